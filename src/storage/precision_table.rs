//! [`save`]: measurements of run time against error as a Parquet file.

use std::path::Path;

use parquet::errors::ParquetError;

use crate::campaign::Plan;
use crate::ensemble::precision::{Deviation, Measurement, Setting};
use crate::run::Quantity;
use crate::storage::atomic;
use crate::storage::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::storage::identity::provenance;

/// A column of numbers: what it is, and its value.
type NumberColumn = (Quantity, fn(&Measurement) -> Option<f64>);

static COLUMNS: [NumberColumn; 17] = [
    (Quantity::new("tolerance", "", "Relative and absolute tolerance; absent for a fixed step."), |m| {
        tolerance(m.setting)
    }),
    (Quantity::new("step_s", "s", "Fixed step; absent for a tolerance."), |m| step(m.setting)),
    (Quantity::new("cpu_s", "s", "CPU time of a run, median of the repetitions."), |m| Some(m.cpu[0])),
    (Quantity::new("cpu_least_s", "s", "CPU time of a run, minimum of the repetitions."), |m| Some(m.cpu[1])),
    (Quantity::new("repeats", "", "Number of timed repetitions."), |m| Some(m.repeats as f64)),
    (Quantity::new("runs", "", "Number of samples."), |m| Some(m.runs[0] as f64)),
    (Quantity::new("failed", "", "Samples that did not reach their end; they have no error."), |m| {
        Some(m.runs[1] as f64)
    }),
    (Quantity::new("steps_mean", "", "Accepted steps of a run, mean."), |m| Some(m.steps)),
    (Quantity::new("runs_per_s", "1/s", "One over the median CPU time."), |m| Some(1.0 / m.cpu[0])),
    (
        Quantity::new("rate_error_max", "", "Maximum |omega - reference solution| over the run's maximum |omega|."),
        |m| maximum(m.rate),
    ),
    (Quantity::new("rate_error_rms", "", "The same, root mean square over samples and points."), |m| mean(m.rate)),
    (
        Quantity::new(
            "attitude_error_max_rad",
            "rad",
            "Maximum angle between the attitude and the reference solution, as 2 |q - q_ref|.",
        ),
        |m| maximum(m.attitude),
    ),
    (Quantity::new("attitude_error_rms_rad", "rad", "The same, root mean square over samples and points."), |m| {
        mean(m.attitude)
    }),
    (Quantity::new("energy_error_max", "", "Maximum relative error of the energy balance."), |m| maximum(m.energy)),
    (Quantity::new("energy_error_rms", "", "The same, root mean square over samples and points."), |m| mean(m.energy)),
    (
        Quantity::new("angular_momentum_error_max", "", "Maximum relative error of the balance of angular momentum."),
        |m| maximum(m.momentum),
    ),
    (Quantity::new("angular_momentum_error_rms", "", "The same, root mean square over samples and points."), |m| {
        mean(m.momentum)
    }),
];

fn tolerance(setting: Setting) -> Option<f64> {
    if let Setting::Tolerance(tolerance) = setting { Some(tolerance) } else { None }
}

fn step(setting: Setting) -> Option<f64> {
    if let Setting::Step(step) = setting { Some(step) } else { None }
}

fn maximum(of: Option<Deviation>) -> Option<f64> {
    of.map(|deviation| deviation.max)
}

fn mean(of: Option<Deviation>) -> Option<f64> {
    of.map(|deviation| deviation.rms)
}

/// Writes `measured` as Parquet; the file is whole or absent.
///
/// # Errors
/// Where writing fails.
pub fn save(measured: &[Measurement], plan: &Plan, isa: &str, path: &Path) -> Result<(), ParquetError> {
    let method = Heading::new(Quantity::new("method", "", "Method, as in campaign files."), Content::Word);
    let numbers = COLUMNS.iter().map(|(quantity, _)| Heading::new(quantity.clone(), Content::Real).nullable());
    let headings: Vec<Heading> = std::iter::once(method).chain(numbers).collect();
    let mut origin = provenance(plan);
    origin.insert("spindrift.isa".to_owned(), isa.to_owned()); // times depend on it, unlike rows
    let layout = Layout::new(&headings, origin, Packing::Lz4)?;
    let columns: Vec<(Vec<f64>, Vec<bool>)> = COLUMNS
        .iter()
        .map(|(_, value)| {
            let values: Vec<Option<f64>> = measured.iter().map(value).collect();
            let there = values.iter().map(Option::is_some).collect();
            (values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect(), there)
        })
        .collect();
    let words = Cells::Word(measured.iter().map(|measurement| measurement.method.name()).collect());
    let numbers = columns.iter().map(|(values, there)| Cells::Real(values, Some(there)));
    atomic::write(path, |file| layout.write(file, &[], std::iter::once(words).chain(numbers)))
}
