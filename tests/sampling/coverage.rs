//! Intervals cover, gates err and sketches are off as stated: 10,000 small campaigns of known distributions. H0: the
//! probability is what is stated; three standard errors, alpha = 0.0027 (0.0013 one-sided).

use crate::prelude::*;
use spindrift::{
    math::normal,
    statistics::{
        binomial::{self, Decision, POWER},
        gate::{Gate, failing_at, failing_together, fraction_gate},
        looks::{Goal, adjusted, decision, looks},
        quantile::{Ranks, coverage, interval_ranks},
        sketch::{RELATIVE_ERROR, Sketch},
    },
};

const CAMPAIGNS: u32 = 10_000;
const SIGMAS: f64 = 3.0;

type Distribution = (&'static str, fn(f64) -> f64);

const DISTRIBUTIONS: [Distribution; 3] =
    [("uniform", |u| u), ("normal", normal::quantile), ("exponential", |u| -libm::log1p(-u))];

fn error(p: f64) -> f64 {
    (p * (1.0 - p) / f64::from(CAMPAIGNS)).sqrt()
}

fn fraction(count: u32) -> f64 {
    f64::from(count) / f64::from(CAMPAIGNS)
}

fn sample(random: &mut Uniform, count: usize, quantile: fn(f64) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = (0..count).map(|_| quantile(random.uniform())).collect();
    values.sort_unstable_by(f64::total_cmp);
    values
}

fn covered(seed: u64, count: usize, p: f64, ranks: Ranks, of: fn(f64) -> f64) -> f64 {
    let mut random = Uniform::new(seed);
    let truth = of(p);
    let covers = |values: &[f64]| {
        ranks.lower.is_none_or(|rank| values[rank as usize - 1] <= truth)
            && ranks.upper.is_none_or(|rank| truth <= values[rank as usize - 1])
    };
    fraction((0..CAMPAIGNS).map(|_| u32::from(covers(&sample(&mut random, count, of)))).sum())
}

/// Law: order statistics cover a quantile with their binomial probability; a rank off by one does not.
#[test]
fn order_statistics_cover_with_their_binomial_probability() {
    for (index, (name, of)) in DISTRIBUTIONS.into_iter().enumerate() {
        for (count, p) in [(60, 0.95), (100, 0.5), (100, 0.05), (80, 0.75)] {
            let ranks = interval_ranks(count, p, 0.95);
            let stated = coverage(count, p, ranks);
            let found = covered(index as u64 + 1, count as usize, p, ranks, of);
            assert!((found - stated).abs() <= SIGMAS * error(stated), "{name} n {count} p {p}: {found} for {stated}");
            assert!(stated >= 0.95, "{stated}");
            let narrow = match ranks {
                Ranks { lower: Some(lower), .. } => Ranks { lower: Some(lower + 1), ..ranks },
                Ranks { lower: None, .. } => continue,
            };
            assert!((covered(9, count as usize, p, narrow, of) - stated).abs() > SIGMAS * error(stated), "{narrow:?}");
        }
    }
}

/// Law: Clopper and Pearson's interval covers with the probability of the counts whose interval has the fraction in it.
#[test]
fn clopper_pearson_covers_with_its_exact_probability() {
    for (count, p, confidence) in [(50_u64, 0.9, 0.95), (20, 0.5, 0.9), (200, 0.99, 0.95)] {
        let covers: Vec<bool> = (0..=count)
            .map(|k| {
                let [lower, upper] = binomial::interval(k, count, confidence);
                lower <= p && p <= upper
            })
            .collect();
        let term =
            |k: u64| binomial::at_most(k, count, p) - if k == 0 { 0.0 } else { binomial::at_most(k - 1, count, p) };
        let stated: f64 = (0..=count).filter(|k| covers[*k as usize]).map(term).sum();
        let mut random = Uniform::new(21);
        let campaign = |random: &mut Uniform| (0..count).filter(|_| random.uniform() < p).count();
        let found = fraction((0..CAMPAIGNS).map(|_| u32::from(covers[campaign(&mut random)])).sum());
        assert!((found - stated).abs() <= SIGMAS * error(stated), "{count} {p}: {found} for {stated}");
        assert!(stated >= confidence, "{stated}");
    }
}

/// Law: a campaign that stops at the first narrow interval covers as stated; uncorrected for the looks it would not.
#[test]
fn stopped_campaigns_cover() {
    let runs = looks(40, 640);
    let goal = Goal { quantile: 0.5, half_width: 0.17, confidence: 0.95 };
    let mut random = Uniform::new(41);
    let (mut covered, mut uncorrected, mut stopped) = (0, 0, vec![0_u32; runs.len()]);
    for _ in 0..CAMPAIGNS {
        let values: Vec<f64> = (0..640).map(|_| normal::quantile(random.uniform())).collect();
        let stop = |looks_counted: usize| {
            let found = runs.iter().map(|runs| decision(&values[..*runs as usize], goal, looks_counted));
            let found: Vec<_> = found.collect();
            let at = found.iter().position(|look| look.stops).unwrap_or(runs.len() - 1);
            let [lower, upper] = found[at].interval.map(|end| end.unwrap());
            (at, u32::from(lower <= 0.0 && 0.0 <= upper))
        };
        let (at, covers) = stop(runs.len());
        stopped[at] += 1;
        covered += covers;
        uncorrected += stop(1).1;
    }
    assert!(fraction(covered) >= 0.95 - SIGMAS * error(0.95), "{covered}");
    assert!(stopped.iter().filter(|count| **count > 100).count() >= 2, "several looks stop: {stopped:?}");
    assert!(uncorrected < covered, "{uncorrected} {covered}");
}

/// Law: at the limit itself gates decide at most as often as 1 - confidence on each side, and are not silent.
#[test]
fn gates_err_as_seldom_as_stated() {
    let mut random = Uniform::new(51);
    let mut counts = [0_u32; 2];
    let fraction_gates: Vec<_> = (0..=300).map(|within| fraction_gate(within, 300, 0.95, 0.95)).collect();
    for _ in 0..CAMPAIGNS {
        let within = (0..300).filter(|_| random.uniform() < 0.95).count();
        match fraction_gates[within].decision {
            Decision::Pass => counts[0] += 1,
            Decision::Fail => counts[1] += 1,
            Decision::Undecided(_) => {}
        }
    }
    for count in counts {
        let found = fraction(count);
        assert!(found <= 0.05 + SIGMAS * error(0.05) && found > 0.02, "{counts:?}");
    }
}

/// Law: where the truth is what was seen, nine in ten campaigns of the number of runs named decide, and at most 0.93,
/// since successes are whole.
#[test]
fn nine_of_ten_campaigns_of_the_runs_named_decide() {
    let mut random = Uniform::new(71);
    let named = |gate: Gate| match gate.decision {
        Decision::Undecided(Some(runs)) => runs,
        other => panic!("{other:?}"),
    };
    let checked = |found: u32, what: &str| {
        let found = fraction(found);
        assert!(found >= POWER - SIGMAS * error(POWER) && found < 0.93, "{what}: {found}");
    };
    for (successes, trials, target, decided) in
        [(97, 100, 0.95, Decision::Pass), (92, 100, 0.95, Decision::Fail), (11, 20, 0.5, Decision::Pass)]
    {
        let runs = named(fraction_gate(successes, trials, target, 0.95));
        let truth = successes as f64 / trials as f64;
        let decisions: Vec<bool> =
            (0..=runs).map(|k| fraction_gate(k, runs, target, 0.95).decision == decided).collect();
        let draws = (0..CAMPAIGNS).map(|_| (0..runs).filter(|_| random.uniform() < truth).count());
        checked(draws.map(|k| u32::from(decisions[k])).sum(), &format!("{successes} of {trials}"));
    }
    let unit = libm::sqrt(19.0 / 20.0);
    let seen = Moments::of((0..20).map(|k| 0.3 + if k % 2 == 0 { unit } else { -unit }));
    let runs = named(mean_gate(&seen, GateLimit::AtLeast(0.0), 0.95));
    let mut campaign = || Moments::of((0..runs).map(|_| 0.3 + normal::quantile(random.uniform())));
    let passes = |moments: Moments| mean_gate(&moments, GateLimit::AtLeast(0.0), 0.95).decision == Decision::Pass;
    checked((0..CAMPAIGNS).map(|_| u32::from(passes(campaign()))).sum(), "mean");
}

/// Law: a campaign that looks until a requirement is decided errs over all its looks as stated; uncorrected, more
/// often. Where the truth is not near the target nine in ten decide before the last look.
#[test]
fn sequential_decisions_err_as_seldom_as_stated() {
    let runs = looks(50, 3200);
    let decided = |truth: f64, confidence: f64, seed: u64| {
        let mut random = Uniform::new(seed);
        let limits: Vec<(u64, Vec<Decision>)> = runs
            .iter()
            .map(|n| (*n, (0..=*n).map(|k| fraction_gate(k, *n, 0.9, confidence).decision).collect()))
            .collect();
        let mut counts = [0_u32; 3];
        for _ in 0..CAMPAIGNS {
            let (mut within, mut made) = (0, 0);
            for (look, (n, decisions)) in limits.iter().enumerate() {
                within += (made..*n).filter(|_| random.uniform() < truth).count();
                made = *n;
                let side = match decisions[within] {
                    Decision::Pass => 0,
                    Decision::Fail => 1,
                    Decision::Undecided(_) => continue,
                };
                counts[side] += 1;
                counts[2] += u32::from(look + 1 < limits.len());
                break;
            }
        }
        counts.map(fraction)
    };
    let corrected = decided(0.9, adjusted(0.95, runs.len()), 81);
    let plain = decided(0.9, 0.95, 81);
    for side in 0..2 {
        assert!(corrected[side] <= 0.05 + SIGMAS * error(0.05) && corrected[side] > 0.005, "{corrected:?}");
        assert!(plain[side] > 0.1, "{plain:?}");
    }
    let [pass, fail, early] = decided(0.94, adjusted(0.95, runs.len()), 82);
    assert!(pass > 0.99 && fail < 0.001 && early > 0.9, "{pass} {fail} {early}");
}

/// Law: of six requirements that are met, none fails in at least as many campaigns as stated; uncorrected, one fails in
/// a fifth. Two more that are missed do not change it (Holm).
#[test]
fn several_requirements_that_are_met_seldom_fail() {
    const RUNS: usize = 300;
    let gates = |together: usize| -> Vec<Decision> {
        let at = |within: u64| {
            let gate = |confidence| fraction_gate(within, RUNS as u64, 0.95, confidence);
            failing_at([0.95, adjusted(0.95, together)], |estimate| estimate >= 0.95, gate).decision
        };
        (0..=RUNS as u64).map(at).collect()
    };
    let by_count: Vec<Vec<Decision>> = (0..=6).map(|together| gates(together.max(1))).collect();
    let mut random = Uniform::new(91);
    let mut fails = |truths: [f64; 6], uncorrected: bool| {
        let draw = |truth: f64, random: &mut Uniform| (0..RUNS).filter(|_| random.uniform() < truth).count();
        let (mut met, mut missed) = (0, 0);
        for _ in 0..CAMPAIGNS {
            let within = truths.map(|truth| draw(truth, &mut random));
            let at = |open: usize| -> Vec<bool> {
                let open = if uncorrected { 1 } else { open };
                within.iter().map(|within| by_count[open][*within] == Decision::Fail).collect()
            };
            let failed = failing_together(6, at, |failed| *failed);
            let of =
                |is_met: bool| truths.iter().zip(&failed).any(|(truth, failed)| *failed && (*truth >= 0.95) == is_met);
            met += u32::from(of(true));
            missed += u32::from(of(false));
        }
        [met, missed].map(fraction)
    };
    let (all_met, two_missed, alone) =
        (fails([0.95; 6], false), fails([0.8, 0.8, 0.95, 0.95, 0.95, 0.95], false), fails([0.95; 6], true));
    for found in [all_met, two_missed] {
        assert!(found[0] <= 0.05 + SIGMAS * error(0.05) && found[0] > 0.01, "{found:?}");
    }
    assert!(alone[0] > 0.15 && two_missed[1] > 0.999, "{alone:?} {two_missed:?}");
}

/// Law: quantiles of a sketch of ten million numbers, and bounds of ranks, are within the stated error.
#[test]
fn a_sketch_of_ten_million_is_within_its_error() {
    const COUNT: usize = 10_000_000;
    let mut random = Uniform::new(61);
    let mut values: Vec<f64> = (0..COUNT).map(|_| libm::exp(8.0 * random.uniform()) - 40.0).collect();
    let mut sketch = Sketch::default();
    values.chunks(16_384).for_each(|part| sketch.add_all(part));
    values.sort_unstable_by(f64::total_cmp);
    let ranks = sketch.ranks();
    for p in [1e-6, 0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999, 1.0 - 1e-6] {
        let (found, exact) = (ranks.quantile(p).unwrap(), quantile(&values, p).unwrap());
        assert!((found - exact).abs() <= RELATIVE_ERROR * exact.abs(), "{p}: {found} for {exact}");
        let rank = 1 + (p * (COUNT - 1) as f64) as u64;
        let [lower, upper] = ranks.bounds(rank).unwrap();
        assert!(lower <= values[rank as usize - 1] && values[rank as usize - 1] <= upper, "{p}");
    }
    let (next, median) = (ranks.quantile(0.51).unwrap(), quantile(&values, 0.5).unwrap());
    assert!((next - median).abs() > RELATIVE_ERROR * median.abs());
    assert_eq!((sketch.min(), sketch.max()), (values.first().copied(), values.last().copied()));
}
