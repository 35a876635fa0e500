//! [`Sketch`]: a mergeable histogram from which order statistics of any number of samples are read.
//!
//! A bucket holds the numbers that share sign, exponent and the leading [`MANTISSA_BITS`] bits of the mantissa (after
//! HdrHistogram, G. Tene 2012, and DDSketch, Masson, Rim & Lee 2019). Its middle is within 0.05% of any quantile in it.
//! Merging adds counts, in any order.
//!
//! A sketch about a reference ([`Sketch::about`]) counts numbers nearer to the reference than to zero by their
//! deviation; quantiles are within 0.05% of the magnitude and of the deviation. Magnitudes below 2^-1022 count as zero.

use fearless_simd::Simd;

use super::carries::Carries;
use super::moments::Moments;
pub use super::ranks::{Ranks, middle};
use crate::math::Isa;
use crate::math::isa::Work;

/// Leading mantissa bits of a bucket.
pub const MANTISSA_BITS: u32 = 10;

/// Largest relative error of a quantile of normal numbers: half a bucket.
pub const RELATIVE_ERROR: f64 = 1.0 / 2048.0;

const PAGE: usize = 1 << MANTISSA_BITS;
/// Pages of one scale: signs and exponents.
const SCALE: u16 = 1 << 12;
/// Marks a missing page; the two scales, of numbers and of deviations, have fewer.
const NO_PAGE: u16 = u16::MAX;
/// Buckets of a cache line.
const CACHE_LINE: usize = 16;
const SHIFT: u32 = 52 - MANTISSA_BITS;

/// Counts of numbers by their leading bits, with exact extremes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sketch {
    /// Zero if numbers are counted by themselves.
    reference: f64,
    /// A page of buckets for each sign and exponent that occurred, ascending.
    pages: Vec<(u16, Box<[u32; PAGE]>)>,
    /// Carries of the buckets, by key.
    carries: Carries,
    count: u64,
    min: f64,
    max: f64,
}

impl Default for Sketch {
    fn default() -> Self {
        Self::about(0.0)
    }
}

/// Inverse of the order-preserving map: sign bit set for positive numbers, all bits inverted for negative ones.
fn unordered(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 { key & !(1 << 63) } else { !key })
}

/// Keys of buckets by numbers.
#[derive(Clone, Copy)]
struct Places {
    reference: f64,
    sign: f64,
    /// |reference|/2.
    half: f64,
}

impl Places {
    fn about(reference: f64) -> Self {
        let sign = if reference == 0.0 { 0.0 } else { reference.signum() };
        Places { reference, sign, half: 0.5 * reference.abs() }
    }

    /// Key of `value`; keys ascend with numbers. Numbers by themselves come before deviations from a positive
    /// reference, and after those from a negative one. Branch-free, so that loops vectorise.
    #[inline(always)]
    fn of(self, value: f64) -> u32 {
        let is_near = self.sign * value > self.half;
        let counted = value - if is_near { self.reference } else { 0.0 };
        let counted = if counted.abs() < f64::MIN_POSITIVE { 0.0 } else { counted };
        // unsigned order is numeric order, see `unordered`
        let upper = (counted.to_bits() >> 32) as u32;
        let flipped = (upper.cast_signed() >> 31).cast_unsigned() | 1 << 31;
        let is_upper = is_near ^ (self.sign < 0.0);
        ((upper ^ flipped) >> (SHIFT - 32)) | (u32::from(is_upper) * UPPER)
    }
}

/// Leading bit of the upper of the two scales.
const UPPER: u32 = (SCALE as u32) << MANTISSA_BITS;

impl Sketch {
    /// An empty sketch about `reference`: a number near the expected ones, or zero.
    pub fn about(reference: f64) -> Self {
        let (min, max) = (f64::INFINITY, f64::NEG_INFINITY);
        Sketch { reference, pages: Vec::new(), carries: Carries::default(), count: 0, min, max }
    }

    /// Counts a number, except NaN.
    pub fn add(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        let value = value + 0.0; // turns -0 into 0, so that the extremes do not depend on order
        let key = Places::about(self.reference).of(value);
        let at = self.page_index((key >> MANTISSA_BITS) as u16);
        self.carries.add(key, &mut self.pages[at].1[key as usize % PAGE], 1);
        self.count += 1;
        self.min = self.min.min(value);
        self.max = self.max.max(value);
    }

    /// Counts several.
    pub fn add_all(&mut self, values: &[f64]) {
        self.add_block(values, &Moments::of_block(values));
    }

