//! Decisions on requirements: met, missed, or undecided with the number of runs that would decide.
//!
//! Fractions and quantiles share one exact binomial test ([`super::binomial::decide`]): the `p`-quantile is at most a
//! limit if at least the fraction p of runs is. Means have bounds that allow for skewness ([`super::mean`]), designs in
//! replicates their own ([`super::replicates`]). A decision is wrong with at most the probability 1 - confidence.

use super::binomial::{Decision, MAX_RUNS, POWER, decide, lower_bound, upper_bound};
use super::looks::adjusted;
use super::mean::{bernstein_reach, bounded_mean_bounds, distance_towards, mean_bounds, one_sided};
use super::moments::Moments;
use super::replicates;

/// Limit of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GateLimit {
    /// At most this.
    AtMost(f64),
    /// At least this.
    AtLeast(f64),
}

impl GateLimit {
    /// True if `value` is within the limit; NaN never is.
    pub fn is_met(self, value: f64) -> bool {
        match self {
            GateLimit::AtMost(limit) => value <= limit,
            GateLimit::AtLeast(limit) => value >= limit,
        }
    }

    /// Required fraction of runs within the limit for a limit of the `p`-quantile.
    pub fn fraction(self, p: f64) -> f64 {
        match self {
            GateLimit::AtMost(_) => p,
            GateLimit::AtLeast(_) => 1.0 - p,
        }
    }

    /// The limit.
    pub fn value(self) -> f64 {
        match self {
            GateLimit::AtMost(limit) | GateLimit::AtLeast(limit) => limit,
        }
    }
}

/// A decision and its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// The decision.
    pub decision: Decision,
    /// Fraction or mean.
    pub estimate: f64,
    /// One-sided bounds, each at the confidence.
    pub bounds: [f64; 2],
}

/// The gate `at` a confidence, but failing at the higher confidence `fails_at` only.
pub fn failing_at([confidence, fails_at]: [f64; 2], is_met: impl Fn(f64) -> bool, at: impl Fn(f64) -> Gate) -> Gate {
    let gate = at(confidence);
    if gate.decision == Decision::Pass || is_met(gate.estimate) {
        return gate;
    }
    Gate { decision: at(fails_at).decision, ..gate }
}

/// Decisions on several requirements, of which a met one fails with at most the risk 1 - c: `at(m)` fails at the
/// confidence 1 - (1 - c)/m.
///
/// By S. Holm, *Scand. J. Stat.* 6 (1979) 65, m counts the requirements that have not failed yet. A pass of all is
/// wrong only if a missed one passes, and needs no correction (R. L. Berger, *Technometrics* 24 (1982) 295).
pub fn failing_together<T>(count: usize, at: impl Fn(usize) -> Vec<T>, has_failed: impl Fn(&T) -> bool) -> Vec<T> {
    let mut open = count;
    loop {
        let found = at(open);
        let left = count - found.iter().filter(|one| has_failed(one)).count();
        if left == 0 || left >= open {
            return found;
        }
        open = left;
    }
}

/// Gate on a success rate of at least `target`, from independent trials.
pub fn fraction_gate(successes: u64, trials: u64, target: f64, confidence: f64) -> Gate {
    Gate {
        decision: decide(successes, trials, target, confidence),
        estimate: if trials == 0 { f64::NAN } else { successes as f64 / trials as f64 },
        bounds: match trials {
            0 => [0.0, 1.0],
            _ => [lower_bound(successes, trials, confidence), upper_bound(successes, trials, confidence)],
        },
    }
}

/// [`fraction_gate`] for successes within bounds: the decision common to both.
pub fn fraction_gate_within(successes: [u64; 2], trials: u64, target: f64, confidence: f64) -> Gate {
    let [least, most] = successes.map(|successes| fraction_gate(successes, trials, target, confidence));
    let decision = match (least.decision, most.decision) {
        (Decision::Pass, _) => Decision::Pass,
        (_, Decision::Fail) => Decision::Fail,
        // the numbers in between stay unseparated with more runs
        (Decision::Undecided(runs), Decision::Undecided(other)) => {
            Decision::Undecided(runs.zip(other).map(|(a, b)| a.max(b)))
        }
        _ => Decision::Undecided(None),
    };
    Gate { decision, estimate: 0.5 * (least.estimate + most.estimate), bounds: [least.bounds[0], most.bounds[1]] }
}

