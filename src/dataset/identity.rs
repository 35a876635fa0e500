//! [`identity`]: what the rows of a campaign are.

use sha2::{Digest, Sha256};

use crate::dataset::manifest::{ARITHMETIC, FORMAT, Identity};
use crate::dataset::rows_file::headings;
use crate::ensemble::Ensemble;

/// SHA-256 of `bytes`, in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The identity of the rows of `ensemble`. Rows with the same identity are the same, sample by sample.
pub fn identity(ensemble: &Ensemble<'_>) -> Identity {
    let columns: Vec<String> = headings(ensemble)
        .iter()
        .map(|heading| format!("{} {:?} {}\n", heading.quantity.name(), heading.content, heading.nullable))
        .collect();
    let plan = ensemble.plan();
    Identity {
        spindrift: "dataset".to_owned(),
        format: FORMAT,
        arithmetic: ARITHMETIC,
        row_hash: plan.row_hash(),
        seed: plan.seed,
        columns: sha256(columns.concat().as_bytes()),
    }
}
