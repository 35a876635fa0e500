//! The bits of a run do not depend on other runs, order, lane or instruction set.

use crate::support::{
    orbits::coupled,
    prelude::*,
    runs::{Bits, METHODS, control_of, hash},
    scenes::mixed_kind,
};
use rayon::prelude::*;

const HORIZON: f64 = 6.0;

fn plan(method: Method, control: Control, scenes: &[Scene]) -> PropagationSettings {
    plan_until(HORIZON, method, control, scenes)
}

fn plan_until(horizon: f64, method: Method, control: Control, scenes: &[Scene]) -> PropagationSettings {
    let settings =
        PropagationSettings::new(method, control, Grid::uniform(horizon, 29), everything(method), &scenes[0]);
    PropagationSettings {
        wheels: scenes.iter().map(|scene| scene.mass.wheels.len()).max().unwrap(),
        thrust: scenes.iter().any(|scene| scene.commands_thrust),
        motors: scenes.iter().any(|scene| scene.commands_torque),
        ..settings
    }
}

type Whole = (Bits, LocalErrors, LocalErrors);

fn whole(run: &Run) -> Whole {
    (run.bits(), run.outcome.local_errors, run.outcome.debris_errors)
}

fn wholes(runs: &[Run]) -> Vec<Whole> {
    runs.iter().map(whole).collect()
}

fn equal_among_runs_of(horizon: f64, method: Method, control: Control, scenes: &dyn Fn(bool) -> Vec<Scene>) {
    for forced in [false, true] {
        let scenes = scenes(forced);
        let plan = plan_until(horizon, method, control, &scenes);
        let alone: Vec<Whole> = scenes
            .iter()
            .map(|scene| whole(&propagate_on(Isa::best(), &plan, std::slice::from_ref(scene))[0]))
            .collect();
        let distinct: std::collections::HashSet<&Bits> = alone.iter().map(|(bits, ..)| bits).collect();
        assert_eq!(distinct.len(), scenes.len(), "scenes differ, so that equality says something");
        for isa in Isa::available() {
            let what = format!("{} on {}, forced: {forced}", method.name(), isa.name());
            assert!(wholes(&propagate_on(isa, &plan, &scenes)) == alone, "{what}");
            let backwards: Vec<Scene> = scenes.iter().rev().cloned().collect();
            assert!(wholes(&propagate_on(isa, &plan, &backwards)).iter().rev().eq(&alone), "{what}, backwards");
        }
        let mut engine = plan.engine(Isa::best());
        engine.propagate(&scenes[10..], &mut |_| {});
        let mut found = vec![None; 10];
        engine.propagate(&scenes[..10], &mut |CompletedRun { index, table, outcome, .. }| {
            found[index] = Some(whole(&Run { table: table.clone(), outcome: *outcome }));
        });
        let what = format!("{}, second batch, forced: {forced}", method.name());
        assert!(found.into_iter().flatten().eq(alone[..10].iter().cloned()), "{what}");
    }
}

#[test]
fn bits_do_not_depend_on_other_runs() {
    METHODS.par_iter().for_each(|(method, control)| {
        equal_among_runs_of(HORIZON, *method, *control, &|forced| mixed(21, forced, HORIZON));
    });
}

#[test]
fn many_wheels_among_any_runs() {
    let scenes = |forced: bool| -> Vec<Scene> {
        let input = |k: u64| many_wheels([8, 4, 3, 1, 0][(k % 5) as usize], k, forced, HORIZON);
        (0..13).map(|k| resolved(&input(k))).collect()
    };
    METHODS.par_iter().filter(|(method, _)| !method.has_fixed_step()).for_each(|(method, control)| {
        let horizon = if *method == Method::NullSpace { 1.0 } else { HORIZON };
        equal_among_runs_of(horizon, *method, *control, &scenes);
    });
}

