//! Gauss-Legendre collocation with three stages, order 6 (Butcher 1964; Kuntzmann 1961): symmetric, symplectic,
//! conserves every quadratic invariant (Cooper 1987).

use super::butcher::Tableau;

const ROOT_15: f64 = 3.872983346207417;

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
