//! [`Batch`]: scenes that are run together, and whatever makes rows of them.

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::campaign::Plan;
use crate::ensemble::audit::{Auditor, NoAudit};
use crate::ensemble::event_finder::{self, EventFinder};
use crate::ensemble::flights::{Flights, LawDraw, nominal_attitude, observe, replayed};
use crate::ensemble::rows::Rows;
use crate::ensemble::run_end::RunEnd;
use crate::ensemble::settings::{EngineMaker, propagator};
use crate::ensemble::supervision::Report;
use crate::math::Isa;
use crate::observables::{Observer, Request};
use crate::propagation::CompletedRun;
use crate::run::{Grid, Status};
use crate::sampling::SampleId;
use crate::scene::{Arc, Scene};

/// How runs are made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Means<'p> {
    pub plan: &'p Plan,
    /// What is observed.
    pub request: Request,
    pub isa: Isa,
    /// Makes the engines in place of those of the plan's method.
    pub own_engines: Option<EngineMaker>,
}

impl<'p> Means<'p> {
    /// Flights of runs that are observed on `grid`.
    pub fn flights(&self, grid: &Grid) -> Flights<'p> {
        let settings = propagator(self.plan, grid.clone(), self.request.fields());
        Flights::new(self.plan, &settings, (self.isa, self.own_engines))
    }

    /// An observer of runs on `grid`.
    pub fn observer(&self, grid: &Grid) -> Observer {
        let nominal = nominal_attitude(self.plan, &self.request, grid, self.isa);
        Observer::new(self.request, grid).with_nominal(nominal)
    }
}

/// Scenes that are run together, observed on one grid. What an earlier batch left in it does not reach a later one.
pub(super) struct Batch<'p> {
    means: Means<'p>,
    grid: Grid,
    /// How many points of the grid are points of the campaign: all, unless an event ends the runs there.
    of_campaign: usize,
    /// The scenes, of which there are as many as rows; more may be left of earlier batches.
    pub scenes: Vec<Scene>,
    /// The row of each scene.
    pub rows_of_scenes: Vec<usize>,
    /// Which scenes of the batch are audited; empty without audits.
    pub is_selected: Vec<bool>,
    /// What the laws of the scenes depend on; empty without a law.
    pub draws_of_laws: Vec<LawDraw>,
    /// Which scenes of the batch have ended.
    is_done: Vec<bool>,
    /// The events that end scenes.
    ends: Vec<Option<RunEnd>>,
    /// The arcs flown by the scenes of the batch that are audited; empty without a law.
    flown: Vec<Vec<Arc>>,
    flights: Flights<'p>,
    /// Where a row has what the law reports.
    places_of_law: Range<usize>,
    /// Finds the events of the runs; `None` where the plan has none.
    events: Option<EventFinder<'p>>,
    /// Where a row has what it finds.
    first_of_events: usize,
    observer: Observer,
    observed: Vec<f64>,
    auditor: Option<Auditor>,
}

impl<'p> Batch<'p> {
    /// An empty one, observed on `grid`. Allocates; running scenes in it does not, once it is warm, unless an event
    /// ends them.
    pub fn new(means: Means<'p>, grid: Grid) -> Self {
        // first: the engine of the nominal run is gone before that of the runs is made
        let observer = means.observer(&grid);
        let Means { plan, request, isa, own_engines } = means;
        Batch {
            of_campaign: grid.points(),
            scenes: Vec::new(),
            rows_of_scenes: Vec::new(),
            is_selected: Vec::new(),
            draws_of_laws: Vec::new(),
            is_done: Vec::new(),
            ends: Vec::new(),
            flown: Vec::new(),
            flights: means.flights(&grid),
            places_of_law: request.places_of_law(),
            events: EventFinder::new(plan, &grid, (isa, own_engines)),
            first_of_events: event_finder::places(plan, &request).start,
            observer,
            observed: vec![0.0; request.columns().len()],
            auditor: None,
            means,
            grid,
        }
    }

    /// The same with audits of the scenes that are selected.
    pub fn audited(self) -> Self {
        let auditor = Some(Auditor::new(self.means.plan, self.means.isa, &self.grid));
        Batch { auditor, ..self }
    }

    /// Audits the scenes of the batch that are selected.
    pub fn audit(&mut self, rows: &mut Rows, report: &mut Report<'_>) {
        let Some(auditor) = &mut self.auditor else { return };
        let Means { plan, isa, .. } = self.means;
        let scenes = self.scenes.iter().zip(&self.rows_of_scenes).zip(&self.is_selected).enumerate();
        for (index, ((scene, row), _)) in scenes.filter(|(_, (_, selected))| **selected) {
            let mut of_end = self.ends[index].map(|end| Auditor::new(plan, isa, &end.grid(&self.grid).0));
            let auditor = of_end.as_mut().unwrap_or(auditor);
            let status = rows.statuses()[*row];
            let audit = match self.flown.get(index) {
                // found beside the engine, which an audit flies alone
                _ if matches!(status, Status::Surface | Status::Diverged) => Err(NoAudit::Run(status)),
                // what the law decided is part of the run: its arcs are judged, and not the law flown again
                Some(arcs) => auditor.audit(&replayed(scene, arcs)),
                None => auditor.audit(scene),
            };
            if let Err(why) = &audit {
                rows.set_audit_reason(*row, why.to_string());
            }
            rows.set_audit(*row, audit.ok());
            report.add(u64::MAX);
        }
    }

