//! [`Bands`]: quantiles of quantities over time over a campaign's runs; [`PartBands`]: those of a part.
//!
//! Deviations from the nominal run are counted in buckets at some observation points
//! ([`crate::statistics::deviation`]): the relative error of a large energy would hide its spread. Counts of parts add
//! up in any order and take the same memory for any number of runs. Only dispersed `ok` runs count.
//!
//! Extremes and numbers of values cover all runs, quantiles of a large campaign its first ones
//! ([`crate::campaign::Plan::last_counted`]).

use crate::ensemble::deviation_window::{DeviationWindow, FULL};
use crate::math::Isa;
use crate::observables::Observer;
use crate::observables::band_reader::{BandColumns, BandReader};
use crate::observables::band_series::Form;
use crate::run::{Quantity, StateTable};
use crate::sampling::SampleId;
use crate::statistics::deviation::{Code, ZERO, ends, ranks};
use crate::statistics::gate::GateLimit;
use std::sync::Arc;

/// Runs between two counts: a column's counts are seldom fetched into the cache.
const PENDING: usize = 2048;

/// Runs between two transpositions: a cache line per column, and all codes in the first-level cache.
const RECENT: usize = 32;

/// Relative rounding of a nominal value plus a deviation.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

#[derive(Clone, Debug, PartialEq)]
pub struct BandLayout {
    pub series: Vec<(Quantity, Form)>,
    pub times: Vec<f64>,
    /// Nominal numbers, series by series and point by point; NaN for none.
    pub nominal: Vec<f64>,
}

impl BandLayout {
    pub fn columns(&self) -> usize {
        self.series.len() * self.times.len()
    }

    pub fn is(&self, other: &BandLayout) -> bool {
        let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
        self.series == other.series
            && bits(&self.times) == bits(&other.times)
            && bits(&self.nominal) == bits(&other.nominal)
    }

    /// The reference of deviations: the nominal number, or zero.
    fn reference(&self, column: usize) -> f64 {
        let nominal = self.nominal[column];
        if nominal.is_nan() { 0.0 } else { nominal }
    }

    fn form(&self, column: usize) -> Form {
        self.series[column / self.times.len()].1
    }
}

/// Bands of a part, reused; adding a run allocates only for a deviation in a new octave.
#[derive(Clone, Debug)]
pub struct PartBands {
    layout: Arc<BandLayout>,
    reader: BandReader,
    runs: u64,
    /// Runs of samples up to `last_counted`.
    counted: u64,
    last_counted: SampleId,
    recent: Vec<Code>,
    recent_runs: usize,
    /// Codes to count, by column, of up to [`PENDING`] runs.
    codes: Vec<Code>,
    pending: usize,
    min: Vec<f64>,
    max: Vec<f64>,
    without: Vec<u64>,
    windows: Vec<DeviationWindow<u16>>,
}

impl PartBands {
    /// For runs read by `reader`; samples up to `last_counted` are counted.
    ///
    /// # Panics
    /// If the layout has other series or points.
    pub fn new(layout: Arc<BandLayout>, mut reader: BandReader, last_counted: SampleId) -> Self {
        let shape = (reader.sources().len(), reader.points().len());
        assert_eq!((layout.series.len(), layout.times.len()), shape, "one layout of bands");
        reader.compare_with(&layout.nominal);
        let columns = layout.columns();
        PartBands {
            layout,
            reader,
            runs: 0,
            counted: 0,
            last_counted,
            recent: vec![ZERO; columns * RECENT],
            recent_runs: 0,
            codes: vec![ZERO; columns * PENDING],
            pending: 0,
            min: vec![f64::INFINITY; columns],
            max: vec![f64::NEG_INFINITY; columns],
            without: vec![0; columns],
            windows: vec![DeviationWindow::default(); columns],
        }
    }

    pub fn start(&mut self) {
        (self.runs, self.counted, self.recent_runs, self.pending) = (0, 0, 0, 0);
        self.min.fill(f64::INFINITY);
        self.max.fill(f64::NEG_INFINITY);
        self.without.fill(0);
        self.windows.iter_mut().for_each(DeviationWindow::clear);
    }

