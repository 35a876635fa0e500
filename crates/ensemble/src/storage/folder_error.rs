//! [`FolderError`]: why a place cannot take a result.

use super::store::StoreError;
use crate::campaign::Plan;
use crate::campaign::difference::{KeyDifference, text_differences};
use crate::storage::identity::Identity;
use thiserror::Error;

/// Most keys in a refusal.
const LISTED: usize = 12;

#[derive(Debug, Error)]
pub enum FolderError {
    #[error(
        "`{folder}` contains {what} of another plan:\n  {differences}\nchoose another --out, or replace it with \
        --overwrite"
    )]
    Occupied {
        folder: String,
        what: &'static str,
        /// The differing keys, a line each.
        differences: String,
    },
    #[error(
        "{folder}: is the result of another plan:\n  {differences}\nchoose another --out; what is in a store is not \
        replaced"
    )]
    Kept { folder: String, differences: String },
    #[error(
        "{folder}: objects are not what was put; remove those that have changed, and the campaign's command with this \
        --out puts them again\n  {damaged}"
    )]
    Changed { folder: String, damaged: String },
    #[error(
        "`{folder}` contains {found} rows of this plan, more than its {asked} samples; leave --samples out, choose \
        another --out, or replace it with --overwrite"
    )]
    Larger { folder: String, found: u64, asked: u64 },
    #[error(
        "`{folder}` contains a result of format 5, which an earlier version of spindrift made and this one does not \
        read; remove it, or choose another --out"
    )]
    Old { folder: String },
    #[error(
        "`{folder}` is finished, and the plan of this shard has other keys that change no row; run the campaign \
        without --shard: it answers from the rows that are there"
    )]
    Answered { folder: String },
    #[error(
        "`{folder}` has shards that ask other questions:\n  {differences}\nrun all shards with one plan, or the \
        campaign without --shard: it answers from the rows that are there"
    )]
    Asked { folder: String, differences: String },
    #[error(
        "`{folder}` contains `{entry}`, which is not part of a result of spindrift; move it away, or choose another \
        --out"
    )]
    Foreign { folder: String, entry: String },
    #[error("another process is using `{folder}`; wait for it, or choose another folder")]
    Busy { folder: String },
    #[error(
        "`{folder}` cannot be replaced, because it cannot be renamed: {why}; choose a folder below it or another one \
        as --out, and run the command in another folder, or remove what is in it and leave --overwrite out"
    )]
    Immovable { folder: String, why: std::io::Error },
    #[error("`{folder}` has no result of spindrift: {why}")]
    Nothing { folder: String, why: String },
    #[error(transparent)]
    Store(#[from] StoreError),
}

pub(super) fn shown(one: KeyDifference) -> String {
    let value = |value: Option<String>| value.unwrap_or_else(|| "absent".to_owned());
    format!("{}: {} there, {} here", one.key, value(one.first), value(one.second))
}

/// The keys except the number of samples that differ between the plan text `there` and `plan`.
pub(super) fn other_questions(there: &str, plan: &Plan) -> Option<String> {
    let mut keys = text_differences(there, &plan.text());
    keys.retain(|one| one.key != "campaign.samples");
    (!keys.is_empty()).then(|| keys.into_iter().map(shown).collect::<Vec<_>>().join("\n  "))
}

/// All keys, one a line, that differ between the plan text `there` with `rows` and `plan` with `identity`.
pub(super) fn all_differences((there, rows): (&str, &Identity), (plan, identity): (&Plan, &Identity)) -> String {
    let keys = if there.is_empty() { Vec::new() } else { text_differences(there, &plan.text()) };
    reasons(keys.into_iter().map(shown).collect(), rows, identity)
}

/// The `list` of differing keys, shortened, with other differences of the identities.
pub(super) fn reasons(mut list: Vec<String>, there: &Identity, identity: &Identity) -> String {
    if there.arithmetic != identity.arithmetic || there.format != identity.format {
        list.push(format!(
            "version of the row arithmetic: {}.{} there, {}.{} here",
            there.format, there.arithmetic, identity.format, identity.arithmetic
        ));
    }
    if there.seed != identity.seed && list.iter().all(|key| !key.starts_with("campaign.seed")) {
        list.push(format!("campaign.seed: {} there, {} here", there.seed, identity.seed));
    }
    if list.is_empty() {
        list.push(if there.columns == identity.columns {
            format!("hash of the rows: {} there, {} here", there.row_hash, identity.row_hash)
        } else {
            "the columns: those of [[require]] at_all_times differ, or they are of another version of the program"
                .to_owned()
        });
    }
    if list.len() > LISTED {
        let more = list.len() - LISTED;
        list.truncate(LISTED);
        list.push(format!("and {more} more"));
    }
    list.join("\n  ")
}
