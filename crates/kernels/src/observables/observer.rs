//! [`Observer`]: writes the row of a run from its state table.

use core::ops::Range;

use fearless_simd::Simd;

use super::accuracy::Accuracy;
use super::acting::Acting;
use super::band_series::BandSeries;
use super::conditioning::{Conditioning, ErrorEstimate, ObservedStates};
use super::exchange::{BodyEnergy, Exchange, exchange};
use super::finished_run::{FinishedRun, final_point, principal_moments};
use super::group::Group;
use super::loop_error::LoopError;
use super::measure::measure;
use super::nominal_attitude::NominalAttitude;
use super::points::{Magnetism, MeasuredRun, SeriesTable};
use super::reduce::reduce;
use super::reduction::{OrderStatistic, Reduction, ValueStatistic};
use super::request::{Request, SeriesSet, SeriesTask};
use super::row_plan::{RowPlan, Slot, Statistics};
use super::rows::SeriesSource;
use super::spectrum::Spectrum;
use super::table::Series;
use super::weights::Weights;
use super::window::Window;
use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::effects::magnetic_torque;
use crate::dynamics::magnetic_field::MagneticField;
use crate::math::Isa;
use crate::math::isa::Work;
use crate::run::{Grid, Outcome, StateTable, Status, points_to};
use crate::scene::Scene;

/// A run under a law.
#[derive(Clone, Copy, Debug)]
pub struct FlownRun<'a> {
    /// Its scene, whose schedule does not count.
    pub scene: &'a Scene,
    /// Its arcs.
    pub arcs: &'a ArcRecord,
    /// Records of the law at the points, by series ([`super::LawSeries`]); empty without records.
    pub of_law: &'a [f64],
}

/// Observes runs on one grid; one per worker, without allocation.
#[derive(Clone, Debug)]
pub struct Observer {
    request: Request,
    observed: SeriesSet,
    sources: Vec<SeriesSource>,
    tasks: Vec<SeriesTask>,
    plan: RowPlan,
    shown: Vec<Series>,
    times: Vec<f64>,
    weights: Weights,
    /// Weights of the last run if its law ended it early.
    ended_weights: Option<Weights>,
    spectrum: Option<Spectrum>,
    series: SeriesTable,
    statistics: Statistics,
    conditioning: Option<Box<Conditioning>>,
    estimate: ErrorEstimate,
    debris_estimate: ErrorEstimate,
    exchange: Exchange,
    nominal: Option<NominalAttitude>,
    windows: Vec<(Window, Range<usize>)>,
    accuracy: Accuracy,
    /// Errors of the next run under a law.
    loop_error: Option<LoopError>,
    filled: usize,
}

impl Observer {
    /// An observer of `request` at the times of `grid`.
    pub fn new(request: Request, grid: &Grid) -> Self {
        let observed = request.observed();
        Observer {
            request,
            observed,
            sources: SeriesSource::ALL.into_iter().filter(|source| observed.has_any_of(*source)).collect(),
            tasks: request.tasks(),
            plan: RowPlan::of(&request),
            shown: request.series(),
            times: grid.times().to_vec(),
            weights: Weights::of(grid),
            ended_weights: None,
            spectrum: if request.groups.contains(Group::Exchange) { Spectrum::of(grid) } else { None },
            series: SeriesTable::new(grid.points()),
            statistics: Statistics::unknown(),
            conditioning: request.groups.contains(Group::Numerics).then(|| Box::new(Conditioning::new())),
            estimate: ErrorEstimate::UNKNOWN,
            debris_estimate: ErrorEstimate::UNKNOWN,
            exchange: Exchange::UNKNOWN,
            nominal: None,
            windows: request.windows.iter().map(|window| (*window, window.points(grid.times()))).collect(),
            accuracy: Accuracy::new(&request),
            loop_error: None,
            filled: 0,
        }
    }

    /// Adds the attitude of the nominal run on the same grid; angles from it are NaN otherwise.
    #[must_use]
    pub fn with_nominal(self, nominal: Option<NominalAttitude>) -> Self {
        Observer { nominal, ..self }
    }

    /// Sets the attitude of the nominal run on the same grid for the next runs.
    pub fn set_nominal(&mut self, nominal: NominalAttitude) {
        self.nominal = Some(nominal);
    }

