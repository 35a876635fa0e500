//! The `[retain]` table. No row depends on it.

use super::section::{Section, choice};
use crate::sampling::keys::{ANY_TEXT, Kind, Row, Written};

/// Runs that keep their full time series.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Retention {
    #[default]
    None,
    /// All, including the nominal run.
    All,
    /// Runs that are not `ok`.
    Failed,
    /// The `count` dispersed runs with the largest magnitudes of an observable.
    Worst { count: u64, observable: String },
    /// This many dispersed runs at random.
    Sample(u64),
}

const KEY: &str = "trajectories";
const ALLOWED: &str = "\"none\", \"all\", \"failed\", \"worst:20 by energy_error_max\" or \"sample:100\"";
pub const ROWS: [Row; 1] = [Row::new(
    KEY,
    Kind::Text(ANY_TEXT),
    "Runs whose full time series are kept: `none` (default), `all`, `failed`, `worst:20 by energy_error_max`, \
    `sample:100`",
)];
const MOST: u64 = 1_000_000;

impl Retention {
    pub(super) fn read(section: &mut Section<'_, '_>) -> Option<Self> {
        let written = section.whole(&ROWS, &[])?;
        let retention = written.text(KEY).map_or(Some(Retention::None), |text| parsed(section, text))?;
        section.document.keep("[retain]", Written::NONE.with(KEY, retention.text().as_str()));
        Some(retention)
    }

    /// As in a campaign file.
    pub fn text(&self) -> String {
        match self {
            Retention::None => "none".to_owned(),
            Retention::All => "all".to_owned(),
            Retention::Failed => "failed".to_owned(),
            Retention::Worst { count, observable } => format!("worst:{count} by {observable}"),
            Retention::Sample(count) => format!("sample:{count}"),
        }
    }
}

fn parsed(section: &mut Section<'_, '_>, text: &str) -> Option<Retention> {
    let text = text.trim();
    let (word, rest) = text.split_once(':').map_or((text, None), |(word, rest)| (word.trim(), Some(rest.trim())));
    match (word, rest) {
        ("none", None) => Some(Retention::None),
        ("all", None) => Some(Retention::All),
        ("failed", None) => Some(Retention::Failed),
        ("sample", Some(count)) => runs(section, count).map(Retention::Sample),
        ("worst", Some(rest)) => {
            let (count, observable) = rest.split_once(" by ").map_or((rest, ""), |(count, name)| (count, name.trim()));
            let count = runs(section, count)?;
            if observable.is_empty() {
                let remedy = format!("name the observable: \"worst:{count} by energy_error_max\"");
                return section.refused(KEY, ALLOWED, remedy);
            }
            let known = section.document.known.as_ref()?;
            if known.observable(observable).is_none() {
                let (allowed, remedy) = known.refusal(observable);
                let value = format!("{text:?}");
                section.refuse_value(KEY, value, format!("{ALLOWED} with {allowed}"), remedy);
                return None;
            }
            Some(Retention::Worst { count, observable: observable.to_owned() })
        }
        _ => {
            let (_, remedy) = choice(word, &["none", "all", "failed", "worst", "sample"]);
            let remedy = match (word, rest) {
                ("sample", None) => "write how many: \"sample:100\"".to_owned(),
                ("worst", None) => "write how many, and by what: \"worst:20 by energy_error_max\"".to_owned(),
                _ => remedy,
            };
            section.refuse(KEY, ALLOWED, remedy);
            None
        }
    }
}

fn runs(section: &mut Section<'_, '_>, text: &str) -> Option<u64> {
    let count = text.trim().parse().ok().filter(|count| (1..=MOST).contains(count));
    if count.is_none() {
        section.refuse(KEY, ALLOWED, format!("write a whole number of runs from 1 to {MOST}"));
    }
    count
}
