//! [`drawn`]: dispersed parameters without runs.

use std::path::Path;

use crate::campaign::Plan;
use crate::ensemble::{DrawnScenes, Percentiles};
use crate::findings::number::counted;
use crate::report::figure_files::{FigureSheet, instead};
use crate::report::inputs::DrawnInputs;
use crate::sampling::SampleId;
use crate::storage::drawn_table;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::workload::{Workload, plotted_samples};

/// Draws the samples of `plan` and writes them to `table` and `plot`; returns percentiles and notes. `is_allowed`: much
/// work is.
///
/// # Errors
/// Too much work, nothing dispersed to plot, or a failed file operation.
pub fn drawn(plan: &Plan, [table, plot]: [Option<&Path>; 2], is_allowed: bool) -> Result<(Percentiles, Vec<String>)> {
    let work = Workload::of_samples(plan, table.is_some(), plot.is_some());
    work.check(table.unwrap_or(Path::new("")), is_allowed, false)?;
    let (mut percentiles, mut notes) = (Percentiles::new(plan), Vec::new());
    match table {
        Some(path) => {
            let save = drawn_table::save(plan, path, |drawn| percentiles.add(drawn));
            save.map_err(|error| WorkflowError::at(path, error))?;
            let (samples, columns) = (counted(plan.samples, "sample"), drawn_table::columns(plan).len());
            notes.push(format!("{}: {samples}, {}", path.display(), counted(columns, "column")));
        }
        None => DrawnScenes::visit(plan, false, |drawn| {
            percentiles.add(drawn);
            Ok::<(), WorkflowError>(())
        })?,
    }
    notes.extend(plan.notes());
    if percentiles.invalid() > 0 {
        let (invalid, all) = (percentiles.invalid(), plan.samples);
        notes.push(format!("{invalid} of {all} samples are not physical: their status would be invalid_sample"));
    }
    if let Some(path) = plot {
        let numbers = plan.dispersions.columns().len();
        if numbers == 0 {
            let why = format!("{} has no dispersions: there is nothing to plot", plan.name);
            return Err(WorkflowError::Input(why));
        }
        // sample 0 is nominal
        let DrawnScenes { columns, .. } = DrawnScenes::new(plan, SampleId(1), plotted_samples(plan));
        let (count, all) = (columns.first().map_or(0, Vec::len), plan.samples.saturating_sub(1));
        let samples = counted(count, "sample");
        let first = if (count as u64) < all { "first " } else { "" };
        let title = format!("{}, {first}{samples}, {} design", plan.name, plan.design.name().replace('_', " "));
        let figures = DrawnInputs { columns, all }.figures(plan);
        let sheet = FigureSheet { title, figures }.in_units(&plan.analysis.display);
        let written = sheet.save(path).map_err(|error| WorkflowError::at(path, error))?;
        notes.push(format!("{}: {} of {samples}", written.display(), counted(numbers, "number")));
        notes.extend((written != path).then(|| instead(&written)));
    }
    Ok((percentiles, notes))
}
