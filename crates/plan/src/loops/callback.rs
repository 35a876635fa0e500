//! An attitude law outside this program: a callback, such as the Python function given to `plan.run(control=...)`.
//!
//! A loop calls it at a tick and waits for the torque. Runs flown side by side on one thread
//! (`Crew` of `ensemble`) can share a call.

use std::sync::{Arc, PoisonError, RwLock};

use super::attitude_law::{AttitudeLaw, KnownBody, LawInput, LawKind, PhaseLaw};
use super::estimate::Estimate;
use super::spec::LoopSpec;
use crate::sampling::SampleId;

/// Its name in `[[guidance]]`.
pub const NAME: &str = "python";

/// The law that calls the installed callback.
pub static KIND: LawKind = LawKind {
    name: NAME,
    parameters: &[],
    make: &|settings| AttitudeLaw::new(CallbackLaw { sample: settings.sample, callback: current() }),
};

/// A call at a tick of a run.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// The run; 0 is nominal.
    pub sample: SampleId,
    /// Time since the last tick, s; zero at the first of a phase.
    pub period: f64,
    /// Input of the law.
    pub input: &'a LawInput<'a>,
    /// Estimated state.
    pub estimate: &'a Estimate,
}

/// A law outside this program.
pub trait Callback: Send + Sync {
    /// The wanted torque on the body, F_s, N m; a non-finite one ends the run as `diverged`.
    fn torque(&self, call: &Call<'_>) -> [f64; 3];
}

static CURRENT: RwLock<Option<Arc<dyn Callback>>> = RwLock::new(None);

fn current() -> Option<Arc<dyn Callback>> {
    CURRENT.read().unwrap_or_else(PoisonError::into_inner).clone()
}

/// Keeps a callback installed.
#[derive(Debug)]
pub struct Installation(());

impl Installation {
    /// Installs `callback` in this process; `None` if one is installed already.
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

/// True if a callback flies a phase of `spec`.
pub fn is_law_of(spec: &LoopSpec) -> bool {
    spec.phases.iter().any(|phase| phase.law == Some(&KIND))
}

/// Refuses to fly `spec` without the callback that it needs.
///
/// # Errors
/// The message.
pub fn refuse_missing(spec: Option<&LoopSpec>) -> Result<(), String> {
    if current().is_some() || !spec.is_some_and(is_law_of) {
        return Ok(());
    }
    Err(format!(
        "[[guidance]]: law = {NAME:?} is a function of Python, which is not here: give it to the Python package, \
        plan.run(control=...)"
    ))
}

#[derive(Clone)]
struct CallbackLaw {
    sample: SampleId,
    callback: Option<Arc<dyn Callback>>,
}

impl PhaseLaw for CallbackLaw {
    fn torque(&mut self, _body: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        match (&self.callback, input.estimate) {
            (Some(callback), Some(estimate)) => callback.torque(&Call { sample: self.sample, period, input, estimate }),
            _ => [f64::NAN; 3],
        }
    }
}
