//! `spindrift precision`: run time against error for every method and tolerance.

use std::path::{Path, PathBuf};

use crate::campaign::forces::allowed_methods;
use crate::cli::arguments::PrecisionOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::outputs::refuse_inputs;
use crate::cli::screen;
use crate::dynamics::effects::ForceModel;
use crate::ensemble::Ensemble;
use crate::ensemble::precision::{Limits, Precision, States};
use crate::ensemble::runner::start_threads;
use crate::ensemble::settings::nominal;
use crate::findings;
use crate::findings::number::counted;
use crate::propagation::Method;
use crate::report::figure_files::instead;
use crate::report::precision_figure::precision_figure;
use crate::report::screen::{measurement, paragraphs};
use crate::storage::precision_table::precision_table;
use crate::storage::{atomic, table_file};
use crate::workflow::isa;
use crate::workflow::source::plan_and_files;
use crate::workflow::workload::Workload;

pub fn run(options: &PrecisionOptions) -> Result<CommandOutcome, Failure> {
    let (plan, files) = plan_and_files(&options.file, options.changed.overrides())?;
    let isa = isa()?;
    start_threads().map_err(|error| Failure::Files(format!("cannot start the threads: {error}")))?;
    let model = ForceModel::of(&nominal(&plan));
    let methods = options
        .methods
        .clone()
        .unwrap_or_else(|| Method::ALL.into_iter().filter(|method| method.integrates(model)).collect());
    if let Some((method, allowed)) = methods.iter().find_map(|method| Some((method, allowed_methods(*method, model)?)))
    {
        return Err(Failure::Input(format!("--methods: {} must be {allowed}", method.name())));
    }
    let mut tolerances = options.tolerances.clone().unwrap_or_else(default_tolerances);
    tolerances.sort_by(|a, b| b.total_cmp(a));
    tolerances.dedup();
    let folder =
        options.out.clone().unwrap_or_else(|| PathBuf::from("results").join(format!("{}_precision", plan.name)));
    for extension in ["parquet", "svg", "html"] {
        refuse_inputs(&files.paths(), &[("--out", Some(&folder.join(format!("precision.{extension}"))))])?;
    }
    Workload::of_precision(&Ensemble::new(&plan, isa), options.samples.get()).check(&folder, options.yes, false)?;
    atomic::make_folder(&folder).map_err(Failure::files)?;

    let states = if options.observed { States::Observed } else { States::All };
    let samples = usize::try_from(options.samples.get()).unwrap_or(usize::MAX);
    let precision = Precision::new(&plan, isa, samples, states).map_err(|(sample, status)| {
        Failure::Input(format!("no reference solution of sample {sample}: it ended with {}", status.name()))
    })?;
    if precision.samples() == 0 {
        return Err(Failure::Input("no sample of this campaign is physical".to_owned()));
    }
    let limits = Limits { repeats: options.repeats.get(), limit: options.limit_s };
    let which = if options.observed { "observed" } else { "all" };
    let head = findings::precision::head(&plan, precision.samples(), [which, isa.name()]);
    screen::print(&(paragraphs(&[head], usize::MAX) + &measurement(None, screen::width())))?;
    let (mut measured, mut omitted) = (Vec::new(), Vec::new());
    for method in methods {
        let settings = precision.settings(method, &tolerances);
        let mut heard = Ok(());
        let skipped = precision.sweep(method, &settings, limits, &mut |found| {
            let printed = screen::print(&measurement(Some(&found), screen::width()));
            heard = std::mem::replace(&mut heard, Ok(())).and(printed);
            measured.push(found);
        });
        heard?;
        omitted.extend(skipped);
    }
    screen::print(&paragraphs(&findings::precision::omissions(&omitted, limits.limit), usize::MAX))?;

    let table = precision_table(&measured, isa.name());
    save(&folder, "parquet", |path| table_file::save(&plan, &table, path).map_err(Failure::files))?;
    let title = format!("{}: {}, {:?} s", plan.name, counted(precision.samples(), "sample"), plan.grid.duration());
    let figure = precision_figure(title, &measured);
    let written = figure.save(&folder.join("precision.svg")).map_err(Failure::files)?;
    let note = if written.extension().is_some_and(|found| found == "svg") {
        written.display().to_string()
    } else {
        instead(&written)
    };
    screen::note(&note);
    Ok(CommandOutcome::Done)
}

/// Writes one file of the result and says so.
fn save(folder: &Path, extension: &str, write: impl FnOnce(&Path) -> Result<(), Failure>) -> Result<(), Failure> {
    let path = folder.join(format!("precision.{extension}"));
    write(&path)?;
    screen::note(&path.display().to_string());
    Ok(())
}

/// 1e-4 to 1e-16, a decade apart.
fn default_tolerances() -> Vec<f64> {
    (4..=16).map(|digits| libm::pow(10.0, -f64::from(digits))).collect()
}
