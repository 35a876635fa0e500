//! [`PrecisionTable`]: measurements of run time against error, as a Parquet file and as text.

use std::fmt::Write as _;
use std::path::Path;

use parquet::errors::ParquetError;

use crate::campaign::Plan;
use crate::dataset::atomic;
use crate::dataset::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::dataset::rows_file::provenance;
use crate::ensemble::precision::{Deviation, Measurement, Setting, Skipped};

/// What a column of numbers holds: name, unit, meaning, value.
type Column = (&'static str, &'static str, &'static str, fn(&Measurement) -> Option<f64>);

/// The columns of numbers.
const COLUMNS: [Column; 17] = [
    ("tolerance", "", "Relative and absolute tolerance; absent for a fixed step.", |m| tolerance(m.setting)),
    ("step_s", "s", "Fixed step; absent for a tolerance.", |m| step(m.setting)),
    ("cpu_s", "s", "CPU time of a run, median of the repetitions.", |m| Some(m.cpu[0])),
    ("cpu_least_s", "s", "CPU time of a run, least of the repetitions.", |m| Some(m.cpu[1])),
    ("repeats", "", "Number of timed repetitions.", |m| Some(m.repeats as f64)),
    ("runs", "", "Number of samples.", |m| Some(m.runs[0] as f64)),
    ("failed", "", "Samples that did not reach their end; they have no error.", |m| Some(m.runs[1] as f64)),
    ("steps_mean", "", "Accepted steps of a run, mean.", |m| Some(m.steps)),
    ("runs_per_s", "1/s", "One over the median CPU time.", |m| Some(1.0 / m.cpu[0])),
    ("rate_error_max", "", "Largest |omega - truth| over the run's largest |omega|.", |m| largest(m.rate)),
    ("rate_error_rms", "", "The same, root mean square over samples and points.", |m| mean(m.rate)),
    ("dcm_orthonormality_max_rad", "rad", "Largest twice |q - truth|.", |m| largest(m.attitude)),
    ("dcm_orthonormality_rms_rad", "rad", "The same, root mean square over samples and points.", |m| mean(m.attitude)),
    ("energy_error_max", "", "Largest relative error of the energy balance.", |m| largest(m.energy)),
    ("energy_error_rms", "", "The same, root mean square over samples and points.", |m| mean(m.energy)),
    ("angular_momentum_error_max", "", "Largest relative error of the balance of angular momentum.", |m| {
        largest(m.momentum)
    }),
    ("angular_momentum_error_rms", "", "The same, root mean square over samples and points.", |m| mean(m.momentum)),
];

fn tolerance(setting: Setting) -> Option<f64> {
    if let Setting::Tolerance(tolerance) = setting { Some(tolerance) } else { None }
}

fn step(setting: Setting) -> Option<f64> {
    if let Setting::Step(step) = setting { Some(step) } else { None }
}

fn largest(of: Option<Deviation>) -> Option<f64> {
    of.map(|deviation| deviation.max)
}

fn mean(of: Option<Deviation>) -> Option<f64> {
    of.map(|deviation| deviation.rms)
}

/// Measurements, in the order in which they were made, and what was skipped.
#[derive(Clone, Debug, Default)]
pub struct PrecisionTable {
    /// What was measured.
    pub measured: Vec<Measurement>,
    /// What was not.
    pub skipped: Vec<Skipped>,
}

impl PrecisionTable {
    /// Writes the measurements as Parquet; the file is whole or absent.
    ///
    /// # Errors
    /// Where writing fails.
    pub fn save(&self, plan: &Plan, isa: &str, path: &Path) -> Result<(), ParquetError> {
        let method = Heading {
            name: "method".to_owned(),
            unit: String::new(),
            meaning: "Kernel and method, as in campaign files.".to_owned(),
            content: Content::Word,
            nullable: false,
        };
        let numbers = COLUMNS.iter().map(|(name, unit, meaning, _)| Heading {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            meaning: (*meaning).to_owned(),
            content: Content::Real,
            nullable: true,
        });
        let headings: Vec<Heading> = std::iter::once(method).chain(numbers).collect();
        let mut origin = provenance(plan);
        origin.insert("spindrift.isa".to_owned(), isa.to_owned()); // times depend on it, unlike rows
        let layout = Layout::new(&headings, origin, Packing::Lz4)?;
        let columns: Vec<(Vec<f64>, Vec<bool>)> = COLUMNS
            .iter()
            .map(|(.., value)| {
                let values: Vec<Option<f64>> = self.measured.iter().map(value).collect();
                let there = values.iter().map(Option::is_some).collect();
                (values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect(), there)
            })
            .collect();
        let words = Cells::Word(self.measured.iter().map(|measurement| measurement.method.name()).collect());
        let numbers = columns.iter().map(|(values, there)| Cells::Real(values, Some(there)));
        atomic::write(path, |file| layout.write(file, &[], std::iter::once(words).chain(numbers)))
    }

    /// The line above the rows.
    pub fn headline() -> String {
        format!(
            "{:<17} {:>9} {:>10} {:>11} {:>8} {:>9} {:>9} {:>9} {:>9}  {}\n",
            "method", "setting", "us/run", "runs/s", "steps", "rate", "attitude", "energy", "momentum", "notes"
        )
    }

    /// A measurement as a line: largest errors.
    pub fn line(measurement: &Measurement) -> String {
        let m = measurement;
        let error = |of| largest(of).map_or("-".to_owned(), |error: f64| format!("{error:.1e}"));
        let mut line = format!(
            "{:<17} {:>9} {:>10} {:>11} {:>8.0} {:>9} {:>9} {:>9} {:>9}",
            m.method.name(),
            setting(m.setting),
            significant(1e6 * m.cpu[0]),
            significant(1.0 / m.cpu[0]),
            m.steps,
            error(m.rate),
            error(m.attitude),
            error(m.energy),
            error(m.momentum),
        );
        // writing to a String does not fail
        if m.runs[1] > 0 {
            let _ = write!(line, "  {} of {} runs failed", m.runs[1], m.runs[0]);
        }
        if m.repeats < 3 {
            let _ = write!(line, "  {} repetition{}", m.repeats, if m.repeats == 1 { "" } else { "s" });
        }
        line.push('\n');
        line
    }

    /// What was skipped, in words; empty where nothing was.
    pub fn omissions(&self, limit: f64) -> String {
        let mut text = String::new();
        let mut methods: Vec<_> = self.skipped.iter().map(|skipped| skipped.method).collect();
        methods.dedup();
        for method in methods {
            let of = || self.skipped.iter().filter(|skipped| skipped.method == method);
            let settings: Vec<String> = of().map(|skipped| setting(skipped.setting)).collect();
            let predicted = of().map(|skipped| skipped.predicted).fold(f64::INFINITY, f64::min);
            let _ = writeln!(
                text,
                "skipped: {} at {}: a pass over the samples would take {} s or more, the limit is {} s (--limit-s)",
                method.name(),
                settings.join(", "),
                significant(predicted),
                significant(limit),
            );
        }
        text
    }
}

/// A setting in few digits.
fn setting(setting: Setting) -> String {
    match setting {
        Setting::Tolerance(tolerance) => format!("{tolerance:.0e}"),
        Setting::Step(step) => format!("{step:.1e}s"),
    }
}

/// A positive number in three digits, without an exponent.
fn significant(value: f64) -> String {
    if !(value > 0.0 && value.is_finite()) {
        return format!("{value}");
    }
    let decimals = (2.0 - libm::floor(libm::log10(value))).clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagation::Method;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.012_34, 1.0, 123.4, 98_765.0].map(significant), ["0.0123", "1.00", "123", "98765"]);
    }

    /// Law: a skipped setting is named with its reason.
    #[test]
    fn omissions_are_named() {
        let skip = |setting| Skipped { method: Method::NullSpace, setting, predicted: 44.0 };
        let skipped = vec![skip(Setting::Tolerance(1e-11)), skip(Setting::Tolerance(1e-12))];
        let text = PrecisionTable { measured: Vec::new(), skipped }.omissions(20.0);
        assert!(text.contains("reference at 1e-11, 1e-12") && text.contains("44.0 s"), "{text}");
        assert_eq!(PrecisionTable::default().omissions(20.0), "");
    }
}
