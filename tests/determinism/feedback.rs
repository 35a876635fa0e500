//! Runs under laws: bits do not depend on company, order, instruction set or threads, and the record of arcs replays.

use crate::support::{
    feedback::{Flight, PERIOD, fly, fly_recorded, fly_schedules, fly_under, law},
    orbits::in_thin_air,
    prelude::*,
    runs::{Bits, METHODS, propagate, relative_field},
    scenes::WHEELS,
};
use spindrift::{
    dynamics::actuation::{Actuation, ActuationLaw, ZeroOrderHold},
    observables::FlownRun,
    scene::Arc,
};

const HORIZON: f64 = 3.1;

fn settings(method: Method, control: Control, scenes: &[Scene]) -> PropagationSettings {
    PropagationSettings::new(method, control, Grid::uniform(HORIZON, 29), everything(method), &scenes[0])
        .with_feedback(Actuated::ALL)
}

fn bits(flights: &[Flight]) -> Vec<Bits> {
    flights.iter().map(|flight| flight.run.bits()).collect()
}

/// Law: a run under feedback has the same bits alone, with others, in any order and on every instruction set.
#[test]
fn bits_are_a_run_s_own() {
    for (method, control) in METHODS {
        let scenes = mixed(13, false, HORIZON);
        let settings = settings(method, control, &scenes);
        let alone: Vec<Flight> =
            scenes.iter().map(|scene| fly(Isa::best(), &settings, std::slice::from_ref(scene)).remove(0)).collect();
        let expected = bits(&alone);
        let samples = (HORIZON / PERIOD).ceil() as usize;
        for (run, flight) in alone.iter().enumerate() {
            assert_eq!(flight.arcs.len(), samples, "{}, run {run}: one arc per control period", method.name());
        }
        for isa in Isa::available() {
            let together = fly(isa, &settings, &scenes);
            assert!(bits(&together) == expected, "{} on {}", method.name(), isa.name());
            for (run, (a, b)) in together.iter().zip(&alone).enumerate() {
                assert!(a.arcs == b.arcs, "{} on {}: arcs of run {run}", method.name(), isa.name());
            }
        }
        let backwards: Vec<Scene> = scenes.iter().rev().cloned().collect();
        assert!(bits(&fly(Isa::best(), &settings, &backwards)).iter().rev().eq(&expected), "{}", method.name());
    }
}

#[test]
fn the_environment_acts_beside_a_law() {
    for forced in [false, true] {
        let calm = mixed(5, forced, HORIZON);
        let mut scenes = calm.clone();
        scenes.iter_mut().for_each(|scene| scene.environment.body_torque_n_m = Some([30.0, -20.0, 10.0]));
        let schedules: Vec<Vec<Arc>> = scenes.iter().map(|scene| scene.schedule.clone()).collect();
        assert!(schedules.iter().all(|schedule| schedule.is_empty() != forced));
        for (method, control) in METHODS {
            let settings = settings(method, control, &scenes);
            let open = bits(&fly_schedules(Isa::best(), &settings, &scenes));
            let under = bits(&fly_recorded(Isa::best(), &settings, &scenes, &schedules));
            assert!(under == open, "{}, forced: {forced}", method.name());
            let without = bits(&fly_recorded(Isa::best(), &settings, &calm, &schedules));
            assert!(without.iter().zip(&open).all(|(a, b)| a != b), "{}, forced: {forced}", method.name());
        }
    }
}

/// Each of the `scenes` flown alone under its `law`, which has the bits of all flown together.
fn alone_and_together<L: ActuationLaw>(
    settings: &PropagationSettings,
    scenes: &[Scene],
    law: &dyn Fn(usize) -> L,
) -> Vec<Flight> {
    let alone = (0..scenes.len()).map(|k| fly_under(&mut vec![law(k)], Isa::best(), settings, &scenes[k..=k]));
    let alone: Vec<Flight> = alone.map(|mut flights| flights.remove(0)).collect();
    for isa in Isa::available() {
        let mut laws: Vec<_> = (0..scenes.len()).map(law).collect();
        let together = fly_under(&mut laws, isa, settings, scenes);
        assert!(bits(&together) == bits(&alone), "{} on {}", settings.method.name(), isa.name());
    }
    alone
}

