//! [`DeviationWindow`]: counts of deviations in a column of bands.

use crate::statistics::deviation::{Code, MANTISSA_BITS, NOT_A_NUMBER, ZERO};

#[derive(Clone, Debug, Default)]
pub(super) struct DeviationWindow<C> {
    first: Code,
    counts: Vec<C>,
    zeros: C,
}

pub(super) const FULL: usize = u16::MAX as usize;

const CACHE_LINE: usize = 32;

/// Counts tested together: outer octaves are mostly zero.
const BLOCK: usize = 16;

/// Windows grow by whole octaves, of both signs.
const OCTAVE: usize = 2 << MANTISSA_BITS;

impl<C: Copy + Default + Into<u64>> DeviationWindow<C> {
    /// `None` beyond the window, and for zero and NaN.
    #[inline(always)]
    fn counter(&mut self, code: Code) -> Option<&mut C> {
        self.counts.get_mut(usize::from(code.wrapping_sub(self.first)))
    }

    /// The counter beyond the window, which grows; `None` for NaN.
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

    /// Non-empty buckets in ascending order.
    pub(super) fn buckets(&self) -> impl Iterator<Item = (Code, u64)> {
        let is_empty = |block: &[C]| block.iter().fold(0, |any, count| any | (*count).into()) == 0;
        let blocks = self.counts.chunks(BLOCK).zip((usize::from(self.first)..).step_by(BLOCK));
        let window = blocks
            .filter(move |(block, _)| !is_empty(block))
            .flat_map(|(block, first)| block.iter().zip(first..).map(|(count, code)| (code as Code, (*count).into())));
        std::iter::once((ZERO, self.zeros.into())).chain(window).filter(|(_, count)| *count > 0)
    }
}

/// 16-bit counts of one part: a column fits in the first-level cache.
impl DeviationWindow<u16> {
    pub(super) fn clear(&mut self) {
        self.counts.fill(0);
        self.zeros = 0;
    }

    /// Counts fewer than [`FULL`] deviations, without NaN.
    pub(super) fn add(&mut self, codes: &[Code]) {
        // reading in order prefetches the window, which other work has evicted
        std::hint::black_box(self.counts.iter().step_by(CACHE_LINE).fold(0, |any, count| any | count));
        let mut codes = codes.iter();
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
