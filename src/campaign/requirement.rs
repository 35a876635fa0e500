//! [`Requirement`]: a `[[require]]` table, what a campaign must show.

use super::columns::{KnownColumns, unit_of};
use super::limits::{CONFIDENCE, PROBABILITY};
use super::lines::Lines;
use super::numbers::FINITE;
use super::section::Section;
use crate::observables::window::Window;
use crate::statistics::gate::GateLimit;

/// What must be within the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statement {
    /// This quantile of the runs.
    Quantile(f64),
    /// Each of this fraction of the runs.
    Fraction(f64),
    /// The mean of the runs.
    Mean,
}

/// What a requirement is about.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// An observable: one number of a run.
    Observable(String),
    /// A quantity over time: its number at every point of its bands in an interval, each for itself.
    Band(BandSubject),
    /// A quantity over time in an interval as a whole: its extreme in a run.
    AtAllTimes {
        /// The quantity and the interval.
        band: BandSubject,
        /// What the rows have of it.
        window: Window,
        /// The name of the column.
        column: String,
    },
}

/// A quantity over time, in an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct BandSubject {
    /// Name of the quantity, as in `bands.parquet`.
    pub series: String,
    /// Start of the interval, s; `None`: of the run.
    pub from_s: Option<f64>,
    /// End of the interval, s; `None`: of the run.
    pub to_s: Option<f64>,
}

impl BandSubject {
    /// Whether the interval has the time `time`, s.
    pub fn contains(&self, time: f64) -> bool {
        self.from_s.is_none_or(|from| from <= time) && self.to_s.is_none_or(|to| time <= to)
    }
}

/// What a campaign must show.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// What it is about.
    pub subject: Subject,
    /// What of it must be within the limit.
    pub statement: Statement,
    /// The limit, in the unit of the observable or of the quantity over time.
    pub limit: GateLimit,
    /// Of a mean: between which values every value is known to be.
    pub bounded: Option<[f64; 2]>,
    /// Of a fraction: whether a run without a value, of something that never happens, meets it; otherwise it violates it.
    pub never_meets: bool,
    /// With which confidence.
    pub confidence: f64,
}

/// Confidence where the file does not say.
pub const DEFAULT_CONFIDENCE: f64 = 0.95;
/// The keys that say what is required: a requirement has exactly one.
const STATEMENTS: [&str; 3] = ["quantile", "fraction", "mean"];
/// The keys of limits: a requirement has exactly one.
const LIMITS: [&str; 2] = ["at_most", "at_least"];
/// The keys of what a requirement is about: it has exactly one.
const SUBJECTS: [&str; 2] = ["observable", "band"];
/// What a run without a value does, in the order of `false` and `true`.
const NEVER: [&str; 2] = ["violates", "meets"];
/// The keys of an interval of time.
const INTERVAL: [&str; 2] = ["from_s", "to_s"];