/// Gate on a success rate of at least `target` at each of several points of the same runs, each by bounds of its
/// successes and its number of runs.
///
/// It passes if every point does ([`failing_together`]), and fails if a point does at the confidence 1 - (1 -
/// `fails_at`)/points (Bonferroni). Estimate, bounds and index are those of the first point with the smallest estimate.
pub fn points_gate(points: &[([u64; 2], u64)], target: f64, [confidence, fails_at]: [f64; 2]) -> (Gate, Option<usize>) {
    let confidences = [confidence, adjusted(fails_at, points.len())];
    let gate = |(counts, runs): &([u64; 2], u64)| {
        let at = |confidence| fraction_gate_within(*counts, *runs, target, confidence);
        failing_at(confidences, |estimate| estimate >= target, at)
    };
    let gates: Vec<Gate> = points.iter().map(gate).collect();
    let worst = gates.iter().enumerate().min_by(|(_, a), (_, b)| a.estimate.total_cmp(&b.estimate));
    let Some((index, worst)) = worst else {
        return (Gate { decision: Decision::Undecided(None), estimate: f64::NAN, bounds: [0.0, 1.0] }, None);
    };
    let decision = if gates.iter().all(|gate| gate.decision == Decision::Pass) {
        Decision::Pass
    } else if gates.iter().any(|gate| gate.decision == Decision::Fail) {
        Decision::Fail
    } else {
        match worst.decision {
            Decision::Undecided(_) => worst.decision,
            _ => Decision::Undecided(None),
        }
    };
    (Gate { decision, ..*worst }, Some(index))
}

/// Gate on the mean of independent runs. Runs without spread decide nothing: they may hide a rare event.
pub fn mean_gate(moments: &Moments, limit: GateLimit, confidence: f64) -> Gate {
    let bounds = mean_bounds(moments, confidence);
    let is_spread = bounds.iter().any(|bound| bound.is_finite());
    gate_on_mean(moments, limit, bounds, is_spread, |n| distance_towards(limit.value(), moments, n, confidence))
}

/// Gate on the mean of runs with values in `range`, for any distribution, even without spread.
pub fn bounded_mean_gate(moments: &Moments, range: [f64; 2], limit: GateLimit, confidence: f64) -> Gate {
    let bounds = bounded_mean_bounds(moments, range, confidence);
    let deviation = moments.standard_deviation().unwrap_or(f64::NAN);
    let reach = |n| bernstein_reach(n, range[1] - range[0], deviation, confidence);
    gate_on_mean(moments, limit, bounds, moments.count() > 1, reach)
}

/// Gate on a mean with these `bounds`, which `n` runs have `reach(n)` from it.
fn gate_on_mean(
    moments: &Moments,
    limit: GateLimit,
    bounds: [f64; 2],
    is_decidable: bool,
    reach: impl Fn(u64) -> f64,
) -> Gate {
    let estimate = moments.mean().unwrap_or(f64::NAN);
    let deviation = moments.standard_deviation().unwrap_or(f64::NAN);
    let distance = (estimate - limit.value()).abs();
    let decides = |n: u64| {
        let scatter = one_sided(POWER, n as f64 - 1.0) * deviation;
        reach(n) + scatter / libm::sqrt(n as f64) < distance
    };
    let needed = || is_decidable.then(|| smallest(moments.count(), decides)).flatten();
    Gate { decision: decision(bounds, limit, needed), estimate, bounds }
}

/// Gate on a number that is the same in every run and has no error.
pub fn constant_gate(value: f64, limit: GateLimit) -> Gate {
    let decision = if limit.is_met(value) { Decision::Pass } else { Decision::Fail };
    Gate { decision, estimate: value, bounds: [value; 2] }
}

