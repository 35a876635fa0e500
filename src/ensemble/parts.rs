//! [`Parts`]: the samples of a campaign divided into parts of consecutive samples.
//!
//! The division depends on the number of samples only, not on threads or machine: a part is the unit of work of a thread, the
//! content of a file, and the unit in which a campaign can be resumed or divided among machines.

use crate::sampling::SampleId;

/// The smallest part: for a smaller one, creating the file costs more than the runs.
const SMALLEST: u64 = 256;

/// The largest part: its rows (about a hundred columns) take some 10 MB per thread.
const LARGEST: u64 = 16_384;

/// A campaign has about this many parts, so that all threads end at nearly the same time.
const AIM: u64 = 32;

/// The number of a part, from zero in the order of its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PartId(pub u64);

/// A part: consecutive samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its number.
    pub id: PartId,
    /// Its first sample.
    pub first: SampleId,
    /// Its number of samples, at least one.
    pub count: usize,
}

impl Part {
    /// Its samples in ascending order.
    pub fn samples(self) -> impl Iterator<Item = SampleId> {
        (self.first.0..self.first.0 + self.count as u64).map(SampleId)
    }
}

/// How the samples of a campaign are divided into parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    samples: u64,
    size: u64,
}

impl Parts {
    /// The parts of a campaign of `samples` samples.
    pub fn of(samples: u64) -> Self {
        let size = samples.div_ceil(AIM).next_multiple_of(64).clamp(SMALLEST, LARGEST);
        Parts { samples, size }
    }

    /// Number of parts.
    pub fn count(self) -> u64 {
        self.samples.div_ceil(self.size)
    }

    /// Number of samples of every part but the last, which may have fewer.
    pub fn size(self) -> usize {
        self.size as usize
    }

    /// The part `id`; `None` after the last.
    pub fn part(self, id: PartId) -> Option<Part> {
        let first = id.0.checked_mul(self.size).filter(|first| *first < self.samples)?;
        let count = self.size.min(self.samples - first) as usize;
        Some(Part { id, first: SampleId(first), count })
    }

    /// All parts in order.
    pub fn iter(self) -> impl Iterator<Item = Part> {
        (0..self.count()).filter_map(move |id| self.part(PartId(id)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: every sample is in exactly one part, in order, and sizes are within their bounds.
    #[test]
    fn parts_tile_the_samples() {
        for samples in [0, 1, 255, 256, 257, 4096, 4097, 100_000, 1_000_000, 1_000_003] {
            let parts = Parts::of(samples);
            let mut next = 0;
            for part in parts.iter() {
                assert_eq!(part.first.0, next, "{samples} samples");
                assert!(part.count >= 1 && part.count <= LARGEST as usize);
                assert_eq!(part.samples().count(), part.count);
                next += part.count as u64;
            }
            assert_eq!(next, samples);
            assert_eq!(parts.part(PartId(parts.count())), None);
        }
    }

    /// Law: the size of a part is bounded, and so is memory.
    #[test]
    fn size_is_bounded() {
        assert_eq!(Parts::of(1).size(), SMALLEST as usize);
        assert_eq!(Parts::of(u64::MAX / 2).size(), LARGEST as usize);
        assert_eq!(Parts::of(4096).size(), 256);
    }

    /// Law: there is no part after the last, however large its number is.
    #[test]
    fn no_part_after_the_last() {
        assert_eq!(Parts::of(4096).part(PartId(16)), None);
        assert_eq!(Parts::of(4096).part(PartId(u64::MAX)), None);
    }
}
