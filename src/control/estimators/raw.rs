//! Raw measurements: the last of each kind, held until the next, latency and all; the nominal state before the first.
//!
//! The rate is that of the gyro, bias and all, or without one the turn between the last two attitudes over the time between them.

use super::{Estimator, EstimatorContext, EstimatorKind, Update, center_of};
use crate::control::estimate::Estimate;
use crate::control::measurement::Measurement;
use crate::control::rotation::vector_of;
use crate::control::vector::{conjugate, dcm_from_quaternion, hamilton, product, scaled, sum};

pub(super) const KIND: EstimatorKind =
    EstimatorKind { name: "raw", parameters: &[], make: |context| Box::new(Raw::new(context)) };

struct Raw {
    estimate: Estimate,
    /// Centre of mass from p in F_s, nominal, m.
    center: [f64; 3],
    has_gyro: bool,
    time: f64,
    /// When the last attitude was taken, and which it was.
    last: Option<(f64, [f64; 4])>,
}

impl Raw {
    fn new(context: &EstimatorContext<'_>) -> Self {
        Raw {
            estimate: context.start(),
            center: context.nominal.mass.center,
            has_gyro: context.sensors.iter().any(|sensor| sensor.kind == "rate_gyro"),
            time: 0.0,
            last: None,
        }
    }
}

impl Estimator for Raw {
    fn update(&mut self, update: &Update<'_>) -> Estimate {
        self.time += update.interval;
        let estimate = &mut self.estimate;
        for (_, measurement) in update.measurements {
            match *measurement {
                Measurement::Rotation { rotation_s, interval } => {
                    estimate.omega_se_s = scaled(1.0 / interval, rotation_s);
                }
                Measurement::Attitude { q_es, age } => {
                    let taken = self.time - age;
                    if let Some((before, q)) = self.last.replace((taken, q_es))
                        && !self.has_gyro
                        && taken > before
                    {
                        let turn = vector_of(hamilton(conjugate(q), q_es));
                        estimate.omega_se_s = scaled(1.0 / (taken - before), turn);
                    }
                    estimate.q_es = q_es;
                }
                Measurement::Radar { .. } | Measurement::Camera { .. } => {}
                Measurement::WheelRates { rates } => estimate.wheel_rates = rates,
            }
        }
        // those that are seen through the attitude of this tick, whatever the order of the sensors
        let (q_es, omega_se_s) = (estimate.q_es, estimate.omega_se_s);
        for (_, measurement) in update.measurements {
            match (*measurement, &mut estimate.debris) {
                (Measurement::Radar { base, debris, .. }, believed) => {
                    let center = center_of(base, self.center, q_es, omega_se_s);
                    (estimate.r_co_e, estimate.v_co_e) = (center.r_e, center.v_e);
                    if let (Some(seen), Some(believed)) = (debris, believed) {
                        (believed.r_gdo_e, believed.v_gdo_e) = (seen.r_e, seen.v_e);
                    }
                }
                (Measurement::Camera { q_sd, omega_ds_d, .. }, Some(believed)) => {
                    believed.q_ed = hamilton(q_es, q_sd);
                    let of_spacecraft = product(dcm_from_quaternion(conjugate(q_sd)), omega_se_s);
                    believed.omega_de_d = sum(omega_ds_d, of_spacecraft);
                }
                _ => {}
            }
        }
        *estimate
    }
}
