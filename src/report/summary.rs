//! [`Summary`]: the statistics of a campaign, as `summary.json` and as text on the screen.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::campaign::Plan;
use crate::dataset::tally::{Headline, Tally};
use crate::report::audit_summary::{AuditSummary, Numerics};
use crate::report::number::short;
use crate::run::Status;
use crate::statistics::sketch::RELATIVE_ERROR;

/// Order statistics of one observable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// The observable.
    pub name: &'static str,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// Number of values.
    pub count: u64,
    /// Median.
    pub median: Option<f64>,
    /// Rank ceil(0.95 n).
    pub p95: Option<f64>,
    /// Rank ceil(0.999 n).
    pub p99_9: Option<f64>,
    /// Largest value.
    pub max: Option<f64>,
    /// Its numerical error over the audited runs, where there are any that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub numerical_error: Option<Numerics>,
}

/// What a campaign amounts to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    name: String,
    seed: u64,
    samples: u64,
    plan_hash: String,
    statuses: Vec<(&'static str, u64)>,
    lines: Vec<Line>,
    audit: Option<AuditSummary>,
}

impl Summary {
    /// Sums up.
    pub fn new(plan: &Plan, tally: &Tally) -> Self {
        let numerics = |index, headline: &Headline| Numerics::new(tally.audits()?, index, &headline.sketch);
        let lines = tally.headlines().iter().enumerate().map(|(index, headline)| Line {
            name: headline.quantity.name(),
            unit: headline.quantity.unit(),
            count: headline.sketch.count(),
            median: headline.quantile(0.5),
            p95: headline.quantile(0.95),
            p99_9: headline.quantile(0.999),
            max: headline.sketch.max(),
            numerical_error: numerics(index, headline),
        });
        Summary {
            name: plan.name.clone(),
            seed: plan.seed,
            samples: plan.samples,
            plan_hash: plan.hash(),
            statuses: Status::ALL.into_iter().map(|status| (status.name(), tally.count(status))).collect(),
            lines: lines.collect(),
            audit: tally.audits().map(|audits| AuditSummary::new(audits, plan.audit_fraction)),
        }
    }

    /// The text of `summary.json`. It holds nothing that depends on the machine or the clock.
    pub fn json(&self) -> String {
        let statuses: Map<String, Value> =
            self.statuses.iter().map(|(name, count)| ((*name).to_owned(), json!(count))).collect();
        let mut value = json!({
            "program": "spindrift",
            "version": env!("CARGO_PKG_VERSION"),
            "campaign": self.name,
            "plan_hash": self.plan_hash,
            "seed": self.seed,
            "samples": self.samples,
            "statuses": statuses,
            "quantiles": {
                "rank": "ceil(p n), over the runs that are ok",
                "relative_error_bound": RELATIVE_ERROR,
                "max": "exact",
            },
            "observables": self.lines,
        });
        if let Some(audit) = &self.audit {
            value["audit"] = json!(audit);
        }
        format!("{value:#}\n")
    }
}

/// How many runs a finished summary calls failed; `None` where it does not say.
pub fn failed_runs(summary: &str) -> Option<u64> {
    let value: Value = serde_json::from_str(summary).ok()?;
    let statuses = value.get("statuses")?.as_object()?;
    Some(statuses.iter().filter(|(name, _)| *name != Status::Done.name()).filter_map(|(_, count)| count.as_u64()).sum())
}

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let statuses = self.statuses.iter().filter(|(name, count)| *count > 0 || *name == Status::Done.name());
        for (name, count) in statuses {
            writeln!(f, "  {name:<16}{count:>12}")?;
        }
        if self.lines.is_empty() {
            return Ok(());
        }
        let width = self.lines.iter().map(|line| line.name.len()).max().unwrap_or(0);
        writeln!(f, "\n  {:<width$}  {:>6}{:>12}{:>12}{:>12}{:>12}", "", "unit", "median", "p95", "p99.9", "max")?;
        for line in &self.lines {
            write!(f, "  {:<width$}  {:>6}", line.name, if line.unit.is_empty() { "-" } else { line.unit })?;
            for value in [line.median, line.p95, line.p99_9, line.max] {
                match value {
                    Some(value) => write!(f, "{:>12}", short(value))?,
                    None => write!(f, "{:>12}", "-")?,
                }
            }
            writeln!(f)?;
        }
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
            write!(f, "  {:<width$}  {:>6}", line.name, if line.unit.is_empty() { "-" } else { line.unit })?;
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

    #[test]
    fn failed_runs_are_read_from_a_summary() {
        assert_eq!(failed_runs(r#"{"statuses": {"ok": 5, "step_limit": 2, "invalid_sample": 1}}"#), Some(3));
        assert_eq!(failed_runs("{}"), None);
    }
}
