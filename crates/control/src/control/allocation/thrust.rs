//! [`ThrustAllocation`]: nonnegative thrusts for a wanted torque, and for a force if one is wanted, with the least
//! total.
//!
//! **Attitude first.** min sum(f) for the wanted torque and 0 <= f <= max; the force is free unless a maneuver or
//! `hold_force` sets it. Deviations are minimised in this order: torque that no wheel can give; force, if wanted;
//! torque that wheels can replace (`super::WheelTorque::reachable`); total thrust. An amount is the sum of component
//! magnitudes: of the force in F_s, of the torque along axes either within or across the span of the wheels' axes
//! (those of F_s if wheels reach all or nothing).
//!
//! **Limits.** If a thrust exceeds its limit, the torque that no wheel can give is scaled down as little as possible in
//! its direction, so that a torque against a rate remains one. The rest follows in the order above.
//!
//! The problem is a linear program (`super::simplex`). Berdoz's P1, P2, P3 with a wanted force have a closed form in
//! three cases.

use super::ROUNDING;
use super::simplex::{COLUMNS, Column, ROWS, least};
use crate::loops::vector::{cross, difference, dot, norm, scaled};
use crate::math::list::List;
use crate::math::symmetric::principal_axes;
use crate::scene::thruster::report_offset;
use crate::scene::{MAX_THRUSTERS, Scene, Thruster};

/// Share of the largest component among thrusters below which a component is rounding.
const NOTHING: f64 = 1e-9;

/// Priorities: torque that no wheel can give, force, torque that wheels can replace, total thrust.
const ACROSS: usize = 0;
const FORCE: usize = 1;
const WITHIN: usize = 2;
const TOTAL: usize = 3;

/// A force and a torque about c in F_s.
pub type Wrench = [[f64; 3]; 2];

#[derive(Clone, Copy, Debug)]
struct Row {
    /// Unit vector in F_s.
    axis: [f64; 3],
    /// Priority of its deviation.
    level: usize,
    /// Largest value among the thrusters at 1 N.
    scale: f64,
}

impl Row {
    fn of(&self, [force, torque]: &Wrench) -> f64 {
        dot(self.axis, if self.level == FORCE { *force } else { *torque })
    }
}

/// The thrusters of a run.
#[derive(Clone, Copy, Debug)]
pub struct ThrustAllocation {
    /// Force and torque about c of each thruster at 1 N.
    pub(super) wrenches: List<Wrench, MAX_THRUSTERS>,
    /// Thrust limits.
    pub(super) most: [f64; MAX_THRUSTERS],
    /// Components in which the thrusters act, torque before force.
    rows: List<Row, ROWS>,
    /// Lever of P1, P2, P3, if the closed form applies.
    pub(super) lever: Option<f64>,
}

