//! [`OutcomeColumns`]: the outcome of a run under a loop as columns, each one row of a table.

use super::MissionOutcome;
use crate::control::guidance::Guidance;
use crate::loops::failure::Failure;
use crate::loops::spec::{LoopSpec, STANDARD_GRAVITY};
use crate::observables::{ColumnKind, LawColumn, LawColumns};
use crate::run::Quantity;

/// Needs of a column, in words and as a test.
struct Needs(&'static str, fn(&LoopSpec) -> bool);

const NOTHING: Needs = Needs("", |_| true);
const LAUNCH: Needs = Needs("needs a phase with next = \"launch\"", LoopSpec::launches);
const TARGET: Needs = Needs("needs a phase with a target", LoopSpec::points);
const APPROACH: Needs = Needs("needs debris, and a phase that points or moves relative to it", LoopSpec::approaches);
const LAUNCH_AT_DEBRIS: Needs =
    Needs("needs debris, and a phase with next = \"launch\"", |spec| spec.approaches() && spec.launches());
const LAUNCH_WITH_WHEELS: Needs = Needs("needs debris, a phase with next = \"launch\", and wheels", |spec| {
    spec.approaches() && spec.launches() && !spec.wheels.is_empty()
});
const THRUSTERS: Needs = Needs("needs thrusters in control.thrusters", |spec| !spec.thrusters.is_empty());
const PLUMES: Needs = Needs("needs debris that a phase approaches, and thrusters in control.thrusters", |spec| {
    spec.approaches() && !spec.thrusters.is_empty()
});
const RODS: Needs = Needs("needs torque rods in control.torque_rods", |spec| !spec.rods.is_empty());
const WHEELS: Needs = Needs("needs wheels in control.wheels", |spec| !spec.wheels.is_empty());
const FILTER: Needs = Needs("needs an estimator with a filter: mekf", LoopSpec::has_filter);
const FILTER_OF_MOTION: Needs =
    Needs("needs an estimator with a filter: mekf, and debris that a phase approaches", |spec| {
        spec.has_filter() && spec.approaches()
    });
const MODULE: Needs = Needs("needs a module that declares telemetry", |_| true);

type Value = fn(&MissionOutcome, &Guidance, usize) -> f64;

struct Row {
    /// `<phase>`, `<thruster>` or `<wheel>` gives one column for each, with its index passed to `value`.
    name: &'static str,
    unit: &'static str,
    needs: Needs,
    value: Value,
    /// `<phases>` and `<failures>` stand for their codes, `<per degree>` for [`PER_DEGREE`].
    meaning: &'static str,
}

/// Null for infinity, which means "never" or "none".
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::NAN }
}

const fn row(name: &'static str, unit: &'static str, needs: Needs, value: Value, meaning: &'static str) -> Row {
    Row { name, unit, needs, value, meaning }
}

/// The scale of normalised squares.
const PER_DEGREE: &str = "divided by its degrees of freedom: 1 on average if the filter is consistent; null if it is \
    not known";

