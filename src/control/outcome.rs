//! [`MissionOutcome`]: what a run under a loop has come to, from the true state at every tick; and the columns that say it.

use super::estimate::EstimateErrors;
use super::estimators::Consistency;
use super::estimators::kalman::NormalizedSquare;
use super::guidance::geometry::{Centers, LaunchState};
use super::guidance::target::AttitudeError;
use super::guidance::{Failure, Guidance};
use super::spec::LoopSpec;
use super::truth::Truth;
use crate::control::rotation::vector_of;
use crate::control::vector::{cross, dcm_from_quaternion, dot, norm, product, scaled};
use crate::observables::{ColumnKind, LawColumn, LawColumns};
use crate::run::Quantity;
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS, Scene};

/// The numbers of a run with which its outcome is judged.
#[derive(Clone, Copy, Debug)]
pub struct Judgement {
    /// The launch state.
    pub launch: LaunchState,
    /// Distance from the debris below which the mission fails, m.
    pub keep_out: f64,
    /// Distance and half angle of a plume that hits the debris, m and rad.
    pub plume: [f64; 2],
    /// Pointing error of an attitude that has settled, rad.
    pub settling_band: f64,
    /// Specific impulse, s; zero where it is not known.
    pub isp: f64,
}

/// Standard gravity, by which a specific impulse is an exhaust velocity, m/s^2 (ISO 80000-3).
const STANDARD_GRAVITY: f64 = 9.806_65;

/// What is true at the launch.
#[derive(Clone, Copy, Debug)]
struct AtLaunch {
    pointing_error: f64,
    axis_offset: f64,
    distance_error: f64,
    relative_speed: f64,
    body_rate: f64,
    momentum_angle: f64,
    speed_margin: f64,
}

/// What a run has come to.
#[derive(Clone, Debug)]
pub struct MissionOutcome {
    failure: Failure,
    end: f64,
    at_launch: Option<AtLaunch>,
    /// Largest rotation to the target after it was first passed, rad, and the direction of the error with which the phase began.
    overshoot: f64,
    first_error: Option<[f64; 3]>,
    /// Since when the pointing error has been within the band, s; NaN while it is not.
    settled_since: f64,
    pointing_since: f64,
    pointing_error: f64,
    /// N s, by thruster.
    impulse: [f64; MAX_THRUSTERS],
    velocity_change: f64,
    debris_distance: f64,
    plume_time: f64,
    speed_peak: [f64; MAX_WHEELS],
    momentum_peak: f64,
    /// Time in which a motor gave less than was commanded: by its limit of torque, by that of speed, s.
    saturated: [f64; 2],
    torque_excess: f64,
    attitude_error: [f64; 2],
    relative_error: [f64; 2],
    consistency: Consistency,
}

/// What an arc has applied, for the sums of a run.
#[derive(Clone, Copy, Debug)]
pub struct ArcApplied {
    /// Its length, s.
    pub length: f64,
    /// Thrusts, N.
    pub thrust: [f64; MAX_THRUSTERS],
    /// Whether the plume of one that fires hits the debris.
    pub hits: bool,
    /// Whether a motor was limited by its torque, and by the speed of its wheel.
    pub saturated: [bool; 2],
    /// Largest commanded torque beyond a limit, N m.
    pub torque_excess: f64,
}

impl MissionOutcome {
    /// At the start.
    pub fn new() -> Self {
        MissionOutcome {
            failure: Failure::None,
            end: f64::NAN,
            at_launch: None,
            overshoot: 0.0,
            first_error: None,
            settled_since: f64::NAN,
            pointing_since: f64::NAN,
            pointing_error: f64::NAN,
            impulse: [0.0; MAX_THRUSTERS],
            velocity_change: 0.0,
            debris_distance: f64::INFINITY,
            plume_time: 0.0,
            speed_peak: [0.0; MAX_WHEELS],
            momentum_peak: 0.0,
            saturated: [0.0; 2],
            torque_excess: 0.0,
            attitude_error: [0.0; 2],
            relative_error: [f64::NAN; 2],
            consistency: Consistency::default(),
        }
    }

