//! Effects: forces and torques on a spacecraft other than its actuators'.
//!
//! An effect is one file and one row of the list below; its parameters are keys of `[environment]` and `[orbit]`. Every
//! engine declares the [`Form`]s that it integrates (`propagation::integrated_effects`) and refuses a run with any
//! other. Kernels for scenes without effects are compiled without them.

mod along_orbit;
mod changing_effects;
pub(crate) mod plates;
pub mod within_arcs;

use super::actuation::sum;
use super::environment::sun::Sun;
use super::orbit_state::OrbitState;
use crate::math::Real;
use crate::math::enumeration::bit_set;
use crate::math::vector::norm;
use crate::scene::{Actuation, EnvironmentInput, Offsets, Scene, SceneInput};

/// The role of an effect in an engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Form {
    /// A torque that is constant over an arc and part of it.
    Constant,
    /// A torque that changes within an arc, by recurrences for its Taylor series.
    Series,
    /// A torque that changes within an arc and is not analytic.
    Evaluated,
    /// A motion of the centre of mass in closed form, without torque.
    Translation,
    /// A force that depends on the offset from that motion, by recurrences for its Taylor series.
    Force,
}

/// Properties of a scene by which effects act.
struct Facts<'a> {
    environment: &'a EnvironmentInput,
    is_on_orbit: bool,
    /// True if a body may leave the orbit.
    may_leave: bool,
    has_rods: bool,
}

changing_effects::effects! {
    constant {
        /// `environment.body_torque_n_m`.
        ConstantTorque: Constant, "environment.body_torque_n_m", |facts| facts.environment.body_torque_n_m.is_some();
    }
    series {
        /// `environment.gravity_gradient`.
        GravityGradient: gravity_gradient, GradientSeries, [], "environment.gravity_gradient",
            |facts| facts.environment.gravity_gradient;
        /// `environment.magnetic_dipole_a_m2`, and `[[torque_rods]]`.
        MagneticTorque: magnetic_torque, MagneticSeries, [begin_arc, set_arc], "environment.magnetic_dipole_a_m2",
            |facts| facts.environment.magnetic_dipole_a_m2.is_some() || facts.has_rods;
    }
    evaluated {
        /// `environment.drag`.
        Drag: drag, [], "environment.drag", |facts| facts.environment.drag;
        /// `environment.solar_pressure`.
        SolarPressure: solar_pressure, [], "environment.solar_pressure", |facts| facts.environment.solar_pressure;
    }
    of_orbit {
        /// `[orbit]`: the force of gravity on the centre of mass.
        Gravity: Translation, "orbit", |facts| facts.is_on_orbit;
        /// `[orbit]` with thrusters or debris: gravity away from the orbit differs from gravity on it.
        Tide: Force, "orbit", |facts| facts.may_leave;
    }
}

impl<R: Real> ChangingEffects<R> {
    /// Magnetic field at `place` and `time` (s), F_e, T; zero if no effect needs it.
    #[inline(always)]
    pub fn field(&self, time: R, place: &OrbitState<R>) -> [R; 3] {
        match &self.magnetic_torque {
            Some(torque) => torque.field.at(time, place.position),
            None => [time.zero(); 3],
        }
    }

    /// The Sun at `time`, s, if an effect needs it.
    #[inline(always)]
    pub fn sun(&self, time: R) -> Sun<R> {
        // no closure: it may be compiled without vector instructions
        match &self.solar_pressure {
            Some(pressure) => pressure.light.sun(time),
            None => Sun::none(time.zero()),
        }
    }
}

bit_set! {
    /// The effects that act in a run.
    ForceModel of Effect
}

impl ForceModel {
    /// The effects on `scene`.
    pub fn of(scene: &Scene) -> Self {
        Self::acting(&Facts {
            environment: &scene.environment,
            is_on_orbit: scene.orbit.is_some(),
            may_leave: scene.offsets.is_some(),
            has_rods: !scene.torque_rods.is_empty(),
        })
    }

    /// The effects on the scenes of `input`.
    pub fn of_input(input: &SceneInput) -> Self {
        Self::acting(&Facts {
            environment: &input.environment,
            is_on_orbit: input.orbit.is_some(),
            may_leave: Offsets::of(input).is_some(),
            has_rods: !input.torque_rods.is_empty(),
        })
    }

    fn acting(facts: &Facts<'_>) -> Self {
        Effect::ALL.into_iter().filter(|effect| effect.acts(facts)).fold(Self::NONE, Self::with)
    }

    /// The effects in order.
    pub fn effects(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(move |effect| self.contains(*effect))
    }

    /// True if every effect has an `integrated` form.
    pub fn is_integrated(self, integrated: impl Fn(Form) -> bool) -> bool {
        self.effects().all(|effect| integrated(effect.form()))
    }

    /// True if an effect must be in the kernel.
    pub fn changes_within_arcs(self) -> bool {
        self.effects().any(|effect| matches!(effect.form(), Form::Series | Form::Evaluated | Form::Force))
    }
}

/// Adds the effects on `scene` that are constant over an arc to `applied`.
#[inline]
pub fn add_constant_effects(scene: &Scene, applied: &mut Actuation) {
    if let Some(body_torque) = scene.environment.body_torque_n_m {
        *applied = sum(applied, &Actuation { body_torque, ..Actuation::none(f64::INFINITY) });
    }
}

/// Upper bound of the torque of the effects on `scene` that are constant over an arc, N m.
pub fn largest_constant_torque(scene: &Scene) -> f64 {
    scene.environment.body_torque_n_m.map_or(0.0, norm)
}
