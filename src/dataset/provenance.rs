//! [`provenance`], [`row_provenance`]: what every file of a campaign says about its origin, as key-value metadata.

use std::collections::HashMap;

use crate::campaign::Plan;
use crate::dataset::manifest::ARITHMETIC;

/// Seed and row plan with its hash, for files of rows: all that changes them, and nothing else. The name of the campaign, the version of the
/// program and the instruction set are not part of it: no bit of a row depends on them.
pub fn row_provenance(plan: &Plan) -> HashMap<String, String> {
    let pairs = [
        ("spindrift.arithmetic", ARITHMETIC.to_string()),
        ("spindrift.seed", plan.seed.to_string()),
        ("spindrift.row_hash", plan.row_hash()),
        ("spindrift.row_plan", plan.row_text()),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value)).into()
}

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