impl Requirement {
    /// Reads one table; `None` where something is wrong, which is then noted.
    pub(super) fn read(table: &mut Section<'_, '_>, known: &KnownColumns) -> Option<Self> {
        let subject = subject(table, known);
        let at_all_times = table.flag("at_all_times");
        let flag_passed = !table.has("at_all_times") || at_all_times.is_some();
        if at_all_times.is_some() && !table.has("band") {
            let allowed = "left out with `observable`, which is one number of a run";
            table.refuse("at_all_times", allowed, "delete it, or write `band`");
        }
        let confidence = table.number("confidence", CONFIDENCE);
        let statement = one_of(table, STATEMENTS, "quantile = 0.99").and_then(|key| match key {
            "quantile" => table.number(key, PROBABILITY).map(Statement::Quantile),
            "fraction" => table.number(key, PROBABILITY).map(Statement::Fraction),
            _ if table.has("band") => {
                let allowed = "left out with `band`: a requirement over time is about a share of the runs";
                table.refuse(key, allowed, "write quantile or fraction");
                None
            }
            _ => match table.flag(key) {
                Some(true) => Some(Statement::Mean),
                Some(false) => {
                    table.refuse(key, "true where it is written", "delete it, or write mean = true");
                    None
                }
                None => None,
            },
        });
        let quantity = subject.as_ref().and_then(|subject| match subject {
            Subject::Observable(name) => known.observable(name),
            Subject::Band(band) | Subject::AtAllTimes { band, .. } => known.band(&band.series),
        });
        let unit = quantity.map(unit_of);
        if let Some(unit) = unit {
            table.measures(unit);
        }
        let limit = one_of(table, LIMITS, "at_most = 1e-9").and_then(|key| {
            // without its unit a limit cannot be read
            unit?;
            let number = table.number(key, FINITE)?;
            if let (Some(written), Some(quantity)) = (table.unit_written(key), quantity)
                && written != quantity.unit()
            {
                let name = quantity.name().to_owned();
                table.document.units.extend(known.over_time(&name).map(|name| (name, written)));
                table.document.units.push((name, written));
            }
            Some(if key == "at_most" { GateLimit::AtMost(number) } else { GateLimit::AtLeast(number) })
        });
        let bounded = bounded(table, statement, unit.is_some());
        let never = table.name("never", &NEVER, |text| NEVER.iter().position(|known| *known == text));
        if table.has("never") && !(matches!(statement, Some(Statement::Fraction(_)) | None) && table.has("observable"))
        {
            let allowed = "left out where the requirement is not about a fraction of the runs and an observable";
            table.refuse("never", allowed, "write fraction, or delete this line");
        }
        STATEMENTS.iter().chain(&LIMITS).chain(&SUBJECTS).chain(&INTERVAL).for_each(|key| table.know(key));
        let confidence_passed = !table.has("confidence") || confidence.is_some();
        let bounded_passed = !table.has("bounded") || bounded.is_some();
        table.finish();
        let (subject, statement, limit) = (subject?, statement?, limit?);
        let confidence = confidence.unwrap_or(DEFAULT_CONFIDENCE);
        let subject = match subject {
            Subject::Band(band) if at_all_times == Some(true) => {
                let is_highest = matches!(limit, GateLimit::AtMost(_));
                let (window, column) = known.window(&band.series, is_highest, [band.from_s, band.to_s])?;
                Subject::AtAllTimes { band, window, column }
            }
            other => other,
        };
        let never_passed = !table.has("never") || never.is_some();
        (confidence_passed && flag_passed && bounded_passed && never_passed).then_some(Requirement {
            subject,
            statement,
            limit,
            bounded,
            never_meets: never == Some(1),
            confidence,
        })
    }

    /// The observable that it is about; `None` where it is about a quantity at each time.
    pub fn observable(&self) -> Option<&str> {
        match &self.subject {
            Subject::Observable(name) | Subject::AtAllTimes { column: name, .. } => Some(name),
            Subject::Band(_) => None,
        }
    }

    /// What the rows have for it alone.
    pub fn window(&self) -> Option<Window> {
        match &self.subject {
            Subject::AtAllTimes { window, .. } => Some(*window),
            _ => None,
        }
    }

    /// The quantity over time that it is about, with the interval.
    pub fn band(&self) -> Option<&BandSubject> {
        match &self.subject {
            Subject::Observable(_) => None,
            Subject::Band(band) | Subject::AtAllTimes { band, .. } => Some(band),
        }
    }

    /// The name of what it is about.
    pub fn name(&self) -> &str {
        match &self.subject {
            Subject::Observable(name) => name,
            Subject::Band(band) | Subject::AtAllTimes { band, .. } => &band.series,
        }
    }

    /// When the limit holds, in words: in each run at all times, or at each time, at which other runs may be beyond it; empty without times.
    pub fn times(&self) -> String {
        let Some(band) = self.band() else { return String::new() };
        let which = if self.window().is_some() { "at all times" } else { "at each time" };
        let end = |word: &str, end: Option<f64>| end.map_or(String::new(), |end| format!(" {word} {end:?} s"));
        format!(" {which}{}{}", end("from", band.from_s), end("to", band.to_s))
    }

