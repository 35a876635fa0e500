//! Two-sided tests of differences between two campaigns, for independent runs or pairs.
//!
//! - Means: B. L. Welch, *Biometrika* 34 (1947) 28; Student's t of paired differences.
//! - Distributions: Kolmogorov and Smirnov's largest difference of the empirical distribution functions, with the
//!   limiting tail corrected by M. A. Stephens, *J. Roy. Stat. Soc. B* 32 (1970) 115.
//! - Pairs: Q. McNemar's exact test (*Psychometrika* 12 (1947) 153) at several limits; F. Wilcoxon's signed ranks
//!   (*Biometrics* 1 (1945) 80), normal approximation, corrected for ties, without zeros; for their spread, ranks
//!   signed by the sums of the pairs, as in E. J. G. Pitman, *Biometrika* 31 (1939) 9.
//! - Several tests: S. Holm, *Scand. J. Stat.* 6 (1979) 65, for any dependence.

use super::binomial::at_most;
use super::correlation::{Estimate, mid_ranks};
use super::moments::Moments;
use super::student::{two_sided_quantile, two_sided_tail};

/// Result of a test of two means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Second mean minus first, with its interval.
    pub shift: Estimate,
    /// Probability of a difference at least as large for equal means.
    pub p_value: f64,
}

/// Welch's test of two means; `None` for fewer than two runs. The difference is certain if neither varies.
pub fn welch(first: &Moments, second: &Moments, confidence: f64) -> Option<Difference> {
    let shift = second.mean()? - first.mean()?;
    let (a, b) = (first.mean_error()?, second.mean_error()?);
    let (a, b) = (a * a, b * b);
    let error = libm::sqrt(a + b);
    let degrees = (a + b) * (a + b) / (a * a / (first.count() - 1) as f64 + b * b / (second.count() - 1) as f64);
    Some(difference(shift, error, degrees, confidence))
}

/// Student's test of the mean of paired differences, second minus first; `None` for fewer than two.
pub fn paired(differences: &Moments, confidence: f64) -> Option<Difference> {
    let (shift, error) = (differences.mean()?, differences.mean_error()?);
    Some(difference(shift, error, (differences.count() - 1) as f64, confidence))
}

/// Student's test of `shift` by its standard error; certain without error.
fn difference(shift: f64, error: f64, degrees: f64, confidence: f64) -> Difference {
    if error == 0.0 {
        let p_value = if shift == 0.0 { 1.0 } else { 0.0 };
        return Difference { shift: Estimate { value: shift, lower: shift, upper: shift }, p_value };
    }
    let half = two_sided_quantile(confidence, degrees) * error;
    let shift = Estimate { value: shift, lower: shift - half, upper: shift + half };
    Difference { shift, p_value: two_sided_tail(shift.value.abs() / error, degrees) }
}

/// Kolmogorov and Smirnov's statistic of two ascending samples, and its p-value.
pub fn kolmogorov_smirnov(first: &[f64], second: &[f64]) -> Option<(f64, f64)> {
    if first.is_empty() || second.is_empty() {
        return None;
    }
    let (n, m) = (first.len() as f64, second.len() as f64);
    let (mut i, mut j, mut largest) = (0, 0, 0.0_f64);
    while i < first.len() && j < second.len() {
        // skip all numbers equal to the smaller of the next two, in both samples
        let next = if first[i] <= second[j] { first[i] } else { second[j] };
        while i < first.len() && first[i] <= next {
            i += 1;
        }
        while j < second.len() && second[j] <= next {
            j += 1;
        }
        largest = largest.max((i as f64 / n - j as f64 / m).abs());
    }
    let root = libm::sqrt(n * m / (n + m));
    Some((largest, kolmogorov_tail((root + 0.12 + 0.11 / root) * largest)))
}

