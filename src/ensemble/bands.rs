//! [`Bands`]: quantiles over a campaign of quantities over time; [`PartBands`]: what one part contributes, while it is run.
//!
//! At each of some observation points the deviations of the runs from the nominal run are counted in buckets
//! ([`crate::statistics::deviation`]): a relative error of a large energy would hide its spread. Counts of parts add up to those of the
//! campaign in any order, and memory does not grow with the number of runs. Only dispersed runs with status `ok` count.

use std::sync::Arc;

use crate::math::Isa;
use crate::observables::Observer;
use crate::observables::band_reader::{BandColumns, BandReader};
use crate::observables::band_series::Form;
use crate::run::Quantity;
use crate::statistics::deviation::{Code, DeviationCounts, MANTISSA_BITS, NOT_A_NUMBER, ZERO};

/// The runs whose codes are kept before they are counted: enough that the counts of a column are fetched seldom, few enough that the
/// codes of all columns stay in the second-level cache.
const PENDING: usize = 512;

/// What bands are of.
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

/// `count` of the `points` points of a grid, evenly distributed, with the first and the last; all where there are no more.
pub fn band_points(points: usize, count: usize) -> Vec<usize> {
    let count = count.min(points);
    let intervals = count.saturating_sub(1).max(1);
    (0..count).map(|index| (index * (points - 1) + intervals / 2) / intervals).collect()
}

/// The counts of the buckets between two magnitudes, for one column. Of 16 bits, so that those of all columns fit in the second-level
/// cache.
#[derive(Clone, Debug, Default)]
struct Window {
    /// The code of the first count.
    first: Code,
    counts: Vec<u16>,
    zeros: u16,
}

/// Runs after which counts of 16 bits may be full.
const FULL: usize = u16::MAX as usize;

impl Window {
    /// Windows grow by whole octaves, of both signs.
    const OCTAVE: usize = 2 << MANTISSA_BITS;

    fn clear(&mut self) {
        self.counts.fill(0);
        self.zeros = 0;
    }

    #[inline(always)]
    fn add(&mut self, code: Code) {
        match self.counts.get_mut(usize::from(code.wrapping_sub(self.first))) {
            Some(count) => *count += 1,
            None => self.add_beyond(code),
        }
    }

    #[inline(never)]
    fn add_beyond(&mut self, code: Code) {
        if code == ZERO {
            self.zeros += 1;
        } else if code != NOT_A_NUMBER {
            self.include(usize::from(code));
            self.counts[usize::from(code - self.first)] += 1;
        }
    }

    /// Widens the window until it has `code`; never by the codes of zero and of what is not a number.
    fn include(&mut self, code: usize) {
        let from = (code / Self::OCTAVE * Self::OCTAVE).max(usize::from(NOT_A_NUMBER) + 1);
        let to = (code / Self::OCTAVE + 1) * Self::OCTAVE;
        if self.counts.is_empty() {
            (self.first, self.counts) = (from as Code, vec![0; to - from]);
            return;
        }
        let first = usize::from(self.first);
        if from < first {
            self.counts.splice(0..0, std::iter::repeat_n(0, first - from));
            self.first = from as Code;
        }
        let length = to - usize::from(self.first);
        self.counts.resize(length.max(self.counts.len()), 0);
    }

    /// The buckets that are not empty.
    fn counted(&self) -> DeviationCounts {
        let zeros = (self.zeros > 0).then_some((ZERO, u64::from(self.zeros)));
        let window = self.counts.iter().zip(usize::from(self.first)..).filter(|(count, _)| **count > 0);
        let window = window.map(|(count, code)| (code as Code, u64::from(*count)));
        DeviationCounts::of(zeros.into_iter().chain(window).collect()).expect("a window is in the order of its codes")
    }
}

/// The bands of one part while it is run. Reused from part to part; adding a run allocates only where a deviation is in an octave
/// that no earlier one was in.
#[derive(Clone, Debug)]
pub struct PartBands {
    layout: Arc<BandLayout>,
    reader: BandReader,
    runs: u64,
    /// Codes that are not counted yet, run by run.
    codes: Vec<Code>,
    pending: usize,
    min: Vec<f64>,
    max: Vec<f64>,
    windows: Vec<Window>,
    /// Runs that are counted in the windows.
    counted: usize,
    /// What was in the windows when they were full; empty until then.
    earlier: Vec<DeviationCounts>,
}

