//! Inertia by second moments of mass: S, the integral of r r^T dm about the centre of mass, and J = tr(S) 1 - S.
//!
//! A symmetric J is the inertia of some body exactly if S is positive semidefinite (positive moments, none above the
//! sum of the other two), which changes of S easily preserve (C. Rucker & P. M. Wensing, IEEE Robotics and Automation
//! Letters 7(2), 2022).

use super::schema::{MassErrors, PrincipalInertia, PrincipalMoments};
use super::solids::Body;
use super::tensor::{symmetric_of, symmetric_product};
use crate::math::prelude::*;

/// S of the inertia `j`, kg m^2, by rows: (tr(J)/2) 1 - J, with a diagonal of half sums and half differences.
pub fn second_moment<R: Real>(j: [[R; 3]; 3]) -> [[R; 3]; 3] {
    let half = j[0][0].splat(0.5);
    let own = |i: usize| half * ((j[(i + 1) % 3][(i + 1) % 3] - j[i][i]) + j[(i + 2) % 3][(i + 2) % 3]);
    symmetric_of(|i, k| if i == k { own(i) } else { -j[i][k] })
}

/// J = tr(S) 1 - S, kg m^2, by rows: sums of positive numbers on the diagonal.
pub fn inertia<R: Real>(s: [[R; 3]; 3]) -> [[R; 3]; 3] {
    let own = |i: usize| s[(i + 1) % 3][(i + 1) % 3] + s[(i + 2) % 3][(i + 2) % 3];
    symmetric_of(|i, k| if i == k { own(i) } else { -s[i][k] })
}

impl PrincipalInertia {
    /// The tensor in the body frame, kg m^2, by rows, in the type of `one`: C diag(moments) C^T with C from the
    /// normalised quaternion; diagonal without a rotation.
    pub fn tensor<R: Real>(&self, one: R) -> [[R; 3]; 3] {
        let zero = one.zero();
        let moments = match self.moments {
            PrincipalMoments::Inertia(moments) => constant(one, moments),
            PrincipalMoments::Second(moments) => {
                let [a, b, c] = constant(one, moments);
                [b + c, a + c, a + b]
            }
        };
        let q = constant_quaternion(one, self.axes);
        let square = q[0].mul_add(q[0], q[1].mul_add(q[1], q[2].mul_add(q[2], q[3] * q[3])));
        let c = dcm_from_quaternion(q);
        if self.axes[1..] == [0.0; 3] {
            return [[moments[0], zero, zero], [zero, moments[1], zero], [zero, zero, moments[2]]];
        }
        // |q|^2 times a rotation, twice
        let scale = one / (square * square);
        let entry =
            |i: usize, j: usize| scale * dot([c[i][0] * moments[0], c[i][1] * moments[1], c[i][2] * moments[2]], c[j]);
        symmetric_of(entry)
    }
}

impl MassErrors {
    /// `body` with these errors; the same bits without.
    pub fn applied<R: Real>(&self, body: Body<R>) -> Body<R> {
        if *self == Self::DEFAULT {
            return body;
        }
        let one = body.mass.splat(1.0);
        let mass_scale = one.splat(self.mass_scale);
        let scale = mass_scale * one.splat(self.inertia_scale);
        Body {
            mass: mass_scale * body.mass,
            center: sum(body.center, constant(one, self.center_offset_m)),
            inertia: if self.stretch_log == [0.0; 3] && self.shear == [0.0; 3] {
                [scaled(scale, body.inertia[0]), scaled(scale, body.inertia[1]), scaled(scale, body.inertia[2])]
            } else {
                inertia(self.moved(scale, second_moment(body.inertia)))
            },
        }
    }

    /// k A S A^T.
    fn moved<R: Real>(&self, scale: R, s: [[R; 3]; 3]) -> [[R; 3]; 3] {
        let k = |value: f64| scale.splat(value);
        let [x, y, z] = self.stretch_log.map(libm::exp);
        let [xy, xz, yz] = self.shear;
        let a = [[k(x), k(0.0), k(0.0)], [k(xy), k(y), k(0.0)], [k(xz), k(yz), k(z)]];
        symmetric_product(scale, a, s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_axes_turn_the_tensor() {
        let axes = [std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2]; // s1 -> s2
        let principal = PrincipalInertia { moments: PrincipalMoments::Inertia([2.0, 3.0, 4.0]), axes };
        let tensor = principal.tensor(1.0);
        for (i, expected) in [3.0, 2.0, 4.0].into_iter().enumerate() {
            // roundings of entries up to four; measured: 4.4e-16
            assert!((tensor[i][i] - expected).abs() < 2e-15, "{tensor:?}");
        }
        let second =
            PrincipalInertia { moments: PrincipalMoments::Second([2.5, 1.5, 0.5]), axes: [1.0, 0.0, 0.0, 0.0] };
        assert_eq!(second.tensor(1.0), [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]);
    }
}
