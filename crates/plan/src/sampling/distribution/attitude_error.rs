//! `attitude_error`: a normal rotation vector from the nominal attitude, in the frame of the body, with `std_rad` or
//! `covariance_rad2`.

use super::prelude::*;
use crate::math::normal::quantile;
use crate::math::vector::{dot, hamilton, norm, scaled};

/// q = q_0 (x) exp(theta/2) with a normal rotation vector theta of mean zero, in the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeError {
    nominal: [f64; 4],
    /// Lower triangular L, rad: the covariance is L L^T.
    factor: [[f64; 3]; 3],
}

impl AttitudeError {
    /// `covariance` in rad^2; `None` unless symmetric positive semidefinite (to 1e-12 of its trace).
    pub fn new(nominal: [f64; 4], covariance: [[f64; 3]; 3]) -> Option<Self> {
        Some(AttitudeError { nominal, factor: factor(covariance)? })
    }
}

impl Together for AttitudeError {
    const NAME: &'static str = "attitude_error";
    const KEYS: &'static [Row] = &[
        Row::values("std_rad", "Standard deviations of the components of the rotation vector"),
        Row::new("covariance_rad2", Kind::Matrix, "Covariance matrix of the rotation vector, by rows, rad^2"),
    ];
    const RULES: &'static [Rule] = &[Rule::One(&[&["std_rad"], &["covariance_rad2"]], "0.01", ALL_BUT_ONE)];

    fn map(target: &Target<'_>) -> Result<Self> {
        let nominal = target.attitude(Self::NAME)?;
        let (key, shown, covariance) =
            match (target.written.values("std_rad"), target.written.matrix("covariance_rad2")) {
                (None, Some(covariance)) => ("covariance_rad2", format!("{covariance:?}"), covariance),
                (std, _) => {
                    let std = std.unwrap_or(&Values::One(0.0));
                    ("std_rad", format!("{std:?}"), variances(target.index, std)?)
                }
            };
        match AttitudeError::new(nominal, covariance) {
            Some(map) => Ok(map),
            None => {
                let remedy = "variances on the diagonal; |c_ij| at most the root of c_ii c_jj";
                target.refused(key, shown, "symmetric and positive semidefinite", remedy)
            }
        }
    }
}

impl Map for AttitudeError {
    fn dimensions(&self) -> usize {
        3
    }

    fn values(&self, u: &[f64], values: &mut [f64]) {
        let z = [quantile(u[0]), quantile(u[1]), quantile(u[2])];
        let theta = core::array::from_fn(|i| (0..=i).map(|j| self.factor[i][j] * z[j]).sum());
        values[..4].copy_from_slice(&hamilton(self.nominal, rotation(theta)));
    }

    fn text(&self, words: NumberWords<'_>) -> String {
        // the covariance is L L^T
        let covariance = |i: usize, j: usize| dot(self.factor[i], self.factor[j]);
        let std: [f64; 3] = core::array::from_fn(|i| covariance(i, i).sqrt());
        let mut text = "normal rotation from the nominal attitude, std ".to_owned();
        text += &match std.map(words.angle) {
            [x, y, z] if x == y && y == z => format!("{x} about each axis"),
            [x, y, z] => format!("{x}, {y}, {z} about the axes"),
        };
        let pairs = [(0, 1, "xy"), (0, 2, "xz"), (1, 2, "yz")];
        if pairs.iter().any(|(i, j, _)| covariance(*i, *j) != 0.0) {
            let of = |(i, j, name): (usize, usize, &str)| {
                let product = std[i] * std[j];
                format!("{name} {}", (words.number)(if product > 0.0 { covariance(i, j) / product } else { 0.0 }))
            };
            text += &format!(", correlations {}", pairs.map(of).join(", "));
        }
        text
    }
}

fn variances(index: usize, values: &Values) -> Result<[[f64; 3]; 3]> {
    let list = match (values, &values.flat()[..]) {
        (Values::One(value), _) => [*value; 3],
        (_, &[x, y, z]) => [x, y, z],
        (other, _) => {
            let remedy = "give one for each axis of the body";
            return Err(error(index, "std_rad", format!("{other:?}"), "1 number, or 3 in an array", remedy));
        }
    };
    if let Some(x) = list.iter().find(|x| !(0.0..=f64::MAX).contains(*x)) {
        return Err(error(index, "std_rad", format!("{x:?}"), ">= 0", "drop the minus sign"));
    }
    let [a, b, c] = list.map(|x| x * x);
    Ok([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]])
}

/// The quaternion of the rotation vector `theta`, rad.
pub fn rotation(theta: [f64; 3]) -> [f64; 4] {
    let half = 0.5 * norm(theta);
    let (sine, cosine) = libm::sincos(half);
    // sin(x)/x is 1 to the last bit below 1e-8
    let share = if half < 1e-8 { 0.5 } else { 0.5 * sine / half };
    let [x, y, z] = scaled(share, theta);
    [cosine, x, y, z]
}

/// The lower Cholesky factor; `None` unless symmetric positive semidefinite. A zero pivot gives a column of zeros.
fn factor(m: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    /// Entries come from files, with twelve digits.
    const SLACK: f64 = 1e-12;
    let slack = SLACK * (m[0][0].abs() + m[1][1].abs() + m[2][2].abs());
    let symmetric = [(0, 1), (0, 2), (1, 2)].into_iter().all(|(i, j)| (m[i][j] - m[j][i]).abs() <= slack);
    if !symmetric || !m.iter().flatten().all(|x| x.is_finite()) {
        return None;
    }
    let mut l = [[0.0; 3]; 3];
    for j in 0..3 {
        let pivot = m[j][j] - dot(l[j], l[j]);
        if pivot < -slack {
            return None;
        }
        let root = pivot.max(0.0).sqrt();
        for i in j..3 {
            let rest = m[i][j] - dot(l[i], l[j]);
            if pivot > slack {
                l[i][j] = rest / root;
            } else if i > j && rest.abs() > slack.max((slack * m[i][i].abs()).sqrt()) {
                return None;
            }
        }
    }
    Some(l)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_covariance_is_factored_or_refused() {
        let m = [[4.0, 2.0, -2.0], [2.0, 5.0, 1.0], [-2.0, 1.0, 6.0]];
        let l = factor(m).expect("positive definite");
        for i in 0..3 {
            for j in 0..3 {
                assert!((dot(l[i], l[j]) - m[i][j]).abs() < 1e-15);
            }
        }
        assert_eq!(factor([[0.0; 3]; 3]), Some([[0.0; 3]; 3]));
        let flat = factor([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]]).expect("semidefinite");
        assert_eq!(flat, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        for wrong in [
            [[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[1.0, 0.5, 0.0], [0.4, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[0.0, 0.5, 0.0], [0.5, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            [[f64::NAN, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        ] {
            assert_eq!(factor(wrong), None, "{wrong:?}");
        }
    }
}
