//! [`Observer`]: reads the state table of one run and writes its row.

use fearless_simd::Simd;

use super::columns::{DirectValue, Statistic, Value};
use super::conditioning::{Conditioning, ErrorEstimate};
use super::group::Group;
use super::measure::{Run, measure};
use super::points::SeriesTable;
use super::reduce::{Weights, correlations, errors, initial_and_max, slope, spread, transfer};
use super::request::{Request, SeriesSet};
use super::series::{Series, SeriesColumn};
use super::spectrum::Spectrum;
use crate::math::Isa;
use crate::math::isa::Work;
use crate::run::{Grid, StateField, StateTable};
use crate::run::{LocalErrors, Outcome, Status};
use crate::scene::Scene;

/// Swing of the fuselage's energy, relative to the total about the centre of mass, below which there is no exchange but only
/// rounding: some dozens of roundings of the total, as its sum of squares and the integration of omega leave them.
pub const EXCHANGE_FLOOR: f64 = 64.0 * f64::EPSILON;

/// An error of the state, from the rounding of the input alone, beyond which a run is ill conditioned: a thousandth of a radian
/// or of the rate, less than which no campaign's question turns on.
pub const MEANINGLESS: f64 = 1e-3;

/// Observes runs on one grid; one per worker, reused from run to run without allocating.
#[derive(Clone, Debug)]
pub struct Observer {
    request: Request,
    wanted: SeriesSet,
    exchange: bool,
    /// For each column the slot of its value.
    slots: Vec<u16>,
    /// For each column whether a run that failed has it too.
    survives: Vec<bool>,
    published: Vec<&'static SeriesColumn>,
    times: Vec<f64>,
    weights: Weights,
    spectrum: Option<Spectrum>,
    series: SeriesTable,
    values: Box<[f64; Value::SLOTS]>,
    conditioning: Option<Box<Conditioning>>,
    judgement: Option<ErrorEstimate>,
    /// Number of points of the run that was observed last.
    filled: usize,
}

impl Observer {
    /// Observes what `request` asks for at the times of `grid`.
    pub fn new(request: Request, grid: &Grid) -> Self {
        let columns = request.columns();
        let exchange = request.groups.contains(Group::Exchange);
        Observer {
            request,
            wanted: request.wanted(),
            exchange,
            slots: columns.iter().map(|column| column.value.slot() as u16).collect(),
            survives: columns.iter().map(|column| column.value.survives()).collect(),
            published: request.series(),
            times: grid.times().to_vec(),
            weights: Weights::of(grid),
            spectrum: if exchange { Spectrum::of(grid) } else { None },
            series: SeriesTable::new(grid.points()),
            values: Box::new([f64::NAN; Value::SLOTS]),
            conditioning: request.groups.contains(Group::Numerics).then(|| Box::new(Conditioning::new())),
            judgement: None,
            filled: 0,
        }
    }

    /// What is observed.
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Writes the values of [`Request::columns`], in that order, of the run that `table` holds.
    ///
    /// Of a run that is not [`Status::Done`] only effort and final state are numbers, the latter that of the last point that
    /// was filled with finite values; all else is NaN, and so is everything that is not finite by itself. Counts are whole.
    ///
    /// # Panics
    /// Where the table lacks a block of [`Request::blocks`] or has other points than the grid, the scene has no debris although
    /// the request says so, or `row` has another length than [`Request::columns`].
    pub fn observe(&mut self, isa: Isa, scene: &Scene, table: &StateTable, outcome: &Outcome, row: &mut [f64]) {
        assert_eq!(row.len(), self.slots.len(), "a row has one value a column");
        assert_eq!(table.points(), self.times.len(), "the table has the points of the grid");
        assert!(scene.mass.debris.is_some() || !self.request.debris, "a scene whose debris is observed has one");
        self.filled = outcome.points.min(table.points());
        if self.filled > 0 {
            isa.run(Observation { observer: self, scene, table, local_errors: &outcome.local_errors });
        }
        self.own(table, outcome);
        for (value, slot) in row.iter_mut().zip(&self.slots) {
            *value = self.values[*slot as usize];
        }
        if outcome.status != Status::Done {
            for (value, survives) in row.iter_mut().zip(&self.survives) {
                *value = if *survives { *value } else { f64::NAN };
            }
        }
    }

