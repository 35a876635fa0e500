//! The results below a folder.

use std::path::PathBuf;

use crate::findings::end::SummaryEnd;
use crate::findings::finding::{Finding, Kind};
use crate::table::Table;
use crate::table::text::Align;

#[derive(Clone, Debug)]
pub struct IndexEntry {
    /// Its folder, relative to the index.
    pub folder: PathBuf,
    pub campaign: String,
    pub question: Option<String>,
    pub end: SummaryEnd,
    pub version: String,
    /// Date of its summary, UTC.
    pub day: String,
    /// Its page, relative to the index.
    pub page: Option<PathBuf>,
    /// Changes since the last run of the campaign; `None` for the first.
    pub changed: Option<String>,
}

#[derive(Clone, Debug)]
pub struct Unreadable {
    /// Relative to the index.
    pub folder: PathBuf,
    pub reason: String,
}

impl IndexEntry {
    pub fn verdicts(&self, text: impl Fn(usize, &str) -> String) -> String {
        let counts = self.end.verdicts(text);
        if counts.is_empty() { "-".to_owned() } else { counts.join(", ") }
    }

    pub fn is_named(&self) -> bool {
        self.folder.file_name().is_some_and(|name| name == self.campaign.as_str())
    }

    /// The number of computed runs: "100", "98 of 100".
    pub fn runs(&self) -> String {
        let SummaryEnd { rows, failed, .. } = self.end;
        if failed > 0 { format!("{} of {rows}", rows - failed) } else { rows.to_string() }
    }
}

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
