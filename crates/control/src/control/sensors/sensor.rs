//! [`Sensor`]: a model of a sensor in a run; [`SensorKind`]: its kind.

use crate::control::truth::Truth;
use crate::loops::kinds::{Components, SensorKind};
use crate::loops::measurement::Values;
use crate::sampling::{Noise, SampleId};
use crate::scene::schema::Limit;
use crate::scene::{DeclaredTable, LawParameter, Scene};

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
pub struct SensorMaker {
    pub kind: SensorKind,
    pub make: fn(&SensorContext<'_>) -> Box<dyn Sensor>,
}

pub(super) const XYZ: Components = Components::Named(&AXES);
pub(super) const WXYZ: Components = Components::Named(&["w", "x", "y", "z"]);

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// An optional vector, by default zero.
pub(super) const fn axes(key: &'static str, unit: &'static str, meaning: &'static str, limit: Limit) -> LawParameter {
    LawParameter::number(key, unit, meaning, limit).with_components(&AXES).or(&[0.0; 3])
}

/// An optional nonnegative number, by default zero.
pub(super) const fn optional(key: &'static str, unit: &'static str, meaning: &'static str) -> LawParameter {
    LawParameter::number(key, unit, meaning, Limit::NotNegative).or(&[0.0])
}
