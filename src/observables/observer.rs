//! [`Observer`]: reads the state table of one run and writes its row.

use fearless_simd::Simd;

use super::conditioning::{Conditioning, ErrorEstimate};
use super::exchange::{BodyEnergy, Exchange, exchange};
use super::group::Group;
use super::measure::measure;
use super::points::{MeasuredRun, SeriesTable};
use super::reduce::{Weights, reduce};
use super::reduction::{OrderStatistic, Reduction, ValueStatistic};
use super::request::{Request, SeriesSet, SeriesTask};
use super::rows::Source;
use super::spectrum::Spectrum;
use super::table::{DirectValue, Series, Value};
use crate::math::Isa;
use crate::math::isa::Work;
use crate::run::{Grid, LocalErrors, Outcome, StateField, StateTable, Status};
use crate::scene::Scene;

/// An error of the state, from the rounding of the input alone, above which a run is ill conditioned: a thousandth of a radian or
/// of the rate. No question that a campaign asks depends on less.
pub const MEANINGLESS: f64 = 1e-3;

/// Observes runs on one grid; one per worker, reused from run to run without allocating.
#[derive(Clone, Debug)]
pub struct Observer {
    request: Request,
    observed: SeriesSet,
    sources: Vec<Source>,
    tasks: Vec<SeriesTask>,
    /// The columns that show a statistic: place in the row, and slot.
    statistics: Vec<(usize, Slot)>,
    /// The columns that are relative to a scale: place in the row, and slot of the scale.
    relative: Vec<(usize, Slot)>,
    /// The columns that show a direct value, with their places in the row.
    direct_values: Vec<(usize, DirectValue)>,
    /// For each column whether a run that failed has it too.
    known_after_failure: Vec<bool>,
    shown: Vec<Series>,
    times: Vec<f64>,
    weights: Weights,
    spectrum: Option<Spectrum>,
    series: SeriesTable,
    values: Values,
    conditioning: Option<Box<Conditioning>>,
    estimate: ErrorEstimate,
    exchange: Exchange,
    /// Number of points of the run that was observed last.
    filled: usize,
}

/// The statistics of every series.
#[derive(Clone, Debug)]
struct Values(Box<[[f64; Reduction::COUNT]; Series::COUNT]>);

/// The index of a statistic among those of all series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Slot(usize);

impl Slot {
    const fn of((series, reduction): (Series, Reduction)) -> Self {
        Slot(series as usize * Reduction::COUNT + reduction.index())
    }
}

impl Values {
    #[inline(always)]
    fn get(&self, slot: Slot) -> f64 {
        self.0.as_flattened()[slot.0]
    }

    /// The value of a scale, or one where it is zero: errors are absolute there.
    #[inline(always)]
    fn scale(&self, slot: Slot) -> f64 {
        let scale = self.get(slot);
        if scale == 0.0 { 1.0 } else { scale }
    }
}

impl Observer {
    /// Observes what `request` asks for at the times of `grid`.
    pub fn new(request: Request, grid: &Grid) -> Self {
        let columns = request.columns();
        let observed = request.observed();
        let (mut statistics, mut relative) = (Vec::new(), Vec::new());
        let mut direct_values = Vec::new();
        for (place, column) in columns.iter().enumerate() {
            match column.value {
                Value::Of(series, reduction) => {
                    statistics.push((place, Slot::of((series, reduction))));
                    relative.extend(column.value.scale().map(|scale| (place, Slot::of(scale))));
                }
                Value::Direct(value) => direct_values.push((place, value)),
            }
        }
        Observer {
            request,
            observed,
            sources: Source::ALL.into_iter().filter(|source| observed.has_any_of(*source)).collect(),
            tasks: request.tasks(),
            statistics,
            relative,
            direct_values,
            known_after_failure: columns.iter().map(|column| column.value.is_known_after_failure()).collect(),
            shown: request.series(),
            times: grid.times().to_vec(),
            weights: Weights::of(grid),
            spectrum: if request.groups.contains(Group::Exchange) { Spectrum::of(grid) } else { None },
            series: SeriesTable::new(grid.points()),
            values: Values(Box::new([[f64::NAN; Reduction::COUNT]; Series::COUNT])),
            conditioning: request.groups.contains(Group::Numerics).then(|| Box::new(Conditioning::new())),
            estimate: ErrorEstimate::UNKNOWN,
            exchange: Exchange::UNKNOWN,
            filled: 0,
        }
    }

