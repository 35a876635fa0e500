//! [`Finding`], [`Number`], [`Verdict`]: of what findings consist.

use crate::campaign::ShownUnit;
use crate::findings::number;
use crate::sampling::SampleId;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::GateLimit;
use crate::statistics::quantile::percent;
use crate::table::Table;

/// Whether what is asked is so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Pass,
    Fail,
    /// The runs do not tell.
    Undecided,
}

impl Verdict {
    /// Those of a decision.
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

/// A number that was found, with how sure it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// What it is: "p95", "mean", "runs within the limit".
    pub name: String,
    /// Its unit in files; `%` of a share, which is a fraction in files.
    pub unit: String,
    /// Exact, in `unit`, shares from 0 to 1; NaN where there is none.
    pub value: f64,
    /// Ends of its interval; NaN where the runs do not bound it on that side.
    pub interval: [f64; 2],
    /// What is asked of it, in `unit`, where something is.
    pub limit: Option<GateLimit>,
    /// Of how many runs it is.
    pub of: u64,
    /// In which unit people see it.
    pub shown: ShownUnit,
    /// Digits without an interval, where neighbours need more to stay apart.
    pub digits: usize,
}

impl Number {
    /// A number in `unit`, shown in `shown`.
    pub fn new(name: &str, (value, interval): (f64, [f64; 2]), of: u64, unit: &str, shown: &ShownUnit) -> Self {
        let (name, unit, shown) = (name.to_owned(), unit.to_owned(), shown.clone());
        Number { name, unit, value, interval, limit: None, of, shown, digits: 3 }
    }

    /// A share of `of` runs.
    pub fn share(name: &str, value: f64, interval: [f64; 2], of: u64) -> Self {
        Number::new(name, (value, interval), of, SHARE, &ShownUnit::own(SHARE))
    }

    pub fn has_interval(&self) -> bool {
        self.interval.iter().any(|end| end.is_finite())
    }

    /// In the unit in which it is shown: value, ends of the interval, limit. A share is in per cent.
    pub fn in_shown(&self) -> (f64, [f64; 2], Option<f64>) {
        let shown = |value: f64| if self.unit == SHARE { 100.0 * value } else { self.shown.value(value) };
        (shown(self.value), self.interval.map(shown), self.limit.map(|limit| shown(limit.value())))
    }

    /// The number with its interval, without its unit: "0.938 [0.901, 0.994]"; "-" where there is none.
    pub fn bare(&self) -> String {
        let (value, interval, _) = self.in_shown();
        match (self.value.is_finite(), self.has_interval()) {
            (false, _) => "-".to_owned(),
            (true, false) => number::significant(value, self.digits),
            (true, true) => number::with_interval(value, interval),
        }
    }

    /// The number alone: "0.938"; "-" where there is none.
    pub fn alone(&self) -> String {
        Number { interval: [f64::NAN; 2], ..self.clone() }.bare()
    }

    /// The number with interval and unit: "98.40% [91.45, 99.96]", "0.938 [0.901, 0.994] deg".
    pub fn text(&self) -> String {
        match (self.value.is_finite(), self.unit == SHARE) {
            (true, true) => number::share([self.value; 2], self.interval),
            (true, false) => format!("{} {}", self.bare(), self.shown.unit).trim_end().to_owned(),
            (false, _) => "-".to_owned(),
        }
    }

    /// Its limit with the unit, as it was written: "2 deg".
    pub fn limit_text(&self) -> Option<String> {
        let limit = self.limit?.value();
        if self.unit == SHARE {
            return Some(format!("{}%", percent(limit)));
        }
        Some(format!("{} {}", number::written(self.shown.written(limit)), self.shown.unit).trim_end().to_owned())
    }
}

/// The unit of shares.
const SHARE: &str = "%";

/// What a renderer may draw for a finding: names of figures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Beside the finding, some lines high.
    pub small: Option<String>,
    pub large: Option<String>,
}

/// What a finding is about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// To know before any number: the title says what it is about in capitals.
    Warning,
    Requirement,
    /// What verdicts say together.
    Verdicts,
    /// Whether `[stop]` has reached its goal.
    Stop,
    /// A reason for which runs have no numbers.
    Loss,
    /// A way in which the missions of a control loop ended.
    Mission,
    #[default]
    Note,
    /// How an outcome is distributed.
    Outcome,
    /// What an outcome, or an event of it, depends on.
    Driver,
    /// How well runs were computed.
    Numerics,
    /// Runs to look at.
    Runs,
}

/// One thing that a campaign has found. Lists of them are in the order of what matters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finding {
    pub kind: Kind,
    /// The same for the same question in every result: `requirement_1`.
    pub id: String,
    /// Where it is shown: on a screen (0), with all that is known (1), or in files only (2).
    pub rank: u8,
    pub verdict: Option<Verdict>,
    /// What it is about, in a few words: "pointing error at launch <= 2 deg in 95%".
    pub title: String,
    /// What was found, as a sentence without its end.
    pub sentence: String,
    /// The first one is that of the title.
    pub numbers: Vec<Number>,
    /// What else has to be known, each a sentence without its end, in the order of their worth.
    pub notes: Vec<String>,
    /// Its rows, called by the title where there are more than are shown.
    pub table: Option<Table<'static>>,
    pub figures: Figures,
    /// The sample whose run shows it.
    pub sample: Option<SampleId>,
    pub children: Vec<Finding>,
}

impl Finding {
    /// The finding `id`, with its title and sentence.
    pub fn new(kind: Kind, id: impl Into<String>, title: impl Into<String>, sentence: impl Into<String>) -> Self {
        let (id, title, sentence) = (id.into(), title.into(), sentence.into());
        Finding { kind, id, title, sentence, ..Finding::default() }
    }

    /// The number called `name`.
    pub fn number(&self, name: &str) -> Option<&Number> {
        self.numbers.iter().find(|number| number.name == name)
    }

    /// The command that shows its run; `file` is the campaign as a word of a command.
    pub fn command(&self, file: &str) -> Option<String> {
        self.sample.map(|sample| format!("spindrift simulate {file} --sample {sample}"))
    }
}

/// What a campaign has found, in the order of what matters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    pub list: Vec<Finding>,
    /// The verdict on all requirements, where there are any.
    pub verdict: Option<Verdict>,
    /// What the list of requirements is called: with the confidence that all of them ask for.
    pub asked: String,
    /// Confidence of the intervals; `None` where no number has one.
    pub confidence: Option<f64>,
}

impl Findings {
    /// Those of a kind, in their order.
    pub fn of(&self, kind: Kind) -> impl Iterator<Item = &Finding> {
        self.list.iter().filter(move |one| one.kind == kind)
    }

    /// The confidence of the intervals for a head: " [95%]".
    pub fn in_brackets(&self) -> Option<String> {
        self.confidence.map(|confidence| format!(" [{}%]", percent(confidence)))
    }

    /// What the intervals in brackets are, once for all of them.
    pub fn brackets(&self) -> Option<String> {
        let confidence = self.confidence?;
        Some(format!("two-sided {}% intervals (Clopper-Pearson for shares)", percent(confidence)))
    }

    /// What comes before every number, each with what it is about.
    pub fn warnings(&self) -> Vec<String> {
        self.of(Kind::Warning).map(|one| format!("{}: {}", one.title, one.sentence)).collect()
    }
}
