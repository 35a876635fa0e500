//! Directions of nadir, velocity, Sun and magnetic field in F_e for the replay, and the hidden share of the Sun.

use serde_json::{Value, json};

use crate::ensemble::SingleRun;
use crate::ensemble::surroundings::{Surroundings, hidden, turning_rate};
use crate::math::vector::{norm, scaled};
use crate::report::page::payload::Payload;
use crate::run::StateField;

/// Maximum turn of the orbit between drawn points, rad.
const STEP: f64 = 0.07;
/// Rounding of direction components, to save space.
const UNIT: f64 = 1.0 / 8192.0;

const NAMES: [&str; 4] = ["nadir", "velocity", "sun", "field"];

fn vectors(around: &Surroundings, time: f64, [position, velocity]: [[f64; 3]; 2]) -> [Option<[f64; 3]>; 4] {
    let sun = around.sun(time, position).map(|(direction, _)| direction);
    [Some(Surroundings::nadir(position)), Some(velocity), sun, around.field(time, position)]
}

fn state(run: &SingleRun, point: usize) -> [[f64; 3]; 2] {
    [StateField::ComPosition, StateField::ComVelocity].map(|field| run.table.at::<3>(field, point))
}

/// The directions at some of the first `points` points of `run`, and the hidden share of the Sun; `None` without an
/// orbit.
pub fn directions(run: &SingleRun, points: usize, payload: &mut Payload) -> Option<Value> {
    let (around, times) = (Surroundings::of(&run.scene)?, run.grid.times());
    let turned = |point: usize| {
        let [position, velocity] = state(run, point);
        turning_rate(position, velocity) * (times[point + 1] - times[point])
    };
    let most = (0..points.saturating_sub(1)).map(turned).fold(f64::MIN_POSITIVE, f64::max);
    let every = ((STEP / most) as usize).clamp(1, points.max(1));
    let last = points.checked_sub(1)?;
    let shown: Vec<usize> = (0..last).step_by(every).chain([last]).collect();
    let mut drawn = json!({ "times": payload.singles(&shown.iter().map(|point| times[*point]).collect::<Vec<_>>()) });
    let rounded = |vector: [f64; 3]| scaled(1.0 / norm(vector), vector).map(|x| UNIT * libm::round(x / UNIT));
    let all: Vec<_> = shown.iter().map(|point| vectors(&around, times[*point], state(run, *point))).collect();
    for (place, name) in NAMES.into_iter().enumerate() {
        let components: Option<Vec<[f64; 3]>> = all.iter().map(|vectors| vectors[place].map(rounded)).collect();
        if let Some(components) = components {
            drawn[name] = payload.singles(components.as_flattened());
        }
    }
    if let Some(hidden) = hidden(run, points) {
        drawn["hidden"] = payload.singles(&hidden);
    }
    Some(drawn)
}
