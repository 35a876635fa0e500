//! [`LoopErrors`]: what the control loop of a plan does to the errors of its runs; [`super::pilots`] measures it.

use crate::observables::LoopError;
use crate::sampling::SampleId;

/// Of the nominal sample, and of all others; `None` without a law, and where it is not known.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoopErrors {
    pub nominal: Option<LoopError>,
    pub drawn: Option<LoopError>,
}

impl LoopErrors {
    /// Of runs that are not judged.
    pub const UNMEASURED: LoopErrors =
        LoopErrors { nominal: Some(LoopError::UNMEASURED), drawn: Some(LoopError::UNMEASURED) };

    /// For the run with the noise of `sample`.
    pub fn of(self, sample: SampleId) -> Option<LoopError> {
        if sample == SampleId(0) { self.nominal } else { self.drawn }
    }
}
