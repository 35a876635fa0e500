//! [`Summary`]: the statistics of a campaign, as `summary.json` and as text on the screen.

use std::fmt::{self, Display, Formatter};

use serde_json::{Map, Value, json};

use crate::analysis::statistics::Statistics;
use crate::analysis::stopping::{LookFound, Stopping};
use crate::analysis::tally::{Ended, Tally, Worst};
use crate::analysis::verdicts::Verdicts;
use crate::campaign::Plan;
use crate::ensemble::FailureReason;
use crate::report::audit_summary::{AuditSummary, Numerics};
use crate::report::number::short;
use crate::report::observable_lines::{ObservableLine, lines, write_table};
use crate::report::{failure_text, requirements, stopping_text};
use crate::run::Status;
use crate::sampling::{Replaced, SampleId};
use crate::storage::folder::IS_FINISHED;

/// The statistics of a campaign.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    name: String,
    seed: u64,
    samples: u64,
    plan_hash: String,
    without_nominal: bool,
    statuses: Vec<(&'static str, Ended)>,
    /// Why runs failed, the most frequent first.
    reasons: Vec<FailureReason>,
    worst: Vec<Worst>,
    lines: Vec<ObservableLine>,
    verdicts: Verdicts,
    /// How statistics were made.
    intervals: String,
    treatment: String,
    confidence: f64,
    quantile_error: f64,
    audit: Option<AuditSummary>,
    replaced: Vec<Replaced>,
    /// The last look of a campaign with `[stop]`, and in words.
    stopping: Option<(Stopping, String)>,
}

