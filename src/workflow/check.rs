//! [`probed`]: estimates a campaign by a probe of its first samples.

use crate::analysis::observed::Observed;
use crate::analysis::part_columns::RowNames;
use crate::campaign::Plan;
use crate::ensemble::plausibility::implausible;
use crate::ensemble::probe::{AuditProbe, RunProbe};
use crate::ensemble::{Ensemble, influence, undefined};
use crate::findings::checked::Probed;
use crate::run::Status;
use crate::scene::Scene;
use crate::storage::rows_file;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::source::refuse_missing_law;
use crate::workflow::workload::Workload;

/// # Errors
/// An unphysical nominal scene, or a missing control law.
pub fn probed<'p>(ensemble: &'p Ensemble<'p>) -> Result<Probed<'p>> {
    let (plan, isa) = (ensemble.plan(), ensemble.isa());
    refuse_missing_law(plan)?;
    let scene = Scene::resolve(&plan.nominal)
        .map_err(|errors| WorkflowError::Input(errors.iter().map(|error| format!("{error}\n")).collect()))?;
    let runs = RunProbe::new(ensemble);
    let mut notes = plan.notes();
    notes.extend(implausible(plan));
    notes.extend(influence::notes(plan, isa));
    notes.extend(undefined::notes(plan, isa));
    notes.extend(undefined_observables(plan, &RowNames::new(ensemble), &runs));
    let Workload { disk, memory, .. } = Workload::of_campaign((ensemble, plan.rows()), None, None, None);
    Ok(Probed {
        ensemble,
        scene,
        runs,
        audits: (plan.audit_fraction > 0.0).then(|| AuditProbe::new(ensemble)),
        notes,
        files: [ensemble.parts().count(), rows_file::columns(ensemble).len() as u64],
        needs: [disk, memory],
        cores: std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get),
    })
}

/// A sentence per observable of the file that is not a number in runs of the probe.
fn undefined_observables(plan: &Plan, names: &RowNames, probe: &RunProbe) -> Vec<String> {
    let statuses = probe.rows.statuses();
    let own = plan.analysis.derived.iter().map(|derived| derived.name.as_str());
    let note = |observed: Observed| {
        let undefined = observed.undefined(&names.of(&probe.rows)).ok()?;
        let rows = (0..undefined.len()).filter(|row| undefined[*row] && statuses[*row] == Status::Done);
        let rows: Vec<usize> = rows.collect();
        let first = probe.rows.samples()[*rows.first()?];
        Some(format!(
            "[[observable]] {}: it is not a number in {} of the first {} samples, first in sample {first}: it is null \
             there, and leaves a requirement undecided",
            observed.quantity.name(),
            rows.len(),
            probe.count(),
        ))
    };
    Observed::named(plan, own).into_iter().filter_map(note).collect()
}
