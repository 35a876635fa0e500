//! Raw measurements: the last of each kind held until the next, latency included; the nominal state before the first.
//! On an orbit, positions and velocities fall freely after their measurement.
//!
//! The rate is the gyro's, bias included, or without a gyro the rotation between the last two attitudes over their
//! interval.

use super::estimator::{Estimator, EstimatorContext, EstimatorMaker, Update, center_of};
use super::translation_filter::falling;
use crate::dynamics::gravity::Gravity;
use crate::loops::estimate::Estimate;
use crate::loops::kinds::EstimatorKind;
use crate::loops::measurement::{PointMotion, part};
use crate::loops::observes::Observes;
use crate::loops::vector::{conjugate, dcm_from_quaternion, hamilton, product, scaled, sum, vector_of};

pub(super) const KIND: EstimatorMaker = EstimatorMaker {
    kind: EstimatorKind {
        name: "raw",
        knows_the_truth: false,
        has_filter: false,
        // a direction alone gives no attitude
        uses: |observes| !matches!(observes, Observes::Direction(_) | Observes::Field(_)),
        parameters: &[],
    },
    make: |context| Box::new(Raw::new(context)),
};

struct Raw {
    center: [f64; 3],
    /// Observation and period (s) of each sensor.
    sensors: Vec<(Observes, f64)>,
    has_gyro: bool,
    time: f64,
    gravity: Option<Gravity<f64>>,
    /// Time and value of the last attitude.
    last: Option<(f64, [f64; 4])>,
}

impl Raw {
    fn new(context: &EstimatorContext<'_>) -> Self {
        Raw {
            center: context.nominal.mass.center,
            sensors: context.sensors.iter().map(|sensor| (sensor.observes, sensor.period)).collect(),
            has_gyro: context.sensors.iter().any(|sensor| matches!(sensor.observes, Observes::Rotation(_))),
            time: 0.0,
            gravity: context.nominal.orbit.as_ref().map(Gravity::of),
            last: None,
        }
    }
}

impl Estimator for Raw {
    fn update(&mut self, update: &Update<'_>, estimate: &mut Estimate) {
        self.time += update.interval;
        let gravity = self.gravity;
        let later = |motion: PointMotion, time: f64| {
            gravity.map_or(motion, |gravity| falling(&motion, &gravity, [0.0; 3], time))
        };
        if gravity.is_some() {
            let own = later(PointMotion { r_e: estimate.r_co_e, v_e: estimate.v_co_e }, update.interval);
            (estimate.r_co_e, estimate.v_co_e) = (own.r_e, own.v_e);
            if let Some(debris) = &mut estimate.debris {
                let other = later(PointMotion { r_e: debris.r_gdo_e, v_e: debris.v_gdo_e }, update.interval);
                (debris.r_gdo_e, debris.v_gdo_e) = (other.r_e, other.v_e);
            }
        }
        for measurement in update.measurements {
            let values = &measurement.values;
            match self.sensors[measurement.sensor] {
                (Observes::Rotation(_), period) => estimate.omega_se_s = scaled(1.0 / period, part(values, 0)),
                (Observes::Attitude(_), _) => {
                    let (q_es, taken) = (part(values, 0), self.time - measurement.age);
                    if let Some((before, q)) = self.last.replace((taken, q_es))
                        && !self.has_gyro
                        && taken > before
                    {
                        let turn = vector_of(hamilton(conjugate(q), q_es));
                        estimate.omega_se_s = scaled(1.0 / (taken - before), turn);
                    }
                    estimate.q_es = q_es;
                }
                (Observes::WheelRates, _) => estimate.wheel_rates = part(values, 0),
                (Observes::Motion(_) | Observes::DebrisAttitude(_), _)
                | (Observes::Direction(_) | Observes::Field(_), _) => {}
            }
        }
        // measurements that depend on this tick's attitude, whatever the order of the sensors
        let (q_es, omega_se_s) = (estimate.q_es, estimate.omega_se_s);
        for measurement in update.measurements {
            let values = &measurement.values;
            match (self.sensors[measurement.sensor].0, &mut estimate.debris) {
                (Observes::Motion(_), believed) => {
                    if let Some(base) = PointMotion::of(values, 0) {
                        let center = later(center_of(base, self.center, q_es, omega_se_s), measurement.age);
                        (estimate.r_co_e, estimate.v_co_e) = (center.r_e, center.v_e);
                    }
                    if let (Some(seen), Some(believed)) = (PointMotion::of(values, 6), believed) {
                        let seen = later(seen, measurement.age);
                        (believed.r_gdo_e, believed.v_gdo_e) = (seen.r_e, seen.v_e);
                    }
                }
                (Observes::DebrisAttitude(_), Some(believed)) => {
                    let q_sd = part(values, 0);
                    believed.q_ed = hamilton(q_es, q_sd);
                    let of_spacecraft = product(dcm_from_quaternion(conjugate(q_sd)), omega_se_s);
                    believed.omega_de_d = sum(part(values, 4), of_spacecraft);
                }
                _ => {}
            }
        }
    }
}
