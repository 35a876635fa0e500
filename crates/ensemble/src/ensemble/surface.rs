//! [`contact`]: the time at which a run reaches the sphere of `orbit.body_radius_m`, which also carries the heights of
//! the air and casts the shadow.
//!
//! The osculating orbit at a point bounds the distance until the next one: by its periapsis, less the effects of
//! flattening ([`Orbit::lowest`]) and thrusters; air only lowers the periapsis, which the later point shows. If the
//! bound is below the surface, the sample is flown again with points between; other runs cost a few operations a point,
//! or nothing in a fixed orbit.

use crate::campaign::Plan;
use crate::ensemble::crossing::{Located, Wanted, nodes, of_curve};
use crate::math::vector::{dot, norm};
use crate::propagation::CompletedRun;
use crate::run::{Outcome, StateField, Status};
use crate::scene::{Orbit, Scene};
use std::f64::consts::PI;

/// Sixteenfold refinements: five hours become a third of a second.
const LEVELS: usize = 4;
const NARROWINGS: usize = 24;
/// Relative error of the time, as of an event at a tolerance of 1e-9.
const ERROR: f64 = 1e-9;
/// A velocity change dv lowers the periapsis of an orbit of mean motion n by at most this times dv/n: 4 for a circle,
/// twice that for an ellipse.
const LOWERED: f64 = 8.0;

/// Positions and velocities at times, s; NaN beyond the end.
pub(super) type Positions<'a> = dyn FnMut(&[f64]) -> Vec<[[f64; 3]; 2]> + 'a;

pub(super) fn leaves_orbit(plan: &Plan) -> bool {
    plan.nominal.orbit.is_some() && (plan.request().actuated.thrusters || plan.nominal.environment.moves())
}

#[derive(Clone, Copy, Debug)]
struct Place {
    time: f64,
    distance: f64,
    speed: f64,
    is_rising: bool,
    /// Lower bound on the osculating orbit, m.
    lowest: f64,
    half_period: f64,
}

impl Place {
    fn new(orbit: &Orbit, time: f64, [position, velocity]: [[f64; 3]; 2]) -> Self {
        let touching = Orbit { position, velocity, ..*orbit };
        let axis = touching.shape().semi_major_axis;
        // a hyperbola passes once
        let half_period = if axis > 0.0 { PI * (axis / orbit.mu).sqrt() * axis } else { f64::INFINITY };
        let is_rising = dot(position, velocity) >= 0.0;
        let (distance, speed) = (norm(position), norm(velocity));
        Place { time, distance, speed, is_rising, lowest: touching.lowest(), half_period }
    }
}

struct Pushes(Vec<[f64; 2]>);

impl Pushes {
    fn of(scene: &Scene, run: &CompletedRun<'_>) -> Self {
        let (mut total, mut sums) = (0.0, vec![[0.0; 2]]);
        for arc in run.arcs.iter() {
            let force = norm(scene.thruster_force_s(arc.applied.thrust));
            if force > 0.0 {
                sums.push([arc.start, total]);
                total += force * (arc.end() - arc.start) / scene.mass.total;
                sums.push([arc.end(), total]);
            }
        }
        Pushes(sums)
    }

    fn until(&self, time: f64) -> f64 {
        let next = self.0.partition_point(|[end, _]| *end <= time);
        let [start, before] = self.0[next.max(1) - 1];
        self.0.get(next).map_or(before, |[end, after]| before + (after - before) * (time - start) / (end - start))
    }
}

struct Search<'a> {
    orbit: &'a Orbit,
    pushes: Pushes,
    places: Vec<Place>,
    /// Time of a failure, s; else NaN.
    failed: f64,
}

impl Search<'_> {
    /// Intervals that may hold the first contact, in order; the last may be certain.
    fn suspects(&self) -> Vec<([f64; 2], bool)> {
        let surface = self.orbit.body_radius;
        let mut found = Vec::new();
        for pair in self.places.windows(2) {
            let ([before, after], between) = ([pair[0], pair[1]], [pair[0].time, pair[1].time]);
            if after.distance <= surface {
                found.push((between, true));
                return found;
            }
            let half = before.half_period.min(after.half_period);
            let pushed = self.pushes.until(after.time) - self.pushes.until(before.time);
            let passes = !before.is_rising && after.is_rising || after.time - before.time >= half || pushed > 0.0;
            let lowered = if pushed > 0.0 { LOWERED * pushed * half / PI } else { 0.0 };
            if passes && before.lowest.min(after.lowest) - lowered <= surface {
                found.push((between, false));
            }
        }
        let last = self.places[self.places.len() - 1];
        if last.distance - last.speed * (self.failed - last.time) <= surface {
            found.push(([last.time, self.failed], false));
        }
        found
    }

    fn take(&mut self, times: &[f64], positions: &mut Positions<'_>) {
        let new = positions(times).into_iter().zip(times);
        let new = new.map(|(state, time)| Place::new(self.orbit, *time, state));
        self.places.extend(new.filter(|place| place.distance.is_finite()));
        self.places.sort_by(|a, b| a.time.total_cmp(&b.time));
        self.places.dedup_by_key(|place| place.time);
    }

    fn located(&self, mut between: [f64; 2], positions: &mut Positions<'_>) -> f64 {
        let error = ERROR * between[1];
        for _ in 0..NARROWINGS {
            let times: Vec<f64> = nodes(between[0], between[1]).collect();
            let heights: Vec<f64> =
                positions(&times).iter().map(|[position, _]| norm(*position) - self.orbit.body_radius).collect();
            match of_curve(&times, &heights, Wanted { is_rising: false, is_last: false }, error) {
                Located::At(time) => return time,
                Located::Between(start, end) => between = [start, end],
            }
        }
        between[1]
    }
}

/// The time, s, of contact before the run's end at `end`; `positions` gives more points.
pub(super) fn contact(
    scene: &Scene,
    run: &CompletedRun<'_>,
    (times, end): (&[f64], f64),
    positions: &mut Positions<'_>,
) -> Option<f64> {
    let orbit = scene.orbit.as_ref()?;
    let has_left = run.table.has(StateField::ComPosition) && scene.offsets.is_some();
    if !has_left && orbit.lowest() > orbit.body_radius {
        return None;
    }
    let Outcome { status, time: reached, points, .. } = *run.outcome;
    let filled = (times.partition_point(|time| *time < end) + 1).min(points);
    let failed = if status == Status::Done { f64::NAN } else { reached };
    let mut search = Search { orbit, pushes: Pushes::of(scene, run), places: Vec::new(), failed };
    let at_points = |times: &[f64]| -> Vec<[[f64; 3]; 2]> {
        let fields = [StateField::ComPosition, StateField::ComVelocity];
        (0..times.len()).map(|point| fields.map(|field| run.table.at(field, point))).collect()
    };
    match has_left {
        true => search.take(&times[..filled], &mut { at_points }),
        false => search.take(&times[..filled], positions),
    }
    if search.places.is_empty() {
        return None;
    }
    for _ in 0..LEVELS {
        let suspects = search.suspects();
        match suspects[..] {
            [] => return None,
            [(_, true)] => break,
            _ => {}
        }
        let between: Vec<f64> = suspects.iter().flat_map(|([start, end], _)| nodes(*start, *end)).collect();
        search.take(&between, positions);
    }
    let (between, _) = search.suspects().into_iter().find(|(_, is_reached)| *is_reached)?;
    Some(search.located(between, positions)).filter(|time| *time <= end)
}
