//! [`Summary`]: the statistics of a campaign, as `summary.json`; as text on the screen: `summary_text`.

use std::path::Path;

use serde_json::{Map, Value, json};

use crate::analysis::assessment::Assessment;
use crate::analysis::ending::Ending;
use crate::analysis::missions::{MissionShare, Missions};
use crate::analysis::outcomes::named;
use crate::analysis::statistics::Statistics;
use crate::analysis::statuses::{Ended, Statuses};
use crate::analysis::stopping::{LookFound, Stopping};
use crate::analysis::tally::{Tally, Worst};
use crate::analysis::verdicts::Verdicts;
use crate::campaign::{Plan, Statement};
use crate::ensemble::FailureReason;
use crate::findings::number::counted;
use crate::report::audit_summary::{AuditSummary, Numerics};
use crate::report::observable_lines::{ObservableLine, lines};
use crate::report::{requirements, stopping_text};
use crate::run::Status;
use crate::sampling::Replaced;
use crate::statistics::contingency::Occurrence;
use crate::storage::folder::IS_FINISHED;

/// How many failed samples of each status are listed by number.
pub(super) const LISTED: usize = 3;

/// The statistics of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    pub(super) name: String,
    pub(super) seed: u64,
    pub(super) samples: u64,
    pub(super) plan_hash: String,
    pub(super) without_nominal: bool,
    pub(super) statuses: Statuses,
    pub(super) worst: Vec<Worst>,
    pub(super) lines: Vec<ObservableLine>,
    /// The observables that the file requires, names or derives.
    pub(super) named: Vec<String>,
    /// Number of columns with statistics.
    pub(super) columns: usize,
    pub(super) verdicts: Verdicts,
    pub(super) missions: Missions,
    pub(super) intervals: String,
    pub(super) treatment: String,
    pub(super) confidence: f64,
    pub(super) quantile_error: f64,
    pub(super) audit: Option<AuditSummary>,
    pub(super) replaced: Vec<Replaced>,
    /// What comes before every number.
    pub(super) warnings: Vec<String>,
    /// What the numbers leave unsaid.
    pub(super) notes: Vec<String>,
    /// The last look of a campaign with `[stop]`, and in words.
    pub(super) stopping: Option<(Stopping, String)>,
}

impl Summary {
    /// The `statistics` and `verdicts` of the campaign `plan`, with the audits and the worst runs in `tally`.
    pub fn new(plan: &Plan, tally: &Tally, statistics: &Statistics, verdicts: Verdicts) -> Self {
        let numerics = |name: &str| {
            let index = tally.headlines.iter().position(|headline| headline == name)?;
            Numerics::new(tally.audits.as_ref()?, index, statistics.column(name)?.spread?)
        };
        let audit = tally.audits.as_ref().map(|audits| AuditSummary::new(audits, plan.audit_fraction));
        Summary {
            warnings: Vec::new(),
            notes: Vec::new(),
            name: plan.name.clone(),
            seed: plan.seed,
            samples: plan.samples,
            plan_hash: plan.hash(),
            statuses: tally.statuses.clone(),
            without_nominal: tally.without_nominal,
            worst: tally.worst.clone(),
            lines: lines(plan, statistics, numerics),
            named: named(plan),
            columns: statistics.columns.len(),
            verdicts,
            intervals: statistics.population.intervals(),
            treatment: statistics.treatment(),
            confidence: statistics.confidence,
            quantile_error: statistics.quantile_error,
            audit,
            replaced: plan.dispersions.replaced_correlations().to_vec(),
            stopping: None,
            missions: Missions::new(),
        }
    }

    /// The same, with what comes before every number, and what these leave unsaid.
    #[must_use]
    pub fn with_warnings(self, warnings: Vec<String>, notes: Vec<String>) -> Self {
        Summary { warnings, notes, ..self }
    }

    /// The same, with how the missions of a control loop ended.
    #[must_use]
    pub fn with_missions(self, missions: Missions) -> Self {
        Summary { missions, ..self }
    }