/// Gate on a success rate of at least `target`, from the rates of independent replicates of `runs` runs in all.
pub fn replicate_fraction_gate(fractions: &[f64], runs: u64, target: f64, confidence: f64) -> Gate {
    let bounds = replicates::fraction_bounds(fractions, runs, confidence);
    replicate_gate(fractions, bounds, runs, GateLimit::AtLeast(target), confidence)
}

/// Gate on a mean, from the `means` of independent replicates and the moments of all their runs.
pub fn replicate_mean_gate(means: &[f64], whole: &Moments, limit: GateLimit, confidence: f64) -> Gate {
    let bounds = replicates::mean_bounds(means, whole, confidence);
    replicate_gate(means, bounds, whole.count(), limit, confidence)
}

/// More runs mean larger replicates, whose variance falls at least in proportion.
fn replicate_gate(estimates: &[f64], bounds: [f64; 2], runs: u64, limit: GateLimit, confidence: f64) -> Gate {
    let estimate = Moments::of(estimates.iter().copied()).mean().unwrap_or(f64::NAN);
    let distance = (estimate - limit.value()).abs();
    let width = if estimate < limit.value() { bounds[1] - estimate } else { estimate - bounds[0] };
    let needed = || {
        let degrees = estimates.len() as f64 - 1.0;
        let width = width * (1.0 + one_sided(POWER, degrees) / one_sided(confidence, degrees));
        let factor = width / distance * (width / distance);
        let needed = (width.is_finite() && distance > 0.0).then(|| (runs as f64 * factor).ceil());
        needed.filter(|needed| *needed <= MAX_RUNS as f64).map(|needed| needed as u64)
    };
    Gate { decision: decision(bounds, limit, needed), estimate, bounds }
}

fn decision([lower, upper]: [f64; 2], limit: GateLimit, needed: impl FnOnce() -> Option<u64>) -> Decision {
    let [inside, outside] = match limit {
        GateLimit::AtMost(limit) => [upper <= limit, lower > limit],
        GateLimit::AtLeast(limit) => [lower >= limit, upper < limit],
    };
    match (inside, outside) {
        (true, _) => Decision::Pass,
        (_, true) => Decision::Fail,
        _ => Decision::Undecided(needed()),
    }
}

