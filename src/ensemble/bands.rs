//! [`Bands`]: quantiles over a campaign of quantities over time; [`PartBands`]: what one part contributes, while it is
//! run.
//!
//! At each of some observation points the deviations of the runs from the nominal run are counted in buckets
//! ([`crate::statistics::deviation`]): a relative error of a large energy would hide its spread. Counts of parts add up
//! to those of the campaign in any order, and memory does not grow with the number of runs. Only dispersed runs with
//! status `ok` count.
//!
//! Extremes and the number of runs with a value are those of all runs. Quantiles of a large campaign are those of its
//! first runs ([`crate::campaign::Plan::last_counted`]).

use std::sync::Arc;

use crate::ensemble::deviation_window::{DeviationWindow, FULL};
use crate::math::Isa;
use crate::observables::Observer;
use crate::observables::band_reader::{BandColumns, BandReader};
use crate::observables::band_series::Form;
use crate::run::{Quantity, StateTable};
use crate::sampling::SampleId;
use crate::statistics::deviation::{Code, ZERO, ends, ranks};
use crate::statistics::gate::GateLimit;

/// The runs whose codes are kept before they are counted, so that the counts of a column, which the runs between have
/// driven out of the second-level cache, are fetched seldom.
const PENDING: usize = 2048;

/// The runs whose codes are kept run by run before they are moved to their columns: those of a column are then a cache
/// line, and the codes of all columns stay in the first-level cache.
const RECENT: usize = 32;

/// Bound of the rounding of a value that is put together from the nominal one and a deviation: some units in the last
/// place.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

#[derive(Clone, Debug, PartialEq)]
pub struct BandLayout {
    /// Each series, and the form in which its numbers are kept.
    pub series: Vec<(Quantity, Form)>,
    /// The times of the points, s, ascending.
    pub times: Vec<f64>,
    /// The kept numbers of the nominal run, series by series and point by point; NaN where it has none.
    pub nominal: Vec<f64>,
}

impl BandLayout {
    /// Number of columns: of series times points.
    pub fn columns(&self) -> usize {
        self.series.len() * self.times.len()
    }

    /// Whether the bits of both are the same.
    pub fn is(&self, other: &BandLayout) -> bool {
        let bits = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<_>>();
        self.series == other.series
            && bits(&self.times) == bits(&other.times)
            && bits(&self.nominal) == bits(&other.nominal)
    }

    /// What deviations at a column are from: the nominal run, or zero where it has no number.
    fn reference(&self, column: usize) -> f64 {
        let nominal = self.nominal[column];
        if nominal.is_nan() { 0.0 } else { nominal }
    }

    fn form(&self, column: usize) -> Form {
        self.series[column / self.times.len()].1
    }
}

/// The bands of one part while it is run. Reused from part to part; adding a run allocates only where a deviation is in
/// an octave that no earlier one was in.
#[derive(Clone, Debug)]
pub struct PartBands {
    layout: Arc<BandLayout>,
    reader: BandReader,
    runs: u64,
    /// Those of them that are counted: of samples up to the last counted one.
    counted: u64,
    last_counted: SampleId,
    /// Codes of the last runs, run by run.
    recent: Vec<Code>,
    recent_runs: usize,
    /// Codes that are not counted yet, column by column, for up to [`PENDING`] runs.
    codes: Vec<Code>,
    pending: usize,
    min: Vec<f64>,
    max: Vec<f64>,
    without: Vec<u64>,
    windows: Vec<DeviationWindow<u16>>,
}

impl PartBands {
    /// Of runs that `reader` reads, whose nominal run is that of `layout`; those up to the sample `last_counted` are
    /// counted.
    ///
    /// # Panics
    /// Where the layout has other series or points.
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

    /// Clears what an earlier part left.
    pub fn start(&mut self) {
        (self.runs, self.counted, self.recent_runs, self.pending) = (0, 0, 0, 0);
        self.min.fill(f64::INFINITY);
        self.max.fill(f64::NEG_INFINITY);
        self.without.fill(0);
        self.windows.iter_mut().for_each(DeviationWindow::clear);
    }

    /// Adds the run of `sample` with the states `table` that `observer` observed last, up to the point before `end`.
    ///
    /// # Panics
    /// Where the part has more than 65,535 runs.
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

    /// Moves the codes of the last runs to their columns, which are counted when they are full.
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

    /// Counts what is not counted yet; after the last run of a part.
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

    /// What the bands are of.
    pub fn layout(&self) -> &Arc<BandLayout> {
        &self.layout
    }

    /// Number of runs, those that are dispersed and `ok`; and how many of them are counted.
    pub fn runs(&self) -> [u64; 2] {
        [self.runs, self.counted]
    }

    /// A column, of the series times points, after [`PartBands::count`], and its buckets that are not empty, in
    /// ascending order of their codes.
    ///
    /// # Panics
    /// Where runs are pending.
    pub fn column(&self, index: usize) -> (RunsOfColumn, impl Iterator<Item = (Code, u64)>) {
        assert_eq!(self.pending + self.recent_runs, 0, "all runs of the part are counted");
        let extremes = [self.min[index], self.max[index]];
        let extremes = (extremes[0] <= extremes[1]).then_some(extremes);
        (RunsOfColumn { extremes, without: self.without[index] }, self.windows[index].buckets())
    }
}

