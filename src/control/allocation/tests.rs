//! What thrusts are allocated, against linear programs solved by other means.

use super::{ThrustAllocation, WheelTorque};
use crate::control::vector::{cross, difference, dot, norm, scaled};
use crate::scene::thruster::{REPORT_DIRECTIONS, report_offset};
use crate::scene::{MAX_THRUSTERS, Thruster};

/// Numbers from -1 to 1 in thousandths, as in tests/golden/thrust_allocation.py.
struct Numbers(u64);

impl Numbers {
    fn one(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (((self.0 >> 33) % 2001) as f64 - 1000.0) / 1000.0
    }

    fn three(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.one())
    }
}

pub const ALL: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
pub const NONE: [[f64; 3]; 3] = [[0.0; 3]; 3];
const FREE: f64 = f64::INFINITY;

fn size(vector: impl IntoIterator<Item = f64>) -> f64 {
    vector.into_iter().map(f64::abs).sum()
}

/// Law: the optimum is that of SciPy's linprog on 1,000 random sets, with a force and without, with limits and without,
/// beside wheels that reach nothing, one axis, two, all: what is missing of torque and force by priority, and the
/// total; no thrust is negative or beyond its limit, and beyond the limits the torque keeps its direction.
#[test]
fn optima_are_those_of_linprog() {
    let text = include_str!("../../../tests/golden/thrust_allocation.json");
    let golden: Vec<[f64; 5]> = serde_json::from_str(text).expect("five numbers of each set");
    assert_eq!(golden.len(), 1000);
    let mut cut = 0;
    for (index, expected) in golden.iter().enumerate() {
        let mut numbers = Numbers(index as u64);
        let (count, has_force, has_limits) = (4 + index % 9, index % 2 == 1, index / 2 % 2 == 1);
        let is_within = [[false; 3], [false, false, true], [true, true, false], [true; 3]][index / 4 % 4];
        let by_wheels = std::array::from_fn(|i| ALL[i].map(|x| if is_within[i] { x } else { 0.0 }));
        let thrusters: Vec<Thruster> =
            (0..count).map(|_| Thruster { position: numbers.three(), direction: numbers.three() }).collect();
        let unlimited = vec![FREE; count];
        let [force, torque] = if index / 16 % 2 == 0 {
            let mut thrust = [0.0; MAX_THRUSTERS];
            thrust[..count].iter_mut().for_each(|thrust| *thrust = numbers.one().abs());
            ThrustAllocation::new(&thrusters, [0.0; 3], &unlimited, by_wheels).given(&thrust)
        } else {
            [numbers.three(), numbers.three()]
        };
        let most: Vec<f64> =
            if has_limits { (0..count).map(|_| 0.1 + numbers.one().abs()).collect() } else { unlimited.clone() };
        let force = has_force.then_some(force);
        let [limited, free] = [&most, &unlimited].map(|most| {
            let allocation = ThrustAllocation::new(&thrusters, [0.0; 3], most, by_wheels);
            let thrust = allocation.allocate(force, torque);
            assert!(thrust.iter().zip(most).all(|(thrust, most)| (0.0..=*most).contains(thrust)), "{index}");
            (thrust, allocation.given(&thrust))
        });
        let (thrust, [forced, turned]) = limited;
        let missing =
            |is_meant: bool| size((0..3).filter(|i| is_within[*i] == is_meant).map(|i| torque[i] - turned[i]));
        let of_force = force.map_or(0.0, |force| size(difference(force, forced)));
        let found = [missing(false), of_force, missing(true), size(thrust)];
        // linprog's own tolerances; measured: 5e-12
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 5e-11 * (1.0 + expected), "{index}: {found} for {expected}");
        }
        for i in (0..3).filter(|i| !is_within[*i]) {
            let given = (1.0 - expected[4]) * free.1[1][i];
            assert!((turned[i] - given).abs() < 1e-10, "{index}: {} for {given}", turned[i]);
        }
        cut += usize::from(expected[4] > 0.0);
    }
    assert!(cut > 100, "{cut} sets beyond their limits");
}