impl ThrustAllocation {
    /// Allocation to `thrusters` with the centre of mass c at `center` (from p in F_s). Limits `most` are infinite
    /// without a limit and zero for an unused thruster; `by_wheels` is the projection onto the torques that wheels can
    /// give.
    ///
    /// # Panics
    /// With more than [`MAX_THRUSTERS`] thrusters, or without a limit for each.
    pub fn new(thrusters: &[Thruster], center: [f64; 3], most: &[f64], by_wheels: [[f64; 3]; 3]) -> Self {
        assert_eq!(thrusters.len(), most.len(), "a limit of each thruster");
        let mut wrenches = List::empty([[0.0; 3]; 2]);
        for thruster in thrusters {
            let torque = cross(difference(thruster.position, center), thruster.direction);
            // rounding of the difference of positions
            let least = ROUNDING * (norm(thruster.position) + norm(center)) * norm(thruster.direction);
            wrenches.push([thruster.direction, torque.map(|torque| if torque.abs() <= least { 0.0 } else { torque })]);
        }
        let of_force = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| (axis, FORCE));
        let mut rows = List::empty(Row { axis: [0.0; 3], level: TOTAL, scale: 0.0 });
        for axes in [torque_axes(by_wheels), of_force] {
            let of_kind = axes.map(|(axis, level)| {
                let row = Row { axis, level, scale: 0.0 };
                let used = wrenches.iter().zip(most).filter(|(_, most)| **most > 0.0);
                Row { scale: used.fold(0.0, |scale, (wrench, _)| row.of(wrench).abs().max(scale)), ..row }
            });
            let largest = of_kind.iter().fold(0.0_f64, |largest, row| largest.max(row.scale));
            of_kind.into_iter().filter(|row| row.scale > NOTHING * largest).for_each(|row| rows.push(row));
        }
        let turns_about_s1 = wrenches.iter().all(|wrench| wrench[1][1] == 0.0 && wrench[1][2] == 0.0);
        let is_closed = turns_about_s1 && most.iter().all(|most| *most > 0.0);
        let lever = report_offset(thrusters).filter(|lever| is_closed && *lever != 0.0);
        let given = most;
        let mut most = [0.0; MAX_THRUSTERS];
        most[..given.len()].copy_from_slice(given);
        ThrustAllocation { wrenches, most, rows, lever }
    }

    /// Allocation to the thrusters `used` of `scene`, beside wheels with the torques of the projection `by_wheels`.
    pub fn of_loop(scene: &Scene, used: &[usize], by_wheels: [[f64; 3]; 3]) -> Self {
        let models = &scene.actuators.thrusters;
        let limit = |place: usize| if used.contains(&place) { models[place].max_thrust } else { 0.0 };
        let most: Vec<f64> = (0..scene.thrusters.len()).map(limit).collect();
        Self::new(&scene.thrusters, scene.mass.center, &most, by_wheels)
    }

    /// Thrusts for the torque `torque_s` about c and, if wanted, the force `force_s`; none if these are not finite.
    pub fn allocate(&self, force_s: Option<[f64; 3]>, torque_s: [f64; 3]) -> [f64; MAX_THRUSTERS] {
        let wanted = [force_s.unwrap_or([0.0; 3]), torque_s];
        let rows = self.rows(force_s.is_some());
        let thrust = match (self.lever, force_s) {
            (Some(lever), Some(_)) => self.closed_form(lever, &wanted),
            _ => self.nearest(rows, &wanted),
        };
        if thrust.iter().zip(self.most).any(|(thrust, most)| *thrust > most) {
            self.within_limits(rows, &wanted, &self.given(&thrust))
        } else {
            thrust
        }
    }

    /// Force and torque about c in F_s of the thrusts `thrust`.
    pub fn given(&self, thrust: &[f64; MAX_THRUSTERS]) -> Wrench {
        let mut total = [[0.0; 3]; 2];
        for (wrench, thrust) in self.wrenches.iter().zip(thrust) {
            for (total, one) in total.as_flattened_mut().iter_mut().zip(wrench.as_flattened()) {
                *total += thrust * one;
            }
        }
        total
    }

    /// The torque components, and those of the force if wanted.
    pub(super) fn rows(&self, has_force: bool) -> Rows<'_> {
        let torques = self.rows.iter().filter(|row| row.level != FORCE).count();
        Rows(&self.rows[..if has_force { self.rows.len() } else { torques }])
    }

    /// P2 and P3 turn about s1 with opposite signs: P2 - P3 = D gives the torque, P1 - P2 - P3 the force F. The smaller
    /// of P2, P3 is zero unless P1 would be negative; then P1 is zero, and P2 + P3 = -F.
    fn closed_form(&self, lever: f64, [[_, _, force], [torque, ..]]: &Wrench) -> [f64; MAX_THRUSTERS] {
        let mut thrust = [0.0; MAX_THRUSTERS];
        if !(force.is_finite() && torque.is_finite()) {
            return thrust;
        }
        // off s3, the force has its own torque about c
        let of_force = self.wrenches[0][1][0];
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

    /// The thrusts as the first variables of a program, in units of `size`.
    fn thrusts(&self, rows: Rows<'_>, size: f64, most: impl Fn(f64) -> f64) -> List<Column, COLUMNS> {
        let mut columns = List::empty(Column::BLANK);
        for (wrench, limit) in self.wrenches.iter().zip(self.most) {
            let mut column = Column { entries: rows.of(wrench, 1.0), most: most(limit) / size, ..Column::BLANK };
            column.costs[TOTAL] = 1.0;
            columns.push(column);
        }
        columns
    }

    /// Unlimited thrusts nearest to `wanted` in `rows`, with the least total.
    pub(super) fn nearest(&self, rows: Rows<'_>, wanted: &Wrench) -> [f64; MAX_THRUSTERS] {
        let size = rows.size(wanted);
        if size == 0.0 || !size.is_finite() {
            return [0.0; MAX_THRUSTERS];
        }
        let mut columns = self.thrusts(rows, size, |most| if most == 0.0 { 0.0 } else { f64::INFINITY });
        rows.push_units(&mut columns, |_| f64::INFINITY);
        self.solved(&columns, self.wrenches.len(), rows, wanted, size)
    }

    /// Thrusts within limits: the largest share of the torque of `without_limits` that no wheel can give, then the rest
    /// of `wanted`.
    fn within_limits(&self, rows: Rows<'_>, wanted: &Wrench, without_limits: &Wrench) -> [f64; MAX_THRUSTERS] {
        let mut target = *wanted;
        // the rows are a basis of the thrusters' torques
        for row in rows.0.iter().filter(|row| row.level == ACROSS) {
            let change = row.of(without_limits) - row.of(wanted);
            target[1] = std::array::from_fn(|i| target[1][i] + change * row.axis[i]);
        }
        let size = rows.size(&target);
        let mut columns = self.thrusts(rows, size, |most| most);
        // the missing share, initially all
        let mut share = Column { entries: rows.of(&target, size), most: 1.0, starts_at_most: true, ..Column::BLANK };
        share.costs[ACROSS] = 1.0;
        for (entry, _) in share.entries.iter_mut().zip(rows.0).filter(|(_, row)| row.level != ACROSS) {
            *entry = 0.0;
        }
        columns.push(share);
        let units = columns.len();
        rows.push_units(&mut columns, |row| if row.level == ACROSS { 0.0 } else { f64::INFINITY });
        let mut thrust = self.solved(&columns, units, rows, &target, size);
        // rounding of limit times size
        thrust.iter_mut().zip(self.most).for_each(|(thrust, most)| *thrust = thrust.min(most));
        thrust
    }

    fn solved(
        &self,
        columns: &[Column],
        units: usize,
        rows: Rows<'_>,
        wanted: &Wrench,
        size: f64,
    ) -> [f64; MAX_THRUSTERS] {
        let found = least(rows.0.len(), columns, units, rows.of(wanted, size));
        let mut thrust = [0.0; MAX_THRUSTERS];
        for (thrust, found) in thrust.iter_mut().zip(&found[..self.wrenches.len()]) {
            *thrust = found * size;
        }
        thrust
    }
}