impl Summary {
    /// The `statistics` and `verdicts` of the campaign `plan`, with the audits and the worst runs in `tally`.
    pub fn new(plan: &Plan, tally: &Tally, statistics: &Statistics, verdicts: Verdicts) -> Self {
        let numerics = |name: &str| {
            let index = tally.headlines().iter().position(|headline| headline.quantity.name() == name)?;
            Numerics::new(tally.audits()?, index, &tally.headlines()[index].spread)
        };
        Summary {
            name: plan.name.clone(),
            seed: plan.seed,
            samples: plan.samples,
            plan_hash: plan.hash(),
            statuses: Status::ALL.into_iter().map(|status| (status.name(), tally.ended(status).clone())).collect(),
            reasons: tally.reasons().groups().into_iter().cloned().collect(),
            without_nominal: tally.without_nominal(),
            worst: tally.worst().to_vec(),
            lines: lines(plan, statistics, numerics),
            verdicts,
            intervals: statistics.population.intervals(),
            treatment: statistics.treatment(),
            confidence: statistics.confidence,
            quantile_error: statistics.quantile_error,
            audit: tally.audits().map(|audits| AuditSummary::new(audits, plan.audit_fraction)),
            replaced: plan.dispersions.replaced_correlations().to_vec(),
            stopping: None,
        }
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
            self.statuses.iter().map(|(name, ended)| ((*name).to_owned(), json!(ended.count))).collect();
        let numbers = |ended: &Ended| ended.first.iter().map(|sample| sample.0).collect::<Vec<_>>();
        let failed = self.statuses.iter().filter(|(name, ended)| ended.count > 0 && *name != Status::Done.name());
        let first_failed: Map<String, Value> =
            failed.map(|(name, ended)| ((*name).to_owned(), json!(numbers(ended)))).collect();
        let reason = |one: &FailureReason| json!({ "status": one.status.name(), "count": one.count, "sample": one.first.0, "reason": one.text });
        let reasons: Vec<Value> = self.reasons.iter().map(reason).collect();
        let runs = |worst: &Worst| -> Vec<Value> {
            worst.runs.iter().map(|(sample, error)| json!({ "sample": sample.0, "error": error })).collect()
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

/// What a finished summary says of how its campaign ended.
#[derive(Clone, Debug, PartialEq)]
pub struct SummaryEnd {
    /// Number of rows.
    pub rows: u64,
    /// Number of runs that are not `ok`.
    pub failed: u64,
    /// The requirements, each with its verdict.
    pub verdicts: Vec<(String, String)>,
    /// Whether a campaign with `[stop]` has reached what it says; `true` of others.
    pub is_reached: bool,
}

impl SummaryEnd {
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
        let list = value.pointer("/requirements/list").and_then(Value::as_array).into_iter().flatten();
        Some(SummaryEnd {
            rows: statuses.iter().map(|(_, count)| count).sum(),
            failed: statuses.iter().filter(|(name, _)| *name != Status::Done.name()).map(|(_, count)| count).sum(),
            verdicts: list.filter_map(|one| Some((text(one, "requirement")?, text(one, "verdict")?))).collect(),
            is_reached: value.pointer("/stop/reached").and_then(Value::as_bool) != Some(false),
        })
    }

    /// The number of requirements with the verdict `word`.
    pub fn count(&self, word: &str) -> usize {
        self.verdicts.iter().filter(|(_, verdict)| verdict == word).count()
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

    /// The runs with the greatest errors and the first that failed, with the command that shows one; `file` is the campaign as
    /// a word of that command. Empty where there are none.
    pub fn replay(&self, file: &str) -> String {
        let mut text = String::new();
        for worst in self.worst.iter().filter(|worst| !worst.runs.is_empty()) {
            text += &format!("  worst {}\n", worst.name);
            for (sample, error) in &worst.runs {
                text += &format!("    {:<9} spindrift simulate {file} --sample {sample}\n", short(*error));
            }
        }
        let failed = self.statuses.iter().filter(|(name, _)| *name != Status::Done.name());
        for (name, ended) in failed {
            if let Some(sample) = ended.first.first() {
                text += &format!("  the first {name}\n    {:<9} spindrift simulate {file} --sample {sample}\n", "");
            }
        }
        text
    }
}

/// Numbers of samples, separated by commas.
fn numbers(samples: &[SampleId]) -> String {
    samples.iter().map(SampleId::to_string).collect::<Vec<_>>().join(", ")
}

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let ok = Status::Done.name();
        let statuses = self.statuses.iter().filter(|(name, ended)| ended.count > 0 || *name == ok);
        for (name, ended) in statuses {
            write!(f, "  {name:<16}{:>12}", ended.count)?;
            if *name != ok {
                let more = if ended.count > ended.first.len() as u64 { ", ..." } else { "" };
                write!(f, "   samples {}{more}", numbers(&ended.first))?;
            }
            writeln!(f)?;
        }
        if !self.reasons.is_empty() {
            let groups: Vec<&FailureReason> = self.reasons.iter().collect();
            write!(f, "  why runs failed:\n{}", failure_text::text(&groups))?;
        }
        if self.lines.is_empty() {
            return Ok(());
        }
        let width = self.lines.iter().map(|line| line.name.len()).max().unwrap_or(0);
        let counted = if self.without_nominal { "dispersed samples" } else { "nominal sample" };
        if self.lines.iter().all(ObservableLine::is_empty) {
            let is_nominal_ok = self.statuses.iter().any(|(name, ended)| *name == ok && ended.count > 0);
            writeln!(f, "\n  no {} is ok: no statistics", if is_nominal_ok { "dispersed run" } else { "run" })?;
        } else {
            write_table(f, &self.lines, counted, self.confidence)?;
            if self.intervals.starts_with("none") {
                writeln!(f, "  intervals: {}", self.intervals)?;
            }
        }
        if let Some((_, text)) = &self.stopping {
            writeln!(f, "\n  stop: {text}")?;
        }
        f.write_str(&requirements::text(&self.verdicts))?;
        let Some(audit) = &self.audit else { return Ok(()) };
        write!(f, "\n{audit}")?;
        let audited = self.lines.iter().filter_map(|line| Some((line, line.numerical_error.as_ref()?)));
        let title = "numerical error, and how much of the spread (p95 - p5) it is";
        writeln!(
            f,
            "\n  {title}\n  {:<width$}  {:>6}{:>12}{:>12}{:>12}{:>12}",
            "", "unit", "median", "p95", "max", "share"
        )?;
        for (line, numerics) in audited {
            write!(f, "  {:<width$}  {:>6}", line.name, if line.unit.is_empty() { "-" } else { &line.unit })?;
            for value in [numerics.median, numerics.p95, numerics.max, numerics.share_of_spread] {
                write!(f, "{:>12}", value.map_or("-".to_owned(), short))?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five runs are ok and eight are not, without observables.
    fn summary() -> Summary {
        let ended = |count: u64, first: &[u64]| Ended { count, first: first.iter().map(|id| SampleId(*id)).collect() };
        Summary {
            name: "x".to_owned(),
            seed: 1,
            samples: 13,
            plan_hash: String::new(),
            without_nominal: true,
            statuses: vec![
                (Status::Done.name(), ended(5, &[])),
                (Status::StepLimit.name(), ended(2, &[3, 4])),
                (Status::NonFinite.name(), ended(0, &[])),
                (Status::Inaccurate.name(), ended(6, &[5, 6])),
            ],
            reasons: Vec::new(),
            worst: Vec::new(),
            lines: Vec::new(),
            verdicts: Verdicts::default(),
            intervals: String::new(),
            treatment: String::new(),
            confidence: 0.95,
            quantile_error: 0.0,
            audit: None,
            replaced: Vec::new(),
            stopping: None,
        }
    }

    /// Law: the screen counts the runs of each status that occurs, and names the first samples of those that are not ok.
    #[test]
    fn statuses_are_counted_and_failures_named() {
        let summary = summary();
        let lines = ["  ok                         5", "  step_limit                 2   samples 3, 4"];
        let more = "  inaccurate                 6   samples 5, 6, ...";
        assert_eq!(summary.to_string(), format!("{}\n{}\n{more}\n", lines[0], lines[1]));
    }

    /// Law: where no run is ok there is one line in place of a table of dashes.
    #[test]
    fn without_runs_that_are_ok_there_is_no_table() {
        let line = |count: u64| ObservableLine {
            name: "attitude_error".to_owned(),
            unit: String::new(),
            count,
            without_value: 0,
            mean: None,
            mean_interval: [None; 2],
            standard_deviation: None,
            standard_deviation_interval: [None; 2],
            mean_note: None,
            skewness: None,
            min: None,
            max: None,
            quantiles: Vec::new(),
            numerical_error: None,
        };
        let text = |lines: Vec<ObservableLine>| Summary { lines, ..summary() }.to_string();
        let none = text(vec![line(0), line(0)]);
        assert!(none.ends_with("\n\n  no dispersed run is ok: no statistics\n"), "{none}");
        let some = text(vec![line(0), line(5)]);
        assert!(some.contains("attitude_error") && !some.contains("no statistics"), "{some}");
    }

    #[test]
    fn failed_runs_are_read_from_a_summary() {
        let end =
            SummaryEnd::read(br#"{"statuses": {"ok": 5, "step_limit": 2, "invalid_sample": 1}}"#).expect("a summary");
        assert_eq!((end.rows, end.failed, end.is_reached), (8, 3, true));
        assert_eq!(SummaryEnd::read(b"{}"), None);
    }
}