#[rustfmt::skip]
static TABLE: [Row; 43] = [
    row("launched", "", LAUNCH, |run, _, _| f64::from(u8::from(run.failure == Failure::None && run.end.is_finite())),
        "Whether the net was launched: 1 or 0."),
    row("failure", "", NOTHING, |run, _, _| run.failure.code(), "Why the mission failed: <failures>."),
    row("phase_final", "", NOTHING, |_, guidance, _| guidance.phase as f64,
        "The phase in which the run ended: <phases>."),
    row("end_time_s", "s", NOTHING, |run, _, _| run.end,
        "Time at which the mission launched or failed; null if it did neither."),
    row("phase_<phase>_begin_s", "s", NOTHING, |_, guidance, phase| guidance.first_begun[phase],
        "Time at which phase <phase> first began; null if it never did."),
    row("pointing_error_final_rad", "rad", TARGET, |run, _, _| run.pointing_error,
        "Rotation angle from the true attitude to the target of the last phase that had one, at the last tick."),
    row("settling_time_s", "s", TARGET, |run, _, _| run.settled_since - run.pointing_since,
        "Time from the beginning of the last phase with a target until the pointing error stayed within \
        control.settling_band_rad; null if it never did."),
    row("overshoot_rad", "rad", TARGET, 
        |run, _, _| if run.pointing_since.is_nan() { f64::NAN } else { run.overshoot },
        "Largest angle beyond the target, against the direction of the error with which the last phase with a target \
        began."),
    row("mission_settling_time_s", "s", TARGET, |run, _, _| run.stability.settled_since,
        "Time from the start of the run until the pointing error stayed within control.settling_band_rad to the end, \
        in all phases from then on; null if it never did."),
    row("relative_performance_error_rms_rad", "rad", TARGET, |run, _, _| run.relative_error(0),
        "Relative performance error (ECSS-E-ST-60-10C): root mean square magnitude of the rotation vector from the \
        target to the true attitude less its mean over the ticks of the window of control.stability_from_s and \
        control.stability_window_s; null if the run does not complete the window, or a phase in it has no target."),
    row("relative_performance_error_peak_to_peak_rad", "rad", TARGET,
        |run, _, _| run.relative_error(1),
        "Relative performance error (ECSS-E-ST-60-10C): largest peak to peak, about any body axis, of the rotation \
        vector from the target to the true attitude less its mean over the ticks of the window of \
        control.stability_from_s and control.stability_window_s; null if the run does not complete the window, or a \
        phase in it has no target."),
    row("debris_distance_min_m", "m", APPROACH, |run, _, _| finite(run.debris_distance),
        "Smallest distance between the centres of mass of spacecraft and debris at the ticks."),
    row("pointing_error_launch_rad", "rad", LAUNCH_AT_DEBRIS, |run, _, _| run.launch(|at| at.pointing_error),
        "Angle between s3 and the line to the debris at the launch; null if not launched."),
    row("axis_offset_launch_m", "m", LAUNCH_AT_DEBRIS, |run, _, _| run.launch(|at| at.axis_offset),
        "Distance of the centre of mass from the line through the debris along its velocity at the launch; null if not \
        launched."),
    row("distance_error_launch_m", "m", LAUNCH_AT_DEBRIS, |run, _, _| run.launch(|at| at.distance_error),
        "Distance behind the debris along that line less control.launch_distance_m at the launch; null if not \
        launched."),
    row("relative_speed_launch_m_s", "m/s", LAUNCH_AT_DEBRIS, |run, _, _| run.launch(|at| at.relative_speed),
        "Speed relative to the debris at the launch; null if not launched."),
    row("body_rate_launch_rad_s", "rad/s", LAUNCH_AT_DEBRIS, |run, _, _| run.launch(|at| at.body_rate),
        "Magnitude of the angular velocity of the body relative to F_e at the launch; null if not launched."),
    row("tumble_axis_angle_launch_rad", "rad", LAUNCH_AT_DEBRIS, |run, _, _| run.launch(|at| at.momentum_angle),
        "Angle, 0 to pi/2, between the angular momentum of the debris and the launch axis at the launch; null if not \
        launched."),
    row("wheel_speed_margin_launch_rad_s", "rad/s", LAUNCH_WITH_WHEELS,
        |run, _, _| run.launch(|at| finite(at.speed_margin)),
        "Smallest difference between a wheel's speed limit and its speed at the launch; null if not launched."),
    row("impulse_<thruster>_n_s", "N s", THRUSTERS, |run, _, thruster| run.impulse[thruster],
        "Impulse of thruster <thruster>, fired by the loop."),
    row("impulse_total_n_s", "N s", THRUSTERS, |run, _, _| run.impulse_total(),
        "Sum of the impulses of all thrusters, fired by the loop."),
    row("delta_v_m_s", "m/s", THRUSTERS, |run, _, _| run.velocity_change,
        "Integral of the magnitude of the acceleration from thrust."),
    row("propellant_kg", "kg", THRUSTERS,
        |run, _, _| finite(run.impulse_total() / (STANDARD_GRAVITY * run.criteria.isp)),
        "Propellant used at control.isp_s; null if that is not known. The mass of the spacecraft is constant."),
    row("plume_time_s", "s", PLUMES, |run, _, _| run.plume_time,
        "Time during which a thruster fired at debris within control.plume_range_m and control.plume_half_angle_rad of \
        its plume's axis, by the state at the start of each arc."),
    row("speed_peak_<wheel>_rad_s", "rad/s", WHEELS, |run, _, wheel| run.speed_peak[wheel],
        "Largest magnitude of the rate of wheel <wheel> relative to the body at the ticks."),
    row("wheel_momentum_peak_n_m_s", "N m s", WHEELS, |run, _, _| run.momentum_peak,
        "Largest magnitude of the wheels' momentum relative to the body at the ticks."),
    row("torque_saturated_s", "s", WHEELS, |run, _, _| run.saturated[0],
        "Time during which a motor gave less than was commanded because of its torque limit."),
    row("speed_saturated_s", "s", WHEELS, |run, _, _| run.saturated[1],
        "Time during which a motor gave less than was commanded because of its wheel's speed limit."),
    row("torque_excess_max_n_m", "N m", WHEELS, |run, _, _| run.torque_excess,
        "Largest difference between the commanded torque and what a motor gave, because of its torque limit or its \
        wheel's speed limit."),
    row("rod_dipole_max_a_m2", "A m^2", RODS, |run, _, _| run.rod_dipole,
        "Largest magnitude of the dipole of all torque rods together."),
    row("rod_saturated_time_s", "s", RODS, |run, _, _| run.rod_saturated,
        "Time during which the limit of a torque rod cut what the law commanded."),
    row("attitude_estimate_error_final_rad", "rad", NOTHING, |run, _, _| run.attitude_error[0],
        "Angle between estimated and true attitude at the last tick."),
    row("attitude_estimate_error_max_rad", "rad", NOTHING, |run, _, _| run.attitude_error[1],
        "Largest angle between estimated and true attitude at the ticks."),
    row("relative_position_estimate_error_final_m", "m", APPROACH, |run, _, _| run.relative_error[0],
        "Distance between estimated and true position relative to the debris at the last tick."),
    row("relative_velocity_estimate_error_final_m_s", "m/s", APPROACH, |run, _, _| run.relative_error[1],
        "Magnitude of the error in the estimated velocity relative to the debris at the last tick."),
    row("attitude_nees_final", "", FILTER, |run, _, _| run.consistency.squares[0][0],
        "Normalised square of the estimation error of attitude and gyro bias (or rate) at the last tick, <per \
        degree>."),
    row("attitude_innovation_mean", "", FILTER, |run, _, _| run.consistency.squares[0][2],
        "Mean normalised square of the innovations of attitude and gyro bias (or rate), <per degree>."),
    row("motion_nees_final", "", FILTER_OF_MOTION, |run, _, _| run.consistency.squares[1][0],
        "Normalised square of the estimation error of position and velocity at the last tick, <per degree>."),
    row("motion_innovation_mean", "", FILTER_OF_MOTION, |run, _, _| run.consistency.squares[1][2],
        "Mean normalised square of the innovations of position and velocity, <per degree>."),
    row("debris_motion_nees_final", "", FILTER_OF_MOTION, |run, _, _| run.consistency.squares[2][0],
        "Normalised square of the estimation error of position and velocity of the debris at the last tick, <per \
        degree>."),
    row("debris_motion_innovation_mean", "", FILTER_OF_MOTION, |run, _, _| run.consistency.squares[2][2],
        "Mean normalised square of the innovations of position and velocity of the debris, <per degree>."),
    row("debris_attitude_nees_final", "", FILTER_OF_MOTION, |run, _, _| run.consistency.squares[3][0],
        "Normalised square of the estimation error of attitude and rate of the debris at the last tick, <per degree>."),
    row("debris_attitude_innovation_mean", "", FILTER_OF_MOTION, |run, _, _| run.consistency.squares[3][2],
        "Mean normalised square of the innovations of attitude and rate of the debris, <per degree>."),
];

