//! [`Ensemble`]: a plan ready to run; [`Worker`]: the memory of one thread.

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::audit::Selection;
use crate::ensemble::bands::{BandLayout, PartBands};
use crate::ensemble::batch::Batch;
use crate::ensemble::event_finder::EndFinder;
use crate::ensemble::flights::{LawDraw, Means, ObservedRuns, Runs};
use crate::ensemble::loop_errors::LoopErrors;
use crate::ensemble::parts::{Part, Parts};
use crate::ensemble::pilots::{Flown, Pilots, compared, measured};
use crate::ensemble::rows::{Rows, Shape};
use crate::ensemble::run_cost::{parts, run_seconds, thread_seconds};
use crate::ensemble::settings::{EngineMaker, Engines, nominal, propagator};
use crate::ensemble::supervision::{Alone, Crew, Report, Supervision};
use crate::math::Isa;
use crate::observables::band_reader::BandReader;
use crate::observables::band_series::band_series;
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::{Group, Request};
use crate::propagation::PropagationSettings;
use crate::run::Grid;
use crate::sampling::SampleId;
use std::sync::atomic::Ordering;
use std::sync::{Arc, OnceLock};

/// Scenes propagated together: each of eight lanes is loaded 16 times, and all fit the second-level cache.
pub const BATCH: usize = 128;

#[derive(Debug)]
pub struct Ensemble<'p> {
    means: Means<'p>,
    propagator: PropagationSettings,
    nominal: OnceLock<NominalRun>,
    /// Bands without runs, made on first use.
    bands: OnceLock<Option<PartBands>>,
    errors: OnceLock<LoopErrors>,
    seconds: Arc<OnceLock<f64>>,
}

/// What a campaign needs of its nominal run, flown once.
#[derive(Debug, Default)]
struct NominalRun {
    /// If angles from it are observed.
    attitude: Option<NominalAttitude>,
    /// If it was flown.
    own: Option<Flown>,
    /// The numbers of bands, if any.
    kept: Vec<f64>,
}

impl<'p> Ensemble<'p> {
    pub fn new(plan: &'p Plan, isa: Isa) -> Self {
        let means = Means::new(plan, Engines::of(isa));
        let propagator = propagator(plan, plan.grid.clone(), means.request.fields());
        Ensemble {
            means,
            propagator,
            nominal: OnceLock::new(),
            bands: OnceLock::new(),
            errors: OnceLock::new(),
            seconds: Arc::default(),
        }
    }

    /// With the caller's engines for all runs; audits keep their reference. A run must depend on its scene alone.
    pub fn with_engines(mut self, new_engine: EngineMaker) -> Self {
        self.means.engines.own = Some(new_engine);
        self
    }

    pub fn plan(&self) -> &'p Plan {
        self.means.plan
    }

    pub fn isa(&self) -> Isa {
        self.means.engines.isa
    }

    pub fn request(&self) -> &Request {
        &self.means.request
    }

    pub fn propagator(&self) -> &PropagationSettings {
        &self.propagator
    }

    pub fn shape(&self) -> Shape {
        Shape { parameters: self.plan().dispersions.columns().len(), observables: self.request().columns().len() }
    }

    pub fn rows(&self, capacity: usize) -> Rows {
        Rows::new(self.shape(), capacity).with_bands(self.bands().cloned())
    }

    /// Bands without runs, if the plan has any.
    pub fn bands(&self) -> Option<&PartBands> {
        self.bands.get_or_init(|| self.no_bands()).as_ref()
    }

    fn no_bands(&self) -> Option<PartBands> {
        let Means { plan, engines, .. } = self.means;
        let mut reader = self.band_reader()?;
        let series = reader.sources().iter().map(|source| (source.quantity.clone(), source.form)).collect();
        let times = plan.grid.evenly(plan.band_points).iter().map(|point| plan.grid.times()[*point]).collect();
        let (scene, draw) = (nominal(plan), LawDraw::nominal(plan));
        let end = EndFinder::new(plan, engines).and_then(|mut ends| ends.end(&scene, draw.as_slice()));
        let nominal = match end {
            None => self.nominal().kept.clone(),
            Some(end) => {
                let (grid, end) = end.grid(&plan.grid);
                let mut kept = Vec::new();
                self.nominal_runs(&grid).fly(Runs::one(&scene, draw.as_slice()), &mut |seen| {
                    kept = reader.kept(seen.observer, seen.run.table, end).to_vec();
                });
                kept
            }
        };
        let layout = Arc::new(BandLayout { series, times, nominal });
        Some(PartBands::new(layout, reader, plan.last_counted()))
    }

    /// `None` without bands.
    fn band_reader(&self) -> Option<BandReader> {
        let plan = self.plan();
        let (sources, points) = (band_series(self.request()), plan.grid.evenly(plan.band_points));
        (!points.is_empty() && !sources.is_empty()).then(|| BandReader::new(sources, points))
    }

    fn nominal_runs(&self, grid: &Grid) -> ObservedRuns<'p> {
        let fields = compared(self.request()).union(self.request().fields());
        self.means.runs_with(grid, fields, None).of_nominal(None)
    }

    fn nominal(&self) -> &NominalRun {
        self.nominal.get_or_init(|| {
            let (plan, mut reader, mut found) = (self.plan(), self.band_reader(), NominalRun::default());
            let has_attitude = self.request().groups.contains(Group::Motion);
            if has_attitude || reader.is_some() {
                let (scene, draw) = (nominal(plan), LawDraw::nominal(plan));
                self.nominal_runs(&plan.grid).fly(Runs::one(&scene, draw.as_slice()), &mut |seen| {
                    found.attitude = has_attitude.then(|| NominalAttitude::of(seen.run.table, seen.run.outcome));
                    found.own = plan.law.as_ref().map(|_| Flown::of(&seen.run, &[], &plan.grid));
                    if let Some(reader) = &mut reader {
                        found.kept = reader.kept(seen.observer, seen.run.table, usize::MAX).to_vec();
                    }
                });
            }
            found
        })
    }

    /// Without pilots: runs under a law are not judged by their estimates.
    #[must_use]
    pub fn unjudged(self) -> Self {
        Ensemble { errors: OnceLock::from(LoopErrors::UNMEASURED), ..self }
    }

    /// Keeps the time of a run where other ensembles of the plan find it.
    #[must_use]
    pub fn counted_in(self, seconds: Arc<OnceLock<f64>>) -> Self {
        Ensemble { seconds, ..self }
    }

    /// The longest time of a run on one core, s ([`run_seconds`]).
    pub fn run_seconds(&self) -> f64 {
        *self.seconds.get_or_init(|| run_seconds(self.plan(), self.isa()))
    }

    /// Its parts, sized by the cost of its runs.
    pub fn parts(&self) -> Parts {
        parts(self.plan(), || self.run_seconds())
    }

    fn errors(&self, crew: &dyn Crew) -> LoopErrors {
        *self.errors.get_or_init(|| {
            let (plan, isa) = (self.plan(), self.isa());
            let is_judged = self.request().groups.contains(Group::Numerics);
            let rows = [plan.rows() - plan.dispersed_rows(), plan.dispersed_rows()];
            let [nominal, drawn] = rows.map(|rows| is_judged && rows > 0);
            let pilots = if nominal { Pilots::of_nominal(plan, isa) } else { None };
            let nominal = pilots.map(|pilots| pilots.error(self.nominal().own.clone()));
            LoopErrors { nominal, ..measured(plan, isa, [false, drawn], crew) }
        })
    }

    /// Flies what is known before the first row, while it `is_on`; a callback is asked by `crew`.
    pub fn prepare(&self, is_on: &dyn Fn() -> bool, crew: &dyn Crew) {
        if is_on() {
            self.nominal();
        }
        if is_on() {
            self.bands();
        }
        if is_on() {
            self.errors(crew);
        }
    }

    /// Running samples does not allocate once warm.
    pub fn worker(&self) -> Worker<'_> {
        let plan = self.plan();
        let is_audited = plan.audit_fraction > 0.0;
        let nominal = self.nominal().attitude.clone();
        let batch = Batch::new(self.means, plan.grid.clone(), nominal, self.errors(&Alone));
        Worker {
            campaign: self,
            draws: SceneDraws::new(plan),
            batch: if is_audited { batch.audited() } else { batch },
            selection: is_audited.then(|| Selection::new(plan)),
        }
    }
}

