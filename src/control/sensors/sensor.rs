//! [`Sensor`]: a model of a sensor in a run; [`SensorKind`]: its kind.

use crate::control::measurement::Values;
use crate::control::observes::Observes;
use crate::control::truth::Truth;
use crate::sampling::{Noise, SampleId};
use crate::scene::schema::Limit;
use crate::scene::schema::control::kept;
use crate::scene::{DeclaredTable, LawParameter, MAX_WHEELS, Scene, SceneInput};

pub trait Sensor: Send {
    /// The measurement of `truth`, in the order of its kind's quantities, if any; `count` samples precede it in the
    /// run.
    fn measure(&mut self, count: u64, truth: &Truth) -> Option<Values>;

    /// True bias of a gyro at its last sample, in F_s.
    fn bias_s(&self) -> Option<[f64; 3]> {
        None
    }
}

/// Settings of a sensor in one run.
#[derive(Clone, Copy, Debug)]
pub struct SensorContext<'a> {
    /// Its parameters as drawn, in a table with the sensor's name.
    pub parameters: &'a DeclaredTable,
    pub drawn: &'a Scene,
    pub period: f64,
    pub sample: SampleId,
    pub seed: u64,
}

impl SensorContext<'_> {
    /// Standard normal numbers of this run for the error `error`, one for each of `components`.
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
    /// The numbers of `count` times their deviations; nothing is drawn for a deviation of zero.
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

#[derive(Debug)]
pub struct SensorKind {
    /// Value of `kind` in `[[sensors]]`.
    pub name: &'static str,
    /// Keys of its table besides `period_s` and `latency_s`.
    pub parameters: &'static [LawParameter],
    /// Values of a measurement in their order, and columns of telemetry.
    pub quantities: &'static [MeasuredQuantity],
    pub observes: Observes,
    /// Its needs besides debris ([`Observes::needs_debris`]).
    pub needs: Option<Need>,
    /// The key that an orbit with an epoch replaces.
    pub replaced_by_epoch: Option<&'static str>,
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
#[derive(Debug)]
pub struct Need {
    pub is_met: fn(&SceneInput) -> bool,
    /// The allowed values without it, and the remedy.
    pub refusal: [&'static str; 2],
}

/// A measured vector.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredQuantity {
    /// Name, without unit and components.
    pub name: &'static str,
    pub components: Components,
    /// Unit, and its suffix in names of columns.
    pub unit: [&'static str; 2],
    /// True if telemetry divides it by the sensor's period.
    pub is_over_period: bool,
    /// A sentence without full stop.
    pub meaning: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Components {
    Named(&'static [&'static str]),
    /// One for each turning wheel.
    Wheels,
}

impl Components {
    pub fn width(self) -> usize {
        match self {
            Components::Named(list) => list.len(),
            Components::Wheels => MAX_WHEELS,
        }
    }
}

pub(super) const XYZ: Components = Components::Named(&AXES);
pub(super) const WXYZ: Components = Components::Named(&["w", "x", "y", "z"]);

impl MeasuredQuantity {
    pub(super) const fn new(
        name: &'static str,
        components: Components,
        [unit, suffix]: [&'static str; 2],
        meaning: &'static str,
    ) -> Self {
        MeasuredQuantity { name, components, unit: [unit, suffix], is_over_period: false, meaning }
    }
}

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// An optional vector, by default zero.
pub(super) const fn axes(key: &'static str, unit: &'static str, meaning: &'static str, limit: Limit) -> LawParameter {
    LawParameter::number(key, unit, meaning, limit).with_components(&AXES).or(&[0.0; 3])
}

/// An optional nonnegative number, by default zero.
pub(super) const fn optional(key: &'static str, unit: &'static str, meaning: &'static str) -> LawParameter {
    LawParameter::number(key, unit, meaning, Limit::NotNegative).or(&[0.0])
}
