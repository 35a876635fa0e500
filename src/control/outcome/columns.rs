//! [`OutcomeColumns`]: the columns of rows that say what a run under a loop has come to.

use super::stability::Stability;
use super::{MissionCriteria, MissionOutcome, STANDARD_GRAVITY};
use crate::control::estimators::kalman::NormalizedSquare;
use crate::control::estimators::{self, Consistency};
use crate::control::guidance::phase::{Maneuver, Next};
use crate::control::guidance::target::Target;
use crate::control::guidance::{Failure, Guidance};
use crate::control::laws::rod_law::RodUse;
use crate::control::net_launch::launch::AtLaunch;
use crate::control::spec::{LoopSpec, ModelSpec, PhaseSpec};
use crate::observables::{ColumnKind, LawColumn, LawColumns};
use crate::run::Quantity;
use crate::scene::Name;

/// A column: name, unit, meaning, what it is of a run.
struct OutcomeColumn {
    quantity: Quantity,
    kind: ColumnKind,
    codes: &'static [&'static str],
    value: Value,
    needs: &'static str,
}

/// What a loop has to have for a column.
mod need {
    pub const NOTHING: &str = "";
    pub const LAUNCH: &str = "needs a phase with next = \"launch\"";
    pub const TARGET: &str = "needs a phase with a target";
    pub const APPROACH: &str = "needs debris, and a phase that points or moves relative to it";
    pub const LAUNCH_AT_DEBRIS: &str = "needs debris, and a phase with next = \"launch\"";
    pub const LAUNCH_WITH_WHEELS: &str = "needs debris, a phase with next = \"launch\", and wheels";
    pub const THRUSTERS: &str = "needs thrusters in control.thrusters";
    pub const PLUMES: &str = "needs debris that a phase approaches, and thrusters in control.thrusters";
    pub const RODS: &str = "needs torque rods in control.torque_rods";
    pub const WHEELS: &str = "needs wheels in control.wheels";
    pub const FILTER: &str = "needs an estimator with a filter: mekf";
    pub const FILTER_OF_MOTION: &str = "needs an estimator with a filter: mekf, and debris that a phase approaches";
}

/// The columns of the runs of a loop.
pub struct OutcomeColumns(Vec<OutcomeColumn>);

impl std::fmt::Debug for OutcomeColumns {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("OutcomeColumns").field(&self.0.len()).finish()
    }
}

/// A value that stands for "never" or "none", as null.
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::NAN }
}

impl OutcomeColumns {
    /// Those of runs of `spec`.
    pub fn of(spec: &LoopSpec) -> Self {
        let mut list = Vec::new();
        let mut add = |needs: &'static str, name: String, unit: &str, meaning: String, value: Value| {
            let quantity = Quantity::named(name, unit.to_owned(), meaning);
            list.push(OutcomeColumn { quantity, kind: ColumnKind::Float, codes: &[], value, needs });
        };
        mission(spec, &mut add);
        if spec.points() {
            pointing(&mut add);
        }
        if spec.approaches() {
            approach(spec, &mut add);
        }
        if !spec.thrusters.is_empty() {
            thrust(spec, &mut add);
        }
        if !spec.wheels.is_empty() {
            wheel(spec, &mut add);
        }
        if !spec.rods.is_empty() {
            rods(&mut add);
        }
        estimation(spec, &mut add);
        for column in &mut list {
            match column.quantity.name() {
                "launched" => column.kind = ColumnKind::Count,
                "failure" => (column.kind, column.codes) = (ColumnKind::Count, &Failure::NAMES),
                "phase_final" => column.kind = ColumnKind::Count,
                _ => {}
            }
        }
        OutcomeColumns(list)
    }

    /// Those that any loop has, each with what it needs; `<phase>`, `<wheel>` and `<thruster>` stand for names.
    pub fn of_all_loops() -> Vec<(Quantity, &'static str)> {
        let [phase, wheel, thruster] = ["phase_name", "wheel_name", "thruster_name"].map(Name::of);
        let phase = PhaseSpec {
            name: phase,
            law: None,
            gyroscopic: false,
            target: Target::LineToDebris,
            thrust: Maneuver::None,
            rods: RodUse::None,
            until: None,
            next: Next::Launch,
            otherwise: None,
        };
        let estimator = estimators::KINDS.iter().position(|kind| kind.has_filter).unwrap_or_default();
        let spec = LoopSpec {
            period: 1.0,
            estimator,
            wheels: vec![0],
            thrusters: vec![0],
            rods: vec![0],
            modulation: 0,
            holds_force: false,
            sensors: Vec::new(),
            phases: vec![phase],
            model: ModelSpec::default(),
            has_debris: true,
            wheel_names: vec![wheel],
            thruster_names: vec![thruster],
            rod_names: vec![Name::of("rod")],
        };
        let placed = |text: &str| {
            ["phase", "wheel", "thruster"]
                .iter()
                .fold(text.to_owned(), |text, what| text.replace(&format!("{what}_name"), &format!("<{what}>")))
        };
        let column = |one: OutcomeColumn| {
            let (name, meaning) = (placed(one.quantity.name()), placed(one.quantity.meaning()));
            (Quantity::named(name, one.quantity.unit().to_owned(), meaning), one.needs)
        };
        OutcomeColumns::of(&spec).0.into_iter().map(column).collect()
    }

    /// As columns of rows.
    pub fn columns(&self) -> LawColumns {
        let column =
            |one: &OutcomeColumn| LawColumn { quantity: one.quantity.clone(), kind: one.kind, codes: one.codes };
        LawColumns::kept(self.0.iter().map(column).collect())
    }

    /// Writes their values of a run.
    pub fn report(
        &self,
        outcome: &MissionOutcome,
        guidance: &Guidance,
        criteria: &MissionCriteria,
        values: &mut [f64],
    ) {
        for (value, column) in values.iter_mut().zip(&self.0) {
            *value = (column.value)(outcome, guidance, criteria);
        }
    }
}

