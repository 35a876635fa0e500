//! [`Statistics`]: the statistics of every observable, a function of plan and files.
//!
//! Counts and extremes are exact, moments are merged in the order of the parts, sketches hold counts: results do not
//! depend on threads. Quantiles are exact up to [`MOST_EXACT`](crate::analysis::column_counts::MOST_EXACT) rows, beyond
//! they come from sketches with an error bound. Columns are read in [`batches`].
//!
//! The nominal sample 0 counts only if it is alone. Runs that are not `ok` are left out of estimates, except for the
//! quantiles of requirements, which they violate. Intervals hold for all their possible values; for a mean, within the
//! range of the observable. After a big [`Loss`] there are no intervals.

use super::accumulator::of_files;
use super::observed::Observed;
use super::population::Population;
use crate::analysis::column_counts::{
    CLOSE, Collected, Collector, ColumnCounts, REFERENCE_ROWS, batches, is_exact, references,
};
use crate::analysis::order_statistics::{AskedQuantile, CommonRanks, Order, QuantileStatistic, of_quantile};
use crate::analysis::population::Loss;
use crate::analysis::statuses::Statuses;
use crate::campaign::{Plan, Requirement, Statement};
use crate::ensemble::threads::Threads;
use crate::run::{Quantity, Status};
use crate::statistics::gate::GateLimit;
use crate::statistics::mean::{MOST_SHARE, deviation_bounds, mean_bounds};
use crate::statistics::moments::Moments;
use crate::statistics::quantile::OrderStatistics;
use crate::statistics::replicates::{self, Step};
use crate::statistics::sketch::{RELATIVE_ERROR, Sketch};
use crate::storage::parallel::in_parallel;
use crate::storage::rows_reader::{Result, RowsReader};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColumnStatistics {
    pub quantity: Quantity,
    pub is_count: bool,
    /// `ok` runs without a value.
    pub without_value: u64,
    /// Over `ok` runs with a value.
    pub moments: Moments,
    /// `None` for an open end, or without an interval.
    pub mean_interval: [Option<f64>; 2],
    /// Standard error of the mean, of independent samples or of replicates.
    pub mean_error: Option<f64>,
    /// For independent samples; `None` as for the mean.
    pub deviation_interval: [Option<f64>; 2],
    /// Why mean and standard deviation are uncertain: no spread, few runs for the skewness, a heavy tail.
    pub note: Option<String>,
    /// The quantiles of the plan, ascending.
    pub quantiles: Vec<QuantileStatistic>,
    /// Difference of the 95% and 5% quantiles, in a campaign with audits.
    pub spread: Option<f64>,
    /// The quantiles of its requirements, which missing values violate.
    pub required: Vec<(Requirement, QuantileStatistic)>,
    /// Its distribution, if shown on the page.
    pub sketch: Option<Sketch>,
}

impl ColumnStatistics {
    pub fn quantile_numbers(&self) -> Vec<[f64; 4]> {
        self.quantiles.iter().map(QuantileStatistic::numbers).collect()
    }
}

/// The quantiles whose difference is the spread.
const SPREAD: [f64; 2] = [0.05, 0.95];

#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    pub population: Population,
    pub confidence: f64,
    /// Numbers of counted samples, in the order of [`Status::ALL`].
    pub statuses: [u64; Status::ALL.len()],
    /// Error bound of quantiles, relative to the smaller of their magnitude and their distance from a typical value; 0
    /// if exact.
    pub quantile_error: f64,
    pub columns: Vec<ColumnStatistics>,
}

impl Statistics {
    pub fn samples(&self) -> u64 {
        self.statuses.iter().sum()
    }

    pub fn ok(&self) -> u64 {
        let Loss { runs, missing, .. } = self.loss();
        runs - missing
    }

    pub fn required(&self, requirement: &Requirement) -> Option<&QuantileStatistic> {
        let column = self.column(requirement.observable()?)?;
        column.required.iter().find(|(one, _)| one == requirement).map(|(_, quantile)| quantile)
    }

    pub fn loss(&self) -> Loss {
        Loss::of(&self.statuses)
    }