/// P(K > x) = 2 sum (-1)^(k-1) exp(-2 k^2 x^2) (A. N. Kolmogorov 1933).
fn kolmogorov_tail(x: f64) -> f64 {
    // below this the tail is 1 to the last two digits, and the series converges slowly
    if x < 0.2 {
        return 1.0;
    }
    let term = |k: i32| {
        let k = f64::from(k);
        libm::exp(-2.0 * k * k * x * x)
    };
    let sum: f64 = (1..=40).map(|k| if k % 2 == 1 { term(k) } else { -term(k) }).sum();
    (2.0 * sum).clamp(0.0, 1.0)
}

/// P-value of Wilcoxon's signed-rank test of paired differences; `None` if all are zero.
pub fn signed_ranks(differences: &[f64]) -> Option<f64> {
    let differences: Vec<f64> = differences.iter().copied().filter(|d| *d != 0.0 && !d.is_nan()).collect();
    if differences.is_empty() {
        return None;
    }
    let ranks = mid_ranks(&differences.iter().map(|difference| difference.abs()).collect::<Vec<f64>>());
    Some(signed_sum(differences.iter().zip(&ranks).map(|(difference, rank)| difference.signum() * (rank + 1.0))))
}

/// P-value of the test of equal spread in both places of `pairs`, without NaN; `None` if no pair differs.
///
/// If the numbers of a pair are exchangeable, the sign of their difference is a fair coin, given its magnitude and
/// their sum. Each sign is weighted by the rank of the magnitude times the centred rank of the sum, since differences
/// are positive for large sums if the second numbers spread more.
pub fn spread_of_pairs(pairs: &[[f64; 2]]) -> Option<f64> {
    let differing: Vec<[f64; 2]> = pairs.iter().copied().filter(|[first, second]| first != second).collect();
    if differing.is_empty() {
        return None;
    }
    let ranks = |of: &dyn Fn(&[f64; 2]) -> f64| mid_ranks(&differing.iter().map(of).collect::<Vec<f64>>());
    let sizes = ranks(&|[first, second]| (second - first).abs());
    // infinities of opposite signs have a sum in the middle
    let sums = ranks(&|[first, second]| if (first + second).is_nan() { 0.0 } else { first + second });
    let middle = 0.5 * (differing.len() - 1) as f64;
    let terms = differing.iter().zip(sizes.iter().zip(&sums));
    Some(signed_sum(terms.map(|([first, second], (size, sum))| {
        let weight = (size + 1.0) * (sum - middle);
        if second > first { weight } else { -weight }
    })))
}

/// Two-sided p-value, in the normal approximation, of a sum of `terms` with fair random signs.
fn signed_sum(terms: impl Iterator<Item = f64>) -> f64 {
    let [sum, squares] = terms.fold([0.0; 2], |[sum, squares], term| [sum + term, squares + term * term]);
    if squares == 0.0 { 1.0 } else { libm::erfc(sum.abs() / libm::sqrt(2.0 * squares)) }
}

/// Number of limits of [`marginals`]: the sixteenths of all values.
const LIMITS: usize = 15;

/// P-value of the test of equal distributions in both places of `pairs`, without NaN; `None` without pairs.
///
/// If both distributions are equal, a pair that crosses a limit goes up or down with probability one half, for any
/// dependence within pairs, symmetric or not (a phase that advances a little and is wrapped to one period). The result
/// is the smallest p-value over the limits times their number (Bonferroni).
pub fn marginals(pairs: &[[f64; 2]]) -> Option<f64> {
    let mut all: Vec<f64> = pairs.iter().flatten().copied().collect();
    all.sort_unstable_by(f64::total_cmp);
    let mut limits: Vec<f64> = (1..=LIMITS).filter_map(|k| all.get(all.len() * k / (LIMITS + 1)).copied()).collect();
    limits.dedup();
    let through = |limit: f64| {
        let mut counts = [0_u64; 2];
        for [first, second] in pairs {
            counts[0] += u64::from(*first < limit && limit <= *second);
            counts[1] += u64::from(*second < limit && limit <= *first);
        }
        mcnemar(counts)
    };
    let smallest = limits.iter().map(|limit| through(*limit)).reduce(f64::min)?;
    Some((limits.len() as f64 * smallest).min(1.0))
}

