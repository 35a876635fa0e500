//! [`Surroundings`]: nadir, Sun, Earth's shadow, magnetic field and ground track for page and figures.

use crate::dynamics::earth_rotation::{TURNS_PER_SECOND, turns_at};
use crate::dynamics::environment::light::Light;
use crate::dynamics::magnetic_field::MagneticField;
use crate::ensemble::SingleRun;
use crate::math::vector::{cross, dot, norm, scaled};
use crate::run::StateField;
use crate::scene::Scene;
use core::f64::consts::TAU;

/// At any time (s) and place (F_e, m).
#[derive(Clone, Copy, Debug)]
pub struct Surroundings {
    light: Option<Light<f64>>,
    field: Option<MagneticField<f64>>,
    /// Earth rotation at time zero, turns; `None` without a date.
    turns: Option<f64>,
}

impl Surroundings {
    /// `None` without an orbit.
    pub fn of(scene: &Scene) -> Option<Self> {
        let orbit = scene.orbit.as_ref()?;
        let (light, field) = (Light::of(0.0, scene), MagneticField::of(scene));
        Some(Surroundings { light, field, turns: orbit.epoch.map(turns_at) })
    }

    /// Unit vector to the Earth's centre, F_e.
    pub fn nadir(position: [f64; 3]) -> [f64; 3] {
        scaled(-1.0 / norm(position), position)
    }

    /// Unit vector to the Sun, F_e, and its share hidden by the Earth; `None` without a date.
    pub fn sun(&self, time: f64, position: [f64; 3]) -> Option<([f64; 3], f64)> {
        let (sun, lit) = self.light?.at(time, position);
        Some((sun.direction, 1.0 - lit))
    }

    /// F_e, T; `None` without a field.
    pub fn field(&self, time: f64, position: [f64; 3]) -> Option<[f64; 3]> {
        Some(self.field?.at_point(time, position))
    }

    /// Longitude (-180 to 180) and geocentric latitude below, deg; `None` without a date.
    pub fn below(&self, time: f64, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        let turned = libm::atan2(y, x) / TAU - (self.turns? + TURNS_PER_SECOND * time);
        Some([360.0 * (turned - libm::round(turned)), libm::atan2(z, libm::hypot(x, y)).to_degrees()])
    }
}

/// The rate of the line from the Earth's centre to a body (m, m/s): |r x v|/r^2, rad/s.
pub fn turning_rate(position: [f64; 3], velocity: [f64; 3]) -> f64 {
    norm(cross(position, velocity)) / dot(position, position)
}

/// The hidden share of the Sun at the first `points` points; `None` if unknown.
pub fn hidden(run: &SingleRun, points: usize) -> Option<Vec<f64>> {
    let around = Surroundings::of(&run.scene)?;
    let at = |point: usize| {
        around.sun(run.grid.times()[point], run.table.at(StateField::ComPosition, point)).map(|(_, hidden)| hidden)
    };
    (0..points).map(at).collect()
}