type Value = Box<dyn Fn(&MissionOutcome, &Guidance, &MissionCriteria) -> f64 + Send + Sync>;
type Add<'a> = dyn FnMut(&'static str, String, &str, String, Value) + 'a;

/// Adds a column whose value needs the outcome alone.
fn plain(
    add: &mut Add<'_>,
    needs: &'static str,
    name: &str,
    unit: &str,
    meaning: &str,
    value: fn(&MissionOutcome) -> f64,
) {
    add(needs, name.to_owned(), unit, meaning.to_owned(), Box::new(move |outcome, _, _| value(outcome)));
}

fn mission(spec: &LoopSpec, add: &mut Add<'_>) {
    if spec.launches() {
        plain(add, need::LAUNCH, "launched", "", "Whether the net was launched: 1 or 0.", |o| {
            f64::from(u8::from(o.failure == Failure::None && o.end.is_finite()))
        });
    }
    let codes: Vec<String> = Failure::NAMES.iter().enumerate().map(|(code, name)| format!("{code} {name}")).collect();
    let meaning = format!("Why the mission failed: {}.", codes.join(", "));
    add(need::NOTHING, "failure".into(), "", meaning, Box::new(|o, _, _| o.failure.code()));
    let names: Vec<String> =
        spec.phases.iter().enumerate().map(|(place, phase)| format!("{place} {}", phase.name)).collect();
    let meaning = format!("The phase in which the run ended: {}.", names.join(", "));
    add(need::NOTHING, "phase_final".into(), "", meaning, Box::new(|_, guidance, _| guidance.phase as f64));
    plain(
        add,
        need::NOTHING,
        "end_time_s",
        "s",
        "Time at which the mission launched or failed; null where it did neither.",
        |o| o.end,
    );
    for (place, phase) in spec.phases.iter().enumerate() {
        let meaning = format!("Time at which phase {} first began; null where it did not.", phase.name);
        let value: Value = Box::new(move |_, guidance, _| guidance.first_begun[place]);
        add(need::NOTHING, format!("phase_{}_begin_s", phase.name), "s", meaning, value);
    }
}

fn pointing(add: &mut Add<'_>) {
    plain(
        add,
        need::TARGET,
        "pointing_error_final_rad",
        "rad",
        "Angle of the rotation from the true attitude to the target of the last phase that had one, at the last tick.",
        |o| o.pointing_error,
    );
    plain(
        add,
        need::TARGET,
        "settling_time_s",
        "s",
        "Time from the beginning of the last phase with a target until the pointing error stayed within control.settling_band_rad; null where it did not.",
        |o| o.settled_since - o.pointing_since,
    );
    plain(
        add,
        need::TARGET,
        "overshoot_rad",
        "rad",
        "Largest angle beyond the target, against the direction of the error with which the last phase with a target began.",
        |o| {
            if o.pointing_since.is_nan() { f64::NAN } else { o.overshoot }
        },
    );
    plain(
        add,
        need::TARGET,
        "mission_settling_time_s",
        "s",
        "Time from the start of the run until the pointing error stayed within control.settling_band_rad to the end, in all phases from then on; null where it did not.",
        |o| o.stability.settled_since(),
    );
    let mut over_window = |name: &str, what: &str, value: fn(&Stability, &MissionCriteria) -> f64| {
        let meaning = format!(
            "Relative performance error (ECSS-E-ST-60-10C), {what}, of the rotation vector from the target to the true attitude less its mean over the ticks of the window of control.stability_from_s and control.stability_window_s; null where the run does not complete it, or a phase in it has no target."
        );
        add(need::TARGET, name.into(), "rad", meaning, Box::new(move |o, _, criteria| value(&o.stability, criteria)));
    };
    over_window("relative_performance_error_rms_rad", "root mean square of the magnitude", Stability::rms);
    over_window(
        "relative_performance_error_peak_to_peak_rad",
        "largest peak to peak about an axis of the body",
        Stability::peak_to_peak,
    );
}

