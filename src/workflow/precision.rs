//! [`measured`]: run time and error for every method and tolerance, as a table and a figure.

use std::path::{Path, PathBuf};

use crate::campaign::Plan;
use crate::campaign::forces::allowed_methods;
use crate::dynamics::effects::ForceModel;
use crate::ensemble::Ensemble;
use crate::ensemble::precision::{Limits, Measurement, Precision};
use crate::ensemble::runner::start_threads;
use crate::ensemble::settings::nominal;
use crate::findings::number::counted;
use crate::findings::{Finding, precision as findings};
use crate::propagation::Method;
use crate::report::precision_figure::precision_figure;
use crate::storage::precision_table::precision_table;
use crate::storage::{atomic, table_file};
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::isa;
use crate::workflow::workload::Workload;

/// The request.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// By default all that integrate the plan's forces.
    pub methods: Option<Vec<Method>>,
    /// By default 1e-4 to 1e-16 by decades.
    pub tolerances: Option<Vec<f64>>,
    /// Number of first samples.
    pub samples: u64,
    /// True to integrate only states needed by the observables.
    pub is_observed: bool,
    pub limits: Limits,
    /// True if much work is allowed.
    pub is_allowed: bool,
}

/// Progress of a measurement.
#[derive(Debug)]
pub enum Told<'m> {
    /// Its parts, once.
    Begun(&'m [Finding]),
    Measured(&'m Measurement),
    /// Omitted parts, with reasons.
    Omitted(&'m [Finding]),
}

/// The files that may result in `folder`.
pub fn outputs(folder: &Path) -> [PathBuf; 3] {
    ["parquet", "svg", "html"].map(|extension| folder.join(format!("precision.{extension}")))
}

/// Measures `plan`; returns the files written to `folder`.
///
/// # Errors
/// A method that does not integrate acting effects, no sample with a reference solution, too much work, a failed file
/// operation, or an error of `tell`.
pub fn measured(
    plan: &Plan,
    wanted: &Wanted,
    folder: &Path,
    tell: &mut dyn FnMut(Told<'_>) -> Result<()>,
) -> Result<[PathBuf; 2]> {
    let isa = isa()?;
    start_threads().map_err(|error| WorkflowError::Files(format!("cannot start the threads: {error}")))?;
    let model = ForceModel::of(&nominal(plan));
    let all = || Method::ALL.into_iter().filter(|method| method.integrates(model)).collect();
    let methods: Vec<Method> = wanted.methods.clone().unwrap_or_else(all);
    let refused = methods.iter().find_map(|method| Some((method, allowed_methods(*method, model)?)));
    if let Some((method, allowed)) = refused {
        return Err(WorkflowError::Input(format!("--methods: {} must be {allowed}", method.name())));
    }
    let by_decades = || (4..=16).map(|digits| libm::pow(10.0, -f64::from(digits))).collect();
    let mut tolerances: Vec<f64> = wanted.tolerances.clone().unwrap_or_else(by_decades);
    tolerances.sort_by(|a, b| b.total_cmp(a));
    tolerances.dedup();
    Workload::of_precision(&Ensemble::new(plan, isa), wanted.samples).check(folder, wanted.is_allowed, false)?;
    atomic::make_folder(folder)?;

    let samples = usize::try_from(wanted.samples).unwrap_or(usize::MAX);
    let precision = Precision::new(plan, isa, samples, wanted.is_observed).map_err(|(sample, status)| {
        WorkflowError::Input(format!("no reference solution of sample {sample}: it ended with {}", status.name()))
    })?;
    if precision.samples() == 0 {
        return Err(WorkflowError::Input("no sample of this campaign is physical".to_owned()));
    }
    let which = if wanted.is_observed { "observed" } else { "all" };
    tell(Told::Begun(&[findings::head(plan, precision.samples(), [which, isa.name()])]))?;
    let (mut measured, mut omitted) = (Vec::new(), Vec::new());
    for method in methods {
        let settings = precision.settings(method, &tolerances);
        let mut heard = Ok(());
        let skipped = precision.sweep(method, &settings, wanted.limits, &mut |found| {
            let told = tell(Told::Measured(&found));
            heard = std::mem::replace(&mut heard, Ok(())).and(told);
            measured.push(found);
        });
        heard?;
        omitted.extend(skipped);
    }
    tell(Told::Omitted(&findings::omissions(&omitted, wanted.limits.limit)))?;

    let [table, figure, _] = outputs(folder);
    table_file::save(plan, &precision_table(&measured, isa.name()), &table)?;
    let title = format!("{}: {}, {:?} s", plan.name, counted(precision.samples(), "sample"), plan.grid.duration());
    let figure = precision_figure(title, &measured).save(&figure)?;
    Ok([table, figure])
}