    /// The same, with the look that ended the campaign of `plan`.
    #[must_use]
    pub fn with_stopping(self, plan: &Plan, stopping: Option<Stopping>) -> Self {
        let stopping = stopping.map(|found| (found.clone(), stopping_text::text(plan, &found)));
        Summary { stopping, ..self }
    }

    /// The text of `summary.json`. Nothing in it depends on the machine or the clock.
    pub fn json(&self) -> String {
        let statuses: Map<String, Value> =
            self.statuses.list().iter().map(|ended| (ended.status.name().to_owned(), json!(ended.count))).collect();
        let numbers = |ended: &Ended| ended.first.iter().take(LISTED).map(|(sample, _)| sample.0).collect::<Vec<_>>();
        let first_failed: Map<String, Value> =
            self.statuses.failed().map(|ended| (ended.status.name().to_owned(), json!(numbers(ended)))).collect();
        let reason = |one: &FailureReason| {
            json!({ "status": one.status.name(), "count": one.count,
            "sample": one.first.0, "reason": one.text })
        };
        let reasons: Vec<Value> = self.statuses.reasons().groups().into_iter().map(reason).collect();
        let runs = |worst: &Worst| -> Vec<Value> {
            worst.list.runs.iter().map(|(sample, error)| json!({ "sample": sample.0, "error": error })).collect()
        };
        let worst: Map<String, Value> =
            self.worst.iter().map(|worst| (worst.name.replace(' ', "_"), json!(runs(worst)))).collect();
        let mut value = json!({
            "program": "spindrift",
            (IS_FINISHED): true,
            "version": env!("CARGO_PKG_VERSION"),
            "campaign": self.name,
            "plan_hash": self.plan_hash,
            "seed": self.seed,
            "samples": self.samples,
            "warnings": self.warnings,
            "notes": self.notes,
            "statuses": statuses,
            "first_failed": first_failed,
            "failure_reasons": reasons,
            "worst_runs": worst,
            "statistics": {
                "samples": if self.without_nominal { "dispersed, without the nominal sample 0" } else { "nominal" },
                "failed_runs": self.treatment,
                "quantiles": "type 7 of Hyndman and Fan, over the runs that are ok",
                "relative_error_of_quantiles": self.quantile_error,
                "intervals": self.intervals,
                "confidence": self.confidence,
            },
            "requirements": requirements::json(&self.verdicts),
            "observables": self.lines,
        });
        if !self.replaced.is_empty() {
            let list = self.replaced.iter();
            let list = list.map(|one| json!({ "parameters": one.names, "asked": one.asked, "used": one.used }));
            value["nearest_correlations_of_scores"] = Value::Array(list.collect());
        }
        if !self.missions.is_empty() {
            let one = |share: &MissionShare| {
                json!({ "end": share.end,
                "phases": share.phases.iter().map(|(name, count)| json!({ "phase": name.as_str(),
                    "count": count })).collect::<Vec<_>>(), "count": share.count, "runs": share.runs,
                        "not_computed": share.missing, "shares": share.shares(), "interval": share.interval })
            };
            value["missions"] = Value::Array(self.missions.iter().map(one).collect());
        }
        if let Some(audit) = &self.audit {
            value["audit"] = json!(audit);
        }
        if let Some((stopping, _)) = &self.stopping {
            let (look, undecided) = match &stopping.found {
                LookFound::Precision(look) => (Some(look), None),
                LookFound::Undecided(count) => (None, Some(count)),
            };
            value["stop"] = json!({
                "look": stopping.look,
                "looks": stopping.looks,
                "samples": stopping.samples,
                "reached": stopping.is_reached(),
                "undecided": undecided,
                "precise_enough": look.map(|look| look.stops),
                "estimate": look.map(|look| look.estimate),
                "interval": look.map(|look| look.interval),
                "confidence": look.map(|look| look.confidence),
            });
        }
        format!("{value:#}\n")
    }
}