    pub fn column(&self, name: &str) -> Option<&ColumnStatistics> {
        self.columns.iter().find(|column| column.quantity.name() == name)
    }

    pub fn treatment(&self) -> String {
        match self.samples() - self.ok() {
            0 => "every run was computed".to_owned(),
            _ if self.population == Population::Nominal => "the nominal run was not computed".to_owned(),
            failed => {
                let intervals = match self.population.has_intervals() && self.loss().missing > 0 {
                    true => " of estimates; intervals hold whatever values they would have",
                    false => "",
                };
                let verb = if failed == 1 { "was not computed and is" } else { "were not computed and are" };
                format!("{failed} of {} dispersed runs {verb} left out{intervals}", self.samples())
            }
        }
    }
}

/// The statistics of `plan` with the statuses `ended`, from `counted`, the first of the [`batches`], and the files of
/// its rows, on `threads` threads. Those in `shown` get sketches.
pub fn compute(
    plan: &Plan,
    reader: &RowsReader,
    ended: &Statuses,
    (mut counted, shown): (Option<Collected>, &[String]),
    threads: Threads,
) -> Result<Statistics> {
    let population = Population::of(plan);
    let is_exact = is_exact(plan);
    let loss = ended.loss();
    // population of the runs with numbers
    let left = population.after(loss);
    let mut columns = Vec::new();
    let mut describe = |observed: &[Observed], collected: Collected| {
        let with_value = collected.columns.first().map_or(0, |column| column.moments.count());
        let common = CommonRanks::new(plan, left, with_value + loss.missing);
        let lost = &collected.lost[..];
        let describe = |(observed, counts): (&Observed, ColumnCounts)| {
            let is_shown = shown.iter().any(|name| name == observed.name());
            described(plan, (left, loss, lost), (observed, is_shown), counts, &common)
        };
        columns.extend(in_parallel(observed.iter().zip(collected.columns).collect(), threads, describe));
    };
    for batch in batches(plan) {
        let of_batch = match counted.take() {
            Some(counted) => counted,
            None => {
                // plus the nominal row
                let first = || references(&batch, population, reader.first_parts(REFERENCE_ROWS + 1));
                let collector = Collector::new(batch.clone(), population, (!is_exact).then(first).transpose()?);
                let counted = of_files(&collector, reader, threads)?;
                collector.finish(counted)
            }
        };
        describe(&batch, of_batch);
    }
    let quantile_error = if is_exact { 0.0 } else { RELATIVE_ERROR };
    let (confidence, statuses) = (plan.analysis.confidence, ended.of_population());
    Ok(Statistics { population: left, confidence, statuses, quantile_error, columns })
}