    /// Runs the scenes of the batch. Where the program panics, those that had not ended are run again one by one in new
    /// memory, so that the panic is the end of one run only.
    pub fn propagate(&mut self, rows: &mut Rows, report: &mut Report<'_>) {
        self.flown.iter_mut().for_each(Vec::clear);
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
                rows.set_result(row, Status::InternalError, &vec![f64::NAN; self.observed.len()]);
                rows.set_reason(row, message(panic.as_ref()));
            }
        }
        self.renew();
    }

    /// Takes new memory in place of that in which the program has failed.
    fn renew(&mut self) {
        self.flights = self.means.flights(&self.grid);
        self.observer = self.means.observer(&self.grid);
    }

    /// Writes what the laws of the runs that have just ended report: those of the scenes `which` of the batch, flown
    /// together.
    fn report_laws(&mut self, which: Range<usize>, rows: &mut Rows) {
        let place = self.places_of_law.clone();
        for (run, scene) in which.enumerate().filter(|(_, scene)| self.is_done[*scene]) {
            let row = self.rows_of_scenes[scene];
            let status = rows.statuses()[row];
            if status == Status::Diverged {
                rows.set_reason(row, self.flights.divergence(run));
            } else if !place.is_empty() && matches!(status, Status::Done | Status::Inaccurate) {
                let values = &mut self.observed[place.clone()];
                self.flights.report(run, values);
                rows.set_observables(row, place.start, values);
            }
        }
    }

    /// Runs some scenes of the batch. Those that an event ends are not done then ([`Batch::end_runs`]).
    fn propagate_some(&mut self, which: Range<usize>, rows: &mut Rows, report: &mut Report<'_>) {
        let (Means { plan, isa, .. }, first_scene) = (self.means, which.start);
        let has_law = plan.law.is_some();
        let draws = if has_law { &self.draws_of_laws[which.clone()] } else { &[] };
        if has_law && !self.is_selected.is_empty() {
            self.flown.resize_with(self.flown.len().max(which.end), Vec::new);
        }
        let flown = &mut self.flown;
        let (scenes, rows_of_scenes) = (&self.scenes[which.clone()], &self.rows_of_scenes[which]);
        let (observer, observed, is_done) = (&mut self.observer, &mut self.observed, &mut self.is_done);
        let (is_selected, of_campaign) = (&self.is_selected, self.of_campaign);
        let events = &mut self.events;
        if let Some(events) = events {
            events.restart(scenes.len());
        }
        self.flights.fly(scenes, draws, &mut |run, of_law| {
            let CompletedRun { index, table, outcome, arcs } = run;
            let status = observe(plan, observer, isa, &scenes[index], (&run, of_law), observed);
            if events.as_mut().is_some_and(|events| events.look(&run, observer, status)) {
                return;
            }
            let row = rows_of_scenes[index];
            let sample = rows.samples()[row];
            rows.set_result(row, status, observed);
            is_done[first_scene + index] = true;
            // a run that is audited is done when its audit is
            let is_audited = is_selected.get(first_scene + index).is_some_and(|selected| *selected);
            if is_audited && let Some(flown) = flown.get_mut(first_scene + index) {
                flown.clear();
                flown.extend(arcs.iter());
            }
            if !is_audited {
                report.add(outcome.effort.evaluations);
            }
            if status == Status::Diverged {
                // its law knows why, when all have been flown
            } else if status != Status::Done {
                rows.set_reason(row, observer.reason(status, outcome, observed));
            } else if sample > SampleId(0)
                && let Some(bands) = rows.bands_mut()
            {
                bands.add(isa, sample, (observer, table), of_campaign);
            }
        });
        let Some(events) = events else { return };
        events.locate(scenes, draws);
        for (run, row) in rows_of_scenes.iter().enumerate() {
            self.ends[first_scene + run] = events.end(run);
            let is_done = self.is_done[first_scene + run];
            if is_done && matches!(rows.statuses()[*row], Status::Done | Status::Inaccurate) {
                let values: Vec<f64> = events.values(run).collect();
                rows.set_observables(*row, self.first_of_events, &values);
            }
        }
    }

    /// Runs those of the scenes `which` again that an event ends, up to there: each as the one scene of a batch of its
    /// own.
    fn end_runs(&mut self, which: Range<usize>, rows: &mut Rows, report: &mut Report<'_>) {
        for scene in which {
            let Some(end) = self.ends[scene].filter(|_| !self.is_done[scene]) else { continue };
            let (grid, of_campaign) = end.grid(&self.grid);
            let mut own = Batch::new(self.means, grid);
            own.events = own.events.map(|events| events.ended_by(Some(end)));
            own.of_campaign = of_campaign;
            own.scenes.push(self.scenes[scene].clone());
            own.rows_of_scenes.push(self.rows_of_scenes[scene]);
            own.is_selected.extend(self.is_selected.get(scene));
            own.draws_of_laws.extend(self.draws_of_laws.get(scene).cloned());
            own.propagate(rows, report);
            self.is_done[scene] = true;
            if let (Some(flown), Some(of_end)) = (self.flown.get_mut(scene), own.flown.pop()) {
                *flown = of_end;
            }
        }
    }
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    format!("the program failed in this run: {}", text.unwrap_or("no message"))
}
