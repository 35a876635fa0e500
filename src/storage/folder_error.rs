//! [`FolderError`]: why a folder cannot take a result.

use thiserror::Error;

use crate::campaign::Plan;
use crate::campaign::difference::{KeyDifference, text_differences};
use crate::storage::disk::StorageError;
use crate::storage::found::Found;
use crate::storage::manifest::Identity;

/// Most keys that a refusal lists.
const LISTED: usize = 12;

/// Why a folder cannot take a result.
#[derive(Debug, Error)]
pub enum FolderError {
    /// It has the rows of another plan.
    #[error(
        "`{folder}` contains {what} of another plan:\n  {differences}\nchoose another --out, or replace it with \
        --overwrite"
    )]
    Occupied {
        folder: String,
        /// A result, or an unfinished one.
        what: &'static str,
        /// The keys that differ, a line each.
        differences: String,
    },
    /// It has more rows than the plan.
    #[error(
        "`{folder}` contains {found} rows of this plan, more than its {asked} samples; leave --samples out, choose \
        another --out, or replace it with --overwrite"
    )]
    Larger { folder: String, found: u64, asked: u64 },
    /// Its shards are of different plans.
    #[error(
        "`{folder}` has rows of different plans: {conflict}\nremove the manifest of the wrong one, so that its parts \
        are made again, or run the campaign with --overwrite"
    )]
    Mixed {
        folder: String,
        /// Which shard differs, in which keys.
        conflict: String,
    },
    /// It has a plan and rows, and no manifest.
    #[error(
        "`{folder}` has lost its manifest.jsonl; this makes its rows again from its plan.toml: spindrift verify \
        {folder} --repair"
    )]
    Lost { folder: String },
    /// Everything is there, and a shard has other keys that change no row.
    #[error(
        "`{folder}` is finished, and the plan of this shard has other keys that change no row; run the campaign \
        without --shard: it answers from the rows that are there"
    )]
    Answered { folder: String },
    #[error(
        "`{folder}` contains `{entry}`, which is not part of a result of spindrift; move it away, or choose another \
        --out"
    )]
    Foreign { folder: String, entry: String },
    /// Another process writes to it.
    #[error("another process is using `{folder}`{owner}; wait for it, or choose another folder")]
    Busy {
        folder: String,
        /// Who it is, where that is known.
        owner: String,
    },
    /// It has a result that is to be replaced, and cannot be renamed.
    #[error(
        "`{folder}` cannot be replaced, because it cannot be renamed: {why}; choose a folder below it or another one \
        as --out, and run the command in another folder, or remove what is in it and leave --overwrite out"
    )]
    Immovable {
        folder: String,
        /// What keeps it from being renamed.
        why: std::io::Error,
    },
    /// There is no result in it.
    #[error("`{folder}` has no result of spindrift: {why}")]
    Nothing { folder: String, why: String },
    #[error(transparent)]
    Storage(#[from] StorageError),
}

/// The keys that change rows in which the plan of the text `there` differs from `plan`, with both values.
fn differing_rows(there: &str, plan: &Plan) -> Vec<String> {
    // keys that do not change rows are no reason
    let is_reason = |one: &KeyDifference| !Plan::OUTSIDE_ROWS.iter().any(|key| one.key.starts_with(key));
    text_differences(there, &plan.text()).into_iter().filter(is_reason).map(said).collect()
}

fn said(one: KeyDifference) -> String {
    let value = |value: Option<String>| value.unwrap_or_else(|| "absent".to_owned());
    format!("{}: {} there, {} here", one.key, value(one.first), value(one.second))
}

/// The same as one text; `None` where there are none, or there is no plan.
pub(super) fn row_differences(there: &str, plan: &Plan) -> Option<String> {
    let list = differing_rows(there, plan);
    (!there.is_empty() && !list.is_empty()).then(|| list.join("\n  "))
}

/// That `found` in `folder` has the rows `there`, and not those of `plan`, which have the identity `identity`.
pub(super) fn occupied(
    folder: String,
    found: &Found,
    there: &Identity,
    (plan, identity): (&Plan, &Identity),
) -> FolderError {
    let differences = reasons(differing_rows(&found.plan, plan), there, identity);
    let what = if found.is_finished { "the result" } else { "an unfinished result" };
    FolderError::Occupied { folder, what, differences }
}

/// All keys in which the plan of the text `there`, whose rows are `rows`, differs from `plan`, whose rows are
/// `identity`, one a line.
pub(super) fn all_differences((there, rows): (&str, &Identity), (plan, identity): (&Plan, &Identity)) -> String {
    reasons(text_differences(there, &plan.text()).into_iter().map(said).collect(), rows, identity)
}

/// The text of a `list` of keys that differ, where the rows are `there` and not `identity`: what else differs is added,
/// and what is too long is cut.
fn reasons(mut list: Vec<String>, there: &Identity, identity: &Identity) -> String {
    if there.arithmetic != identity.arithmetic || there.format != identity.format {
        list.push(format!(
            "version of the row arithmetic: {}.{} there, {}.{} here",
            there.format, there.arithmetic, identity.format, identity.arithmetic
        ));
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
