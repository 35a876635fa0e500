//! Histogram of deviations from a nominal value.
//!
//! Buckets are those of [`super::sketch`] with [`MANTISSA_BITS`] bits of the mantissa, coded in 16 bits, so that
//! hundreds of millions can be counted. Magnitudes below 2^-512 (7e-155) count as zero, those from 2^512 (1.3e154) on
//! in the last bucket.

use super::ranks::Ranks;

/// Leading mantissa bits of a bucket.
pub const MANTISSA_BITS: u32 = 5;

/// Largest relative error of the middle of a bucket: half its width.
pub const RELATIVE_ERROR: f64 = 1.0 / 64.0;

/// A bucket: twice the index of its magnitude, from 1, plus one for negative deviations.
pub type Code = u16;

/// The bucket of zero.
pub const ZERO: Code = 0;

/// The code of NaN, which is in no bucket.
pub const NOT_A_NUMBER: Code = 1;

/// Bits of the upper half of a number below its bucket.
const SHIFT: u32 = 20 - MANTISSA_BITS;

/// Leading bits of the smallest nonzero magnitude, 2^-512.
const LOWEST: i32 = (1023 - 512) << MANTISSA_BITS;

const LAST: i32 = Code::MAX as i32 / 2;

/// The bucket of a deviation; branch-free, so that loops vectorise.
#[inline(always)]
pub fn code(deviation: f64) -> Code {
    let upper = (deviation.to_bits() >> 32) as u32;
    let leading = ((upper & 0x7fff_ffff) >> SHIFT).cast_signed();
    let magnitude = (leading - (LOWEST - 1)).clamp(0, LAST);
    let sign = (upper >> 31) & u32::from(magnitude != 0);
    let code = (magnitude as u32) << 1 | sign;
    (if deviation.is_nan() { u32::from(NOT_A_NUMBER) } else { code }) as Code
}

/// Ends of a bucket, ascending; all its deviations lie between them.
pub fn ends(code: Code) -> [f64; 2] {
    let magnitude = i32::from(code >> 1);
    let end = |leading: i32| f64::from_bits((leading as u64) << (32 + SHIFT));
    let leading = magnitude + (LOWEST - 1);
    if magnitude == 0 {
        return [-end(LOWEST), end(LOWEST)];
    }
    let [near, far] = [end(leading), if magnitude == LAST { f64::INFINITY } else { end(leading + 1) }];
    if is_negative(code) { [-far, -near] } else { [near, far] }
}

fn is_negative(code: Code) -> bool {
    code & 1 == 1
}

/// Order statistics of counted deviations; `buckets` have ascending codes.
pub fn ranks(buckets: &[(Code, u64)]) -> Ranks {
    let negative = buckets.iter().rev().filter(|(code, _)| is_negative(*code));
    let ascending = negative.chain(buckets.iter().filter(|(code, _)| !is_negative(*code)));
    // the last bucket is cut at the largest number, so that it has a middle
    Ranks::of(ascending.map(|(code, count)| (ends(*code).map(|end| end.clamp(f64::MIN, f64::MAX)), *count)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn middle(code: Code) -> f64 {
        ranks(&[(code, 1)]).quantile(0.5).expect("a value")
    }

    /// Law: the middle of a bucket has the sign and, within the stated error, the value of its deviations, from 2^-512
    /// to 2^511.
    #[test]
    fn a_bucket_is_as_narrow_as_stated() {
        let mut widest = 0.0f64;
        for octave in -512..511 {
            for step in 0..257 {
                let value = libm::exp2(f64::from(octave)) * (1.0 + f64::from(step) / 257.0);
                for value in [value, -value] {
                    let found = middle(code(value));
                    widest = widest.max((found - value).abs() / value.abs());
                    assert!((found - value).abs() <= RELATIVE_ERROR * value.abs(), "{value}: {found}");
                    let [low, high] = ends(code(value));
                    assert!(low <= value && value <= high, "{value}: {low} {high}");
                }
            }
        }
        // counter-test: the bound is tight
        assert!(widest > 0.99 * RELATIVE_ERROR, "{widest}");
    }

    #[test]
    fn what_is_beyond_the_buckets() {
        for tiny in [0.0, -0.0, 7e-155, -7e-155, f64::from_bits(1)] {
            assert_eq!((code(tiny), middle(code(tiny))), (ZERO, 0.0), "{tiny}");
            assert!(ends(ZERO)[0] <= tiny && tiny <= ends(ZERO)[1], "{tiny}");
        }
        assert_eq!([code(f64::NAN), code(-f64::NAN)], [NOT_A_NUMBER; 2]);
        assert_eq!([code(1.35e154), code(f64::INFINITY)], [Code::MAX - 1; 2]);
        assert_eq!((ends(Code::MAX - 1)[1], ends(Code::MAX)[0]), (f64::INFINITY, f64::NEG_INFINITY));
        assert_eq!([code(-1.35e154), code(f64::NEG_INFINITY)], [Code::MAX; 2]);
        assert!(ranks(&[]).neighbours(0.5).is_none() && middle(Code::MAX).is_finite());
    }
}
