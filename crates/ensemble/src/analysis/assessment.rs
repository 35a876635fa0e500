//! [`Assessment`]: the verdict on one requirement.

use crate::campaign::{Requirement, ShownUnit, Statement};
use crate::statistics::binomial::{Decision, upper_bound};
use crate::statistics::gate::{Gate, GateLimit};
use crate::statistics::looks::adjusted;

#[derive(Clone, Debug, PartialEq)]
pub struct Assessment {
    pub requirement: Requirement,
    /// Confidences of a pass (and of the bounds) and of a failure, corrected for looks and requirements.
    pub confidences: [f64; 2],
    /// Unit of its limit; empty for a pure number.
    pub unit: String,
    pub shown: ShownUnit,
    /// Decision, estimate and one-sided bounds, of the fraction of runs within the limit or of the mean.
    pub gate: Gate,
    /// Two-sided interval of the estimate at the confidence of the statistics; NaN if there is none.
    pub interval: [f64; 2],
    /// The quantile, with missing values as violations, or the mean; `None` for fractions and a missing quantile.
    pub value: Option<f64>,
    /// Dispersed, physical runs.
    pub runs: u64,
    /// Runs beyond the limit, without a value, or with NaN.
    pub violations: u64,
    /// Runs without a value, which violate the requirement.
    pub missing: u64,
    pub failed: u64,
    pub worst: Option<WorstPoint>,
    /// Why the decision is open, or does not follow from the numbers.
    pub reason: Option<String>,
    /// Why the bounds may be too narrow.
    pub note: Option<String>,
}

/// Events with fewer expected occurrences than this in N runs are rare: the runs do not show their effect on a mean.
/// Measured (`rare_events_are_what_a_mean_assumes`): a 5% bound misses in 0 to 3% of campaigns for ten occurrences on
/// average, 7 to 21% for two to four, 20 to 38% for one, up to 96% for fewer.
pub const RARE: u64 = 10;

/// The first time with the fewest runs within the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstPoint {
    pub time_s: f64,
    pub points: usize,
    /// Runs in the same bucket as the limit, on an unknown side; counted as violations.
    pub unresolved: u64,
}

impl Assessment {
    pub fn word(&self) -> &'static str {
        match self.gate.decision {
            Decision::Pass => "PASS",
            Decision::Fail => "FAIL",
            Decision::Undecided(_) => "UNDECIDED",
        }
    }

    /// The largest shift of a mean by rare events ([`RARE`]) that keeps the decision valid, if the values have no
    /// bounds.
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

    /// The deciding one-sided bound and the limit, if the two-sided interval contains the limit and so suggests no
    /// decision. `true`: a lower bound.
    pub fn hidden_bound(&self) -> Option<([f64; 2], bool)> {
        let [low, high] = self.interval;
        let limit = self.requirement.limit;
        let (limit, is_least) = match self.requirement.share() {
            Some(share) => (share, true),
            None => (limit.value(), matches!(limit, GateLimit::AtLeast(_))),
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

    pub fn has_interval(&self) -> bool {
        self.interval.iter().any(|end| end.is_finite())
    }

    fn points(&self) -> usize {
        self.worst.map_or(1, |worst| worst.points)
    }

    /// Confidence of a failure, corrected for looks, requirements and points of time.
    pub fn fails_at(&self) -> f64 {
        adjusted(self.confidences[1], self.points())
    }

    /// Confidence of a failure if this were the only requirement.
    pub fn fails_alone_at(&self) -> f64 {
        adjusted(self.confidences[0], self.points())
    }

    pub fn fails_alone(&self) -> bool {
        let [lower, mut upper] = self.gate.bounds;
        if let Some(worst) = self.worst {
            // the bounds are those of the worst of several points
            let most = (self.runs - self.violations + worst.unresolved).min(self.runs);
            upper = upper_bound(most, self.runs, self.fails_alone_at());
        }
        let is_undecided = matches!(self.gate.decision, Decision::Undecided(_)) && self.reason.is_none();
        is_undecided
            && match (self.requirement.share(), self.requirement.limit) {
                (Some(share), _) => upper < share,
                (None, GateLimit::AtMost(limit)) => lower > limit,
                (None, GateLimit::AtLeast(limit)) => upper < limit,
            }
    }
}