/// A requirement with its verdict.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EndVerdict {
    /// The requirement as a sentence.
    pub requirement: String,
    /// `PASS`, `FAIL` or `UNDECIDED`.
    pub word: String,
    /// The requirement in a few words: "pointing error at launch <= 2 deg in 95%".
    pub statement: String,
    /// What was found, with its interval: "97.7% [95.3, 99.1]".
    pub found: String,
    /// The observable that it is about, where it is about one.
    pub observable: Option<String>,
    /// How many runs violate it, unless it is about a mean.
    pub violations: Option<Occurrence>,
}

/// How a campaign ended, as its rows and its summary both say.
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryEnd {
    pub rows: u64,
    /// Number of runs that are not `ok`.
    pub failed: u64,
    /// Audited runs whose errors are larger than their estimates, where these are more than promised; else 0.
    pub not_covered: u64,
    /// What comes before every number, as the summary says it.
    pub warnings: Vec<String>,
    /// The requirements, each with its verdict.
    pub verdicts: Vec<EndVerdict>,
    /// Whether a campaign with `[stop]` has reached what it says; `true` of others.
    pub is_reached: bool,
}

impl SummaryEnd {
    /// What the summary of a campaign says that ended like this, without its warnings.
    pub fn of(ending: &Ending) -> Self {
        let verdict = |one: &Assessment| EndVerdict {
            requirement: one.sentence(),
            word: one.word().to_owned(),
            statement: requirements::statement(one),
            found: requirements::estimate(one),
            observable: one.requirement.observable().map(str::to_owned),
            violations: (one.requirement.statement != Statement::Mean)
                .then_some(Occurrence { events: one.violations, runs: one.runs }),
        };
        SummaryEnd {
            rows: ending.rows,
            failed: ending.failed,
            not_covered: ending.not_covered,
            warnings: Vec::new(),
            verdicts: ending.verdicts.list.iter().map(verdict).collect(),
            is_reached: ending.stopping.as_ref().is_none_or(Stopping::is_reached),
        }
    }

    /// What the bytes of a summary say; `None` where they are no finished summary.
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let value: Value = serde_json::from_slice(bytes).ok()?;
        let statuses: Vec<(&String, u64)> = value
            .get("statuses")?
            .as_object()?
            .iter()
            .filter_map(|(name, count)| Some((name, count.as_u64()?)))
            .collect();
        let text = |one: &Value, key: &str| Some(one.get(key)?.as_str()?.to_owned());
        let excess = |estimate: &str| value.pointer(&format!("/audit/{estimate}/excess")).and_then(Value::as_u64);
        let list = value.pointer("/requirements/list").and_then(Value::as_array).into_iter().flatten();
        Some(SummaryEnd {
            rows: statuses.iter().map(|(_, count)| count).sum(),
            failed: statuses.iter().filter(|(name, _)| *name != Status::Done.name()).map(|(_, count)| count).sum(),
            warnings: value
                .get("warnings")
                .and_then(Value::as_array)
                .map_or_else(Vec::new, |list| list.iter().filter_map(Value::as_str).map(str::to_owned).collect()),
            not_covered: ["estimate", "debris_estimate"].into_iter().filter_map(excess).sum(),
            verdicts: list
                .filter_map(|one| {
                    let requirement = text(one, "requirement")?;
                    // summaries of earlier versions have the sentence alone
                    let statement = text(one, "in_short").unwrap_or_else(|| requirement.clone());
                    let found = text(one, "found").unwrap_or_default();
                    let count = |key: &str| one.get(key)?.as_u64();
                    let occurrence = |(events, runs)| Occurrence { events, runs };
                    let violations = count("violations").zip(count("runs")).map(occurrence);
                    let is_mean = text(one, "statement").as_deref() == Some("mean");
                    Some(EndVerdict {
                        requirement,
                        word: text(one, "verdict")?,
                        statement,
                        found,
                        observable: text(one, "observable"),
                        violations: violations.filter(|_| !is_mean),
                    })
                })
                .collect(),
            is_reached: value.pointer("/stop/reached").and_then(Value::as_bool) != Some(false),
        })
    }

    /// The same without the words from which nothing follows: warnings, and the requirements in short.
    pub fn without_words(&self) -> Self {
        let bare = |one: &EndVerdict| EndVerdict {
            requirement: one.requirement.clone(),
            word: one.word.clone(),
            ..EndVerdict::default()
        };
        SummaryEnd { warnings: Vec::new(), verdicts: self.verdicts.iter().map(bare).collect(), ..self.clone() }
    }

    /// The verdicts of the campaign in one line, or how many runs were computed where nothing is required, and where
    /// the rest stands: `3 PASS, 1 FAIL -> results/x/report.html`.
    pub fn verdict_line(&self, place: &Path) -> String {
        let count = |word: &&str| (self.count(word), word.to_string());
        let found = ["PASS", "FAIL", "UNDECIDED"].iter().map(count).filter(|(count, _)| *count > 0);
        let mut said: Vec<String> = found.map(|(count, word)| format!("{count} {word}")).collect();
        let (rows, ok) = (self.rows, self.rows - self.failed);
        if said.is_empty() || self.failed > 0 {
            let of = if self.failed > 0 { format!("{ok} of ") } else { String::new() };
            said.push(format!("{of}{} computed", counted(rows, "run")));
        }
        if self.not_covered > 0 {
            said.push("audit FAILED".to_owned());
        }
        if !self.is_reached {
            said.push("[stop] not reached".to_owned());
        }
        format!("{} -> {}", said.join(", "), place.display())
    }

    /// The number of requirements with the verdict `word`.
    pub fn count(&self, word: &str) -> usize {
        self.verdicts.iter().filter(|one| one.word == word).count()
    }
}

