//! [`InputSensitivity`]: the effect of one input on one outcome.

use crate::analysis::effects::{Dependence, Direction, OnEvent};
use crate::analysis::event::Occurs;
use crate::statistics::correlation::Estimate;

/// Pseudo-outcome: 1 for an `ok` run, else 0.
pub const COMPUTED: &str = "computed";

/// `None` for measures that do not apply.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InputSensitivity {
    pub observable: String,
    /// Column of the rows; a distribution for a `saltelli` design.
    pub input: String,
    pub rows: u64,
    pub pearson: Option<Estimate>,
    pub spearman: Option<Estimate>,
    /// Rank correlation with the other inputs held fixed.
    pub partial_rank: Option<Estimate>,
    pub regression: Option<Estimate>,
    /// R^2 of the regression on all inputs, corrected for their number.
    pub r_squared: Option<Estimate>,
    pub first_order: Option<Estimate>,
    /// Share of the variance explained by a parabola, averaged over values and ranks; orders inputs without a
    /// first-order index.
    pub parabola: Option<f64>,
    /// Total index, including interactions.
    pub total: Option<Estimate>,
    /// P-value of no influence on the spread, adjusted for all inputs (Holm).
    pub p_value: Option<f64>,
    pub direction: Option<Direction>,
    pub on_events: Vec<OnEvent>,
    /// A correlated input that the rows do not separate from this one.
    pub instead: Option<String>,
    /// The input with the largest notable rank correlation.
    pub correlated_with: Option<(String, f64)>,
    pub note: Option<String>,
}

impl InputSensitivity {
    /// Removes intervals if the rows are no sample of the population, except of missed requirements if
    /// `has_all_missed`.
    #[must_use]
    pub fn without_intervals(mut self, has_all_missed: bool) -> Self {
        let without = |one: Estimate| Estimate { lower: f64::NAN, upper: f64::NAN, ..one };
        for one in [
            &mut self.pearson,
            &mut self.spearman,
            &mut self.partial_rank,
            &mut self.regression,
            &mut self.r_squared,
            &mut self.first_order,
            &mut self.total,
        ] {
            *one = one.map(without);
        }
        for effect in &mut self.on_events {
            if has_all_missed && matches!(effect.event.occurs, Occurs::Missed { .. }) {
                continue;
            }
            effect.share = effect.share.map(without);
            if let Dependence::Levels { ratio, .. } = &mut effect.dependence {
                *ratio = without(*ratio);
            }
        }
        self
    }
}
