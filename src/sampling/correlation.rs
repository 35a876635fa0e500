//! [`Correlation`]: a `[[correlate]]` table as written, and its way to a [`Copula`].

use super::copula::{Copula, Matrix, nearest_correlation, score_correlation, smallest_negative_eigenvalue};
use super::distribution::{Distribution, Quantile};
use super::error::{DispersionError, Table, error_of};
use crate::scene::Parameter;

/// How a dependence is written.
#[derive(Clone, Debug, PartialEq)]
pub enum Dependence {
    /// Correlations of the normal scores: of the values where these are normal (`correlation`).
    Scores(Matrix),
    /// Spearman's rank correlations (`rank_correlation`).
    Ranks(Matrix),
    /// Covariances of normal values, whose variances must be those of their distributions (`covariance`).
    Covariance(Matrix),
}

/// A `[[correlate]]` table as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlation {
    /// The parameters, whole or by component.
    pub parameters: Vec<(Parameter, Option<usize>)>,
    /// Their dependence, in the order of the parameters and their components.
    pub dependence: Dependence,
    /// Whether a matrix that is not positive semidefinite is replaced by the nearest that is.
    pub nearest_psd: bool,
}

/// A diagonal or a pair of mirror images that differ by more are two different numbers, not one in two roundings.
const SAME: f64 = 1e-9;
impl Correlation {
    /// The dependence that table `index` asks for. `drawn` gives the dimension and the distribution of a component, if it has one of
    /// one number; `is_correlated` tells whether another table has a dimension.
    ///
    /// # Errors
    /// What is wrong with parameters or matrix.
    #[expect(clippy::needless_range_loop, reason = "entries of a matrix are known by two indices")]
    pub(super) fn copula<'d>(
        &self,
        index: usize,
        drawn: impl Fn((Parameter, usize)) -> Option<(usize, &'d Distribution)>,
        is_correlated: impl Fn(usize) -> bool,
    ) -> Result<Copula, DispersionError> {
        let refused = |key, value: String, allowed: String, remedy: &str| {
            Err(error_of(Table::Correlate(index), key, value, allowed, remedy))
        };
        let components: Vec<(Parameter, usize)> = self
            .parameters
            .iter()
            .flat_map(|(parameter, component)| match component {
                Some(component) => vec![(*parameter, *component)],
                None => (0..parameter.width()).map(|component| (*parameter, component)).collect(),
            })
            .collect();
        let name = |(parameter, component): (Parameter, usize)| format!("{:?}", parameter.component_name(component));
        let mut dimensions: Vec<usize> = Vec::with_capacity(components.len());
        let mut distributions: Vec<&Distribution> = Vec::with_capacity(components.len());
        for component in &components {
            let Some((first, distribution)) = drawn(*component) else {
                let allowed =
                    "made of parameters that a [[disperse]] table gives a distribution of one number each".to_owned();
                return refused("parameters", name(*component), allowed, "disperse it, or take it out of the list");
            };
            if is_correlated(first) || dimensions.contains(&first) {
                let allowed = "correlated in one table".to_owned();
                return refused("parameters", name(*component), allowed, "put all of its correlations into one matrix");
            }
            dimensions.push(first);
            distributions.push(distribution);
        }
        let (key, matrix) = match &self.dependence {
            Dependence::Scores(matrix) => ("correlation", matrix),
            Dependence::Ranks(matrix) => ("rank_correlation", matrix),
            Dependence::Covariance(matrix) => ("covariance", matrix),
        };
        let n = components.len();
        if matrix.len() != n {
            let (value, allowed) = (format!("{0} x {0}", matrix.len()), format!("{n} x {n}, as there are components"));
            return refused(key, value, allowed, "give one row and column for each component, in their order");
        }
        for i in 0..n {
            for j in 0..i {
                let (a, b) = (matrix[i][j], matrix[j][i]);
                if (a - b).abs() > SAME * a.abs().max(b.abs()) {
                    let value = format!("{b:?} and {a:?} in rows {} and {}", j + 1, i + 1);
                    return refused(key, value, "symmetric".to_owned(), "write each pair's number twice");
                }
            }
        }
        let scales = match &self.dependence {
            Dependence::Covariance(matrix) => deviations(&distributions, matrix).map_err(|(place, allowed)| {
                let remedy = "give it a normal distribution of that standard deviation, or use correlation";
                error_of(
                    Table::Correlate(index),
                    key,
                    format!("{:?} of {}", matrix[place][place], name(components[place])),
                    allowed,
                    remedy,
                )
            })?,
            _ => vec![1.0; n],
        };
        let mut scores: Matrix = (0..n)
            .map(|i| (0..n).map(|j| 0.5 * (matrix[i][j] + matrix[j][i]) / (scales[i] * scales[j])).collect())
            .collect();
        for i in 0..n {
            if (scores[i][i] - 1.0).abs() > SAME {
                let (value, allowed) = (format!("{:?}", matrix[i][i]), "1 on the diagonal".to_owned());
                let remedy = "a parameter is correlated with itself by 1; for covariances write the key covariance";
                return refused(key, value, allowed, remedy);
            }
            scores[i][i] = 1.0;
            if let Some(j) = (0..n).find(|j| scores[i][*j].abs() > 1.0 + SAME) {
                let allowed = "made of correlations from -1 to 1".to_owned();
                let (value, remedy) = match &self.dependence {
                    Dependence::Covariance(_) => {
                        let r = scores[i][j];
                        (
                            format!("{:?} (a correlation of {r:?})", matrix[i][j]),
                            "at most the product of the two standard deviations",
                        )
                    }
                    _ => (format!("{:?}", matrix[i][j]), "for covariances write the key covariance"),
                };
                return refused(key, value, allowed, remedy);
            }
        }
        if matches!(self.dependence, Dependence::Ranks(_)) {
            for i in 0..n {
                for j in (0..n).filter(|j| *j != i) {
                    scores[i][j] = score_correlation(scores[i][j]);
                }
            }
        }
        if let Some(smallest) = smallest_negative_eigenvalue(&scores) {
            if !self.nearest_psd {
                let allowed = format!(
                    "positive semidefinite (the smallest eigenvalue of the scores' correlation is {smallest:.6})"
                );
                let remedy = "no numbers have these correlations: change them, or add nearest_psd = true for the nearest that exist";
                return refused(key, format!("{matrix:?}"), allowed, remedy);
            }
            scores = nearest_correlation(&scores);
        }
        Ok(Copula::new(dimensions, &scores))
    }
}

/// The standard deviations of normal distributions whose variances are on the diagonal of `matrix`; the index of one that is not,
/// and what it must be.
fn deviations(distributions: &[&Distribution], matrix: &Matrix) -> Result<Vec<f64>, (usize, String)> {
    distributions
        .iter()
        .enumerate()
        .map(|(index, distribution)| match distribution.normal_std() {
            Some(std) if (matrix[index][index] - std * std).abs() <= SAME * std * std && std > 0.0 => Ok(std),
            Some(std) if std > 0.0 => Err((index, format!("the variance of its distribution ({:?})", std * std))),
            _ => Err((index, "the variance of a normal distribution".to_owned())),
        })
        .collect()
}
