//! [`GyrostatBatch`]: scenes as gyrostats: runs of the spacecraft, rotation of non-isotropic debris, and completion to
//! state tables.

use fearless_simd::Simd;

use super::arc_source::ArcSource;
use super::engine::{CompletedRun, CompletionCallback};
use super::settings::{PropagationSettings, observes_debris_rotation};
use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::debris;
use crate::dynamics::gyrostat::completion::complete;
use crate::dynamics::gyrostat::{Gyrostat, WITH_ATTITUDE};
use crate::dynamics::relative_orbit::RelativeOrbit;
use crate::run::{Grid, Outcome, StateTable, Trajectory};
use crate::scene::{Offsets, Scene};

#[derive(Clone, Debug)]
pub struct GyrostatBatch {
    runs: Vec<Gyrostat<f64>>,
    completion: StateCompletion,
}

#[derive(Clone, Debug)]
pub struct StateCompletion {
    grid: Grid,
    observes_debris_rotation: bool,
    debris_runs: Vec<Gyrostat<f64>>,
    debris_trajectories: Vec<Trajectory>,
    debris_outcomes: Vec<Outcome>,
    debris_is_integrated: bool,
    /// Motion of the debris near an orbit, if any.
    debris_orbit: Option<Box<RelativeOrbit>>,
    table: StateTable,
    arcs: ArcRecord,
}

impl GyrostatBatch {
    pub fn new(plan: &PropagationSettings) -> Self {
        GyrostatBatch {
            runs: Vec::new(),
            completion: StateCompletion {
                grid: plan.grid.clone(),
                observes_debris_rotation: observes_debris_rotation(plan.fields),
                debris_runs: Vec::new(),
                debris_trajectories: Vec::new(),
                debris_outcomes: Vec::new(),
                debris_is_integrated: false,
                debris_orbit: None,
                table: StateTable::new(plan.fields, plan.wheels, plan.grid.points()),
                arcs: ArcRecord::default(),
            },
        }
    }

    /// The runs of `scenes` before their first arcs, which `arcs` provides, and their completion.
    pub fn load(&mut self, scenes: &[Scene], arcs: &ArcSource<'_>) -> (&mut [Gyrostat<f64>], &mut StateCompletion) {
        while self.runs.len() < scenes.len() {
            self.runs.push(Gyrostat::blank(0.0));
        }
        for (index, (run, scene)) in self.runs.iter_mut().zip(scenes).enumerate() {
            run.reset(0.0, scene);
            arcs.prepare(index, run);
        }
        (&mut self.runs[..scenes.len()], &mut self.completion)
    }

    /// The debris of `scenes` as gyrostats without wheels, if a rotation is integrated.
    pub fn load_debris(&mut self, scenes: &[Scene]) -> Option<DebrisRuns<'_>> {
        let completion = &mut self.completion;
        let observes = completion.observes_debris_rotation;
        let StateCompletion { grid, debris_runs, debris_trajectories, debris_outcomes, debris_is_integrated, .. } =
            completion;
        let general = |scene: &Scene| scene.mass.debris.as_ref().is_some_and(|body| !debris::is_isotropic(body));
        *debris_is_integrated = observes && scenes.iter().any(general);
        if !*debris_is_integrated {
            return None;
        }
        while debris_runs.len() < scenes.len() {
            debris_runs.push(Gyrostat::blank(0.0));
            debris_trajectories.push(Trajectory::new(WITH_ATTITUDE, grid.points()));
            debris_outcomes.push(Outcome::NOTHING);
        }
        for (run, scene) in debris_runs.iter_mut().zip(scenes) {
            debris::set_rotation(run, scene);
        }
        let trajectories = &mut debris_trajectories[..scenes.len()];
        let outcomes = &mut debris_outcomes[..scenes.len()];
        Some(DebrisRuns { runs: &mut debris_runs[..scenes.len()], trajectories, outcomes })
    }
}

/// The debris of a batch of scenes.
pub struct DebrisRuns<'b> {
    /// Gyrostats without wheels, one for each scene.
    pub runs: &'b mut [Gyrostat<f64>],
    /// Their components.
    pub trajectories: &'b mut [Trajectory],
    /// Outcomes of their integration.
    pub outcomes: &'b mut [Outcome],
}

impl StateCompletion {
    /// Completes run `index` and passes it to `finish`.
    #[expect(clippy::too_many_arguments, reason = "one call per engine; a struct would be taken apart at once")]
    pub fn complete<S: Simd>(
        &mut self,
        simd: S,
        scenes: &[Scene],
        index: usize,
        run: &Gyrostat<f64>,
        trajectory: &Trajectory,
        outcome: &Outcome,
        finish: &mut CompletionCallback<'_>,
    ) {
        self.fill_table(simd, &scenes[index], index, run, trajectory);
        let arcs = if run.flown.is_empty() {
            self.arcs.clear();
            self.arcs.extend(run.arcs.iter().map(|arc| arc.arc));
            &self.arcs
        } else {
            &run.flown
        };
        let outcome = self.with_debris(outcome, &scenes[index], index);
        finish(CompletedRun { index, table: &self.table, outcome: &outcome, arcs });
    }

    /// Outcome of run `index` with its debris: the run ends with the first of both bodies.
    fn with_debris(&self, outcome: &Outcome, scene: &Scene, index: usize) -> Outcome {
        match &scene.mass.debris {
            Some(body) if debris::is_isotropic(body) => Outcome { debris_errors: debris::ISOTROPIC_ERRORS, ..*outcome },
            Some(_) if self.debris_is_integrated => {
                let debris = &self.debris_outcomes[index];
                let first = if debris.points < outcome.points { debris } else { outcome };
                let (status, time, points) = (first.status, first.time, first.points);
                Outcome { status, time, points, debris_errors: debris.local_errors, ..*outcome }
            }
            _ => *outcome,
        }
    }

    #[inline(never)]
    fn fill_table<S: Simd>(
        &mut self,
        simd: S,
        scene: &Scene,
        index: usize,
        run: &Gyrostat<f64>,
        trajectory: &Trajectory,
    ) {
        let StateCompletion {
            grid, debris_runs, debris_trajectories, debris_is_integrated, debris_orbit, table, ..
        } = self;
        if let (Some(orbit), Some(Offsets { debris, .. })) = (&run.orbit, &scene.offsets) {
            let relative = debris_orbit.get_or_insert_with(|| Box::new(RelativeOrbit::new(orbit, *debris)));
            relative.reset(orbit, *debris);
        }
        // called through closures, which are compiled separately: enter the instruction set again
        simd.vectorize(
            #[inline(always)]
            || {
                complete(simd, run, trajectory, grid, table);
                if let Some(body) = &scene.mass.debris {
                    match debris_orbit {
                        Some(relative) if scene.offsets.is_some() => {
                            debris::complete_orbit(relative, body.mass, grid, table);
                        }
                        _ => debris::complete_translation(simd, scene, grid, table),
                    }
                    if debris::is_isotropic(body) {
                        debris::complete_isotropic(simd, scene, grid, table);
                    } else if *debris_is_integrated {
                        let (run, states) = (&debris_runs[index], &debris_trajectories[index]);
                        debris::complete_rotation(simd, run, states, table);
                    }
                }
            },
        );
    }
}
