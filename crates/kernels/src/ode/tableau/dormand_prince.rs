//! Dormand-Prince 5(4): seven stages, the last is the first of the next step, order 5 (Dormand & Prince 1980,
//! RK5(4)7M); dense output of order 4 (Shampine 1986), as in ode45 (Shampine & Reichelt 1997, `ntrp45`).

use super::butcher::Tableau;

#[derive(Clone, Copy, Debug)]
pub struct DormandPrinceTableau;

impl Tableau<7> for DormandPrinceTableau {
    const C: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
    const A: [[f64; 7]; 7] = [
        [0.0; 7],
        [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0, 0.0],
        [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0, 0.0],
        [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0, 0.0],
        Self::B,
    ];
    const B: [f64; 7] = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0, 0.0];
}

impl DormandPrinceTableau {
    /// Weights of the error: the solution of order 5 minus the embedded one of order 4.
    pub const E: [f64; 7] =
        [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

    /// Dense output: the weight of stage i at the fraction s of the step is `sum_p DENSE[i][p] s^(p+1)`.
    pub const DENSE: [[f64; 4]; 7] = [
        [1.0, -183.0 / 64.0, 37.0 / 12.0, -145.0 / 128.0],
        [0.0; 4],
        [0.0, 1500.0 / 371.0, -1000.0 / 159.0, 1000.0 / 371.0],
        [0.0, -125.0 / 32.0, 125.0 / 12.0, -375.0 / 64.0],
        [0.0, 9477.0 / 3392.0, -729.0 / 106.0, 25515.0 / 6784.0],
        [0.0, -11.0 / 7.0, 11.0 / 3.0, -55.0 / 28.0],
        [0.0, 3.0 / 2.0, -4.0, 5.0 / 2.0],
    ];
}
