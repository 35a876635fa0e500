//! Verdicts on requirements over time, from the bands of a campaign.
//!
//! The limit applies at every band time in an interval for a share of the runs, not necessarily the same ones. The
//! number within it is known up to the bucket of the limit: both bounds must decide.

use super::population::Population;
use crate::analysis::assessment::{Assessment, WorstPoint};
use crate::analysis::order_statistics::among_values;
use crate::analysis::row_verdicts::Judged;
use crate::campaign::requirement::BandSubject;
use crate::campaign::{ShownUnit, Statement};
use crate::ensemble::Bands;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::{Gate, points_gate};

pub(super) fn over_time(
    judged: Judged<'_>,
    band: &BandSubject,
    bands: Option<&Bands>,
    runs: u64,
    population: Population,
) -> Assessment {
    let Judged { requirement, confidences, failed, .. } = judged;
    let found = bands.and_then(|bands| bands.find(&band.series).map(|series| (bands, series)));
    let points: Vec<(usize, f64)> = found.map_or_else(Vec::new, |(bands, _)| {
        bands.times().iter().copied().enumerate().filter(|(_, time)| band.contains(*time)).collect()
    });
    let within: Vec<([u64; 2], u64)> = found.map_or_else(Vec::new, |(bands, series)| {
        points.iter().map(|(point, _)| (bands.within(series, *point, requirement.limit), runs)).collect()
    });
    let target = requirement.share().unwrap_or(f64::NAN);
    let (mut gate, worst) = points_gate(&within, target, confidences);
    let mut interval = points_gate(&within, target, [judged.of_an_end(); 2]).0.bounds;
    let mut reason = None;
    if population != Population::Independent {
        gate = Gate { decision: Decision::Undecided(None), bounds: [f64::NAN; 2], ..gate };
        interval = [f64::NAN; 2];
        reason = Some(match population {
            Population::Replicated(_) => "no intervals: bands do not tell replicates apart".to_owned(),
            _ => population.about_intervals(),
        });
    } else if within.is_empty() {
        reason = Some("there are no bands of it".to_owned());
    } else if runs == 0 {
        reason = Some("there are no runs that count".to_owned());
    } else if let Some((bands, _)) = found.filter(|(bands, _)| bands.counted_runs() < bands.runs())
        && matches!(gate.decision, Decision::Undecided(_))
    {
        let (counted, all) = (bands.counted_runs(), bands.runs());
        reason = Some(format!("over time {counted} of {all} runs are counted: set bands.runs to count all"));
    }
    let (missing, value) = found.zip(worst).map_or((failed, None), |((bands, series), worst)| {
        let count = bands.count(series, points[worst].0);
        let missing = runs.saturating_sub(count);
        let Statement::Quantile(p) = requirement.statement else { return (missing, None) };
        let p = among_values(p, count, missing, requirement.limit);
        (missing, p.and_then(|p| bands.quantile(series, points[worst].0, p)))
    });
    let [least, most] = worst.map_or([0; 2], |worst| within[worst].0);
    let unit = found.map_or_else(String::new, |(bands, series)| bands.quantity(series).unit().to_owned());
    Assessment {
        requirement: requirement.clone(),
        confidences,
        shown: ShownUnit::own(&unit),
        unit,
        gate,
        interval,
        value,
        runs,
        violations: runs.saturating_sub(least),
        missing,
        failed,
        worst: worst.map(|worst| WorstPoint {
            time_s: points[worst].1,
            points: points.len(),
            unresolved: most - least,
        }),
        reason,
        note: None,
    }
}
