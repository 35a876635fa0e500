//! [`ThrustAllocation`]: thrusts, none negative, that give a wanted force and torque with the least total thrust.
//!
//! - Berdoz's P1, P2, P3, where the force along s3 and the torque about s1 are controlled: closed form, in three cases.
//! - Any other set: a linear program (`super::simplex`).
//!
//! **Out of reach.** Where no thrusts give what is wanted, those are chosen that miss least of the torque (the sum of the magnitudes of its controlled
//! components in F_s), then least of the force, then have the least total.
//!
//! **Limits.** Where a thrust is beyond its limit, the torque keeps its direction and is scaled down as little as possible, whatever becomes of the
//! force: attitude comes first. Then the force, in its direction. Then the total is made least.

use super::simplex::{COLUMNS, Column, ROWS, least};
use crate::control::vector::{cross, difference};
use crate::math::list::List;
use crate::scene::thruster::report_offset;
use crate::scene::{MAX_THRUSTERS, Scene, Thruster};

/// A component of a thruster's direction below this is rounding: far below any alignment.
const NO_PUSH: f64 = 1e-9;

/// What is known of the thrusters, made once per run.
#[derive(Clone, Copy, Debug)]
pub struct ThrustAllocation {
    /// Force and torque about c of each thruster at 1 N, in F_s, N and N m.
    pub(super) wrenches: List<[f64; 6], MAX_THRUSTERS>,
    /// The largest thrusts, N.
    pub(super) most: [f64; MAX_THRUSTERS],
    /// The components of force and torque that are controlled, and the largest entry of each.
    pub(super) rows: List<usize, ROWS>,
    pub(super) scales: [f64; ROWS],
    /// P1, P2, P3 with the controlled components that the closed form needs: the lever, m.
    pub(super) lever: Option<f64>,
}

/// Thrusts, and what they do not give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allocated {
    /// Thrusts in the order of the thrusters, N.
    pub thrust: [f64; MAX_THRUSTERS],
    /// What is wanted less what they give: force and torque about c in F_s, N and N m; zero in components that are not controlled.
    pub missing: [f64; 6],
}

impl ThrustAllocation {
    /// That of `thrusters` on a spacecraft with its centre of mass c at `center` (from p in F_s, m). `most` has the largest thrusts, N, infinite without a
    /// limit, zero of a thruster that is not used; `axes` says which of the components of force and torque in F_s are controlled. The others are
    /// whatever they come to.
    ///
    /// # Panics
    /// With more than [`MAX_THRUSTERS`] thrusters, or not as many limits.
    pub fn new(thrusters: &[Thruster], center: [f64; 3], most: &[f64], axes: [bool; 6]) -> Self {
        assert_eq!(thrusters.len(), most.len(), "a limit of each thruster");
        let mut wrenches = List::empty([0.0; 6]);
        for thruster in thrusters {
            let torque = cross(difference(thruster.position, center), thruster.direction);
            wrenches.push(joined(thruster.direction, torque));
        }
        let (mut rows, mut scales) = (List::empty(0), [1.0; ROWS]);
        for row in (0..6).filter(|row| axes[*row]) {
            let largest = wrenches.iter().fold(0.0_f64, |largest, wrench: &[f64; 6]| largest.max(wrench[row].abs()));
            if largest > 0.0 {
                scales[rows.len()] = largest;
            }
            rows.push(row);
        }
        let is_closed = axes == [false, false, true, true, false, false] && most.iter().all(|most| *most > 0.0);
        let lever = report_offset(thrusters).filter(|lever| is_closed && *lever != 0.0);
        let given = most;
        let mut most = [0.0; MAX_THRUSTERS];
        most[..given.len()].copy_from_slice(given);
        ThrustAllocation { wrenches, most, rows, scales, lever }
    }

