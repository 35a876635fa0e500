//! The Kalman update, innovations of all or part of the attitude, and normalised squares for tests of consistency.

use crate::loops::measurement::{Values, part};
use crate::loops::observes::{AttitudeInnovation, AttitudeSensor, Innovation};
use crate::loops::vector::{added, cholesky, conjugate, hamilton, multiplied, solved, transposed, vector_of};

/// e^T S^-1 e of an innovation or an estimation error: chi-square with `degrees` degrees of freedom if the filter is
/// consistent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalizedSquare {
    pub value: f64,
    /// Number of components of e.
    pub degrees: usize,
}

impl NormalizedSquare {
    /// Sum of independent squares; `None` if one is missing.
    pub fn sum(mut squares: impl Iterator<Item = Option<Self>>) -> Option<Self> {
        squares
            .try_fold(NormalizedSquare { value: 0.0, degrees: 0 }, |sum, square| square.map(|square| sum.with(square)))
    }

    /// Their sum.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        NormalizedSquare { value: self.value + other.value, degrees: self.degrees + other.degrees }
    }
}

/// e^T S^-1 e for the Cholesky factor `l` of S.
fn square_of<const N: usize>(l: &[[f64; N]; N], e: [f64; N]) -> NormalizedSquare {
    NormalizedSquare { value: e.iter().zip(solved(l, e)).map(|(a, b)| a * b).sum(), degrees: N }
}

/// e^T S^-1 e; `None` unless S is positive definite.
pub fn normalized_square<const N: usize>(s: &[[f64; N]; N], e: [f64; N]) -> Option<NormalizedSquare> {
    cholesky(s).map(|l| square_of(&l, e))
}

/// The gain of an M-component measurement on an N-component state.
#[derive(Clone, Copy, Debug)]
pub struct Gain<const N: usize, const M: usize> {
    gain: [[f64; M]; N],
    /// Cholesky factor of the innovation covariance.
    factor: [[f64; M]; M],
}

impl<const N: usize, const M: usize> Gain<N, M> {
    /// The gain for the sensitivity `h` to the first `K` states and measurement noise `r`; updates the covariance `p`
    /// in Joseph form, (1 - K H) P (1 - K H)^T + K R K^T (R. S. Bucy & P. D. Joseph, 1968). `None`, with no change,
    /// unless the innovation covariance is positive definite.
    pub fn of<const K: usize>(p: &mut [[f64; N]; N], h: &[[f64; K]; M], r: &[[f64; M]; M]) -> Option<Self> {
        let pht = multiplied(&first(p), &transposed(h));
        let factor = cholesky(&added(&multiplied(h, &top::<N, M, K>(&pht)), r))?;
        let gain: [[f64; M]; N] = std::array::from_fn(|i| solved(&factor, pht[i]));
        // the first K columns of 1 - K H; the others are those of the identity
        let mut rest = multiplied(&gain, h);
        for (i, row) in rest.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = f64::from(u8::from(i == j)) - *entry;
            }
        }
        let mut once = multiplied(&rest, &top::<N, N, K>(p));
        for (row, p) in once.iter_mut().zip(&*p).skip(K) {
            row.iter_mut().zip(p).for_each(|(entry, p)| *entry += p);
        }
        let mut twice = multiplied(&first(&once), &transposed(&rest));
        for (row, once) in twice.iter_mut().zip(&once) {
            row.iter_mut().zip(once).skip(K).for_each(|(entry, once)| *entry += once);
        }
        let noise = multiplied(&multiplied(&gain, r), &transposed(&gain));
        *p = symmetric(&added(&twice, &noise));
        Some(Gain { gain, factor })
    }

    pub fn correction(&self, e: [f64; M]) -> [f64; N] {
        self.gain.map(|row| row.iter().zip(e).map(|(k, e)| k * e).sum())
    }

    pub fn square(&self, e: [f64; M]) -> NormalizedSquare {
        square_of(&self.factor, e)
    }
}

/// The first `K` columns.
fn first<const N: usize, const M: usize, const K: usize>(a: &[[f64; M]; N]) -> [[f64; K]; N] {
    let mut columns = [[0.0; K]; N];
    columns.iter_mut().zip(a).for_each(|(row, of_a)| row.copy_from_slice(&of_a[..K]));
    columns
}

/// The first `K` rows.
fn top<const N: usize, const M: usize, const K: usize>(a: &[[f64; M]; N]) -> [[f64; M]; K] {
    let mut rows = [[0.0; M]; K];
    rows.copy_from_slice(&a[..K]);
    rows
}

pub fn transported<const N: usize>(a: &[[f64; N]; N], p: &[[f64; N]; N]) -> [[f64; N]; N] {
    multiplied(&multiplied(a, p), &transposed(a))
}

pub fn symmetric<const N: usize>(p: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut half = added(p, &transposed(p));
    half.iter_mut().flatten().for_each(|entry| *entry *= 0.5);
    half
}

/// The matrix [[a, b], [c, d]].
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

/// First and last three components.
pub fn halves(x: [f64; 6]) -> ([f64; 3], [f64; 3]) {
    let [a, b, c, d, e, f] = x;
    ([a, b, c], [d, e, f])
}

/// Updates `covariance`, whose first three errors are those of the attitude; the correction of the state and the
/// normalised square. `None`, with no change, if the innovation's covariance is singular to rounding.
pub fn updated(
    innovation: &AttitudeInnovation,
    covariance: &mut [[f64; 6]; 6],
) -> Option<([f64; 6], NormalizedSquare)> {
    match innovation {
        AttitudeInnovation::Two(innovation) => updated_by(innovation, covariance),
        AttitudeInnovation::Three(innovation) => updated_by(innovation, covariance),
    }
}

fn updated_by<const M: usize>(
    innovation: &Innovation<M>,
    covariance: &mut [[f64; 6]; 6],
) -> Option<([f64; 6], NormalizedSquare)> {
    let gain = Gain::of(covariance, &innovation.sensitivity, &innovation.covariance)?;
    Some((gain.correction(innovation.value), gain.square(innovation.value)))
}

/// A sensor of the whole attitude as a quaternion, with its error covariance in F_s, rad^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeAttitude(pub [[f64; 3]; 3]);

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl AttitudeSensor for WholeAttitude {
    fn innovation(&self, values: &Values, q_es: [f64; 4], _time: f64) -> AttitudeInnovation {
        let value = vector_of(hamilton(conjugate(q_es), part(values, 0)));
        AttitudeInnovation::Three(Innovation { value, sensitivity: IDENTITY, covariance: self.0 })
    }
}
