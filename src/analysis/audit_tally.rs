//! [`AuditTally`]: statistics of the audits of a campaign, counted part by part.

use crate::ensemble::Audit;
use crate::propagation::taylor::reference_solution;
use crate::sampling::SampleId;
use crate::statistics::spread::Spread;

/// Errors above this are no longer small, and soon bounded: an estimate above half of this counts as covering them.
pub const SMALL: f64 = 0.1;

/// How an estimate compares with the true error.
#[derive(Clone, Debug, Default)]
pub struct Coverage {
    /// Runs whose estimate covers the true error.
    pub covered: u64,
    /// Estimate over true error, where the true error is above zero.
    pub ratio: Spread,
}

impl Coverage {
    fn add(&mut self, estimate: f64, error: f64) {
        let is_covered = estimate >= error || (error > SMALL && estimate > 0.5 * SMALL);
        self.covered += u64::from(is_covered);
        if error > 0.0 {
            self.ratio.add(estimate / error);
        }
    }
}

/// Counts over the audited runs.
#[derive(Clone, Debug, Default)]
pub struct AuditTally {
    /// Runs that were audited.
    pub audited: u64,
    /// Selected runs that did not reach their end, or whose reference solution did not.
    pub failed: u64,
    /// Audited runs whose reference solution is in double-double; the others have one in plain doubles.
    pub in_double_double: u64,
    /// How `state_error_estimate` compares with the true error.
    pub coverage: Coverage,
    /// How `debris_state_error_estimate` does, where there is debris.
    pub debris_coverage: Coverage,
    /// Maximum of the next two.
    pub state: Spread,
    /// Errors of omega over the run's maximum |omega|.
    pub omega: Spread,
    /// Errors of the attitude, rad.
    pub attitude: Spread,
    /// Errors of the rotation of the debris, where there is one.
    pub debris: Spread,
    /// Errors of the observables that have statistics.
    pub observables: Vec<Spread>,
}

impl AuditTally {
    /// Nothing counted yet, of `observables` observables.
    pub fn new(observables: usize) -> Self {
        AuditTally { observables: vec![Spread::default(); observables], ..AuditTally::default() }
    }

    /// Counts the audits of a part, without those of samples that are left out; `indices` are the indices of the observables in a row.
    pub fn add(
        &mut self,
        audits: &[(SampleId, Option<Audit>)],
        indices: impl Iterator<Item = usize> + Clone,
        is_left_out: impl Fn(SampleId) -> bool,
    ) {
        for (sample, audit) in audits {
            if is_left_out(*sample) {
                continue;
            }
            let Some(audit) = audit else {
                self.failed += 1;
                continue;
            };
            self.audited += 1;
            self.in_double_double += u64::from(audit.reference_tolerance == reference_solution::TOLERANCE);
            let error = audit.state();
            self.coverage.add(audit.estimate, error);
            self.state.add(error);
            self.omega.add(audit.omega);
            self.attitude.add(audit.attitude);
            if !audit.debris.is_nan() {
                self.debris.add(audit.debris);
                self.debris_coverage.add(audit.debris_estimate, audit.debris);
            }
            for (spread, index) in self.observables.iter_mut().zip(indices.clone()) {
                spread.add(audit.observables[index]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::sketch::RELATIVE_ERROR;

    /// The tally of audits with these (error, estimate); `None` is an audit that failed.
    fn tally(audits: &[Option<(f64, f64)>]) -> AuditTally {
        let audits = audits.iter().zip(0..).map(|(audit, sample)| {
            let audit = audit.map(|(error, estimate)| Audit {
                omega: error,
                attitude: 0.5 * error,
                debris: f64::NAN,
                estimate,
                debris_estimate: f64::NAN,
                reference_tolerance: reference_solution::TOLERANCE,
                observables: vec![f64::NAN],
            });
            (SampleId(sample), audit)
        });
        let mut tally = AuditTally::new(1);
        tally.add(&audits.collect::<Vec<_>>(), std::iter::once(0), |_| false);
        tally
    }

    /// Law: what is left out - the nominal sample, which is not dispersed - is in no count.
    #[test]
    fn the_nominal_sample_is_left_out() {
        let mut tally = AuditTally::new(1);
        tally.add(&[0, 2].map(|sample| (SampleId(sample), None)), std::iter::once(0), |sample| sample == SampleId(0));
        assert_eq!((tally.audited, tally.failed), (0, 1));
    }

    /// Law: every selected run is counted once, as audited or as failed.
    #[test]
    fn failed_audits_are_counted() {
        let found = tally(&[Some((1e-12, 2e-12)), None, Some((1e-12, 2e-12)), None, None]);
        assert_eq!((found.audited, found.failed), (2, 3));
    }

    /// Law: the ratio is that of estimate to error, of runs with an error.
    #[test]
    fn the_ratio_is_estimate_over_error() {
        let found = tally(&[Some((2e-12, 8e-12)), Some((0.0, 8e-12)), Some((2e-12, 8e-12))]);
        let ratio = found.coverage.ratio.quantile(0.5).expect("two ratios");
        assert_eq!(found.coverage.ratio.count(), 2);
        assert!((ratio / 4.0 - 1.0).abs() <= RELATIVE_ERROR, "{ratio}");
    }

    /// Law: the estimate of the debris is compared with the error of the debris, and with no other.
    #[test]
    fn the_debris_has_a_coverage_of_its_own() {
        let audit = |debris: f64, debris_estimate: f64| Audit {
            omega: 1e-12,
            attitude: 1e-12,
            debris,
            estimate: 2e-12,
            debris_estimate,
            reference_tolerance: reference_solution::TOLERANCE,
            observables: vec![f64::NAN],
        };
        let audits = [(1e-9, 1.5e-12), (1e-9, 4e-9), (f64::NAN, f64::NAN)]
            .map(|(debris, estimate)| (SampleId(0), Some(audit(debris, estimate))));
        let mut tally = AuditTally::new(1);
        tally.add(&audits, std::iter::once(0), |_| false);
        assert_eq!((tally.coverage.covered, tally.debris_coverage.covered), (3, 1));
        assert_eq!((tally.debris.count(), tally.debris_coverage.ratio.count()), (2, 2));
    }

    /// Law: an error is covered by an estimate that is as large, and by none that is just below it. A large error, which is
    /// bounded by half a turn, is covered by every large estimate.
    #[test]
    fn an_estimate_just_below_the_error_does_not_cover_it() {
        let covered = |error: f64, estimate: f64| tally(&[Some((error, estimate))]).coverage.covered == 1;
        assert!(covered(1e-9, 1e-9) && covered(1e-9, 2e-9));
        assert!(!covered(1e-9, 0.999e-9) && !covered(1e-9, 0.2e-9) && !covered(0.09, 0.08));
        assert!(covered(1.0, 0.9 * SMALL) && !covered(1.0, 0.4 * SMALL));
        assert!(!covered(f64::NAN, 1e-9), "an error that is NaN is not covered");
    }
}
