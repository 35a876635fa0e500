//! The conservation errors of every shipped campaign under every method.
//! Bounds: the upper 99% confidence limit of the median, and the largest of 512 runs. Baseline: 33 quantiles of each
//! distribution; H0: the same (Kolmogorov-Smirnov, alpha = 1e-4, critical distance 0.139).
//! `SPINDRIFT_WRITE_BASELINE=1 cargo test --release --test accuracy drift_bounds` writes it again.

use crate::prelude::*;
use serde_json::json;

const SECTION: &str = "drift_bounds";
const WRITE: &str = "SPINDRIFT_WRITE_BASELINE";
const CAMPAIGNS: [&str; 5] = ["burn", "no_debris", "report_1e-6", "report_1e-8", "spin_sweep"];
const RUNS: u64 = 512;
const REFERENCE_RUNS: u64 = 48;
const COLUMNS: [&str; 4] =
    ["energy_error_max", "energy_error_rate_per_s", "angular_momentum_error_max", "angular_momentum_error_rate_per_s"];
const QUANTILES: usize = 33;
/// Kolmogorov's constant for alpha = 1e-4: sqrt(-ln(alpha/2)/2).
const KOLMOGOROV: f64 = 2.225;

/// A method, and its largest relative error of energy over the horizon: (median, largest), 1.6 to 4 times the measured.
#[derive(Clone, Copy)]
struct Setting {
    method: Method,
    tolerance: f64,
    step: Option<f64>,
    horizon: f64,
    energy: [f64; 2],
}

fn settings() -> [Setting; 7] {
    let adaptive = |method, tolerance, horizon, energy| Setting { method, tolerance, step: None, horizon, energy };
    let fixed = |method, step, energy| Setting { method, tolerance: 1e-14, step: Some(step), horizon: 2.0, energy };
    [
        adaptive(Method::Auto, 1e-16, 10.0, [1e-15, 2e-15]),
        adaptive(Method::Taylor, 1e-16, 10.0, [1e-15, 2e-15]),
        adaptive(DORMAND_PRINCE, 1e-8, 2.0, [1e-9, 3e-9]),
        adaptive(DOP853, 1e-8, 2.0, [5e-10, 1e-9]),
        fixed(RUNGE_KUTTA, 1e-3, [1e-11, 2e-11]),
        fixed(GAUSS_LEGENDRE, 1e-2, [1e-15, 2e-15]),
        adaptive(Method::NullSpace, 1e-8, 0.25, [2e-10, 2e-10]),
    ]
}

fn plan(campaign: &str, setting: &Setting) -> Plan {
    let samples = shipped(campaign, None).samples;
    let most = if setting.method == Method::NullSpace { REFERENCE_RUNS } else { RUNS };
    let mut plan = shipped(campaign, Some(samples.min(most)));
    plan.method = setting.method;
    plan.tolerance = Tolerance { relative: setting.tolerance, absolute: setting.tolerance };
    plan.step_s = setting.step;
    plan.grid = Grid::uniform(setting.horizon, 65);
    plan
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    for (sample, size) in sizes.iter().enumerate() {
        assert!(size.is_finite(), "sample {sample}: {size}");
    }
    sizes.sort_by(f64::total_cmp);
    sizes
}

/// Upper 99% confidence limit of the median, by the normal limit of its order statistic.
fn median_limit(sorted: &[f64]) -> f64 {
    let n = sorted.len() as f64;
    let rank = (0.5 * n + 2.326 * (0.25 * n).sqrt()).ceil() as usize;
    sorted[rank.min(sorted.len() - 1)]
}

fn quantiles(sorted: &[f64]) -> Vec<f64> {
    let last = (sorted.len() - 1) as f64;
    (0..QUANTILES).map(|k| sorted[(last * k as f64 / (QUANTILES - 1) as f64).round() as usize]).collect()
}

