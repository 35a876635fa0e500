//! Every method and the double-double solution fly the same sampled-data loop.

use crate::prelude::*;
use crate::support::feedback::{Flight, fly, law};

const HORIZON: f64 = 3.1;

/// Largest relative distance from the double-double solution of any state: within 10 times the measured.
const BOUNDS: [(Method, Control, f64); 7] = [
    (Method::Auto, adaptive(1e-16), 2e-14),
    (Method::Taylor, adaptive(1e-16), 2e-14),
    (DOP853, adaptive(1e-13), 1e-12),
    (DORMAND_PRINCE, adaptive(1e-12), 2e-11),
    (GAUSS_LEGENDRE, fixed(1e-3), 2e-14),
    (RUNGE_KUTTA, fixed(1e-3), 5e-10),
    (Method::NullSpace, adaptive(1e-11), 2e-10),
];

const FIELDS: [StateField; 8] = [
    StateField::Rate,
    StateField::WheelRates,
    StateField::WheelAngles,
    StateField::ComPosition,
    StateField::ComVelocity,
    StateField::Work,
    StateField::Impulse,
    StateField::AngularImpulse,
];

fn distance(flight: &Flight, reference: &ReferenceSolution) -> f64 {
    let table = &flight.run.table;
    let mut worst = 0.0_f64;
    let points = table.points();
    for field in FIELDS {
        let (mut off, mut size) = (0.0_f64, 1.0_f64);
        for component in 0..reference.high.width(field) {
            let (found, expected) = (table.column(field, component), reference.high.column(field, component));
            for (found, expected) in found.iter().zip(expected).take(points) {
                off = off.max((found - expected).abs());
                size = size.max(expected.abs());
            }
        }
        worst = worst.max(off / size);
    }
    for point in 0..points {
        let turned = |sign| reference.distance::<4>(table, StateField::Attitude, point, sign);
        worst = worst.max(turned(1.0).min(turned(-1.0)));
    }
    worst
}

#[test]
fn all_methods_fly_the_same_closed_loop() {
    let grid = Grid::uniform(HORIZON, 29);
    let scenes: Vec<Scene> = mixed(6, false, HORIZON);
    let references: Vec<ReferenceSolution> = scenes
        .iter()
        .map(|scene| {
            let fields = everything(Method::Taylor);
            ReferenceSolution::under(&mut law(scene), Isa::best(), scene, &grid, fields, TOLERANCE).unwrap()
        })
        .collect();
    let mut report = String::new();
    let mut failed = false;
    for (method, control, bound) in BOUNDS {
        let settings = PropagationSettings::new(method, control, grid.clone(), everything(method), &scenes[0])
            .with_feedback(Actuated::ALL);
        let flown = fly(Isa::best(), &settings, &scenes);
        for (scene, flight) in flown.iter().enumerate() {
            assert_eq!(flight.run.outcome.status, Status::Done, "{}, scene {scene}", method.name());
        }
        let worst = flown.iter().zip(&references).map(|(run, exact)| distance(run, exact)).fold(0.0, f64::max);
        failed |= worst > bound || worst.is_nan();
        report.push_str(&format!("{}: {worst:.1e}, bound {bound:.1e}\n", method.name()));
    }
    assert!(!failed, "{report}");
    let last = grid.points() - 1;
    let free = solved(&scenes[0], &grid, everything(Method::Taylor)).high.at::<3>(StateField::Rate, last);
    let bound = references[0].high.at::<3>(StateField::Rate, last);
    // measured: 8.4 rad/s
    assert!((0..3).any(|i| (free[i] - bound[i]).abs() > 1e-3), "{free:?} {bound:?}");
}
