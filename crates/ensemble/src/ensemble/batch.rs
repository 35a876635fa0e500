//! [`Batch`]: scenes run together into rows.

use crate::ensemble::audit::Auditor;
use crate::ensemble::event_finder::{self, EventFinder, RunEnd};
use crate::ensemble::flights::{LawDraw, Means, ObservedRun, ObservedRuns, Runs};
use crate::ensemble::loop_errors::LoopErrors;
use crate::ensemble::rows::Rows;
use crate::ensemble::supervision::Report;
use crate::math::lanes::WIDTH;
use crate::observables::nominal_attitude::NominalAttitude;
use crate::propagation::CompletedRun;
use crate::run::{Grid, Status};
use crate::sampling::SampleId;
use crate::scene::Scene;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Scenes run together on one grid, independent of earlier batches.
pub(super) struct Batch<'p> {
    means: Means<'p>,
    grid: Grid,
    /// Number of the campaign's points: all, unless an event ends the runs.
    of_campaign: usize,
    /// One for each row; more may be left of earlier batches.
    pub scenes: Vec<Scene>,
    pub rows_of_scenes: Vec<usize>,
    pub is_selected: Vec<bool>,
    pub draws_of_laws: Vec<LawDraw>,
    is_done: Vec<bool>,
    ends: Vec<Option<RunEnd>>,
    nominal: Option<NominalAttitude>,
    runs: ObservedRuns<'p>,
    places_of_law: Range<usize>,
    report: Vec<f64>,
    events: Option<EventFinder<'p>>,
    first_of_events: usize,
    auditor: Option<Auditor<'p>>,
}

impl<'p> Batch<'p> {
    /// Running scenes allocates nothing once warm, unless an event ends them.
    pub fn new(means: Means<'p>, grid: Grid, nominal: Option<NominalAttitude>, errors: LoopErrors) -> Self {
        let Means { plan, request, engines } = means;
        Batch {
            of_campaign: grid.points(),
            scenes: Vec::new(),
            rows_of_scenes: Vec::new(),
            is_selected: Vec::new(),
            draws_of_laws: Vec::new(),
            is_done: Vec::new(),
            ends: Vec::new(),
            runs: means.runs_with(&grid, request.fields(), nominal.clone()).judged(errors),
            nominal,
            places_of_law: request.places_of_law(),
            report: vec![f64::NAN; request.places_of_law().len()],
            events: EventFinder::new(plan, &grid, engines),
            first_of_events: event_finder::places(plan, &request).start,
            auditor: None,
            means,
            grid,
        }
    }

    pub fn audited(self) -> Self {
        let auditor = Some(Auditor::new(self.means.plan, self.means.engines.isa, &self.grid).under(self.runs.errors));
        Batch { auditor, ..self }
    }

    pub fn audit(&mut self, rows: &mut Rows, report: &mut Report<'_>) {
        let Some(auditor) = &mut self.auditor else { return };
        let Means { plan, engines, .. } = self.means;
        let selected = |index: &usize| self.is_selected.get(*index).is_some_and(|is_selected| *is_selected);
        let selected: Vec<usize> = (0..self.rows_of_scenes.len()).filter(selected).collect();
        let has_law = plan.law.is_some();
        // loops that no event ends have one grid, and fly in lanes
        let together = |a: &usize, b: &usize| has_law && [a, b].iter().all(|index| self.ends[**index].is_none());
        for group in selected.chunk_by(together).flat_map(|group| group.chunks(WIDTH)) {
            let end = self.ends[group[0]];
            let of_end = |end: RunEnd| Auditor::new(plan, engines.isa, &end.grid(&self.grid).0).under(self.runs.errors);
            let mut of_end = end.map(of_end);
            let auditor = of_end.as_mut().unwrap_or(&mut *auditor);
            let rows_of_group: Vec<usize> = group.iter().map(|index| self.rows_of_scenes[*index]).collect();
            let scenes: Vec<Scene> = group.iter().map(|index| self.scenes[*index].clone()).collect();
            let draws: Vec<LawDraw> = if has_law {
                group.iter().map(|index| self.draws_of_laws[*index].clone()).collect()
            } else {
                Vec::new()
            };
            let statuses: Vec<Status> = rows_of_group.iter().map(|row| rows.statuses()[*row]).collect();
            let audits = auditor.audit_flown(Runs { scenes: &scenes, draws: &draws }, end, &statuses);
            for (row, audit) in rows_of_group.into_iter().zip(audits) {
                if let Err(why) = &audit {
                    rows.set_audit_reason(row, why.to_string());
                }
                rows.set_audit(row, audit.ok());
                report.add(u64::MAX);
            }
        }
    }

