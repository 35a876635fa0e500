//! [`DrawnScenes`]: drawn samples without runs.

use crate::campaign::{Plan, SceneDraws};
use crate::math::symmetric::principal_axes;
use crate::math::vector::{conjugate, hamilton, norm};
use crate::sampling::SampleId;
use crate::sampling::design::Size;
use crate::sampling::design::hash::mix;
use crate::scene::parameter::{Parameter, Shape};
use crate::scene::unit_quaternion::unit_quaternion;
use crate::scene::{Scene, SceneInput};

#[derive(Clone, Debug, PartialEq)]
pub struct DrawnScenes {
    pub first: SampleId,
    /// True if each scene is physical, or its row `invalid_sample`.
    pub physical: Vec<bool>,
    /// In the order of [`crate::sampling::Dispersions::columns`].
    pub columns: Vec<Vec<f64>>,
    /// In the order of [`MASS_COLUMNS`], if wanted; NaN for unphysical samples.
    pub mass: Vec<Vec<f64>>,
    /// In the order of [`magnitudes`].
    pub magnitudes: Vec<Vec<f64>>,
}

/// The length of a rate or alignment error, or the angle of an attitude from the nominal one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Magnitude {
    pub parameter: Parameter,
}

impl Magnitude {
    /// `None` for other parameters.
    pub fn of(parameter: Parameter) -> Option<Self> {
        let is_vector = ["rad/s", "rad"].contains(&parameter.unit()) && parameter.width() > 1;
        (is_vector || parameter.shape() == Shape::Quaternion).then_some(Magnitude { parameter })
    }

    pub fn name(self) -> String {
        let name = self.parameter.name();
        match self.parameter.shape() {
            Shape::Quaternion => format!("{name}, angle from nominal"),
            _ => format!("|{name}|"),
        }
    }

    pub fn unit(self) -> &'static str {
        if self.parameter.shape() == Shape::Quaternion { "rad" } else { self.parameter.unit() }
    }

    /// SI; NaN if the scene lacks the parameter. The angle is 2 atan2(|v|, |w|) of q_0* (x) q = (w, v), accurate for
    /// small angles.
    pub fn value(self, scene: &SceneInput, nominal: &SceneInput) -> f64 {
        let read = |scene: &SceneInput, component| self.parameter.value(scene, component).unwrap_or(f64::NAN);
        if self.parameter.shape() == Shape::Quaternion {
            let attitude = |scene| unit_quaternion(std::array::from_fn(|component| read(scene, component)));
            let [w, x, y, z] = hamilton(conjugate(attitude(nominal)), attitude(scene));
            2.0 * libm::atan2(norm([x, y, z]), w.abs())
        } else {
            (0..self.parameter.width()).map(|component| read(scene, component)).fold(0.0, libm::hypot)
        }
    }
}

/// Magnitudes of the dispersed parameters, by first column.
pub fn magnitudes(plan: &Plan) -> Vec<Magnitude> {
    let mut list: Vec<Magnitude> = Vec::new();
    for magnitude in plan.dispersions.columns().iter().filter_map(|column| Magnitude::of(column.parameter)) {
        if !list.contains(&magnitude) {
            list.push(magnitude);
        }
    }
    list
}

const CENTER: &str = "Centre of mass of the spacecraft, from p in F_s.";

macro_rules! moment {
    ($which:literal) => {
        concat!($which, " principal moment of inertia of the spacecraft, wheels locked, about its centre of mass.")
    };
}

/// Column as in rows, unit, meaning.
pub const MASS_COLUMNS: [[&str; 3]; 7] = [
    ["mass_kg", "kg", "Mass of the spacecraft, wheels included."],
    ["center_of_mass_x_m", "m", CENTER],
    ["center_of_mass_y_m", "m", CENTER],
    ["center_of_mass_z_m", "m", CENTER],
    ["principal_moment_smallest_kg_m2", "kg m^2", moment!("Smallest")],
    ["principal_moment_middle_kg_m2", "kg m^2", moment!("Middle")],
    ["principal_moment_largest_kg_m2", "kg m^2", moment!("Largest")],
];

