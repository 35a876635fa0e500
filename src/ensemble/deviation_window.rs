//! [`DeviationWindow`]: counts of deviations of one column of bands, in a form in which adding is cheap.

use crate::statistics::deviation::{Code, DeviationCounts, MANTISSA_BITS, NOT_A_NUMBER, ZERO};

/// A count.
pub(super) trait Count: Copy + Default + std::ops::AddAssign + From<u8> + Into<u64> {}

impl Count for u16 {}
impl Count for u64 {}

/// The counts of the buckets between two magnitudes, for one column. Of 16 bits while runs are counted, so that those of a column fit in the
/// first-level cache.
#[derive(Clone, Debug, Default)]
pub(super) struct DeviationWindow<C> {
    /// The code of the first count.
    first: Code,
    counts: Vec<C>,
    zeros: C,
}

/// Runs after which counts of 16 bits may be full.
pub(super) const FULL: usize = u16::MAX as usize;

/// Windows grow by whole octaves, of both signs.
const OCTAVE: usize = 2 << MANTISSA_BITS;

impl<C: Count> DeviationWindow<C> {
    /// Empties it; the buckets remain.
    pub(super) fn clear(&mut self) {
        self.counts.fill(C::default());
        self.zeros = C::default();
    }

    /// Counts a deviation; what is not a number is in no bucket.
    #[inline(always)]
    pub(super) fn add(&mut self, code: Code) {
        match self.counts.get_mut(usize::from(code.wrapping_sub(self.first))) {
            Some(count) => *count += C::from(1),
            None => self.add_beyond(code, C::from(1)),
        }
    }

    #[inline(never)]
    fn add_beyond(&mut self, code: Code, count: C) {
        if code == ZERO {
            self.zeros += count;
        } else if code != NOT_A_NUMBER {
            self.include(usize::from(code));
            self.counts[usize::from(code - self.first)] += count;
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

    /// The buckets that are not empty.
    pub(super) fn counted(&self) -> DeviationCounts {
        let zeros = std::iter::once((ZERO, self.zeros.into()));
        let window =
            self.counts.iter().zip(usize::from(self.first)..).map(|(count, code)| (code as Code, (*count).into()));
        let buckets = zeros.chain(window).filter(|(_, count)| *count > 0).collect();
        DeviationCounts::of(buckets).expect("a window is in the order of its codes")
    }
}

impl DeviationWindow<u64> {
    /// Counts all that `counts` has counted.
    pub(super) fn add_counts(&mut self, counts: &DeviationCounts) {
        for (code, count) in counts.buckets() {
            match self.counts.get_mut(usize::from(code.wrapping_sub(self.first))) {
                Some(sum) => *sum += count,
                None => self.add_beyond(*code, *count),
            }
        }
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
            let mut window = DeviationWindow::<u16>::default();
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

    /// Law: however deviations are divided into parts, and in whichever order the parts are added, the counts are the same.
    #[test]
    fn adding_has_no_order() {
        let values: Vec<f64> = (0..600).map(|k| libm::sin(f64::from(k)) * libm::exp2(f64::from(k % 90 - 60))).collect();
        let counted = |values: &[f64]| {
            let mut window = DeviationWindow::<u16>::default();
            values.iter().for_each(|value| window.add(code(*value)));
            window.counted()
        };
        for size in [1, 7, 100, 599] {
            let mut parts: Vec<DeviationCounts> = values.chunks(size).map(counted).collect();
            for _ in 0..2 {
                let mut sums = DeviationWindow::<u64>::default();
                parts.iter().for_each(|part| sums.add_counts(part));
                assert_eq!(sums.counted(), counted(&values), "parts of {size}");
                parts.reverse();
            }
        }
        // counter-test: a part that is added twice
        let mut sums = DeviationWindow::<u64>::default();
        [&values[..300], &values[..300], &values[300..]].into_iter().for_each(|part| sums.add_counts(&counted(part)));
        assert_ne!(sums.counted(), counted(&values));
    }
}
