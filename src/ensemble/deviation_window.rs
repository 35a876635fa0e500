//! [`DeviationWindow`]: counts of deviations in one column of bands, cheap to add to.

use crate::statistics::deviation::{Code, MANTISSA_BITS, NOT_A_NUMBER, ZERO};

#[derive(Clone, Debug, Default)]
pub(super) struct DeviationWindow<C> {
    first: Code,
    counts: Vec<C>,
    zeros: C,
}

/// Runs that may fill counts of 16 bits.
pub(super) const FULL: usize = u16::MAX as usize;

const CACHE_LINE: usize = 32;

/// Counts tested together: most blocks in the outer octaves are zero.
const BLOCK: usize = 16;

/// Windows grow by whole octaves, of both signs.
const OCTAVE: usize = 2 << MANTISSA_BITS;

impl<C: Copy + Default + Into<u64>> DeviationWindow<C> {
    /// The counter of a bucket; `None` beyond the window, and for zero and NaN.
    #[inline(always)]
    fn counter(&mut self, code: Code) -> Option<&mut C> {
        self.counts.get_mut(usize::from(code.wrapping_sub(self.first)))
    }

    /// The counter of a bucket beyond the window, which is widened; `None` for NaN, which is in no bucket.
    #[inline(never)]
    fn counter_beyond(&mut self, code: Code) -> Option<&mut C> {
        match code {
            ZERO => Some(&mut self.zeros),
            NOT_A_NUMBER => None,
            _ => {
                self.include(usize::from(code));
                self.counter(code)
            }
        }
    }

    /// Widens the window to hold `code`, but never the codes of zero and NaN.
    fn include(&mut self, code: usize) {
        let from = (code / OCTAVE * OCTAVE).max(usize::from(NOT_A_NUMBER) + 1);
        let to = (code / OCTAVE + 1) * OCTAVE;
        if self.counts.is_empty() {
            (self.first, self.counts) = (from as Code, vec![C::default(); to - from]);
            return;
        }
        let first = usize::from(self.first);
        if from < first {
            self.counts.splice(0..0, std::iter::repeat_n(C::default(), first - from));
            self.first = from as Code;
        }
        let length = to - usize::from(self.first);
        self.counts.resize(length.max(self.counts.len()), C::default());
    }

    /// The buckets that are not empty, in ascending order of their codes.
    pub(super) fn buckets(&self) -> impl Iterator<Item = (Code, u64)> {
        let is_empty = |block: &[C]| block.iter().fold(0, |any, count| any | (*count).into()) == 0;
        let blocks = self.counts.chunks(BLOCK).zip((usize::from(self.first)..).step_by(BLOCK));
        let window = blocks
            .filter(move |(block, _)| !is_empty(block))
            .flat_map(|(block, first)| block.iter().zip(first..).map(|(count, code)| (code as Code, (*count).into())));
        std::iter::once((ZERO, self.zeros.into())).chain(window).filter(|(_, count)| *count > 0)
    }
}

/// Of one part: 16-bit counts, so that a column fits in the first-level cache.
impl DeviationWindow<u16> {
    pub(super) fn clear(&mut self) {
        self.counts.fill(0);
        self.zeros = 0;
    }

    /// Counts fewer than [`FULL`] deviations; NaN is in no bucket.
    pub(super) fn add(&mut self, codes: &[Code]) {
        // other work has evicted the window from the caches; reading it in order prefetches it
        std::hint::black_box(self.counts.iter().step_by(CACHE_LINE).fold(0, |any, count| any | count));
        let mut codes = codes.iter();
        // the window is fixed until a code is beyond it
        loop {
            let (first, counts, zeros) = (self.first, &mut self.counts[..], &mut self.zeros);
            let beyond = codes.find(|code| match counts.get_mut(usize::from(code.wrapping_sub(first))) {
                Some(count) => {
                    *count += 1;
                    false
                }
                None => {
                    *zeros += u16::from(**code == ZERO);
                    **code != ZERO
                }
            });
            let Some(beyond) = beyond else { return };
            self.counter_beyond(*beyond).into_iter().for_each(|count| *count += 1);
        }
    }
}

impl DeviationWindow<u64> {
    pub(super) fn add_buckets(&mut self, buckets: impl Iterator<Item = (Code, u64)>) {
        for (code, count) in buckets {
            let counter = match self.counter(code) {
                Some(counter) => Some(counter),
                None => self.counter_beyond(code),
            };
            counter.into_iter().for_each(|counter| *counter += count);
        }
    }
}