pub fn mass_properties(scene: &Scene) -> [f64; 7] {
    let (mut moments, _) = principal_axes(scene.mass.inertia);
    moments.sort_by(f64::total_cmp);
    let ([x, y, z], [a, b, c]) = (scene.mass.center, moments);
    [scene.mass.total, x, y, z, a, b, c]
}

/// Samples held at a time by [`DrawnScenes::visit`].
pub const CHUNK: u64 = 1 << 16;

impl DrawnScenes {
    pub fn new(plan: &Plan, first: SampleId, count: u64) -> Self {
        let mut drawn = DrawnScenes::empty(plan, false);
        drawn.draw(plan, &mut SceneDraws::new(plan), first.0..first.0.saturating_add(count).min(plan.samples));
        drawn
    }

    /// Draws the first `count` dispersed samples, or for a design of fixed size one at a pseudo-random place in each of
    /// `count` equal parts.
    pub fn spread(plan: &Plan, count: u64) -> Self {
        let dispersed = plan.samples.saturating_sub(1);
        let has_points = plan.design.size(plan.dispersions.dimensions().len()) != Size::Any;
        if !has_points || dispersed <= count {
            return Self::new(plan, SampleId(1), count);
        }
        let place = |part: u64| {
            let width = dispersed as f64 / count as f64;
            let within = mix(part) as f64 / (u64::MAX as f64);
            1 + (((part as f64 + within) * width) as u64).min(dispersed - 1)
        };
        let mut drawn = DrawnScenes::empty(plan, false);
        drawn.draw(plan, &mut SceneDraws::new(plan), (0..count).map(place));
        drawn
    }

    /// Passes all samples to `seen`, at most [`CHUNK`] at a time, with mass properties if `with_mass`.
    ///
    /// # Errors
    /// The first error of `seen`, which ends the visit.
    pub fn visit<E>(plan: &Plan, with_mass: bool, mut seen: impl FnMut(&Self) -> Result<(), E>) -> Result<(), E> {
        let (mut draws, mut drawn) = (SceneDraws::new(plan), DrawnScenes::empty(plan, with_mass));
        let mut first = 0;
        while first < plan.samples {
            let end = (first + CHUNK).min(plan.samples);
            drawn.draw(plan, &mut draws, first..end);
            seen(&drawn)?;
            first = end;
        }
        Ok(())
    }

    fn empty(plan: &Plan, with_mass: bool) -> Self {
        let mass = if with_mass { vec![Vec::new(); MASS_COLUMNS.len()] } else { Vec::new() };
        let columns = vec![Vec::new(); plan.dispersions.columns().len()];
        let magnitudes = vec![Vec::new(); magnitudes(plan).len()];
        DrawnScenes { first: SampleId(0), physical: Vec::new(), columns, mass, magnitudes }
    }

    fn draw(&mut self, plan: &Plan, draws: &mut SceneDraws<'_>, samples: impl Iterator<Item = u64>) {
        let mut samples = samples.peekable();
        self.first = SampleId(samples.peek().copied().unwrap_or(0));
        self.physical.clear();
        self.columns.iter_mut().chain(&mut self.mass).chain(&mut self.magnitudes).for_each(Vec::clear);
        let magnitudes = magnitudes(plan);
        let mut scenes: Vec<Scene> = Vec::with_capacity(1);
        for sample in samples {
            let physical = draws.scene_at(SampleId(sample), &mut scenes, 0).is_ok();
            self.physical.push(physical);
            self.columns.iter_mut().zip(draws.applied()).for_each(|(column, value)| column.push(*value));
            for (column, magnitude) in self.magnitudes.iter_mut().zip(&magnitudes) {
                column.push(magnitude.value(draws.drawn(), &plan.nominal));
            }
            if !self.mass.is_empty() {
                let values = scenes.first().filter(|_| physical).map_or([f64::NAN; 7], mass_properties);
                self.mass.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
            }
        }
    }

    pub fn count(&self) -> usize {
        self.physical.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observables::Group;
    use crate::observables::table;

    #[test]
    fn mass_properties_are_named_as_in_rows() {
        for [name, unit, _] in MASS_COLUMNS {
            let mut columns = table::all().filter(|column| column.group == Group::MassProperties);
            let found = columns.find(|column| column.quantity.name() == name).expect(name);
            assert_eq!(found.quantity.unit(), unit, "{name}");
        }
    }
}
