//! `summary.json`: [`json`] writes the findings for programs; [`read`] returns the end of a campaign.

use serde_json::{Map, Value, json};

use crate::analysis::analysed::Analysed;
use crate::analysis::assessment::Assessment;
use crate::analysis::missions::MissionShare;
use crate::analysis::statistic::{STATISTICS, Statistic};
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::statuses::Ended;
use crate::analysis::stopping::{LookFound, Stopping};
use crate::analysis::tally::Worst;
use crate::campaign::{Plan, Statement};
use crate::ensemble::FailureReason;
use crate::findings::end::SummaryEnd;
use crate::findings::numerics::{AuditSummary, Numerics};
use crate::findings::outcome::summarised;
use crate::findings::requirement::{self, EndVerdict};
use crate::findings::{Finding, Findings, Kind, Number, Verdict};
use crate::run::Status;
use crate::statistics::binomial::Decision;
use crate::statistics::contingency::Occurrence;
use crate::statistics::gate::GateLimit;

const LISTED: usize = 3;

/// The text of `summary.json`, independent of machine and clock.
pub fn json(plan: &Plan, analysed: &Analysed, findings: &Findings) -> String {
    let Analysed { statistics, tally, missions, stopping, .. } = analysed;
    let statuses = &tally.statuses;
    let counts: Map<String, Value> =
        statuses.list().iter().map(|ended| (ended.status.name().to_owned(), json!(ended.count))).collect();
    let numbers = |ended: &Ended| ended.first.iter().take(LISTED).map(|(sample, _)| sample.0).collect::<Vec<_>>();
    let first_failed: Map<String, Value> =
        statuses.failed().map(|ended| (ended.status.name().to_owned(), json!(numbers(ended)))).collect();
    let reason = |one: &FailureReason| {
        let (status, sample) = (one.status.name(), one.first.0);
        json!({ "status": status, "count": one.count, "sample": sample, "reason": one.text })
    };
    let reasons: Vec<Value> = statuses.reasons().groups().into_iter().map(reason).collect();
    let runs = |worst: &Worst| -> Vec<Value> {
        let key = if worst.is_error { "error" } else { "value" };
        worst.list.runs.iter().map(|(sample, value)| json!({ "sample": sample.0, key: value })).collect()
    };
    let worst: Map<String, Value> =
        tally.worst.iter().map(|worst| (worst.name.replace(' ', "_"), json!(runs(worst)))).collect();
    let samples = if tally.without_nominal { "dispersed, without the nominal sample 0" } else { "nominal" };
    let untold = findings.of(Kind::Driver).filter(|one| one.id == "untold").map(|one| one.sentence.clone());
    let notes = findings.of(Kind::Note).map(|one| format!("{}: {}", one.title, one.sentence));
    let notes: Vec<String> = notes.chain(untold).collect();
    let observables = summarised(plan, statistics).into_iter().map(|column| observable(analysed, column));
    let mut value = json!({
        "program": "spindrift",
        "finished": true,
        "version": env!("CARGO_PKG_VERSION"),
        "campaign": plan.name,
        "plan_hash": plan.hash(),
        "seed": plan.seed,
        "samples": plan.samples,
        "warnings": findings.warnings(),
        "notes": notes,
        "statuses": counts,
        "first_failed": first_failed,
        "failure_reasons": reasons,
        "worst_runs": worst,
        "statistics": {
            "samples": samples,
            "failed_runs": statistics.treatment(),
            "quantiles": "type 7 of Hyndman and Fan, over the runs that are ok",
            "relative_error_of_quantiles": statistics.quantile_error,
            "intervals": statistics.population.intervals(),
            "confidence": statistics.confidence,
        },
        "requirements": requirements(analysed, findings),
        "drivers": findings.of(Kind::Driver).map(driver).collect::<Vec<_>>(),
        "observables": observables.collect::<Vec<_>>(),
    });
    let replaced = plan.dispersions.replaced_correlations();
    if !replaced.is_empty() {
        let list = replaced.iter();
        let list = list.map(|one| json!({ "parameters": one.names, "asked": one.written, "used": one.used }));
        value["nearest_correlations_of_scores"] = list.collect();
    }
    if !missions.is_empty() {
        value["missions"] = missions.iter().map(mission).collect();
    }
    if let Some(audit) = AuditSummary::of(plan, tally) {
        value["audit"] = json!(audit);
    }
    if let Some(stopping) = stopping {
        value["stop"] = stop(stopping);
    }
    format!("{value:#}\n")
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn observable(analysed: &Analysed, column: &ColumnStatistics) -> Value {
    let known = |value: Option<f64>| value.filter(|value| value.is_finite());
    let (name, moments) = (column.quantity.name(), &column.moments);
    let quantiles = column.quantiles.iter().map(|one| {
        let mut value = json!({ "p": one.p, "value": known(one.value), "interval": one.interval.map(known) });
        if let Some(note) = &one.note {
            value["note"] = json!(note);
        }
        value
    });
    let mut value = json!({
        "name": name,
        "unit": column.quantity.unit(),
        "count": moments.count(),
        "without_value": column.without_value,
    });
    for Statistic { name, value: of, uncertainty, .. } in &STATISTICS {
        value[*name] = json!(known(of(column)));
        if let Some(uncertainty) = uncertainty {
            value[format!("{name}_interval")] = json!((uncertainty.interval)(column));
        }
    }
    value["quantiles"] = quantiles.collect();
    if let Some(note) = &column.note {
        value["mean_note"] = json!(note);
    }
    if let Some(numerics) = Numerics::of(analysed, name) {
        value["numerical_error"] = json!(numerics);
    }
    value
}

fn requirements(analysed: &Analysed, findings: &Findings) -> Value {
    let verdicts = &analysed.verdicts;
    let one = |(place, one): (usize, &Assessment)| {
        let asked = &one.requirement;
        let (statement, target) = match asked.statement {
            Statement::Quantile(p) => ("quantile", Some(p)),
            Statement::Fraction(fraction) => ("fraction", Some(fraction)),
            Statement::Mean => ("mean", None),
        };
        let (side, limit) = match asked.limit {
            GateLimit::AtMost(limit) => ("at_most", limit),
            GateLimit::AtLeast(limit) => ("at_least", limit),
        };
        let needed = match one.gate.decision {
            Decision::Undecided(runs) => runs,
            _ => None,
        };
        let id = format!("requirement_{}", place + 1);
        let said = findings.of(Kind::Requirement).find(|one| one.id == id);
        json!({
            "requirement": requirement::question(one),
            "verdict": Verdict::of(one.gate.decision).word(),
            "in_short": requirement::title(one),
            "found": said.and_then(|said| said.numbers.first()).map(Number::text),
            "says": said.map(|said| &said.sentence),
            "notes": said.map(|said| &said.notes),
            "observable": asked.observable(),
            "band": asked.band().map(|band| json!({
                "quantity": band.series,
                "from_s": band.from_s,
                "to_s": band.to_s,
                "at_all_times": asked.window().is_some(),
                "worst_at_s": one.worst.map(|worst| worst.time_s),
                "points": one.worst.map(|worst| worst.points),
                "unresolved": one.worst.map(|worst| worst.unresolved),
            })),
            "unit": one.unit,
            "statement": statement,
            "target": target,
            side: limit,
            "confidence": asked.confidence,
            "confidence_of_pass_and_bounds": one.confidences[0],
            "confidence_of_fail": one.confidences[1],
            "estimate": finite(one.gate.estimate),
            "bounds": one.gate.bounds.map(finite),
            "interval": one.interval.map(finite),
            "bounded": asked.bounded,
            "assumes": requirement::assumed(one),
            "value": one.value.and_then(finite),
            "runs": one.runs,
            "violations": one.violations,
            "runs_without_a_value": one.missing,
            "failed_runs": one.failed,
            "runs_that_would_decide": needed,
            "reason": one.reason,
            "note": one.note,
        })
    };
    json!({
        "list": verdicts.list.iter().enumerate().map(one).collect::<Vec<_>>(),
        "looks": verdicts.looks,
        "confidence_of_intervals": verdicts.confidence,
        "together": findings.of(Kind::Verdicts).map(|one| &one.sentence).collect::<Vec<_>>(),
        "samples": verdicts.samples,
        "samples_that_are_not_physical": verdicts.invalid,
    })
}

fn driver(one: &Finding) -> Value {
    let share = |input: &Finding| {
        let share = input.numbers.first();
        json!({
            "input": input.id,
            "name": input.title,
            "share_of_the_variance": share.and_then(|share| finite(share.value)),
            "interval": share.map(|share| share.interval.map(finite)),
            "runs": share.map(|share| share.of),
        })
    };
    let inputs: Vec<Value> = one.children.iter().map(share).collect();
    json!({ "id": one.id, "about": one.title, "says": one.sentence, "inputs": inputs })
}

fn mission(share: &MissionShare) -> Value {
    let phase = |(name, count): &(crate::scene::Name, u64)| json!({ "phase": name.as_str(), "count": count });
    json!({
        "end": share.end,
        "phases": share.phases.iter().map(phase).collect::<Vec<_>>(),
        "count": share.count,
        "runs": share.runs,
        "not_computed": share.missing,
        "shares": share.shares(),
        "interval": share.interval,
    })
}

fn stop(stopping: &Stopping) -> Value {
    let (look, undecided) = match &stopping.found {
        LookFound::Precision(look) => (Some(look), None),
        LookFound::Undecided(count) => (None, Some(count)),
    };
    json!({
        "look": stopping.look,
        "looks": stopping.looks,
        "samples": stopping.samples,
        "reached": stopping.is_reached(),
        "undecided": undecided,
        "precise_enough": look.map(|look| look.stops),
        "estimate": look.map(|look| look.estimate),
        "interval": look.map(|look| look.interval),
        "confidence": look.map(|look| look.confidence),
    })
}

/// Parses a summary; `None` if it is unfinished or invalid.
pub fn read(bytes: &[u8]) -> Option<SummaryEnd> {
    let value: Value = serde_json::from_slice(bytes).ok()?;
    let statuses: Vec<(&String, u64)> =
        value.get("statuses")?.as_object()?.iter().filter_map(|(name, count)| Some((name, count.as_u64()?))).collect();
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
                // older summaries have only the sentence
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