impl PartBands {
    /// Of runs that `reader` reads, whose nominal run is that of `layout`.
    ///
    /// # Panics
    /// Where the layout has other series or points.
    pub fn new(layout: Arc<BandLayout>, mut reader: BandReader) -> Self {
        let shape = (reader.sources().len(), reader.points().len());
        assert_eq!((layout.series.len(), layout.times.len()), shape, "one layout of bands");
        reader.compare_with(&layout.nominal);
        let columns = layout.columns();
        PartBands {
            layout,
            reader,
            runs: 0,
            codes: vec![ZERO; columns * PENDING],
            pending: 0,
            min: vec![f64::INFINITY; columns],
            max: vec![f64::NEG_INFINITY; columns],
            windows: vec![Window::default(); columns],
            counted: 0,
            earlier: Vec::new(),
        }
    }

    /// Clears what an earlier part left.
    pub fn start(&mut self) {
        (self.runs, self.pending, self.counted) = (0, 0, 0);
        self.min.fill(f64::INFINITY);
        self.max.fill(f64::NEG_INFINITY);
        self.windows.iter_mut().for_each(Window::clear);
        self.earlier.clear();
    }

    /// Adds the run that `observer` observed last.
    #[inline]
    pub fn add(&mut self, isa: Isa, observer: &Observer) {
        let columns = self.reader.columns();
        let codes = &mut self.codes[self.pending * columns..][..columns];
        self.reader.read(isa, observer, BandColumns { min: &mut self.min, max: &mut self.max, codes });
        self.runs += 1;
        self.pending += 1;
        if self.pending == PENDING {
            self.count();
        }
    }

    /// Counts the codes that are pending; after the last run of a part.
    pub fn count(&mut self) {
        if self.counted + self.pending > FULL {
            let windows: Vec<DeviationCounts> = self.windows.iter().map(Window::counted).collect();
            self.earlier.resize(windows.len(), DeviationCounts::default());
            self.earlier.iter_mut().zip(&windows).for_each(|(earlier, window)| earlier.merge(window));
            self.windows.iter_mut().for_each(Window::clear);
            self.counted = 0;
        }
        let columns = self.reader.columns();
        for (column, window) in self.windows.iter_mut().enumerate() {
            for codes in self.codes.chunks_exact(columns).take(self.pending) {
                window.add(codes[column]);
            }
        }
        self.counted += self.pending;
        self.pending = 0;
    }

    /// The bands of the part, after [`PartBands::count`].
    ///
    /// # Panics
    /// Where runs are pending.
    pub fn bands(&self) -> Bands {
        assert_eq!(self.pending, 0, "all runs of the part are counted");
        let column = |index: usize| {
            let mut counts = self.windows[index].counted();
            self.earlier.get(index).into_iter().for_each(|earlier| counts.merge(earlier));
            let extremes = [self.min[index], self.max[index]];
            BandColumn { extremes: (extremes[0] <= extremes[1]).then_some(extremes), counts }
        };
        Bands { layout: self.layout.clone(), runs: self.runs, columns: (0..self.windows.len()).map(column).collect() }
    }
}

/// The counts of one series at one point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BandColumn {
    /// The smallest and the largest kept number, exactly; `None` where no run had one.
    pub extremes: Option<[f64; 2]>,
    /// Deviations from the nominal run, in the form of the series.
    pub counts: DeviationCounts,
}

/// Quantiles over runs of quantities over time: of a part, or of several.
#[derive(Clone, Debug)]
pub struct Bands {
    layout: Arc<BandLayout>,
    runs: u64,
    columns: Vec<BandColumn>,
}

impl PartialEq for Bands {
    fn eq(&self, other: &Bands) -> bool {
        self.layout.is(&other.layout) && self.runs == other.runs && self.columns == other.columns
    }
}

/// Bands of different campaigns cannot be merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("these are bands of another campaign: series, times or nominal run differ")]
pub struct OtherCampaign;

impl Bands {
    /// Bands of `runs` runs with these columns, series by series and point by point; `None` where there are not as many as the layout
    /// has.
    pub fn new(layout: Arc<BandLayout>, runs: u64, columns: Vec<BandColumn>) -> Option<Self> {
        (columns.len() == layout.columns()).then_some(Bands { layout, runs, columns })
    }

