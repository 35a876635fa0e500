//! What statistics, verdicts and bands of a campaign are on the page.

use crate::campaign::Statement;
use crate::dataset::statistics::{ColumnStatistics, Statistics};
use crate::dataset::verdicts::{Assessment, Verdicts};
use crate::ensemble::Bands;
use crate::report::page::Contents;
use crate::report::page::cards::{Card, Judged, driven_by};
use crate::report::page::influence::Influence;
use crate::report::page::over_time::TimeBands;
use crate::report::page::tables::StatisticsRow;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::Limit;

/// Probabilities of the bands.
const PROBABILITIES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

impl Contents {
    /// The same with what was computed from the rows, and the names and checksums of the files.
    #[must_use]
    pub fn with_analysis(
        self,
        statistics: &Statistics,
        verdicts: &Verdicts,
        bands: Option<&Bands>,
        files: Vec<(String, String)>,
    ) -> Self {
        let counted = statistics.columns.iter().filter(|column| column.moments.count() > 0);
        Contents {
            statistics: counted.map(row).collect(),
            verdicts: verdicts.list.iter().map(|one| card(one, &self.influences)).collect(),
            bands: bands.map_or_else(Vec::new, time_bands),
            files,
            ..self
        }
    }
}

fn row(column: &ColumnStatistics) -> StatisticsRow {
    let end = |end: Option<f64>| end.unwrap_or(f64::NAN);
    let moments = &column.moments;
    StatisticsRow {
        name: column.quantity.name().to_owned(),
        unit: column.quantity.unit().to_owned(),
        meaning: column.quantity.meaning().to_owned(),
        count: moments.count(),
        mean: end(moments.mean()),
        deviation: end(moments.standard_deviation()),
        min: end(moments.min()),
        max: end(moments.max()),
        quantiles: column
            .quantiles
            .iter()
            .map(|found| [found.p, end(found.value), end(found.interval[0]), end(found.interval[1])])
            .collect(),
    }
}

/// A requirement as a card: the estimate is that of what the gate decides, in percent for a share of runs.
fn card(one: &Assessment, influences: &[Influence]) -> Card {
    let requirement = &one.requirement;
    let (limit, is_upper) = match requirement.limit {
        Limit::AtMost(limit) => (limit, true),
        Limit::AtLeast(limit) => (limit, false),
    };
    let is_mean = matches!(requirement.statement, Statement::Mean);
    let share = match requirement.statement {
        Statement::Quantile(p) if is_upper => p,
        Statement::Quantile(p) => 1.0 - p,
        Statement::Fraction(fraction) => fraction,
        Statement::Mean => f64::NAN,
    };
    let [low, high] = one.gate.bounds;
    let mut notes = vec![format!("{} of {} runs are not within the limit.", one.violations, one.runs)];
    if let Decision::Undecided(runs) = one.gate.decision {
        notes.push(match runs {
            Some(runs) => format!("{runs} runs would decide, if the share stays as it is."),
            None => "No number of runs would decide at this share.".to_owned(),
        });
    }
    notes.extend(one.value.map(|value| format!("Estimate: {value:.4e} {}.", one.unit)));
    notes.extend(one.reason.clone());
    Card {
        judged: match one.gate.decision {
            Decision::Pass => Judged::Pass,
            Decision::Fail => Judged::Fail,
            Decision::Undecided(_) => Judged::Undecided,
        },
        quantity: requirement.observable.replace('_', " "),
        sentence: format!("{}.", one.sentence()),
        statistic: if is_mean { "mean".to_owned() } else { "runs within the limit".to_owned() },
        estimate: if is_mean { one.gate.estimate } else { 100.0 * one.gate.estimate },
        interval: if is_mean { [low, high] } else { [100.0 * low, 100.0 * high] },
        confidence: requirement.confidence,
        limit: Some(if is_mean { (limit, is_upper) } else { (100.0 * share, false) }),
        unit: if is_mean { one.unit.clone() } else { "%".to_owned() },
        note: notes.join(" "),
        drivers: driven_by(&requirement.observable, influences),
    }
}

fn time_bands(bands: &Bands) -> Vec<TimeBands> {
    let points = bands.times().len();
    let series = 0..bands.layout().series.len();
    series
        .map(|index| TimeBands {
            name: bands.quantity(index).name().to_owned(),
            times: bands.times().to_vec(),
            quantiles: PROBABILITIES
                .map(|p| (0..points).map(|point| bands.quantile(index, point, p).unwrap_or(f64::NAN)).collect()),
            runs: (0..points).map(|point| bands.count(index, point)).max().unwrap_or(0),
        })
        .collect()
}
