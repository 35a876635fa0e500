//! Distribution-free rank tests of the influence of an input on an observable.
//!
//! - H. B. Mann & D. R. Whitney, *Ann. Math. Stat.* 18 (1947) 50: an event and a value.
//! - W. H. Kruskal & W. A. Wallis, *J. Am. Stat. Assoc.* 47 (1952) 583: groups.
//! - C. Spearman, *Am. J. Psychol.* 15 (1904) 72: monotonic dependence of two columns.
//!
//! All are two-sided and for independent rows, with the limiting distributions and the variance of the actual ranks.
//! Few events err less often than stated; fewer than four show nothing at 1e-3.

use super::correlation::{mid_ranks, pearson};
use crate::math::incomplete_gamma::incomplete_gamma;

/// Association of an event and a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RankShift {
    /// Probability that a run with the event has the larger value; ties count half.
    pub chance: f64,
    /// Probability of a chance at least as far from one half if the event is independent of the column.
    pub p_value: f64,
}

/// Two-sided tail of a normal variable.
pub(super) fn two_sided(z: f64) -> f64 {
    libm::erfc(z.abs() * core::f64::consts::FRAC_1_SQRT_2)
}

/// Mean of `ranks`, sum of squared deviations.
fn moments(ranks: &[f64]) -> [f64; 2] {
    let mean = ranks.iter().sum::<f64>() / ranks.len() as f64;
    [mean, ranks.iter().map(|rank| (rank - mean) * (rank - mean)).sum()]
}

/// Mann and Whitney's test for the [`mid_ranks`] of a column and an event in the `marked` rows; `None` if all or none
/// are marked, or the column does not vary.
pub fn mann_whitney(ranks: &[f64], marked: &[bool]) -> Option<RankShift> {
    let (n, m) = (ranks.len() as f64, marked.iter().filter(|is_marked| **is_marked).count() as f64);
    let [mean, squares] = moments(ranks);
    if m == 0.0 || m == n || squares == 0.0 {
        return None;
    }
    let sum: f64 = ranks.iter().zip(marked).filter(|(_, is_marked)| **is_marked).map(|(rank, _)| rank).sum();
    // of m ranks without replacement
    let variance = squares / n * m * (n - m) / (n - 1.0);
    Some(RankShift {
        chance: (sum - 0.5 * m * (m - 1.0)) / (m * (n - m)),
        p_value: two_sided((sum - m * mean) / libm::sqrt(variance)),
    })
}

/// P-value of Kruskal and Wallis' test for the [`mid_ranks`] of the observable and the `group` of each row, from 0 to
/// `groups` - 1, none empty. `None` for fewer than two groups, or equal ranks.
pub fn kruskal_wallis(ranks: &[f64], group: &[usize], groups: usize) -> Option<f64> {
    let [mean, squares] = moments(ranks);
    if groups < 2 || squares == 0.0 {
        return None;
    }
    let mut sums = vec![[0.0; 2]; groups];
    for (rank, group) in ranks.iter().zip(group) {
        sums[*group][0] += rank - mean;
        sums[*group][1] += 1.0;
    }
    let between: f64 = sums.iter().map(|[sum, count]| sum * sum / count).sum();
    let h = (ranks.len() - 1) as f64 * between / squares;
    Some(incomplete_gamma(0.5 * (groups - 1) as f64, 0.5 * h).upper)
}

/// Spearman's coefficient of columns with these [`mid_ranks`], and its two-sided p-value under independence.
pub fn spearman_test(x_ranks: &[f64], y_ranks: &[f64]) -> [f64; 2] {
    let r = pearson(x_ranks, y_ranks);
    [r, two_sided(r * libm::sqrt(x_ranks.len() as f64 - 1.0))]
}

/// True if `y` both rises and falls with `x`, by rank correlations within the halves and quarters of the rows, in
/// ascending `order` of `x`; false results have at most the probability `alpha` for a monotonic influence.
pub fn turns(order: &[usize], x: &[f64], y: &[f64], alpha: f64) -> bool {
    const PARTS: [usize; 2] = [2, 4];
    let level = alpha / PARTS.iter().sum::<usize>() as f64;
    let (mut rises, mut falls) = (false, false);
    for parts in PARTS {
        for part in 0..parts {
            let rows = &order[part * order.len() / parts..(part + 1) * order.len() / parts];
            if rows.len() < 4 {
                continue;
            }
            let of = |column: &[f64]| mid_ranks(&rows.iter().map(|row| column[*row]).collect::<Vec<f64>>());
            let [r, p_value] = spearman_test(&of(x), &of(y));
            if p_value <= level {
                rises |= r > 0.0;
                falls |= r < 0.0;
            }
        }
    }
    rises && falls
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::statistics::correlation::ascending_order;
    use crate::testing::{close, near};

    /// Uniform numbers in [0, 1) by SplitMix64.
    pub(in crate::statistics) struct Uniform(pub u64);

    impl Uniform {
        pub(in crate::statistics) fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    /// Law: for two groups Kruskal and Wallis' test is Mann and Whitney's. Published: weights of bottles from three
    /// machines (Kruskal & Wallis 1952, section 1.3), H = 5.656, with the tail exp(-H/2) = 0.0591 of chi-square.
    #[test]
    fn kruskal_wallis_is_known() {
        let bottles = [340.0, 345.0, 330.0, 342.0, 338.0, 339.0, 333.0, 344.0, 347.0, 343.0, 349.0, 355.0];
        let machine = [0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2];
        let ranks = mid_ranks(&bottles);
        let found = kruskal_wallis(&ranks, &machine, 3).expect("a test");
        close(found, libm::exp(-0.5 * 5.656), 1e-4);
        let marked: Vec<bool> = machine.iter().map(|group| *group == 2).collect();
        let two: Vec<usize> = marked.iter().map(|is_marked| usize::from(*is_marked)).collect();
        let [one, other] =
            [kruskal_wallis(&ranks, &two, 2).expect("a test"), mann_whitney(&ranks, &marked).expect("a test").p_value];
        near(one, other, 1e-12);
        assert_eq!(kruskal_wallis(&[2.0; 12], &two, 2), None);
        assert_eq!(kruskal_wallis(&ranks, &[0; 12], 1), None);
    }

    /// Law: a V turns if its tip is within the middle three quarters of the range; a line, a step and noise do not.
    #[test]
    fn a_v_turns() {
        let mut random = Uniform(5);
        let x: Vec<f64> = (0..1000).map(|_| random.next()).collect();
        let order = ascending_order(&x);
        let turns_of = |of: &dyn Fn(f64) -> f64, random: &mut Uniform| {
            let y: Vec<f64> = x.iter().map(|x| of(*x) + 0.05 * random.next()).collect();
            turns(&order, &x, &y, 0.05)
        };
        for point in [0.15, 0.3, 0.5, 0.7, 0.85] {
            assert!(turns_of(&|x| (x - point).abs(), &mut random), "{point}");
            assert!(turns_of(&|x| -(x - point).abs(), &mut random), "{point}, upside down");
        }
        for of in [&(|x| x) as &dyn Fn(f64) -> f64, &|x| -x, &|x| f64::from(x > 0.5), &|_| 0.0, &|x| x * x * x] {
            assert!(!turns_of(of, &mut random));
        }
    }
}