/// Every corner of thrusts within `most` that give `torque` about c: with n thrusters and three equations all but three
/// are at zero or at their limit.
fn corners(thrusters: &[Thruster], most: f64, torque: [f64; 3], found: &mut Vec<f64>) {
    let columns: Vec<[f64; 3]> = thrusters.iter().map(|one| cross(one.position, one.direction)).collect();
    let n = columns.len();
    for basis in (0..1_usize << n).filter(|set| set.count_ones() == 3) {
        let is_basic = |i: usize| basis >> i & 1 == 1;
        let [a, b, c] = [0, 1, 2].map(|k| columns[(0..n).filter(|i| is_basic(*i)).nth(k).expect("three")]);
        let volume = dot(a, cross(b, c));
        for at_most in (0..1_usize << n).filter(|set| set & basis == 0) {
            let others = (0..n).filter(|i| at_most >> i & 1 == 1);
            let left = others.fold(torque, |left, i| difference(left, columns[i].map(|x| most * x)));
            // Cramer's rule
            let basic = [(b, c), (c, a), (a, b)].map(|(u, v)| dot(left, cross(u, v)) / volume);
            if basic.iter().all(|one| (-1e-9..=most + 1e-9).contains(one)) {
                found.push(basic.iter().sum::<f64>() + most * f64::from(at_most.count_ones()));
            }
        }
    }
}

/// Law: four canted thrusters and five, whose torques span all directions, give every torque of every direction within
/// their limits, with the least total of all corners; a torque that is beyond them keeps its direction. No set of three
/// can.
#[test]
fn canted_thrusters_give_every_torque() {
    let places = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    // thrust along +s3, turned about the arm to either side in turn
    let canted = |(place, side): ([f64; 2], f64)| {
        let [x, y] = place;
        let (sine, cosine) = (0.3 * side, 0.91_f64.sqrt());
        Thruster { position: [x, y, -0.5], direction: [-sine * y, sine * x, cosine] }
    };
    let four: Vec<Thruster> = places.into_iter().zip([1.0, -1.0, 1.0, -1.0]).map(canted).collect();
    let mut five = four.clone();
    five.push(Thruster { position: [0.1, 0.0, -0.5], direction: [0.0, 0.0, 1.0] });
    let mut numbers = Numbers(11);
    for thrusters in [&four, &five] {
        let most = vec![2.0; thrusters.len()];
        let allocation = ThrustAllocation::new(thrusters, [0.0; 3], &most, NONE);
        let axes: f64 = (0..3).map(|i| allocation.two_sided_torques(false)[i][i]).sum();
        assert!((axes - 3.0).abs() < 1e-12);
        assert!((0..3).map(|i| allocation.two_sided_torques(true)[i][i]).sum::<f64>() < 2.5, "with the force held");
        for _ in 0..50 {
            let torque = numbers.three().map(|x| 0.2 * x);
            let thrust = allocation.allocate(None, torque);
            assert!(size(difference(allocation.given(&thrust)[1], torque)) < 1e-14, "{torque:?}");
            let mut totals = Vec::new();
            corners(thrusters, 2.0, torque, &mut totals);
            let least = totals.iter().copied().fold(f64::INFINITY, f64::min);
            assert!((size(thrust) - least).abs() < 1e-12, "{} for {least}", size(thrust));
            let far = allocation.given(&allocation.allocate(None, torque.map(|x| 100.0 * x)))[1];
            let mut totals = Vec::new();
            corners(thrusters, 2.0, far, &mut totals);
            assert!(size(cross(far, torque)) < 1e-12 && dot(far, torque) > 0.0 && !totals.is_empty());
            let mut beyond = Vec::new();
            corners(thrusters, 2.0, far.map(|x| 1.001 * x), &mut beyond);
            assert!(beyond.is_empty(), "more would be within reach");
        }
    }
    let three = ThrustAllocation::new(&four[..3], [0.0; 3], &[2.0; 3], NONE);
    assert!((0..3).map(|i| three.two_sided_torques(false)[i][i]).sum::<f64>() < 2.5);
}

pub fn report(center: [f64; 3], most: f64, by_wheels: [[f64; 3]; 3]) -> ThrustAllocation {
    let positions = [[0.0; 3], [0.0, -0.8, 3.0], [0.0, 0.8, 3.0]];
    let thrusters: Vec<Thruster> = std::iter::zip(positions, REPORT_DIRECTIONS)
        .map(|(position, direction)| Thruster { position, direction })
        .collect();
    assert_eq!(report_offset(&thrusters), Some(0.8));
    ThrustAllocation::new(&thrusters, center, &[most; 3], by_wheels)
}

