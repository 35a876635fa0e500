//! Filters of all that is estimated: attitude and gyro bias ([`super::attitude_filter`]), or without a gyro attitude and rate by the nominal body's equation
//! of motion ([`super::rigid_body_filter`]); position and velocity of spacecraft and debris ([`super::translation_filter`]); attitude and rate of the
//! debris, torque-free, which keep on through gaps of the camera.
//!
//! They start at the nominal state, at no bias, and believe the nominal noise of the sensors. Measurements are taken at their time. The debris is seen through the
//! estimated attitude and rate of the spacecraft: their covariance adds to the camera's noise, as if it were white, which it is not.
//! The first gyro is used; where it measures less often than the loop ticks, the rotation in between is predicted at its last rate and put right when it
//! measures. Rates of wheels follow the commanded torques of motors from one tachometer reading to the next.

use super::attitude_filter::{AttitudeFilter, AttitudeObservation, GyroNoise, GyroStep};
use super::delayed::Delayed;
use super::kalman::{NormalizedSquare, corners};
use super::rigid_body_filter::{BodyObservation, BodyStep, RigidBodyFilter};
use super::translation_filter::{MotionObservation, TranslationFilter, TranslationStep};
use super::{Consistency, Estimator, EstimatorContext, EstimatorKind, Update, center_of};
use crate::control::estimate::Estimate;
use crate::control::laws::wheel_momenta;
use crate::control::measurement::{Measurement, PointMotion};
use crate::control::rotation::{quaternion_of, vector_of};
use crate::control::sensors::number;
use crate::control::sensors::star_tracker::covariance_s;
use crate::control::small_matrix::{added, diagonal, multiplied, transposed};
use crate::control::truth::{DebrisState, Truth};
use crate::control::vector::{conjugate, dcm_from_quaternion, difference, dot, hamilton, product, scaled, sum};
use crate::scene::schema::Limit;
use crate::scene::{LawParameter, MAX_WHEELS, MassProperties, WheelMode};

pub(super) const KIND: EstimatorKind =
    EstimatorKind { name: "mekf", parameters: &PARAMETERS, make: |context| Box::new(Mekf::new(context)) };

const fn belief(key: &'static str, unit: &'static str, meaning: &'static str, default: &'static [f64]) -> LawParameter {
    LawParameter::number(key, unit, meaning, Limit::NotNegative).or(default)
}

static PARAMETERS: [LawParameter; 13] = [
    belief("initial_attitude_sigma_rad", "rad", "Initial standard deviation of the attitude, about each axis", &[0.1]),
    belief(
        "initial_bias_sigma_rad_s",
        "rad/s",
        "Initial standard deviation of the gyro bias, first estimated as zero",
        &[1e-4],
    ),
    belief("initial_rate_sigma_rad_s", "rad/s", "Initial standard deviation of the rate; without a gyro", &[0.1]),
    belief(
        "rate_random_walk_rad_s_sqrt_s",
        "rad/s/sqrt(s)",
        "Process noise of the rate: unknown torque; without a gyro",
        &[1e-4],
    ),
    belief("initial_position_sigma_m", "m", "Initial standard deviation of the position, along each axis", &[10.0]),
    belief("initial_velocity_sigma_m_s", "m/s", "Initial standard deviation of the velocity, along each axis", &[0.1]),
    belief(
        "velocity_random_walk_m_s_sqrt_s",
        "m/s/sqrt(s)",
        "Process noise of the velocity: unknown acceleration",
        &[1e-4],
    ),
    belief("debris_position_sigma_m", "m", "Initial standard deviation of the debris's position", &[10.0]),
    belief("debris_velocity_sigma_m_s", "m/s", "Initial standard deviation of the debris's velocity", &[0.1]),
    belief(
        "debris_velocity_random_walk_m_s_sqrt_s",
        "m/s/sqrt(s)",
        "Process noise of the debris's velocity: unknown acceleration",
        &[1e-5],
    ),
    belief("debris_attitude_sigma_rad", "rad", "Initial standard deviation of the debris's attitude", &[1.0]),
    belief("debris_rate_sigma_rad_s", "rad/s", "Initial standard deviation of the debris's rate", &[0.1]),
    belief(
        "debris_rate_random_walk_rad_s_sqrt_s",
        "rad/s/sqrt(s)",
        "Process noise of the debris's rate: unknown torque",
        &[1e-5],
    ),
];