fn described(
    plan: &Plan,
    (population, loss, lost): (Population, Loss, &[u64]),
    (observed, is_shown): (&Observed, bool),
    mut collected: ColumnCounts,
    common: &CommonRanks,
) -> ColumnStatistics {
    let confidence = plan.analysis.confidence;
    let mut whole = Sketch::default();
    let mut values = Vec::new();
    let groups = std::mem::take(&mut collected.groups);
    let of_groups: Vec<Moments> = groups.iter().map(|group| group.moments).collect();
    let sizes: Vec<u64> = of_groups.iter().zip(lost).map(|(group, lost)| group.count() + lost).collect();
    let all_lost: u64 = lost.iter().sum();
    let mut steps = Vec::new();
    let is_sketched = groups.iter().any(|group| group.sketch.count() > 0);
    let ranks = |sketch: &Sketch| {
        let ranks = sketch.ranks();
        if observed.is_count { ranks.of_whole_numbers() } else { ranks }
    };
    for (replicate, group) in groups.into_iter().enumerate() {
        if is_sketched {
            whole.merge(&group.sketch);
        }
        if matches!(population, Population::Replicated(_)) {
            let order = if is_sketched {
                Order::Sketched(ranks(&group.sketch))
            } else {
                Order::Exact(OrderStatistics::new(group.values.clone(), []))
            };
            steps.extend(order.steps(replicate));
        }
        if values.is_empty() {
            values = group.values;
        } else {
            values.extend(group.values);
        }
    }
    steps.sort_by(|a, b| a.value.total_cmp(&b.value));
    let moments = collected.moments;
    let sketch = is_shown.then(|| if is_sketched { whole.clone() } else { sketched(&values, &moments) });
    let count = moments.count();
    let asked = |p: f64| {
        let ranks = population.has_intervals().then(|| common.of(count + all_lost, p, confidence));
        AskedQuantile::new(p, confidence, ranks).with_lost(count, all_lost)
    };
    let with_missing = |p: f64, limit: GateLimit| {
        let runs = loss.runs.max(count);
        // known violations allow intervals
        let is_known = match Population::of(plan) {
            Population::Independent => true,
            other => other.has_intervals() && runs == count,
        };
        let ranks = is_known.then(|| common.of(runs, p, confidence));
        AskedQuantile::new(p, confidence, ranks).with_missing(count, runs - count, limit)
    };
    let requirements = plan.analysis.requirements_on(observed.name());
    let required = requirements.filter_map(|one| match one.statement {
        Statement::Quantile(p) => Some((one, with_missing(p, one.limit))),
        _ => None,
    });
    let required: Vec<(&Requirement, AskedQuantile)> = required.collect();
    let is_audited = plan.audit_fraction > 0.0;
    let ends: Vec<AskedQuantile> =
        SPREAD.iter().filter(|_| is_audited).map(|p| AskedQuantile::new(*p, confidence, None)).collect();
    let quantiles: Vec<AskedQuantile> = plan.analysis.quantiles.iter().map(|p| asked(*p)).collect();
    let order = if is_sketched {
        Order::Sketched(ranks(&whole))
    } else {
        let count = values.len();
        let all = quantiles.iter().chain(required.iter().map(|(_, one)| one)).chain(&ends);
        Order::Exact(OrderStatistics::new(values, all.flat_map(|one| one.places(count))))
    };
    let one_sided = 0.5 + 0.5 * confidence;
    let range = observed.range(plan);
    let bounds = |end: f64| {
        let filled = |moments: &Moments, lost: u64| {
            let mut all = *moments;
            all.merge(&Moments::of_block(&vec![end; lost as usize]));
            all
        };
        let whole = filled(&moments, all_lost);
        match population {
            Population::Replicated(_) => {
                let means = of_groups.iter().zip(lost).filter_map(|(group, lost)| filled(group, *lost).mean());
                replicates::mean_bounds(&means.collect::<Vec<f64>>(), &whole, one_sided)
            }
            _ => mean_bounds(&whole, one_sided),
        }
    };
    let is_in_range = moments.min() >= Some(range[0]) && moments.max() <= Some(range[1]);
    let mean = match all_lost {
        _ if !population.has_intervals() => [f64::NAN; 2],
        0 => bounds(0.0),
        _ => [0, 1].map(|end| if is_in_range && range[end].is_finite() { bounds(range[end])[end] } else { f64::NAN }),
    };
    let is_complete = population.has_intervals() && all_lost == 0;
    let mean_error = match population {
        Population::Replicated(_) => Moments::of(of_groups.iter().filter_map(Moments::mean)).mean_error(),
        _ => moments.mean_error(),
    };
    let known = |bounds: [f64; 2]| bounds.map(|end| Some(end).filter(|end| end.is_finite()));
    let mean_interval = known(mean);
    let deviation = deviation_bounds(&moments, one_sided);
    let of_replicates = |p: f64| {
        if all_lost == 0 {
            return replicates::quantile_interval(&steps, &sizes, p, confidence);
        }
        let with_lost = |end: f64| {
            let places = lost.iter().enumerate().filter(|(_, count)| **count > 0);
            let lost = places.map(|(replicate, count)| Step { value: end, lower: end, replicate, count: *count });
            let mut all: Vec<Step> = steps.iter().copied().chain(lost).collect();
            all.sort_by(|a, b| a.value.total_cmp(&b.value));
            replicates::quantile_interval(&all, &sizes, p, confidence)
        };
        let [low, high] = [with_lost(f64::NEG_INFINITY)[0], with_lost(f64::INFINITY)[1]];
        [low, high].map(|end| end.filter(|end| end.is_finite()))
    };
    let quantile = |asked: &AskedQuantile| {
        let mut found = of_quantile(&order, asked);
        let ranks = common.of(count + all_lost, asked.p, asked.confidence);
        let is_bounded = asked.missing == 0 && ranks.lower.is_some() && ranks.upper.is_some();
        if matches!(population, Population::Replicated(_)) && is_bounded {
            found.interval = of_replicates(asked.p);
            found.note = found.note.filter(|_| found.interval.contains(&None));
        }
        found
    };
    ColumnStatistics {
        quantity: observed.quantity.clone(),
        is_count: observed.is_count,
        without_value: collected.without_value,
        moments,
        mean_interval,
        mean_error: mean_error.filter(|_| is_complete),
        deviation_interval: if is_complete { known(deviation) } else { [None; 2] },
        note: match all_lost {
            _ if !population.has_intervals() => None,
            0 => note(&moments, mean_interval),
            _ => Some(with_lost_runs(all_lost, mean_interval)),
        },
        quantiles: quantiles.iter().map(quantile).collect(),
        spread: is_audited.then(|| Some(order.quantile(SPREAD[1])? - order.quantile(SPREAD[0])?)).flatten(),
        required: required.iter().map(|(one, asked)| ((*one).clone(), quantile(asked))).collect(),
        sketch,
    }
}