/// Smallest number above `from` for which the monotonic `decides` holds, up to [`MAX_RUNS`].
fn smallest(from: u64, decides: impl Fn(u64) -> bool) -> Option<u64> {
    let (mut low, mut high) = (from, from);
    while !decides(high) {
        low = high;
        high = high.checked_mul(2).filter(|high| *high <= MAX_RUNS)?;
    }
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if decides(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::near;

    /// Law: several points pass if each does, and fail if one does at the corrected confidence; bounds decide together.
    #[test]
    fn every_point_must_pass() {
        let of = |successes: &[u64]| {
            let points: Vec<([u64; 2], u64)> = successes.iter().map(|count| ([*count; 2], 1000)).collect();
            points_gate(&points, 0.9, [0.95; 2]).0
        };
        assert_eq!((of(&[950, 960, 999]).decision, of(&[950, 960, 840]).decision), (Decision::Pass, Decision::Fail));
        let found = of(&[950, 905, 999]);
        assert!(matches!(found.decision, Decision::Undecided(Some(_))) && found.estimate == 0.905, "{found:?}");
        // 883 of 1000 misses 0.9 at 95% (P = 0.0433), but not at 99.9%, as fifty points require
        assert_eq!(of(&[883]).decision, Decision::Fail);
        let mut many = vec![999; 49];
        many.push(883);
        assert!(matches!(of(&many).decision, Decision::Undecided(_)));
        assert_eq!(of(&[]).decision, Decision::Undecided(None));
        for (bounds, decision) in
            [([950, 960], Decision::Pass), ([800, 850], Decision::Fail), ([800, 960], Decision::Undecided(None))]
        {
            assert_eq!(points_gate(&[(bounds, 1000)], 0.9, [0.95; 2]).0.decision, decision, "{bounds:?}");
        }
    }

    /// Law: a mean decides if both bounds lie on one side of the limit, else it predicts the runs that decide; nothing
    /// decides at the limit, without spread, or with too few runs.
    #[test]
    fn known_gates_on_a_mean() {
        let values = [1.0, 2.0, 3.0, 4.0].repeat(5);
        let moments = Moments::of(values.iter().copied());
        let of = |limit| mean_gate(&moments, limit, 0.95);
        let [lower, upper] = of(GateLimit::AtMost(4.1)).bounds;
        // Student's half-width t(0.95, 19) s/sqrt(20) = 1.729 * 0.2565, widened for hidden skewness
        assert!(upper - 2.5 > 0.4435 && upper - 2.5 < 1.25 * 0.4435 && (upper + lower - 5.0).abs() < 1e-14, "{upper}");
        for (limit, decision) in [
            (GateLimit::AtMost(4.1), Decision::Pass),
            (GateLimit::AtMost(0.9), Decision::Fail),
            (GateLimit::AtLeast(0.9), Decision::Pass),
            (GateLimit::AtLeast(4.1), Decision::Fail),
            (GateLimit::AtMost(2.5), Decision::Undecided(None)),
        ] {
            assert_eq!(of(limit).decision, decision, "{limit:?}");
        }
        let Decision::Undecided(Some(needed)) = of(GateLimit::AtMost(2.6)).decision else { panic!("undecided") };
        // with so many runs the bound is nearer than the limit by 1.2816 standard errors, the scatter in nine of ten
        let repeated = Moments::of(values.iter().copied().cycle().take(needed as usize));
        let upper = mean_gate(&repeated, GateLimit::AtMost(2.6), 0.95).bounds[1];
        let distance = upper - 2.5 + 1.2816 * repeated.mean_error().expect("many");
        // s of 1133 is 2.5% smaller than that of 20 with the same spread
        near(distance, 0.1, 0.05);
        for (found, decision) in [
            (mean_gate(&Moments::of([1.0]), GateLimit::AtMost(9.0), 0.95), Decision::Undecided(None)),
            (mean_gate(&Moments::of([0.0; 100]), GateLimit::AtMost(9.0), 0.95), Decision::Undecided(None)),
            (constant_gate(0.0, GateLimit::AtMost(9.0)), Decision::Pass),
            (constant_gate(f64::NAN, GateLimit::AtMost(9.0)), Decision::Fail),
        ] {
            assert_eq!(found.decision, decision, "{found:?}");
        }
    }

    /// Law: a requirement missed on its own but not among several is undecided; each failure helps the others (Holm):
    /// p = 0.001, 0.014, 0.03 and 0.04 fail at 0.0125, 0.0167, 0.025 and not at 0.05/2.
    #[test]
    fn several_requirements_fail_together() {
        // 883 of 1000 miss 0.9 with P = 0.0433, 870 with P = 0.0013 (scipy.stats.binom.cdf)
        let of = |within: u64, together: usize| {
            let at = |confidence| fraction_gate(within, 1000, 0.9, confidence);
            failing_at([0.95, adjusted(0.95, together)], |estimate| estimate >= 0.9, at)
        };
        assert_eq!((of(883, 1).decision, of(870, 6).decision), (Decision::Fail, Decision::Fail));
        let found = of(883, 6);
        assert!(matches!(found.decision, Decision::Undecided(Some(runs)) if runs > 1000), "{found:?}");
        assert_eq!(found.bounds, of(883, 1).bounds);
        assert_eq!(of(950, 6), of(950, 1), "a pass needs no correction");
        let fails = |tails: [f64; 4]| {
            let at = |open: usize| tails.iter().map(|tail| *tail <= 0.05 / open as f64).collect::<Vec<_>>();
            failing_together(4, at, |has_failed| *has_failed)
        };
        assert_eq!(fails([0.001, 0.014, 0.03, 0.04]), [true, true, false, false]);
        assert_eq!(fails([0.04, 0.024, 0.001, 0.014]), [true; 4]);
        assert_eq!(fails([0.013, 0.014, 0.015, 0.016]), [false; 4]);
    }
}
