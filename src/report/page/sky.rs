//! What the replay draws about a spacecraft on an orbit: nadir, velocity, Sun and magnetic field as directions in F_e,
//! and the share of the Sun that is hidden.

use serde_json::{Value, json};

use crate::ensemble::SingleRun;
use crate::ensemble::surroundings::{Surroundings, hidden, turning_rate};
use crate::math::vector::{norm, scaled};
use crate::report::page::payload::Payload;
use crate::run::StateField;

/// Between two points that are drawn the orbit turns by this angle at most, rad, unless the run has fewer.
const STEP: f64 = 0.07;
/// Components of directions are rounded to multiples of this: they take less space.
const UNIT: f64 = 1.0 / 8192.0;

/// The directions that are drawn, by the names of the replay's arrows.
const NAMES: [&str; 4] = ["nadir", "velocity", "sun", "field"];

/// Where they point at `time` from `position` with `velocity`, F_e, of any length; `None` of what the scene does not
/// have.
fn vectors(around: &Surroundings, time: f64, [position, velocity]: [[f64; 3]; 2]) -> [Option<[f64; 3]>; 4] {
    let sun = around.sun(time, position).map(|(direction, _)| direction);
    [Some(Surroundings::nadir(position)), Some(velocity), sun, around.field(time, position)]
}

/// Position and velocity of the centre of mass of `run` at `point`.
fn state(run: &SingleRun, point: usize) -> [[f64; 3]; 2] {
    [StateField::ComPosition, StateField::ComVelocity].map(|field| run.table.at::<3>(field, point))
}

/// The directions at some of the first `points` points of `run`, and the hidden share of the Sun at each; `None` where
/// there is no orbit.
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
