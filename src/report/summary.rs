//! [`Tally`]: what a campaign amounts to, counted part by part; [`Summary`]: the same as `summary.json` and on the screen.
//!
//! Everything is counted, nothing is added up in floating point, so that a summary does not depend on the order of parts.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::campaign::Plan;
use crate::ensemble::{Ensemble, Rows};
use crate::observables::Kind;
use crate::report::audit_summary::{AuditSummary, AuditTally, Numerics};
use crate::run::Status;
use crate::statistics::sketch::{RELATIVE_ERROR, Sketch};

/// The observables that are summed up, where the campaign has them: main errors, exchange, effort, numerics.
pub const HEADLINES: &[&str] = &[
    "energy_error_max",
    "energy_error_rate_per_s",
    "linear_momentum_error_max",
    "angular_momentum_error_max",
    "debris_linear_momentum_error_max",
    "debris_angular_momentum_error_max",
    "dcm_orthonormality_max",
    "residual_kinematic_max_m_s",
    "residual_collocation_max_m",
    "residual_attitude_max",
    "energy_com_error_max",
    "exchange_fuselage_peak_to_peak_j",
    "exchange_wheel1_peak_to_peak_j",
    "exchange_wheel2_peak_to_peak_j",
    "exchange_fuselage_fraction",
    "exchange_wheel1_fraction",
    "exchange_wheel2_fraction",
    "exchange_wheel1_gross_j",
    "exchange_wheel2_gross_j",
    "steps",
    "state_error_estimate",
    "error_amplification",
    "ill_conditioned",
];

/// An observable that is summed up.
#[derive(Clone, Debug)]
struct Headline {
    /// Its place in a row.
    index: usize,
    name: &'static str,
    unit: &'static str,
    kind: Kind,
    sketch: Sketch,
}

impl Headline {
    /// The value of rank ceil(p n); a count is a whole number, which the middle of a bucket need not be.
    fn quantile(&self, p: f64) -> Option<f64> {
        let value = self.sketch.quantile(p)?;
        Some(if self.kind == Kind::Count { libm::round(value) } else { value })
    }
}

/// Counts of statuses, and of values of the main observables over the runs that are `ok`.
#[derive(Clone, Debug)]
pub struct Tally {
    statuses: [u64; Status::ALL.len()],
    headlines: Vec<Headline>,
    /// Where the campaign is audited.
    audits: Option<AuditTally>,
}

impl Tally {
    /// Nothing counted yet.
    pub fn new(campaign: &Ensemble<'_>) -> Self {
        let columns = campaign.request().columns();
        let headline = |name: &&'static str| {
            let index = columns.iter().position(|column| column.name == *name)?;
            let column = columns[index];
            Some(Headline { index, name, unit: column.unit, kind: column.kind, sketch: Sketch::default() })
        };
        let headlines: Vec<Headline> = HEADLINES.iter().filter_map(headline).collect();
        let audits = (campaign.plan().audit_fraction > 0.0).then(|| AuditTally::new(headlines.len()));
        Tally { statuses: [0; Status::ALL.len()], headlines, audits }
    }

    /// Counts the rows of a part.
    pub fn add(&mut self, rows: &Rows) {
        for status in rows.statuses() {
            self.statuses[place(*status)] += 1;
        }
        for headline in &mut self.headlines {
            for (value, status) in rows.observable(headline.index).iter().zip(rows.statuses()) {
                if *status == Status::Done {
                    headline.sketch.add(*value);
                }
            }
        }
        if let Some(audits) = &mut self.audits {
            audits.add(rows, self.headlines.iter().map(|headline| headline.index));
        }
    }

    /// What the audits amount to, where there are any.
    pub fn audits(&self) -> Option<&AuditTally> {
        self.audits.as_ref()
    }

    /// How many samples ended with `status`.
    pub fn count(&self, status: Status) -> u64 {
        self.statuses[place(status)]
    }

    /// How many runs failed.
    pub fn failed(&self) -> u64 {
        self.statuses.iter().sum::<u64>() - self.count(Status::Done)
    }
}

fn place(status: Status) -> usize {
    Status::ALL.iter().position(|known| *known == status).expect("every status is in the list of all")
}

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
        let numerics = |index, headline: &Headline| tally.audits.as_ref()?.numerics(index, &headline.sketch);
        let lines = tally.headlines.iter().enumerate().map(|(index, headline)| Line {
            name: headline.name,
            unit: headline.unit,
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
            audit: tally.audits.as_ref().map(|audits| audits.summary(plan.audit_fraction)),
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

/// A number in at most ten characters, four digits of it.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.3e}")
    } else if size == libm::floor(size) {
        format!("{value:.0}")
    } else {
        let before = libm::floor(libm::log10(size)) as i32;
        format!("{value:.*}", (3 - before).max(1) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: numbers on the screen stay within their column, whatever their size.
    #[test]
    fn short_numbers_are_short() {
        for (value, text) in
            [(0.0, "0"), (1.234_567e-15, "1.235e-15"), (12.345_67, "12.35"), (4096.0, "4096"), (-1.5e300, "-1.500e300")]
        {
            assert_eq!(short(value), text);
        }
        assert!([f64::MIN, f64::MIN_POSITIVE, f64::NAN, f64::INFINITY].iter().all(|value| short(*value).len() <= 11));
    }

    #[test]
    fn failed_runs_are_read_from_a_summary() {
        assert_eq!(failed_runs(r#"{"statuses": {"ok": 5, "step_limit": 2, "invalid_sample": 1}}"#), Some(3));
        assert_eq!(failed_runs("{}"), None);
    }

    /// Law: every headline is an observable; a name that changes there must change here.
    #[test]
    fn headlines_are_observables() {
        use crate::observables::{Groups, Request};
        let request = |debris, actuated, constrained| Request { groups: Groups::ALL, debris, actuated, constrained };
        let mut names: Vec<&str> = request(true, false, true).columns().iter().map(|column| column.name).collect();
        names.extend(request(true, true, false).columns().iter().map(|column| column.name));
        for headline in HEADLINES {
            assert!(names.contains(headline), "{headline} is not among {names:?}");
        }
    }
}