    /// [`Sketch::add_all`] with known moments.
    pub fn add_block(&mut self, values: &[f64], moments: &Moments) {
        let (min, max) = (moments.min().unwrap_or(f64::INFINITY), moments.max().unwrap_or(f64::NEG_INFINITY));
        // false without numbers
        if min <= max {
            // -0 becomes 0, as in `add`
            let ends = [min + 0.0, max + 0.0];
            Isa::best().run(Counting { sketch: self, values, ends });
        }
    }

    /// Adds the counts of `other`; an empty sketch takes over its reference.
    ///
    /// # Panics
    /// If both are nonempty and have different references.
    pub fn merge(&mut self, other: &Sketch) {
        if other.count == 0 {
            return;
        }
        if self.count == 0 {
            self.reference = other.reference;
        }
        assert_eq!(self.reference.to_bits(), other.reference.to_bits(), "sketches about one reference");
        other.for_each_bucket(|number, bucket, count| {
            let at = self.page_index(number);
            self.carries.add(key(number, bucket), &mut self.pages[at].1[bucket], count);
        });
        self.count += other.count;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Number of numbers.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Exact maximum, if any.
    pub fn max(&self) -> Option<f64> {
        (self.count > 0).then_some(self.max)
    }

    /// Exact minimum, if any.
    pub fn min(&self) -> Option<f64> {
        (self.count > 0).then_some(self.min)
    }

    /// The `p`-quantile of type 7, if any; for several use [`Sketch::ranks`].
    pub fn quantile(&self, p: f64) -> Option<f64> {
        self.ranks().quantile(p)
    }

    /// Visits the nonempty buckets in ascending order: page, bucket in the page, count.
    #[inline(always)]
    fn for_each_bucket(&self, mut visit: impl FnMut(u16, usize, u64)) {
        for (number, page) in &self.pages {
            for (line, counts) in page.chunks(CACHE_LINE).enumerate() {
                // most lines are empty
                let are_empty = counts.iter().fold(0, |any, count| any | count) == 0;
                if are_empty && self.carries.is_empty() {
                    continue;
                }
                for (low, bucket) in counts.iter().zip(line * CACHE_LINE..) {
                    let count = self.carries.whole(key(*number, bucket), *low);
                    if count > 0 {
                        visit(*number, bucket, count);
                    }
                }
            }
        }
    }

    /// Ends of a bucket.
    fn ends(&self, number: u16, bucket: usize) -> [f64; 2] {
        let [low, high] = ends(number % SCALE, bucket);
        // the bucket of an infinity reaches into the NaNs
        let [low, high] = [if low.is_nan() { high } else { low }, if high.is_nan() { low } else { high }];
        let is_near = self.reference != 0.0 && (number >= SCALE) == (self.reference > 0.0);
        if !is_near {
            return [low, high];
        }
        let [near, far] = [self.reference + low, self.reference + high];
        // deviations and sums are rounded; the reference itself is exact
        if low == high { [near, far] } else { [near.next_down(), far.next_up()] }
    }

    /// Writes the index of each page to `at`, whose first entry is for page `first`.
    fn note_pages(&self, first: u32, at: &mut [u16]) {
        for (index, (number, _)) in self.pages.iter().enumerate() {
            let place = u32::from(*number).checked_sub(first).and_then(|place| at.get_mut(place as usize));
            place.into_iter().for_each(|place| *place = index as u16);
        }
    }

    /// Index of a page, inserted if missing.
    fn page_index(&mut self, number: u16) -> usize {
        match self.pages.binary_search_by_key(&number, |(number, _)| *number) {
            Ok(at) => at,
            Err(at) => {
                self.pages.insert(at, (number, Box::new([0; PAGE])));
                at
            }
        }
    }

    /// The order statistics.
    pub fn ranks(&self) -> Ranks {
        let mut buckets = Vec::new();
        self.for_each_bucket(|number, bucket, count| {
            let [low, high] = self.ends(number, bucket);
            // the extremes are exact
            let ends = if low < high { [low.max(self.min), high.min(self.max)] } else { [low, high] };
            buckets.push((ends, count));
        });
        Ranks::of(buckets)
    }
}

/// Counts numbers of a list except NaN.
struct Counting<'a> {
    sketch: &'a mut Sketch,
    values: &'a [f64],
    ends: [f64; 2],
}

/// Numbers mapped to keys at once.
const TOGETHER: usize = 64;

