//! The multiplicative extended Kalman filter for the whole state: attitude with gyro bias ([`super::attitude_filter`])
//! or, without a gyro, with rate ([`super::rigid_body_filter`]); translation of spacecraft and debris
//! ([`super::translation_filter`]); torque-free attitude of the debris, propagated through gaps of the camera.
//!
//! Filters start at the nominal state with zero bias and assume the sensors' nominal noise. The attitude covariance of
//! the spacecraft adds to the camera's noise as if it were white, which it is not. Between samples of a slow gyro the
//! rotation is predicted at the last rate and corrected at the next sample; between tachometer readings, wheel rates
//! follow the commanded motor torques.

use std::collections::VecDeque;
use std::sync::Arc;

use super::attitude_filter::{AttitudeFilter, AttitudeObservation, GyroStep};
use super::delayed::Delayed;
use super::estimator::{
    Confidence, Covariance, Estimator, EstimatorContext, EstimatorMaker, Filters, KnownSensor, Update, center_of,
};
use super::kalman::corners;
use super::rigid_body_filter::{BodyObservation, BodyStep, MeasuredMotion, RigidBodyFilter};
use super::translation_filter::{MotionObservation, TranslationFilter, TranslationStep};
use crate::dynamics::gravity::Gravity;
use crate::loops::attitude_law::wheel_momenta;
use crate::loops::declared::{declared, number};
use crate::loops::estimate::{DebrisState, Estimate};
use crate::loops::kinds::EstimatorKind;
use crate::loops::measurement::{Measurement, PointMotion, part};
use crate::loops::observes::{AttitudeSensor, GyroNoise, Observes};
use crate::loops::vector::{
    added, conjugate, dcm_from_quaternion, diagonal, difference, dot, hamilton, multiplied, product, quaternion_of,
    scaled, sum, transposed, vector_of,
};
use crate::scene::{MAX_WHEELS, MassProperties, Scene, WheelMode};

pub(super) const KIND: EstimatorMaker = EstimatorMaker {
    kind: EstimatorKind {
        name: "mekf",
        knows_the_truth: false,
        has_filter: true,
        uses: |_| true,
        parameters: &PARAMETERS,
    },
    make: |context| Box::new(Mekf::new(context)),
};

declared! {
    /// Initial standard deviations and process noise of the filters.
    Beliefs = PARAMETERS {
        attitude_sigma: f64 = number("initial_attitude_sigma_rad", "rad",
            "Initial standard deviation of the attitude, about each axis", &[0.1]);
        bias_sigma: f64 = number("initial_bias_sigma_rad_s", "rad/s",
            "Initial standard deviation of the gyro bias, whose first estimate is zero", &[1e-4]);
        rate_sigma: f64 = number("initial_rate_sigma_rad_s", "rad/s",
            "Initial standard deviation of the rate; used without a gyro", &[0.1]);
        rate_walk: f64 = number("rate_random_walk_rad_s_sqrt_s", "rad/s/sqrt(s)",
            "Process noise of the rate: unknown torque; used without a gyro", &[1e-4]);
        position_sigma: f64 = number("initial_position_sigma_m", "m",
            "Initial standard deviation of the position, along each axis", &[10.0]);
        velocity_sigma: f64 = number("initial_velocity_sigma_m_s", "m/s",
            "Initial standard deviation of the velocity, along each axis", &[0.1]);
        velocity_walk: f64 = number("velocity_random_walk_m_s_sqrt_s", "m/s/sqrt(s)",
            "Process noise of the velocity: unknown acceleration", &[1e-4]);
        debris_position_sigma: f64 = number("debris_position_sigma_m", "m",
            "Initial standard deviation of the debris's position", &[10.0]);
        debris_velocity_sigma: f64 = number("debris_velocity_sigma_m_s", "m/s",
            "Initial standard deviation of the debris's velocity", &[0.1]);
        debris_velocity_walk: f64 = number("debris_velocity_random_walk_m_s_sqrt_s", "m/s/sqrt(s)",
            "Process noise of the debris's velocity: unknown acceleration", &[1e-5]);
        debris_attitude_sigma: f64 = number("debris_attitude_sigma_rad", "rad",
            "Initial standard deviation of the debris's attitude", &[1.0]);
        debris_rate_sigma: f64 = number("debris_rate_sigma_rad_s", "rad/s",
            "Initial standard deviation of the debris's rate", &[0.1]);
        debris_rate_walk: f64 = number("debris_rate_random_walk_rad_s_sqrt_s", "rad/s/sqrt(s)",
            "Process noise of the debris's rate: unknown torque", &[1e-5]);
    }
}