    /// Adds the run of `sample`, observed last by `observer`, up to the point before `end`.
    ///
    /// # Panics
    /// If the part has more than 65,535 runs.
    #[inline]
    pub fn add(&mut self, isa: Isa, sample: SampleId, (observer, table): (&Observer, &StateTable), end: usize) {
        assert!(self.runs < FULL as u64, "bands of a part of more than {FULL} runs");
        let (columns, is_counted) = (self.reader.columns(), sample <= self.last_counted);
        let codes = is_counted.then(|| &mut self.recent[self.recent_runs * columns..][..columns]);
        let (min, max, without) = (&mut self.min[..], &mut self.max[..], &mut self.without[..]);
        self.reader.read(isa, observer, table, end, BandColumns { min, max, without, codes });
        self.runs += 1;
        self.counted += u64::from(is_counted);
        self.recent_runs += usize::from(is_counted);
        if self.recent_runs == RECENT {
            self.move_to_columns();
        }
    }

    /// Transposes recent codes, and counts full columns.
    fn move_to_columns(&mut self) {
        let (columns, recent) = (self.reader.columns(), self.recent_runs);
        for (column, codes) in self.codes.chunks_exact_mut(PENDING).enumerate() {
            let of_column = self.recent.iter().skip(column).step_by(columns);
            codes[self.pending..self.pending + recent]
                .iter_mut()
                .zip(of_column)
                .for_each(|(code, found)| *code = *found);
        }
        self.pending += recent;
        self.recent_runs = 0;
        if self.pending == PENDING {
            self.count_columns();
        }
    }

    /// Counts pending runs at the end of a part.
    pub fn count(&mut self) {
        self.move_to_columns();
        self.count_columns();
    }

    fn count_columns(&mut self) {
        if self.pending > 0 {
            for (window, codes) in self.windows.iter_mut().zip(self.codes.chunks_exact(PENDING)) {
                window.add(&codes[..self.pending]);
            }
        }
        self.pending = 0;
    }

    pub fn layout(&self) -> &Arc<BandLayout> {
        &self.layout
    }

    /// Numbers of dispersed `ok` runs, and of counted ones.
    pub fn runs(&self) -> [u64; 2] {
        [self.runs, self.counted]
    }

    /// A column (series times points) and its non-empty buckets, in ascending order.
    ///
    /// # Panics
    /// Before [`PartBands::count`].
    pub fn column(&self, index: usize) -> (RunsOfColumn, impl Iterator<Item = (Code, u64)>) {
        assert_eq!(self.pending + self.recent_runs, 0, "all runs of the part are counted");
        let extremes = [self.min[index], self.max[index]];
        let extremes = (extremes[0] <= extremes[1]).then_some(extremes);
        (RunsOfColumn { extremes, without: self.without[index] }, self.windows[index].buckets())
    }
}

/// All runs at one point of one series.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunsOfColumn {
    /// Exact extremes; `None` without numbers.
    pub extremes: Option<[f64; 2]>,
    pub without: u64,
}

impl RunsOfColumn {
    fn add(&mut self, more: RunsOfColumn) {
        self.without += more.without;
        self.extremes = match (self.extremes, more.extremes) {
            (Some([a, b]), Some([c, d])) => Some([a.min(c), b.max(d)]),
            (mine, theirs) => mine.or(theirs),
        };
    }
}

#[derive(Clone, Debug, Default)]
struct BandColumn {
    all: RunsOfColumn,
    counts: DeviationWindow<u64>,
}

#[derive(Clone, Debug)]
pub struct Bands {
    layout: Arc<BandLayout>,
    runs: [u64; 2],
    columns: Vec<BandColumn>,
}

impl PartialEq for Bands {
    fn eq(&self, other: &Bands) -> bool {
        let is_same = |(a, b): (&BandColumn, &BandColumn)| a.all == b.all && a.counts.buckets().eq(b.counts.buckets());
        let columns = || self.columns.iter().zip(&other.columns);
        self.layout.is(&other.layout) && self.runs == other.runs && columns().all(is_same)
    }
}

impl Bands {
    pub fn new(layout: Arc<BandLayout>) -> Self {
        Bands { runs: [0; 2], columns: vec![BandColumn::default(); layout.columns()], layout }
    }

    /// Adds the runs of a part of the campaign, after [`PartBands::count`].
    pub fn add(&mut self, part: &PartBands) {
        self.add_runs(part.runs());
        for index in 0..self.columns.len() {
            let (all, buckets) = part.column(index);
            self.add_column(index, all, buckets);
        }
    }

    /// Adds to the numbers of runs ([`PartBands::runs`]).
    pub fn add_runs(&mut self, runs: [u64; 2]) {
        self.runs.iter_mut().zip(runs).for_each(|(sum, runs)| *sum += runs);
    }

