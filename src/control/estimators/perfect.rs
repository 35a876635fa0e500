//! Perfect knowledge: the true state; true parameters are not part of it.

use super::{Estimator, EstimatorKind, Update};
use crate::control::estimate::Estimate;

pub(super) const KIND: EstimatorKind = EstimatorKind { name: "perfect", parameters: &[], make: |_| Box::new(Perfect) };

struct Perfect;

impl Estimator for Perfect {
    fn update(&mut self, update: &Update<'_>) -> Estimate {
        let truth = update.truth;
        Estimate {
            q_es: truth.body.q_es,
            omega_se_s: truth.body.omega_se_s,
            gyro_bias_s: [0.0; 3],
            r_co_e: truth.body.r_co_e,
            v_co_e: truth.body.v_co_e,
            wheel_rates: truth.wheels.rates,
            debris: truth.debris,
        }
    }
}
