//! [`AuditSummary`]: the statistics of the audits, for `summary.json` and the screen.
//!
//! CPU time is on the screen only: `summary.json` does not depend on the machine.

use serde::Serialize;

use crate::analysis::audit_tally::{AuditTally, Coverage, PROMISED_COVERAGE};
use crate::ensemble::audit::AuditValue;
use crate::findings::number::{counted, short};
use crate::observables::headlines::{DEBRIS_STATE_ERROR_ESTIMATE, STATE_ERROR_ESTIMATE};
use crate::statistics::quantile::percent;
use crate::statistics::spread::Spread;
use crate::table::Table;
use crate::table::text::Align;

/// The numerical errors of an observable over the audited runs, beside the spread of its values over the campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Numerics {
    /// Number of audited runs that have it.
    pub count: u64,
    /// Median of |observed - true|.
    pub median: Option<f64>,
    /// 95% quantile, type 7.
    pub p95: Option<f64>,
    /// 99% quantile, type 7.
    pub p99: Option<f64>,
    pub max: Option<f64>,
    /// Difference of the 95% and 5% quantiles of the observable.
    pub spread: f64,
    /// `p95` over `spread`: how much of the spread is numerics; absent where there is no spread.
    pub share_of_spread: Option<f64>,
}

/// Order statistics of an error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    pub median: Option<f64>,
    /// 95% quantile, type 7.
    pub p95: Option<f64>,
    /// 99% quantile, type 7.
    pub p99: Option<f64>,
    pub max: Option<f64>,
}

impl Quantiles {
    fn of(spread: &Spread) -> Self {
        let [median, p95, p99] = [0.5, 0.95, 0.99].map(|p| spread.quantile(p));
        Quantiles { median, p95, p99, max: spread.max() }
    }
}

/// Comparison of an estimate with the true error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Runs that were audited and have this error.
    pub audited: u64,
    /// Runs whose estimate covers the true error.
    pub covered: u64,
    /// Fraction of the audited runs.
    pub coverage: Option<f64>,
    /// Median of estimate over true error.
    pub median_ratio: Option<f64>,
    /// The coverage that is promised.
    pub promised: f64,
    /// The probability of so few covered runs, or fewer, if the promise were kept.
    pub chance: f64,
    /// Runs that are not covered, where chance does not explain that there are so many; else 0.
    pub excess: u64,
}

/// The statistics of the audits of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AuditSummary {
    /// Fraction of the samples selected for audits.
    pub fraction: f64,
    pub audited: u64,
    /// Selected runs that did not reach their end, or whose reference solution did not.
    pub failed: u64,
    /// Audited runs with a reference solution in double-double; the others have one in plain doubles with tolerance
    /// 1e-16.
    pub in_double_double: u64,
    /// Maximum of the next two.
    pub state_error: Quantiles,
    /// Of omega, over the run's maximum |omega|.
    pub omega_error: Quantiles,
    /// Of the attitude, rad.
    pub attitude_error_rad: Quantiles,
    /// Of the rotation of the debris, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub debris_error: Option<Quantiles>,
    /// Comparison of `state_error_estimate` with the true error.
    pub estimate: Estimate,
    /// The same of `debris_state_error_estimate`, where there is debris.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub debris_estimate: Option<Estimate>,
}

impl Estimate {
    fn new(coverage: &Coverage) -> Self {
        Estimate {
            audited: coverage.audited,
            covered: coverage.covered,
            coverage: (coverage.audited > 0).then(|| coverage.covered as f64 / coverage.audited as f64),
            median_ratio: coverage.ratio.quantile(0.5),
            promised: PROMISED_COVERAGE,
            chance: coverage.chance(),
            excess: coverage.excess(),
        }
    }
}