    /// That of the thrusters at the places `used` of `scene`, as a control loop needs it: controlled are the torques that they give in both directions, and
    /// the forces that any of them gives.
    pub fn of_loop(scene: &Scene, used: &[usize]) -> Self {
        let models = &scene.actuators.thrusters;
        let limit = |place: usize| if used.contains(&place) { models[place].max_thrust } else { 0.0 };
        let most: Vec<f64> = (0..scene.thrusters.len()).map(limit).collect();
        let center = scene.mass.center;
        let all = Self::new(&scene.thrusters, center, &most, [true; 6]);
        let two_sided = all.two_sided_torques();
        let gives = |row: usize| used.iter().any(|place| all.wrenches[*place][row].abs() > NO_PUSH);
        // as many components as there are such torques: those that they have most of
        let count = (0..3).map(|i| two_sided[i][i]).sum::<f64>().round() as usize;
        let rank = |row: usize| {
            (0..3)
                .filter(|other| {
                    two_sided[*other][*other] > two_sided[row][row]
                        || (two_sided[*other][*other] == two_sided[row][row] && *other < row)
                })
                .count()
        };
        let axes = std::array::from_fn(|row| if row < 3 { gives(row) } else { rank(row - 3) < count });
        Self::new(&scene.thrusters, center, &most, axes)
    }

    /// The thrusts for the force `force_s` (N) and the torque `torque_s` about c (N m), both in F_s; without any where these are not finite.
    pub fn allocate(&self, force_s: [f64; 3], torque_s: [f64; 3]) -> Allocated {
        let wanted = joined(force_s, torque_s);
        let mut thrust = match self.lever {
            Some(lever) => self.closed_form(lever, &wanted),
            None => self.nearest(&wanted),
        };
        if thrust.iter().zip(self.most).any(|(thrust, most)| *thrust > most) {
            thrust = self.within_limits(&self.given(&thrust));
        }
        let given = self.given(&thrust);
        let mut missing = [0.0; 6];
        for row in &self.rows {
            missing[*row] = wanted[*row] - given[*row];
        }
        Allocated { thrust, missing }
    }

    /// Force and torque about c in F_s of the thrusts `thrust`, N and N m.
    pub fn given(&self, thrust: &[f64; MAX_THRUSTERS]) -> [f64; 6] {
        let mut total = [0.0; 6];
        for (wrench, thrust) in self.wrenches.iter().zip(thrust) {
            for (total, one) in total.iter_mut().zip(wrench) {
                *total += thrust * one;
            }
        }
        total
    }

    /// P2 and P3 turn about s1 with opposite signs: P2 - P3 = D makes the torque, P1 - P2 - P3 the force F. The smaller of P2, P3 is zero unless that
    /// leaves P1 below zero; then P1 is, and P2 + P3 = -F.
    fn closed_form(&self, lever: f64, wanted: &[f64; 6]) -> [f64; MAX_THRUSTERS] {
        let (force, torque) = (wanted[2], wanted[3]);
        let mut thrust = [0.0; MAX_THRUSTERS];
        if !(force.is_finite() && torque.is_finite()) {
            return thrust;
        }
        // c beside s3: the force has a torque of its own
        let of_force = self.wrenches[0][3];
        let turning = (torque - of_force * force) / lever;
        let forward = force + turning.abs();
        let of_three = if forward >= 0.0 {
            [forward, turning.max(0.0), (-turning).max(0.0)]
        } else {
            [0.0, 0.5 * (turning - force), 0.5 * (-turning - force)]
        };
        thrust[..3].copy_from_slice(&of_three);
        thrust
    }

    /// The controlled components of `wrench` in units of their scales and of `size`.
    fn in_rows(&self, wrench: &[f64; 6], size: f64) -> [f64; ROWS] {
        let mut found = [0.0; ROWS];
        for ((entry, row), scale) in found.iter_mut().zip(&self.rows).zip(self.scales) {
            *entry = wrench[*row] / scale / size;
        }
        found
    }

    /// The sum of the magnitudes of the controlled components of `wrench`, in units of their scales.
    fn size(&self, wrench: &[f64; 6]) -> f64 {
        self.in_rows(wrench, 1.0).iter().map(|entry| entry.abs()).sum()
    }