    /// Takes the truth of a tick. `error` is the true attitude relative to the target of the phase, `None` without one; `begins`: the phase has just begun.
    pub fn tick(
        &mut self,
        scene: &Scene,
        truth: &Truth,
        (error, begins): (Option<&AttitudeError>, bool),
        (errors, consistency): (&EstimateErrors, &Consistency),
        judgement: &Judgement,
    ) {
        if let Some(error) = error {
            self.pointing(truth.time, error, begins, judgement.settling_band);
        }
        let mut momentum = [0.0; 3];
        for (i, wheel) in scene.mass.wheels.iter().enumerate() {
            let rate = truth.wheels.rates[i];
            self.speed_peak[i] = self.speed_peak[i].max(rate.abs());
            momentum = crate::control::vector::sum(momentum, scaled(wheel.axial * rate, wheel.axis));
        }
        self.momentum_peak = self.momentum_peak.max(norm(momentum));
        if let Some(debris) = &truth.debris {
            let apart = crate::control::vector::difference(debris.r_gdo_e, truth.body.r_co_e);
            self.debris_distance = self.debris_distance.min(norm(apart));
        }
        self.attitude_error = [errors.attitude, self.attitude_error[1].max(errors.attitude)];
        self.relative_error = [errors.relative_position, errors.relative_velocity];
        self.consistency = *consistency;
    }

    fn pointing(&mut self, time: f64, error: &AttitudeError, begins: bool, band: f64) {
        let vector = vector_of(error.q_ts);
        let angle = norm(vector);
        if begins || self.first_error.is_none() {
            self.first_error = (angle > 0.0).then(|| scaled(1.0 / angle, vector));
            (self.overshoot, self.settled_since, self.pointing_since) = (0.0, f64::NAN, time);
        }
        if let Some(first) = self.first_error {
            self.overshoot = self.overshoot.max(-dot(first, vector));
        }
        self.pointing_error = angle;
        if angle > band {
            self.settled_since = f64::NAN;
        } else if self.settled_since.is_nan() {
            self.settled_since = time;
        }
    }

    /// Takes an arc of a run of `scene`.
    pub fn arc(&mut self, scene: &Scene, applied: &ArcApplied) {
        for (which, is_saturated) in applied.saturated.into_iter().enumerate() {
            self.saturated[which] += if is_saturated { applied.length } else { 0.0 };
        }
        self.torque_excess = self.torque_excess.max(applied.torque_excess);
        if applied.thrust == [0.0; MAX_THRUSTERS] {
            return;
        }
        for (impulse, thrust) in self.impulse.iter_mut().zip(applied.thrust) {
            *impulse += thrust * applied.length;
        }
        let force = norm(scene.thruster_force_s(applied.thrust));
        self.velocity_change += force * applied.length / scene.mass.total;
        self.plume_time += if applied.hits { applied.length } else { 0.0 };
    }

    /// Whether the plume of a thruster that fires at `thrust` in the state `truth` hits the debris.
    pub fn plume_hits(
        &self,
        scene: &Scene,
        truth: &Truth,
        thrust: &[f64; MAX_THRUSTERS],
        judgement: &Judgement,
    ) -> bool {
        let firing = scene.thrusters.iter().zip(thrust).filter(|(_, thrust)| **thrust > 0.0);
        firing.into_iter().any(|(thruster, _)| plume_hits(truth, thruster.direction, judgement.plume))
    }

    /// A command is no finite number at `time`, s.
    pub fn diverges(&mut self, time: f64) {
        (self.end, self.failure) = (time, Failure::Diverged);
    }

    /// The run ends at `truth`, launched or failed.
    pub fn ends(&mut self, scene: &Scene, truth: &Truth, failure: Failure, launch: &LaunchState) {
        self.end = truth.time;
        self.failure = failure;
        if failure == Failure::None {
            self.at_launch = at_launch(scene, truth, launch);
        }
    }
}

