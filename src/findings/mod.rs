//! Layer 9: what a campaign has found, in words and numbers, once. Screen, page, JSON, JUnit and notebook choose from
//! it by rank and width, and compose nothing.
//!
//! - [`requirement`]: a finding for each requirement, the nearest to its limit first. - [`number`]: numbers in text,
//!   the one formatter. - [`names`]: names of columns
//!   and parameters in words. - [`shell_word`]: words of commands.

pub mod names;
pub mod number;
pub mod requirement;
pub mod shell_word;

use crate::campaign::ShownUnit;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::GateLimit;
use crate::statistics::quantile::percent;

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
}

impl Number {
    /// A share of `of` runs.
    pub fn share(name: &str, value: f64, interval: [f64; 2], of: u64) -> Self {
        let (unit, shown) = ("%".to_owned(), ShownUnit::own("%"));
        Number { name: name.to_owned(), unit, value, interval, limit: None, of, shown }
    }

    /// In the unit in which it is shown: value, ends of the interval, limit. A share is in per cent.
    pub fn in_shown(&self) -> (f64, [f64; 2], Option<f64>) {
        let shown = |value: f64| if self.unit == "%" { 100.0 * value } else { self.shown.value(value) };
        (shown(self.value), self.interval.map(shown), self.limit.map(|limit| shown(limit.value())))
    }

    /// The number with interval and unit: "98.40% [91.45, 99.96]", "0.938 [0.901, 0.994] deg"; "-" where there is none.
    pub fn text(&self) -> String {
        if !self.value.is_finite() {
            return "-".to_owned();
        }
        if self.unit == "%" {
            return number::share([self.value; 2], self.interval);
        }
        let (value, interval, _) = self.in_shown();
        format!("{} {}", number::with_interval(value, interval), self.shown.unit).trim_end().to_owned()
    }

    /// Its limit with the unit, as it was written: "2 deg".
    pub fn limit_text(&self) -> Option<String> {
        let limit = self.limit?.value();
        if self.unit == "%" {
            return Some(format!("{}%", percent(limit)));
        }
        Some(format!("{} {}", number::written(self.shown.written(limit)), self.shown.unit).trim_end().to_owned())
    }
}

/// What a renderer may draw for a finding: names of figures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Beside the finding, some lines high.
    pub small: Option<String>,
    pub large: Option<String>,
}

/// One thing that a campaign has found. A list of them is in the order of what matters: that is their rank.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finding {
    /// The same for the same question in every result: `requirement_1`.
    pub id: String,
    pub verdict: Option<Verdict>,
    /// What it is about, in a few words: "pointing error at launch <= 2 deg in 95%".
    pub title: String,
    /// What was found, as a sentence without its end.
    pub sentence: String,
    /// The first one is that of the title.
    pub numbers: Vec<Number>,
    /// What else has to be known, each a sentence without its end, in the order of their worth.
    pub notes: Vec<String>,
    pub figures: Figures,
    /// The command that shows more.
    pub more: Option<String>,
    pub children: Vec<Finding>,
}
