//! [`SceneError`]: one reason why a scene is not physical, with the key to fix.

use std::borrow::Cow;

/// One problem of a scene: which key, which value, what is allowed, what to do.
///
/// The reader of campaign files adds file and line; the texts here never contain them.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key} = {value}: must be {allowed}; {remedy}")]
pub struct SceneError {
    /// The dotted path as in a campaign file, e.g. `body.parts.b1.length_m` or `actuation[1].start_s`.
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
    /// Notes a problem. Out of line: a scene without one then runs through its checks without a jump.
    #[cold]
    #[inline(never)]
    pub(super) fn add(
        &mut self,
        key: impl Into<Cow<'static, str>>,
        value: String,
        allowed: impl Into<String>,
        remedy: &'static str,
    ) {
        self.0.push(SceneError { key: key.into(), value, allowed: allowed.into(), remedy });
    }
}