/// Whether the plume of a thruster that pushes along `direction` (F_s) hits the debris: it leaves against its push.
fn plume_hits(truth: &Truth, direction: [f64; 3], [range, half_angle]: [f64; 2]) -> bool {
    let Some(debris) = &truth.debris else { return false };
    let to_debris = crate::control::vector::difference(debris.r_gdo_e, truth.body.r_co_e);
    let distance = norm(to_debris);
    let plume = scaled(-1.0, product(dcm_from_quaternion(truth.body.q_es), direction));
    distance < range && libm::atan2(norm(cross(plume, to_debris)), dot(plume, to_debris)) < half_angle
}

/// The angle between two vectors, rad.
fn angle_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    libm::atan2(norm(cross(a, b)), dot(a, b))
}

/// The centres of mass at `truth`; `None` without debris.
pub fn centers_of(truth: &Truth) -> Option<Centers> {
    let debris = truth.debris.as_ref()?;
    let body = &truth.body;
    Some(Centers { r_co_e: body.r_co_e, v_co_e: body.v_co_e, r_gdo_e: debris.r_gdo_e, v_gdo_e: debris.v_gdo_e })
}

fn at_launch(scene: &Scene, truth: &Truth, launch: &LaunchState) -> Option<AtLaunch> {
    let geometry = launch.geometry(&centers_of(truth)?);
    let (body, debris) = (scene.mass.debris.as_ref()?, truth.debris.as_ref()?);
    let s3 = product(dcm_from_quaternion(truth.body.q_es), [0.0, 0.0, 1.0]);
    let momentum = product(dcm_from_quaternion(debris.q_ed), product(body.inertia, debris.omega_de_d));
    let margin = |(i, model): (usize, &crate::scene::WheelModel)| model.speed_limit - truth.wheels.rates[i].abs();
    let wheels = scene.actuators.wheels[..scene.mass.wheels.len()].iter().enumerate();
    Some(AtLaunch {
        pointing_error: angle_between(s3, geometry.to_debris),
        axis_offset: geometry.axis_offset(),
        distance_error: geometry.distance_error(),
        relative_speed: norm(geometry.relative_velocity),
        body_rate: norm(truth.body.omega_se_s),
        // a line has no direction: 0 to pi/2
        momentum_angle: {
            let angle = angle_between(momentum, geometry.axis);
            if momentum == [0.0; 3] { f64::NAN } else { angle.min(core::f64::consts::PI - angle) }
        },
        speed_margin: wheels.map(margin).fold(f64::INFINITY, f64::min),
    })
}

impl Default for MissionOutcome {
    fn default() -> Self {
        Self::new()
    }
}

/// A column: name, unit, meaning, what it is of a run.
struct OutcomeColumn {
    quantity: Quantity,
    kind: ColumnKind,
    codes: &'static [&'static str],
    value: Value,
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
        let mut add = |name: String, unit: &str, meaning: String, value: Value| {
            let quantity = Quantity::named(name, unit.to_owned(), meaning);
            list.push(OutcomeColumn { quantity, kind: ColumnKind::Float, codes: &[], value });
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

    /// As columns of rows.
    pub fn columns(&self) -> LawColumns {
        let column =
            |one: &OutcomeColumn| LawColumn { quantity: one.quantity.clone(), kind: one.kind, codes: one.codes };
        LawColumns::kept(self.0.iter().map(column).collect())
    }

    /// Writes their values of a run.
    pub fn report(&self, outcome: &MissionOutcome, guidance: &Guidance, judgement: &Judgement, values: &mut [f64]) {
        for (value, column) in values.iter_mut().zip(&self.0) {
            *value = (column.value)(outcome, guidance, judgement);
        }
    }
}

type Value = Box<dyn Fn(&MissionOutcome, &Guidance, &Judgement) -> f64 + Send + Sync>;
type Add<'a> = dyn FnMut(String, &str, String, Value) + 'a;

