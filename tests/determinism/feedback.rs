//! Runs under laws of their own: bits do not depend on lanes, other runs, order, instruction set or threads, and the record of the
//! arcs flown gives the same run again.

use crate::support::feedback::{Flight, PERIOD, fly, fly_recorded, fly_schedules};
use crate::support::runs::{Bits, adaptive, everything, fixed};
use crate::support::scenes::mixed;
use spindrift::math::Isa;
use spindrift::ode::Control;
use spindrift::propagation::{Method, PropagationSettings};
use spindrift::run::Grid;
use spindrift::scene::Scene;

/// s.
const HORIZON: f64 = 3.1;

const METHODS: [(Method, Control); 7] = [
    (Method::Auto, adaptive(1e-12)),
    (Method::Taylor, adaptive(1e-12)),
    (Method::DormandPrince, adaptive(1e-8)),
    (Method::Dop853, adaptive(1e-8)),
    (Method::RungeKutta4, fixed(0.01)),
    (Method::GaussLegendre, fixed(0.01)),
    (Method::NullSpace, adaptive(1e-5)),
];

fn settings(method: Method, control: Control, scenes: &[Scene]) -> PropagationSettings {
    PropagationSettings::new(method, control, Grid::uniform(HORIZON, 29), everything(method), &scenes[0])
        .with_feedback()
}

fn bits(flights: &[Flight]) -> Vec<Bits> {
    flights.iter().map(|flight| flight.run.bits()).collect()
}

/// Law: a run under feedback is the same bits alone, together with others, in any order, on every instruction set, and on two
/// threads.
#[test]
fn bits_are_a_run_s_own() {
    for (method, control) in METHODS {
        let scenes = mixed(13, false, HORIZON);
        let settings = settings(method, control, &scenes);
        let alone: Vec<Flight> =
            scenes.iter().map(|scene| fly(Isa::best(), &settings, std::slice::from_ref(scene)).remove(0)).collect();
        let expected = bits(&alone);
        let samples = (HORIZON / PERIOD).ceil() as usize;
        assert!(alone.iter().all(|flight| flight.arcs.len() == samples), "one arc per control period");
        for isa in Isa::available() {
            let together = fly(isa, &settings, &scenes);
            assert!(bits(&together) == expected, "{} on {}", method.name(), isa.name());
            assert!(together.iter().zip(&alone).all(|(a, b)| a.arcs == b.arcs), "{}", method.name());
        }
        let backwards: Vec<Scene> = scenes.iter().rev().cloned().collect();
        assert!(bits(&fly(Isa::best(), &settings, &backwards)).iter().rev().eq(&expected), "{}", method.name());
        let (first, second) = scenes.split_at(6);
        let (first, second) = std::thread::scope(|scope| {
            let settings = &settings;
            let first = scope.spawn(move || bits(&fly(Isa::best(), settings, first)));
            let second = scope.spawn(move || bits(&fly(Isa::best(), settings, second)));
            (first.join().expect("a thread"), second.join().expect("a thread"))
        });
        assert!(first.into_iter().chain(second).eq(expected), "{} on two threads", method.name());
    }
}

/// Law: the record of the arcs flown is a schedule that gives the same bits: as a law, and as the schedule of the scene.
#[test]
fn the_record_flown_again_gives_the_same_bits() {
    for (method, control) in METHODS {
        let mut scenes = mixed(13, false, HORIZON);
        let settings = settings(method, control, &scenes);
        let flown = fly(Isa::best(), &settings, &scenes);
        let records: Vec<_> = flown.iter().map(|flight| flight.arcs.clone()).collect();
        let again = fly_recorded(Isa::best(), &settings, &scenes, &records);
        assert!(bits(&again) == bits(&flown), "{} as laws", method.name());
        for (scene, record) in scenes.iter_mut().zip(&records) {
            scene.schedule = record.clone();
        }
        let replayed = fly_schedules(Isa::best(), &settings, &scenes);
        assert!(replayed.iter().zip(&records).all(|(flight, record)| flight.arcs == *record), "{}", method.name());
        assert!(bits(&replayed) == bits(&flown), "{} as schedules", method.name());
        // the law can fail: a record with one switch moved gives another run
        let moved = &mut scenes[0].schedule[3];
        moved.applied.body_torque[0] += 1e-6 * (1.0 + moved.applied.body_torque[0].abs());
        let other = fly_schedules(Isa::best(), &settings, &scenes[..1]);
        assert!(other[0].run.bits() != flown[0].run.bits(), "{}", method.name());
    }
}