    /// The thrusts as variables, the first of a program, in units of `size`.
    fn thrusts(&self, size: f64, most: impl Fn(f64) -> f64) -> List<Column, COLUMNS> {
        let mut columns = List::empty(Column::BLANK);
        for (wrench, limit) in self.wrenches.iter().zip(self.most) {
            let (entries, most) = (self.in_rows(wrench, 1.0), most(limit) / size);
            columns.push(Column { entries, most, costs: [0.0, 0.0, 1.0], starts_at_most: false });
        }
        columns
    }

    /// The thrusts without limits that come nearest to `wanted`, with the least total.
    pub(super) fn nearest(&self, wanted: &[f64; 6]) -> [f64; MAX_THRUSTERS] {
        let size = self.size(wanted);
        if size == 0.0 || !size.is_finite() {
            return [0.0; MAX_THRUSTERS];
        }
        let mut columns = self.thrusts(size, |most| if most == 0.0 { 0.0 } else { f64::INFINITY });
        let largest = |is_torque: bool| {
            let of_kind = self.rows.iter().zip(self.scales).filter(|(row, _)| (**row >= 3) == is_torque);
            of_kind.fold(0.0_f64, |largest, (_, scale)| largest.max(scale))
        };
        for sign in [1.0, -1.0] {
            for (index, row) in self.rows.iter().enumerate() {
                let mut column = Column { most: f64::INFINITY, ..Column::BLANK };
                column.entries[index] = sign;
                column.costs[usize::from(*row < 3)] = self.scales[index] / largest(*row >= 3);
                columns.push(column);
            }
        }
        self.solved(&columns, self.wrenches.len(), wanted, size)
    }

    /// The thrusts within their limits that give the largest share of the torque of `wanted`, then of its force, then have the least total; without limits
    /// `wanted` can be reached.
    fn within_limits(&self, wanted: &[f64; 6]) -> [f64; MAX_THRUSTERS] {
        let size = self.size(wanted);
        let mut columns = self.thrusts(size, |most| most);
        // the shares of torque and force that are not given: all at the start
        let (force, torque) = halves(wanted);
        let shares = [(joined([0.0; 3], torque), [1.0, 0.0, 0.0]), (joined(force, [0.0; 3]), [0.0, 1.0, 0.0])];
        for (wrench, costs) in shares {
            let entries = self.in_rows(&wrench, size);
            columns.push(Column { entries, most: 1.0, costs, starts_at_most: true });
        }
        let units = columns.len();
        for index in 0..self.rows.len() {
            let mut column = Column::BLANK;
            column.entries[index] = 1.0;
            columns.push(column);
        }
        let mut thrust = self.solved(&columns, units, wanted, size);
        // of the product of limit and size
        thrust.iter_mut().zip(self.most).for_each(|(thrust, most)| *thrust = thrust.min(most));
        thrust
    }

    fn solved(&self, columns: &[Column], units: usize, wanted: &[f64; 6], size: f64) -> [f64; MAX_THRUSTERS] {
        let found = least(self.rows.len(), columns, units, self.in_rows(wanted, size));
        let mut thrust = [0.0; MAX_THRUSTERS];
        for (thrust, found) in thrust.iter_mut().zip(&found[..self.wrenches.len()]) {
            *thrust = found * size;
        }
        thrust
    }
}

