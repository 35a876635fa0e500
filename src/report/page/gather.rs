//! [`Contents::read`]: reads what the page is made of from the rows of a result.

use std::num::NonZeroUsize;

use crate::dataset::rows_reader::{RowsError, RowsReader};
use crate::ensemble::Ensemble;
use crate::report::page::influence::Influence;
use crate::report::page::shown_columns::{CONFIDENCE, interval};
use crate::report::page::survey::{Outcome, Survey};
use crate::report::page::tables::StatisticsRow;
use crate::report::page::{Contents, errors, is_independent};
use crate::statistics::correlation::{spearman, spearman_interval};

/// Outcomes whose drivers are shown where no requirement names one.
const DRIVEN: [&str; 4] =
    ["energy_error_max", "angular_momentum_error_max", "state_error_estimate", "exchange_body_peak_to_peak_j"];
/// Fewer runs than this say nothing about what drives them.
const FEWEST_RUNS: usize = 16;
/// Probabilities of the table of statistics.
const PROBABILITIES: [f64; 5] = [0.05, 0.5, 0.95, 0.99, 0.999];

impl Contents {
    /// What the rows alone say.
    ///
    /// # Errors
    /// Where a part cannot be read.
    pub fn read(ensemble: &Ensemble<'_>, rows: &RowsReader, threads: Option<NonZeroUsize>) -> Result<Self, RowsError> {
        let survey = Survey::new(ensemble, rows, &[], threads)?;
        let has_intervals = is_independent(ensemble.plan());
        let counted = survey.outcomes.iter().filter(|outcome| outcome.sketch.count() > 0);
        let statistics = counted.map(|outcome| row(outcome, has_intervals)).collect();
        let influences = influences(ensemble, &survey, has_intervals);
        Ok(Contents { survey, bands: Vec::new(), statistics, influences, verdicts: Vec::new(), files: Vec::new() })
    }
}

fn row(outcome: &Outcome, has_intervals: bool) -> StatisticsRow {
    let quantile = |p: f64| {
        let [low, high] = if has_intervals { interval(&outcome.sketch, p, CONFIDENCE) } else { [f64::NAN; 2] };
        [p, outcome.sketch.quantile(p).unwrap_or(f64::NAN), low, high]
    };
    StatisticsRow {
        name: outcome.quantity.name().to_owned(),
        unit: outcome.quantity.unit().to_owned(),
        meaning: outcome.quantity.meaning().to_owned(),
        count: outcome.sketch.count(),
        mean: f64::NAN,
        deviation: f64::NAN,
        min: outcome.sketch.min().unwrap_or(f64::NAN),
        max: outcome.sketch.max().unwrap_or(f64::NAN),
        quantiles: PROBABILITIES.map(quantile).to_vec(),
    }
}

/// Rank correlations of inputs and main outcomes in the thinned table.
fn influences(ensemble: &Ensemble<'_>, survey: &Survey, has_intervals: bool) -> Vec<Influence> {
    let plan = ensemble.plan();
    let rows = errors::shown_rows(survey);
    if rows.len() < FEWEST_RUNS || plan.dispersions.columns().is_empty() {
        return Vec::new();
    }
    let of = |column: &[f64]| rows.iter().map(|row| column[*row].abs()).collect::<Vec<f64>>();
    let signed = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
    let influence = |name: &&str| {
        let (index, outcome) = survey.outcome(name)?;
        let y = if outcome.is_error {
            of(&survey.thinned.outcomes[index])
        } else {
            signed(&survey.thinned.outcomes[index])
        };
        let input = |(column, values): (&crate::sampling::Column, &Vec<f64>)| {
            let r = spearman(&signed(values), &y);
            let found = spearman_interval(r, rows.len(), 0, CONFIDENCE);
            let ends = if has_intervals { [found.lower, found.upper] } else { [f64::NAN; 2] };
            (column.parameter.column_name(column.component), [found.value, ends[0], ends[1]])
        };
        let inputs = plan.dispersions.columns().iter().zip(&survey.thinned.inputs).map(input).collect();
        let correlated = if plan.correlated.is_empty() {
            ""
        } else {
            " Some inputs are correlated: their bars share what they explain together."
        };
        Some(Influence {
            outcome: (*name).to_owned(),
            measure: "rank correlation".to_owned(),
            meaning: format!(
                "Spearman's rank correlation of each input with the outcome, with its 95% interval, of {} runs: the sign says in which \
                 direction it acts, the length how strongly.{correlated}",
                rows.len()
            ),
            inputs,
        })
    };
    DRIVEN.iter().filter_map(influence).collect()
}
