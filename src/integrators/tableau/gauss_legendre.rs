//! Gauss-Legendre collocation with three stages, order 6: Butcher 1964, *Implicit Runge-Kutta processes*; Kuntzmann 1961.
//!
//! Symmetric, symplectic, and it keeps every quadratic invariant (Cooper 1987).

use super::Tableau;

/// sqrt(15), correctly rounded.
const ROOT_15: f64 = 3.872983346207417;

/// The tableau; see the module.
#[derive(Clone, Copy, Debug)]
pub struct GaussLegendreTableau;

impl Tableau<3> for GaussLegendreTableau {
    const C: [f64; 3] = [0.5 - ROOT_15 / 10.0, 0.5, 0.5 + ROOT_15 / 10.0];
    const A: [[f64; 3]; 3] = [
        [5.0 / 36.0, 2.0 / 9.0 - ROOT_15 / 15.0, 5.0 / 36.0 - ROOT_15 / 30.0],
        [5.0 / 36.0 + ROOT_15 / 24.0, 2.0 / 9.0, 5.0 / 36.0 - ROOT_15 / 24.0],
        [5.0 / 36.0 + ROOT_15 / 30.0, 2.0 / 9.0 + ROOT_15 / 15.0, 5.0 / 36.0],
    ];
    const B: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
}

impl GaussLegendreTableau {
    /// The derivatives at the stages of the next step of the same size, from those of this one: Lagrange's polynomials
    /// through the nodes C at 1 + C_i. A first guess only.
    pub const EXTRAPOLATION: [[f64; 3]; 3] = {
        let c = Self::C;
        let mut rows = [[0.0; 3]; 3];
        let mut i = 0;
        while i < 3 {
            let x = 1.0 + c[i];
            rows[i] = [
                (x - c[1]) * (x - c[2]) / ((c[0] - c[1]) * (c[0] - c[2])),
                (x - c[0]) * (x - c[2]) / ((c[1] - c[0]) * (c[1] - c[2])),
                (x - c[0]) * (x - c[1]) / ((c[2] - c[0]) * (c[2] - c[1])),
            ];
            i += 1;
        }
        rows
    };
}
