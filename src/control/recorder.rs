//! [`Recorder`]: telemetry of a run under a loop: phase, estimates, commands and measurements at the control ticks.

use super::estimate::Estimate;
use super::measurement::Measurement;
use super::spec::LoopSpec;
use crate::run::{Quantity, Telemetry};
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS};

/// Records a run.
#[derive(Debug)]
pub struct Recorder {
    telemetry: Telemetry,
    wheels: Vec<usize>,
    thrusters: Vec<usize>,
    has_debris: bool,
}

/// The components of a vector.
const XYZ: [&str; 3] = ["x", "y", "z"];

impl Recorder {
    /// Of a run under `spec`.
    pub fn new(spec: &LoopSpec) -> Self {
        let mut quantities = Vec::new();
        let mut add = |name: String, unit: &str, meaning: &str| {
            quantities.push(Quantity::named(name, unit.to_owned(), meaning.to_owned()));
        };
        add("phase".into(), "", "Place of the phase of guidance.");
        add(
            "estimated_pointing_error_rad".into(),
            "rad",
            "Angle of the rotation from the estimated attitude to the target.",
        );
        for component in ["w", "x", "y", "z"] {
            add(format!("estimated_q_es_{component}"), "", "Estimated attitude quaternion, F_s -> F_e.");
        }
        let mut vector = |name: &str, unit: &str, suffix: &str, meaning: &str| {
            XYZ.iter().for_each(|component| add(format!("{name}_{component}_{suffix}"), unit, meaning));
        };
        vector("estimated_omega_se_s", "rad/s", "rad_s", "Estimated angular velocity of F_s relative to F_e, in F_s.");
        vector("estimated_gyro_bias_s", "rad/s", "rad_s", "Estimated bias of the gyro, in F_s.");
        if spec.has_debris {
            vector(
                "estimated_to_debris_e",
                "m",
                "m",
                "Estimated position of the debris relative to the centre of mass, in F_e.",
            );
            vector("estimated_relative_velocity_e", "m/s", "m_s", "Estimated velocity relative to the debris, in F_e.");
        }
        vector(
            "measured_rate_s",
            "rad/s",
            "rad_s",
            "Rotation measured by a gyro over its interval, in F_s; null where none was delivered.",
        );
        for component in ["w", "x", "y", "z"] {
            add(
                format!("measured_q_es_{component}"),
                "",
                "Attitude quaternion measured by a star tracker; null where none was delivered.",
            );
        }
        for place in &spec.wheels {
            let name = spec.wheel_names[*place];
            add(format!("commanded_torque_{name}_n_m"), "N m", "Commanded torque of the motor of this wheel.");
        }
        for place in &spec.thrusters {
            let name = spec.thruster_names[*place];
            add(format!("commanded_thrust_{name}_n"), "N", "Commanded mean thrust over the control period.");
        }
        let telemetry = Telemetry { quantities, times: Vec::new(), rows: Vec::new() };
        Recorder {
            telemetry,
            wheels: spec.wheels.clone(),
            thrusters: spec.thrusters.clone(),
            has_debris: spec.has_debris,
        }
    }

    /// What was recorded.
    pub fn telemetry(&self) -> &Telemetry {
        &self.telemetry
    }

    /// Records a control tick at `time`, s.
    pub fn tick(
        &mut self,
        time: f64,
        phase: usize,
        pointing_error: f64,
        estimate: &Estimate,
        (torque, thrust): ([f64; MAX_WHEELS], [f64; MAX_THRUSTERS]),
        measurements: &[(usize, Measurement)],
    ) {
        let mut row = vec![phase as f64, pointing_error];
        row.extend(estimate.q_es.iter().chain(&estimate.omega_se_s).chain(&estimate.gyro_bias_s));
        if self.has_debris {
            let of = |debris: [f64; 3], own: [f64; 3]| crate::control::vector::difference(debris, own);
            let apart = estimate.debris.map_or([f64::NAN; 3], |debris| of(debris.r_gdo_e, estimate.r_co_e));
            let velocity = estimate.debris.map_or([f64::NAN; 3], |debris| of(estimate.v_co_e, debris.v_gdo_e));
            row.extend(apart.into_iter().chain(velocity));
        }
        let (mut rate, mut attitude) = ([f64::NAN; 3], [f64::NAN; 4]);
        for (_, measurement) in measurements {
            match measurement {
                Measurement::Rotation { rotation_s, interval } => rate = rotation_s.map(|turn| turn / interval),
                Measurement::Attitude { q_es, .. } => attitude = *q_es,
                Measurement::Radar { .. } | Measurement::Camera { .. } | Measurement::WheelRates { .. } => {}
            }
        }
        row.extend(rate.into_iter().chain(attitude));
        row.extend(self.wheels.iter().map(|place| torque[*place]));
        row.extend(self.thrusters.iter().map(|place| thrust[*place]));
        self.telemetry.times.push(time);
        self.telemetry.rows.push(row);
    }
}