    /// What is observed.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Writes the values of [`Request::columns`], in that order, of the run whose states are in `table`.
    ///
    /// Of a run that is not [`Status::Done`] only step statistics and final state are numbers, the latter at the last point with
    /// finite values; everything else is NaN. Counts are whole numbers.
    ///
    /// # Panics
    /// Where the table lacks a field of [`Request::fields`] or has other points than the grid, the scene has no debris although
    /// the request says so, or `row` has another length than [`Request::columns`].
    pub fn observe(&mut self, isa: Isa, scene: &Scene, table: &StateTable, outcome: &Outcome, row: &mut [f64]) {
        assert_eq!(row.len(), self.known_after_failure.len(), "a row has one value a column");
        assert_eq!(table.points(), self.times.len(), "the table has the points of the grid");
        assert!(scene.mass.debris.is_some() || !self.request.debris, "a scene whose debris is observed has one");
        self.filled = outcome.points.min(table.points());
        if self.filled > 0 {
            isa.run(Observation { observer: self, scene, table, local_errors: &outcome.local_errors });
        }
        for (place, slot) in &self.statistics {
            row[*place] = self.values.get(*slot);
        }
        for (place, scale) in &self.relative {
            row[*place] /= self.values.scale(*scale);
        }
        let finished = FinishedRun { table, outcome, final_point: self.final_point(table) };
        for (place, value) in &self.direct_values {
            row[*place] = self.direct_value(*value, &finished);
        }
        if outcome.status != Status::Done {
            for (value, known) in row.iter_mut().zip(&self.known_after_failure) {
                *value = if *known { *value } else { f64::NAN };
            }
        }
    }

