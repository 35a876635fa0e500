//! [`DeviationWindow`]: counts of deviations of one column of bands, in a form in which adding is cheap; [`DeviationSums`]: of many parts.

use crate::statistics::carries::Carries;
use crate::statistics::deviation::{Code, DeviationCounts, MANTISSA_BITS, NOT_A_NUMBER, ZERO};

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

/// Windows grow by whole octaves, of both signs.
const OCTAVE: usize = 2 << MANTISSA_BITS;

impl<C: Copy + Default> DeviationWindow<C> {
    /// The counter of a bucket; `None` where the window has to be widened first, and for zero and what is not a number.
    #[inline(always)]
    fn counter(&mut self, code: Code) -> Option<&mut C> {
        self.counts.get_mut(usize::from(code.wrapping_sub(self.first)))
    }

    /// The counter of a bucket beyond the window, which is widened; `None` for what is not a number, which is in no bucket.
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

    /// The count of zero, the code of the first other count, and those counts.
    pub(super) fn parts(&self) -> (C, Code, &[C]) {
        (self.zeros, self.first, &self.counts)
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

/// Sums of the counts of a column, of any number of runs.
#[derive(Clone, Debug, Default)]
pub(super) struct DeviationSums {
    window: DeviationWindow<u32>,
    carries: Carries,
}

impl DeviationSums {
    /// Counts all that is in `buckets`.
    pub(super) fn add(&mut self, buckets: impl Iterator<Item = (Code, u64)>) {
        for (code, count) in buckets {
            let counter = match self.window.counter(code) {
                Some(counter) => Some(counter),
                None => self.window.counter_beyond(code),
            };
            counter.into_iter().for_each(|counter| self.carries.add(u32::from(code), counter, count));
        }
    }

    /// The buckets that are not empty.
    pub(super) fn counted(&self) -> DeviationCounts {
        let (zeros, first, counts) = self.window.parts();
        let window = counts.iter().zip(usize::from(first)..).map(|(count, code)| (code as Code, *count));
        let buckets = std::iter::once((ZERO, zeros)).chain(window);
        let whole = buckets.map(|(code, low)| (code, self.carries.whole(u32::from(code), low)));
        DeviationCounts::of(whole.filter(|(_, count)| *count > 0).collect()).expect("in the order of the codes")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::deviation::code;

    /// What a window has counted.
    fn counted(window: &DeviationWindow<u16>) -> DeviationCounts {
        let (zeros, first, counts) = window.parts();
        let codes = (usize::from(first)..).map(|code| code as Code);
        let all = std::iter::once((ZERO, zeros)).chain(codes.zip(counts.iter().copied()));
        DeviationCounts::of(all.filter(|(_, count)| *count > 0).map(|(code, count)| (code, count.into())).collect())
            .expect("in the order of the codes")
    }

    /// Law: a window counts every code once, in whichever order they come and however it has to grow; zero is counted, what is not a
    /// number is not.
    #[test]
    fn a_window_counts_every_code() {
        let values = [1.0, -1.0, 1e-9, 0.0, f64::NAN, 1e12, -3e-200, 1.0, 1e77, f64::INFINITY, 0.0, 1e-77, -1e-77];
        for turn in 0..values.len() {
            let mut window = DeviationWindow::<u16>::default();
            let mut turned = values;
            turned.rotate_left(turn);
            window.add(&turned.map(code));
            let mut codes: Vec<Code> = values.iter().map(|value| code(*value)).filter(|c| *c != NOT_A_NUMBER).collect();
            codes.sort_unstable();
            let expected = codes.chunk_by(|a, b| a == b).map(|run| (run[0], run.len() as u64)).collect();
            assert_eq!(Some(counted(&window)), DeviationCounts::of(expected), "{turn}");
            window.clear();
            assert_eq!(counted(&window), DeviationCounts::default());
        }
    }

    /// Law: however deviations are divided into parts, and in whichever order the parts are added, the sums are the same; they go on
    /// beyond 2^32.
    #[test]
    fn adding_has_no_order() {
        let values: Vec<f64> = (0..600).map(|k| libm::sin(f64::from(k)) * libm::exp2(f64::from(k % 90 - 60))).collect();
        let of = |values: &[f64]| {
            let mut window = DeviationWindow::<u16>::default();
            window.add(&values.iter().map(|value| code(*value)).collect::<Vec<Code>>());
            counted(&window)
        };
        let sums_of = |parts: &[DeviationCounts]| {
            let mut sums = DeviationSums::default();
            parts.iter().for_each(|part| sums.add(part.buckets().iter().copied()));
            sums.counted()
        };
        for size in [1, 7, 100, 599] {
            let mut parts: Vec<DeviationCounts> = values.chunks(size).map(of).collect();
            for _ in 0..2 {
                assert_eq!(sums_of(&parts), of(&values), "parts of {size}");
                parts.reverse();
            }
        }
        // counter-test: a part that is added twice
        assert_ne!(sums_of(&[&values[..300], &values[..300], &values[300..]].map(of)), of(&values));
        let many = DeviationCounts::of(vec![(ZERO, 3 << 31), (70, (1 << 40) + 1)]).expect("two buckets");
        let twice = DeviationCounts::of(vec![(ZERO, 3 << 32), (70, (1 << 41) + 2)]);
        assert_eq!(Some(sums_of(&[many.clone(), many])), twice);
    }
}