    /// Runs the scenes. After a panic, unfinished scenes run again one by one in new memory, so that it ends one run
    /// only.
    pub fn propagate(&mut self, rows: &mut Rows, report: &mut Report<'_>) {
        self.is_done.clear();
        self.is_done.resize(self.rows_of_scenes.len(), false);
        self.ends.clear();
        self.ends.resize(self.rows_of_scenes.len(), None);
        let all = 0..self.rows_of_scenes.len();
        let flown = catch_unwind(AssertUnwindSafe(|| self.propagate_some(all.clone(), rows, report)));
        self.report_laws(all.clone(), rows);
        let ended = flown.and_then(|()| catch_unwind(AssertUnwindSafe(|| self.end_runs(all.clone(), rows, report))));
        if ended.is_ok() {
            return;
        }
        for scene in all {
            if self.is_done[scene] {
                continue;
            }
            self.renew();
            let one = scene..scene + 1;
            let run = AssertUnwindSafe(|| {
                self.propagate_some(one.clone(), rows, report);
                self.report_laws(one.clone(), rows);
                self.end_runs(one, rows, report);
            });
            if let Err(panic) = catch_unwind(run) {
                let row = self.rows_of_scenes[scene];
                rows.set_result(row, Status::InternalError, &vec![f64::NAN; rows.shape().observables]);
                rows.set_reason(row, message(panic.as_ref()));
            }
        }
        self.renew();
    }

    fn renew(&mut self) {
        let Batch { means, grid, nominal, .. } = self;
        self.runs = means.runs_with(grid, means.request.fields(), nominal.clone()).judged(self.runs.errors);
    }

    fn report_laws(&mut self, which: Range<usize>, rows: &mut Rows) {
        let place = self.places_of_law.clone();
        for (run, scene) in which.enumerate().filter(|(_, scene)| self.is_done[*scene]) {
            let row = self.rows_of_scenes[scene];
            let status = rows.statuses()[row];
            if status == Status::Diverged {
                rows.set_reason(row, self.runs.flights.divergence(run));
            } else if !place.is_empty() && matches!(status, Status::Done | Status::Inaccurate) {
                self.runs.flights.report(run, &mut self.report);
                rows.set_observables(row, place.start, &self.report);
            }
        }
    }

    /// Runs scenes, except for ends by events ([`Batch::end_runs`]).
    fn propagate_some(&mut self, which: Range<usize>, rows: &mut Rows, report: &mut Report<'_>) {
        let (Means { plan, engines, .. }, first_scene) = (self.means, which.start);
        let has_law = plan.law.is_some();
        let draws = if has_law { &self.draws_of_laws[which.clone()] } else { &[] };
        let runs = Runs { scenes: &self.scenes[which.clone()], draws };
        let (rows_of_scenes, is_done) = (&self.rows_of_scenes[which], &mut self.is_done);
        let (is_selected, of_campaign) = (&self.is_selected, self.of_campaign);
        let events = &mut self.events;
        if let Some(events) = events {
            events.restart(runs.scenes.len());
        }
        self.runs.fly(runs, &mut |ObservedRun { run, status, observer, row: observed, .. }| {
            if events.as_mut().is_some_and(|events| events.look(&run, observer, status)) {
                return;
            }
            let CompletedRun { index, table, outcome, .. } = run;
            let row = rows_of_scenes[index];
            let sample = rows.samples()[row];
            rows.set_result(row, status, observed);
            is_done[first_scene + index] = true;
            let is_audited = is_selected.get(first_scene + index).is_some_and(|selected| *selected);
            if !is_audited {
                report.add(outcome.effort.evaluations);
            }
            if status == Status::Diverged {
                // the law gives the reason after the flight
            } else if status != Status::Done {
                rows.set_reason(row, observer.reason(status, outcome, observed));
            } else if sample > SampleId(0)
                && let Some(bands) = rows.bands_mut()
            {
                bands.add(engines.isa, sample, (observer, table), of_campaign);
            }
        });
        let Some(events) = events else { return };
        events.locate(runs);
        for (run, row) in rows_of_scenes.iter().enumerate() {
            self.ends[first_scene + run] = events.end(run);
            let is_done = self.is_done[first_scene + run];
            if is_done && matches!(rows.statuses()[*row], Status::Done | Status::Inaccurate) {
                let values: Vec<f64> = events.values(run).collect();
                rows.set_observables(*row, self.first_of_events, &values);
            }
        }
    }

    /// Flies scenes that events end again up to there, each in its own batch.
    fn end_runs(&mut self, which: Range<usize>, rows: &mut Rows, report: &mut Report<'_>) {
        for scene in which {
            let Some(end) = self.ends[scene].filter(|_| !self.is_done[scene]) else { continue };
            let (grid, of_campaign) = end.grid(&self.grid);
            let nominal = self.means.nominal_attitude(&grid);
            let mut own = Batch::new(self.means, grid, nominal, self.runs.errors);
            own.events = own.events.map(|events| events.ended_by(Some(end)));
            own.of_campaign = of_campaign;
            own.scenes.push(self.scenes[scene].clone());
            own.rows_of_scenes.push(self.rows_of_scenes[scene]);
            own.is_selected.extend(self.is_selected.get(scene));
            own.draws_of_laws.extend(self.draws_of_laws.get(scene).cloned());
            own.propagate(rows, report);
            self.is_done[scene] = true;
        }
    }
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    format!("the program failed in this run: {}", text.unwrap_or("no message"))
}
