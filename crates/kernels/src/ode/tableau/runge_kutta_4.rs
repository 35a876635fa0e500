//! The classical method of order 4 (Kutta 1901).

use super::butcher::Tableau;

#[derive(Clone, Copy, Debug)]
pub struct RungeKutta4Tableau;

impl Tableau<4> for RungeKutta4Tableau {
    const C: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
    const A: [[f64; 4]; 4] = [[0.0; 4], [0.5, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
    const B: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
}
