//! Measurements of run time against error as lines of text.

use std::fmt::Write as _;

use crate::ensemble::precision::{Deviation, Measurement, Setting, Skipped};
use crate::findings::number::counted;
use crate::findings::number::{brief, significant};
use crate::table::Table;
use crate::table::text::{Align, Text};

/// The columns of [`line()`], with the widths of their numbers.
const COLUMNS: [(&str, Align, usize); 10] = [
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

/// A table whose rows are shown one by one.
fn table() -> Table<'static> {
    Table::with(COLUMNS.map(|(name, align, _)| (name, align)))
}

fn as_text<'t>(table: &'t Table<'_>) -> Text<'t> {
    Text::of(table).at_least(&COLUMNS.map(|(.., width)| width)).spaced(0, 1)
}

/// The names of the columns of [`line()`], for lines of `width` characters.
pub fn headline(width: usize) -> String {
    as_text(&table()).head(width)
}

/// A measurement as a line of `width` characters, or several where it is longer, with its maximum errors.
pub fn line(m: &Measurement, width: usize) -> String {
    let error = |of: Option<Deviation>| of.map_or("-".to_owned(), |error| significant(error.max, 2));
    let failed = (m.runs[1] > 0).then(|| format!("{} of {} failed", m.runs[1], counted(m.runs[0], "run")));
    let few = (m.repeats < 3).then(|| counted(m.repeats, "repetition"));
    let mut table = table();
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
    as_text(&table).body(width)
}

/// The settings that were not measured, with the reason; empty where all were.
pub fn omissions(skipped: &[Skipped], limit: f64) -> String {
    let mut text = String::new();
    let mut methods: Vec<_> = skipped.iter().map(|skipped| skipped.method).collect();
    methods.dedup();
    for method in methods {
        let of = || skipped.iter().filter(|skipped| skipped.method == method);
        let settings: Vec<String> = of().map(|skipped| setting(skipped.setting)).collect();
        let predicted = of().map(|skipped| skipped.predicted).fold(f64::INFINITY, f64::min);
        let _ = writeln!(
            text,
            "skipped: {} at {}: a pass over the samples would take {} s or more, the limit is {} s (--limit-s)",
            method.name(),
            settings.join(", "),
            brief(predicted),
            brief(limit),
        );
    }
    text
}

/// A tolerance or a step in one or two digits.
fn setting(setting: Setting) -> String {
    match setting {
        Setting::Tolerance(tolerance) => format!("{tolerance:.0e}"),
        Setting::Step(step) => format!("{step:.1e}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagation::Method;

    /// Law: a setting that is not measured is named with the reason.
    #[test]
    fn omissions_are_named() {
        let skip = |setting| Skipped { method: Method::NullSpace, setting, predicted: 44.0 };
        let skipped = vec![skip(Setting::Tolerance(1e-11)), skip(Setting::Tolerance(1e-12))];
        let text = omissions(&skipped, 20.0);
        assert!(text.contains("null_space at 1e-11, 1e-12") && text.contains("take 44 s"), "{text}");
        assert_eq!(omissions(&[], 20.0), "");
    }

    /// Law: at every width each number of a measurement stands whole in the order of the wide line, below its head.
    #[test]
    fn measurements_fit_every_width() {
        let error = |max: f64| Some(Deviation { max, rms: 0.5 * max });
        let [rate, attitude, energy, momentum] = [-1.5e-300, 0.043, 1.2e-10, 6.8e-8].map(error);
        let (method, setting) = (Method::NullSpace, Setting::Step(0.5));
        let (cpu, runs) = ([1.234_567e10, 1.0], [200, 17]);
        let found =
            Measurement { method, setting, cpu, repeats: 1, runs, steps: 1e7, rate, attitude, energy, momentum };
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        for width in 40..=200 {
            let (head, text) = (headline(width), line(&found, width));
            assert_eq!(words(&text), words(&line(&found, 1000)), "{width}:\n{text}");
            assert!(head.lines().chain(text.lines()).all(|line| line.len() <= width), "{width}:\n{head}{text}");
            for (heads, numbers) in head.lines().zip(text.lines()).filter(|(heads, _)| !heads.contains("notes")) {
                assert_eq!(heads.split_whitespace().count(), numbers.split_whitespace().count(), "{width}:\n{text}");
                assert!(heads.len() == numbers.len() || heads.starts_with("method"), "{width}:\n{head}{text}");
            }
        }
    }
}
