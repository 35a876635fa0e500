//! [`Ensemble`]: a plan made ready to run; [`Worker`]: the memory in which one thread runs samples of it.

use std::slice::from_ref;
use std::sync::atomic::Ordering;
use std::sync::{Arc, OnceLock};

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::audit::Selection;
use crate::ensemble::bands::{BandLayout, PartBands};
use crate::ensemble::batch::{Batch, Means};
use crate::ensemble::end_finder::EndFinder;
use crate::ensemble::flights::{LawDraw, observe};
use crate::ensemble::parts::Part;
use crate::ensemble::rows::{Rows, Shape};
use crate::ensemble::run_cost::thread_seconds;
use crate::ensemble::settings::{EngineMaker, nominal, propagator};
use crate::ensemble::supervision::{Report, Supervision};
use crate::math::Isa;
use crate::observables::Request;
use crate::observables::band_reader::BandReader;
use crate::observables::band_series::band_series;
use crate::propagation::PropagationSettings;
use crate::sampling::SampleId;

/// Scenes that are drawn and propagated together: enough that lanes seldom wait for work (each of eight lanes is loaded
/// 16 times), few enough that scenes and workspace stay in the second-level cache.
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

    /// The same, with every run (the nominal one of the bands included) made by engines of the caller's own. Audits
    /// keep their reference solution. An engine must give a run that depends on its scene alone.
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
        let scene = nominal(self.plan);
        let mut kept = vec![f64::NAN; reader.columns()];
        let draw = LawDraw::nominal(self.plan);
        let ends = EndFinder::new(self.plan, (self.isa, self.own_engines));
        let end = ends.and_then(|mut ends| ends.end(&scene, draw.as_slice()));
        let (grid, end) = end.map_or_else(|| (self.plan.grid.clone(), usize::MAX), |end| end.grid(&self.plan.grid));
        let (means, mut ignored) = (self.means(), vec![f64::NAN; self.shape().observables]);
        let mut observer = means.observer(&grid);
        means.flights(&grid).fly(from_ref(&scene), draw.as_slice(), &mut |run, of_law| {
            observe(self.plan, &mut observer, self.isa, &scene, (&run, of_law), &mut ignored);
            kept.copy_from_slice(reader.kept(&observer, run.table, end));
        });
        let layout = Arc::new(BandLayout { series, times, nominal: kept });
        Some(PartBands::new(layout, reader, self.plan.last_counted()))
    }

    fn means(&self) -> Means<'p> {
        Means { plan: self.plan, request: self.request, isa: self.isa, own_engines: self.own_engines }
    }

    /// Memory for one thread. Allocates; running samples in it does not, once it is warm.
    pub fn worker(&self) -> Worker<'_> {
        let is_audited = self.plan.audit_fraction > 0.0;
        let batch = Batch::new(self.means(), self.plan.grid.clone());
        Worker {
            campaign: self,
            draws: SceneDraws::new(self.plan),
            batch: if is_audited { batch.audited() } else { batch },
            selection: is_audited.then(|| Selection::new(self.plan)),
        }
    }
}

/// The memory in which one thread runs samples. What an earlier sample left in it does not reach a later one.
pub struct Worker<'c> {
    campaign: &'c Ensemble<'c>,
    draws: SceneDraws<'c>,
    batch: Batch<'c>,
    /// Chooses those that are audited; `None` without audits.
    selection: Option<Selection>,
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

    /// Draws the samples of `batch`. One that is not physical keeps the row of [`Rows::start`]: `invalid_sample`.
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

    /// Notes what the law of the scene that was drawn last depends on, where the plan has a law.
    fn note_law(&mut self, sample: SampleId) {
        if self.campaign.plan.law.is_none() {
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

    /// Chooses the scenes of the batch that are audited.
    fn select(&mut self, rows: &Rows) {
        let Batch { is_selected, rows_of_scenes, .. } = &mut self.batch;
        is_selected.clear();
        let Some(selection) = &mut self.selection else { return };
        let samples = rows_of_scenes.iter().map(|row| rows.samples()[*row]);
        is_selected.extend(samples.map(|sample| selection.contains(sample)));
    }
}