/// Law: the closed form of P1, P2, P3 gives what is wanted, and is the program's optimum, in each of its three cases.
#[test]
fn the_closed_form_is_the_optimum() {
    let mut numbers = Numbers(5);
    let mut cases = [0; 3];
    for most in [FREE, 0.5] {
        for _ in 0..500 {
            let center = [0.0, 0.1 * numbers.one(), 1.5];
            let closed = report(center, most, NONE);
            assert!(closed.lever.is_some());
            let mut program = closed;
            program.lever = None;
            let (force, torque) = ([0.0, 0.0, 2.0 * numbers.one()], [numbers.one(), 0.0, 0.0]);
            let [a, b] = [closed, program].map(|all| all.allocate(Some(force), torque));
            assert!((size(a) - size(b)).abs() < 1e-14 * (1.0 + size(a)), "{a:?} {b:?}");
            let [of_a, of_b] = [a, b].map(|thrust| closed.given(&thrust));
            assert!(size(of_a.into_iter().zip(of_b).flat_map(|(a, b)| difference(a, b))) < 1e-14, "{a:?} {b:?}");
            let missing = size(difference(force, of_a[0])) + size(difference(torque, of_a[1]));
            assert!(most < FREE || missing < 1e-14, "{a:?}");
            let [p1, p2, p3, ..] = a;
            cases[if p1 == 0.0 {
                0
            } else if p3 == 0.0 {
                1
            } else {
                2
            }] += 1;
            assert!(p1.min(p2).min(p3) >= 0.0 && (most < FREE || p1 == 0.0 || p2 == 0.0 || p3 == 0.0));
        }
    }
    assert!(cases.iter().all(|count| *count > 50), "{cases:?}");
    assert!(report([0.1, 0.0, 1.5], 1.0, NONE).lever.is_none(), "with c off s3 they turn about s2 too");
}

/// Law: a torque that no wheel can give comes before the force, the force before a torque that wheels make good.
/// Without a wanted force, one thruster turns.
#[test]
fn torque_comes_first() {
    let pair = report([0.0, 0.0, 1.5], 1.0, NONE);
    let close = |found: [f64; MAX_THRUSTERS], expected: [f64; 3]| {
        found[..3].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15)
    };
    // 1.6 N m are beyond P2, which gives 0.8; P1 adds to the force, or balances
    for (force, expected) in [(None, [0.0, 1.0, 0.0]), (Some(0.5), [1.0, 1.0, 0.0]), (Some(-0.25), [0.75, 1.0, 0.0])] {
        let found = pair.allocate(force.map(|force| [0.0, 0.0, force]), [1.6, 0.0, 0.0]);
        assert!(close(found, expected), "{force:?}: {found:?}");
    }
    let found = pair.allocate(None, [-0.4, 0.7, 0.0]);
    assert!(close(found, [0.0, 0.0, 0.5]), "{found:?}");
    // where a wheel takes the torque, the force comes first; of the torque what is left is given
    let within = report([0.0, 0.0, 1.5], 1.0, ALL);
    assert!(close(within.allocate(Some([0.0, 0.0, 1.0]), [0.8, 0.0, 0.0]), [1.0, 0.0, 0.0]));
    assert!(close(within.allocate(Some([0.0, 0.0, 0.5]), [0.8, 0.0, 0.0]), [1.0, 0.5, 0.0]));
    assert!(close(pair.allocate(Some([0.0, 0.0, 1.0]), [0.8, 0.0, 0.0]), [1.0, 1.0, 0.0]));
    for unknown in [pair.allocate(Some([0.0, 0.0, f64::NAN]), [0.0; 3]), pair.allocate(None, [f64::NAN; 3])] {
        assert_eq!(unknown, [0.0; MAX_THRUSTERS]);
    }
}

/// Law: beside two wheels whose axes are oblique, what thrusters give across the plane of these axes is what is wanted.
#[test]
fn oblique_wheels_have_a_plane() {
    let normal = [0.48, -0.6, 0.64];
    let plane = std::array::from_fn(|i| std::array::from_fn(|j| ALL[i][j] - normal[i] * normal[j]));
    let mut numbers = Numbers(3);
    let thrusters: Vec<Thruster> =
        (0..6).map(|_| Thruster { position: numbers.three(), direction: numbers.three() }).collect();
    let allocation = ThrustAllocation::new(&thrusters, [0.0; 3], &[FREE; 6], plane);
    for sign in [1.0, -1.0] {
        let [force, torque] = [numbers.three(), normal.map(|x| sign * x)];
        let [_, given] = allocation.given(&allocation.allocate(Some(force), torque));
        assert!((dot(given, normal) - sign).abs() < 1e-13, "{given:?}");
    }
}

