//! [`expected`]: how many samples of a distribution are expected in the bars of a histogram.

use crate::sampling::distribution::{Distribution, Quantile};

/// Halvings of (0, 1) in which a probability is found: beyond the resolution of a picture.
const HALVINGS: u32 = 40;

/// How many of `count` values are expected between neighbouring edges.
pub fn expected(distribution: &Distribution, edges: &[f64], count: usize) -> Vec<f64> {
    let below: Vec<f64> = edges.iter().map(|edge| probability(distribution, *edge)).collect();
    below.windows(2).map(|pair| count as f64 * (pair[1] - pair[0])).collect()
}

/// The probability of smaller values, by bisection of the quantile function.
fn probability(distribution: &Distribution, value: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if distribution.quantile(middle) < value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::distribution::normal::NormalQuantile;
    use crate::sampling::distribution::uniform::UniformQuantile;

    /// Known: 68.27% of normal numbers are within one standard deviation; none of uniform ones is outside of their range.
    #[test]
    fn known_shares() {
        let normal = Distribution::Normal(NormalQuantile { mean: 5.0, std: 2.0 });
        let found = expected(&normal, &[3.0, 5.0, 7.0], 1000);
        // the resolution of the bisection is 1e-12
        assert!(found.iter().all(|count| (count - 341.344_746).abs() < 1e-6), "{found:?}");
        let uniform = Distribution::Uniform(UniformQuantile { min: 0.0, max: 1.0 });
        let found = expected(&uniform, &[-1.0, 0.0, 0.5, 1.0], 8);
        let known = [0.0, 4.0, 4.0];
        assert!(found.iter().zip(known).all(|(found, known)| (found - known).abs() < 1e-9), "{found:?}");
    }
}