/// Columns of each telemetry number that a module declares, appended to its own unit and meaning.
static TELEMETRY: [Row; 2] = [
    row(
        "module_<telemetry>_final",
        "",
        MODULE,
        |run, _, place| run.telemetry(place, 0),
        "telemetry of the module at the last tick at which it was asked; null if it never was, or if this is not a \
        finite number.",
    ),
    row(
        "module_<telemetry>_max",
        "",
        MODULE,
        |run, _, place| run.telemetry(place, 1),
        "largest magnitude of that telemetry of the module at the ticks; null if it was never asked, or if one of them \
        is not a finite number.",
    ),
];

/// Integer columns, with the names of their codes.
const COUNTS: [(&str, &[&str]); 3] = [("launched", &[]), ("failure", &Failure::NAMES), ("phase_final", &[])];

/// Names of phases, thrusters and wheels with their indices, by placeholder.
type Names = [(&'static str, Vec<(usize, String)>); 3];

impl Row {
    /// Its columns, each with the index for its value.
    fn columns(&self, names: &Names) -> Vec<(Quantity, usize)> {
        let coded = |names: &mut dyn Iterator<Item = (usize, &str)>| {
            names.map(|(code, name)| format!("{code} {name}")).collect::<Vec<_>>().join(", ")
        };
        let phases = coded(&mut names[0].1.iter().map(|(place, name)| (*place, name.as_str())));
        let failures = coded(&mut Failure::NAMES.into_iter().enumerate());
        let meaning = self.meaning.replace("<phases>", &phases).replace("<failures>", &failures);
        let meaning = meaning.replace("<per degree>", PER_DEGREE);
        let column = |name: String, meaning| Quantity::named(name, self.unit.to_owned(), meaning);
        match names.iter().find(|(mark, _)| self.name.contains(mark)) {
            None => vec![(column(self.name.to_owned(), meaning), 0)],
            Some((mark, names)) => {
                let of = |(place, name): &(usize, String)| {
                    (column(self.name.replace(mark, name), meaning.replace(mark, name)), *place)
                };
                names.iter().map(of).collect()
            }
        }
    }
}

/// With their rows and indices.
pub struct OutcomeColumns(Vec<(Quantity, &'static Row, usize)>);

impl OutcomeColumns {
    pub fn of(spec: &LoopSpec) -> Self {
        let names = |places: &[usize], names: &[crate::scene::Name]| {
            places.iter().map(|place| (*place, names[*place].to_string())).collect()
        };
        let phases = spec.phases.iter().enumerate().map(|(place, phase)| (place, phase.name.to_string()));
        let names = [
            ("<phase>", phases.collect()),
            ("<thruster>", names(&spec.thrusters, &spec.thruster_names)),
            ("<wheel>", names(&spec.wheels, &spec.wheel_names)),
        ];
        let mut columns = Self::named(&names, |Needs(_, are_met)| are_met(spec));
        for (place, declared) in spec.telemetry().iter().enumerate() {
            columns.0.extend(TELEMETRY.iter().zip(["_final", "_max"]).map(|(row, of)| {
                let meaning = format!("{}: {}", declared.meaning, row.meaning);
                let unit = declared.unit_of_column().to_owned();
                (Quantity::named(declared.column(of), unit, meaning), row, place)
            }));
        }
        columns
    }

    fn named(names: &Names, is_there: impl Fn(&Needs) -> bool) -> Self {
        let of = |row: &'static Row| row.columns(names).into_iter().map(move |(column, place)| (column, row, place));
        OutcomeColumns(TABLE.iter().filter(|row| is_there(&row.needs)).flat_map(of).collect())
    }

    /// Columns of any loop, each with its needs; placeholders stand for names.
    pub fn of_all_loops() -> Vec<(Quantity, &'static str)> {
        let names = ["<phase>", "<thruster>", "<wheel>"].map(|mark| (mark, vec![(0, mark.to_owned())]));
        let of_loop = Self::named(&names, |_| true).0.into_iter().map(|(column, row, _)| (column, row));
        let of_module = TELEMETRY.iter().map(|row| (Quantity::new(row.name, row.unit, row.meaning), row));
        of_loop.chain(of_module).map(|(column, row)| (column, row.needs.0)).collect()
    }

    pub fn columns(&self) -> LawColumns {
        let column = |(quantity, row, _): &(Quantity, &Row, usize)| {
            let count = COUNTS.iter().find(|(name, _)| *name == row.name);
            let kind = if count.is_some() { ColumnKind::Count } else { ColumnKind::Float };
            LawColumn { quantity: quantity.clone(), kind, codes: count.map_or(&[], |(_, codes)| codes) }
        };
        LawColumns::kept(self.0.iter().map(column).collect())
    }

    pub fn report(&self, outcome: &MissionOutcome, guidance: &Guidance, values: &mut [f64]) {
        for (value, (_, row, place)) in values.iter_mut().zip(&self.0) {
            *value = (row.value)(outcome, guidance, *place);
        }
    }
}