/// Kolmogorov-Smirnov distance from a baseline known by its quantiles.
fn distance(sorted: &[f64], baseline: &[f64]) -> f64 {
    let n = sorted.len() as f64;
    let at = |k: usize| {
        let share = k as f64 / (QUANTILES - 1) as f64;
        let below = baseline.partition_point(|q| *q < baseline[k]) as f64 / (QUANTILES - 1) as f64;
        let up_to = (baseline.partition_point(|q| *q <= baseline[k]) as f64 - 1.0) / (QUANTILES - 1) as f64;
        let (low, high) = (
            sorted.partition_point(|x| *x < baseline[k]) as f64 / n,
            sorted.partition_point(|x| *x <= baseline[k]) as f64 / n,
        );
        let gap = (low - up_to).max(below - high).max(0.0);
        if below == up_to { gap.max((low - share).max(share - high)) } else { gap }
    };
    (0..QUANTILES).map(at).fold(0.0, f64::max)
}

fn critical(n: usize) -> f64 {
    KOLMOGOROV * (2.0 / n as f64).sqrt()
}

fn golden() -> std::path::PathBuf {
    root().join("tests/golden/drift_bounds.json")
}

fn key(campaign: &str, method: Method, column: &str) -> String {
    format!("{campaign} {} {column}", method.name())
}

fn baseline(file: &Value, key: &str) -> Vec<f64> {
    let list = file[key].as_array().unwrap_or_else(|| panic!("drift_bounds.json has no {key}: {WRITE}=1 writes it"));
    list.iter().map(|value| value.as_str().unwrap().parse().unwrap()).collect()
}

/// Law: errors of shipped campaigns stay within their bounds and distributions.
#[test]
fn shipped_campaigns_drift_as_before() {
    let write = std::env::var_os(WRITE).is_some();
    let file: Value =
        std::fs::read_to_string(golden()).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or(json!({}));
    let mut written = serde_json::Map::new();
    let mut wrong = Vec::new();
    for setting in settings() {
        let (mut middle, mut largest, mut secular) = (0.0_f64, 0.0_f64, 0.0_f64);
        for campaign in CAMPAIGNS {
            let table = rows(&plan(campaign, &setting));
            for (sample, status) in table.statuses.iter().enumerate() {
                assert_eq!(*status, Status::Done, "{campaign} {}, sample {sample}", setting.method.name());
            }
            for column in COLUMNS {
                let found = sorted(table.column(column));
                let key = key(campaign, setting.method, column);
                if column == COLUMNS[0] {
                    middle = middle.max(median_limit(&found));
                    largest = largest.max(found[found.len() - 1]);
                }
                if column == COLUMNS[1] {
                    secular = secular.max(setting.horizon * found[found.len() - 1]);
                }
                if write {
                    let digits = quantiles(&found).into_iter().map(|q| json!(format!("{q:.6e}"))).collect();
                    written.insert(key, Value::Array(digits));
                } else if found.len() == 1 {
                    let ratio = (found[0] + 1e-16) / (baseline(&file, &key)[0] + 1e-16);
                    if !(0.1..10.0).contains(&ratio) {
                        wrong.push(format!("{key}: {:e}, {ratio:.2} times the baseline", found[0]));
                    }
                } else {
                    let (off, limit) = (distance(&found, &baseline(&file, &key)), critical(found.len()));
                    if off > limit {
                        wrong.push(format!("{key}: KS distance {off:.3} > {limit:.3}"));
                    }
                }
            }
        }
        let what = match setting.step {
            Some(step) => format!("steps of {step} s"),
            None => format!("{:e}", setting.tolerance),
        };
        let (method, horizon) = (setting.method.name(), setting.horizon);
        let claim =
            |which: &str| format!("`{method}` at {what}, shipped campaigns, {horizon} s: energy error, {which}");
        hold(SECTION, &claim("upper 99% confidence limit of the median"), setting.energy[0], middle);
        hold(SECTION, &claim("largest (99th percentile at 99.4% confidence)"), setting.energy[1], largest);
        // a straight drift to the largest error, and half as much again for a bent one
        hold(SECTION, &claim("largest secular rate times the time"), 1.5 * setting.energy[1], secular);
    }
    if write {
        let text = serde_json::to_string_pretty(&Value::Object(written)).unwrap();
        std::fs::write(golden(), text + "\n").unwrap();
    }
    assert!(wrong.is_empty(), "distributions have changed ({WRITE}=1 writes the baseline again): {wrong:#?}");
}

