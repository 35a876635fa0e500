//! [`Copula`]: a Gaussian copula between the u of several dimensions.
//!
//! Normal scores z = Phi^-1(u) of independent u become y = L z, with the Cholesky factor of the correlation matrix R =
//! L L^T, and u' = Phi(y): marginals stay, and R correlates the scores, or normal values. A rank correlation rho_s
//! needs r = 2 sin(pi rho_s/6) (K. Pearson 1907; W. H. Kruskal, *J. Am. Stat. Assoc.* 53 (1958) 814).
//!
//! A matrix that is not positive semidefinite is refused, or replaced by the nearest one (N. J. Higham, *Computing the
//! nearest correlation matrix*, IMA J. Numer. Anal. 22 (2002) 329, algorithm 3.3). Arithmetic is portable, since rows
//! depend on the factor.

use super::design::BLOCK;
use crate::math::normal::{probability, quantiles};

pub type Matrix = Vec<Vec<f64>>;

#[derive(Clone, Debug, PartialEq)]
pub struct Copula {
    pub dimensions: Vec<usize>,
    /// By rows, row i of i + 1 numbers.
    factor: Matrix,
}

/// Eigenvalues above minus this, times the order, are zero: rounding in 15 digits.
const SLACK: f64 = 1e-12;
/// Below, a row depends on those above it.
const SMALLEST_PIVOT: f64 = 1e-12;
/// Hundreds are typical.
const MOST_PROJECTIONS: usize = 5000;

impl Copula {
    /// `correlation` is positive semidefinite to rounding.
    pub fn new(dimensions: Vec<usize>, correlation: &Matrix) -> Self {
        Copula { dimensions, factor: cholesky(correlation) }
    }

    /// Makes the u of a block dependent and writes their normal scores.
    pub fn apply(&self, u: &mut [[f64; BLOCK]], scores: &mut [[f64; BLOCK]]) {
        for dimension in &self.dimensions {
            quantiles(&u[*dimension], &mut scores[*dimension]);
        }
        // upwards, each row needs only independent scores above it
        for (row, dimension) in self.factor.iter().zip(&self.dimensions).rev() {
            let mut sum = [0.0; BLOCK];
            for (weight, other) in row.iter().zip(&self.dimensions) {
                for (sum, score) in sum.iter_mut().zip(&scores[*other]) {
                    *sum += weight * score;
                }
            }
            scores[*dimension] = sum;
            for (u, score) in u[*dimension].iter_mut().zip(sum) {
                *u = inside(probability(score));
            }
        }
    }
}

/// `p`, kept away from zero and one.
fn inside(p: f64) -> f64 {
    const LEAST: f64 = f64::EPSILON / 2.0;
    p.clamp(LEAST, 1.0 - LEAST)
}

/// The correlation of normal scores for Spearman's.
pub fn score_correlation(rank_correlation: f64) -> f64 {
    2.0 * libm::sin(core::f64::consts::PI / 6.0 * rank_correlation)
}

/// The Cholesky factor; a row that depends on those above it has a zero diagonal.
fn cholesky(matrix: &Matrix) -> Matrix {
    let mut factor: Matrix = Vec::with_capacity(matrix.len());
    for (i, entries) in matrix.iter().enumerate() {
        let mut row = vec![0.0; i + 1];
        for j in 0..=i {
            let before: f64 = (0..j).map(|k| row[k] * if j == i { row[k] } else { factor[j][k] }).sum();
            let rest = entries[j] - before;
            row[j] = if j == i {
                if rest > SMALLEST_PIVOT { rest.sqrt() } else { 0.0 }
            } else if factor[j][j] > 0.0 {
                rest / factor[j][j]
            } else {
                0.0
            };
        }
        factor.push(row);
    }
    factor
}

/// The smallest eigenvalue, if negative beyond rounding.
pub fn smallest_negative_eigenvalue(matrix: &Matrix) -> Option<f64> {
    let (values, _) = eigen(matrix);
    let smallest = values.into_iter().fold(f64::INFINITY, f64::min);
    (smallest < -SLACK * matrix.len() as f64).then_some(smallest)
}

/// The nearest correlation matrix in the Frobenius norm (Higham 2002, algorithm 3.3).
pub fn nearest_correlation(matrix: &Matrix) -> Matrix {
    let n = matrix.len();
    let (mut y, mut correction) = (matrix.clone(), vec![vec![0.0; n]; n]);
    for _ in 0..MOST_PROJECTIONS {
        let r = combined(&y, &correction, -1.0);
        let x = semidefinite_part(&r);
        correction = combined(&x, &r, -1.0);
        let mut next = x;
        (0..n).for_each(|i| next[i][i] = 1.0);
        let change = combined(&next, &y, -1.0).iter().flatten().fold(0.0f64, |most, entry| most.max(entry.abs()));
        y = next;
        if change < 1e-14 {
            break;
        }
    }
    let x = semidefinite_part(&y);
    (0..n).map(|i| (0..n).map(|j| if i == j { 1.0 } else { x[i][j] / (x[i][i] * x[j][j]).sqrt() }).collect()).collect()
}

fn combined(a: &Matrix, b: &Matrix, factor: f64) -> Matrix {
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + factor * b).collect()).collect()
}

fn semidefinite_part(matrix: &Matrix) -> Matrix {
    let (values, vectors) = eigen(matrix);
    let n = matrix.len();
    let entry = |i: usize, j: usize| (0..n).map(|k| values[k].max(0.0) * vectors[i][k] * vectors[j][k]).sum();
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// Eigenvalues and eigenvectors (columns), by cyclic Jacobi rotations (Golub & Van Loan, *Matrix Computations*, 4th ed.
/// (2013), section 8.5).
#[expect(clippy::needless_range_loop, reason = "two rows of one matrix change together")]
fn eigen(matrix: &Matrix) -> (Vec<f64>, Matrix) {
    const SWEEPS: usize = 60;
    let n = matrix.len();
    let mut a = matrix.clone();
    let mut vectors: Matrix = (0..n).map(|i| (0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect();
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                if a[p][q].abs() <= f64::EPSILON * f64::EPSILON {
                    continue;
                }
                rotated = true;
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let cosine = 1.0 / (t * t + 1.0).sqrt();
                let sine = t * cosine;
                let turned = |x: f64, y: f64| (cosine * x - sine * y, sine * x + cosine * y);
                for row in &mut a {
                    (row[p], row[q]) = turned(row[p], row[q]);
                }
                for k in 0..n {
                    (a[p][k], a[q][k]) = turned(a[p][k], a[q][k]);
                }
                for row in &mut vectors {
                    (row[p], row[q]) = turned(row[p], row[q]);
                }
            }
        }
        if !rotated {
            break;
        }
    }
    ((0..n).map(|i| a[i][i]).collect(), vectors)
}
