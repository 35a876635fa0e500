//! [`written`]: all results below a folder, with changes since the previous run of the same campaign.

use std::cmp::Reverse;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use serde_json::Value;

use crate::campaign::Plan;
use crate::campaign::difference::text_differences;
use crate::findings::changed_keys;
use crate::findings::end::SummaryEnd;
use crate::findings::results_index::{IndexEntry, Unreadable};
use crate::report::{index_page, summary};
use crate::scene::epoch::date_of;
use crate::storage::atomic;
use crate::storage::names::{HEAD, PLAN, REPORT, SUMMARY};
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::session::Session;

/// Greatest depth below the first folder.
const DEEPEST: usize = 6;
/// Most named changes of plans.
const MOST_KEYS: usize = 4;
/// Latest day since 1970 in a valid file: year 9999.
const LAST_DAY: u64 = 2_932_896;

#[derive(Clone, Debug, Default)]
pub struct ResultsIndex {
    /// Finished results by campaign, latest first.
    pub entries: Vec<IndexEntry>,
    /// Unreadable results, with reasons.
    pub unreadable: Vec<Unreadable>,
}

/// A result, with the data to compare it with the previous run.
struct Found {
    entry: IndexEntry,
    seconds: u64,
    plan: String,
}

const PAGE: &str = "index.html";

/// All results below `root`, and the written page of them.
///
/// # Errors
/// No results, a folder that is a result itself, or a failed file operation.
pub fn written(session: &Session<'_>, root: &Path) -> Result<(ResultsIndex, PathBuf)> {
    let index = indexed(session, root)?;
    let shown = root.display();
    if index.entries.is_empty() && index.unreadable.is_empty() {
        return Err(WorkflowError::Input(format!("there is no result of spindrift in `{shown}` or below it")));
    }
    let unreadable = index.unreadable.iter().map(|one| &one.folder);
    if index.entries.iter().map(|one| &one.folder).chain(unreadable).any(|folder| folder.as_os_str().is_empty()) {
        return Err(WorkflowError::Input(format!(
            "`{shown}` is itself a result, in which nothing else is written; name the folder above it"
        )));
    }
    let name = root.canonicalize().ok().and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
    let html = index_page::html(&name.unwrap_or_else(|| "results".to_owned()), &index.entries, &index.unreadable);
    let path = root.join(PAGE);
    atomic::write_bytes(&path, html.as_bytes()).map_err(|error| WorkflowError::at(&path, error))?;
    Ok((index, path))
}

/// All results in and below `root`, without verified checksums (`spindrift verify`).
///
/// # Errors
/// An unreadable folder.
fn indexed(session: &Session<'_>, root: &Path) -> Result<ResultsIndex> {
    std::fs::read_dir(root).map_err(|error| {
        let why = match error.kind() {
            ErrorKind::NotFound => "there is no such folder".to_owned(),
            ErrorKind::NotADirectory => "is a file; name the folder that has the results".to_owned(),
            _ => error.to_string(),
        };
        WorkflowError::Input(format!("`{}`: {why}", root.display()))
    })?;
    let mut folders = Vec::new();
    visit(root, 0, &mut folders);
    folders.sort();
    let (mut found, mut index) = (Vec::new(), ResultsIndex::default());
    for folder in folders {
        let name = folder.strip_prefix(root).unwrap_or(&folder).to_owned();
        match read(session, &folder, &name) {
            Ok(one) => found.push(one),
            Err(reason) => index.unreadable.push(Unreadable { folder: name, reason }),
        }
    }
    found.sort_by_cached_key(|Found { entry, seconds, .. }| {
        (entry.campaign.clone(), Reverse(*seconds), entry.folder.clone())
    });
    let changes: Vec<Option<String>> = (0..found.len())
        .map(|place| match found.get(place + 1) {
            Some(before) if before.entry.campaign == found[place].entry.campaign => {
                Some(changed(session, root, [before, &found[place]]))
            }
            _ => None,
        })
        .collect();
    index.entries = found.into_iter().zip(changes).map(|(one, changed)| IndexEntry { changed, ..one.entry }).collect();
    Ok(index)
}