/// McNemar's exact test: p-value of the numbers of pairs with a property of the first alone, and of the second alone.
pub fn mcnemar(alone: [u64; 2]) -> f64 {
    (2.0 * at_most(alone[0].min(alone[1]), alone[0] + alone[1], 0.5)).min(1.0)
}

/// P-values adjusted for their number (Holm 1979): of true hypotheses, any is at most alpha with at most the
/// probability alpha.
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p_values.len()).collect();
    order.sort_by(|a, b| p_values[*a].total_cmp(&p_values[*b]));
    let (mut adjusted, mut largest) = (vec![1.0; p_values.len()], 0.0_f64);
    for (left, index) in (1..=p_values.len()).rev().zip(order) {
        largest = largest.max((left as f64 * p_values[index]).min(1.0));
        adjusted[index] = largest;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{close, near};

    /// Published: R's `p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm")`, 0.03 0.06 0.06 0.02; values are at most 1.
    #[test]
    fn adjusted_values_are_those_of_holm() {
        let found = holm(&[0.01, 0.04, 0.03, 0.005]);
        let known = [0.03, 0.06, 0.06, 0.02];
        assert!(found.iter().zip(known).all(|(found, known)| (found - known).abs() < 1e-15), "{found:?}");
        assert_eq!((holm(&[0.9, 0.6, 0.0]), holm(&[])), (vec![1.0, 1.0, 0.0], vec![]));
    }

    /// Twenty and thirty irregular numbers.
    fn samples() -> [Vec<f64>; 2] {
        let irregular = |k: i32, root: f64| libm::fmod(f64::from(k) * root, 1.0);
        [
            (1..=20).map(|k| irregular(k, core::f64::consts::SQRT_2)).collect(),
            (1..=30).map(|k| 0.2 + 1.3 * irregular(k, 1.732_050_807_568_877_2)).collect(),
        ]
    }

    fn ascending(values: &[f64]) -> Vec<f64> {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        values
    }

    /// Expected values: scipy.stats 1.x, `x = [k sqrt(2) % 1 for k in 1..20]`, `y = [0.2 + 1.3 (k sqrt(3) % 1) for k in
    /// 1..30]`: `ttest_ind(y, x, equal_var=False)`, `ttest_rel(y[:20], x)`, `wilcoxon(y[:20] - x, mode="approx")`,
    /// `ks_2samp(x, y)`.
    #[test]
    fn tests_are_those_of_scipy() {
        let [x, y] = samples();
        let (of_x, of_y) = (Moments::of_block(&x), Moments::of_block(&y));
        let found = welch(&of_x, &of_y, 0.95).expect("enough");
        // measured, relative: p-values 1.7e-15 at most, ends of the interval 1.1e-16
        let near = |found: f64, known: f64| (found / known - 1.0).abs() < 1e-14;
        assert!(near(found.p_value, WELCH[0]), "{found:?}");
        assert!(near(found.shift.lower, WELCH[1]) && near(found.shift.upper, WELCH[2]), "{found:?}");
        let differences: Vec<f64> = x.iter().zip(&y).map(|(x, y)| y - x).collect();
        let found = paired(&Moments::of_block(&differences), 0.95).expect("enough");
        assert!(near(found.p_value, PAIRED), "{found:?}");
        assert!(near(signed_ranks(&differences).expect("differences"), WILCOXON));
        let (statistic, p) = kolmogorov_smirnov(&ascending(&x), &ascending(&y)).expect("both");
        // scipy's p-value is exact; Stephens gives an error of some percent for such small samples
        assert!((statistic - KOLMOGOROV[0]).abs() < 1e-15 && (p / KOLMOGOROV[1] - 1.0).abs() < 0.15, "{statistic} {p}");
    }

    const WELCH: [f64; 3] = [0.0003244771923555467, 0.17728290091345167, 0.5592131676106349];
    const PAIRED: f64 = 0.0012955505685977547;
    const WILCOXON: f64 = 0.0057339909503071225;
    const KOLMOGOROV: [f64; 2] = [5.0 / 12.0, 0.024351206903677477];

    /// Known: P(K > 1.3581) = 0.05 and P(K > 1.6276) = 0.01 (N. Smirnov, Ann. Math. Statist. 19 (1948) 279).
    #[test]
    fn kolmogorov_distribution() {
        for (x, tail) in [(1.3581, 0.05), (1.6276, 0.01), (0.8276, 0.5)] {
            // four digits of x, and a density of at most 1.7; measured 4.2e-5
            close(kolmogorov_tail(x), tail, 1e-4);
        }
        assert_eq!((kolmogorov_tail(0.0), kolmogorov_tail(9.0)), (1.0, 2.0 * libm::exp(-162.0)));
    }

    /// Known: of a hundred pairs (k, k + 10) ten cross each limit upward and none downward: p is 15 times 2/2^10 =
    /// 15/512; pairs (k, k + 10 modulo 100) cross both ways equally, although nine in ten differences are positive.
    #[test]
    fn pairs_go_through_limits_up_and_down() {
        let pairs = |wrap: f64| -> Vec<[f64; 2]> {
            (0..100).map(|k| [f64::from(k), libm::fmod(f64::from(k) + 10.0, wrap)]).collect()
        };
        let (shifted, wrapped) = (marginals(&pairs(1e9)), marginals(&pairs(100.0)));
        close(shifted.expect("pairs"), 15.0 / 512.0, 1e-15);
        assert_eq!(wrapped, Some(1.0));
        let differences: Vec<f64> = pairs(100.0).iter().map(|[a, b]| b - a).collect();
        assert!(signed_ranks(&differences).is_some_and(|p| p < 1e-6), "the counter-test");
        assert_eq!((marginals(&[[3.0, 3.0]; 9]), marginals(&[])), (Some(1.0), None));
        let jumps: Vec<[f64; 2]> = (0..40).map(|k| [0.0, f64::from(u8::from(k < 10))]).collect();
        assert!(marginals(&jumps).is_some_and(|p| (0.001..0.02).contains(&p)), "{:?}", marginals(&jumps));
    }

    /// Known: for untied pairs (x, 2 x) all terms are positive: z is their sum over the root of the sum of squares.
    /// Law: places may be exchanged, a common step is no spread, equal pairs have no test.
    #[test]
    fn spreads_of_pairs_are_seen() {
        let pairs: Vec<[f64; 2]> = (-20..=20).map(|k| f64::from(k) + 0.1).map(|x| [x, 2.0 * x]).collect();
        let turned: Vec<[f64; 2]> = pairs.iter().map(|[a, b]| [*b, *a]).collect();
        let sizes = mid_ranks(&pairs.iter().map(|[a, _]| a.abs()).collect::<Vec<f64>>());
        // the pair next to zero is in the middle
        let terms: Vec<f64> =
            sizes.iter().zip(-20..=20).map(|(size, k)| (size + 1.0) * f64::from(i32::abs(k))).collect();
        let z = terms.iter().sum::<f64>() / libm::sqrt(terms.iter().map(|term| term * term).sum());
        let found = spread_of_pairs(&pairs).expect("differences");
        assert!((found / libm::erfc(z / core::f64::consts::SQRT_2) - 1.0).abs() < 1e-12 && found < 1e-5, "{found} {z}");
        assert_eq!(spread_of_pairs(&turned), Some(found));
        // whole numbers, so that rounding does not order the differences
        let step: Vec<[f64; 2]> = (-20..=20).map(f64::from).map(|x| [x, x + 1024.0]).collect();
        assert!(spread_of_pairs(&step).is_some_and(|p| p > 0.5), "{:?}", spread_of_pairs(&step));
        assert_eq!((spread_of_pairs(&[[1.0, 1.0]; 9]), mcnemar([0, 0])), (None, 1.0));
        near(mcnemar([0, 5]), 0.0625, 1e-14);
    }
}
