//! What the results below a folder are.

use std::path::PathBuf;

use crate::findings::end::SummaryEnd;
use crate::findings::finding::{Finding, Kind};
use crate::table::Table;
use crate::table::text::Align;

/// A finished result.
#[derive(Clone, Debug)]
pub struct IndexEntry {
    /// Its folder, from the one that is indexed.
    pub folder: PathBuf,
    /// The name of its campaign.
    pub campaign: String,
    /// The question that it answers.
    pub question: Option<String>,
    pub end: SummaryEnd,
    /// The version of the program that made it.
    pub version: String,
    /// The day of its summary, UTC.
    pub day: String,
    /// Its page, from the folder that is indexed, where there is one.
    pub page: Option<PathBuf>,
    /// What changed since the last run of the same campaign, in words; `None` of the first one.
    pub changed: Option<String>,
}

/// A folder of a result that says nothing.
#[derive(Clone, Debug)]
pub struct Unreadable {
    /// The folder, from the one that is indexed.
    pub folder: PathBuf,
    pub reason: String,
}

/// The words of verdicts.
const WORDS: [&str; 3] = ["PASS", "FAIL", "UNDECIDED"];

impl IndexEntry {
    /// The verdicts, counted, each as `said` of its count and its word: `3 PASS, 1 FAIL`; of a campaign without
    /// requirements a dash.
    pub fn verdicts(&self, said: impl Fn(usize, &str) -> String) -> String {
        let counts = WORDS.iter().map(|word| (self.end.count(word), word)).filter(|(count, _)| *count > 0);
        let found: Vec<String> = counts.map(|(count, word)| said(count, word)).collect();
        if found.is_empty() { "-".to_owned() } else { found.join(", ") }
    }

    /// Whether its folder has the name of its campaign, and says it.
    pub fn is_named(&self) -> bool {
        self.folder.file_name().is_some_and(|name| name == self.campaign.as_str())
    }

    /// The runs that were computed, of all where some were not.
    pub fn runs(&self) -> String {
        let SummaryEnd { rows, failed, .. } = self.end;
        if failed > 0 { format!("{} of {rows}", rows - failed) } else { rows.to_string() }
    }
}

/// A row for each of `entries`, and what is not in that table.
pub fn findings(entries: &[IndexEntry], unreadable: &[Unreadable]) -> Vec<Finding> {
    let mut table = Table::with([
        ("result", Align::Title),
        ("verdicts", Align::Whole),
        ("runs", Align::Right),
        ("day", Align::Left),
        ("version", Align::Left),
        ("since the last run", Align::Sentence),
    ]);
    for one in entries {
        let campaign = if one.is_named() { String::new() } else { format!(" ({})", one.campaign) };
        let cells = [
            format!("{}{campaign}", one.folder.display()),
            one.verdicts(|count, word| format!("{count} {word}")),
            one.runs(),
            one.day.clone(),
            one.version.clone(),
        ];
        table.row(cells.into_iter().chain([one.changed.clone().unwrap_or_default()]));
    }
    let mut others = Table::with([("", Align::Left), ("", Align::Sentence)]);
    unreadable.iter().for_each(|one| others.row([one.folder.display().to_string(), one.reason.clone()]));
    let all = [("", table), ("\n  not in the table", others)].into_iter().filter(|(_, table)| table.rows() > 0);
    all.map(|(said, table)| Finding { table: Some(table), ..Finding::new(Kind::Note, "index", "", said) }).collect()
}