/// The memory of one thread, independent of earlier samples.
pub struct Worker<'c> {
    campaign: &'c Ensemble<'c>,
    draws: SceneDraws<'c>,
    batch: Batch<'c>,
    selection: Option<Selection>,
}

impl Worker<'_> {
    /// Runs the samples of `part` into `rows`; false if abandoned.
    pub fn run(&mut self, part: Part, rows: &mut Rows, supervision: Supervision<'_>) -> bool {
        let plan = self.campaign.plan();
        rows.start(part, part.samples().map(|row| plan.sample(row.0)));
        for start in (0..part.count).step_by(BATCH) {
            if supervision.abandon.load(Ordering::Relaxed) {
                return false;
            }
            let end = part.count.min(start + BATCH);
            let begun = self.selection.as_ref().map(|_| thread_seconds());
            self.draw(start..end, rows);
            self.select(rows);
            let mut report = Report::new(supervision, end - start);
            self.batch.propagate(rows, &mut report);
            if let Some(begun) = begun {
                let done = thread_seconds();
                self.batch.audit(rows, &mut report);
                rows.add_seconds(done - begun, thread_seconds() - done);
            }
            report.finish();
        }
        rows.bands_mut().into_iter().for_each(PartBands::count);
        true
    }

    /// Draws samples; unphysical ones keep the row of [`Rows::start`]: `invalid_sample`.
    fn draw(&mut self, batch: std::ops::Range<usize>, rows: &mut Rows) {
        self.batch.rows_of_scenes.clear();
        for row in batch {
            let Batch { scenes, rows_of_scenes, .. } = &mut self.batch;
            let physical = self.draws.scene_at(rows.samples()[row], scenes, rows_of_scenes.len());
            rows.set_parameters(row, self.draws.applied());
            match physical {
                Ok(()) => {
                    self.note_law(rows.samples()[row]);
                    self.batch.rows_of_scenes.push(row);
                }
                Err(errors) => {
                    let errors: Vec<String> = errors.iter().map(ToString::to_string).collect();
                    rows.set_reason(row, errors.join("; "));
                }
            }
        }
    }

    fn note_law(&mut self, sample: SampleId) {
        if self.campaign.plan().law.is_none() {
            return;
        }
        let parameters = &self.draws.drawn().control;
        let Batch { draws_of_laws, rows_of_scenes, .. } = &mut self.batch;
        match draws_of_laws.get_mut(rows_of_scenes.len()) {
            Some(place) => {
                place.sample = sample;
                place.parameters.take_values(parameters);
            }
            None => draws_of_laws.push(LawDraw { sample, parameters: parameters.clone() }),
        }
    }

    fn select(&mut self, rows: &Rows) {
        let Batch { is_selected, rows_of_scenes, .. } = &mut self.batch;
        is_selected.clear();
        let Some(selection) = &mut self.selection else { return };
        let samples = rows_of_scenes.iter().map(|row| rows.samples()[*row]);
        is_selected.extend(samples.map(|sample| selection.contains(sample)));
    }
}
