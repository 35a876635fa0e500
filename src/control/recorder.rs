//! [`Recorder`]: telemetry of a run under a loop: phase, estimates, commands and measurements at the control ticks.

use super::control_loop::SAME_TIME;
use super::estimate::Estimate;
use super::estimators::Consistency;
use super::estimators::kalman::NormalizedSquare;
use super::flight_software::Commanded;
use super::measurement::Measurement;
use super::sensors::{Components, KINDS as SENSORS, MeasuredQuantity};
use super::spec::{LoopSpec, SensorSpec};
use super::vector::difference;
use crate::run::{Quantity, Telemetry};
use crate::scene::MAX_WHEELS;

/// The components of vectors and of quaternions.
const XYZ: &[&str] = &["x", "y", "z"];
const WXYZ: &[&str] = &["w", "x", "y", "z"];

/// Records a run.
#[derive(Debug)]
pub struct Recorder {
    telemetry: Telemetry,
    parts: Parts,
}

/// Which parts the loop has, and so which columns.
#[derive(Clone, Debug)]
struct Parts {
    wheels: Vec<usize>,
    thrusters: Vec<usize>,
    rods: Vec<usize>,
    has_debris: bool,
    has_filter: bool,
    has_camera: bool,
    sensors: Vec<MeasuredColumns>,
}

/// The columns of a sensor.
#[derive(Clone, Debug)]
struct MeasuredColumns {
    /// In the names of its columns: its own name where a loop has several of its kind.
    prefix: String,
    quantities: &'static [MeasuredQuantity],
    /// Its period, s.
    period: f64,
}

/// What is recorded at a tick.
#[derive(Clone, Copy, Debug)]
pub struct Tick<'a> {
    /// Time, s.
    pub time: f64,
    /// Place of the phase.
    pub phase: usize,
    /// Angle of the estimated attitude to the target, rad.
    pub pointing_error: f64,
    /// The estimate.
    pub estimate: &'a Estimate,
    /// How well the filters agree with their covariance.
    pub consistency: &'a Consistency,
    /// What is commanded.
    pub commanded: Commanded,
    /// What was delivered at the tick.
    pub measurements: &'a [Measurement],
}

impl Recorder {
    /// Of a run under `spec`.
    pub fn new(spec: &LoopSpec) -> Self {
        let columns = |sensor: &SensorSpec| {
            let is_alone = spec.sensors.iter().filter(|other| other.kind == sensor.kind).count() == 1;
            MeasuredColumns {
                prefix: if is_alone { String::new() } else { format!("{}_", sensor.name) },
                quantities: SENSORS[sensor.kind].quantities,
                period: sensor.period,
            }
        };
        let parts = Parts {
            wheels: spec.wheels.clone(),
            thrusters: spec.thrusters.clone(),
            rods: spec.rods.clone(),
            has_debris: spec.has_debris,
            has_filter: spec.has_filter(),
            has_camera: spec.has_camera(),
            sensors: spec.sensors.iter().map(columns).collect(),
        };
        let quantities = parts.quantities(spec);
        let same = SAME_TIME * spec.period;
        Recorder { telemetry: Telemetry { quantities, times: Vec::new(), rows: Vec::new(), same }, parts }
    }

    /// What was recorded.
    pub fn telemetry(&self) -> &Telemetry {
        &self.telemetry
    }

    /// Records a control tick.
    pub fn tick(&mut self, tick: &Tick<'_>) {
        let row = self.parts.row(tick);
        assert_eq!(row.len(), self.telemetry.quantities.len(), "a value for each column");
        self.telemetry.times.push(tick.time);
        self.telemetry.rows.push(row);
    }
}

