//! Effects: what acts on a spacecraft beside its actuators, under a schedule and under any law alike.
//!
//! Each effect is one file, and its lines in the list here; its parameters are keys of `[environment]` and `[orbit]`
//! ([`crate::scene::schema`]). The effects that act in a run are its [`ForceModel`]. Every engine says which [`Form`]s
//! of effects it integrates (`propagation::integrated_effects`); a run is not given to an engine that leaves one out.
//!
//! - `constant_torque`: constant in F_s: a part of every arc of constant actuation, so that all methods have it.
//! - [`gravity_gradient`]: depends on attitude and position.
//! - [`magnetic_torque`]: depends on attitude, position, date and the torque rods.
//! - [`drag`], [`solar_pressure`]: act on plates ([`plates`]), which turn on and off.
//! - [`within_arcs`]: the effects that change within an arc, as the equations of motion have them, and what they depend
//!   on; `changing_effects` makes them from the list.
//!
//! A scene without effects costs nothing: its kernel is compiled without them. A scene with effects evaluates only
//! those that act, and its orbit only where one of them needs it.

mod changing_effects;
mod constant_torque;
pub mod drag;
pub mod gravity_gradient;
pub mod magnetic_torque;
pub mod plates;
pub mod solar_pressure;
pub mod within_arcs;

use super::actuation::sum;
use crate::math::vector::dot;
use crate::scene::{Actuation, EnvironmentInput, Offsets, Scene, SceneInput};

/// An effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// `environment.body_torque_n_m`.
    ConstantTorque,
    /// `environment.gravity_gradient`.
    GravityGradient,
    /// `environment.magnetic_dipole_a_m2`, and `[[torque_rods]]`.
    MagneticTorque,
    /// `environment.drag`.
    Drag,
    /// `environment.solar_pressure`.
    SolarPressure,
    /// `[orbit]`: the force of gravity on the centre of mass.
    Gravity,
    /// `[orbit]` with thrusters or debris: gravity beside the orbit is another than on it.
    Tide,
}

/// What an effect is to an engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// A torque that is constant over an arc, and a part of it.
    Constant,
    /// A torque that changes within an arc, with recurrences for its Taylor series.
    Series,
    /// A torque that changes within an arc and can only be evaluated, because it is not analytic.
    Evaluated,
    /// A motion of the centre of mass in closed form, which turns nothing.
    Translation,
    /// A force that depends on the offset from that motion, and turns nothing; with recurrences for its Taylor series.
    Force,
}

impl Effect {
    /// All effects.
    pub const ALL: [Effect; 7] = [
        Effect::ConstantTorque,
        Effect::GravityGradient,
        Effect::MagneticTorque,
        Effect::Drag,
        Effect::SolarPressure,
        Effect::Gravity,
        Effect::Tide,
    ];

    /// The key that makes it act.
    pub const fn key(self) -> &'static str {
        match self {
            Effect::ConstantTorque => "environment.body_torque_n_m",
            Effect::GravityGradient => "environment.gravity_gradient",
            Effect::MagneticTorque => "environment.magnetic_dipole_a_m2",
            Effect::Drag => "environment.drag",
            Effect::SolarPressure => "environment.solar_pressure",
            Effect::Gravity | Effect::Tide => "orbit",
        }
    }

    /// What it is to an engine.
    pub const fn form(self) -> Form {
        match self {
            Effect::ConstantTorque => Form::Constant,
            Effect::GravityGradient => Form::Series,
            Effect::MagneticTorque => Form::Series,
            Effect::Drag => Form::Evaluated,
            Effect::SolarPressure => Form::Evaluated,
            Effect::Gravity => Form::Translation,
            Effect::Tide => Form::Force,
        }
    }

    /// Whether it acts in `environment`: on an orbit or on none, which the bodies may leave or not, with torque rods or
    /// without.
    const fn acts_in(self, environment: &EnvironmentInput, [is_on_orbit, may_leave, has_rods]: [bool; 3]) -> bool {
        match self {
            Effect::ConstantTorque => environment.body_torque_n_m.is_some(),
            Effect::GravityGradient => environment.gravity_gradient,
            Effect::MagneticTorque => environment.magnetic_dipole_a_m2.is_some() || has_rods,
            Effect::Drag => environment.drag,
            Effect::SolarPressure => environment.solar_pressure,
            Effect::Gravity => is_on_orbit,
            Effect::Tide => may_leave,
        }
    }
}

changing_effects::changing_effects! {
    series {
        gravity_gradient: GravityGradient, GradientSeries;
        magnetic_torque: MagneticTorque, MagneticSeries;
    }
    evaluated {
        drag: Drag;
        solar_pressure: SolarPressure;
    }
}

/// The effects that act in a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ForceModel(u32);

impl ForceModel {
    /// No effects.
    pub const NONE: ForceModel = ForceModel(0);

    /// The effects on `scene`.
    pub fn of(scene: &Scene) -> Self {
        let facts = [scene.orbit.is_some(), scene.offsets.is_some(), !scene.torque_rods.is_empty()];
        Self::acting(&scene.environment, facts)
    }

    /// Those that act on the scenes of `input`.
    pub fn of_input(input: &SceneInput) -> Self {
        let facts = [input.orbit.is_some(), Offsets::of(input).is_some(), !input.torque_rods.is_empty()];
        Self::acting(&input.environment, facts)
    }

    fn acting(environment: &EnvironmentInput, facts: [bool; 3]) -> Self {
        let acts = |effect: &Effect| effect.acts_in(environment, facts);
        Effect::ALL.into_iter().filter(acts).fold(Self::NONE, Self::with)
    }

    /// These and one more.
    #[must_use]
    pub const fn with(self, effect: Effect) -> Self {
        ForceModel(self.0 | 1 << effect as u32)
    }

    /// Whether `effect` is among them.
    pub const fn contains(self, effect: Effect) -> bool {
        self.0 & (1 << effect as u32) != 0
    }

    /// The effects.
    pub fn effects(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(move |effect| self.contains(*effect))
    }

    /// Whether every effect has a form that `integrated` says yes to.
    pub fn is_integrated(self, integrated: impl Fn(Form) -> bool) -> bool {
        self.effects().all(|effect| integrated(effect.form()))
    }

    /// Whether an effect changes within an arc and the kernel has it: all but those in closed form.
    pub fn changes_within_arcs(self) -> bool {
        self.effects().any(|effect| matches!(effect.form(), Form::Series | Form::Evaluated | Form::Force))
    }
}

/// Adds the effects on `scene` that are constant over an arc to what is `applied` by the actuators.
#[inline]
pub fn add_constant_effects(scene: &Scene, applied: &mut Actuation) {
    if scene.environment.body_torque_n_m.is_some() {
        *applied = sum(applied, &constant_torque::actuation(scene));
    }
}

/// The environment of a run whose arcs are known to contain the constant effects: that of the run without them.
pub fn beside_arcs(environment: EnvironmentInput) -> EnvironmentInput {
    EnvironmentInput { body_torque_n_m: None, ..environment }
}

/// Upper bound of the torque of the effects on `scene` that are constant over an arc, N m.
pub fn largest_constant_torque(scene: &Scene) -> f64 {
    let mut applied = Actuation::none(f64::INFINITY);
    add_constant_effects(scene, &mut applied);
    dot(applied.body_torque, applied.body_torque).sqrt()
}