    /// Adds runs and counted buckets to a column (series times points).
    pub fn add_column(&mut self, index: usize, all: RunsOfColumn, buckets: impl Iterator<Item = (Code, u64)>) {
        let column = &mut self.columns[index];
        column.all.add(all);
        column.counts.add_buckets(buckets);
    }

    pub fn layout(&self) -> &Arc<BandLayout> {
        &self.layout
    }

    pub fn runs(&self) -> u64 {
        self.runs[0]
    }

    pub fn counted_runs(&self) -> u64 {
        self.runs[1]
    }

    pub fn find(&self, name: &str) -> Option<usize> {
        self.layout.series.iter().position(|(quantity, _)| quantity.name() == name)
    }

    pub fn quantity(&self, series: usize) -> &Quantity {
        &self.layout.series[series].0
    }

    pub fn times(&self) -> &[f64] {
        &self.layout.times
    }

    fn column(&self, series: usize, point: usize) -> (usize, &BandColumn) {
        assert!(point < self.layout.times.len(), "point {point} of {}", self.layout.times.len());
        let index = series * self.layout.times.len() + point;
        (index, &self.columns[index])
    }

    pub fn nominal(&self, series: usize, point: usize) -> Option<f64> {
        let (index, _) = self.column(series, point);
        let kept = self.layout.nominal[index];
        (!kept.is_nan()).then(|| self.layout.form(index).shown(kept))
    }

    pub fn count(&self, series: usize, point: usize) -> u64 {
        self.runs() - self.column(series, point).1.all.without
    }

    pub fn counted(&self, series: usize, point: usize) -> u64 {
        self.column(series, point).1.counts.buckets().map(|(_, count)| count).sum()
    }

    pub fn extremes(&self, series: usize, point: usize) -> Option<[f64; 2]> {
        let (index, column) = self.column(series, point);
        column.all.extremes.map(|extremes| extremes.map(|kept| self.layout.form(index).shown(kept)))
    }

    /// The `p`-quantile of type 7, 0 <= p <= 1, of the [counted](Bands::counted) runs with a value.
    ///
    /// Accurate to [`crate::statistics::deviation::RELATIVE_ERROR`] of its deviation from the nominal run (the larger
    /// of the interpolated neighbours), and within the extremes.
    pub fn quantile(&self, series: usize, point: usize, p: f64) -> Option<f64> {
        self.quantiles(series, point, [p])[0]
    }

    pub fn quantiles<const N: usize>(&self, series: usize, point: usize, p: [f64; N]) -> [Option<f64>; N] {
        let (index, column) = self.column(series, point);
        let (form, reference) = (self.layout.form(index), self.layout.reference(index));
        let ranks = ranks(&column.counts.buckets().collect::<Vec<_>>());
        let extremes = self.extremes(series, point);
        p.map(|p| {
            let ([low, high], part) = ranks.neighbours(p)?;
            let (low, high) = (form.shown(low), form.shown(high));
            let [min, max] = extremes?;
            Some((form.shown(reference) + (low + part * (high - low))).clamp(min, max))
        })
    }

    /// Least and most number of runs within `limit` at a point: they differ by runs in the limit's bucket and uncounted
    /// runs. A run without a value is outside.
    pub fn within(&self, series: usize, point: usize, limit: GateLimit) -> [u64; 2] {
        let (index, column) = self.column(series, point);
        let (form, reference) = (self.layout.form(index), self.layout.reference(index));
        let Some(extremes) = self.extremes(series, point) else { return [0; 2] };
        let (count, counted) = (self.count(series, point), self.counted(series, point));
        match extremes.map(|extreme| limit.is_met(extreme)) {
            [true, true] => return [count; 2],
            [false, false] => return [0; 2],
            _ => {}
        }
        let start = form.shown(reference);
        let found = column.counts.buckets().map(|(code, count)| {
            let [low, high] = ends(code).map(|end| start + form.shown(end));
            let slack = ROUNDING * (start.abs() + low.abs().min(high.abs()));
            let are_met = [low - slack, high + slack].map(|end| limit.is_met(end));
            [u64::from(are_met == [true; 2]) * count, u64::from(are_met != [false; 2]) * count]
        });
        found.fold([0, count.saturating_sub(counted)], |sum, found| [sum[0] + found[0], sum[1] + found[1]])
    }
}