fn joined([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> [f64; 6] {
    [a, b, c, d, e, f]
}

pub(super) fn halves([a, b, c, d, e, f]: &[f64; 6]) -> ([f64; 3], [f64; 3]) {
    ([*a, *b, *c], [*d, *e, *f])
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::control::vector::norm;
    use crate::scene::thruster::REPORT_DIRECTIONS;

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

    pub const TORQUE: [bool; 6] = [false, false, false, true, true, true];
    pub const REPORT_AXES: [bool; 6] = [false, false, true, true, false, false];
    const FREE: f64 = f64::INFINITY;

    fn total(allocated: &Allocated) -> f64 {
        allocated.thrust.iter().sum()
    }

    /// Law: the optimum is that of SciPy's linprog on 1,000 random sets: what is missing of torque and force, or their shares beyond the limits, and the
    /// total; no thrust is negative or beyond its limit, and what is said to be missing is.
    #[test]
    fn optima_are_those_of_linprog() {
        let text = include_str!("../../../tests/golden/thrust_allocation.json");
        let golden: Vec<[f64; 3]> = serde_json::from_str(text).expect("three numbers of each set");
        assert_eq!(golden.len(), 1000);
        let axes = [TORQUE, [true; 6], [false, false, true, true, true, true], [true; 6]];
        for (index, expected) in golden.iter().enumerate() {
            let mut numbers = Numbers(index as u64);
            let (count, kind) = (4 + index % 9, index % 4);
            let thrusters: Vec<Thruster> =
                (0..count).map(|_| Thruster { position: numbers.three(), direction: numbers.three() }).collect();
            let unlimited = vec![FREE; count];
            let of_all = ThrustAllocation::new(&thrusters, [0.0; 3], &unlimited, axes[kind]);
            let wanted = if kind == 3 || index / 4 % 2 == 0 {
                let mut thrust = [0.0; MAX_THRUSTERS];
                thrust[..count].iter_mut().for_each(|thrust| *thrust = numbers.one().abs());
                of_all.given(&thrust)
            } else {
                joined(numbers.three(), numbers.three())
            };
            let (force, torque) = halves(&wanted);
            let most: Vec<f64> =
                if kind == 3 { (0..count).map(|_| 0.1 + numbers.one().abs()).collect() } else { unlimited };
            let allocation = ThrustAllocation::new(&thrusters, [0.0; 3], &most, axes[kind]);
            let found = allocation.allocate(force, torque);
            for (thrust, most) in found.thrust.iter().zip(&most) {
                assert!((0.0..=*most).contains(thrust), "{index}: {thrust} of {most}");
            }
            let given = allocation.given(&found.thrust);
            for row in (0..6).filter(|row| axes[kind][*row]) {
                assert!((wanted[row] - given[row] - found.missing[row]).abs() < 1e-14);
            }
            let (no_force, no_torque) = halves(&found.missing);
            let missing = if kind == 3 {
                // in the direction of what is wanted
                let share = |missing: [f64; 3], wanted: [f64; 3]| {
                    assert!(norm(cross(missing, wanted)) < 1e-10, "{index}: {missing:?} of {wanted:?}");
                    norm(missing) / norm(wanted)
                };
                [share(no_torque, torque), share(no_force, force)]
            } else {
                [no_torque, no_force].map(|v| v.iter().map(|x| x.abs()).sum())
            };
            let found = [missing[0], missing[1], total(&found)];
            // linprog's own tolerances; measured: 5e-12
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 5e-11 * (1.0 + expected), "{index}: {found} for {expected}");
            }
        }
    }

    pub fn report(center: [f64; 3], most: f64, axes: [bool; 6]) -> ThrustAllocation {
        let positions = [[0.0; 3], [0.0, -0.8, 3.0], [0.0, 0.8, 3.0]];
        let thrusters: Vec<Thruster> = std::iter::zip(positions, REPORT_DIRECTIONS)
            .map(|(position, direction)| Thruster { position, direction })
            .collect();
        assert_eq!(report_offset(&thrusters), Some(0.8));
        ThrustAllocation::new(&thrusters, center, &[most; 3], axes)
    }

    /// Law: the closed form of P1, P2, P3 gives what is wanted, and is the program's optimum, in each of its three cases.
    #[test]
    fn the_closed_form_is_the_optimum() {
        let mut numbers = Numbers(5);
        let mut cases = [0; 3];
        for most in [FREE, 0.5] {
            for _ in 0..500 {
                let center = [0.0, 0.1 * numbers.one(), 1.5];
                let closed = report(center, most, REPORT_AXES);
                let program = ThrustAllocation { lever: None, ..closed };
                let (force, torque) = ([0.0, 0.0, 2.0 * numbers.one()], [numbers.one(), 0.0, 0.0]);
                let (a, b) = (closed.allocate(force, torque), program.allocate(force, torque));
                assert!((total(&a) - total(&b)).abs() < 1e-14 * (1.0 + total(&a)), "{a:?} {b:?}");
                assert!(a.missing.iter().zip(b.missing).all(|(a, b)| (a - b).abs() < 1e-14), "{a:?} {b:?}");
                assert!(most < FREE || a.missing.iter().all(|missing| missing.abs() < 1e-14), "{a:?}");
                let [p1, p2, p3, ..] = a.thrust;
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
    }

    /// Law: of what P1, P2, P3 cannot do nothing is done; torque comes before force, and both keep their directions.
    #[test]
    fn torque_comes_first() {
        let pair = report([0.0, 0.0, 1.5], 1.0, REPORT_AXES);
        // 0.8 N m take all of P2, and P1 for the balance
        let found = pair.allocate([0.0, 0.0, 0.5], [1.6, 0.0, 0.0]);
        assert!(found.thrust[..3].iter().zip([1.0, 1.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        assert!((found.missing[3] - 0.8).abs() < 1e-15 && (found.missing[2] - 0.5).abs() < 1e-15);
        let all = report([0.0, 0.0, 1.5], 1.0, [true; 6]);
        let found = all.allocate([3.0, 0.0, 0.25], [0.0, 0.4, 0.0]);
        let expected = [3.0, 0.0, 0.0, 0.0, 0.4, 0.0];
        assert!((total(&found) - 0.25).abs() < 1e-15, "{found:?}");
        assert!(found.missing.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        let unknown = all.allocate([f64::NAN, 0.0, 0.0], [0.0; 3]);
        assert_eq!(total(&unknown), 0.0);
    }

    /// Eight thrusters as in Basilisk's test of thrForceMapping: four at the top, the same at the bottom.
    pub fn eight(center: [f64; 3], axes: [bool; 6]) -> ThrustAllocation {
        let top = [[-0.8636, -0.8255], [-0.8255, -0.8636], [0.8255, 0.8636], [0.8636, 0.8255]];
        let directions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]];
        let at = |z: f64| {
            std::iter::zip(top, directions).map(move |([x, y], direction)| Thruster { position: [x, y, z], direction })
        };
        let thrusters: Vec<Thruster> = at(1.7907).chain(at(-1.7907)).collect();
        ThrustAllocation::new(&thrusters, center, &[0.95; 8], axes)
    }

    /// Basilisk babdff7, src/fswAlgorithms/effectorInterfaces/thrForceMapping/_UnitTest/test_thrForceMapping.py, set of eight thrusters, torque
    /// (1, -0.5, 0.7) N m: the totals of its thrusts, from its module (bsk 2.12.1). Law: the same torque with no greater total.
    #[test]
    fn totals_are_no_greater_than_of_basilisk() {
        let offset = [0.03, 0.001, 0.02];
        let cases = [
            ([0.0; 3], 1, 1.1168816663874461),
            ([0.0; 3], 2, 1.1168816663874463),
            ([0.0; 3], 3, 1.9648525930985303),
            (offset, 1, 1.129215051884725),
            (offset, 2, 1.129215051884725),
            (offset, 3, 1.9830476967174024),
        ];
        for (center, count, of_basilisk) in cases {
            let allocation = eight(center, std::array::from_fn(|row| row >= 3 && row < 3 + count));
            let found = allocation.allocate([0.0; 3], [1.0, -0.5, 0.7]);
            assert!(found.missing.iter().all(|missing| missing.abs() < 1e-14), "{found:?}");
            assert!(total(&found) <= of_basilisk * (1.0 + 1e-12), "{} of {of_basilisk}", total(&found));
        }
    }
}