/// Law: so do runs on orbits about a point mass, circles among them, and about a flattened body, with air and light
/// that turn and move them.
#[test]
fn orbits_among_any_runs() {
    let turning = |forced: bool| {
        let mut scenes = tumbling(13, 41, [0.2, 10.0]);
        let torque = forced.then_some([1e-4, 2e-4, -1e-4]);
        scenes.iter_mut().for_each(|scene| scene.environment.body_torque_n_m = torque);
        scenes
    };
    let flattened = |forced: bool| {
        let mut scenes = turning(forced);
        for (k, scene) in scenes.iter_mut().enumerate() {
            scene.orbit.as_mut().unwrap().j2 = Some([0.0, 1e-3][k % 2]);
        }
        scenes
    };
    let round = |forced: bool| {
        let mut scenes = turning(forced);
        for (_, scene) in scenes.iter_mut().enumerate().filter(|(k, _)| k % 3 > 0) {
            let orbit = scene.orbit.as_mut().unwrap();
            let [x, y, _] = orbit.position;
            let across = [-y, x, 0.0];
            let speed = (orbit.mu / norm(orbit.position)).sqrt();
            orbit.velocity = scaled(speed / norm(across), across);
        }
        scenes
    };
    let moved = |forced: bool| coupled(13, if forced { 5 } else { 6 });
    let families: [&(dyn Fn(bool) -> Vec<Scene> + Sync); 4] = [&turning, &flattened, &round, &moved];
    for scenes in families {
        let able = METHODS.par_iter().filter(|(method, _)| method.integrates(ForceModel::of(&scenes(true)[0])));
        able.for_each(|(method, control)| {
            let control = Control { step: control.step.map(|_| 10.0), ..*control };
            equal_among_runs_of(6000.0, *method, control, &scenes);
        });
    }
}

#[test]
fn runs_that_fail_beside_runs_that_do_not() {
    for method in [Method::Taylor, Method::Auto, DORMAND_PRINCE] {
        let scenes = mixed(21, true, HORIZON);
        let whole = propagate_on(Isa::best(), &plan(method, adaptive(1e-12), &scenes), &scenes);
        let mut steps: Vec<u64> = whole.iter().map(|run| run.outcome.effort.steps).collect();
        steps.sort_unstable();
        let control = Control { max_steps: steps[10], ..adaptive(1e-12) };
        let plan = plan(method, control, &scenes);
        let together = propagate_on(Isa::best(), &plan, &scenes);
        let done = together.iter().filter(|run| run.outcome.points == 29).count();
        assert!((1..21).contains(&done), "{done} of 21 are complete");
        for (scene, run) in scenes.iter().zip(&together) {
            let alone = &propagate_on(Isa::best(), &plan, std::slice::from_ref(scene))[0];
            assert!(alone.bits() == run.bits(), "{}", method.name());
        }
    }
}

/// The first 64 bits of the SHA-256 of outcome and states of sixteen fixed scenes. A deliberate change of a method's
/// arithmetic commits new ones (printed by this test) with its reason.
const GOLDEN: [(Method, &str, &str); 7] = [
    (Method::Auto, "d50ff790ae91ea57", "1ea1a21bc85d5402"),
    (Method::Taylor, "946cf90aedee39ca", "116e9773de473632"),
    (DORMAND_PRINCE, "98b666c6598c06bf", "35453f7aadc57cfb"),
    (DOP853, "09aaab6fca8de5d1", "c5927ff47dae48c1"),
    (RUNGE_KUTTA, "b12204d809439ba8", "d8c41193ad609629"),
    (GAUSS_LEGENDRE, "ffb8ee51245782fd", "3f2593a94efcea15"),
    (Method::NullSpace, "2dcfc8a1b4dcc668", "1933a2c1436c1eb1"),
];

fn golden_bits(run: &Run, k: u64, forced: bool) -> Bits {
    let has = mixed_kind(k, forced).wheels;
    let table = &run.table;
    assert_eq!(table.wheels(), 2, "the first scene, which makes the table, has both wheels");
    let mut bits = run.outcome_bits();
    for block in StateField::ALL.into_iter().filter(|block| table.fields().contains(*block)) {
        let before = match block {
            StateField::WheelRates | StateField::WheelAngles => 0,
            StateField::KineticEnergies => 1,
            _ => table.width(block),
        };
        let components = 0..table.width(block);
        bits.extend(components.clone().take(before).flat_map(|component| run.column_bits(block, component)));
        let mut place = before;
        for present in has.into_iter().take(table.width(block) - before) {
            if present {
                bits.extend(run.column_bits(block, place));
                place += 1;
            } else {
                bits.extend(std::iter::repeat_n(0.0_f64.to_bits(), table.points()));
            }
        }
        let after = components.skip(before + has.len());
        bits.extend(after.flat_map(|component| run.column_bits(block, component)));
    }
    bits
}

#[test]
fn bits_are_golden() {
    let mut wrong = String::new();
    for (method, free, forced) in GOLDEN {
        let control = control_of(method);
        for (expected, forced) in [(free, false), (forced, true)] {
            let scenes = mixed(16, forced, HORIZON);
            let runs = propagate_on(Isa::best(), &plan(method, control, &scenes), &scenes);
            let found = hash((0..).zip(&runs).flat_map(|(k, run)| golden_bits(run, k, forced)));
            if found[..16] != *expected {
                wrong.push_str(&format!("{method:?}, forced {forced}: {}\n", &found[..16]));
            }
        }
    }
    assert!(wrong.is_empty(), "bits have changed:\n{wrong}");
}