/// Distance of the log-log slope from one: a factor of 2.5 over four decades. Measured: 0.015.
const PROPORTIONAL: f64 = 0.1;

#[test]
fn drift_scales_with_the_tolerance() {
    for method in [DORMAND_PRINCE, DOP853, Method::NullSpace] {
        let setting = settings().into_iter().find(|setting| setting.method == method).unwrap();
        let median = |tolerance: f64| {
            let mut plan = plan("no_debris", &Setting { tolerance, ..setting });
            plan.samples = plan.samples.min(64);
            let found = sorted(rows(&plan).column(COLUMNS[0]));
            found[found.len() / 2]
        };
        let slope = libm::log10(median(1e-6) / median(1e-10)) / 4.0;
        let method = method.name();
        let regime =
            format!("`{method}`, median energy error from 1e-6 to 1e-10: distance of its log-log slope from 1");
        hold(SECTION, &regime, PROPORTIONAL, (slope - 1.0).abs());
    }
}

fn faulty(plan: &Plan, count: u64, fault: impl Fn(&mut Scene)) -> [Vec<f64>; 2] {
    let isa = Isa::best();
    let campaign = Ensemble::new(plan, isa);
    let columns = campaign.request().columns();
    let names: Vec<&str> = columns.iter().map(|column| column.quantity.name()).collect();
    let place = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let propagator: &PropagationSettings = campaign.propagator();
    let (mut engine, mut observer) = (propagator.engine(isa), Observer::new(*campaign.request(), &plan.grid));
    let mut row = vec![0.0; names.len()];
    let mut errors = [Vec::new(), Vec::new()];
    for sample in 0..count {
        let drawn = SingleRun::new(plan, SampleId(sample), Grid::uniform(1e-3, 2), isa).unwrap().scene;
        let mut wrong = drawn.clone();
        fault(&mut wrong);
        engine.propagate(std::slice::from_ref(&wrong), &mut |CompletedRun { table, outcome, .. }| {
            observer.observe(isa, &drawn, table, outcome, &mut row);
            for (errors, column) in errors.iter_mut().zip([COLUMNS[0], COLUMNS[2]]) {
                errors.push(row[place(column)]);
            }
        });
    }
    errors.map(|errors| sorted(&errors))
}

/// Counter-test: a coefficient off by 1e-12, a dropped term and a wrong sign are seen, and a sound kernel is not.
#[test]
fn faults_are_seen() {
    if std::env::var_os(WRITE).is_some() {
        return;
    }
    let text = std::fs::read_to_string(golden()).unwrap();
    let file: Value = serde_json::from_str(&text).unwrap();
    let setting = &settings()[0];
    let plan = plan("no_debris", setting);
    let seen = |fault: &dyn Fn(&mut Scene)| {
        let errors = faulty(&plan, 128, fault);
        let off = |i: usize, column| distance(&errors[i], &baseline(&file, &key("no_debris", setting.method, column)));
        let bound = errors[0][errors[0].len() - 1] > setting.energy[1];
        (off(0, COLUMNS[0]).max(off(1, COLUMNS[2])), bound)
    };
    let (sound, beyond) = seen(&|_| {});
    assert!(sound < critical(128) && !beyond);
    for axis in 0..3 {
        let (off, _) = seen(&|scene| scene.mass.inertia_free[axis][axis] *= 1.0 + 1e-12);
        assert!(off > critical(128), "moment {axis}: {off}");
    }
    let (off, beyond) = seen(&|scene| scene.mass.inertia_free = scene.mass.inertia);
    assert!(off > 0.99 && beyond, "{off}");
    let (off, beyond) = seen(&|scene| scene.mass.wheels[0].axis = scene.mass.wheels[0].axis.map(|x| -x));
    assert!(off > 0.99 && beyond, "{off}");
}