fn approach(spec: &LoopSpec, add: &mut Add<'_>) {
    plain(
        add,
        need::APPROACH,
        "debris_distance_min_m",
        "m",
        "Smallest distance between the centres of mass of spacecraft and debris at the ticks.",
        |o| finite(o.debris_distance),
    );
    if !spec.launches() {
        return;
    }
    let mut at = |needs: &'static str, name: &str, unit: &str, meaning: &str, value: fn(&AtLaunch) -> f64| {
        let value: Value = Box::new(move |o, _, _| o.at_launch.as_ref().map_or(f64::NAN, value));
        add(needs, name.to_owned(), unit, format!("{meaning} at the launch; null if not launched."), value);
    };
    at(
        need::LAUNCH_AT_DEBRIS,
        "pointing_error_launch_rad",
        "rad",
        "Angle between s3 and the line to the debris",
        |l| l.pointing_error,
    );
    at(
        need::LAUNCH_AT_DEBRIS,
        "axis_offset_launch_m",
        "m",
        "Distance of the centre of mass from the line through the debris along its velocity",
        |l| l.axis_offset,
    );
    at(
        need::LAUNCH_AT_DEBRIS,
        "distance_error_launch_m",
        "m",
        "Distance behind the debris along that line less control.launch_distance_m",
        |l| l.distance_error,
    );
    at(need::LAUNCH_AT_DEBRIS, "relative_speed_launch_m_s", "m/s", "Speed relative to the debris", |l| {
        l.relative_speed
    });
    at(
        need::LAUNCH_AT_DEBRIS,
        "body_rate_launch_rad_s",
        "rad/s",
        "Magnitude of the angular velocity of the body relative to F_e",
        |l| l.body_rate,
    );
    at(
        need::LAUNCH_AT_DEBRIS,
        "tumble_axis_angle_launch_rad",
        "rad",
        "Angle, 0 to pi/2, between the angular momentum of the debris and the launch axis",
        |l| l.momentum_angle,
    );
    if !spec.wheels.is_empty() {
        at(
            need::LAUNCH_WITH_WHEELS,
            "wheel_speed_margin_launch_rad_s",
            "rad/s",
            "Smallest difference between the limit of a wheel's speed and its speed",
            |l| finite(l.speed_margin),
        );
    }
}

fn rods(add: &mut Add<'_>) {
    plain(
        add,
        need::RODS,
        "rod_dipole_max_a_m2",
        "A m^2",
        "Largest magnitude of the dipole of all torque rods together.",
        |o| o.rod_dipole,
    );
    plain(
        add,
        need::RODS,
        "rod_saturated_time_s",
        "s",
        "Time in which the limit of a torque rod cut what the law wanted.",
        |o| o.rod_saturated,
    );
}

fn thrust(spec: &LoopSpec, add: &mut Add<'_>) {
    for &i in &spec.thrusters {
        let name = spec.thruster_names[i];
        let meaning = format!("Impulse of thruster {name}, fired by the loop.");
        add(need::THRUSTERS, format!("impulse_{name}_n_s"), "N s", meaning, Box::new(move |o, _, _| o.impulse[i]));
    }
    plain(
        add,
        need::THRUSTERS,
        "impulse_total_n_s",
        "N s",
        "Sum of the impulses of all thrusters, fired by the loop.",
        MissionOutcome::impulse_total,
    );
    plain(
        add,
        need::THRUSTERS,
        "delta_v_m_s",
        "m/s",
        "Integral of the magnitude of the acceleration by thrust.",
        |o| o.velocity_change,
    );
    let meaning =
        "Propellant used at control.isp_s; null where that is not known. The mass of the spacecraft is constant.";
    let propellant = |o: &MissionOutcome, _: &Guidance, criteria: &MissionCriteria| {
        finite(o.impulse_total() / (STANDARD_GRAVITY * criteria.isp))
    };
    add(need::THRUSTERS, "propellant_kg".into(), "kg", meaning.into(), Box::new(propellant));
    if spec.approaches() {
        plain(
            add,
            need::PLUMES,
            "plume_time_s",
            "s",
            "Time in which a thruster fired at debris within control.plume_range_m and control.plume_half_angle_rad of its plume's axis, by the state at the start of each arc.",
            |o| o.plume_time,
        );
    }
}