/// What the filters believe of a sensor.
#[derive(Clone, Copy, Debug)]
enum Believed {
    /// The gyro that is used.
    Gyro,
    /// Covariance of an attitude, rad^2.
    Tracker([[f64; 3]; 3]),
    /// Standard deviations of position, m, and velocity, m/s.
    Radar([f64; 2]),
    /// Variances of relative attitude, rad^2, and rate, rad^2/s^2.
    Camera([f64; 2]),
    /// It measures rates of wheels, or something that the filters do not use.
    Other,
}

/// The filter of the spacecraft's attitude.
enum Attitude {
    WithGyro(Delayed<AttitudeFilter>, Turned),
    WithoutGyro(Delayed<RigidBodyFilter>),
}

/// What the gyro has told.
struct Turned {
    /// The rotation since its last measurement, as predicted.
    predicted: [f64; 4],
    /// Its last rate, with the bias, rad/s.
    rate: [f64; 3],
    /// Variance of that rate about the bias, rad^2/s^2.
    variance: f64,
}

struct Mekf {
    mass: MassProperties,
    tick: f64,
    believed: Vec<Believed>,
    attitude: Attitude,
    motion: Delayed<TranslationFilter>,
    debris_motion: Option<Delayed<TranslationFilter>>,
    debris: Option<Delayed<RigidBodyFilter>>,
    wheel_rates: [f64; MAX_WHEELS],
    innovations: Consistency,
    /// Sum and number of the normalised squares of the innovations since the start, over their degrees of freedom.
    innovation_sums: [[f64; 2]; 4],
}

impl Mekf {
    fn new(context: &EstimatorContext<'_>) -> Self {
        let (start, mass) = (context.start(), context.nominal.mass);
        let own = |key: &str| number(context.parameters, key);
        let mut gyro = None;
        let mut believed = Vec::new();
        let mut oldest = 0;
        for sensor in context.sensors {
            let table = sensor.parameters;
            let square = |key: &str| number(table, key) * number(table, key);
            believed.push(match sensor.kind {
                "rate_gyro" if gyro.is_none() => {
                    gyro = Some(sensor);
                    Believed::Gyro
                }
                "star_tracker" => Believed::Tracker(covariance_s(table)),
                "ground_radar" => {
                    Believed::Radar([number(table, "position_noise_m"), number(table, "velocity_noise_m_s")])
                }
                "relative_camera" => Believed::Camera([square("attitude_noise_rad"), square("rate_noise_rad_s")]),
                _ => Believed::Other,
            });
            oldest = oldest.max(ticks(sensor.latency, context.tick));
        }
        let sigma = own("initial_attitude_sigma_rad");
        let attitude = match gyro {
            Some(sensor) => {
                let table = sensor.parameters;
                let angular_random_walk = number(table, "angular_random_walk_rad_sqrt_s");
                let noise =
                    GyroNoise { angular_random_walk, bias_random_walk: number(table, "bias_random_walk_rad_s_sqrt_s") };
                let mut filter = AttitudeFilter::new(start.q_es, sigma, own("initial_bias_sigma_rad_s"), noise);
                filter.rate_s = start.omega_se_s;
                let variance = angular_random_walk * angular_random_walk / sensor.period;
                let turned = Turned { predicted: [1.0, 0.0, 0.0, 0.0], rate: start.omega_se_s, variance };
                Attitude::WithGyro(Delayed::new(filter, oldest), turned)
            }
            None => {
                let sigmas = [sigma, own("initial_rate_sigma_rad_s")];
                let walk = own("rate_random_walk_rad_s_sqrt_s");
                let filter = RigidBodyFilter::new(mass.inertia_rotating(), start.q_es, start.omega_se_s, sigmas, walk);
                Attitude::WithoutGyro(Delayed::new(filter, oldest))
            }
        };
        let translation = |r_e, v_e, position: &str, velocity: &str, walk: &str| {
            let motion = PointMotion { r_e, v_e };
            Delayed::new(TranslationFilter::new(motion, [own(position), own(velocity)], own(walk)), oldest)
        };
        let debris_motion = start.debris.map(|debris| {
            let sigmas = ("debris_position_sigma_m", "debris_velocity_sigma_m_s");
            let walk = "debris_velocity_random_walk_m_s_sqrt_s";
            translation(debris.r_gdo_e, debris.v_gdo_e, sigmas.0, sigmas.1, walk)
        });
        let debris = start.debris.zip(mass.debris).map(|(debris, body)| {
            let sigmas = [own("debris_attitude_sigma_rad"), own("debris_rate_sigma_rad_s")];
            let walk = own("debris_rate_random_walk_rad_s_sqrt_s");
            Delayed::new(RigidBodyFilter::new(body.inertia, debris.q_ed, debris.omega_de_d, sigmas, walk), oldest)
        });
        let sigmas = ("initial_position_sigma_m", "initial_velocity_sigma_m_s");
        Mekf {
            mass,
            tick: context.tick,
            believed,
            attitude,
            motion: translation(start.r_co_e, start.v_co_e, sigmas.0, sigmas.1, "velocity_random_walk_m_s_sqrt_s"),
            debris_motion,
            debris,
            wheel_rates: start.wheel_rates,
            innovations: Consistency::default(),
            innovation_sums: [[0.0; 2]; 4],
        }
    }