/// Components of a wrench that count.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a>(&'a [Row]);

impl Rows<'_> {
    /// Components of `wrench` in units of their scales and of `size`; rounding becomes zero.
    fn of(&self, wrench: &Wrench, size: f64) -> [f64; ROWS] {
        let [force, torque] = wrench.map(|part| ROUNDING * norm(part));
        let mut found = [0.0; ROWS];
        for (entry, row) in found.iter_mut().zip(self.0) {
            let component = row.of(wrench);
            let least = if row.level == FORCE { force } else { torque };
            *entry = if component.abs() <= least { 0.0 } else { component / row.scale / size };
        }
        found
    }

    /// Sum of their magnitudes in units of their scales.
    fn size(&self, wrench: &Wrench) -> f64 {
        self.of(wrench, 1.0).iter().map(|entry| entry.abs()).sum()
    }

    /// True if all components of `wrench` are below `least`, relative to the thrusters.
    pub(super) fn is_negligible(&self, wrench: &Wrench, least: f64) -> bool {
        self.of(wrench, 1.0).iter().all(|entry| entry.abs() <= least)
    }

    /// Adds deficit and excess of each component as variables up to `most`.
    fn push_units(&self, columns: &mut List<Column, COLUMNS>, most: impl Fn(&Row) -> f64) {
        let largest = |level: usize| {
            let of_level = self.0.iter().filter(|row| row.level == level);
            of_level.fold(0.0_f64, |largest, row| largest.max(row.scale))
        };
        for sign in [1.0, -1.0] {
            for (index, row) in self.0.iter().enumerate() {
                let mut column = Column { most: most(row), ..Column::BLANK };
                column.entries[index] = sign;
                column.costs[row.level] = row.scale / largest(row.level);
                columns.push(column);
            }
        }
    }
}

/// Three orthogonal axes, each within or across the span of the projection `by_wheels`: those of F_s if it is diagonal.
/// Otherwise the single axis n within or across, the direction across n nearest to an axis of F_s (the first of
/// equals), and their cross product.
fn torque_axes(by_wheels: [[f64; 3]; 3]) -> [([f64; 3], usize); 3] {
    let of_frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let within = (0..3).map(|i| by_wheels[i][i]).sum::<f64>().round() as usize;
    let is_diagonal = (0..3).all(|i| (0..3).all(|j| i == j || by_wheels[i][j] == 0.0));
    if within == 0 || within == 3 || is_diagonal {
        let is_within = |i: usize| within == 3 || (within > 0 && by_wheels[i][i] > 0.5);
        return std::array::from_fn(|i| (of_frame[i], if is_within(i) { WITHIN } else { ACROSS }));
    }
    let (moments, c_sb) = principal_axes(by_wheels);
    let (alone, others) = if within == 1 { (WITHIN, ACROSS) } else { (ACROSS, WITHIN) };
    let place = (0..3).find(|i| (moments[*i] > 0.5) == (within == 1)).expect("one of three is alone");
    let normal = c_sb.map(|row| row[place]);
    let nearest = (1..3).fold(0, |best, i| if normal[i].abs() < normal[best].abs() - NOTHING { i } else { best });
    let level = difference(of_frame[nearest], scaled(normal[nearest], normal));
    let level = scaled(1.0 / norm(level), level);
    [(normal, alone), (level, others), (cross(normal, level), others)]
}
