//! [`InputSensitivity`]: what one input of a campaign means for one outcome.

use crate::analysis::effects::{Dependence, Direction, OnEvent};
use crate::analysis::event::Occurs;
use crate::statistics::correlation::Estimate;

/// The name of the outcome whether a run is computed: 1 where it is `ok`, else 0.
pub const COMPUTED: &str = "computed";

/// What one input means for one observable. What does not apply is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InputSensitivity {
    pub observable: String,
    /// The input: a column of the rows, or for a `saltelli` design what one distribution disperses.
    pub input: String,
    pub rows: u64,
    pub pearson: Option<Estimate>,
    pub spearman: Option<Estimate>,
    /// Rank correlation with the other inputs held fixed.
    pub partial_rank: Option<Estimate>,
    pub regression: Option<Estimate>,
    /// Share of the variance that the regression on all inputs explains, corrected for their number.
    pub r_squared: Option<Estimate>,
    /// First-order index: share of the variance that this input explains alone.
    pub first_order: Option<Estimate>,
    /// Share of the variance that a parabola explains, the mean of that of the values and that of their ranks: what
    /// orders inputs whose first-order index is not known.
    pub parabola: Option<f64>,
    /// Total index: share that this input and its interactions explain.
    pub total: Option<Estimate>,
    /// Probability of an influence on the spread as strong as this one where no input has any, of all inputs together
    /// (Holm).
    pub p_value: Option<f64>,
    /// How the observable goes with the input, where it is a driver of the spread and the rows show it.
    pub direction: Option<Direction>,
    /// What the input means for the events of the observable.
    pub on_events: Vec<OnEvent>,
    /// The correlated input that may drive the spread in place of this one: the rows do not tell the two apart.
    pub instead: Option<String>,
    /// The input that it is most correlated with, and their rank correlation, where that is notable.
    pub correlated_with: Option<(String, f64)>,
    /// What to know about these numbers.
    pub note: Option<String>,
}

impl InputSensitivity {
    /// The same without intervals: of rows that are not a sample of the population. Which runs miss a requirement is
    /// known of all runs; that keeps its intervals if `has_all_missed`.
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
