//! [`SceneError`]: a problem of a scene, with the key to fix.

use std::borrow::Cow;

/// One problem of a scene; the reader of campaign files adds file and line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key} = {value}: must be {allowed}; {remedy}")]
pub struct SceneError {
    /// The dotted path, e.g. `body.parts.b1.length_m` or `actuation[1].start_s`.
    pub key: Cow<'static, str>,
    /// The refused values.
    pub value: String,
    /// Allowed values, with bounds.
    pub allowed: String,
    /// A change that would help.
    pub remedy: &'static str,
}

/// The problems of one input; without any, nothing is allocated.
#[derive(Default)]
pub(super) struct Problems(pub(super) Vec<SceneError>);

impl Problems {
    /// Adds a problem. Out of line, so that a valid scene passes its checks without a jump.
    #[cold]
    #[inline(never)]
    pub(super) fn add(
        &mut self,
        key: impl Into<Cow<'static, str>>,
        value: impl Into<String>,
        allowed: impl Into<String>,
        remedy: &'static str,
    ) {
        let (key, value, allowed) = (key.into(), value.into(), allowed.into());
        self.0.push(SceneError { key, value, allowed, remedy });
    }
}
