//! The law of the Python package: the function given to `plan.run(control=...)`, which serves many runs at once.

use super::attitude_law::LawKind;
use super::spec::LoopSpec;

/// Its name in `[[guidance]]`.
pub const NAME: &str = "python";

/// The law in a program that does not have the function.
pub static MISSING: LawKind = LawKind::missing(NAME);

/// True if a phase of `spec` names it.
pub fn is_law_of(spec: &LoopSpec) -> bool {
    spec.laws().any(|law| *law == MISSING)
}
