//! [`provenance`]: what every file of a campaign says about its origin, as key-value metadata.

use std::collections::HashMap;

use crate::campaign::Plan;

/// Version of the program, campaign, seed, and the plan with its hash. The instruction set is not part of it: no bit of a
/// row depends on it.
pub fn provenance(plan: &Plan) -> HashMap<String, String> {
    let pairs = [
        ("spindrift.version", env!("CARGO_PKG_VERSION").to_owned()),
        ("spindrift.campaign", plan.name.clone()),
        ("spindrift.seed", plan.seed.to_string()),
        ("spindrift.plan_hash", plan.hash()),
        ("spindrift.plan", plan.text()),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value)).into()
}