impl Parts {
    /// The columns, in the order of [`Parts::row`].
    fn quantities(&self, spec: &LoopSpec) -> Vec<Quantity> {
        let mut found = Vec::new();
        let mut add = |name: &str, components: &[&str], unit: &str, suffix: &str, meaning: &str| {
            for component in components {
                let parts = [name, component, suffix].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>();
                found.push(Quantity::named(parts.join("_"), unit.to_owned(), meaning.to_owned()));
            }
        };
        add("phase", &[""], "", "", "Place of the phase of guidance.");
        add(
            "estimated_pointing_error",
            &[""],
            "rad",
            "rad",
            "Angle of the rotation from the estimated attitude to the target.",
        );
        add("estimated_q_es", WXYZ, "", "", "Estimated attitude quaternion, F_s -> F_e.");
        add(
            "estimated_omega_se_s",
            XYZ,
            "rad/s",
            "rad_s",
            "Estimated angular velocity of F_s relative to F_e, in F_s.",
        );
        add("estimated_gyro_bias_s", XYZ, "rad/s", "rad_s", "Estimated bias of the gyro, in F_s.");
        let names: Vec<&str> = self.wheels.iter().map(|place| spec.wheel_names[*place].as_str()).collect();
        add("estimated_rate", &names, "rad/s", "rad_s", "Estimated rate of this wheel relative to the body.");
        if self.has_debris {
            add(
                "estimated_to_debris_e",
                XYZ,
                "m",
                "m",
                "Estimated position of the debris relative to the centre of mass, in F_e.",
            );
            add(
                "estimated_relative_velocity_e",
                XYZ,
                "m/s",
                "m_s",
                "Estimated velocity relative to the debris, in F_e.",
            );
            add("estimated_q_ed", WXYZ, "", "", "Estimated attitude quaternion of the debris, F_d -> F_e.");
            add(
                "estimated_omega_de_d",
                XYZ,
                "rad/s",
                "rad_s",
                "Estimated angular velocity of the debris relative to F_e, in F_d.",
            );
        }
        if self.has_filter {
            let of = ["attitude", "motion"]
                .into_iter()
                .chain(self.has_debris.then_some("debris_motion"))
                .chain(self.has_camera.then_some("debris"));
            for of in of {
                add(
                    of,
                    &["nees", "innovation_square"],
                    "",
                    "",
                    "Normalised square of an estimation error, or of the innovation of this tick, over its degrees of freedom; null where there is none.",
                );
            }
        }
        if self.has_filter {
            let relative =
                [("relative_position_expected_error", "m", "m"), ("relative_velocity_expected_error", "m/s", "m_s")];
            let own = [("attitude_expected_error", "rad", "rad"), ("rate_expected_error", "rad/s", "rad_s")];
            let relative = relative.into_iter().filter(|_| self.has_debris);
            for (name, unit, suffix) in own.into_iter().chain(relative) {
                add(
                    name,
                    &[""],
                    unit,
                    suffix,
                    "Root mean square of the magnitude of this estimation error by the filter's covariance: the root of the sum of three variances.",
                );
            }
        }
        for sensor in &self.sensors {
            for quantity in sensor.quantities {
                let components = match quantity.components {
                    Components::Named(components) => components,
                    Components::Wheels => &names,
                };
                let (name, [unit, suffix]) = (format!("{}{}", sensor.prefix, quantity.name), quantity.unit);
                let meaning = format!("{}; null where none was delivered.", quantity.meaning);
                add(&name, components, unit, suffix, &meaning);
            }
        }
        add("commanded_torque", &names, "N m", "n_m", "Commanded torque of the motor of this wheel.");
        let names: Vec<&str> = self.thrusters.iter().map(|place| spec.thruster_names[*place].as_str()).collect();
        add("commanded_thrust", &names, "N", "n", "Commanded mean thrust of this thruster over the control period.");
        let names: Vec<&str> = self.rods.iter().map(|place| spec.rod_names[*place].as_str()).collect();
        add("commanded_dipole", &names, "A m^2", "a_m2", "Commanded dipole of this torque rod.");
        found
    }

    /// The values of a tick.
    fn row(&self, tick: &Tick<'_>) -> Vec<f64> {
        let estimate = tick.estimate;
        let mut row = vec![tick.phase as f64, tick.pointing_error];
        row.extend(estimate.q_es.iter().chain(&estimate.omega_se_s).chain(&estimate.gyro_bias_s));
        row.extend(self.wheels.iter().map(|place| estimate.wheel_rates[*place]));
        if self.has_debris {
            match &estimate.debris {
                Some(debris) => {
                    row.extend(difference(debris.r_gdo_e, estimate.r_co_e));
                    row.extend(difference(estimate.v_co_e, debris.v_gdo_e));
                    row.extend(debris.q_ed.iter().chain(&debris.omega_de_d));
                }
                None => row.extend([f64::NAN; 13]),
            }
        }
        if self.has_filter {
            let of = tick.consistency;
            let all = [
                (true, [of.attitude, of.attitude_innovation]),
                (true, [of.motion, of.motion_innovation]),
                (self.has_debris, [of.debris_motion, of.debris_motion_innovation]),
                (self.has_camera, [of.debris, of.debris_innovation]),
            ];
            let shown = all.into_iter().filter(|(is_shown, _)| *is_shown).flat_map(|(_, squares)| squares);
            row.extend(shown.map(|square| square.map_or(f64::NAN, per_degree)));
            let expected = of.expected;
            let relative =
                [expected.relative_position, expected.relative_velocity].into_iter().filter(|_| self.has_debris);
            let all = [expected.attitude, expected.rate].into_iter().chain(relative);
            row.extend(all.map(|error| error.unwrap_or(f64::NAN)));
        }
        self.measured(tick.measurements, &mut row);
        let Commanded { motor_torque, thrust, dipoles } = tick.commanded;
        row.extend(self.wheels.iter().map(|place| motor_torque[*place]));
        row.extend(self.thrusters.iter().map(|place| thrust[*place]));
        row.extend(self.rods.iter().map(|place| dipoles[*place]));
        row
    }

    /// The last measurement of each sensor.
    fn measured(&self, measurements: &[Measurement], row: &mut Vec<f64>) {
        for (place, sensor) in self.sensors.iter().enumerate() {
            let last = measurements.iter().rev().find(|measurement| measurement.sensor == place);
            let mut next = 0;
            for quantity in sensor.quantities {
                let places: Vec<usize> = match quantity.components {
                    Components::Named(components) => (next..next + components.len()).collect(),
                    Components::Wheels => self.wheels.iter().map(|wheel| next + wheel).collect(),
                };
                let interval = if quantity.is_over_period { sensor.period } else { 1.0 };
                row.extend(places.iter().map(|at| last.map_or(f64::NAN, |last| last.values[*at] / interval)));
                next += match quantity.components {
                    Components::Named(components) => components.len(),
                    Components::Wheels => MAX_WHEELS,
                };
            }
        }
    }
}

/// A normalised square over its degrees of freedom: 1 on average where a filter is right.
fn per_degree(square: NormalizedSquare) -> f64 {
    square.value / square.degrees as f64
}
