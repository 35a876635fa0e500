//! [`Recorder`]: telemetry of a run under a loop: phase, estimates, commands and measurements at the control ticks.

use super::control_loop::SAME_TIME;
use super::estimate::Estimate;
use super::estimators::Consistency;
use super::estimators::kalman::NormalizedSquare;
use super::measurement::Measurement;
use super::spec::LoopSpec;
use super::vector::difference;
use crate::run::{Quantity, Telemetry};
use crate::scene::{MAX_THRUSTERS, MAX_WHEELS};

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
    has_debris: bool,
    has_filter: bool,
    gyro: bool,
    tracker: bool,
    radar: bool,
    camera: bool,
    tachometers: bool,
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
    /// Commanded motor torques, N m, and mean thrusts, N.
    pub commanded: ([f64; MAX_WHEELS], [f64; MAX_THRUSTERS]),
    /// What was delivered since the control tick before, with the places of the sensors.
    pub measurements: &'a [(usize, Measurement)],
}

impl Recorder {
    /// Of a run under `spec`.
    pub fn new(spec: &LoopSpec) -> Self {
        let has = |kind: &str| spec.sensors.iter().any(|sensor| super::sensors::KINDS[sensor.kind].name == kind);
        let parts = Parts {
            wheels: spec.wheels.clone(),
            thrusters: spec.thrusters.clone(),
            has_debris: spec.has_debris,
            has_filter: spec.has_filter(),
            gyro: has("rate_gyro"),
            tracker: has("star_tracker"),
            radar: has("ground_radar"),
            camera: has("relative_camera"),
            tachometers: has("tachometers"),
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
                .chain(self.camera.then_some("debris"));
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
        let null = "null where none was delivered.";
        if self.gyro {
            add(
                "measured_rate_s",
                XYZ,
                "rad/s",
                "rad_s",
                &format!("Rotation measured by a gyro over its interval, in F_s; {null}"),
            );
        }
        if self.tracker {
            add(
                "measured_q_es",
                WXYZ,
                "",
                "",
                &format!("Attitude quaternion measured by a star tracker, F_s -> F_e; {null}"),
            );
        }
        if self.radar {
            add("measured_r_po_e", XYZ, "m", "m", &format!("Position of p measured by the radar, in F_e; {null}"));
            add("measured_v_po_e", XYZ, "m/s", "m_s", &format!("Velocity of p measured by the radar, in F_e; {null}"));
            add(
                "measured_r_gdo_e",
                XYZ,
                "m",
                "m",
                &format!("Position of the debris measured by the radar, in F_e; {null}"),
            );
            add(
                "measured_v_gdo_e",
                XYZ,
                "m/s",
                "m_s",
                &format!("Velocity of the debris measured by the radar, in F_e; {null}"),
            );
        }
        if self.camera {
            add(
                "measured_q_sd",
                WXYZ,
                "",
                "",
                &format!("Attitude quaternion of the debris measured by the camera, F_d -> F_s; {null}"),
            );
            add(
                "measured_omega_ds_d",
                XYZ,
                "rad/s",
                "rad_s",
                &format!(
                    "Angular velocity of the debris relative to the spacecraft measured by the camera, in F_d; {null}"
                ),
            );
        }
        if self.tachometers {
            add(
                "measured_rate",
                &names,
                "rad/s",
                "rad_s",
                &format!("Rate of this wheel measured by its tachometer; {null}"),
            );
        }
        add("commanded_torque", &names, "N m", "n_m", "Commanded torque of the motor of this wheel.");
        let names: Vec<&str> = self.thrusters.iter().map(|place| spec.thruster_names[*place].as_str()).collect();
        add("commanded_thrust", &names, "N", "n", "Commanded mean thrust of this thruster over the control period.");
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
                (self.camera, [of.debris, of.debris_innovation]),
            ];
            let shown = all.into_iter().filter(|(is_shown, _)| *is_shown).flat_map(|(_, squares)| squares);
            row.extend(shown.map(|square| square.map_or(f64::NAN, per_degree)));
        }
        self.measured(tick.measurements, &mut row);
        let (torque, thrust) = tick.commanded;
        row.extend(self.wheels.iter().map(|place| torque[*place]));
        row.extend(self.thrusters.iter().map(|place| thrust[*place]));
        row
    }

    /// The last measurement of each kind.
    fn measured(&self, measurements: &[(usize, Measurement)], row: &mut Vec<f64>) {
        let (mut gyro, mut tracker, mut radar) = ([f64::NAN; 3], [f64::NAN; 4], [f64::NAN; 12]);
        let (mut camera, mut tachometers) = ([f64::NAN; 7], [f64::NAN; MAX_WHEELS]);
        for (_, measurement) in measurements {
            match measurement {
                Measurement::Rotation { rotation_s, interval } => gyro = rotation_s.map(|turn| turn / interval),
                Measurement::Attitude { q_es, .. } => tracker = *q_es,
                Measurement::Radar { base, debris, .. } => {
                    radar[..3].copy_from_slice(&base.r_e);
                    radar[3..6].copy_from_slice(&base.v_e);
                    if let Some(debris) = debris {
                        radar[6..9].copy_from_slice(&debris.r_e);
                        radar[9..].copy_from_slice(&debris.v_e);
                    }
                }
                Measurement::Camera { q_sd, omega_ds_d, .. } => {
                    camera[..4].copy_from_slice(q_sd);
                    camera[4..].copy_from_slice(omega_ds_d);
                }
                Measurement::WheelRates { rates } => tachometers = *rates,
            }
        }
        let shown: [(bool, &[f64]); 4] =
            [(self.gyro, &gyro), (self.tracker, &tracker), (self.radar, &radar), (self.camera, &camera)];
        shown.into_iter().filter(|(is_there, _)| *is_there).for_each(|(_, values)| row.extend(values));
        if self.tachometers {
            row.extend(self.wheels.iter().map(|place| tachometers[*place]));
        }
    }
}

/// A normalised square over its degrees of freedom: 1 on average where a filter is right.
fn per_degree(square: NormalizedSquare) -> f64 {
    square.value / square.degrees as f64
}
