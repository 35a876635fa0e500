//! [`provenance`], [`row_provenance`]: what every file of a campaign says about its origin, as key-value metadata.

use std::collections::HashMap;

use crate::campaign::Plan;
use crate::storage::identity;
use crate::storage::manifest::Identity;

/// Identity of the rows and the row plan, for files of rows: all that changes them, and nothing else. The name of the campaign, the version of
/// the program and the instruction set are not part of it: no bit of a row depends on them.
pub fn row_provenance(plan: &Plan, identity: &Identity) -> HashMap<String, String> {
    let plan = ("spindrift.row_plan", plan.row_text());
    let pairs = identity::metadata(identity).into_iter().chain([plan]);
    pairs.map(|(key, value)| (key.to_owned(), value)).collect()
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