impl Summary {
    /// The samples of the campaign in words: how many are dispersed, and the nominal one.
    pub fn samples(&self) -> String {
        if self.without_nominal {
            format!("{} dispersed + nominal", self.samples - 1)
        } else {
            "nominal sample".to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failed_runs_are_read_from_a_summary() {
        let end =
            SummaryEnd::read(br#"{"statuses": {"ok": 5, "step_limit": 2, "invalid_sample": 1}}"#).expect("a summary");
        assert_eq!((end.rows, end.failed, end.not_covered, end.is_reached), (8, 3, 0, true));
        let audited =
            br#"{"statuses": {"ok": 9}, "audit": {"estimate": {"excess": 2}, "debris_estimate": {"excess": 3}}}"#;
        assert_eq!(SummaryEnd::read(audited).map(|end| end.not_covered), Some(5));
        assert_eq!(SummaryEnd::read(b"{}"), None);
    }

    /// Law: the last line counts each verdict, and else the runs; it says what makes a success none, and the place.
    #[test]
    fn the_last_line_is_the_verdict() {
        let end = |words: &[&str], failed: u64| SummaryEnd {
            rows: 20,
            failed,
            not_covered: 0,
            warnings: Vec::new(),
            verdicts: words
                .iter()
                .map(|word| EndVerdict { word: (*word).to_owned(), ..EndVerdict::default() })
                .collect(),
            is_reached: true,
        };
        let line = |end: SummaryEnd| end.verdict_line(Path::new("r/report.html"));
        let mixed = ["PASS", "FAIL", "PASS", "UNDECIDED", "PASS"];
        assert_eq!(line(end(&mixed, 0)), "3 PASS, 1 FAIL, 1 UNDECIDED -> r/report.html");
        assert_eq!(line(end(&mixed[..1], 3)), "1 PASS, 17 of 20 runs computed -> r/report.html");
        assert_eq!(line(end(&[], 0)), "20 runs computed -> r/report.html");
        let broken = SummaryEnd { not_covered: 2, is_reached: false, ..end(&[], 0) };
        assert_eq!(line(broken), "20 runs computed, audit FAILED, [stop] not reached -> r/report.html");
    }
}