impl Work for Counting<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let Counting { sketch, values, ends } = self;
        // touch the pages in order, so that they are prefetched: other work has evicted them
        let pages =
            sketch.pages.iter().map(|(_, page)| page.iter().step_by(CACHE_LINE).fold(0, |any, count| any | count));
        std::hint::black_box(pages.fold(0, |any, count| any | count));
        let places = Places::about(sketch.reference);
        // keys ascend with numbers, so no other page occurs
        let [first, last] = ends.map(|end| places.of(end) >> MANTISSA_BITS);
        let mut at = vec![NO_PAGE; (last - first) as usize + 1];
        sketch.note_pages(first, &mut at);
        let mut keys = [0; TOGETHER];
        for values in values.chunks(TOGETHER) {
            keys.iter_mut().zip(values).for_each(|(key, value)| *key = places.of(*value));
            for (key, _) in keys.iter().zip(values).filter(|(_, value)| !value.is_nan()) {
                let page = ((key >> MANTISSA_BITS) - first) as usize;
                if at[page] == NO_PAGE {
                    sketch.page_index((key >> MANTISSA_BITS) as u16);
                    // later pages have moved
                    sketch.note_pages(first, &mut at);
                }
                let bucket = &mut sketch.pages[usize::from(at[page])].1[*key as usize % PAGE];
                sketch.carries.add(*key, bucket, 1);
                sketch.count += 1;
            }
        }
        (sketch.min, sketch.max) = (sketch.min.min(ends[0]), sketch.max.max(ends[1]));
    }
}

fn key(number: u16, bucket: usize) -> u32 {
    u32::from(number) << MANTISSA_BITS | bucket as u32
}