    /// The series of the run that was observed last, in the order of [`Request::series`], each with its values at the
    /// observation points that the run reached. Relative errors are divided by their scales, as in the row.
    pub fn series(&self) -> impl Iterator<Item = (Series, impl ExactSizeIterator<Item = f64> + '_)> + '_ {
        self.shown.iter().map(|series| {
            let scale = series.row().scale.map_or(1.0, |scale| self.values.scale(Slot::of(scale)));
            let stored = series.row().stored;
            let values = &self.series.column(*series)[..self.filled];
            (*series, values.iter().map(move |value| stored.shown(*value) / scale))
        })
    }

    /// The last point with finite rotational states, where the final state is observed.
    fn final_point(&self, table: &StateTable) -> Option<usize> {
        let finite = |point: &usize| {
            table.at::<3>(StateField::Rate, *point).iter().all(|x| x.is_finite())
                && table.at::<4>(StateField::Attitude, *point).iter().all(|x| x.is_finite())
                && table.at::<2>(StateField::WheelRates, *point).iter().all(|x| x.is_finite())
        };
        if self.request.groups.contains(Group::FinalState) { (0..self.filled).rev().find(finite) } else { None }
    }

    /// A value that is read and not reduced from a series.
    fn direct_value(&self, value: DirectValue, run: &FinishedRun<'_>) -> f64 {
        match value {
            DirectValue::WorkThrusters => run.last(StateField::Work, 0),
            DirectValue::WorkMotors => run.last(StateField::Work, 1),
            DirectValue::CorrelationWheel1 => self.exchange.correlations[0],
            DirectValue::CorrelationWheel2 => self.exchange.correlations[1],
            DirectValue::ExchangeFrequency => self.exchange.frequency,
            DirectValue::TimeReached => run.outcome.time,
            DirectValue::TimeFinal => run.final_point.map_or(f64::NAN, |point| self.times[point]),
            DirectValue::AttitudeW => run.final_state(StateField::Attitude, 0),
            DirectValue::AttitudeX => run.final_state(StateField::Attitude, 1),
            DirectValue::AttitudeY => run.final_state(StateField::Attitude, 2),
            DirectValue::AttitudeZ => run.final_state(StateField::Attitude, 3),
            DirectValue::RateX => run.final_state(StateField::Rate, 0),
            DirectValue::RateY => run.final_state(StateField::Rate, 1),
            DirectValue::RateZ => run.final_state(StateField::Rate, 2),
            DirectValue::WheelRate1 => run.final_state(StateField::WheelRates, 0),
            DirectValue::WheelRate2 => run.final_state(StateField::WheelRates, 1),
            DirectValue::Steps => run.outcome.effort.steps as f64,
            DirectValue::Rejected => run.outcome.effort.rejected as f64,
            DirectValue::Evaluations => run.outcome.effort.evaluations as f64,
            DirectValue::StateError => self.estimate.error,
            DirectValue::Amplification => self.estimate.amplification,
            DirectValue::IllConditioned => {
                f64::from(u8::from(self.estimate.amplification * f64::EPSILON > MEANINGLESS))
            }
        }
    }

    /// Reduces the observed series to statistics.
    #[inline(always)]
    fn reduce<S: Simd>(&mut self, simd: S) {
        for task in &self.tasks {
            let out = &mut self.values.0[task.series as usize];
            reduce(simd, &self.weights, self.series.column(task.series), task.passes, task.stored, out);
        }
    }

    /// Exchange between fuselage and wheels about the centre of mass.
    #[inline(always)]
    fn find_exchange<S: Simd>(&mut self, simd: S) {
        let (series, values) = (&self.series, &self.values);
        let body = |of: Series| BodyEnergy {
            column: series.column(of),
            mean: values.get(Slot::of((of, Reduction::Value(ValueStatistic::Mean)))),
            swing: values.get(Slot::of((of, Reduction::Value(ValueStatistic::PeakToPeak)))),
        };
        let total = values.get(Slot::of((Series::ComTotal, Reduction::Order(OrderStatistic::Max))));
        let wheels = [body(Series::ComWheel1), body(Series::ComWheel2)];
        let spectrum = self.spectrum.as_mut();
        self.exchange = exchange(simd, &self.weights, spectrum, total, body(Series::ComFuselage), wheels);
    }
}

/// A run as the direct values see it.
struct FinishedRun<'a> {
    table: &'a StateTable,
    outcome: &'a Outcome,
    /// The point of the final state, where there is one and it is observed.
    final_point: Option<usize>,
}

impl FinishedRun<'_> {
    fn last(&self, field: StateField, component: usize) -> f64 {
        self.table.column(field, component)[self.table.points() - 1]
    }

    fn final_state(&self, field: StateField, component: usize) -> f64 {
        self.final_point.map_or(f64::NAN, |point| self.table.column(field, component)[point])
    }
}

struct Observation<'a> {
    observer: &'a mut Observer,
    scene: &'a Scene,
    table: &'a StateTable,
    local_errors: &'a LocalErrors,
}

impl Work for Observation<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Observation { observer, scene, table, local_errors } = self;
        let debris = scene.mass.debris.as_ref().filter(|_| observer.request.debris);
        let (observed, points) = (observer.observed, observer.filled);
        let run = MeasuredRun { observed, sources: &observer.sources, mass: &scene.mass, debris, table, points };
        measure(simd, &run, &mut observer.series);
        observer.reduce(simd);
        if observer.request.groups.contains(Group::Exchange) {
            observer.find_exchange(simd);
        }
        if let Some(conditioning) = &mut observer.conditioning {
            observer.estimate = conditioning.estimate(simd, scene, table, &observer.times, points, local_errors);
        }
    }
}
