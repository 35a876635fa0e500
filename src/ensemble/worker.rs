//! [`Ensemble`]: a plan made ready to run; [`Worker`]: the memory in which one thread runs samples of it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::sync::{Arc, OnceLock};

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::audit::{Auditor, Selection};
use crate::ensemble::bands::{BandLayout, PartBands};
use crate::ensemble::event_finder::{self, EventFinder};
use crate::ensemble::flights::{Flights, LawDraw, nominal_attitude, observe, replayed};
use crate::ensemble::parts::Part;
use crate::ensemble::rows::{Rows, Shape};
use crate::ensemble::run_cost::thread_seconds;
use crate::ensemble::settings::{EngineMaker, nominal, propagator};
use crate::ensemble::supervision::{Report, Supervision};
use crate::math::Isa;
use crate::observables::band_reader::BandReader;
use crate::observables::band_series::band_series;
use crate::observables::{Observer, Request};
use crate::propagation::PropagationSettings;
use crate::propagation::{CompletedRun, Engine};
use crate::run::Status;
use crate::sampling::SampleId;
use crate::scene::Scene;

/// Scenes that are drawn and propagated together: enough that lanes seldom wait for work (each of eight lanes is loaded 16 times), few
/// enough that scenes and workspace stay in the second-level cache.
pub const BATCH: usize = 128;

/// A plan made ready to run.
#[derive(Debug)]
pub struct Ensemble<'p> {
    plan: &'p Plan,
    isa: Isa,
    request: Request,
    propagator: PropagationSettings,
    /// Makes the engines of the workers in place of those of the plan's method.
    own_engines: Option<EngineMaker>,
    /// The bands of no run yet, made where they are asked for first: they need the nominal run.
    bands: OnceLock<Option<PartBands>>,
}

impl<'p> Ensemble<'p> {
    /// `plan`, to be run on `isa`.
    pub fn new(plan: &'p Plan, isa: Isa) -> Self {
        let request = plan.request();
        let propagator = propagator(plan, plan.grid.clone(), request.fields());
        Ensemble { plan, isa, request, propagator, own_engines: None, bands: OnceLock::new() }
    }

    /// The same, with every run (the nominal one of the bands included) made by engines of the caller's own. Audits keep their reference
    /// solution. An engine must give a run that depends on its scene alone.
    pub fn with_engines(mut self, new_engine: EngineMaker) -> Self {
        self.own_engines = Some(new_engine);
        self
    }

    pub fn plan(&self) -> &'p Plan {
        self.plan
    }

    /// The instruction set that it is run on.
    pub fn isa(&self) -> Isa {
        self.isa
    }

    pub fn request(&self) -> &Request {
        &self.request
    }

    pub fn propagator(&self) -> &PropagationSettings {
        &self.propagator
    }

    /// What columns a row has.
    pub fn shape(&self) -> Shape {
        Shape { parameters: self.plan.dispersions.columns().len(), observables: self.request.columns().len() }
    }

    /// Rows of parts of up to `capacity` samples, with bands where the campaign has them.
    pub fn rows(&self, capacity: usize) -> Rows {
        Rows::new(self.shape(), capacity).with_bands(self.bands().cloned())
    }

    /// The bands of no run; `None` where the plan asks for none, or observes no quantity that has bands.
    pub fn bands(&self) -> Option<&PartBands> {
        self.bands.get_or_init(|| self.no_bands()).as_ref()
    }

    fn no_bands(&self) -> Option<PartBands> {
        let points = self.plan.grid.evenly(self.plan.band_points);
        let sources = band_series(&self.request);
        if points.is_empty() || sources.is_empty() {
            return None;
        }
        let series = sources.iter().map(|source| (source.quantity.clone(), source.form)).collect();
        let times = points.iter().map(|point| self.plan.grid.times()[*point]).collect();
        let mut reader = BandReader::new(sources, points);
        let (scene, mut observer) = (nominal(self.plan), self.observer());
        let mut ignored = vec![f64::NAN; self.shape().observables];
        let mut kept = vec![f64::NAN; reader.columns()];
        self.flights().fly_nominal(&mut |run, of_law| {
            observe(self.plan, &mut observer, self.isa, &scene, (&run, of_law), &mut ignored);
            kept.copy_from_slice(reader.kept(&observer, run.table));
        });
        let layout = Arc::new(BandLayout { series, times, nominal: kept });
        Some(PartBands::new(layout, reader, self.plan.last_counted()))
    }

    fn engine(&self) -> Box<dyn Engine> {
        match self.own_engines {
            Some(new_engine) => new_engine(&self.propagator, self.isa),
            None => self.propagator.engine(self.isa),
        }
    }

    fn flights(&self) -> Flights<'p> {
        Flights::new(self.plan, self.engine(), &self.plan.grid)
    }

    fn observer(&self) -> Observer {
        let (plan, grid) = (self.plan, &self.plan.grid);
        Observer::new(self.request, grid).with_nominal(nominal_attitude(plan, &self.request, grid, self.isa))
    }

    /// Memory for one thread. Allocates; running samples in it does not, once it is warm.
    pub fn worker(&self) -> Worker<'_> {
        // first: the engine of the nominal run is gone before that of the runs is made
        let observer = self.observer();
        Worker {
            campaign: self,
            draws: SceneDraws::new(self.plan),
            scenes: Vec::new(),
            rows_of_scenes: Vec::with_capacity(BATCH),
            is_done: Vec::with_capacity(BATCH),
            is_selected: Vec::with_capacity(BATCH),
            draws_of_laws: Vec::new(),
            flown: Vec::new(),
            flights: self.flights(),
            places_of_law: self.request.places_of_law(),
            events: EventFinder::new(self.plan, &self.plan.grid, (self.isa, self.own_engines)),
            first_of_events: event_finder::places(self.plan, &self.request).start,
            observer,
            observed: vec![0.0; self.shape().observables],
            audits: (self.plan.audit_fraction > 0.0)
                .then(|| (Selection::new(self.plan), Auditor::new(self.plan, self.isa, &self.plan.grid))),
        }
    }
}

