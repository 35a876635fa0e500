//! [`SensorKind`] and [`EstimatorKind`]: traits and keys of the kinds of sensors and estimators.

use super::observes::Observes;
use crate::scene::schema::control::kept;
use crate::scene::{LawParameter, MAX_WHEELS, SceneInput};

#[derive(Debug)]
pub struct EstimatorKind {
    pub name: &'static str,
    pub knows_the_truth: bool,
    /// True if it has filters, whose covariances can be compared with their errors.
    pub has_filter: bool,
    /// True if it uses an observation of this kind.
    pub uses: fn(&Observes) -> bool,
    pub parameters: &'static [LawParameter],
}

/// Kinds are equal by name.
impl PartialEq for EstimatorKind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
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

impl MeasuredQuantity {
    pub const fn new(
        name: &'static str,
        components: Components,
        unit: [&'static str; 2],
        meaning: &'static str,
    ) -> Self {
        MeasuredQuantity { name, components, unit, is_over_period: false, meaning }
    }
}

/// Kinds are equal by name.
impl PartialEq for SensorKind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
