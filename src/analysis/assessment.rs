//! [`Assessment`]: what the runs of a campaign say of one requirement.

use crate::campaign::{Requirement, ShownUnit, Statement};
use crate::statistics::binomial::Decision;
use crate::statistics::gate::{Gate, GateLimit};
use crate::statistics::quantile::percent;

/// What the runs say of one requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    /// The requirement.
    pub requirement: Requirement,
    /// The confidence of a pass and of the bounds, and that of a failure, after corrections for several looks and several requirements.
    pub confidences: [f64; 2],
    /// Unit of its limit; empty for a pure number.
    pub unit: String,
    /// The unit in which people see it.
    pub shown: ShownUnit,
    /// What is decided, and from which estimate with which one-sided bounds: of the fraction of runs within the limit, or of the mean.
    pub gate: Gate,
    /// The quantile, as in the statistics, or the mean over the runs that have a value; `None` for fractions.
    pub value: Option<f64>,
    /// Runs that count: dispersed and physical.
    pub runs: u64,
    /// Runs of those that are not within the limit, or have no value.
    pub violations: u64,
    /// Runs of those that are not `ok`.
    pub failed: u64,
    /// Of a requirement over time: where it is met least.
    pub worst: Option<WorstPoint>,
    /// Why nothing, or something else than the numbers say, was decided.
    pub reason: Option<String>,
    /// Why the bounds may be too narrow.
    pub note: Option<String>,
}

/// The point of time at which the fewest runs are within the limit, the first of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPoint {
    /// The time, s.
    pub time_s: f64,
    /// At how many points the requirement was tested.
    pub points: usize,
    /// Runs that are in one bucket with the limit, so that the bands do not tell on which side of it they are. Counted as violations.
    pub unresolved: u64,
}

impl Assessment {
    /// PASS, FAIL or UNDECIDED.
    pub fn word(&self) -> &'static str {
        match self.gate.decision {
            Decision::Pass => "PASS",
            Decision::Fail => "FAIL",
            Decision::Undecided(_) => "UNDECIDED",
        }
    }

    /// Whether it would have failed, were it the only requirement.
    pub fn fails_alone(&self) -> bool {
        let [lower, upper] = self.gate.bounds;
        let is_undecided = matches!(self.gate.decision, Decision::Undecided(_));
        is_undecided
            && match (self.requirement.statement, self.requirement.limit) {
                (Statement::Mean, GateLimit::AtMost(limit)) => lower > limit,
                (Statement::Mean, GateLimit::AtLeast(limit)) => upper < limit,
                (Statement::Fraction(target), _) => upper < target,
                (Statement::Quantile(p), limit) => upper < limit.fraction(p),
            }
    }

    /// The requirement in words.
    pub fn sentence(&self) -> String {
        let requirement = &self.requirement;
        let unit = if self.shown.unit.is_empty() { String::new() } else { format!(" {}", self.shown.unit) };
        let limit = self.shown.written(requirement.limit.value());
        let limit = match requirement.limit {
            GateLimit::AtMost(_) => format!("at most {limit:?}{unit}"),
            GateLimit::AtLeast(_) => format!("at least {limit:?}{unit}"),
        };
        let (name, confidence) = (requirement.name(), percent(requirement.confidence));
        let limit = format!("{limit}{}", requirement.times());
        let what = match requirement.statement {
            Statement::Quantile(p) if requirement.window().is_some() => {
                format!("{}% of runs with {name} {limit}", percent(requirement.limit.fraction(p)))
            }
            Statement::Quantile(p) => format!("p{} of {name} {limit}", percent(p)),
            Statement::Fraction(fraction) => format!("{}% of runs with {name} {limit}", percent(fraction)),
            Statement::Mean => format!("mean of {name} {limit}"),
        };
        format!("{what}, with {confidence}% confidence")
    }
}