/// The memory in which one thread runs samples. What an earlier sample left in it does not reach a later one.
pub struct Worker<'c> {
    campaign: &'c Ensemble<'c>,
    draws: SceneDraws<'c>,
    scenes: Vec<Scene>,
    /// The row of each scene.
    rows_of_scenes: Vec<usize>,
    /// Which scenes of the batch have ended.
    is_done: Vec<bool>,
    /// Which scenes of the batch are audited; empty without audits.
    is_selected: Vec<bool>,
    /// What the laws of the scenes depend on; empty without a law.
    draws_of_laws: Vec<LawDraw>,
    /// The arcs flown by the scenes of the batch that are audited; empty without a law.
    flown: Vec<Vec<crate::scene::Arc>>,
    flights: Flights<'c>,
    /// Where a row has what the law reports.
    places_of_law: std::ops::Range<usize>,
    /// Finds the events of the runs; `None` where the plan has none.
    events: Option<EventFinder<'c>>,
    /// Where a row has what it finds.
    first_of_events: usize,
    observer: Observer,
    observed: Vec<f64>,
    audits: Option<(Selection, Auditor)>,
}

impl Worker<'_> {
    /// Runs the samples of `part` and writes their rows; false where it was given up.
    pub fn run(&mut self, part: Part, rows: &mut Rows, supervision: Supervision<'_>) -> bool {
        let plan = self.campaign.plan;
        rows.start_with(part, part.samples().map(|row| plan.sample(row.0)));
        for start in (0..part.count).step_by(BATCH) {
            if supervision.abandon.load(Ordering::Relaxed) {
                return false;
            }
            let end = part.count.min(start + BATCH);
            let begun = self.audits.as_ref().map(|_| thread_seconds());
            self.draw(start..end, rows);
            self.select(rows);
            let mut report = Report::new(supervision, end - start);
            self.propagate(rows, &mut report);
            if let Some(begun) = begun {
                let done = thread_seconds();
                self.audit(rows, &mut report);
                rows.add_seconds(done - begun, thread_seconds() - done);
            }
            report.finish();
        }
        rows.bands_mut().into_iter().for_each(PartBands::count);
        true
    }

    /// Draws the samples of `batch`. One that is not physical keeps the row of [`Rows::start`]: `invalid_sample`.
    fn draw(&mut self, batch: std::ops::Range<usize>, rows: &mut Rows) {
        self.rows_of_scenes.clear();
        for row in batch {
            let physical = self.draws.scene_at(rows.samples()[row], &mut self.scenes, self.rows_of_scenes.len());
            rows.set_parameters(row, self.draws.applied());
            match physical {
                Ok(()) => {
                    self.note_law(rows.samples()[row]);
                    self.rows_of_scenes.push(row);
                }
                Err(errors) => {
                    let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
                    rows.set_reason(row, errors.join("; "));
                }
            }
        }
    }

    /// Notes what the law of the scene that was drawn last depends on, where the plan has a law.
    fn note_law(&mut self, sample: SampleId) {
        if self.campaign.plan.law.is_none() {
            return;
        }
        let parameters = &self.draws.drawn().control;
        match self.draws_of_laws.get_mut(self.rows_of_scenes.len()) {
            Some(place) => {
                place.sample = sample;
                place.parameters.take_values(parameters);
            }
            None => self.draws_of_laws.push(LawDraw { sample, parameters: parameters.clone() }),
        }
    }

    /// Chooses the scenes of the batch that are audited.
    fn select(&mut self, rows: &Rows) {
        self.is_selected.clear();
        let Some((selection, _)) = &mut self.audits else { return };
        let samples = self.rows_of_scenes.iter().map(|row| rows.samples()[*row]);
        self.is_selected.extend(samples.map(|sample| selection.contains(sample)));
    }

    /// Audits the scenes of the batch that are selected.
    fn audit(&mut self, rows: &mut Rows, report: &mut Report<'_>) {
        let Some((_, auditor)) = &mut self.audits else { return };
        let scenes = self.scenes.iter().zip(&self.rows_of_scenes).zip(&self.is_selected).enumerate();
        for (index, ((scene, row), _)) in scenes.filter(|(_, (_, selected))| **selected) {
            let audit = match self.flown.get(index) {
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

    /// Runs the scenes of the batch. Where the program panics, those that had not ended are run again one by one in new memory, so that
    /// the panic is the end of one run only.
    fn propagate(&mut self, rows: &mut Rows, report: &mut Report<'_>) {
        self.flown.iter_mut().for_each(Vec::clear);
        self.is_done.clear();
        self.is_done.resize(self.rows_of_scenes.len(), false);
        let all = 0..self.rows_of_scenes.len();
        let ended = catch_unwind(AssertUnwindSafe(|| self.propagate_some(all.clone(), rows, report)));
        self.report_laws(all.clone(), rows);
        if ended.is_ok() {
            return;
        }
        for scene in all {
            if self.is_done[scene] {
                continue;
            }
            self.flights = self.campaign.flights();
            self.observer = self.campaign.observer();
            let one = scene..scene + 1;
            if let Err(panic) = catch_unwind(AssertUnwindSafe(|| self.propagate_some(one, rows, report))) {
                let row = self.rows_of_scenes[scene];
                rows.set_result(row, Status::InternalError, &vec![f64::NAN; self.observed.len()]);
                rows.set_reason(row, message(panic.as_ref()));
            } else {
                self.report_laws(scene..scene + 1, rows);
            }
        }
        self.flights = self.campaign.flights();
        self.observer = self.campaign.observer();
    }

    /// Writes what the laws of the runs that have just ended report: those of the scenes `which` of the batch, flown together.
    fn report_laws(&mut self, which: std::ops::Range<usize>, rows: &mut Rows) {
        let place = self.places_of_law.clone();
        if place.is_empty() {
            return;
        }
        for (run, scene) in which.enumerate().filter(|(_, scene)| self.is_done[*scene]) {
            let row = self.rows_of_scenes[scene];
            if matches!(rows.statuses()[row], Status::Done | Status::Inaccurate) {
                let values = &mut self.observed[place.clone()];
                self.flights.report(run, values);
                rows.set_observables(row, place.start, values);
            }
        }
    }

    /// Runs some scenes of the batch.
    fn propagate_some(&mut self, which: std::ops::Range<usize>, rows: &mut Rows, report: &mut Report<'_>) {
        let (isa, first_scene) = (self.campaign.isa, which.start);
        let plan = self.campaign.plan;
        let has_law = plan.law.is_some();
        let draws = if has_law { &self.draws_of_laws[which.clone()] } else { &[] };
        if has_law && !self.is_selected.is_empty() {
            self.flown.resize_with(self.flown.len().max(which.end), Vec::new);
        }
        let flown = &mut self.flown;
        let (scenes, rows_of_scenes) = (&self.scenes[which.clone()], &self.rows_of_scenes[which]);
        let (observer, observed, is_done) = (&mut self.observer, &mut self.observed, &mut self.is_done);
        let is_selected = &self.is_selected;
        let events = &mut self.events;
        if let Some(events) = events {
            events.restart(scenes.len());
        }
        self.flights.fly(scenes, draws, &mut |run, of_law| {
            let CompletedRun { index, table, outcome, arcs } = run;
            let status = observe(plan, observer, isa, &scenes[index], (&run, of_law), observed);
            if let (Some(events), Status::Done | Status::Inaccurate) = (events.as_mut(), status) {
                events.look(index, observer, table);
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
            if status != Status::Done {
                rows.set_reason(row, observer.reason(status, outcome, observed));
            } else if sample > SampleId(0)
                && let Some(bands) = rows.bands_mut()
            {
                bands.add(isa, sample, observer, table);
            }
        });
        let Some(events) = events else { return };
        events.locate(scenes, draws);
        for (run, row) in rows_of_scenes.iter().enumerate() {
            if matches!(rows.statuses()[*row], Status::Done | Status::Inaccurate) {
                let values: Vec<f64> = events.values(run).collect();
                rows.set_observables(*row, self.first_of_events, &values);
            }
        }
    }
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    format!("the program failed in this run: {}", text.unwrap_or("no message"))
}