enum SensorModel {
    /// Noise and period (s).
    Gyro(GyroNoise, f64),
    Attitude(Arc<dyn AttitudeSensor>),
    /// Standard deviations of position (m) and velocity (m/s).
    Motion([f64; 2]),
    /// Standard deviations of relative attitude (rad) and rate (rad/s).
    DebrisAttitude([f64; 2]),
    WheelRates,
}

impl SensorModel {
    fn of(sensor: &KnownSensor<'_>, nominal: &Scene) -> Self {
        let table = sensor.parameters;
        match sensor.observes {
            Observes::Rotation(noise) => SensorModel::Gyro(noise(table), sensor.period),
            Observes::Attitude(model) => SensorModel::Attitude(model(table)),
            Observes::Direction(model) | Observes::Field(model) => SensorModel::Attitude(model(table, nominal)),
            Observes::Motion(sigmas) => SensorModel::Motion(sigmas(table)),
            Observes::DebrisAttitude(sigmas) => SensorModel::DebrisAttitude(sigmas(table)),
            Observes::WheelRates => SensorModel::WheelRates,
        }
    }
}

enum Attitude {
    WithGyro(Delayed<AttitudeFilter>, GyroPropagation),
    WithoutGyro(Delayed<RigidBodyFilter>),
}

struct GyroPropagation {
    /// Predicted rotation since its last measurement.
    predicted: [f64; 4],
    rate: [f64; 3],
    /// Variance of that rate about the bias, rad^2/s^2.
    variance: f64,
}

struct Mekf {
    mass: MassProperties,
    tick: f64,
    /// The last intervals between updates, the latest first, s: as many as the largest latency has ticks.
    intervals: VecDeque<f64>,
    time: f64,
    sensors: Vec<SensorModel>,
    attitude: Attitude,
    motion: Delayed<TranslationFilter>,
    debris_motion: Option<Delayed<TranslationFilter>>,
    debris: Option<Delayed<RigidBodyFilter>>,
    wheel_rates: [f64; MAX_WHEELS],
}

impl Mekf {
    fn new(context: &EstimatorContext<'_>) -> Self {
        let (start, mass) = (context.start(), context.nominal.mass);
        let believed = Beliefs::of(context.parameters);
        let sensors: Vec<SensorModel> =
            context.sensors.iter().map(|sensor| SensorModel::of(sensor, context.nominal)).collect();
        let gyro = sensors.iter().find_map(|sensor| match sensor {
            SensorModel::Gyro(noise, period) => Some((*noise, *period)),
            _ => None,
        });
        let latencies = context.sensors.iter().map(|sensor| ticks(sensor.latency, context.tick));
        let oldest = latencies.max().unwrap_or(0);
        let sigma = believed.attitude_sigma;
        let attitude = match gyro {
            Some((noise, period)) => {
                let mut filter = AttitudeFilter::new(start.q_es, sigma, believed.bias_sigma, noise);
                filter.rate_s = start.omega_se_s;
                let variance = noise.angular_random_walk * noise.angular_random_walk / period;
                let turned = GyroPropagation { predicted: [1.0, 0.0, 0.0, 0.0], rate: start.omega_se_s, variance };
                Attitude::WithGyro(Delayed::new(filter, oldest), turned)
            }
            None => {
                let sigmas = [sigma, believed.rate_sigma];
                let walk = believed.rate_walk;
                let filter = RigidBodyFilter::new(mass.inertia_rotating(), start.q_es, start.omega_se_s, sigmas, walk);
                Attitude::WithoutGyro(Delayed::new(filter, oldest))
            }
        };
        let gravity = context.nominal.orbit.as_ref().map(Gravity::of);
        let translation = |r_e, v_e, sigmas: [f64; 2], walk| {
            Delayed::new(TranslationFilter::new(PointMotion { r_e, v_e }, sigmas, walk, gravity), oldest)
        };
        let debris_motion = start.debris.map(|debris| {
            let sigmas = [believed.debris_position_sigma, believed.debris_velocity_sigma];
            translation(debris.r_gdo_e, debris.v_gdo_e, sigmas, believed.debris_velocity_walk)
        });
        let debris = start.debris.zip(mass.debris).map(|(debris, body)| {
            let sigmas = [believed.debris_attitude_sigma, believed.debris_rate_sigma];
            let walk = believed.debris_rate_walk;
            Delayed::new(RigidBodyFilter::new(body.inertia, debris.q_ed, debris.omega_de_d, sigmas, walk), oldest)
        });
        let sigmas = [believed.position_sigma, believed.velocity_sigma];
        Mekf {
            mass,
            tick: context.tick,
            intervals: VecDeque::from(vec![context.tick; oldest]),
            time: 0.0,
            sensors,
            attitude,
            motion: translation(start.r_co_e, start.v_co_e, sigmas, believed.velocity_walk),
            debris_motion,
            debris,
            wheel_rates: start.wheel_rates,
        }
    }

