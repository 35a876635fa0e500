//! The share of control-loop noise in the variance of the outcomes, from scenes flown twice with different noise. Noise
//! is no input: it is in no first-order index and in every total one.

use super::observed::Observed;
use crate::campaign::Plan;
use crate::ensemble::runner::RunError;
use crate::ensemble::single::{SingleRuns, run_each};
use crate::ensemble::threads::Threads;
use crate::math::Isa;
use crate::run::Status;
use crate::sampling::SampleId;
use crate::statistics::jackknife::Estimate;
use crate::statistics::share_within::{others, share_within};
use crate::storage::rows_reader::Result;
use std::convert::Infallible;

#[derive(Clone, Debug, PartialEq)]
pub struct NoiseShare {
    pub observable: String,
    /// Scenes with a value in both runs.
    pub scenes: usize,
    /// Runs that differ from the most frequent value.
    pub others: usize,
    /// `None` without variance, or if too few runs vary.
    pub share: Option<Estimate>,
}

/// Offset of the noise samples of second flights, beyond all samples.
const SECOND: u64 = 1 << 63;

/// The shares in the outcomes `names`, from `scenes` evenly spaced dispersed samples (or all).
///
/// # Errors If threads cannot be started.
pub fn noise_shares(
    plan: &Plan,
    names: &[String],
    scenes: u64,
    (isa, threads): (Isa, Threads),
) -> Result<Vec<NoiseShare>, RunError<Infallible>> {
    let dispersed = plan.samples.saturating_sub(1);
    let count = scenes.min(dispersed);
    let spaced = |k: u64| SampleId(1 + (u128::from(k) * u128::from(dispersed) / u128::from(count)) as u64);
    let samples: Vec<SampleId> = (0..count).map(spaced).collect();
    let outcomes = Observed::named(plan, names.iter().map(String::as_str));
    let columns = plan.request().columns();
    let inputs = plan.dispersions.columns();
    // NaN for a missing outcome
    let values = |runs: &mut SingleRuns<'_>, sample: SampleId, noise: SampleId| -> Option<Vec<f64>> {
        let run = runs.run_with_noise_of(sample, noise).ok()?;
        let of = |name: &str| {
            let place = columns.iter().position(|column| column.quantity.name() == name).map(|place| run.row[place]);
            let input = || inputs.iter().position(|input| input.name() == name);
            place.or_else(|| input().map(|place| runs.applied()[place]))
        };
        let is_ok = run.outcome.status == Status::Done;
        Some(outcomes.iter().map(|outcome| outcome.value(of).filter(|_| is_ok).unwrap_or(f64::NAN)).collect())
    };
    let both = |runs: &mut SingleRuns<'_>, sample: SampleId| {
        let first = values(runs, sample, sample);
        Ok(first.zip(values(runs, sample, SampleId(SECOND + sample.0))).map(<[Vec<f64>; 2]>::from))
    };
    let flown = run_each(plan, &samples, (isa, threads), &both)?;
    let flown: Vec<[Vec<f64>; 2]> = flown.into_iter().flatten().collect();
    let share = |(place, outcome): (usize, &Observed)| {
        let pairs = flown.iter().map(|[first, second]| [first[place], second[place]]);
        let pairs: Vec<[f64; 2]> = pairs.filter(|pair| pair.iter().all(|value| value.is_finite())).collect();
        NoiseShare {
            observable: outcome.quantity.name().to_owned(),
            scenes: pairs.len(),
            others: others(&pairs),
            share: share_within(&pairs, plan.analysis.confidence),
        }
    };
    Ok(outcomes.iter().enumerate().map(share).collect())
}
