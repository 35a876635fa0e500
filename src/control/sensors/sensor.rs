//! [`Sensor`]: a model of a sensor in a run; [`SensorKind`]: a kind of it.

use crate::control::measurement::Values;
use crate::control::observes::Observes;
use crate::control::truth::Truth;
use crate::sampling::{Noise, SampleId};
use crate::scene::schema::Limit;
use crate::scene::schema::control::kept;
use crate::scene::{DeclaredTable, LawParameter, MAX_WHEELS, Scene, SceneInput};

/// A model of a sensor in one run.
pub trait Sensor: Send {
    /// Its measurement of `truth`, in the order of its kind's quantities; `None` if it gives nothing. `count` is
    /// the number of its samples before this one: 0 at the start of the run.
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values>;

    /// The true bias of a gyro at its last sample, in F_s, rad/s.
    fn bias_s(&self) -> Option<[f64; 3]> {
        None
    }
}

/// The settings of a sensor in one run.
#[derive(Clone, Copy, Debug)]
pub struct SensorContext<'a> {
    /// Its parameters as drawn; the name of the table is that of the sensor.
    pub parameters: &'a DeclaredTable,
    /// The scene that is flown.
    pub drawn: &'a Scene,
    /// Time from sample to sample, s.
    pub period: f64,
    /// The sample; 0 is the nominal run.
    pub sample: SampleId,
    /// The seed of the campaign.
    pub seed: u64,
}

impl SensorContext<'_> {
    /// Standard normal numbers of this run for the error called `error`, one for each of `components`.
    pub fn normal<const N: usize>(&self, error: &str, components: [&str; N]) -> NormalErrors<N> {
        let stream = |component: &str| {
            Noise::new(self.seed, &format!("sensors.{}.{error}.{component}", self.parameters.name), self.sample)
        };
        NormalErrors { noise: (self.sample != SampleId(0)).then(|| components.map(stream)) }
    }
}

/// Standard normal numbers, addressed by count; zeros in the nominal run.
#[derive(Debug)]
pub struct NormalErrors<const N: usize> {
    noise: Option<[Noise; N]>,
}

impl<const N: usize> NormalErrors<N> {
    /// The numbers of `count`, each times its deviation; for a deviation of zero nothing is drawn.
    pub fn scaled(&mut self, count: u64, deviations: [f64; N]) -> [f64; N] {
        let mut errors = [0.0; N];
        if let Some(noise) = &mut self.noise {
            for ((error, noise), deviation) in errors.iter_mut().zip(noise).zip(deviations) {
                if deviation != 0.0 {
                    *error = deviation * noise.normal(count);
                }
            }
        }
        errors
    }
}

/// A kind of sensor.
#[derive(Debug)]
pub struct SensorKind {
    /// As in `kind` of `[[sensors]]`.
    pub name: &'static str,
    /// The keys of its table; `period_s` and `latency_s` are those of every sensor.
    pub parameters: &'static [LawParameter],
    /// The numbers of a measurement in their order, and columns of telemetry.
    pub quantities: &'static [MeasuredQuantity],
    /// The part of the state that it observes.
    pub observes: Observes,
    /// Its needs besides debris ([`Observes::needs_debris`]).
    pub needs: Option<Need>,
    /// The key that an orbit with an epoch replaces.
    pub replaced_by_epoch: Option<&'static str>,
    /// The sensor of a run.
    pub make: fn(&SensorContext<'_>) -> Box<dyn Sensor>,
}

impl SensorKind {
    /// The key that `scene` replaces.
    pub fn replaced(&self, scene: &SceneInput) -> Option<&'static str> {
        self.replaced_by_epoch.filter(|_| scene.orbit.is_some_and(|orbit| orbit.epoch.is_some()))
    }

    /// The keys of its table in `scene`.
    pub fn parameters_in(&self, scene: &SceneInput) -> &'static [LawParameter] {
        let is_replaced = |parameter: &LawParameter| self.replaced(scene) == Some(parameter.facts.key);
        match self.parameters.iter().position(is_replaced) {
            Some(place) => kept(&[&self.parameters[..place], &self.parameters[place + 1..]]),
            None => self.parameters,
        }
    }
}

/// A need of a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// `[orbit]`.
    Orbit,
    /// `environment.magnetic_field`, which is of an orbit.
    MagneticField,
}

impl Need {
    /// True if it is met in `scene`.
    pub fn is_met(self, scene: &SceneInput) -> bool {
        match self {
            Need::Orbit => scene.orbit.is_some(),
            Need::MagneticField => scene.environment.magnetic_field.is_some(),
        }
    }

    /// The allowed values without it, and the remedy.
    pub fn refusal(self) -> [&'static str; 2] {
        match self {
            Need::Orbit => ["another kind without an [orbit]", "add an [orbit] table, or delete this one"],
            Need::MagneticField => [
                "another kind where [environment] has no magnetic_field",
                "add magnetic_field = \"igrf\" to [environment], or delete this table",
            ],
        }
    }
}

/// A vector that a sensor measures.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredQuantity {
    /// Its name, without unit, and its components: numbers of a measurement, one after another.
    pub name: &'static str,
    /// Its components.
    pub components: Components,
    /// Its unit, and how that stands in the name of a column.
    pub unit: [&'static str; 2],
    /// True if telemetry divides it by the period of the sensor, as it does rotations.
    pub is_over_period: bool,
    /// Its meaning, a sentence without full stop.
    pub meaning: &'static str,
}

/// The components of a measured vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Components {
    /// Components with these names.
    Named(&'static [&'static str]),
    /// One for each wheel that turns.
    Wheels,
}

impl Components {
    /// Their number.
    pub fn width(self) -> usize {
        match self {
            Components::Named(list) => list.len(),
            Components::Wheels => MAX_WHEELS,
        }
    }
}

/// The components of vectors and of quaternions.
pub(super) const XYZ: Components = Components::Named(&AXES);
pub(super) const WXYZ: Components = Components::Named(&["w", "x", "y", "z"]);

impl MeasuredQuantity {
    /// `name` with `components`, in `unit`, which stands in the names of columns as `suffix`.
    pub(super) const fn new(
        name: &'static str,
        components: Components,
        [unit, suffix]: [&'static str; 2],
        meaning: &'static str,
    ) -> Self {
        MeasuredQuantity { name, components, unit: [unit, suffix], is_over_period: false, meaning }
    }
}

/// The names of the components of a vector.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// A vector in F_s or F_d that a campaign file may leave out: zeros.
pub(super) const fn axes(key: &'static str, unit: &'static str, meaning: &'static str, limit: Limit) -> LawParameter {
    LawParameter::number(key, unit, meaning, limit).with_components(&AXES).or(&[0.0; 3])
}

/// A number that a campaign file may leave out: zero.
pub(super) const fn optional(key: &'static str, unit: &'static str, meaning: &'static str) -> LawParameter {
    LawParameter::number(key, unit, meaning, Limit::NotNegative).or(&[0.0])
}
