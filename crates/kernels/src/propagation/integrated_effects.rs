//! Forms of effects that each kind of engine integrates: a new form needs an answer from every engine.

use crate::dynamics::effects::Form;

/// Taylor methods, and Runge-Kutta methods without an error estimate, whose errors follow from the Taylor series.
pub const fn by_series(form: Form) -> bool {
    match form {
        Form::Constant | Form::Series | Form::Translation | Form::Force => true,
        Form::Evaluated => false,
    }
}

/// Runge-Kutta methods on the gyrostat with an error estimate, and reference solutions.
pub const fn by_evaluation(form: Form) -> bool {
    match form {
        Form::Constant | Form::Series | Form::Evaluated | Form::Translation | Form::Force => true,
    }
}

/// The null-space formulation: constant over an arc.
pub const fn by_null_space(form: Form) -> bool {
    match form {
        Form::Constant => true,
        Form::Series | Form::Evaluated | Form::Translation | Form::Force => false,
    }
}
