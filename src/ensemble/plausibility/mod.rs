//! [`noted`], [`implausible`]: numbers that can be computed with, and look like a mistake: degrees for radians,
//! revolutions per minute for radians per second, millimetres for metres, the scalar of a quaternion in the last
//! place.
//!
//! [`rules::RULES`] is the list of what is noted, [`rule`] what a row of it says; `measures` are the sizes that are no
//! parameter of their own. Nothing is refused.

pub mod looked;
mod measures;
pub mod rule;
pub mod rules;

use std::collections::BTreeSet;

use crate::campaign::Plan;
use crate::control::capacity::Capacity;

use self::looked::Looked;
pub use self::measures::ends_of_air;
use self::rule::Rule;
use self::rules::RULES;

/// The rules that something in `plan` breaks, each with its note.
pub fn noted(plan: &Plan) -> Vec<(&'static Rule, String)> {
    of(&Looked::new(plan))
}

fn of(looked: &Looked<'_>) -> Vec<(&'static Rule, String)> {
    // a parameter is judged by the first rule that has it
    let mut judged = BTreeSet::new();
    let mut notes = Vec::new();
    for rule in RULES {
        notes.extend(rule.notes(looked, &mut judged).into_iter().map(|note| (rule, note)));
    }
    notes
}

/// The numbers of `plan` that look like a mistake, and what its control loop cannot do, a sentence each.
pub fn implausible(plan: &Plan) -> Vec<String> {
    let looked = Looked::new(plan);
    let mut notes: Vec<String> = of(&looked).into_iter().map(|(_, note)| note).collect();
    if let (Some(spec), Ok(scene)) = (looked.spec(), &looked.scene) {
        notes.extend(Capacity::of(spec, scene).notes(spec));
    }
    notes
}