#[test]
fn bits_of_brief_arcs_are_a_run_s_own() {
    let mut scenes = mixed(13, false, HORIZON);
    for (k, scene) in scenes.iter_mut().enumerate() {
        let slower = (-2.0 * (k % 6) as f64).exp2();
        scene.initial.omega_se_s = scene.initial.omega_se_s.map(|rate| slower * rate);
        scene.initial.wheel_rates = scene.initial.wheel_rates.map(|rate| slower * rate);
    }
    let period = |k: usize| [0.01, 0.02, 0.005, 1.0, 0.04][k % 5];
    let idle = |k: usize| k % 4 == 3;
    let single = |k: usize| {
        let mut law = law(&scenes[k]);
        ZeroOrderHold::new(period(k), move |time: f64, body: &BodyState, wheels: &WheelState| {
            if idle(k) { Actuation::none(f64::INFINITY) } else { law.arc(time, body, wheels) }
        })
    };
    for (method, control) in METHODS.into_iter().filter(|(method, _)| matches!(method, Method::Auto | Method::Taylor)) {
        let settings = settings(method, control, &scenes);
        let alone = alone_and_together(&settings, &scenes, &single);
        let records: Vec<_> = alone.iter().map(|flight| flight.arcs.clone()).collect();
        assert!(records.iter().any(|record| record.len() > 600), "{} arcs", records[2].len());
        let mut replayed = scenes.clone();
        for (scene, record) in replayed.iter_mut().zip(&records) {
            scene.schedule = record.clone();
        }
        assert!(bits(&fly_schedules(Isa::best(), &settings, &replayed)) == bits(&alone), "{}", method.name());
    }
}

/// Law: in short arcs effects read series along the orbit, in long ones they are evaluated at the orbit, run by run;
/// the motion is that of one long arc.
#[test]
fn short_arcs_read_series_along_the_orbit() {
    const LONG: f64 = 900.0;
    let (control, grid) = (adaptive(1e-12), Grid::uniform(LONG, 29));
    let period = |k: usize| [1.0, 300.0, 7.0, 20.0][k % 4];
    let nothing = |_: f64, _: &BodyState, _: &WheelState| Actuation::none(f64::INFINITY);
    let single = |k: usize| ZeroOrderHold::new(period(k), nothing);
    // series of the motion know neither air, light nor field
    for method in [DOP853, DORMAND_PRINCE, Method::Taylor] {
        let mut scenes = in_thin_air(13, 59);
        for (k, scene) in scenes.iter_mut().enumerate() {
            let environment = &mut scene.environment;
            if method != Method::Taylor {
                environment.magnetic_field = Some(FieldModel::Igrf);
                environment.magnetic_dipole_a_m2 = Some([0.3, -0.2, 0.1]);
            } else {
                (environment.drag, environment.solar_pressure) = (false, false);
            }
            environment.gravity_gradient = true;
            let is_oblate = method == Method::Taylor || k.is_multiple_of(2);
            scene.orbit.as_mut().unwrap().j2 = is_oblate.then_some(1.08262668e-3);
        }
        let settings = PropagationSettings::new(method, control, grid.clone(), everything(method), &scenes[0])
            .with_feedback(Actuated::ALL);
        let alone = alone_and_together(&settings, &scenes, &single);
        for (k, (own, free)) in alone.iter().zip(propagate(method, control, &grid, &scenes)).enumerate() {
            for field in [StateField::Attitude, StateField::Rate] {
                let off = relative_field(&own.run.table, &free.table, field, 28);
                assert!(off < 1e-9, "{}, run {k}, {field:?}: {off:e}", method.name());
            }
        }
    }
}

struct Pushing<L>(L, Vec<bool>, f64);

impl<L: ActuationLaw> ActuationLaw for Pushing<L> {
    fn arc(&mut self, time: f64, body: &BodyState, wheels: &WheelState) -> Actuation {
        let mut answer = self.0.arc(time, body, wheels);
        for (index, torque) in answer.motor_torque.iter_mut().enumerate() {
            if self.1.get(index).is_none_or(|is_pushed| *is_pushed) {
                *torque = self.2;
            }
        }
        answer
    }
}