    /// Sets the errors that the next runs under laws carry on; unknown errors (`None`) are not judged.
    pub fn set_loop_error(&mut self, of_loop: Option<LoopError>) {
        self.loop_error = of_loop;
    }

    /// The request.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Writes the values of [`Request::columns`] for the run of `scene` by its own schedule with the states `table`.
    ///
    /// Returns the status of `outcome`, or [`Status::Inaccurate`] for a complete run with errors beyond any use
    /// ([`super::accuracy`]), whose row is complete. A run ended by its law ([`crate::scene::Actuation::ends_run`])
    /// counts up to there. Runs of any other status than [`Status::Done`] have step statistics, mass properties and the
    /// last finite state only, else NaN.
    ///
    /// # Panics
    /// If the table lacks a field of [`Request::fields`] or differs from the grid in its points, if the requested
    /// debris is missing, or if `row` and [`Request::columns`] differ in length.
    pub fn observe(
        &mut self,
        isa: Isa,
        scene: &Scene,
        table: &StateTable,
        outcome: &Outcome,
        row: &mut [f64],
    ) -> Status {
        self.observe_acting(isa, Acting::scheduled(scene), &[], table, outcome, row)
    }

    /// [`Observer::observe`] for a run under a law.
    ///
    /// # Panics
    /// As [`Observer::observe`].
    pub fn observe_flown(
        &mut self,
        isa: Isa,
        run: &FlownRun<'_>,
        table: &StateTable,
        outcome: &Outcome,
        row: &mut [f64],
    ) -> Status {
        self.observe_acting(isa, Acting::flown(run.scene, run.arcs), run.of_law, table, outcome, row)
    }

    fn observe_acting(
        &mut self,
        isa: Isa,
        acting: Acting<'_>,
        of_law: &[f64],
        table: &StateTable,
        outcome: &Outcome,
        row: &mut [f64],
    ) -> Status {
        assert_eq!(row.len(), self.plan.columns(), "a row has one value a column");
        assert_eq!(table.points(), self.times.len(), "the table has the points of the grid");
        let has_debris = acting.scene().mass.debris.is_some();
        assert!(has_debris || !self.request.debris, "a scene whose debris is observed has one");
        let end = acting.end();
        let observed = end.map_or(self.times.len(), |end| points_to(&self.times, end));
        self.filled = outcome.points.min(observed);
        let is_ended = self.filled == observed && observed < self.times.len();
        self.ended_weights = is_ended.then(|| Weights::at(&self.times[..observed]));
        if self.filled > 0 {
            isa.run(Observation { observer: self, acting, of_law, table, outcome });
        }
        let is_final_observed = self.request.groups.contains(Group::FinalState);
        let mass = &acting.scene().mass;
        let is_mass_observed = self.request.groups.contains(Group::MassProperties);
        let run = FinishedRun {
            table,
            outcome,
            time_reached: end.map_or(outcome.time, |end| end.min(outcome.time)),
            filled: self.filled,
            times: &self.times,
            final_point: if is_final_observed { final_point(table, self.filled) } else { None },
            exchange: self.exchange,
            estimate: self.estimate,
            debris_estimate: self.debris_estimate,
            mass,
            moments: if is_mass_observed { principal_moments(mass) } else { [f64::NAN; 3] },
        };
        self.plan.fill(&self.statistics, |value, wheel| run.value(value, usize::from(wheel)), row);
        let of_windows = row.len() - self.windows.len();
        for (value, (window, points)) in row[of_windows..].iter_mut().zip(&self.windows) {
            let scale = self.statistics.scale(window.series.row().scale);
            let column = &self.series.column(window.series)[..self.filled];
            *value = window.extreme(column, points.start..points.end.min(self.filled), scale);
        }
        if outcome.status != Status::Done {
            self.plan.clear_unknown(row);
            return outcome.status;
        }
        let is_judged = !acting.is_flown() || self.loop_error.is_some_and(|of_loop| !of_loop.outcomes_agree);
        if self.accuracy.holds(row, is_judged) { Status::Done } else { Status::Inaccurate }
    }

    /// Why the run of `row`, with the status from [`Observer::observe`], is not `ok`; else empty.
    pub fn reason(&self, status: Status, outcome: &Outcome, row: &[f64]) -> String {
        match status {
            Status::Inaccurate => self.accuracy.reason(row),
            other => other.reason(outcome.time).unwrap_or_default(),
        }
    }

