//! [`MissionOutcome`]: the outcome of a run under a loop, from the true state at every tick.

pub mod columns;
pub mod estimation;
mod stability;

use self::estimation::{Consistency, EstimateErrors};
use self::stability::Stability;
use super::net_launch::AtLaunch;
use super::parameters::LoopNumbers;
use super::plant::Applied;
use super::truth::Truth;
use crate::dynamics::actuation::Actuation;
use crate::loops::attitude_law::stored_momentum;
use crate::loops::failure::Failure;
use crate::loops::launch_geometry::LaunchState;
use crate::loops::target::AttitudeError;
use crate::loops::vector::{difference, dot, norm, scaled, vector_of};
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS, Scene};

/// Numbers that judge the outcome of a run.
pub struct MissionCriteria {
    pub launch: LaunchState,
    pub of_loop: LoopNumbers,
    pub period: f64,
    /// Specific impulse, s; zero if unknown.
    pub isp: f64,
}

pub struct MissionOutcome {
    pub criteria: MissionCriteria,
    pub failure: Failure,
    pub end: f64,
    pub at_launch: Option<AtLaunch>,
    /// Largest rotation past the target, rad, and the direction of the phase's first error.
    overshoot: f64,
    first_error: Option<[f64; 3]>,
    /// Time since which the pointing error has been in the band, s; NaN outside it.
    settled_since: f64,
    pointing_since: f64,
    pointing_error: f64,
    stability: Stability,
    /// By thruster, N s.
    impulse: [f64; MAX_THRUSTERS],
    velocity_change: f64,
    debris_distance: f64,
    plume_time: f64,
    speed_peak: [f64; MAX_WHEELS],
    momentum_peak: f64,
    /// Time with a motor at its torque limit and at its wheel's speed limit, s.
    saturated: [f64; 2],
    torque_excess: f64,
    /// Largest dipole of all rods together, A m^2, and time in saturation, s.
    rod_dipole: f64,
    rod_saturated: f64,
    attitude_error: [f64; 2],
    relative_error: [f64; 2],
    /// Last value and largest magnitude of each telemetry number; NaN after a non-finite one.
    telemetry: Vec<[f64; 2]>,
    pub consistency: Consistency,
}

impl MissionOutcome {
    pub fn new(criteria: MissionCriteria) -> Self {
        MissionOutcome {
            criteria,
            failure: Failure::None,
            end: f64::NAN,
            at_launch: None,
            overshoot: 0.0,
            first_error: None,
            settled_since: f64::NAN,
            pointing_since: f64::NAN,
            pointing_error: f64::NAN,
            stability: Stability::NONE,
            impulse: [0.0; MAX_THRUSTERS],
            velocity_change: 0.0,
            debris_distance: f64::INFINITY,
            plume_time: 0.0,
            speed_peak: [0.0; MAX_WHEELS],
            momentum_peak: 0.0,
            saturated: [0.0; 2],
            torque_excess: 0.0,
            rod_dipole: 0.0,
            rod_saturated: 0.0,
            attitude_error: [0.0; 2],
            relative_error: [f64::NAN; 2],
            telemetry: Vec::new(),
            consistency: Consistency::NONE,
        }
    }

    /// A value at launch; NaN without one.
    fn launch(&self, value: fn(&AtLaunch) -> f64) -> f64 {
        self.at_launch.as_ref().map_or(f64::NAN, value)
    }

    /// Last value or largest magnitude of the telemetry number `place`.
    fn telemetry(&self, place: usize, which: usize) -> f64 {
        self.telemetry.get(place).map_or(f64::NAN, |found| found[which])
    }

    /// Root mean square or peak to peak of the relative performance error, rad.
    fn relative_error(&self, which: usize) -> f64 {
        self.stability.relative_error(self.criteria.of_loop.stability_window, self.criteria.period)[which]
    }

    /// Adds a tick. `error` is the true attitude relative to the phase's target, if it has one; `begins` marks the
    /// first tick of a phase.
    pub fn tick(
        &mut self,
        scene: &Scene,
        truth: &Truth,
        (error, begins): (Option<&AttitudeError>, bool),
        errors: &EstimateErrors,
    ) {
        let MissionCriteria { of_loop, period, .. } = self.criteria;
        let vector = error.map(|error| vector_of(error.q_ts));
        self.stability.tick(truth.time, vector, &of_loop, period);
        if let Some(vector) = vector {
            self.pointing(truth.time, vector, begins, of_loop.settling_band);
        }
        let turning = scene.mass.wheels.len();
        for (peak, rate) in self.speed_peak[..turning].iter_mut().zip(truth.wheel_rates) {
            *peak = peak.max(rate.abs());
        }
        self.momentum_peak = self.momentum_peak.max(norm(stored_momentum(&scene.mass, &truth.wheel_rates)));
        if let Some(debris) = &truth.debris {
            self.debris_distance = self.debris_distance.min(norm(difference(debris.r_gdo_e, truth.body.r_co_e)));
        }
        self.attitude_error = [errors.attitude, self.attitude_error[1].max(errors.attitude)];
        self.relative_error = [errors.relative_position, errors.relative_velocity];
    }

    fn pointing(&mut self, time: f64, vector: [f64; 3], begins: bool, band: f64) {
        let angle = norm(vector);
        if begins {
            (self.first_error, self.overshoot) = (None, 0.0);
            (self.settled_since, self.pointing_since) = (f64::NAN, time);
        }
        // a phase that begins on target takes its direction from the first error
        if self.first_error.is_none() && angle > 0.0 {
            self.first_error = Some(scaled(1.0 / angle, vector));
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

    /// Adds the module's telemetry at a tick; empty if it did not step.
    pub fn take_telemetry(&mut self, values: &[f64]) {
        self.telemetry.resize(self.telemetry.len().max(values.len()), [f64::NAN, 0.0]);
        for ([last, most], value) in self.telemetry.iter_mut().zip(values) {
            (*last, *most) = (*value, if value.is_nan() || most.is_nan() { f64::NAN } else { most.max(value.abs()) });
        }
    }

    pub fn arc(&mut self, actuation: &Actuation, applied: &Applied) {
        for (which, is_saturated) in applied.saturated.into_iter().enumerate() {
            self.saturated[which] += if is_saturated { applied.length } else { 0.0 };
        }
        self.torque_excess = self.torque_excess.max(applied.torque_excess);
        self.rod_dipole = self.rod_dipole.max(norm(actuation.dipole));
        self.rod_saturated += if applied.is_rod_saturated { applied.length } else { 0.0 };
    }

    /// Adds `length` seconds of the thrusts `thrust` (N) in a run of `scene`; `hits` if a plume hits the debris.
    pub fn fires(&mut self, scene: &Scene, length: f64, thrust: [f64; MAX_THRUSTERS], hits: bool) {
        for (impulse, thrust) in self.impulse.iter_mut().zip(thrust) {
            *impulse += thrust * length;
        }
        let force = norm(scene.thruster_force_s(thrust));
        self.velocity_change += force * length / scene.mass.total;
        self.plume_time += if hits { length } else { 0.0 };
    }

    pub fn impulse_total(&self) -> f64 {
        self.impulse.iter().sum()
    }
}