/// Ends of a bucket on one scale. The bucket of an infinity extends into the NaNs; the bucket of zero holds zero only.
fn ends(number: u16, bucket: usize) -> [f64; 2] {
    let low = (u64::from(number) << MANTISSA_BITS | bucket as u64) << SHIFT;
    if unordered(low) == 0.0 {
        return [0.0; 2];
    }
    [unordered(low), unordered(low | ((1 << SHIFT) - 1))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::quantile::quantile;

    fn sketch(values: &[f64]) -> Sketch {
        let mut sketch = Sketch::default();
        values.iter().for_each(|value| sketch.add(*value));
        sketch
    }

    /// Pseudo-random numbers over 80 octaves and both signs.
    fn spread(k: u64) -> f64 {
        let bits = k.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let magnitude = libm::exp2((bits >> 40) as f64 / f64::from(1 << 24) * 80.0 - 60.0);
        if bits & 1 == 0 { magnitude } else { -magnitude }
    }

    /// Law: bounds enclose order statistics and counts at a limit, quantiles are within the relative error of their
    /// neighbours, extremes are exact.
    #[test]
    fn ranks_are_bounded() {
        let mut values: Vec<f64> = (0..20_000).map(spread).collect();
        let mut added = Sketch::default();
        values.chunks(999).for_each(|part| added.add_all(part));
        assert_eq!(added, sketch(&values));
        let ranks = added.ranks();
        values.sort_by(f64::total_cmp);
        for rank in [1, 2, 57, 10_000, 19_999, 20_000] {
            let [low, high] = ranks.bounds(rank).unwrap();
            let exact = values[rank as usize - 1];
            assert!(low <= exact && exact <= high && high - low <= 2.1 * RELATIVE_ERROR * exact.abs(), "{rank}");
            for limit in [exact, exact * 1.0003] {
                let [least, most] = ranks.at_most(limit);
                let exactly = values.partition_point(|value| *value <= limit) as u64;
                assert!(least <= exactly && exactly <= most && most - least < 30, "{limit}: {least} {exactly} {most}");
            }
        }
        assert_eq!((ranks.bounds(1).unwrap()[0], ranks.bounds(20_000).unwrap()[1]), (values[0], values[19_999]));
        assert_eq!((added.min(), added.max()), (Some(values[0]), Some(values[19_999])));
        assert_eq!((ranks.bounds(20_001), ranks.at_most(-1e99), ranks.at_most(1e99)), (None, [0; 2], [20_000; 2]));
        for p in [0.0, 1e-4, 0.01, 0.3, 0.5, 0.95, 0.999, 1.0] {
            let (found, exact) = (ranks.quantile(p).unwrap(), quantile(&values, p).unwrap());
            let below = (p * 19_999.0) as usize;
            let greater = values[below].abs().max(values[(below + 1).min(19_999)].abs());
            assert!((found - exact).abs() <= RELATIVE_ERROR * greater, "{p}: {found} {exact}");
        }
        assert_eq!(Sketch::default().ranks().quantile(0.5), None);
        let infinite = sketch(&[f64::NEG_INFINITY, 1.0, f64::INFINITY]).ranks();
        assert_eq!((infinite.bounds(1), infinite.bounds(3)), (Some([f64::NEG_INFINITY; 2]), Some([f64::INFINITY; 2])));
    }

    /// Law: for any offset, quantiles about a reference are within the relative error of deviation and magnitude, and
    /// bounds enclose order statistics. Counter-test: without a reference the error is several standard deviations.
    #[test]
    fn an_offset_hides_no_spread() {
        let scores: Vec<f64> = (1..20_000).map(|k| crate::math::normal::quantile(f64::from(k) / 20_000.0)).collect();
        let worst_of = |offset: f64, reference: f64| {
            let mut values: Vec<f64> = scores.iter().map(|z| offset + z).collect();
            let mut sketch = Sketch::about(reference);
            values.iter().for_each(|value| sketch.add(*value));
            let mut parts = Sketch::default();
            for part in values.chunks(777) {
                let mut one = Sketch::about(reference);
                one.add_all(part);
                parts.merge(&one);
            }
            assert_eq!(parts, sketch);
            values.sort_by(f64::total_cmp);
            let ranks = sketch.ranks();
            for rank in [1, 2, 700, 10_000, 19_998, 19_999] {
                let [low, high] = ranks.bounds(rank).unwrap();
                let exact = values[rank as usize - 1];
                assert!(low <= exact && exact <= high, "{offset} {reference} {rank}: {low} {exact} {high}");
                let [least, most] = ranks.at_most(exact);
                assert!(least <= rank && rank <= most, "{offset} {reference}: {least} {rank} {most}");
            }
            let error = |p: f64| (ranks.quantile(p).unwrap() - quantile(&values, p).unwrap()).abs();
            [0.001, 0.05, 0.5, 0.95, 0.999].map(error).into_iter().fold(0.0, f64::max)
        };
        for offset in [0.0_f64, 1.0, -30.0, 1e3, -1e5, 1e9, -1e9] {
            // a reference two standard deviations off: deviations up to 5.1, and the rounding of the offset
            for reference in [offset - 2.0, offset + 2.0] {
                let bound = RELATIVE_ERROR * 5.2 + 4.0 * f64::EPSILON * offset.abs();
                let worst = worst_of(offset, reference);
                assert!(worst <= bound, "{offset}: {worst}");
            }
            // a distant reference does no harm
            let bound = RELATIVE_ERROR * (offset.abs() + 4.0);
            for reference in [1e12, -1e12, -offset] {
                assert!(worst_of(offset, reference) <= bound, "{offset}, {reference}");
            }
        }
        assert!(worst_of(1e5, 0.0) > 2.0, "without a reference");
    }

    /// Law: a median of zeros is zero, even next to subnormal numbers of both signs; NaN is not counted.
    #[test]
    fn zeros_are_zero() {
        for reference in [0.0, 0.3, -7.0] {
            assert_eq!((Sketch::about(reference).quantile(0.5), Sketch::about(reference).max()), (None, None));
            for others in [[1e-9, 2.0], [-3.0, 1.0], [-2.0, -1e-300], [5e-324, 1e-310]] {
                let mut sketch = Sketch::about(reference);
                [0.0, -0.0, 0.0, f64::NAN, 0.0, 0.0, others[0], others[1]].iter().for_each(|value| sketch.add(*value));
                assert_eq!(sketch.quantile(0.5), Some(0.0), "{reference} {others:?}");
            }
        }
    }

    /// Law: whole numbers below 2048 are exact; bounds of larger ones are whole and enclose them.
    #[test]
    fn whole_numbers_stay_whole() {
        let values: Vec<f64> = (0..1000).map(|k| f64::from(k * 7)).collect();
        let ranks = sketch(&values).ranks().of_whole_numbers();
        for (rank, exact) in (1..).zip(&values) {
            let [low, high] = ranks.bounds(rank).unwrap();
            assert!(low <= *exact && *exact <= high && low.fract() == 0.0 && high.fract() == 0.0, "{rank}");
            assert!(*exact >= 2048.0 || low == high, "{rank}: {low} {high}");
        }
        // 99.9 intervals of 7, to the rounding of the interpolation
        assert!((ranks.quantile(0.1).unwrap() - 699.3).abs() <= 699.3 * f64::EPSILON);
    }
}
