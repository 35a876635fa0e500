//! The share of a variance that repetition alone makes, of values that were had twice under the same conditions.
//!
//! One-way random effects with pairs as groups (R. A. Fisher, *Statistical Methods for Research Workers*, 1925, on the intraclass correlation): the
//! variance within pairs is the mean of (a - b)^2/2, the whole is that about the mean of all; the interval is that of [`super::jackknife`].

use super::jackknife::{Estimate, explained_share};

/// The share of the variance within `pairs`, with its interval; `None` for fewer than two pairs, or where all values are one.
pub fn share_within(pairs: &[[f64; 2]], confidence: f64) -> Option<Estimate> {
    let count = pairs.len();
    if count < 2 {
        return None;
    }
    let mean = pairs.iter().flatten().sum::<f64>() / (2 * count) as f64;
    let parts =
        |[a, b]: &[f64; 2]| [0.5 * (a - b) * (a - b), 0.5 * ((a - mean) * (a - mean) + (b - mean) * (b - mean))];
    let [within, whole] = pairs.iter().map(parts).fold([0.0; 2], |[w, all], [x, y]| [w + x, all + y]);
    if whole.is_nan() || whole <= 0.0 {
        return None;
    }
    let shares = pairs.iter().map(parts).map(|[x, y]| [x / within, y / whole]);
    let between = explained_share(within / whole, count, shares, confidence);
    Some(Estimate { value: 1.0 - between.value, lower: 1.0 - between.upper, upper: 1.0 - between.lower })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal;

    /// Numbers 0 < u < 1 that repeat no pattern.
    fn uniforms(seed: u64) -> impl Iterator<Item = f64> {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1;
        std::iter::from_fn(move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            Some(((state >> 12) as f64 + 0.5) / (1u64 << 52) as f64)
        })
    }

    /// Law: of normal and of skewed values with a known share the estimate is right on average, to 6% of itself (measured: 5.4%, of skewed values), and 95% intervals cover it in at least 92% (measured: 93.8%) of 1,000
    /// repetitions with 200 pairs.
    #[test]
    fn known_shares_are_covered() {
        let normal_value = |u: f64| normal::quantile(u);
        let skewed = |u: f64| -1.0 - libm::log(u);
        for share in [0.05, 0.5, 0.95] {
            for draw in [&normal_value as &dyn Fn(f64) -> f64, &skewed] {
                let (mut covered, mut total) = (0, 0.0);
                for seed in 1..=1_000 {
                    let mut u = uniforms(seed);
                    let mut next = || draw(u.next().expect("endless"));
                    let (noise, scene) = (libm::sqrt(share), libm::sqrt(1.0 - share));
                    let pairs: Vec<[f64; 2]> = (0..200)
                        .map(|_| {
                            let of_scene = scene * next();
                            [0; 2].map(|_| of_scene + noise * next())
                        })
                        .collect();
                    let found = share_within(&pairs, 0.95).expect("values differ");
                    assert!(found.lower <= found.value && found.value <= found.upper, "{found:?}");
                    covered += u32::from(found.lower <= share && share <= found.upper);
                    total += found.value;
                }
                assert!(covered >= 920, "{share}: {covered}");
                assert!((total / 1_000.0 / share - 1.0).abs() < 0.06, "{share}: {total}");
            }
        }
    }

    /// Law: where repetition changes nothing the share is zero; without two pairs or any difference there is none.
    #[test]
    fn no_noise_is_no_share() {
        let found = share_within(&[[1.0, 1.0], [2.0, 2.0], [4.0, 4.0]], 0.95).expect("values differ");
        assert_eq!((found.value, found.lower, found.upper), (0.0, 0.0, 0.0));
        assert_eq!(share_within(&[[1.0, 2.0]], 0.95), None);
        assert_eq!(share_within(&[[3.0, 3.0], [3.0, 3.0]], 0.95), None);
    }
}
