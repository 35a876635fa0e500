//! Which forms of effects each kind of engine integrates: an answer for each form, without a default, so that a new
//! form does not compile until every engine has said so.
//!
//! A separate file, because the engines know the settings, and the settings do not know the engines.

use crate::dynamics::effects::Form;

/// Taylor methods: what has a series.
pub const fn by_taylor(form: Form) -> bool {
    match form {
        Form::Constant | Form::Series | Form::Translation | Form::Force => true,
        Form::Evaluated => false,
    }
}

/// Runge-Kutta methods on the gyrostat with an error estimate.
pub const fn by_runge_kutta(form: Form) -> bool {
    match form {
        Form::Constant | Form::Series | Form::Evaluated | Form::Translation | Form::Force => true,
    }
}

/// The reference solution: Taylor series, or extrapolation where an effect has none.
pub const fn by_reference(form: Form) -> bool {
    match form {
        Form::Constant | Form::Series | Form::Evaluated | Form::Translation | Form::Force => true,
    }
}

/// Those without: what they say of their error comes from the Taylor series of the motion.
pub const fn by_fixed_steps(form: Form) -> bool {
    by_taylor(form)
}

/// The null-space formulation: what is constant over an arc.
pub const fn by_null_space(form: Form) -> bool {
    match form {
        Form::Constant => true,
        Form::Series | Form::Evaluated | Form::Translation | Form::Force => false,
    }
}