/// What is known of all runs at one point of one series.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunsOfColumn {
    /// The smallest and the largest kept number, exactly; `None` where no run had one.
    pub extremes: Option<[f64; 2]>,
    /// How many runs have no value.
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

/// The counts of one series at one point.
#[derive(Clone, Debug, Default)]
struct BandColumn {
    all: RunsOfColumn,
    /// Deviations from the nominal run, in the form of the series.
    counts: DeviationWindow<u64>,
}

/// Quantiles over runs of quantities over time: of any number of parts, added in any order.
#[derive(Clone, Debug)]
pub struct Bands {
    layout: Arc<BandLayout>,
    /// All, and those that are counted.
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

/// Bands of different campaigns cannot be merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("these are bands of another campaign: series, times or nominal run differ")]
pub struct OtherCampaign;

impl Bands {
    pub fn new(layout: Arc<BandLayout>) -> Self {
        Bands { runs: [0; 2], columns: vec![BandColumn::default(); layout.columns()], layout }
    }

    /// Adds the runs of a part, after [`PartBands::count`].
    ///
    /// # Errors
    /// Where the bands are of another campaign; nothing is added then.
    pub fn add(&mut self, part: &PartBands) -> Result<(), OtherCampaign> {
        if !Arc::ptr_eq(&self.layout, part.layout()) && !self.layout.is(part.layout()) {
            return Err(OtherCampaign);
        }
        self.add_runs(part.runs());
        for index in 0..self.columns.len() {
            let (all, buckets) = part.column(index);
            self.add_column(index, all, buckets);
        }
        Ok(())
    }

    /// Adds to the numbers of runs ([`PartBands::runs`]).
    pub fn add_runs(&mut self, runs: [u64; 2]) {
        self.runs.iter_mut().zip(runs).for_each(|(sum, runs)| *sum += runs);
    }

    /// Adds to a column, of the series times points, what is known of all runs, and the buckets of those that were
    /// counted.
    pub fn add_column(&mut self, index: usize, all: RunsOfColumn, buckets: impl Iterator<Item = (Code, u64)>) {
        let column = &mut self.columns[index];
        column.all.add(all);
        column.counts.add_buckets(buckets);
    }

    /// What the bands are of.
    pub fn layout(&self) -> &Arc<BandLayout> {
        &self.layout
    }

    /// Number of runs: those that are dispersed and `ok`.
    pub fn runs(&self) -> u64 {
        self.runs[0]
    }

    /// How many of them quantiles are of: all, or the first ones.
    pub fn counted_runs(&self) -> u64 {
        self.runs[1]
    }

    /// The number of the series called `name`.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.layout.series.iter().position(|(quantity, _)| quantity.name() == name)
    }

    /// Name, unit and meaning of a series.
    pub fn quantity(&self, series: usize) -> &Quantity {
        &self.layout.series[series].0
    }

    /// The times of the points, s.
    pub fn times(&self) -> &[f64] {
        &self.layout.times
    }

    fn column(&self, series: usize, point: usize) -> (usize, &BandColumn) {
        assert!(point < self.layout.times.len(), "point {point} of {}", self.layout.times.len());
        let index = series * self.layout.times.len() + point;
        (index, &self.columns[index])
    }

    /// The value of the nominal run; `None` where it has none.
    pub fn nominal(&self, series: usize, point: usize) -> Option<f64> {
        let (index, _) = self.column(series, point);
        let kept = self.layout.nominal[index];
        (!kept.is_nan()).then(|| self.layout.form(index).shown(kept))
    }

    /// How many runs have a value.
    pub fn count(&self, series: usize, point: usize) -> u64 {
        self.runs() - self.column(series, point).1.all.without
    }

    /// How many runs the quantiles are of.
    pub fn counted(&self, series: usize, point: usize) -> u64 {
        self.column(series, point).1.counts.buckets().map(|(_, count)| count).sum()
    }

    /// The smallest and the largest value, exactly; `None` where no run has one.
    pub fn extremes(&self, series: usize, point: usize) -> Option<[f64; 2]> {
        let (index, column) = self.column(series, point);
        column.all.extremes.map(|extremes| extremes.map(|kept| self.layout.form(index).shown(kept)))
    }

    /// The `p`-quantile, 0 <= p <= 1, of type 7, of the runs that are [counted](Bands::counted); `None` where none of
    /// them has a value.
    ///
    /// Within [`crate::statistics::deviation::RELATIVE_ERROR`] of its deviation from the nominal run (of the larger
    /// deviation of the two neighbours between which it is interpolated), and never beyond the extremes.
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

    /// At least and at most how many runs are within `limit` at a point, of all runs. They differ by the runs in the
    /// bucket that the limit is in, and by those that are not counted; a run without a value is not within it.
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
            // rounding of the deviation, and of its sum with the nominal value
            let slack = ROUNDING * (start.abs() + low.abs().min(high.abs()));
            let are_met = [low - slack, high + slack].map(|end| limit.is_met(end));
            [u64::from(are_met == [true; 2]) * count, u64::from(are_met != [false; 2]) * count]
        });
        found.fold([0, count.saturating_sub(counted)], |sum, found| [sum[0] + found[0], sum[1] + found[1]])
    }
}
