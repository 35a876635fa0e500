//! [`SceneError`]: a problem of a scene, with the key to fix.

use std::borrow::Cow;

/// One problem of a scene: key, value, allowed values, remedy. File and line are added by the reader of campaign files.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key} = {value}: must be {allowed}; {remedy}")]
pub struct SceneError {
    /// The dotted path as in a campaign file, e.g. `body.parts.b1.length_m` or `actuation[1].start_s`.
    pub key: Cow<'static, str>,
    /// The refused value or values.
    pub value: String,
    /// Allowed values, with bounds.
    pub allowed: String,
    /// A change that would help.
    pub remedy: &'static str,
}

/// The problems of one input; without one, nothing is allocated.
#[derive(Default)]
pub(super) struct Problems(pub(super) Vec<SceneError>);

impl Problems {
    /// Adds a problem. Out of line, so that a valid scene passes its checks without a jump.
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