/// Collects folders of results, which have a head or a summary, and do not nest.
fn visit(folder: &Path, depth: usize, found: &mut Vec<PathBuf>) {
    if [HEAD, SUMMARY].iter().any(|name| folder.join(name).is_file()) {
        found.push(folder.to_owned());
        return;
    }
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    // links may lead in a circle
    let folders = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
    if depth < DEEPEST {
        folders.for_each(|entry| visit(&entry.path(), depth + 1, found));
    }
}

/// The result in `folder`, or why it is unreadable.
fn read(session: &Session<'_>, folder: &Path, name: &Path) -> Result<Found, String> {
    let path = folder.join(SUMMARY);
    let store = (session.folders)(folder);
    let read = |name: &str| store.read(name).map_err(|error| error.to_string());
    let bytes = read(SUMMARY)?.map_err(|_| format!("not finished: no {SUMMARY}"))?;
    let value: Value = serde_json::from_slice(&bytes).map_err(|error| format!("{SUMMARY}: {error}"))?;
    let end = summary::read(&bytes).ok_or_else(|| format!("{SUMMARY} is none of spindrift"))?;
    let text = |key: &str| value[key].as_str().map(str::to_owned);
    let campaign = text("campaign").ok_or_else(|| format!("{SUMMARY} names no campaign"))?;
    let plan = read(PLAN)?.map_err(|error| error.to_string())?;
    let plan = String::from_utf8(plan).map_err(|_| format!("{PLAN} is not text"))?;
    let question = toml::from_str::<toml::Table>(&plan)
        .ok()
        .and_then(|table| Some(table.get("campaign")?.get("description")?.as_str()?.to_owned()));
    let modified = path.metadata().and_then(|found| found.modified()).ok();
    let seconds = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok()).map_or(0, |since| since.as_secs());
    let page = folder.join(REPORT).is_file().then(|| name.join(REPORT));
    let version = text("version").unwrap_or_default();
    let entry = IndexEntry {
        folder: name.to_owned(),
        campaign,
        question,
        end,
        version,
        day: day(seconds),
        page,
        changed: None,
    };
    Ok(Found { entry, seconds, plan })
}

/// Changes from the run `before` to `after`: keys of the plan except number formats, then verdicts.
fn changed(session: &Session<'_>, root: &Path, [before, after]: [&Found; 2]) -> String {
    let mut keys = text_differences(&before.plan, &after.plan);
    keys.retain(|one| !one.key.starts_with("display."));
    // a plan of another version, or with a missing law, is only text
    let plan = |one: &Found| {
        let folder = root.join(&one.entry.folder);
        Plan::from_text_in(&folder, PLAN, &one.plan, session.overrides()).ok().filter(|_| !keys.is_empty())
    };
    let plans = plan(before).zip(plan(after));
    let mut said = changed_keys::phrases(&keys, plans.as_ref().map(|(before, after)| [before, after]), MOST_KEYS);
    if before.entry.version != after.entry.version {
        said.push(format!("version {} -> {}", before.entry.version, after.entry.version));
    }
    let verdict = |end: &SummaryEnd, name: &str| {
        end.verdicts.iter().find(|one| one.requirement == name).map(|one| one.word.clone())
    };
    for one in &after.entry.end.verdicts {
        let now = &one.word;
        if let Some(then) = verdict(&before.entry.end, &one.requirement).filter(|then| then != now) {
            said.push(format!("{then} -> {now}: {}", one.statement));
        }
    }
    if said.is_empty() { "the same campaign, version and verdicts".to_owned() } else { said.join("; ") }
}

/// The day of a time since 1970 in UTC, `2026-11-25`.
fn day(seconds: u64) -> String {
    let to_2000 = 10_957;
    let (year, month, day) = date_of((seconds / 86_400).min(LAST_DAY) as i32 - to_2000);
    format!("{year}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: days are those of `date -u -d @SECONDS +%F`.
    #[test]
    fn days_are_those_of_the_calendar() {
        for (seconds, text) in [
            (0, "1970-01-01"),
            (951_782_399, "2000-02-28"),
            (951_782_400, "2000-02-29"),
            (951_868_800, "2000-03-01"),
            (1_795_651_200, "2026-11-26"),
            (4_107_542_399, "2100-02-28"),
            (4_107_542_400, "2100-03-01"),
            (u64::MAX, "9999-12-31"),
        ] {
            assert_eq!(day(seconds), text);
        }
    }
}
