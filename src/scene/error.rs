//! [`SceneError`]: one reason why a scene is not physical, with the key to mend.

use std::borrow::Cow;

/// One problem of a scene: which key, which value, what is allowed, what to do.
///
/// The campaign floor adds file and line; the texts here never contain them.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key} = {value}: must be {allowed}; {remedy}")]
pub struct SceneError {
    /// The dotted path as in a campaign file, e.g. `fuselage.wall_thickness_m` or `actuation[1].start_s`.
    pub key: Cow<'static, str>,
    /// The value or values that were refused.
    pub value: String,
    /// What is allowed, with the numbers that bound it.
    pub allowed: String,
    /// What to change.
    pub remedy: &'static str,
}

/// The problems of one input, gathered; without one, nothing is allocated.
#[derive(Default)]
pub(super) struct Problems(pub(super) Vec<SceneError>);

impl Problems {
    /// Notes a problem. Out of line, so that a scene without one runs through its checks in a straight line.
    #[cold]
    #[inline(never)]
    pub(super) fn add(
        &mut self,
        key: impl Into<Cow<'static, str>>,
        value: impl std::fmt::Debug,
        allowed: impl Into<String>,
        remedy: &'static str,
    ) {
        self.0.push(SceneError { key: key.into(), value: format!("{value:?}"), allowed: allowed.into(), remedy });
    }

    /// Whether `value` is finite; notes it where not.
    #[inline(always)]
    pub(super) fn finite(&mut self, key: &'static str, value: f64) -> bool {
        let passed = value.is_finite();
        if !passed {
            self.add(key, value, "a finite number", "write a finite number");
        }
        passed
    }

    /// Whether all `values` are finite; notes the whole vector where not.
    #[inline(always)]
    pub(super) fn all_finite<const N: usize>(&mut self, key: &'static str, values: [f64; N]) -> bool {
        let passed = values.iter().all(|value| value.is_finite());
        if !passed {
            self.add(key, values, "finite numbers", "write finite numbers");
        }
        passed
    }

    /// Whether all `values` are finite and above zero; notes the whole vector where not.
    pub(super) fn all_positive<const N: usize>(&mut self, key: &'static str, values: [f64; N]) -> bool {
        let finite = self.all_finite(key, values);
        let passed = values.iter().all(|&value| value > 0.0);
        if finite && !passed {
            self.add(key, values, "above zero, each", "write positive numbers");
        }
        finite && passed
    }

    /// Whether `value` is finite and above zero; notes it where not.
    #[inline(always)]
    pub(super) fn positive(&mut self, key: &'static str, value: f64) -> bool {
        let passed = self.finite(key, value);
        if passed && value <= 0.0 {
            self.add(key, value, "above zero", "write a positive number");
        }
        passed && value > 0.0
    }

    /// Whether `value` is finite and not below zero; notes it where not.
    #[inline(always)]
    pub(super) fn not_negative(&mut self, key: &'static str, value: f64) -> bool {
        let passed = self.finite(key, value);
        if passed && value < 0.0 {
            self.add(key, value, "zero or above", "write zero or a positive number");
        }
        passed && value >= 0.0
    }
}