    /// Writes the table.
    pub(super) fn write(&self, lines: &mut Lines) {
        lines.table("[[require]]");
        match self.band() {
            None => lines.key("observable", self.name()),
            Some(band) => {
                lines.key("band", &band.series);
                let ends = INTERVAL.into_iter().zip([band.from_s, band.to_s]);
                ends.filter_map(|(key, end)| Some((key, end?))).for_each(|(key, end)| lines.key(key, end));
                lines.key("at_all_times", self.window().is_some());
            }
        }
        match self.statement {
            Statement::Quantile(quantile) => lines.key("quantile", quantile),
            Statement::Fraction(fraction) => lines.key("fraction", fraction),
            Statement::Mean => lines.key("mean", true),
        }
        match self.limit {
            GateLimit::AtMost(limit) => lines.key("at_most", limit),
            GateLimit::AtLeast(limit) => lines.key("at_least", limit),
        }
        if let Some([low, high]) = self.bounded {
            lines.key("bounded", vec![low, high]);
        }
        if self.never_meets {
            lines.key("never", NEVER[1]);
        }
        lines.key("confidence", self.confidence);
    }
}

/// Between which values every value of a mean is known to be, if it was written; `has_unit`: the unit of the observable is known. What is wrong is noted.
fn bounded(table: &mut Section<'_, '_>, statement: Option<Statement>, has_unit: bool) -> Option<[f64; 2]> {
    if !has_unit {
        table.know("bounded");
        return None;
    }
    let list = table.numbers("bounded", table.unit_of("bounded"))?;
    if statement != Some(Statement::Mean) {
        let allowed = "left out without mean = true: shares and quantiles need no bounds";
        table.refuse("bounded", allowed, "delete it");
        return None;
    }
    match list[..] {
        [low, high] if low < high => Some([low, high]),
        _ => {
            let allowed = "two numbers, the smaller one first: no run has a value outside of them";
            table.refuse("bounded", allowed, "write it like [0.0, 1.0]");
            None
        }
    }
}

/// What the table is about; `None` where that is wrong, which is then noted.
fn subject(table: &mut Section<'_, '_>, known: &KnownColumns) -> Option<Subject> {
    if one_of(table, SUBJECTS, "observable = \"energy_error_max\"")? == "observable" {
        let found = observable(table, "observable", known);
        let written: Vec<&str> = INTERVAL.into_iter().filter(|key| table.has(key)).collect();
        for key in written {
            table.refuse(key, "left out with `observable`, which is one number of a run", "delete it, or write `band`");
        }
        return found.map(Subject::Observable);
    }
    let ends = INTERVAL.map(|key| table.number(key, FINITE));
    let name = table.text("band")?.to_owned();
    if known.band(&name).is_none() {
        let (allowed, remedy) = known.band_refusal(&name);
        table.refuse("band", allowed, remedy);
        return None;
    }
    let are_passed = INTERVAL.iter().zip(&ends).all(|(key, end)| !table.has(key) || end.is_some());
    let [from_s, to_s] = ends;
    are_passed.then_some(Subject::Band(BandSubject { series: name, from_s, to_s }))
}

/// The observable that `key` names; `None` where there is none, which is then noted.
pub(super) fn observable(table: &mut Section<'_, '_>, key: &str, known: &KnownColumns) -> Option<String> {
    let name = table.text(key)?;
    if known.observable(name).is_none() {
        let (allowed, remedy) = known.refusal(name);
        table.refuse(key, allowed, remedy);
        return None;
    }
    Some(name.to_owned())
}

/// The one of `keys` that was written; `None` where none was or several were, which is then noted.
fn one_of<const N: usize>(table: &mut Section<'_, '_>, keys: [&'static str; N], example: &str) -> Option<&'static str> {
    let written: Vec<&'static str> = keys.into_iter().filter(|key| table.has(key)).collect();
    match written[..] {
        [key] => Some(key),
        [] => {
            let (key, value) = example.split_once(" = ").unwrap_or((example, ""));
            table.require(key, &format!("given (one of {})", keys.join(", ")), value);
            None
        }
        [_, second, ..] => {
            table.refuse(second, format!("the only one of {}", keys.join(", ")), "write a [[require]] table for each");
            None
        }
    }
}