    /// What the bands are of.
    pub fn layout(&self) -> &Arc<BandLayout> {
        &self.layout
    }

    /// Number of runs: those that are dispersed and `ok`.
    pub fn runs(&self) -> u64 {
        self.runs
    }

    /// The columns, series by series and point by point.
    pub fn columns(&self) -> &[BandColumn] {
        &self.columns
    }

    /// Adds the runs of `other`.
    ///
    /// # Errors
    /// Where the bands are of another campaign; nothing is added then.
    pub fn merge(&mut self, other: &Bands) -> Result<(), OtherCampaign> {
        if !self.layout.is(&other.layout) {
            return Err(OtherCampaign);
        }
        self.runs += other.runs;
        for (mine, theirs) in self.columns.iter_mut().zip(&other.columns) {
            mine.extremes = match (mine.extremes, theirs.extremes) {
                (Some([a, b]), Some([c, d])) => Some([a.min(c), b.max(d)]),
                (mine, theirs) => mine.or(theirs),
            };
            mine.counts.merge(&theirs.counts);
        }
        Ok(())
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
        self.column(series, point).1.counts.count()
    }

    /// The smallest and the largest value, exactly; `None` where no run has one.
    pub fn extremes(&self, series: usize, point: usize) -> Option<[f64; 2]> {
        let (index, column) = self.column(series, point);
        column.extremes.map(|extremes| extremes.map(|kept| self.layout.form(index).shown(kept)))
    }

    /// The `p`-quantile, 0 <= p <= 1, of type 7; `None` where no run has a value.
    ///
    /// Within [`crate::statistics::deviation::RELATIVE_ERROR`] of its deviation from the nominal run (of the larger deviation of the two
    /// neighbours between which it is interpolated), and never beyond the extremes.
    pub fn quantile(&self, series: usize, point: usize, p: f64) -> Option<f64> {
        let (index, column) = self.column(series, point);
        let (form, reference) = (self.layout.form(index), self.layout.reference(index));
        let ([low, high], part) = column.counts.neighbours(p)?;
        let (low, high) = (form.shown(low), form.shown(high));
        let [min, max] = self.extremes(series, point)?;
        Some((form.shown(reference) + (low + part * (high - low))).clamp(min, max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::deviation::code;

    /// Law: a window counts every code once, in whichever order they come and however it has to grow; zero is counted, what is not a
    /// number is not.
    #[test]
    fn a_window_counts_every_code() {
        let values = [1.0, -1.0, 1e-9, 0.0, f64::NAN, 1e12, -3e-200, 1.0, 1e77, f64::INFINITY, 0.0, 1e-77, -1e-77];
        for turn in 0..values.len() {
            let mut window = Window::default();
            let mut turned = values;
            turned.rotate_left(turn);
            turned.iter().for_each(|value| window.add(code(*value)));
            let mut codes: Vec<Code> = values.iter().map(|value| code(*value)).filter(|c| *c != NOT_A_NUMBER).collect();
            codes.sort_unstable();
            let expected = codes.chunk_by(|a, b| a == b).map(|run| (run[0], run.len() as u64)).collect();
            assert_eq!(Some(window.counted()), DeviationCounts::of(expected), "{turn}");
            window.clear();
            assert_eq!(window.counted(), DeviationCounts::default());
        }
    }

    #[test]
    fn points_are_evenly_distributed() {
        assert_eq!(band_points(101, 33).first(), Some(&0));
        assert_eq!(band_points(101, 33).last(), Some(&100));
        assert_eq!(band_points(33, 33), (0..33).collect::<Vec<_>>());
        for (points, count) in [(101, 33), (11, 33), (2, 2), (10_000_000, 257), (100, 99)] {
            let found = band_points(points, count);
            assert_eq!(found.len(), count.min(points));
            let gaps: Vec<usize> = found.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let (least, most) = (gaps.iter().min(), gaps.iter().max());
            assert!(least > Some(&0) && most <= least.map(|least| least + 1).as_ref(), "{points} {count}: {found:?}");
        }
        assert!(band_points(11, 0).is_empty());
    }
}
