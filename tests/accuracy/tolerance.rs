//! Promises of a tolerance, a step and a direction of time.

use crate::support::{exact::Exact, prelude::*};

const SECTION: &str = "tolerance";

fn exact(count: u64, forced: bool, horizon: f64) -> Exact {
    Exact::new(mixed(count, forced, horizon), Grid::uniform(horizon, 9))
}

fn error(exact: &Exact, method: Method, control: Control) -> (f64, f64) {
    let runs = exact.runs(method, control);
    let errors = exact.errors(&runs);
    let count = errors.len() as f64;
    let steps = runs.iter().map(|run| run.outcome.effort.steps as f64).sum::<f64>() / count;
    ((errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt(), steps)
}

const PROPORTIONS: [(Method, u64, f64, f64); 5] = [
    (Method::Auto, 8, 10.0, 4e2),
    (Method::Taylor, 8, 10.0, 4e2),
    (DORMAND_PRINCE, 8, 10.0, 3e1),
    (DOP853, 8, 10.0, 2e1),
    (Method::NullSpace, 4, 1.0, 2.0),
];
const PROPORTIONAL: f64 = 0.05;
/// Slope of the Taylor method, whose order changes in whole numbers.
const STAIRCASE: f64 = 0.15;
const FLOOR: f64 = 2e-14;

#[test]
fn errors_fall_in_proportion_to_the_tolerance() {
    for (method, count, horizon, factor) in PROPORTIONS {
        let exact = exact(count, false, horizon);
        let (mut points, mut largest, mut former) = (Vec::new(), 0.0_f64, f64::INFINITY);
        for exponent in 4..=13 {
            let tolerance = libm::pow(10.0, -f64::from(exponent));
            let (error, _) = error(&exact, method, adaptive(tolerance));
            largest = largest.max(error / tolerance.max(FLOOR));
            if error > FLOOR {
                points.push([libm::log(tolerance), libm::log(error)]);
                // a tenth is the law; measured at most: 0.28 `auto`, 0.14 `taylor`, 0.12 the others
                assert!(error < 0.5 * former, "{method:?}: {error:e} at 1e-{exponent} after {former:e}");
            }
            former = error;
        }
        let off = (draws::slope(&points) - 1.0).abs();
        let claim = |what: &str| format!("`{}`, 1e-4 to 1e-13, rms over scenes: {what}", method.name());
        let slack = if matches!(method, Method::Auto | Method::Taylor) { STAIRCASE } else { PROPORTIONAL };
        hold(SECTION, &claim("distance of the error's log-log slope over the tolerance from 1"), slack, off);
        hold(SECTION, &claim("largest error / tolerance"), factor, largest);
    }
}

const ORDER_SLACK: f64 = 0.3;

/// Law: errors fall with the order of the method, over the step or the number of steps.
#[test]
fn methods_have_their_order() {
    for forced in [false, true] {
        let exact = exact(4, forced, 8.0);
        let what = if forced { "with actuators" } else { "free" };
        for (method, order, step) in [(RUNGE_KUTTA, 4.0, 0.0078125), (GAUSS_LEGENDRE, 6.0, 0.0625)] {
            let at = |step: f64| error(&exact, method, fixed(step)).0;
            let measured = (at(step) / at(0.5 * step)).log2();
            let regime = format!("`{}`, {what}: distance of the measured order from {order}", method.name());
            hold(SECTION, &regime, ORDER_SLACK, (measured - order).abs());
        }
        if forced {
            continue; // most of the few steps of an arc are its first and last
        }
        for (method, order) in [(DORMAND_PRINCE, 5.0), (DOP853, 8.0)] {
            let [(large, few), (small, many)] =
                [1e-8, 1e-12].map(|tolerance| error(&exact, method, adaptive(tolerance)));
            let measured = (large / small).log2() / (many / few).log2();
            let regime = format!("`{}`, {what}: distance of the measured order from {order}", method.name());
            hold(SECTION, &regime, ORDER_SLACK, (measured - order).abs());
        }
    }
}

const RETURN: f64 = 1e3 * f64::EPSILON;

#[test]
fn runs_are_reversible() {
    for (method, control, horizon) in [
        (Method::Auto, adaptive(1e-16), 10.0),
        (Method::Taylor, adaptive(1e-16), 10.0),
        (DORMAND_PRINCE, adaptive(1e-14), 2.0),
        (DOP853, adaptive(1e-14), 10.0),
        (RUNGE_KUTTA, fixed(1e-4), 2.0),
        (GAUSS_LEGENDRE, fixed(1e-2), 10.0),
        (Method::NullSpace, adaptive(1e-14), 0.5),
    ] {
        let off = there_and_back(method, control, horizon);
        let regime = format!("`{}`, {horizon} s forward and back: distance from the start", method.name());
        hold(SECTION, &regime, RETURN, off);
    }
}

fn reversed(scene: &Scene, run: &Run) -> Scene {
    let last = run.table.points() - 1;
    let mut back = scene.clone();
    back.initial.q_es = run.table.at(StateField::Attitude, last);
    back.initial.omega_se_s = run.table.at::<3>(StateField::Rate, last).map(|x| -x);
    let rates = run.table.at::<2>(StateField::WheelRates, last);
    back.initial.wheel_rates[..2].copy_from_slice(&rates.map(|x| -x));
    back
}

fn there_and_back(method: Method, control: Control, horizon: f64) -> f64 {
    let there = Exact { scenes: mixed(8, false, horizon), grid: Grid::uniform(horizon, 3), truths: Vec::new() };
    let runs = there.runs(method, control);
    let turned = there.scenes.iter().zip(&runs).map(|(scene, run)| reversed(scene, run)).collect();
    let back = Exact { scenes: turned, grid: there.grid.clone(), truths: Vec::new() };
    let mut worst = 0.0_f64;
    for (scene, run) in there.scenes.iter().zip(back.runs(method, control)) {
        let (start, last) = (&scene.initial, run.table.points() - 1);
        let rate = relative(run.table.at(StateField::Rate, last), start.omega_se_s.map(|x| -x));
        let attitude = up_to_sign(run.table.at(StateField::Attitude, last), start.q_es);
        let wheels =
            relative(run.table.at(StateField::WheelRates, last), [0, 1].map(|wheel| -start.wheel_rates[wheel]));
        worst = worst.max(rate).max(attitude).max(wheels);
    }
    worst
}