#[test]
fn a_torque_on_a_held_wheel_changes_no_bit() {
    let scenes = (0..12).map(|k| resolved(&many_wheels(4, k, false, HORIZON)));
    let is_held = |scene: &Scene| -> Vec<bool> {
        scene.mass.wheels.iter().map(|wheel| wheel.mode == WheelMode::SpeedHeld).collect()
    };
    let mixed = scenes.filter(|scene| is_held(scene).contains(&true) && is_held(scene).contains(&false));
    let scenes: Vec<Scene> = mixed.take(3).collect();
    assert_eq!(scenes.len(), 3);
    for scene in &scenes {
        let held = is_held(scene);
        let free: Vec<bool> = held.iter().map(|is_held| !is_held).collect();
        for (method, control) in METHODS {
            let settings = settings(method, control, std::slice::from_ref(scene));
            let pushed = |wheels: &[bool], torque: f64| {
                let law = ZeroOrderHold::new(PERIOD, Pushing(law(scene), wheels.to_vec(), torque));
                bits(&fly_under(&mut vec![law], Isa::best(), &settings, std::slice::from_ref(scene)))
            };
            assert!(pushed(&held, 2.5) == pushed(&held, 0.0), "{}", method.name());
            assert!(pushed(&free, 2.5) != pushed(&free, 0.0), "{}", method.name());
        }
    }
}

type Observe = fn(&mut Observer, Isa, &Scene, &CompletedRun<'_>, &mut [f64]);

fn flown(observer: &mut Observer, isa: Isa, scene: &Scene, run: &CompletedRun<'_>, row: &mut [f64]) {
    observer.observe_flown(isa, &FlownRun { scene, arcs: run.arcs, of_law: &[] }, run.table, run.outcome, row);
}

fn scheduled(observer: &mut Observer, isa: Isa, scene: &Scene, run: &CompletedRun<'_>, row: &mut [f64]) {
    observer.observe(isa, scene, run.table, run.outcome, row);
}

fn rows(
    isa: Isa,
    (method, control): (Method, Control),
    scenes: &[Scene],
    is_closed_loop: bool,
    observe: Observe,
) -> (Vec<Bits>, Vec<Vec<Arc>>) {
    // the errors of a loop are those of its pilots
    let groups = Group::ALL.into_iter().filter(|group| *group != Group::Numerics).collect();
    let request = request(groups, WHEELS.len(), true, true, method == Method::NullSpace);
    let settings = settings(method, control, scenes);
    let mut observer = Observer::new(request, &Grid::uniform(HORIZON, 29));
    let mut row = vec![0.0; request.columns().len()];
    let (mut rows, mut records) = (vec![Bits::new(); scenes.len()], vec![Vec::new(); scenes.len()]);
    let mut finish = |run: CompletedRun<'_>| {
        observe(&mut observer, isa, &scenes[run.index], &run, &mut row);
        rows[run.index] = row.iter().map(|value| value.to_bits()).collect();
        records[run.index] = run.arcs.to_vec();
    };
    let mut engine = settings.engine(isa);
    if is_closed_loop {
        let mut laws: Vec<_> = scenes.iter().map(law).collect();
        engine.propagate_under(Laws::Feedback(&mut laws), scenes, &mut finish);
    } else {
        engine.propagate(scenes, &mut finish);
    }
    (rows, records)
}

/// Law: the columns of a run under a law are those of its record flown as a schedule, bit for bit.
#[test]
fn columns_are_those_of_the_record_replayed() {
    for (method, control) in METHODS {
        let mut scenes = mixed(10, false, HORIZON);
        scenes.retain(|scene| scene.mass.wheels.len() == WHEELS.len());
        let method = (method, control);
        let (best, _) = rows(Isa::best(), method, &scenes, true, flown);
        let closed: Vec<_> = Isa::available().into_iter().map(|isa| rows(isa, method, &scenes, true, flown)).collect();
        for (isa, (observed, records)) in Isa::available().into_iter().zip(closed) {
            assert!(observed == best, "{} on {}", method.0.name(), isa.name());
            for (scene, record) in scenes.iter_mut().zip(records) {
                scene.schedule = record;
            }
            let (replayed, _) = rows(isa, method, &scenes, false, scheduled);
            assert!(replayed == best, "{} on {} replayed", method.0.name(), isa.name());
        }
    }
}