    /// Attitude and rate of the spacecraft `age` updates ago.
    fn attitude_at(&self, age: usize) -> ([f64; 4], [f64; 3]) {
        match &self.attitude {
            Attitude::WithGyro(filter, _) => (filter.at(age).q_es, filter.at(age).omega_se_s()),
            Attitude::WithoutGyro(filter) => (filter.at(age).q, filter.at(age).omega),
        }
    }

    fn covariances_at(&self, age: usize) -> [[[f64; 3]; 3]; 2] {
        match &self.attitude {
            Attitude::WithGyro(filter, turned) => {
                let [of_turn, _, of_bias] = corners(&filter.at(age).covariance);
                [of_turn, added(&of_bias, &diagonal([turned.variance; 3]))]
            }
            Attitude::WithoutGyro(filter) => {
                let [of_turn, _, of_rate] = corners(&filter.at(age).covariance);
                [of_turn, of_rate]
            }
        }
    }

    /// Number of updates in the last `age` seconds; sensors measure at updates.
    fn updates_in(&self, age: f64) -> usize {
        let mut left = age - 0.5 * self.tick;
        let after = |interval: &f64| {
            left -= interval;
            left + interval > 0.0
        };
        self.intervals.iter().copied().take_while(after).count()
    }

    fn propagate(&mut self, update: &Update<'_>) {
        let interval = update.interval;
        self.intervals.push_front(interval);
        self.intervals.pop_back();
        let before = self.attitude_at(0);
        match &mut self.attitude {
            Attitude::WithGyro(filter, turned) => {
                let rotation_s = turned.rotation(&self.sensors, update);
                filter.propagate(GyroStep { rotation_s, rate_s: turned.rate, interval });
            }
            Attitude::WithoutGyro(filter) => {
                let momenta = wheel_momenta(&self.mass, before.1, &self.wheel_rates);
                let momentum = momenta.fold([0.0; 3], sum);
                filter.propagate(BodyStep { torque: update.torque_s, momentum, interval });
            }
        }
        let after = self.attitude_at(0);
        let mut acceleration_e = [0.0; 3];
        if update.acceleration_s != [0.0; 3] {
            // mean over the tick: the body turns during a burn
            let at = |q| product(dcm_from_quaternion(q), update.acceleration_s);
            acceleration_e = scaled(0.5, sum(at(before.0), at(after.0)));
        }
        self.motion.propagate(TranslationStep { acceleration_e, interval });
        if let Some(filter) = &mut self.debris_motion {
            filter.propagate(TranslationStep { acceleration_e: [0.0; 3], interval });
        }
        if let Some(filter) = &mut self.debris {
            filter.propagate(BodyStep { torque: [0.0; 3], momentum: [0.0; 3], interval });
        }
        let of_body = difference(after.1, before.1);
        let turning = self.mass.wheels.iter().enumerate();
        for (index, wheel) in turning.filter(|(_, wheel)| wheel.mode != WheelMode::SpeedHeld) {
            let of_motor = interval * update.motor_torques[index] / wheel.axial;
            self.wheel_rates[index] += of_motor - dot(wheel.axis, of_body);
        }
    }

    /// Processes measurements that depend on the spacecraft's attitude.
    fn take(&mut self, measurement: &Measurement) {
        let (age, values) = (self.updates_in(measurement.age), &measurement.values);
        match &self.sensors[measurement.sensor] {
            SensorModel::Motion(sigmas) => {
                let sigmas = *sigmas;
                if let Some(base) = PointMotion::of(values, 0) {
                    let (q_es, omega) = self.attitude_at(age);
                    let motion = center_of(base, self.mass.center, q_es, omega);
                    self.motion.update(MotionObservation { motion, sigmas }, age);
                }
                if let (Some(motion), Some(filter)) = (PointMotion::of(values, 6), &mut self.debris_motion) {
                    filter.update(MotionObservation { motion, sigmas }, age);
                }
            }
            SensorModel::DebrisAttitude(sigmas) => {
                let [of_turn, of_rate] = sigmas.map(|sigma| sigma * sigma);
                let (q_sd, omega_ds_d): ([f64; 4], [f64; 3]) = (part(values, 0), part(values, 4));
                let (q_es, omega) = self.attitude_at(age);
                let [turn_covariance, rate_covariance] = self.covariances_at(age);
                let c_ds = dcm_from_quaternion(conjugate(q_sd));
                let in_debris = |p: [[f64; 3]; 3]| multiplied(&multiplied(&c_ds, &p), &transposed(&c_ds));
                let noise = |variance| diagonal([variance; 3]);
                let seen = MeasuredMotion {
                    q: hamilton(q_es, q_sd),
                    attitude_covariance: in_debris(added(&turn_covariance, &noise(of_turn))),
                    omega: sum(omega_ds_d, product(c_ds, omega)),
                    rate_covariance: added(&in_debris(rate_covariance), &noise(of_rate)),
                };
                if let Some(filter) = &mut self.debris {
                    filter.update(BodyObservation::AttitudeAndRate(seen), age);
                }
            }
            SensorModel::WheelRates => self.wheel_rates = part(values, 0),
            // already processed
            SensorModel::Gyro(..) | SensorModel::Attitude(_) => {}
        }
    }
}