    /// Series of the last run, as [`Request::series`], at the points reached; relative errors are divided by their
    /// scales.
    pub fn series(&self) -> impl Iterator<Item = (Series, impl ExactSizeIterator<Item = f64> + '_)> + '_ {
        self.shown.iter().map(|series| {
            let scale = self.statistics.scale(series.row().scale);
            let stored = series.row().stored;
            let values = &self.series.column(*series)[..self.filled];
            (*series, values.iter().map(move |value| stored.shown(*value) / scale))
        })
    }

    #[inline(always)]
    pub(super) fn reached(&self) -> usize {
        self.filled
    }

    /// Stored numbers of a series at the points reached, and their divisor.
    #[inline(always)]
    pub(super) fn observed_column(&self, band: &BandSeries) -> (&[f64], f64) {
        (&self.series.column(band.series)[..self.filled], self.statistics.scale(band.scale))
    }

    #[inline(always)]
    fn reduce<S: Simd>(&mut self, simd: S) {
        let weights = self.ended_weights.as_ref().unwrap_or(&self.weights);
        for task in &self.tasks {
            let scale = self.statistics.scale(task.scale);
            let out = self.statistics.of(task.series);
            reduce(simd, weights, self.series.column(task.series), task.passes, task.stored, scale, out);
        }
    }

    #[inline(always)]
    fn find_exchange<S: Simd>(&mut self, simd: S) {
        let (series, values) = (&self.series, &self.statistics);
        let body = |of: Series| BodyEnergy {
            column: series.column(of),
            mean: values.get(Slot::of((of, Reduction::Value(ValueStatistic::Mean)))),
            swing: values.get(Slot::of((of, Reduction::Value(ValueStatistic::PeakToPeak)))),
        };
        let total = values.get(Slot::of((Series::ComTotal, Reduction::Order(OrderStatistic::Max))));
        let wheels = (0..self.request.wheels.len()).map(|wheel| body(Series::ComWheel.of_wheel(wheel)));
        // a spectrum needs the whole grid
        let spectrum = self.spectrum.as_mut().filter(|_| self.ended_weights.is_none());
        let weights = self.ended_weights.as_ref().unwrap_or(&self.weights);
        self.exchange = exchange(simd, weights, spectrum, total, body(Series::ComBody), wheels);
    }
}

struct Observation<'a> {
    observer: &'a mut Observer,
    acting: Acting<'a>,
    of_law: &'a [f64],
    table: &'a StateTable,
    outcome: &'a Outcome,
}

impl Work for Observation<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Observation { observer, acting, of_law, table, outcome } = self;
        let scene = acting.scene();
        let debris = scene.mass.debris.as_ref().filter(|_| observer.request.debris);
        let (observed, points) = (observer.observed, observer.filled);
        let nutation_axis =
            if observed.has(Series::Nutation) { observer.request.nutation_axis.of(scene.mass.inertia) } else { None };
        let magnetism = magnetic_torque::residual_dipole(scene)
            .and_then(|dipole| Some(Magnetism { field: MagneticField::of(scene)?, dipole, acting }));
        let run = MeasuredRun {
            observed,
            sources: &observer.sources,
            debris,
            nominal: observer.nominal.as_ref(),
            nutation_axis,
            magnetism,
            scene,
            times: &observer.times,
            of_law,
            table,
            points,
        };
        measure(simd, &run, &mut observer.series);
        observer.reduce(simd);
        if observer.request.groups.contains(Group::Exchange) {
            observer.find_exchange(simd);
        }
        if let Some(conditioning) = &mut observer.conditioning {
            let states = ObservedStates { table, times: &observer.times, filled: points, local: &outcome.local_errors };
            observer.estimate = match observer.loop_error {
                Some(of_loop) if acting.is_flown() => {
                    of_loop.estimate(table, &observer.times, points, &outcome.local_errors)
                }
                None if acting.is_flown() => ErrorEstimate::UNKNOWN,
                _ => conditioning.estimate(simd, acting, states),
            };
            if let Some(body) = debris {
                let states = ObservedStates { local: &outcome.debris_errors, ..states };
                observer.debris_estimate = conditioning.estimate_debris(simd, body.inertia, states);
            }
        }
    }
}
