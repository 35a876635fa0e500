//! [`DrawnScenes`]: the samples of a campaign as they are drawn, without running them.

use crate::campaign::{Plan, SceneDraws};
use crate::sampling::SampleId;
use crate::scene::Scene;
use crate::statistics::correlation::{matrix, mid_ranks, standardised};
use crate::statistics::quantile::quantile;

/// Samples as drawn: what was applied, and whether the scene is physical.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnScenes {
    /// The first sample.
    pub first: SampleId,
    /// Whether each sample's scene is physical; one that is not would be a row with status `invalid_sample`.
    pub physical: Vec<bool>,
    /// The applied values, column by column as [`crate::sampling::Dispersions::columns`] has them.
    pub columns: Vec<Vec<f64>>,
}

impl DrawnScenes {
    /// Draws `count` samples of `plan` from `first` on, as far as it has them.
    pub fn new(plan: &Plan, first: SampleId, count: u64) -> Self {
        let end = first.0.saturating_add(count).min(plan.samples);
        let mut draws = SceneDraws::new(plan);
        let mut scenes: Vec<Scene> = Vec::with_capacity(1);
        let columns = plan.dispersions.columns().len();
        let mut drawn = DrawnScenes { first, physical: Vec::new(), columns: vec![Vec::new(); columns] };
        for sample in first.0..end {
            drawn.physical.push(draws.scene_at(SampleId(sample), &mut scenes, 0));
            drawn.columns.iter_mut().zip(draws.applied()).for_each(|(column, value)| column.push(*value));
        }
        drawn
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.physical.len()
    }

    /// Quantiles of each column at the fractions `p`, of type 7 of R. J. Hyndman & Y. Fan (*Am. Stat.* 50 (1996) 361): linear
    /// between neighbours; none where there are no samples.
    pub fn percentiles<const N: usize>(&self, p: [f64; N]) -> Vec<Option<[f64; N]>> {
        let of = |column: &Vec<f64>| {
            let mut values = column.clone();
            values.sort_by(f64::total_cmp);
            let mut found = [f64::NAN; N];
            for (found, p) in found.iter_mut().zip(p) {
                *found = quantile(&values, p)?;
            }
            Some(found)
        };
        self.columns.iter().map(of).collect()
    }

    /// Spearman's rank correlation of each pair of columns; 0 for a column that does not vary. Equal values share their mean rank.
    pub fn rank_correlations(&self) -> Vec<Vec<f64>> {
        let scores: Vec<Vec<f64>> = self.columns.iter().map(|column| standardised(&mid_ranks(column))).collect();
        matrix(&scores)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rank_correlations_of_known_columns() {
        let columns =
            vec![vec![1.0, 2.0, 3.0, 4.0], vec![1.0, 8.0, 27.0, 64.0], vec![4.0, 3.0, 2.0, 1.0], vec![5.0; 4]];
        let drawn = DrawnScenes { first: SampleId(0), physical: vec![true; 4], columns };
        let r = drawn.rank_correlations();
        assert!((r[0][1] - 1.0).abs() < 1e-15 && (r[0][2] + 1.0).abs() < 1e-15 && r[0][3] == 0.0);
        let [low, middle, high] = drawn.percentiles([0.0, 0.5, 0.99])[1].expect("four samples");
        assert_eq!((low, middle), (1.0, 17.5));
        assert!((high - (64.0 - 0.03 * 37.0)).abs() < 5e-14, "99% of four draws is not their maximum: {high}");
    }
}
