//! [`AuditTally`]: statistics of the audits of a campaign.

use crate::ensemble::Audit;
use crate::ensemble::audit::AuditValue;
use crate::propagation::taylor::reference_solution;
use crate::sampling::SampleId;
use crate::statistics::binomial::at_most;
use crate::statistics::spread::Spread;

/// Errors above this are near their upper bound: an estimate above half of this covers them.
pub const SMALL: f64 = 0.1;

/// Minimum share of runs whose true error the estimate covers, as documented and measured by the tests of
/// `error_estimate`.
pub const PROMISED_COVERAGE: f64 = 0.95;

/// Maximum probability of a false report of a broken promise. Coverages of 0 of 2 audits, 1 of 4, 15 of 20, 88 of 100
/// break it; a single audit never does.
pub const FALSE_ALARM: f64 = 0.01;

/// An estimate compared with the true error.
#[derive(Clone, Debug, Default)]
pub struct Coverage {
    pub audited: u64,
    /// Runs whose estimate covers the true error.
    pub covered: u64,
    /// Estimate over true error, for positive errors.
    pub ratio: Spread,
}

impl Coverage {
    fn add(&mut self, estimate: f64, error: f64) {
        let is_covered = estimate >= error || (error > SMALL && estimate > 0.5 * SMALL);
        self.audited += 1;
        self.covered += u64::from(is_covered);
        if error > 0.0 {
            self.ratio.add(estimate / error);
        }
    }

    /// Probability of at most this coverage at [`PROMISED_COVERAGE`].
    pub fn chance(&self) -> f64 {
        at_most(self.covered, self.audited, PROMISED_COVERAGE)
    }

    /// Uncovered runs beyond chance; else 0.
    pub fn excess(&self) -> u64 {
        if self.chance() <= FALSE_ALARM { self.audited - self.covered } else { 0 }
    }
}

#[derive(Clone, Debug, Default)]
pub struct AuditTally {
    pub audited: u64,
    /// Selected runs without an end, or whose reference solution has none.
    pub failed: u64,
    /// Audited against double-double; the others against doubles.
    pub in_double_double: u64,
    pub coverage: Coverage,
    pub debris_coverage: Coverage,
    /// Maximum of the next two.
    pub state: Spread,
    /// Relative to the run's maximum |omega|.
    pub omega: Spread,
    /// Error of the attitude, rad.
    pub attitude: Spread,
    pub debris: Spread,
    pub observables: Vec<Spread>,
}

impl AuditTally {
    pub fn new(observables: usize) -> Self {
        AuditTally { observables: vec![Spread::default(); observables], ..AuditTally::default() }
    }

    /// Uncovered runs of estimates with a broken promise.
    pub fn not_covered(&self) -> u64 {
        self.coverage.excess() + self.debris_coverage.excess()
    }

    /// Adds the audits of a part, except those left out; `indices` locate the observables in a row.
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
            self.in_double_double += u64::from(audit.value(AuditValue::Tolerance) == reference_solution::TOLERANCE);
            let error = audit.state();
            self.coverage.add(audit.value(AuditValue::Estimate), error);
            self.state.add(error);
            self.omega.add(audit.value(AuditValue::Omega));
            self.attitude.add(audit.value(AuditValue::Attitude));
            let debris = audit.value(AuditValue::Debris);
            if !debris.is_nan() {
                self.debris.add(debris);
                self.debris_coverage.add(audit.value(AuditValue::DebrisEstimate), debris);
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

    /// Law: an estimate covers errors up to its size.
    #[test]
    fn an_estimate_just_below_the_error_does_not_cover_it() {
        let covered = |error: f64, estimate: f64| {
            let mut coverage = Coverage::default();
            coverage.add(estimate, error);
            coverage.covered == 1
        };
        assert!(covered(1e-9, 1e-9) && covered(1e-9, 2e-9));
        assert!(!covered(1e-9, 0.999e-9) && !covered(1e-9, 0.2e-9) && !covered(0.09, 0.08));
        assert!(covered(1.0, 0.9 * SMALL) && !covered(1.0, 0.4 * SMALL));
        assert!(!covered(f64::NAN, 1e-9), "an error that is NaN is not covered");
    }

    /// Law: a promise is broken if so few covered runs are improbable by the binomial sum; two uncovered audits
    /// suffice, one does not.
    #[test]
    fn a_promise_is_broken_where_chance_is_no_explanation() {
        let excess = |covered: u64, audited: u64| Coverage { audited, covered, ..Coverage::default() }.excess();
        let term = |k: u64, n: u64| {
            let ways = (0..k).fold(1.0, |ways, j| ways * (n - j) as f64 / (j + 1) as f64);
            ways * 0.95_f64.powi(k as i32) * 0.05_f64.powi((n - k) as i32)
        };
        for audited in 0..=120 {
            for covered in 0..=audited {
                let chance: f64 = (0..=covered).map(|k| term(k, audited)).sum();
                let expected = if chance <= 0.01 { audited - covered } else { 0 };
                assert_eq!(excess(covered, audited), expected, "{covered} of {audited}: {chance}");
            }
        }
        for (covered, audited) in [(0, 2), (1, 4), (15, 20), (88, 100)] {
            assert_eq!((excess(covered, audited), excess(covered + 1, audited)), (audited - covered, 0));
        }
        assert_eq!((excess(0, 0), excess(0, 1)), (0, 0));
    }
}