/// Adds a column whose value needs the outcome alone.
fn plain(add: &mut Add<'_>, name: &str, unit: &str, meaning: &str, value: fn(&MissionOutcome) -> f64) {
    add(name.to_owned(), unit, meaning.to_owned(), Box::new(move |outcome, _, _| value(outcome)));
}

fn mission(spec: &LoopSpec, add: &mut Add<'_>) {
    if spec.launches() {
        plain(add, "launched", "", "Whether the net was launched: 1 or 0.", |o| {
            f64::from(u8::from(o.failure == Failure::None && o.end.is_finite()))
        });
    }
    let codes: Vec<String> = Failure::NAMES.iter().enumerate().map(|(code, name)| format!("{code} {name}")).collect();
    let meaning = format!("Why the mission failed: {}.", codes.join(", "));
    add("failure".into(), "", meaning, Box::new(|o, _, _| o.failure.code()));
    let names: Vec<String> =
        spec.phases.iter().enumerate().map(|(place, phase)| format!("{place} {}", phase.name)).collect();
    let meaning = format!("The phase in which the run ended: {}.", names.join(", "));
    add("phase_final".into(), "", meaning, Box::new(|_, guidance, _| guidance.phase as f64));
    plain(add, "end_time_s", "s", "Time at which the mission launched or failed; null where it did neither.", |o| {
        o.end
    });
    for (place, phase) in spec.phases.iter().enumerate() {
        let meaning = format!("Time at which phase {} first began; null where it did not.", phase.name);
        let value: Value = Box::new(move |_, guidance, _| guidance.first_begun[place]);
        add(format!("phase_{}_begin_s", phase.name), "s", meaning, value);
    }
}

fn pointing(add: &mut Add<'_>) {
    plain(
        add,
        "pointing_error_final_rad",
        "rad",
        "Angle of the rotation from the true attitude to the target of the last phase that had one, at the last tick.",
        |o| o.pointing_error,
    );
    plain(
        add,
        "settling_time_s",
        "s",
        "Time from the beginning of the last phase with a target until the pointing error stayed within control.settling_band_rad; null where it did not.",
        |o| o.settled_since - o.pointing_since,
    );
    plain(
        add,
        "overshoot_rad",
        "rad",
        "Largest angle beyond the target, against the direction of the error with which the last phase with a target began.",
        |o| {
            if o.pointing_since.is_nan() { f64::NAN } else { o.overshoot }
        },
    );
}

fn approach(spec: &LoopSpec, add: &mut Add<'_>) {
    plain(
        add,
        "debris_distance_min_m",
        "m",
        "Smallest distance between the centres of mass of spacecraft and debris at the ticks.",
        |o| finite(o.debris_distance),
    );
    if !spec.launches() {
        return;
    }
    let mut at = |name: &str, unit: &str, meaning: &str, value: fn(&AtLaunch) -> f64| {
        let value: Value = Box::new(move |o, _, _| o.at_launch.as_ref().map_or(f64::NAN, value));
        add(name.to_owned(), unit, format!("{meaning} at the launch; null without one."), value);
    };
    at("pointing_error_launch_rad", "rad", "Angle between s3 and the line to the debris", |l| l.pointing_error);
    at(
        "axis_offset_launch_m",
        "m",
        "Distance of the centre of mass from the line through the debris along its velocity",
        |l| l.axis_offset,
    );
    at(
        "distance_error_launch_m",
        "m",
        "Distance behind the debris along that line less control.launch_distance_m",
        |l| l.distance_error,
    );
    at("relative_speed_launch_m_s", "m/s", "Speed relative to the debris", |l| l.relative_speed);
    at("body_rate_launch_rad_s", "rad/s", "Magnitude of the angular velocity of the body relative to F_e", |l| {
        l.body_rate
    });
    at(
        "tumble_axis_angle_launch_rad",
        "rad",
        "Angle, 0 to pi/2, between the angular momentum of the debris and the launch axis",
        |l| l.momentum_angle,
    );
    if !spec.wheels.is_empty() {
        at(
            "wheel_speed_margin_launch_rad_s",
            "rad/s",
            "Smallest difference between the limit of a wheel's speed and its speed",
            |l| finite(l.speed_margin),
        );
    }
}