fn sketched(values: &[f64], moments: &Moments) -> Sketch {
    let range = moments.max().zip(moments.min()).map_or(0.0, |(max, min)| max - min);
    let mut sketch = Sketch::about(moments.mean().filter(|mean| range < CLOSE * mean.abs()).unwrap_or(0.0));
    sketch.add_all(values);
    sketch
}

fn with_lost_runs(lost: u64, mean_interval: [Option<f64>; 2]) -> String {
    let lost = match lost {
        1 => "1 run was not computed".to_owned(),
        _ => format!("{lost} runs were not computed"),
    };
    match mean_interval {
        [Some(_), Some(_)] => {
            format!("{lost}; the interval of the mean holds wherever in the range of the observable they are")
        }
        _ => format!("{lost}, and their values have no known bounds: the mean is not bounded on every side"),
    }
}

/// True if all values are 0 or 1: the mean of x (1 - x), positive in between, is 0.
pub fn is_yes_or_no(moments: &Moments) -> bool {
    let (Some(mean), Some(deviation)) = (moments.mean(), moments.standard_deviation()) else { return false };
    let count = moments.count() as f64;
    let of_square = deviation * deviation * (count - 1.0) / count + mean * mean;
    moments.min() == Some(0.0) && moments.max() == Some(1.0) && (mean - of_square).abs() < 1e-9 * mean
}

fn note(moments: &Moments, mean_interval: [Option<f64>; 2]) -> Option<String> {
    let skewness = moments.count().gt(&1).then(|| moments.skewness().unwrap_or(0.0))?;
    let share = moments.largest_share(2);
    match mean_interval {
        [None, None] if moments.standard_deviation() == Some(0.0) => Some(
            "all values are equal: whether the mean is that value these runs cannot tell, a rare event would not show"
                .to_owned(),
        ),
        [Some(_), Some(_)] if share <= MOST_SHARE || is_yes_or_no(moments) => None,
        [Some(_), Some(_)] => Some(format!(
            "heavy tail: one run makes {:.0}% of the variance, and intervals of mean and standard deviation may be too \
            narrow",
            100.0 * share
        )),
        _ => Some(format!("too few runs for their skewness of {skewness:.1}: the mean is not bounded on every side")),
    }
}

#[cfg(test)]
mod lost_runs;

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: values are yes or no if and only if each is 0 or 1 and both occur.
    #[test]
    fn yes_or_no_is_known_from_moments() {
        for (values, known) in [
            (vec![0.0, 1.0, 1.0], true),
            ([vec![0.0; 999], vec![1.0]].concat(), true),
            (vec![0.0, 0.5, 1.0], false),
            ([vec![0.0; 999], vec![1.0, 1e-3]].concat(), false),
            (vec![0.0, 2.0], false),
            (vec![1.0, 1.0], false),
        ] {
            assert_eq!(is_yes_or_no(&Moments::of(values.iter().copied())), known, "{values:?}");
        }
    }
}
