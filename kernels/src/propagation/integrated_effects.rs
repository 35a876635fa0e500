//! Which effects each kind of engine integrates: an answer for each effect, without a default, so that a new effect does not compile until every engine
//! has said so.
//!
//! A separate file, because the engines know the settings, and the settings do not know the engines.

use crate::dynamics::effects::Effect;

/// Taylor methods.
pub const fn by_taylor(effect: Effect) -> bool {
    match effect {
        Effect::ConstantTorque | Effect::GravityGradient | Effect::Gravity => true,
    }
}

/// Runge-Kutta methods on the gyrostat.
pub const fn by_runge_kutta(effect: Effect) -> bool {
    match effect {
        Effect::ConstantTorque | Effect::GravityGradient | Effect::Gravity => true,
    }
}

/// The null-space formulation: what is constant over an arc.
pub const fn by_null_space(effect: Effect) -> bool {
    match effect {
        Effect::ConstantTorque => true,
        Effect::GravityGradient | Effect::Gravity => false,
    }
}
