//! [`DeviationWindow`]: counts of deviations of one column of bands, in a form in which adding is cheap.

use crate::statistics::deviation::{Code, MANTISSA_BITS, NOT_A_NUMBER, ZERO};

/// The counts of the buckets between two magnitudes, for one column.
#[derive(Clone, Debug, Default)]
pub(super) struct DeviationWindow<C> {
    /// The code of the first count.
    first: Code,
    counts: Vec<C>,
    zeros: C,
}

/// Runs after which counts of 16 bits may be full.
pub(super) const FULL: usize = u16::MAX as usize;

/// Counts in a cache line.
const CACHE_LINE: usize = 32;

/// Counts that are looked at together: where all are zero, as most are in the outer octaves, none is looked at alone.
const BLOCK: usize = 16;

/// Windows grow by whole octaves, of both signs.
const OCTAVE: usize = 2 << MANTISSA_BITS;

impl<C: Copy + Default + Into<u64>> DeviationWindow<C> {
    /// The counter of a bucket; `None` where the window has to be widened first, and for zero and what is not a number.
    #[inline(always)]
    fn counter(&mut self, code: Code) -> Option<&mut C> {
        self.counts.get_mut(usize::from(code.wrapping_sub(self.first)))
    }

    /// The counter of a bucket beyond the window, which is widened; `None` for what is not a number, which is in no
    /// bucket.
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

    /// Widens the window until it has `code`; never by the codes of zero and of what is not a number.
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

/// Of one part: counts of 16 bits, so that those of a column fit in the first-level cache.
impl DeviationWindow<u16> {
    /// Empties it; the buckets remain.
    pub(super) fn clear(&mut self) {
        self.counts.fill(0);
        self.zeros = 0;
    }

    /// Counts deviations, of fewer than [`FULL`]; what is not a number is in no bucket.
    pub(super) fn add(&mut self, codes: &[Code]) {
        // other work has driven the window out of the caches; read in order, it is fetched ahead
        std::hint::black_box(self.counts.iter().step_by(CACHE_LINE).fold(0, |any, count| any | count));
        let mut codes = codes.iter();
        // the window stays where it is until a code is beyond it
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

/// Sums over parts, of any number of runs.
impl DeviationWindow<u64> {
    /// Counts all that is in `buckets`; what is not a number is in no bucket.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::deviation::code;

    /// The same counted one by one.
    fn expected(codes: &[Code]) -> Vec<(Code, u64)> {
        let mut codes: Vec<Code> = codes.iter().copied().filter(|code| *code != NOT_A_NUMBER).collect();
        codes.sort_unstable();
        codes.chunk_by(|a, b| a == b).map(|run| (run[0], run.len() as u64)).collect()
    }

    /// Law: a window counts every code once, in whichever order they come and however it has to grow; zero is counted,
    /// what is not a number is not.
    #[test]
    fn a_window_counts_every_code() {
        let values = [1.0, -1.0, 1e-9, 0.0, f64::NAN, 1e12, -3e-200, 1.0, 1e77, f64::INFINITY, 0.0, 1e-77, -1e-77];
        for turn in 0..values.len() {
            let mut window = DeviationWindow::<u16>::default();
            let mut codes = values.map(code);
            codes.rotate_left(turn);
            window.add(&codes);
            assert_eq!(window.buckets().collect::<Vec<_>>(), expected(&codes), "{turn}");
            window.clear();
            assert_eq!(window.buckets().count(), 0);
        }
    }

    /// Law: however deviations are divided into parts, and in whichever order the parts are added, the sums are the
    /// same; they go on beyond 2^32.
    #[test]
    fn adding_has_no_order() {
        let value = |k: u32| libm::sin(f64::from(k)) * libm::exp2(f64::from(k % 90) - 60.0);
        let codes: Vec<Code> = (0..600).map(|k| code(value(k))).collect();
        let sums_of = |parts: &[&[Code]]| {
            let mut sums = DeviationWindow::<u64>::default();
            for part in parts {
                let mut window = DeviationWindow::<u16>::default();
                window.add(part);
                sums.add_buckets(window.buckets());
            }
            sums.buckets().collect::<Vec<_>>()
        };
        for size in [1, 7, 100, 599] {
            let mut parts: Vec<&[Code]> = codes.chunks(size).collect();
            for _ in 0..2 {
                assert_eq!(sums_of(&parts), expected(&codes), "parts of {size}");
                parts.reverse();
            }
        }
        // counter-test: a part that is added twice
        assert_ne!(sums_of(&[&codes[..300], &codes[..300], &codes[300..]]), expected(&codes));
        let mut many = DeviationWindow::<u64>::default();
        (0..2).for_each(|_| many.add_buckets([(ZERO, 3 << 31), (70, (1 << 40) + 1)].into_iter()));
        assert_eq!(many.buckets().collect::<Vec<_>>(), [(ZERO, 3 << 32), (70, (1 << 41) + 2)]);
    }
}
