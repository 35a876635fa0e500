//! [`BandReader`]: values of a run at the points of its bands, and buckets of their deviations from the nominal run.
//!
//! Branch-free loops over flat arrays, with the same buckets on all instruction sets ([`crate::math::isa::Work`]).
//! Buckets are counted in `ensemble`.

use fearless_simd::Simd;

use super::band_series::{BandSeries, Form, keep, keep_own};
use super::observer::Observer;
use crate::math::Isa;
use crate::math::isa::Work;
use crate::run::StateTable;
use crate::statistics::deviation::{Code, code};

/// Reads runs; one per worker, without allocation.
#[derive(Clone, Debug)]
pub struct BandReader {
    sources: Vec<BandSeries>,
    /// Observation points, ascending.
    points: Vec<usize>,
    /// Reference of deviations, by series and point.
    reference: Vec<f64>,
    kept: Vec<f64>,
    deviations: Vec<f64>,
}

/// Output for a run, by series and point.
pub struct BandColumns<'a> {
    /// Smallest kept numbers so far.
    pub min: &'a mut [f64],
    /// Largest kept numbers so far.
    pub max: &'a mut [f64],
    /// Runs without a value so far.
    pub without: &'a mut [u64],
    /// Buckets of this run's deviations, if counted.
    pub codes: Option<&'a mut [Code]>,
}

impl BandReader {
    /// Reads `sources` at `points`, ascending.
    pub fn new(sources: Vec<BandSeries>, points: Vec<usize>) -> Self {
        let columns = sources.len() * points.len();
        BandReader {
            sources,
            points,
            reference: vec![0.0; columns],
            kept: vec![f64::NAN; columns],
            deviations: vec![f64::NAN; columns],
        }
    }

    /// The series.
    pub fn sources(&self) -> &[BandSeries] {
        &self.sources
    }

    /// The observation points.
    pub fn points(&self) -> &[usize] {
        &self.points
    }

    /// Series times points.
    pub fn columns(&self) -> usize {
        self.reference.len()
    }

    /// Sets the reference of deviations, with zero for NaN; zero until then.
    pub fn compare_with(&mut self, nominal: &[f64]) {
        for (reference, nominal) in self.reference.iter_mut().zip(nominal) {
            *reference = if nominal.is_nan() { 0.0 } else { *nominal };
        }
    }

    /// Kept numbers of the run last observed by `observer`, with the states `table`; NaN at points not reached, and
    /// from point `end` on.
    pub fn kept(&mut self, observer: &Observer, table: &StateTable, end: usize) -> &[f64] {
        self.keep(observer, table, end);
        &self.kept
    }

    /// Reads the run last observed by `observer`, see [`BandReader::kept`].
    ///
    /// # Panics
    /// If a list does not have [`BandReader::columns`] entries.
    pub fn read(&mut self, isa: Isa, observer: &Observer, table: &StateTable, end: usize, out: BandColumns<'_>) {
        isa.run(Reading { reader: self, observer, table, end, out });
    }

    #[inline(always)]
    fn keep(&mut self, observer: &Observer, table: &StateTable, end: usize) {
        let reached = self.points.partition_point(|point| *point < observer.reached().min(end));
        for (source, kept) in self.sources.iter().zip(self.kept.chunks_exact_mut(self.points.len())) {
            let (points, of_reached) = (&self.points[..reached], &mut kept[..reached]);
            if source.is_own {
                keep_own(table, points, of_reached);
            } else {
                let (column, scale) = observer.observed_column(source);
                keep(source, column, scale, points, of_reached);
            }
            kept[reached..].fill(f64::NAN);
        }
    }
}

struct Reading<'a> {
    reader: &'a mut BandReader,
    observer: &'a Observer,
    table: &'a StateTable,
    end: usize,
    out: BandColumns<'a>,
}

impl Work for Reading<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let Reading { reader, observer, table, end, out } = self;
        reader.keep(observer, table, end);
        let (count, points) = (reader.columns(), reader.points.len());
        let (kept, reference) = (&reader.kept[..count], &reader.reference[..count]);
        let deviations = &mut reader.deviations[..count];
        let (min, max) = (&mut out.min[..count], &mut out.max[..count]);
        let mut has_gaps = 0;
        for at in 0..count {
            let value = kept[at] + 0.0; // -0 becomes 0, so that the extremes do not depend on order
            min[at] = if value < min[at] { value } else { min[at] };
            max[at] = if value > max[at] { value } else { max[at] };
            has_gaps |= u64::from(value.is_nan());
        }
        if has_gaps > 0 {
            out.without.iter_mut().zip(kept).for_each(|(without, kept)| *without += u64::from(kept.is_nan()));
        }
        let Some(codes) = out.codes else { return };
        for at in 0..count {
            deviations[at] = Form::Value.deviation(kept[at] + 0.0, reference[at]);
        }
        for (index, _) in reader.sources.iter().enumerate().filter(|(_, source)| source.form == Form::HalfTangent) {
            for at in index * points..(index + 1) * points {
                deviations[at] = Form::HalfTangent.deviation(kept[at], reference[at]);
            }
        }
        for (code_at, deviation) in codes[..count].iter_mut().zip(deviations) {
            *code_at = code(*deviation);
        }
    }
}
