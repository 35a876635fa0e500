//! Perfect knowledge of the state, though not of the true parameters.

use super::estimator::{Estimator, EstimatorMaker, Update};
use crate::loops::estimate::Estimate;
use crate::loops::kinds::EstimatorKind;

pub(super) const KIND: EstimatorMaker = EstimatorMaker {
    kind: EstimatorKind { name: "perfect", knows_the_truth: true, has_filter: false, uses: |_| false, parameters: &[] },
    make: |_| Box::new(Perfect),
};

struct Perfect;

impl Estimator for Perfect {
    fn update(&mut self, update: &Update<'_>, estimate: &mut Estimate) {
        if let Some(state) = update.state {
            *estimate = *state;
        }
    }
}