impl Numerics {
    /// Errors of the observable `index` among those with statistics, beside the `spread` of its values; `None` where
    /// there are no errors.
    pub fn new(audits: &AuditTally, index: usize, spread: f64) -> Option<Self> {
        let errors = &audits.observables[index];
        let p95 = errors.quantile(0.95)?;
        Some(Numerics {
            count: errors.count(),
            median: errors.quantile(0.5),
            p95: Some(p95),
            p99: errors.quantile(0.99),
            max: errors.max(),
            spread,
            share_of_spread: (spread > 0.0).then_some(p95 / spread),
        })
    }
}

impl AuditSummary {
    /// The statistics of `audits`, of a campaign that audits `fraction` of its samples.
    pub fn new(audits: &AuditTally, fraction: f64) -> Self {
        AuditSummary {
            fraction,
            audited: audits.audited,
            failed: audits.failed,
            in_double_double: audits.in_double_double,
            state_error: Quantiles::of(&audits.state),
            omega_error: Quantiles::of(&audits.omega),
            attitude_error_rad: Quantiles::of(&audits.attitude),
            debris_error: (audits.debris.count() > 0).then(|| Quantiles::of(&audits.debris)),
            estimate: Estimate::new(&audits.coverage),
            debris_estimate: (audits.debris.count() > 0).then(|| Estimate::new(&audits.debris_coverage)),
        }
    }

    /// The estimates, each with the name of its column.
    fn estimates(&self) -> impl Iterator<Item = (&'static str, Estimate)> {
        let debris = self.debris_estimate.map(|estimate| (DEBRIS_STATE_ERROR_ESTIMATE.name(), estimate));
        std::iter::once((STATE_ERROR_ESTIMATE.name(), self.estimate)).chain(debris)
    }

    /// A line for each estimate: how many of the true errors it covers.
    pub fn coverage(&self) -> String {
        let line = |(name, one): (&str, Estimate)| {
            format!(
                "  {name} covers {} of {} ({:.1}%), {} times the error in the median\n",
                one.covered,
                one.audited,
                100.0 * one.coverage.unwrap_or(0.0),
                one.median_ratio.map_or("-".to_owned(), short),
            )
        };
        self.estimates().map(line).collect()
    }

    /// The estimates that cover the true error in fewer runs than promised, each as a sentence; none where chance may
    /// be why.
    pub fn broken_promises(&self) -> Vec<String> {
        let broken = self.estimates().filter(|(_, estimate)| estimate.excess > 0);
        let sentence = |(name, one): (&str, Estimate)| {
            format!(
                "AUDIT FAILED: {name} covers the true error in {} of {} audited runs, at least {}% are promised; with \
                that promise kept, so few or fewer would have the probability {}. The numerical errors of these runs \
                are larger than their estimates",
                one.covered,
                one.audited,
                percent(one.promised),
                short(one.chance),
            )
        };
        broken.map(sentence).collect()
    }
}

/// CPU time of the audits, and its share of the total; of CPU time of runs and of audits, s.
pub fn cost([runs, audits]: [f64; 2]) -> String {
    format!("{} s of CPU time, {:.1}% of the total", short(audits), 100.0 * audits / (runs + audits).max(1e-9))
}

/// Numbers in four digits; `-` for none.
pub(super) fn shorts<const N: usize>(values: [Option<f64>; N]) -> [String; N] {
    values.map(|value| value.map_or("-".to_owned(), short))
}

