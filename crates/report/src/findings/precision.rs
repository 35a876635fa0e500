//! Measurements of run time against error.

use crate::campaign::Plan;
use crate::ensemble::precision::{Deviation, Measurement, Setting, Skipped};
use crate::findings::finding::{Finding, Kind};
use crate::findings::number::{brief, counted, significant};
use crate::table::Table;
use crate::table::text::Align;

/// Columns with widths, since rows appear one by one.
pub const COLUMNS: [(&str, Align, usize); 10] = [
    ("method", Align::Whole, 17),
    ("setting", Align::Right, 9),
    ("us/run", Align::Right, 10),
    ("runs/s", Align::Right, 11),
    ("steps", Align::Right, 8),
    ("rate", Align::Right, 9),
    ("attitude", Align::Right, 9),
    ("energy", Align::Right, 9),
    ("momentum", Align::Right, 9),
    ("notes", Align::Sentence, 0),
];

fn about(sentence: String) -> Finding {
    Finding::new(Kind::Note, "precision", "", sentence)
}

/// The setup: `samples` of `plan`, `which` states, an instruction set.
pub fn head(plan: &Plan, samples: usize, [which, isa]: [&str; 2]) -> Finding {
    about(format!(
        "{}: {} over {:?} s at {}, {which} states, on {isa}; largest errors against a reference in double-double",
        plan.name,
        counted(samples, "sample"),
        plan.grid.duration(),
        counted(plan.grid.points(), "point"),
    ))
}

/// A row with the measurement `found`; without one only the heads.
pub fn table(found: Option<&Measurement>) -> Table<'static> {
    let error = |of: Option<Deviation>| of.map_or("-".to_owned(), |error| significant(error.max, 2));
    let mut table = Table::with(COLUMNS.map(|(name, align, _)| (name, align)));
    if let Some(m) = found {
        let failed = (m.runs[1] > 0).then(|| format!("{} of {} failed", m.runs[1], counted(m.runs[0], "run")));
        let few = (m.repeats < 3).then(|| counted(m.repeats, "repetition"));
        table.row([
            m.method.name().to_owned(),
            setting(m.setting),
            brief(1e6 * m.cpu[0]),
            brief(1.0 / m.cpu[0]),
            format!("{:.0}", m.steps),
            error(m.rate),
            error(m.attitude),
            error(m.energy),
            error(m.momentum),
            failed.into_iter().chain(few).collect::<Vec<_>>().join(", "),
        ]);
    }
    table
}

/// Skipped settings with the reason; one finding per method.
pub fn omissions(skipped: &[Skipped], limit: f64) -> Vec<Finding> {
    let of_method = |all: &[Skipped]| {
        let settings: Vec<String> = all.iter().map(|skipped| setting(skipped.setting)).collect();
        let predicted = all.iter().map(|skipped| skipped.predicted).fold(f64::INFINITY, f64::min);
        about(format!(
            "skipped: {} at {}: a pass over the samples would take {} s or more, the limit is {} s (--limit-s)",
            all[0].method.name(),
            settings.join(", "),
            brief(predicted),
            brief(limit),
        ))
    };
    skipped.chunk_by(|one, next| one.method == next.method).map(of_method).collect()
}

fn setting(setting: Setting) -> String {
    match setting {
        Setting::Tolerance(tolerance) => format!("{tolerance:.0e}"),
        Setting::Step(step) => format!("{step:.1e}s"),
    }
}