fn wheel(spec: &LoopSpec, add: &mut Add<'_>) {
    for &i in &spec.wheels {
        let name = spec.wheel_names[i];
        let meaning = format!("Largest magnitude of the rate of wheel {name} relative to the body at the ticks.");
        add(
            need::WHEELS,
            format!("speed_peak_{name}_rad_s"),
            "rad/s",
            meaning,
            Box::new(move |o, _, _| o.speed_peak[i]),
        );
    }
    plain(
        add,
        need::WHEELS,
        "wheel_momentum_peak_n_m_s",
        "N m s",
        "Largest magnitude of the wheels' momentum relative to the body at the ticks.",
        |o| o.momentum_peak,
    );
    plain(
        add,
        need::WHEELS,
        "torque_saturated_s",
        "s",
        "Time in which a motor gave less than was commanded because of its limit of torque.",
        |o| o.saturated[0],
    );
    plain(
        add,
        need::WHEELS,
        "speed_saturated_s",
        "s",
        "Time in which a motor gave less than was commanded because of the limit of its wheel's speed.",
        |o| o.saturated[1],
    );
    plain(
        add,
        need::WHEELS,
        "torque_excess_max_n_m",
        "N m",
        "Largest torque that was commanded beyond what a motor gave, because of its limit of torque or of its wheel's speed.",
        |o| o.torque_excess,
    );
}

fn estimation(spec: &LoopSpec, add: &mut Add<'_>) {
    plain(
        add,
        need::NOTHING,
        "attitude_estimate_error_final_rad",
        "rad",
        "Angle between estimated and true attitude at the last tick.",
        |o| o.attitude_error[0],
    );
    plain(
        add,
        need::NOTHING,
        "attitude_estimate_error_max_rad",
        "rad",
        "Largest angle between estimated and true attitude at the ticks.",
        |o| o.attitude_error[1],
    );
    if spec.approaches() {
        plain(
            add,
            need::APPROACH,
            "relative_position_estimate_error_final_m",
            "m",
            "Distance between estimated and true position relative to the debris at the last tick.",
            |o| o.relative_error[0],
        );
        plain(
            add,
            need::APPROACH,
            "relative_velocity_estimate_error_final_m_s",
            "m/s",
            "Magnitude of the error of the estimated velocity relative to the debris at the last tick.",
            |o| o.relative_error[1],
        );
    }
    if !spec.has_filter() {
        return;
    }
    // what the covariance of a filter says of its errors: normalised squares, over their degrees of freedom
    let mut of_filter = |needs: &'static str,
                         place: usize,
                         name: &str,
                         what: &str,
                         value: fn(&Consistency) -> Option<NormalizedSquare>| {
        let is = "over its degrees of freedom: 1 on average where the filter is right; null where it is not known";
        add(
            needs,
            format!("{name}_nees_final"),
            "",
            format!("Normalised square of the estimation error of {what} at the last tick, {is}."),
            Box::new(move |o, _, _| {
                value(&o.consistency).map_or(f64::NAN, |square| square.value / square.degrees as f64)
            }),
        );
        add(
            needs,
            format!("{name}_innovation_mean"),
            "",
            format!("Mean normalised square of the innovations of {what}, {is}."),
            Box::new(move |o, _, _| o.consistency.mean_innovations[place].unwrap_or(f64::NAN)),
        );
    };
    of_filter(need::FILTER, 0, "attitude", "attitude and gyro bias (or rate)", |c| c.attitude);
    if spec.approaches() {
        of_filter(need::FILTER_OF_MOTION, 1, "motion", "position and velocity", |c| c.motion);
        of_filter(need::FILTER_OF_MOTION, 2, "debris_motion", "position and velocity of the debris", |c| {
            c.debris_motion
        });
        of_filter(need::FILTER_OF_MOTION, 3, "debris_attitude", "attitude and rate of the debris", |c| c.debris);
    }
}