impl GyroPropagation {
    /// The rotation over a tick, as measured or, between samples, as predicted.
    fn rotation(&mut self, sensors: &[SensorModel], update: &Update<'_>) -> [f64; 3] {
        let mut measured = ([1.0, 0.0, 0.0, 0.0], 0.0);
        for measurement in update.measurements {
            if let SensorModel::Gyro(_, period) = sensors[measurement.sensor] {
                let rotation = quaternion_of(part(&measurement.values, 0));
                measured = (hamilton(measured.0, rotation), measured.1 + period);
            }
        }
        if measured.1 > 0.0 {
            self.rate = scaled(1.0 / measured.1, vector_of(measured.0));
            let predicted = std::mem::replace(&mut self.predicted, [1.0, 0.0, 0.0, 0.0]);
            vector_of(hamilton(conjugate(predicted), measured.0))
        } else {
            let rotation = scaled(update.interval, self.rate);
            self.predicted = hamilton(self.predicted, quaternion_of(rotation));
            rotation
        }
    }
}

fn ticks(time: f64, tick: f64) -> usize {
    (time / tick).round() as usize
}

impl Estimator for Mekf {
    fn update(&mut self, update: &Update<'_>, estimate: &mut Estimate) {
        if update.interval > 0.0 {
            self.propagate(update);
        }
        self.time += update.interval;
        for measurement in update.measurements {
            if let SensorModel::Attitude(sensor) = &self.sensors[measurement.sensor] {
                let time = self.time - measurement.age;
                let observation = AttitudeObservation { values: measurement.values, sensor: sensor.clone(), time };
                let age = self.updates_in(measurement.age);
                match &mut self.attitude {
                    Attitude::WithGyro(filter, _) => filter.update(observation, age),
                    Attitude::WithoutGyro(filter) => filter.update(BodyObservation::Attitude(observation), age),
                }
            }
        }
        for measurement in update.measurements {
            self.take(measurement);
        }
        let (q_es, omega_se_s) = self.attitude_at(0);
        let motion = self.motion.at(0).motion;
        let debris = self.debris.as_ref().zip(self.debris_motion.as_ref()).map(|(body, point)| DebrisState {
            r_gdo_e: point.at(0).motion.r_e,
            v_gdo_e: point.at(0).motion.v_e,
            q_ed: body.at(0).q,
            omega_de_d: body.at(0).omega,
        });
        let gyro_bias_s = match &self.attitude {
            Attitude::WithGyro(filter, _) => filter.at(0).bias_s,
            Attitude::WithoutGyro(_) => [0.0; 3],
        };
        let (r_co_e, v_co_e) = (motion.r_e, motion.v_e);
        *estimate = Estimate { q_es, omega_se_s, gyro_bias_s, r_co_e, v_co_e, wheel_rates: self.wheel_rates, debris };
    }

    fn filters(&self) -> Filters {
        let motion = |filter: &Delayed<TranslationFilter>| Confidence {
            covariance: Covariance::Motion(filter.at(0).covariance),
            innovations: filter.innovations,
        };
        let body = |filter: &Delayed<RigidBodyFilter>| Confidence {
            covariance: Covariance::AttitudeAndRate(filter.at(0).covariance),
            innovations: filter.innovations,
        };
        let attitude = match &self.attitude {
            Attitude::WithGyro(filter, turned) => Confidence {
                covariance: Covariance::AttitudeAndBias {
                    covariance: filter.at(0).covariance,
                    rate_variance: turned.variance,
                },
                innovations: filter.innovations,
            },
            Attitude::WithoutGyro(filter) => body(filter),
        };
        let of_debris = (self.debris_motion.as_ref().map(motion), self.debris.as_ref().map(body));
        [Some(attitude), Some(motion(&self.motion)), of_debris.0, of_debris.1]
    }
}
