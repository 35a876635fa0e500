//! [`Parts`]: a campaign cut into parts of consecutive samples.
//!
//! Where the cuts are follows from the number of samples alone, never from threads or machine: a part is what a thread takes,
//! what a file holds, and what a shard or a resumed campaign will count in.

use crate::sampling::SampleId;

/// The smallest part: below it, opening a file costs more than the runs in it.
const SMALLEST: u64 = 256;

/// The largest part: its rows (about a hundred columns) stay near 10 MB for each thread.
const LARGEST: u64 = 16_384;

/// A campaign is cut into about this many parts, so that threads end at nearly the same time.
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
    /// How many samples it holds, at least one.
    pub count: usize,
}

impl Part {
    /// Its samples in ascending order.
    pub fn samples(self) -> impl Iterator<Item = SampleId> {
        (self.first.0..self.first.0 + self.count as u64).map(SampleId)
    }
}

/// How a campaign is cut into parts.
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

    /// Number of samples of every part but the last, which may hold fewer.
    pub fn size(self) -> usize {
        self.size as usize
    }

    /// The part numbered `id`, or `None` behind the last.
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

    /// Law: the parts hold every sample exactly once, in order, and sizes keep their bounds.
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

    /// Law: a bigger campaign does not need bigger parts for ever, so memory stays flat.
    #[test]
    fn size_is_bounded() {
        assert_eq!(Parts::of(1).size(), SMALLEST as usize);
        assert_eq!(Parts::of(u64::MAX / 2).size(), LARGEST as usize);
        assert_eq!(Parts::of(4096).size(), 256);
    }

    /// Law: a number behind the last part is no part, however large it is.
    #[test]
    fn no_part_behind_the_last() {
        assert_eq!(Parts::of(4096).part(PartId(16)), None);
        assert_eq!(Parts::of(4096).part(PartId(u64::MAX)), None);
    }
}
