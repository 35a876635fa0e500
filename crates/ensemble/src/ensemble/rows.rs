//! [`Rows`]: the rows of one part by columns, in memory that a worker reuses.

use crate::ensemble::audit::Audit;
use crate::ensemble::bands::PartBands;
use crate::ensemble::parts::Part;
use crate::run::Status;
use crate::sampling::SampleId;

const CACHE_LINE: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    pub parameters: usize,
    pub observables: usize,
}

#[derive(Clone, Debug)]
pub struct Rows {
    part: Part,
    shape: Shape,
    capacity: usize,
    /// Distance of columns: not a multiple of a large power of two, which maps a row to few cache sets.
    stride: usize,
    samples: Vec<SampleId>,
    statuses: Vec<Status>,
    values: Vec<f64>,
    audits: Vec<(usize, Option<Audit>)>,
    audit_reasons: Vec<(usize, String)>,
    reasons: Vec<(usize, String)>,
    seconds: [f64; 2],
    bands: Option<PartBands>,
}

impl Rows {
    pub fn new(shape: Shape, capacity: usize) -> Self {
        let stride = capacity.next_multiple_of(CACHE_LINE) + CACHE_LINE;
        Rows {
            stride,
            part: Part { id: crate::ensemble::parts::PartId(0), first: SampleId(0), count: 0 },
            shape,
            capacity,
            samples: Vec::with_capacity(capacity),
            statuses: vec![Status::InvalidSample; capacity],
            values: vec![f64::NAN; (shape.parameters + shape.observables) * stride],
            audits: Vec::new(),
            audit_reasons: Vec::new(),
            reasons: Vec::new(),
            seconds: [0.0; 2],
            bands: None,
        }
    }

    #[must_use]
    pub fn with_bands(self, bands: Option<PartBands>) -> Self {
        Rows { bands, ..self }
    }

    /// Clears the block for `part` with these samples: unwritten rows are invalid samples.
    ///
    /// # Panics
    /// If the part is larger than the block, or has a different number of samples.
    pub fn start(&mut self, part: Part, samples: impl IntoIterator<Item = SampleId>) {
        assert!(part.count <= self.capacity, "a part of {} samples in a block for {}", part.count, self.capacity);
        self.part = part;
        self.samples.clear();
        self.samples.extend(samples);
        assert_eq!(self.samples.len(), part.count, "samples of a part");
        self.statuses.fill(Status::InvalidSample);
        self.values.fill(f64::NAN);
        self.audits.clear();
        self.audit_reasons.clear();
        self.reasons.clear();
        self.seconds = [0.0; 2];
        self.bands.iter_mut().for_each(PartBands::start);
    }

    pub fn part(&self) -> Part {
        self.part
    }

    pub fn shape(&self) -> Shape {
        self.shape
    }

    pub fn samples(&self) -> &[SampleId] {
        &self.samples
    }

    pub fn statuses(&self) -> &[Status] {
        &self.statuses[..self.part.count]
    }

    pub fn parameter(&self, index: usize) -> &[f64] {
        assert!(index < self.shape.parameters);
        self.column(index)
    }

    /// NaN for none; infinite numbers are absent, as in files.
    pub fn observable(&self, index: usize) -> &[f64] {
        assert!(index < self.shape.observables);
        self.column(self.shape.parameters + index)
    }

    pub fn set_parameters(&mut self, row: usize, values: &[f64]) {
        assert_eq!(values.len(), self.shape.parameters);
        self.scatter(0, row, values);
    }

    pub fn set_result(&mut self, row: usize, status: Status, observables: &[f64]) {
        assert_eq!(observables.len(), self.shape.observables);
        self.statuses[row] = status;
        self.scatter(self.shape.parameters, row, observables);
    }

    pub fn set_observables(&mut self, row: usize, first: usize, values: &[f64]) {
        assert!(first + values.len() <= self.shape.observables);
        self.scatter(self.shape.parameters + first, row, values);
    }

    pub fn set_audit(&mut self, row: usize, audit: Option<Audit>) {
        assert!(row < self.part.count);
        let audit = audit.map(|Audit { values, observables }| {
            let [values, observables] = [values, observables].map(|list| list.into_iter().map(finite).collect());
            Audit { values, observables }
        });
        self.audits.push((row, audit));
    }

    pub fn set_audit_reason(&mut self, row: usize, reason: String) {
        assert!(row < self.part.count);
        self.audit_reasons.push((row, reason));
    }

    pub fn audit_reasons(&self) -> &[(usize, String)] {
        &self.audit_reasons
    }

    pub fn set_reason(&mut self, row: usize, reason: String) {
        assert!(row < self.part.count);
        self.reasons.push((row, reason));
    }

    /// Reasons of rows that are not `ok`, in any order.
    pub fn reasons(&self) -> &[(usize, String)] {
        &self.reasons
    }

    pub fn audits(&self) -> &[(usize, Option<Audit>)] {
        &self.audits
    }

    pub fn bands(&self) -> Option<&PartBands> {
        self.bands.as_ref()
    }

    pub fn bands_mut(&mut self) -> Option<&mut PartBands> {
        self.bands.as_mut()
    }

    pub fn add_seconds(&mut self, runs: f64, audits: f64) {
        self.seconds[0] += runs;
        self.seconds[1] += audits;
    }

    /// CPU time of runs and audits, s; only measured with audits.
    pub fn seconds(&self) -> [f64; 2] {
        self.seconds
    }

    fn column(&self, index: usize) -> &[f64] {
        &self.values[index * self.stride..index * self.stride + self.part.count]
    }

    fn scatter(&mut self, first: usize, row: usize, values: &[f64]) {
        assert!(row < self.part.count);
        for (index, value) in values.iter().enumerate() {
            self.values[(first + index) * self.stride + row] = finite(*value);
        }
    }
}

fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::parts::PartId;

    #[test]
    fn infinite_values_are_absent() {
        let mut rows = Rows::new(Shape { parameters: 1, observables: 2 }, 1);
        rows.start(part(1), part(1).samples());
        rows.set_parameters(0, &[f64::NEG_INFINITY]);
        rows.set_result(0, Status::Done, &[f64::INFINITY, -0.0]);
        assert!(rows.parameter(0)[0].is_nan() && rows.observable(0)[0].is_nan());
        assert_eq!(rows.observable(1)[0].to_bits(), (-0.0_f64).to_bits());
    }

    fn part(count: usize) -> Part {
        Part { id: PartId(3), first: SampleId(768), count }
    }
}