    /// Attitude and rate of the spacecraft `age` ticks ago.
    fn attitude_at(&self, age: usize) -> ([f64; 4], [f64; 3]) {
        match &self.attitude {
            Attitude::WithGyro(filter, _) => (filter.at(age).q_es, filter.at(age).omega_se_s()),
            Attitude::WithoutGyro(filter) => (filter.at(age).q, filter.at(age).omega),
        }
    }

    /// Covariances of attitude and rate of the spacecraft `age` ticks ago, in F_s.
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

    /// Moves on by a tick.
    fn propagate(&mut self, update: &Update<'_>) {
        let interval = update.interval;
        let before = self.attitude_at(0);
        match &mut self.attitude {
            Attitude::WithGyro(filter, turned) => {
                let rotation_s = turned.rotation(&self.believed, update);
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
            // mean of both ends: the body turns during a burn
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

    /// Takes what is seen through the attitude of the spacecraft.
    fn take(&mut self, measurement: &Measurement, believed: Believed) {
        match (*measurement, believed) {
            (Measurement::Radar { base, debris, age }, Believed::Radar(sigmas)) => {
                let age = ticks(age, self.tick);
                let (q_es, omega) = self.attitude_at(age);
                let motion = center_of(base, self.mass.center, q_es, omega);
                self.innovations.motion_innovation = self.motion.update(MotionObservation { motion, sigmas }, age);
                if let (Some(motion), Some(filter)) = (debris, &mut self.debris_motion) {
                    self.innovations.debris_motion_innovation =
                        filter.update(MotionObservation { motion, sigmas }, age);
                }
            }
            (Measurement::Camera { q_sd, omega_ds_d, age }, Believed::Camera([of_turn, of_rate])) => {
                let age = ticks(age, self.tick);
                let (q_es, omega) = self.attitude_at(age);
                let [turn_covariance, rate_covariance] = self.covariances_at(age);
                let c_ds = dcm_from_quaternion(conjugate(q_sd));
                let in_debris = |p: [[f64; 3]; 3]| multiplied(&multiplied(&c_ds, &p), &transposed(&c_ds));
                let noise = |variance| diagonal([variance; 3]);
                let covariance = in_debris(added(&turn_covariance, &noise(of_turn)));
                let attitude = AttitudeObservation { q_es: hamilton(q_es, q_sd), covariance };
                let rate = sum(omega_ds_d, product(c_ds, omega));
                let of_both = added(&in_debris(rate_covariance), &noise(of_rate));
                if let Some(filter) = &mut self.debris {
                    let observation = BodyObservation::AttitudeAndRate(attitude, rate, of_both);
                    self.innovations.debris_innovation = filter.update(observation, age);
                }
            }
            (Measurement::WheelRates { rates }, _) => self.wheel_rates = rates,
            _ => {}
        }
    }
}

impl Turned {
    /// The rotation of a tick as measured, or as predicted where the gyro did not measure.
    fn rotation(&mut self, believed: &[Believed], update: &Update<'_>) -> [f64; 3] {
        let mut measured = ([1.0, 0.0, 0.0, 0.0], 0.0);
        for (sensor, measurement) in update.measurements {
            if let (Measurement::Rotation { rotation_s, interval }, Believed::Gyro) = (*measurement, believed[*sensor])
            {
                measured = (hamilton(measured.0, quaternion_of(rotation_s)), measured.1 + interval);
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

/// The nearest number of ticks to a time.
fn ticks(time: f64, tick: f64) -> usize {
    (time / tick).round() as usize
}

impl Estimator for Mekf {
    fn update(&mut self, update: &Update<'_>) -> Estimate {
        if update.interval > 0.0 {
            self.propagate(update);
        }
        self.innovations = Consistency::default();
        for (sensor, measurement) in update.measurements {
            if let (Measurement::Attitude { q_es, age }, Believed::Tracker(covariance)) =
                (*measurement, self.believed[*sensor])
            {
                let (observation, age) = (AttitudeObservation { q_es, covariance }, ticks(age, self.tick));
                self.innovations.attitude_innovation = match &mut self.attitude {
                    Attitude::WithGyro(filter, _) => filter.update(observation, age),
                    Attitude::WithoutGyro(filter) => filter.update(BodyObservation::Attitude(observation), age),
                };
            }
        }
        for (sensor, measurement) in update.measurements {
            self.take(measurement, self.believed[*sensor]);
        }
        let now = &self.innovations;
        let squares =
            [now.attitude_innovation, now.motion_innovation, now.debris_motion_innovation, now.debris_innovation];
        for ([sum, count], square) in self.innovation_sums.iter_mut().zip(squares) {
            if let Some(square) = square {
                (*sum, *count) = (*sum + square.value / square.degrees as f64, *count + 1.0);
            }
        }
        let (q_es, omega_se_s) = self.attitude_at(0);
        let motion = self.motion.now().motion;
        let debris = self.debris.as_ref().zip(self.debris_motion.as_ref()).map(|(body, point)| DebrisState {
            r_gdo_e: point.now().motion.r_e,
            v_gdo_e: point.now().motion.v_e,
            q_ed: body.now().q,
            omega_de_d: body.now().omega,
        });
        let gyro_bias_s = match &self.attitude {
            Attitude::WithGyro(filter, _) => filter.now().bias_s,
            Attitude::WithoutGyro(_) => [0.0; 3],
        };
        let (r_co_e, v_co_e) = (motion.r_e, motion.v_e);
        Estimate { q_es, omega_se_s, gyro_bias_s, r_co_e, v_co_e, wheel_rates: self.wheel_rates, debris }
    }

    fn consistency(&self, truth: &Truth, gyro_bias_s: Option<[f64; 3]>) -> Consistency {
        let body = &truth.body;
        let square = |filter: &Delayed<TranslationFilter>, r_e, v_e| -> Option<NormalizedSquare> {
            filter.now().error_square(&PointMotion { r_e, v_e })
        };
        let debris = truth.debris.as_ref();
        Consistency {
            attitude: match &self.attitude {
                Attitude::WithGyro(filter, _) => filter.now().error_square(body.q_es, gyro_bias_s),
                Attitude::WithoutGyro(filter) => filter.now().error_square(body.q_es, body.omega_se_s),
            },
            motion: square(&self.motion, body.r_co_e, body.v_co_e),
            debris_motion: debris
                .zip(self.debris_motion.as_ref())
                .and_then(|(debris, filter)| square(filter, debris.r_gdo_e, debris.v_gdo_e)),
            debris: debris
                .zip(self.debris.as_ref())
                .and_then(|(debris, filter)| filter.now().error_square(debris.q_ed, debris.omega_de_d)),
            mean_innovations: self.innovation_sums.map(|[sum, count]| (count > 0.0).then(|| sum / count)),
            ..self.innovations
        }
    }
}
