//! A law of attitude outside of this program: a callback of whoever flies the campaign, as the function of Python that
//! `plan.run(control=...)` takes.
//!
//! A loop calls its law at a tick and waits for the torque. Runs flown side by side on one thread
//! ([`crate::ensemble::supervision::Crew`]) can wait for one another, so that one call serves all of them.

use std::sync::{Arc, PoisonError, RwLock};

use super::interface::{AttitudeLaw, KnownBody, LawInput, LawKind, PhaseLaw};
use crate::control::estimate::Estimate;
use crate::control::spec::LoopSpec;
use crate::sampling::SampleId;

/// Its name in `[[guidance]]`.
pub const NAME: &str = "python";

/// The law of the list for which a process installs a callback.
pub static KIND: LawKind = LawKind {
    name: NAME,
    parameters: &[],
    make: &|settings| AttitudeLaw::new(CallbackLaw { sample: settings.sample, callback: current() }),
};

/// A call at a tick of a run.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// The run; 0 is the nominal one.
    pub sample: SampleId,
    /// Since the last tick, s: zero at the first of a phase.
    pub period: f64,
    /// The input of laws.
    pub input: &'a LawInput<'a>,
    /// The state that flight software believes.
    pub estimate: &'a Estimate,
}

/// The law itself.
pub trait Callback: Send + Sync {
    /// The wanted torque on the body, F_s, N m. One that is not finite ends the run, which fails as `diverged`.
    fn torque(&self, call: &Call<'_>) -> [f64; 3];
}

/// The callback of this process.
static CURRENT: RwLock<Option<Arc<dyn Callback>>> = RwLock::new(None);

fn current() -> Option<Arc<dyn Callback>> {
    CURRENT.read().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Keeps a callback installed.
#[derive(Debug)]
pub struct Installation(());

impl Installation {
    /// Installs `callback` in this process; `None` if there is another one.
    pub fn new(callback: Arc<dyn Callback>) -> Option<Self> {
        let mut current = CURRENT.write().unwrap_or_else(PoisonError::into_inner);
        if current.is_some() {
            return None;
        }
        *current = Some(callback);
        Some(Installation(()))
    }
}

impl Drop for Installation {
    fn drop(&mut self) {
        *CURRENT.write().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// True if a phase of the loop `spec` is flown by a callback.
pub fn is_law_of(spec: &LoopSpec) -> bool {
    spec.phases.iter().any(|phase| phase.law == Some(&KIND))
}

/// Refuses to fly the loop `spec` without the callback that it needs.
///
/// # Errors
/// With the message.
pub fn refuse_missing(spec: Option<&LoopSpec>) -> Result<(), String> {
    if current().is_some() || !spec.is_some_and(is_law_of) {
        return Ok(());
    }
    Err(format!(
        "[[guidance]]: law = {NAME:?} is a function of Python, which is not here: give it to the Python package, \
        plan.run(control=...)"
    ))
}

/// The law in a run.
#[derive(Clone)]
struct CallbackLaw {
    sample: SampleId,
    callback: Option<Arc<dyn Callback>>,
}

impl std::fmt::Debug for CallbackLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CallbackLaw").field("sample", &self.sample).finish_non_exhaustive()
    }
}

impl PhaseLaw for CallbackLaw {
    fn torque(&mut self, _body: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        match (&self.callback, input.estimate) {
            (Some(callback), Some(estimate)) => callback.torque(&Call { sample: self.sample, period, input, estimate }),
            _ => [f64::NAN; 3],
        }
    }
}