fn thrust(spec: &LoopSpec, add: &mut Add<'_>) {
    for &i in &spec.thrusters {
        let name = spec.thruster_names[i];
        let meaning = format!("Impulse of thruster {name}.");
        add(format!("impulse_{name}_n_s"), "N s", meaning, Box::new(move |o, _, _| o.impulse[i]));
    }
    plain(add, "impulse_total_n_s", "N s", "Sum of the impulses of all thrusters.", |o| o.impulse.iter().sum());
    plain(add, "delta_v_m_s", "m/s", "Integral of the magnitude of the acceleration by thrust.", |o| o.velocity_change);
    let meaning =
        "Propellant used at control.isp_s; null where that is not known. The mass of the spacecraft is constant.";
    let propellant = |o: &MissionOutcome, _: &Guidance, judgement: &Judgement| {
        finite(o.impulse.iter().sum::<f64>() / (STANDARD_GRAVITY * judgement.isp))
    };
    add("propellant_kg".into(), "kg", meaning.into(), Box::new(propellant));
    if spec.approaches() {
        plain(
            add,
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
        add(format!("speed_peak_{name}_rad_s"), "rad/s", meaning, Box::new(move |o, _, _| o.speed_peak[i]));
    }
    plain(
        add,
        "wheel_momentum_peak_n_m_s",
        "N m s",
        "Largest magnitude of the wheels' momentum relative to the body at the ticks.",
        |o| o.momentum_peak,
    );
    plain(
        add,
        "torque_saturated_s",
        "s",
        "Time in which a motor gave less than was commanded because of its limit of torque.",
        |o| o.saturated[0],
    );
    plain(
        add,
        "speed_saturated_s",
        "s",
        "Time in which a motor gave less than was commanded because of the limit of its wheel's speed.",
        |o| o.saturated[1],
    );
    plain(
        add,
        "torque_excess_max_n_m",
        "N m",
        "Largest torque that was commanded beyond what a motor gave, because of its limit of torque or of its wheel's speed.",
        |o| o.torque_excess,
    );
}

fn estimation(spec: &LoopSpec, add: &mut Add<'_>) {
    plain(
        add,
        "attitude_estimate_error_final_rad",
        "rad",
        "Angle between estimated and true attitude at the last tick.",
        |o| o.attitude_error[0],
    );
    plain(
        add,
        "attitude_estimate_error_max_rad",
        "rad",
        "Largest angle between estimated and true attitude at the ticks.",
        |o| o.attitude_error[1],
    );
    if spec.approaches() {
        plain(
            add,
            "relative_position_estimate_error_final_m",
            "m",
            "Distance between estimated and true position relative to the debris at the last tick.",
            |o| o.relative_error[0],
        );
        plain(
            add,
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
    let mut of_filter = |name: &str, what: &str, value: fn(&Consistency) -> Option<NormalizedSquare>| {
        let meaning = format!(
            "Normalised square of {what} at the last tick, over its degrees of freedom: 1 on average where the filter is right; null where it is not known."
        );
        add(
            format!("{name}_final"),
            "",
            meaning,
            Box::new(move |o, _, _| {
                value(&o.consistency).map_or(f64::NAN, |square| square.value / square.degrees as f64)
            }),
        );
    };
    of_filter("attitude_nees", "the estimation error of attitude and gyro bias (or rate)", |c| c.attitude);
    if spec.approaches() {
        of_filter("motion_nees", "the estimation error of position and velocity", |c| c.motion);
        of_filter("debris_motion_nees", "the estimation error of position and velocity of the debris", |c| {
            c.debris_motion
        });
        of_filter("debris_attitude_nees", "the estimation error of attitude and rate of the debris", |c| c.debris);
    }
}