/// Law: rounding fires no thruster. Thrusters whose lines meet c turn nothing, whatever their directions; what wheels
/// about three oblique axes give is given by them alone; and of a torque across two wheels no thruster gives more than
/// that of it.
#[test]
fn rounding_fires_nothing() {
    let mut numbers = Numbers(11);
    for index in 0..200 {
        let center = numbers.three();
        let through_center: Vec<Thruster> = (0..4)
            .map(|_| {
                let (direction, along) = (numbers.three(), 10.0 * numbers.one());
                let position = std::array::from_fn(|i| center[i] + along * direction[i]);
                Thruster { position, direction }
            })
            .collect();
        let idle = ThrustAllocation::new(&through_center, center, &[FREE; 4], NONE);
        assert_eq!(idle.allocate(None, numbers.three()), [0.0; MAX_THRUSTERS], "{index}");
        let axes: Vec<[f64; 3]> = (0..4).map(|_| numbers.three()).map(|axis| scaled(1.0 / norm(axis), axis)).collect();
        let (all, two) = (WheelTorque::new(&axes), WheelTorque::new(&axes[..2]));
        let torque = numbers.three();
        assert_eq!(all.out_of_reach(torque), [0.0; 3], "{index}");
        let normal = cross(axes[0], axes[1]);
        if norm(normal) < 0.1 {
            continue;
        }
        // thrusters in pairs, each pair about one axis of the plane or about its normal
        let level = scaled(1.0 / norm(normal), normal);
        let arms = [axes[0], cross(level, axes[0]), level];
        let pairs = (0..3).flat_map(|i| {
            let (arm, direction) = (arms[(i + 1) % 3], arms[(i + 2) % 3]);
            [1.0, -1.0].map(|sign| Thruster { position: scaled(sign, arm), direction })
        });
        let pairs: Vec<Thruster> = pairs.collect();
        let allocation = ThrustAllocation::new(&pairs, [0.0; 3], &[FREE; 6], two.reachable);
        let thrust = allocation.allocate(None, two.out_of_reach(torque));
        let fired = thrust.iter().filter(|thrust| **thrust > 0.0).count();
        assert_eq!(fired, 1, "{index}: {thrust:?}");
    }
}

/// Eight thrusters as in Basilisk's test of thrForceMapping: four at the top, the same at the bottom.
pub fn eight(center: [f64; 3], by_wheels: [[f64; 3]; 3]) -> ThrustAllocation {
    let top = [[-0.8636, -0.8255], [-0.8255, -0.8636], [0.8255, 0.8636], [0.8636, 0.8255]];
    let directions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];
    let at = |z: f64| {
        std::iter::zip(top, directions).map(move |([x, y], direction)| Thruster { position: [x, y, z], direction })
    };
    let thrusters: Vec<Thruster> = at(1.7907).chain(at(-1.7907)).collect();
    ThrustAllocation::new(&thrusters, center, &[0.95; 8], by_wheels)
}

/// Basilisk babdff7, src/fswAlgorithms/effectorInterfaces/thrForceMapping/_UnitTest/test_thrForceMapping.py, set of
/// eight thrusters, torque (1, -0.5, 0.7) N m about all axes: the total of its thrusts, from its module (bsk 2.12.1).
/// Law: the same torque with no greater total.
#[test]
fn totals_are_no_greater_than_of_basilisk() {
    for (center, of_basilisk) in [([0.0; 3], 1.9648525930985303), ([0.03, 0.001, 0.02], 1.9830476967174024)] {
        let (allocation, torque) = (eight(center, NONE), [1.0, -0.5, 0.7]);
        let found = allocation.allocate(None, torque);
        assert!(size(difference(allocation.given(&found)[1], torque)) < 1e-14, "{found:?}");
        assert!(size(found) <= of_basilisk * (1.0 + 1e-12), "{} of {of_basilisk}", size(found));
    }
}
