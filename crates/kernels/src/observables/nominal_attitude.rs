//! [`NominalAttitude`]: attitude of the nominal run at the observation points.

use crate::math::lanes::WIDTH;
use crate::run::{Outcome, StateField, StateTable};

/// Attitude quaternion q_es of the nominal run; NaN at points not reached.
#[derive(Clone, Debug)]
pub struct NominalAttitude([Vec<[f64; WIDTH]>; 4]);

impl NominalAttitude {
    /// The attitude of a run.
    ///
    /// # Panics
    /// If the table lacks the attitude.
    pub fn of(table: &StateTable, outcome: &Outcome) -> Self {
        NominalAttitude(std::array::from_fn(|component| {
            let mut column = table.column(StateField::Attitude, component).to_vec();
            column[outcome.points.min(table.points())..].fill(f64::NAN);
            column.as_chunks().0.to_vec()
        }))
    }

    #[inline(always)]
    pub(super) fn columns(&self, vectors: usize) -> [&[[f64; WIDTH]]; 4] {
        let [w, x, y, z] = &self.0;
        [&w[..vectors], &x[..vectors], &y[..vectors], &z[..vectors]]
    }
}
