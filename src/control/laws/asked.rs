//! A law of attitude that is not in this program: whoever flies the campaign answers for it, tick by tick. The function
//! of Python that `plan.run(control=...)` is given is one.
//!
//! A loop asks its law at a tick and waits for the torque. Where runs are flown side by side on one thread
//! ([`crate::ensemble::crew::Crew`]), the one who answers lets a run wait until the others have asked too, and answers
//! all of them at once.

use std::sync::{Arc, PoisonError, RwLock};

use super::interface::{KnownBody, LawInput, PhaseLaw};
use super::{AttitudeLaw, LawKind};
use crate::control::estimate::Estimate;
use crate::control::spec::LoopSpec;
use crate::sampling::SampleId;

/// Its name in `[[guidance]]`.
pub const NAME: &str = "python";

/// Its place beside the list of laws.
pub static KIND: LawKind = LawKind {
    name: NAME,
    parameters: &[],
    make: |settings| AttitudeLaw::own(AskedLaw { sample: settings.sample, answers: now() }),
};

/// What the law of a run is asked at a tick.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The run; 0 is the nominal one.
    pub sample: SampleId,
    /// Since the last tick, s: zero at the first of a phase.
    pub period: f64,
    /// What laws are told.
    pub input: &'a LawInput<'a>,
    /// What flight software believes of the state.
    pub estimate: &'a Estimate,
}

/// Answers for the law.
pub trait Answers: Send + Sync {
    /// The wanted torque on the body, F_s, N m. One that is not finite ends the run, which fails as `diverged`.
    fn torque(&self, question: &Question<'_>) -> [f64; 3];
}

/// Who answers now.
static NOW: RwLock<Option<Arc<dyn Answers>>> = RwLock::new(None);

fn now() -> Option<Arc<dyn Answers>> {
    NOW.read().unwrap_or_else(PoisonError::into_inner).clone()
}

/// While it is there, laws of this process are answered.
#[derive(Debug)]
pub struct Answered(());

impl Answered {
    /// By `answers`; `None` where another one does.
    pub fn by(answers: Arc<dyn Answers>) -> Option<Self> {
        let mut now = NOW.write().unwrap_or_else(PoisonError::into_inner);
        if now.is_some() {
            return None;
        }
        *now = Some(answers);
        Some(Answered(()))
    }
}

impl Drop for Answered {
    fn drop(&mut self) {
        *NOW.write().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// Whether a phase of the loop `spec` is flown by it.
pub fn is_law_of(spec: &LoopSpec) -> bool {
    spec.phases.iter().any(|phase| phase.law == Some(&KIND))
}

/// Why runs of the loop `spec` cannot be flown now, if so: nobody answers for it.
///
/// # Errors
/// With the message.
pub fn refuse_unanswered(spec: Option<&LoopSpec>) -> Result<(), String> {
    if now().is_some() || !spec.is_some_and(is_law_of) {
        return Ok(());
    }
    Err(format!(
        "[[guidance]]: law = {NAME:?} is a function of Python, which is not here: give it to the Python package, \
        plan.run(control=...)"
    ))
}

/// The law in a run.
#[derive(Clone)]
struct AskedLaw {
    sample: SampleId,
    answers: Option<Arc<dyn Answers>>,
}

impl std::fmt::Debug for AskedLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AskedLaw").field("sample", &self.sample).finish_non_exhaustive()
    }
}

impl PhaseLaw for AskedLaw {
    fn torque(&mut self, _body: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        match (&self.answers, input.estimate) {
            (Some(answers), Some(estimate)) => {
                answers.torque(&Question { sample: self.sample, period, input, estimate })
            }
            _ => [f64::NAN; 3],
        }
    }
}
