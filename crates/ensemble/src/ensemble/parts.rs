//! [`Parts`]: a campaign's parts of consecutive samples.
//!
//! A part is a thread's work, a file's content and the unit of resuming and sharding. Its boundaries do not depend on
//! threads, machine, shards or the number of samples. Sizes grow, so that all threads share a small campaign and a
//! large one has few files.

use crate::sampling::SampleId;

/// First size: below, creating a file costs more than the runs.
const SMALLEST: u64 = 256;

/// Rows of a hundred columns take some 10 MB per thread.
const LARGEST: u64 = 16_384;

const OF_ONE_SIZE: u64 = 16;

/// Size of the next [`OF_THE_USUAL_SIZE`] parts: rows of two threads fit in a shared cache, and memory is constant from
/// a hundred thousand to ten million samples; beyond, the number of files matters more.
const USUAL: u64 = 4096;

const OF_THE_USUAL_SIZE: u64 = 2560;

/// From zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PartId(pub u64);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    pub id: PartId,
    /// First sample, counted among those that run.
    pub first: SampleId,
    /// At least one.
    pub count: usize,
}

impl Part {
    /// Counted among those that run.
    pub fn samples(self) -> impl Iterator<Item = SampleId> {
        (self.first.0..self.first.0 + self.count as u64).map(SampleId)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    samples: u64,
    largest: u64,
}

impl Parts {
    pub fn of(samples: u64) -> Self {
        Self::up_to(samples, LARGEST)
    }

    /// Parts of at most `largest` (at least 1) samples.
    pub fn up_to(samples: u64, largest: u64) -> Self {
        Parts { samples, largest: largest.clamp(1, LARGEST) }
    }

    #[must_use]
    pub fn with_samples(self, samples: u64) -> Self {
        Parts { samples, ..self }
    }

    /// Sizes and numbers of parts; the last has no end.
    fn sizes(self) -> impl Iterator<Item = (u64, Option<u64>)> {
        let mut size = SMALLEST.min(self.largest);
        std::iter::from_fn(move || {
            let now = size;
            size = (2 * size).min(self.largest);
            let many = if now == USUAL { OF_THE_USUAL_SIZE } else { OF_ONE_SIZE };
            Some((now, (now < self.largest).then_some(many)))
        })
    }

    pub fn largest(self) -> u64 {
        self.largest
    }

    pub fn samples(self) -> u64 {
        self.samples
    }

    pub fn count(self) -> u64 {
        let (mut left, mut parts) = (self.samples, 0);
        for (size, many) in self.sizes() {
            let needed = left.div_ceil(size);
            match many {
                Some(many) if needed > many => (left, parts) = (left - many * size, parts + many),
                _ => return parts + needed,
            }
        }
        parts
    }

    pub fn part(self, id: PartId) -> Option<Part> {
        let (mut first, mut index) = (0_u64, id.0);
        for (size, many) in self.sizes() {
            match many {
                Some(many) if index >= many => (first, index) = (first + many * size, index - many),
                _ => {
                    let first = first.checked_add(index.checked_mul(size)?).filter(|first| *first < self.samples)?;
                    let count = size.min(self.samples - first) as usize;
                    return Some(Part { id, first: SampleId(first), count });
                }
            }
        }
        None
    }

    /// The part of a sample; `None` after the last.
    pub fn with(self, sample: SampleId) -> Option<Part> {
        let (mut first, mut id) = (0_u64, 0_u64);
        for (size, many) in self.sizes() {
            match many {
                Some(many) if sample.0 - first >= many * size => (first, id) = (first + many * size, id + many),
                _ => return self.part(PartId(id + (sample.0 - first) / size)),
            }
        }
        None
    }

    pub fn iter(self) -> impl Iterator<Item = Part> {
        (0..self.count()).filter_map(move |id| self.part(PartId(id)))
    }
}

impl IntoIterator for Parts {
    type Item = Part;
    type IntoIter = Box<dyn Iterator<Item = Part>>;

    fn into_iter(self) -> Self::IntoIter {
        Box::new(self.iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NUMBERS: [u64; 11] = [0, 1, 255, 256, 257, 4096, 4097, 100_000, 1_000_000, 1_000_003, 5_000_000];

    #[test]
    fn parts_tile_the_samples() {
        for (samples, largest) in
            NUMBERS.into_iter().flat_map(|samples| [(samples, LARGEST), (samples, 1000), (samples.min(3000), 7)])
        {
            let parts = Parts::up_to(samples, largest);
            let mut next = 0;
            for part in parts.iter() {
                assert_eq!(part.first.0, next, "{samples} samples");
                assert!(part.count >= 1 && part.count <= largest as usize);
                assert_eq!(part.samples().count(), part.count);
                assert_eq!(parts.with(part.first), Some(part));
                assert_eq!(parts.with(SampleId(next + part.count as u64 - 1)), Some(part));
                next += part.count as u64;
            }
            assert_eq!(next, samples);
            assert_eq!(parts.part(PartId(parts.count())), None);
        }
    }

    #[test]
    fn boundaries_do_not_depend_on_the_number_of_samples() {
        for largest in [LARGEST, 1000, 7] {
            let all = Parts::up_to(200_000, largest);
            for samples in [1_u64, 300, 4097, 77_777, 199_999] {
                let parts = Parts::up_to(samples, largest);
                for part in parts.iter().take(parts.count() as usize - 1) {
                    assert_eq!(all.part(part.id), Some(part), "{samples} samples");
                }
                let last = parts.part(PartId(parts.count() - 1)).unwrap();
                assert_eq!(all.part(last.id).unwrap().first, last.first, "{samples} samples");
            }
        }
    }
}