impl AuditSummary {
    /// The audits in lines of `width` characters.
    pub fn text(&self, width: usize) -> String {
        let (audited, plain) = (self.audited, self.audited - self.in_double_double);
        let mut head = format!(
            "  audit: {} compared with reference solutions, {} of them in double-double",
            counted(audited, "run"),
            self.in_double_double
        );
        if plain > 0 {
            head += &format!(", {plain} too long for that, in plain doubles with tolerance 1e-16");
        }
        if self.failed > 0 {
            head += &format!("; {} more did not reach their end", self.failed);
        }
        head.push('\n');
        if audited == 0 {
            return head;
        }
        let heads = ["median", "p95", "p99", "max"].map(|head| (head, Align::Right));
        let mut table = Table::with([("true error of the rotation", Align::Title)].into_iter().chain(heads));
        let spacecraft = [
            (AuditValue::State, self.state_error),
            (AuditValue::Omega, self.omega_error),
            (AuditValue::Attitude, self.attitude_error_rad),
        ];
        let debris = self.debris_error.map(|errors| (AuditValue::Debris, errors));
        for (name, of) in spacecraft.into_iter().chain(debris) {
            let name = [name.quantity().name().to_owned()];
            table.row(name.into_iter().chain(shorts([of.median, of.p95, of.p99, of.max])));
        }
        head + &table.text(width) + &self.coverage()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::sketch::RELATIVE_ERROR;

    /// Law: the screen says how many runs were compared, how many of them in double-double, how many in plain doubles,
    /// and how many failed.
    #[test]
    fn every_selected_run_is_accounted_for() {
        let line = |audited: u64, in_double_double: u64, failed: u64| {
            let audits = AuditTally { audited, in_double_double, failed, ..AuditTally::default() };
            AuditSummary::new(&audits, 0.5).text(200).lines().next().map(str::to_owned).unwrap_or_default()
        };
        let head = "  audit: 7 runs compared with reference solutions";
        let plain = "too long for that, in plain doubles with tolerance 1e-16";
        assert_eq!(line(7, 7, 0), format!("{head}, 7 of them in double-double"));
        assert_eq!(line(7, 4, 0), format!("{head}, 4 of them in double-double, 3 {plain}"));
        let failed = "2 more did not reach their end";
        assert_eq!(line(7, 5, 2), format!("{head}, 5 of them in double-double, 2 {plain}; {failed}"));
    }

    /// Law: each quantile is that of type 7, and the ratios are of the runs that were audited.
    #[test]
    fn quantiles_and_shares_are_those_stated() {
        let mut audits = AuditTally {
            audited: 4,
            coverage: Coverage { audited: 4, covered: 3, ..Coverage::default() },
            ..AuditTally::new(1)
        };
        (1..=1000).for_each(|k| audits.state.add(f64::from(k)));
        (1..=1000).for_each(|k| audits.observables[0].add(f64::from(k)));
        let found = AuditSummary::new(&audits, 0.5);
        let near = |found: Option<f64>, expected: f64| {
            let found = found.expect("a value");
            assert!((found / expected - 1.0).abs() <= RELATIVE_ERROR, "{found} for {expected}");
        };
        near(found.state_error.median, 500.5);
        near(found.state_error.p95, 950.05);
        near(found.state_error.p99, 990.01);
        assert_eq!((found.state_error.max, found.estimate.coverage), (Some(1000.0), Some(0.75)));
        let numerics = Numerics::new(&audits, 0, 89.1).expect("errors");
        near(numerics.share_of_spread, 950.05 / 89.1);
        assert_eq!(cost([3.0, 1.0]), format!("{} s of CPU time, 25.0% of the total", short(1.0)));
    }

    /// Law: an estimate whose promise is broken is named with its counts, each estimate by its own runs; none is where
    /// the promise may be kept.
    #[test]
    fn broken_promises_are_named() {
        let of = |state: [u64; 2], debris: [u64; 2]| {
            let coverage = |[covered, audited]: [u64; 2]| Coverage { audited, covered, ..Coverage::default() };
            let mut audits =
                AuditTally { coverage: coverage(state), debris_coverage: coverage(debris), ..AuditTally::new(0) };
            (0..debris[1]).for_each(|_| audits.debris.add(1e-12));
            AuditSummary::new(&audits, 1.0).broken_promises()
        };
        assert!(of([7, 7], [0, 0]).is_empty() && of([6, 7], [95, 100]).is_empty());
        let found = of([0, 7], [10, 20]);
        let words = [
            "AUDIT FAILED: state_error_estimate covers the true error in 0 of 7",
            "AUDIT FAILED: debris_state_error_estimate covers the true error in 10 of 20",
        ];
        assert!(
            found.len() == 2 && found.iter().zip(words).all(|(found, words)| found.starts_with(words)),
            "{found:?}"
        );
    }
}
