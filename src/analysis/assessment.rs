//! [`Assessment`]: what the runs of a campaign say of one requirement.

use crate::campaign::{Requirement, ShownUnit, Statement};
use crate::statistics::binomial::{Decision, upper_bound};
use crate::statistics::gate::{Gate, GateLimit};
use crate::statistics::looks::adjusted;

/// What the runs say of one requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    pub requirement: Requirement,
    /// The confidence of a pass and of the bounds, and that of a failure, after corrections for several looks and
    /// several requirements.
    pub confidences: [f64; 2],
    /// Unit of its limit; empty for a pure number.
    pub unit: String,
    /// The unit in which people see it.
    pub shown: ShownUnit,
    /// What is decided, and from which estimate with which one-sided bounds: of the fraction of runs within the limit,
    /// or of the mean.
    pub gate: Gate,
    /// The two-sided interval of what is estimated, at the confidence of the statistics; NaN where there is none.
    pub interval: [f64; 2],
    /// The quantile, of which runs without a value violate the limit, or the mean over the runs that have a value;
    /// `None` for fractions, and where the quantile is a run without a value.
    pub value: Option<f64>,
    /// Runs that count: dispersed and physical.
    pub runs: u64,
    /// Runs of those that are not within the limit, have no value, or one that is not a number.
    pub violations: u64,
    /// Runs of those that have no value, and violate the requirement.
    pub missing: u64,
    /// Runs of those that are not `ok`.
    pub failed: u64,
    /// Of a requirement over time: where it is met least.
    pub worst: Option<WorstPoint>,
    /// Why nothing, or something else than the numbers say, was decided.
    pub reason: Option<String>,
    /// Why the bounds may be too narrow.
    pub note: Option<String>,
}

/// An event that N runs show fewer than so many times, on average, is rare: what it adds to a mean these runs do not
/// tell. Measured (`rare_events_are_what_a_mean_assumes`): of events that ten runs have on average a bound for 5%
/// misses in 0 to 3%, of one that two to four have in 7 to 21%, of one that one has in 20 to 38%, of rarer ones in up
/// to 96%.
pub const RARE: u64 = 10;

/// The point of time at which the fewest runs are within the limit, the first of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPoint {
    /// The time, s.
    pub time_s: f64,
    /// At how many points the requirement was tested.
    pub points: usize,
    /// Runs that are in one bucket with the limit, so that the bands do not tell on which side of it they are. Counted
    /// as violations.
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

    /// Of a mean that is decided without bounds of its values: by how much at most rare events ([`RARE`]) may move it,
    /// so that the decision holds.
    pub fn room_for_rare_events(&self) -> Option<f64> {
        let [lower, upper] = self.gate.bounds;
        let requirement = &self.requirement;
        // a constant has no rare events
        let assumes = requirement.statement == Statement::Mean && requirement.bounded.is_none() && lower < upper;
        let limit = requirement.limit.value();
        let bound = match (self.gate.decision, requirement.limit) {
            (Decision::Undecided(_), _) => return None,
            (Decision::Pass, GateLimit::AtMost(_)) | (Decision::Fail, GateLimit::AtLeast(_)) => upper,
            (Decision::Pass, GateLimit::AtLeast(_)) | (Decision::Fail, GateLimit::AtMost(_)) => lower,
        };
        (assumes && self.reason.is_none()).then_some((limit - bound).abs())
    }

    /// The bound on one side by which it passed or failed, where its interval has the limit in it and so seems to say
    /// that nothing is decided; of the fraction of runs within the limit, or of the mean: the bound and the limit.
    /// `true`: a lower bound.
    pub fn hidden_bound(&self) -> Option<([f64; 2], bool)> {
        let [low, high] = self.interval;
        let (limit, is_least) = match (self.requirement.statement, self.requirement.limit) {
            (Statement::Mean, limit) => (limit.value(), matches!(limit, GateLimit::AtLeast(_))),
            (Statement::Fraction(target), _) => (target, true),
            (Statement::Quantile(p), limit) => (limit.fraction(p), true),
        };
        let is_lower = match self.gate.decision {
            Decision::Pass => is_least,
            Decision::Fail => !is_least,
            Decision::Undecided(_) => return None,
        };
        let bound = self.gate.bounds[usize::from(!is_lower)];
        (low < limit && limit < high && bound.is_finite() && self.reason.is_none())
            .then_some(([bound, limit], is_lower))
    }

    /// Whether there is an interval.
    pub fn has_interval(&self) -> bool {
        self.interval.iter().any(|end| end.is_finite())
    }

    /// At how many points of time it is tested.
    fn points(&self) -> usize {
        self.worst.map_or(1, |worst| worst.points)
    }

    /// The confidence at which it fails: after the corrections for looks, requirements and points of time.
    pub fn fails_at(&self) -> f64 {
        adjusted(self.confidences[1], self.points())
    }

    /// The same, were it the only requirement.
    pub fn fails_alone_at(&self) -> f64 {
        adjusted(self.confidences[0], self.points())
    }

    /// Whether it would have failed, were it the only requirement.
    pub fn fails_alone(&self) -> bool {
        let [lower, mut upper] = self.gate.bounds;
        if let Some(worst) = self.worst {
            // the bounds are those of one point that was chosen among several
            let most = (self.runs - self.violations + worst.unresolved).min(self.runs);
            upper = upper_bound(most, self.runs, self.fails_alone_at());
        }
        let is_undecided = matches!(self.gate.decision, Decision::Undecided(_)) && self.reason.is_none();
        is_undecided
            && match (self.requirement.statement, self.requirement.limit) {
                (Statement::Mean, GateLimit::AtMost(limit)) => lower > limit,
                (Statement::Mean, GateLimit::AtLeast(limit)) => upper < limit,
                (Statement::Fraction(target), _) => upper < target,
                (Statement::Quantile(p), limit) => upper < limit.fraction(p),
            }
    }
}
