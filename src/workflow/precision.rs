//! [`measured`]: run time against error for every method and tolerance, as a table and a figure in a folder.

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
use crate::workflow::error::WorkflowError;
use crate::workflow::isa;
use crate::workflow::workload::Workload;

/// What is measured.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// All that integrate the forces of the plan, without.
    pub methods: Option<Vec<Method>>,
    /// 1e-4 to 1e-16, a decade apart, without.
    pub tolerances: Option<Vec<f64>>,
    /// The first so many samples.
    pub samples: u64,
    /// Whether only the states that the observables need are integrated.
    pub is_observed: bool,
    pub limits: Limits,
    /// Whether much work is allowed.
    pub is_allowed: bool,
}

/// What is told while it is measured.
#[derive(Debug)]
pub enum Told<'m> {
    /// What is measured, once.
    Begun(&'m [Finding]),
    Measured(&'m Measurement),
    /// What was not measured, and why.
    Omitted(&'m [Finding]),
}

/// The files that may be in `folder` afterwards.
pub fn outputs(folder: &Path) -> [PathBuf; 3] {
    ["parquet", "svg", "html"].map(|extension| folder.join(format!("precision.{extension}")))
}

/// Measures `plan`; the files that were written to `folder`.
///
/// # Errors
/// Where a method does not integrate what acts, no sample has a reference solution, the work is too much, or a file
/// cannot be written; those of `tell`.
pub fn measured(
    plan: &Plan,
    wanted: &Wanted,
    folder: &Path,
    tell: &mut dyn FnMut(Told<'_>) -> Result<(), WorkflowError>,
) -> Result<[PathBuf; 2], WorkflowError> {
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
