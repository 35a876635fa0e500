//! [`AuditTally`]: what the audits of a campaign amount to; [`AuditSummary`]: the same for `summary.json` and the screen.
//!
//! Errors are counted as everything is ([`crate::statistics::sketch`]); only the CPU time is added up, and it goes to the screen
//! alone.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;

use crate::ensemble::Rows;
use crate::propagation::taylor::reference_solution;
use crate::report::summary::short;
use crate::statistics::sketch::Sketch;

/// An error beyond this is no longer small, and soon bounded: there an estimate covers it that is above half of this.
pub const SMALL: f64 = 0.1;

/// Counts over the audited runs.
#[derive(Clone, Debug, Default)]
pub struct AuditTally {
    audited: u64,
    failed: u64,
    in_double_double: u64,
    covered: u64,
    state: Sketch,
    omega: Sketch,
    attitude: Sketch,
    /// Estimate over true error, where both are numbers above zero.
    excess: Sketch,
    /// Errors of the observables that are summed up.
    observables: Vec<Sketch>,
    seconds: [f64; 2],
}

impl AuditTally {
    /// Nothing counted yet, of `observables` observables.
    pub fn new(observables: usize) -> Self {
        AuditTally { observables: vec![Sketch::default(); observables], ..AuditTally::default() }
    }

    /// Counts the audits of a part; `indices` are the places of the observables in a row.
    pub fn add(&mut self, rows: &Rows, indices: impl Iterator<Item = usize> + Clone) {
        for (_, audit) in rows.audits() {
            let Some(audit) = audit else {
                self.failed += 1;
                continue;
            };
            self.audited += 1;
            self.in_double_double += u64::from(audit.truth_tolerance == reference_solution::TOLERANCE);
            let error = audit.state();
            let is_covered = audit.estimate >= error || (error > SMALL && audit.estimate > 0.5 * SMALL);
            self.covered += u64::from(is_covered);
            self.state.add(error);
            self.omega.add(audit.omega);
            self.attitude.add(audit.attitude);
            if error > 0.0 {
                self.excess.add(audit.estimate / error);
            }
            for (sketch, index) in self.observables.iter_mut().zip(indices.clone()) {
                sketch.add(audit.observables[index]);
            }
        }
        for (sum, seconds) in self.seconds.iter_mut().zip(rows.seconds()) {
            *sum += seconds;
        }
    }

    /// Errors of the observable numbered `index` among those that are summed up, beside its own `values`.
    pub fn numerics(&self, index: usize, values: &Sketch) -> Option<Numerics> {
        let errors = &self.observables[index];
        let p95 = errors.quantile(0.95)?;
        let spread = values.quantile(0.95)? - values.quantile(0.05)?;
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

    /// Sums up.
    pub fn summary(&self, fraction: f64) -> AuditSummary {
        AuditSummary {
            fraction,
            audited: self.audited,
            failed: self.failed,
            in_double_double: self.in_double_double,
            state_error: Quantiles::of(&self.state),
            omega_error: Quantiles::of(&self.omega),
            attitude_error_rad: Quantiles::of(&self.attitude),
            estimate: Estimate {
                covered: self.covered,
                coverage: (self.audited > 0).then(|| self.covered as f64 / self.audited as f64),
                median_ratio: self.excess.quantile(0.5),
            },
        }
    }

    /// What the audits cost, for the screen: CPU time, and its share.
    pub fn cost(&self) -> String {
        let [runs, audits] = self.seconds;
        format!("{} s of CPU time, {:.1}% of all", short(audits), 100.0 * audits / (runs + audits).max(1e-9))
    }
}

/// The numerical errors of an observable over the audited runs, beside the spread of its values over the campaign.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Numerics {
    /// Number of audited runs that have it.
    pub count: u64,
    /// Median of |observed - true|.
    pub median: Option<f64>,
    /// Rank ceil(0.95 n).
    pub p95: Option<f64>,
    /// Rank ceil(0.99 n).
    pub p99: Option<f64>,
    /// Largest.
    pub max: Option<f64>,
    /// Difference of the 95% and 5% quantiles of the observable.
    pub spread: f64,
    /// `p95` over `spread`: how much of the spread is numerics; absent where there is no spread.
    pub share_of_spread: Option<f64>,
}

/// Order statistics of an error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// Median.
    pub median: Option<f64>,
    /// Rank ceil(0.95 n).
    pub p95: Option<f64>,
    /// Rank ceil(0.99 n).
    pub p99: Option<f64>,
    /// Largest.
    pub max: Option<f64>,
}

impl Quantiles {
    fn of(sketch: &Sketch) -> Self {
        let [median, p95, p99] = [0.5, 0.95, 0.99].map(|p| sketch.quantile(p));
        Quantiles { median, p95, p99, max: sketch.max() }
    }
}

/// How good `state_error_estimate` was.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Runs whose estimate covers the true error.
    pub covered: u64,
    /// Share of the audited runs.
    pub coverage: Option<f64>,
    /// Median of estimate over true error.
    pub median_ratio: Option<f64>,
}

/// What the audits of a campaign amount to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AuditSummary {
    /// Share of the samples that was to be audited.
    pub fraction: f64,
    /// Runs that were audited.
    pub audited: u64,
    /// Selected runs that did not arrive, or whose truth did not.
    pub failed: u64,
    /// How many of them against double-double; the others against plain doubles at 1e-16.
    pub in_double_double: u64,
    /// The larger of the next two.
    pub state_error: Quantiles,
    /// Of omega, over the largest |omega| of the run.
    pub omega_error: Quantiles,
    /// Of the attitude, rad.
    pub attitude_error_rad: Quantiles,
    /// How good the estimate was.
    pub estimate: Estimate,
}

impl Display for AuditSummary {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let plain = self.audited - self.in_double_double;
        write!(f, "  audit: {} runs again, {} in double-double", self.audited, self.in_double_double)?;
        if plain > 0 {
            write!(f, ", {plain} too long for that, in plain doubles at 1e-16")?;
        }
        if self.failed > 0 {
            write!(f, "; {} more did not arrive", self.failed)?;
        }
        writeln!(f)?;
        if self.audited == 0 {
            return Ok(());
        }
        writeln!(f, "  {:<28}{:>12}{:>12}{:>12}{:>12}", "true error of the rotation", "median", "p95", "p99", "max")?;
        for (name, of) in [
            ("audit_state_error", self.state_error),
            ("audit_omega_error", self.omega_error),
            ("audit_attitude_error_rad", self.attitude_error_rad),
        ] {
            write!(f, "  {name:<28}")?;
            for value in [of.median, of.p95, of.p99, of.max] {
                write!(f, "{:>12}", value.map_or("-".to_owned(), short))?;
            }
            writeln!(f)?;
        }
        let Estimate { covered, coverage, median_ratio } = self.estimate;
        let ratio = median_ratio.map_or("-".to_owned(), short);
        writeln!(
            f,
            "  state_error_estimate covers {covered} of {} ({:.1}%), {ratio} times the error in the median",
            self.audited,
            100.0 * coverage.unwrap_or(0.0)
        )
    }
}
