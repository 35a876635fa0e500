//! Allocated thrusts against independent solutions of linear programs.

use super::{ThrustAllocation, WheelTorque};
use crate::loops::vector::{cross, difference, norm, scaled};
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

/// Law: on 1,000 random sets the optimum is that of SciPy's linprog, with and without force and limits, beside wheels
/// that reach zero to three axes: missing torque and force by priority, and the total. No thrust is negative or beyond
/// its limit, and at the limits the torque keeps its direction.
#[test]
fn optima_are_those_of_linprog() {
    let text = include_str!("../../../../../tests/golden/thrust_allocation.json");
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
        // linprog's tolerances; measured: 5e-12
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

/// P1, P2, P3.
pub fn report_thrusters() -> Vec<Thruster> {
    let positions = [[0.0; 3], [0.0, -0.8, 3.0], [0.0, 0.8, 3.0]];
    std::iter::zip(positions, REPORT_DIRECTIONS).map(|(position, direction)| Thruster { position, direction }).collect()
}

pub fn report(center: [f64; 3], most: f64, by_wheels: [[f64; 3]; 3]) -> ThrustAllocation {
    let thrusters = report_thrusters();
    assert_eq!(report_offset(&thrusters), Some(0.8));
    ThrustAllocation::new(&thrusters, center, &[most; 3], by_wheels)
}

/// Law: the closed form of P1, P2, P3 gives the wanted wrench and is the program's optimum, in each of its three cases.
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

/// Law: rounding fires no thruster, be it through lines of thrust that meet c, three oblique wheels that give all the
/// torque, or two wheels and a torque across them.
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
        // pairs of thrusters, each about one axis of the plane or about its normal
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

/// Eight thrusters as in Basilisk's test of thrForceMapping: four at the top, four at the bottom.
pub fn eight(center: [f64; 3], by_wheels: [[f64; 3]; 3]) -> ThrustAllocation {
    let top = [[-0.8636, -0.8255], [-0.8255, -0.8636], [0.8255, 0.8636], [0.8636, 0.8255]];
    let directions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];
    let at = |z: f64| {
        std::iter::zip(top, directions).map(move |([x, y], direction)| Thruster { position: [x, y, z], direction })
    };
    let thrusters: Vec<Thruster> = at(1.7907).chain(at(-1.7907)).collect();
    ThrustAllocation::new(&thrusters, center, &[0.95; 8], by_wheels)
}
