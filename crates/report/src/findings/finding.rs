//! [`Finding`], [`Number`], [`Verdict`].

use crate::campaign::ShownUnit;
use crate::findings::number;
use crate::sampling::SampleId;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::GateLimit;
use crate::statistics::quantile::percent;
use crate::table::Table;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Pass,
    Fail,
    Undecided,
}

impl Verdict {
    pub fn of(decision: Decision) -> Self {
        match decision {
            Decision::Pass => Verdict::Pass,
            Decision::Fail => Verdict::Fail,
            Decision::Undecided(_) => Verdict::Undecided,
        }
    }

    pub const fn word(self) -> &'static str {
        match self {
            Verdict::Pass => "PASS",
            Verdict::Fail => "FAIL",
            Verdict::Undecided => "UNDECIDED",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// "p95", "mean", "runs within the limit".
    pub name: String,
    /// Unit in files; `%` for a share, which is a fraction in files.
    pub unit: String,
    /// Exact, in `unit`, shares from 0 to 1; NaN if unknown.
    pub value: f64,
    /// NaN at an end that the runs do not bound.
    pub interval: [f64; 2],
    pub limit: Option<GateLimit>,
    pub of: u64,
    pub shown: ShownUnit,
    /// Digits without an interval; more keep neighbours apart.
    pub digits: usize,
}

impl Number {
    pub fn new(name: &str, (value, interval): (f64, [f64; 2]), of: u64, unit: &str, shown: &ShownUnit) -> Self {
        let (name, unit, shown) = (name.to_owned(), unit.to_owned(), shown.clone());
        Number { name, unit, value, interval, limit: None, of, shown, digits: 3 }
    }

    pub fn share(name: &str, value: f64, interval: [f64; 2], of: u64) -> Self {
        Number::new(name, (value, interval), of, SHARE, &ShownUnit::own(SHARE))
    }

    pub fn has_interval(&self) -> bool {
        self.interval.iter().any(|end| end.is_finite())
    }

    /// Value, interval and limit in the shown unit; shares in per cent.
    pub fn in_shown(&self) -> (f64, [f64; 2], Option<f64>) {
        let shown = |value: f64| if self.unit == SHARE { 100.0 * value } else { self.shown.value(value) };
        (shown(self.value), self.interval.map(shown), self.limit.map(|limit| shown(limit.value())))
    }

    /// With interval, without unit: "0.938 [0.901, 0.994]"; "-" if unknown.
    pub fn bare(&self) -> String {
        let (value, interval, _) = self.in_shown();
        match (self.value.is_finite(), self.has_interval()) {
            (false, _) => "-".to_owned(),
            (true, false) => number::significant(value, self.digits),
            (true, true) => number::with_interval(value, interval),
        }
    }

    /// Without interval and unit: "0.938".
    pub fn alone(&self) -> String {
        Number { interval: [f64::NAN; 2], ..self.clone() }.bare()
    }

    /// With interval and unit: "98.40% [91.45, 99.96]", "0.938 [0.901, 0.994] deg".
    pub fn text(&self) -> String {
        match (self.value.is_finite(), self.unit == SHARE) {
            (true, true) => number::share([self.value; 2], self.interval),
            (true, false) => number::with_unit(self.bare(), &self.shown.unit),
            (false, _) => "-".to_owned(),
        }
    }

    /// The limit as written, with its unit: "2 deg".
    pub fn limit_text(&self) -> Option<String> {
        let limit = self.limit?.value();
        if self.unit == SHARE {
            return Some(format!("{}%", percent(limit)));
        }
        Some(number::with_unit(number::written(self.shown.written(limit)), &self.shown.unit))
    }
}

const SHARE: &str = "%";

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// A few lines high.
    pub small: Option<String>,
    pub large: Option<String>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Precedes all numbers; its title is in capitals.
    Warning,
    Requirement,
    Verdicts,
    Stop,
    /// Why runs have no numbers.
    Loss,
    Mission,
    #[default]
    Note,
    Outcome,
    Driver,
    Numerics,
    Runs,
}

/// One result of a campaign. Lists are in order of importance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finding {
    pub kind: Kind,
    /// Stable across results: `requirement_1`.
    pub id: String,
    /// Shown on a screen (0), in the verbose view (1), or only in files (2).
    pub rank: u8,
    pub verdict: Option<Verdict>,
    /// The subject in a few words: "pointing error at launch <= 2 deg in 95%".
    pub title: String,
    /// A sentence without a full stop.
    pub sentence: String,
    /// The first belongs to the title.
    pub numbers: Vec<Number>,
    /// Qualifications, each a sentence without a full stop, most important first.
    pub notes: Vec<String>,
    /// The title names its rows if some are hidden.
    pub table: Option<Table<'static>>,
    pub figures: Figures,
    pub sample: Option<SampleId>,
    pub children: Vec<Finding>,
}

impl Finding {
    pub fn new(kind: Kind, id: impl Into<String>, title: impl Into<String>, sentence: impl Into<String>) -> Self {
        let (id, title, sentence) = (id.into(), title.into(), sentence.into());
        Finding { kind, id, title, sentence, ..Finding::default() }
    }

    pub fn number(&self, name: &str) -> Option<&Number> {
        self.numbers.iter().find(|number| number.name == name)
    }

    /// The command that replays its sample; `file` is quoted for a shell.
    pub fn command(&self, file: &str) -> Option<String> {
        self.sample.map(|sample| format!("spindrift simulate {file} --sample {sample}"))
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    pub list: Vec<Finding>,
    /// The overall verdict; `None` without requirements.
    pub verdict: Option<Verdict>,
    /// Heading of the requirements, with their common confidence.
    pub asked: String,
    /// Confidence of the intervals; `None` if there are none.
    pub confidence: Option<f64>,
}

impl Findings {
    pub fn of(&self, kind: Kind) -> impl Iterator<Item = &Finding> {
        self.list.iter().filter(move |one| one.kind == kind)
    }

    /// The confidence as a suffix of a heading: " [95%]".
    pub fn in_brackets(&self) -> Option<String> {
        self.confidence.map(|confidence| format!(" [{}%]", percent(confidence)))
    }

    pub fn brackets(&self) -> Option<String> {
        let confidence = self.confidence?;
        Some(format!("two-sided {}% intervals (Clopper-Pearson for shares)", percent(confidence)))
    }

    pub fn warnings(&self) -> Vec<String> {
        self.of(Kind::Warning).map(|one| format!("{}: {}", one.title, one.sentence)).collect()
    }
}
