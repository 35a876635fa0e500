//! [`noted`], [`implausible`]: numbers that are valid but look like a mistake: degrees for radians, rpm for rad/s,
//! millimetres for metres, a quaternion with its scalar last. Nothing is refused.
//!
//! [`rules::RULES`] lists the rules, each a [`rule`]; `measures` computes sizes that are no parameters.

pub mod looked;
mod measures;
pub mod rule;
pub mod rules;

use std::collections::BTreeSet;

use crate::campaign::Plan;

use self::looked::Looked;
pub use self::measures::ends_of_air;
use self::rule::Rule;
use self::rules::RULES;

pub fn noted(plan: &Plan) -> Vec<(&'static Rule, String)> {
    of(&Looked::new(plan))
}

fn of(looked: &Looked<'_>) -> Vec<(&'static Rule, String)> {
    // a parameter is judged by the first rule for it
    let mut judged = BTreeSet::new();
    let mut notes = Vec::new();
    for rule in RULES {
        notes.extend(rule.notes(looked, &mut judged).into_iter().map(|note| (rule, note)));
    }
    notes
}

/// The numbers of `plan` that look like a mistake, and the limits of its control loop, a sentence each.
pub fn implausible(plan: &Plan) -> Vec<String> {
    let looked = Looked::new(plan);
    let mut notes: Vec<String> = of(&looked).into_iter().map(|(_, note)| note).collect();
    if let (Some(spec), Ok(scene)) = (looked.spec(), &looked.scene) {
        let capacity = plan.law.as_ref().and_then(|law| law.maker().capacity(scene));
        notes.extend(capacity.into_iter().flat_map(|capacity| capacity.notes(spec)));
    }
    notes
}