    /// The series of the run that was observed last, in the order of [`Request::series`], each with its column and its values
    /// at the observation points that the run reached. Relative errors are divided by their scales, as in the row.
    pub fn series(
        &self,
    ) -> impl Iterator<Item = (&'static SeriesColumn, impl ExactSizeIterator<Item = f64> + '_)> + '_ {
        self.published.iter().map(|column| {
            let scale = self.scale(column.series);
            let values = &self.series.column(column.series)[..self.filled];
            (*column, values.iter().map(move |value| value / scale))
        })
    }

    /// What the values of a series are divided by: the largest value of its scale, or one where that is zero or there is none.
    #[inline(always)]
    fn scale(&self, series: Series) -> f64 {
        let scale = series.scale().map_or(1.0, |of| self.values[Value::Of(of, Statistic::Max).slot()]);
        if scale == 0.0 { 1.0 } else { scale }
    }

    #[inline(always)]
    fn put(&mut self, series: Series, statistic: Statistic, value: f64) {
        self.values[Value::Of(series, statistic).slot()] = value;
    }

    #[inline(always)]
    fn put_own(&mut self, own: DirectValue, value: f64) {
        self.values[Value::DirectValue(own).slot()] = value;
    }

    /// Reduces the series to the numbers of the row.
    #[inline(always)]
    fn reduce<S: Simd>(&mut self, simd: S) {
        use Series::*;
        const BODIES: [Series; 7] =
            [EnergyFuselage, EnergyWheel1, EnergyWheel2, EnergyDebris, ComFuselage, ComWheel1, ComWheel2];
        const SQUARES: [Series; 4] =
            [LinearMomentumSquare, AngularMomentumSquare, DebrisLinearSquare, DebrisAngularSquare];
        const ERRORS: [Series; 10] = [
            EnergyError,
            ComError,
            LinearMomentumError,
            AngularMomentumError,
            DebrisLinearError,
            DebrisAngularError,
            AttitudeError,
            ResidualKinematic,
            ResidualCollocation,
            ResidualAttitude,
        ];
        for series in [EnergyTotal, ComTotal] {
            if self.wanted.has(series) {
                let (initial, max) = initial_and_max(simd, &self.weights, self.series.column(series));
                self.put(series, Statistic::Initial, initial);
                self.put(series, Statistic::Max, max);
            }
        }
        for series in SQUARES {
            if self.wanted.has(series) {
                let (initial, max) = initial_and_max(simd, &self.weights, self.series.column(series));
                self.put(series, Statistic::Initial, initial.sqrt());
                self.put(series, Statistic::Max, max.sqrt());
            }
        }
        for series in BODIES {
            if self.wanted.has(series) {
                let spread = spread(simd, &self.weights, self.series.column(series));
                self.put(series, Statistic::Initial, spread.initial);
                self.put(series, Statistic::Final, spread.last);
                self.put(series, Statistic::Min, spread.min);
                self.put(series, Statistic::Max, spread.max);
                self.put(series, Statistic::Mean, spread.mean);
                self.put(series, Statistic::PeakToPeak, spread.max - spread.min);
            }
        }
        for series in ERRORS {
            if self.wanted.has(series) {
                let errors = errors(simd, &self.weights, self.series.column(series));
                let scale = self.scale(series);
                self.put(series, Statistic::Max, errors.max / scale);
                self.put(series, Statistic::Final, errors.last / scale);
                self.put(series, Statistic::Rms, errors.rms / scale);
                self.put(series, Statistic::Rate, errors.rate / scale);
            }
        }
        if self.exchange {
            self.exchange(simd);
        }
    }

    /// Exchange between fuselage and wheels about the centre of mass.
    #[inline(always)]
    fn exchange<S: Simd>(&mut self, simd: S) {
        use Series::{ComFuselage, ComTotal, ComWheel1, ComWheel2};
        let of = |values: &[f64; Value::SLOTS], series, statistic| values[Value::Of(series, statistic).slot()];
        let total = of(&self.values, ComTotal, Statistic::Max);
        for series in [ComFuselage, ComWheel1, ComWheel2] {
            let swing = of(&self.values, series, Statistic::PeakToPeak);
            let net = of(&self.values, series, Statistic::Final) - of(&self.values, series, Statistic::Initial);
            let (gross, power) = transfer(simd, &self.weights, self.series.column(series));
            self.put(series, Statistic::Fraction, if total > 0.0 { swing / total } else { 0.0 });
            self.put(series, Statistic::Net, net);
            self.put(series, Statistic::Gross, gross);
            self.put(series, Statistic::Power, power);
        }
        let swings = [ComFuselage, ComWheel1, ComWheel2].map(|series| of(&self.values, series, Statistic::PeakToPeak));
        let varies = swings.map(|swing| swing > EXCHANGE_FLOOR * total);
        let with_mean = |series| (self.series.column(series), of(&self.values, series, Statistic::Mean));
        let fuselage = with_mean(ComFuselage);
        let wheels = correlations(simd, &self.weights, fuselage, [with_mean(ComWheel1), with_mean(ComWheel2)]);
        let frequency = match &mut self.spectrum {
            Some(_) if !varies[0] => 0.0,
            Some(spectrum) => {
                let (column, mean) = fuselage;
                let slope = slope(simd, &self.weights, column, mean);
                spectrum.peak(simd, column, mean, slope)
            }
            None => f64::NAN,
        };
        self.put_own(DirectValue::CorrelationWheel1, if varies[0] && varies[1] { wheels[0] } else { 0.0 });
        self.put_own(DirectValue::CorrelationWheel2, if varies[0] && varies[2] { wheels[1] } else { 0.0 });
        self.put_own(DirectValue::ExchangeFrequency, frequency);
    }

    /// The numbers that are read and not computed.
    fn own(&mut self, table: &StateTable, outcome: &Outcome) {
        let done = outcome.status == Status::Done;
        let groups = self.request.groups;
        if done && self.request.actuated && groups.contains(Group::EnergyConservation) {
            let [thrusters, motors] = table.at(StateField::Work, table.points() - 1);
            self.put_own(DirectValue::WorkThrusters, thrusters);
            self.put_own(DirectValue::WorkMotors, motors);
        }
        if groups.contains(Group::FinalState) {
            let finite = |point: &usize| {
                table.at::<3>(StateField::Rate, *point).iter().all(|x| x.is_finite())
                    && table.at::<4>(StateField::Attitude, *point).iter().all(|x| x.is_finite())
                    && table.at::<2>(StateField::WheelRates, *point).iter().all(|x| x.is_finite())
            };
            let state = (0..self.filled).rev().find(finite).map(|point| {
                let [w, x, y, z] = table.at(StateField::Attitude, point);
                let [a, b, c] = table.at(StateField::Rate, point);
                let [first, second] = table.at(StateField::WheelRates, point);
                [self.times[point], w, x, y, z, a, b, c, first, second]
            });
            let first = Value::DirectValue(DirectValue::TimeFinal).slot();
            self.values[first..first + 10].copy_from_slice(&state.unwrap_or([f64::NAN; 10]));
            self.put_own(DirectValue::TimeReached, outcome.time);
        }
        if let Some(ErrorEstimate { error, amplification }) = self.judgement {
            self.put_own(DirectValue::StateError, error);
            self.put_own(DirectValue::Amplification, amplification);
            self.put_own(DirectValue::IllConditioned, f64::from(u8::from(amplification * f64::EPSILON > MEANINGLESS)));
        }
        self.put_own(DirectValue::Steps, outcome.effort.steps as f64);
        self.put_own(DirectValue::Rejected, outcome.effort.rejected as f64);
        self.put_own(DirectValue::Evaluations, outcome.effort.evaluations as f64);
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
        let (wanted, points) = (observer.wanted, observer.filled);
        let run = Run { wanted, mass: &scene.mass, debris, table, points };
        measure(simd, &run, &mut observer.series);
        observer.reduce(simd);
        if let Some(conditioning) = &mut observer.conditioning {
            let found = conditioning.judge(simd, scene, table, &observer.times, points, local_errors);
            observer.judgement = Some(found);
        }
    }
}
