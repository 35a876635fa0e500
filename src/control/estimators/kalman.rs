//! The update of a Kalman filter, and the squares by which its consistency is judged.

use crate::control::small_matrix::{added, cholesky, multiplied, solved, transposed};

/// e^T S^-1 e, of an innovation or of an error of the estimate: distributed as chi-square with `degrees` degrees of
/// freedom if the filter knows its noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalizedSquare {
    /// Its value.
    pub value: f64,
    /// The number of components of e.
    pub degrees: usize,
}

impl NormalizedSquare {
    /// The sum of squares that are independent; `None` where one is.
    pub fn sum(mut squares: impl Iterator<Item = Option<Self>>) -> Option<Self> {
        squares.try_fold(NormalizedSquare { value: 0.0, degrees: 0 }, |sum, square| {
            square.map(|NormalizedSquare { value, degrees }| NormalizedSquare {
                value: sum.value + value,
                degrees: sum.degrees + degrees,
            })
        })
    }
}

/// e^T S^-1 e for the factor `l` of S.
fn square_of<const N: usize>(l: &[[f64; N]; N], e: [f64; N]) -> NormalizedSquare {
    NormalizedSquare { value: e.iter().zip(solved(l, e)).map(|(a, b)| a * b).sum(), degrees: N }
}

/// e^T S^-1 e; `None` where S is not positive definite.
pub fn normalized_square<const N: usize>(s: &[[f64; N]; N], e: [f64; N]) -> Option<NormalizedSquare> {
    cholesky(s).map(|l| square_of(&l, e))
}

/// The gain of a measurement of M numbers on a state of N.
#[derive(Clone, Copy, Debug)]
pub struct Gain<const N: usize, const M: usize> {
    gain: [[f64; M]; N],
    /// The factor of the covariance of the innovation.
    factor: [[f64; M]; M],
}

impl<const N: usize, const M: usize> Gain<N, M> {
    /// The gain of a measurement with the sensitivity `h` and the covariance `r`; `p` becomes the covariance after it.
    /// `None`, and nothing changes, where the covariance of the innovation is not positive definite: the filter is as
    /// certain of the measurement as can be.
    ///
    /// The covariance is updated in the form (1 - K H) P (1 - K H)^T + K R K^T, which stays positive (R. S. Bucy & P.
    /// D. Joseph, 1968).
    pub fn of(p: &mut [[f64; N]; N], h: &[[f64; N]; M], r: &[[f64; M]; M]) -> Option<Self> {
        let pht = multiplied(p, &transposed(h));
        let factor = cholesky(&added(&multiplied(h, &pht), r))?;
        let gain: [[f64; M]; N] = std::array::from_fn(|i| solved(&factor, pht[i]));
        let kh = multiplied(&gain, h);
        let rest = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j)) - kh[i][j]));
        let noise = multiplied(&multiplied(&gain, r), &transposed(&gain));
        *p = symmetric(&added(&transported(&rest, p), &noise));
        Some(Gain { gain, factor })
    }

    /// The correction of the state for the innovation `e`.
    pub fn correction(&self, e: [f64; M]) -> [f64; N] {
        self.gain.map(|row| row.iter().zip(e).map(|(k, e)| k * e).sum())
    }

    /// The normalised square of the innovation `e`.
    pub fn square(&self, e: [f64; M]) -> NormalizedSquare {
        square_of(&self.factor, e)
    }
}

/// a p a^T.
pub fn transported<const N: usize>(a: &[[f64; N]; N], p: &[[f64; N]; N]) -> [[f64; N]; N] {
    multiplied(&multiplied(a, p), &transposed(a))
}

/// The symmetric part.
pub fn symmetric<const N: usize>(p: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut half = added(p, &transposed(p));
    half.iter_mut().flatten().for_each(|entry| *entry *= 0.5);
    half
}

/// The matrix of the blocks [[a, b], [c, d]].
pub fn blocks(a: [[f64; 3]; 3], b: [[f64; 3]; 3], c: [[f64; 3]; 3], d: [[f64; 3]; 3]) -> [[f64; 6]; 6] {
    let mut whole = [[0.0; 6]; 6];
    for (i, row) in whole.iter_mut().enumerate() {
        let (left, right) = if i < 3 { (a[i], b[i]) } else { (c[i - 3], d[i - 3]) };
        row[..3].copy_from_slice(&left);
        row[3..].copy_from_slice(&right);
    }
    whole
}

/// The blocks a, b, d of the symmetric matrix [[a, b], [b^T, d]].
pub fn corners(p: &[[f64; 6]; 6]) -> [[[f64; 3]; 3]; 3] {
    let mut all = [[[0.0; 3]; 3]; 3];
    for i in 0..3 {
        all[0][i].copy_from_slice(&p[i][..3]);
        all[1][i].copy_from_slice(&p[i][3..]);
        all[2][i].copy_from_slice(&p[i + 3][3..]);
    }
    all
}

/// The first three and the last three of six numbers.
pub fn halves(x: [f64; 6]) -> ([f64; 3], [f64; 3]) {
    let [a, b, c, d, e, f] = x;
    ([a, b, c], [d, e, f])
}
