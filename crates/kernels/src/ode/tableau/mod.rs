//! Tableaus of Runge-Kutta methods, tested to the last digit by all conditions of their order, one per rooted tree
//! (Butcher 1963; Hairer, Norsett & Wanner 1993, theorem II.2.13).

mod butcher;
mod dop853;
mod dormand_prince;
mod gauss_legendre;
mod runge_kutta_4;
#[cfg(test)]
pub(super) mod trees;

pub use butcher::Tableau;
pub use dop853::Dop853Tableau;
pub use dormand_prince::DormandPrinceTableau;
pub use gauss_legendre::GaussLegendreTableau;
pub use runge_kutta_4::RungeKutta4Tableau;

#[cfg(test)]
mod tests {
    use super::trees::{largest_defect, largest_defect_at};
    use super::*;

    /// Coefficients up to 50 in products of up to seven sums; measured 5e-15.
    const ROUND_OFF: f64 = 4e-14;

    fn orders<T: Tableau<S>, const S: usize>(order: usize) {
        for (row, node) in T::A.iter().zip(T::C) {
            assert!((row.iter().sum::<f64>() - node).abs() < ROUND_OFF, "row sum for the node {node}");
        }
        let defect = largest_defect(&T::A, &T::B, 1.0, order);
        assert!(defect < ROUND_OFF, "order {order}: {defect:e}");
        // counter-test: the next order is not met; measured 2.7e-5 or more
        assert!(largest_defect(&T::A, &T::B, 1.0, order + 1) > 3e-6);
        let mut slip = T::B;
        slip[0] += 1e-10;
        // the condition of order one shows it
        assert!(largest_defect(&T::A, &slip, 1.0, order) > 5e-11);
    }

    #[test]
    fn tableaus_have_their_orders() {
        orders::<DormandPrinceTableau, 7>(5);
        orders::<Dop853Tableau, 16>(8);
        orders::<RungeKutta4Tableau, 4>(4);
        orders::<GaussLegendreTableau, 3>(6);
        // Cooper 1987: b_i a_ij + b_j a_ji = b_i b_j.
        let (a, b) = (GaussLegendreTableau::A, GaussLegendreTableau::B);
        for i in 0..3 {
            for j in 0..3 {
                // products of weights below a half; measured 2.8e-17
                assert!((b[i] * a[i][j] + b[j] * a[j][i] - b[i] * b[j]).abs() < 1e-16);
            }
        }
    }

    #[test]
    fn embedded_solutions_have_their_orders() {
        let embedded = std::array::from_fn(|i| DormandPrinceTableau::B[i] - DormandPrinceTableau::E[i]);
        assert!(largest_defect(&DormandPrinceTableau::A, &embedded, 1.0, 4) < ROUND_OFF);
        // measured: 8.1e-4
        assert!(largest_defect_at(&DormandPrinceTableau::A, &embedded, 5) > 1e-4);
        for (error, order) in [(Dop853Tableau::E5, 5), (Dop853Tableau::E3, 3)] {
            let embedded = std::array::from_fn(|i| Dop853Tableau::B[i] - error[i]);
            assert!(largest_defect(&Dop853Tableau::A, &embedded, 1.0, order) < ROUND_OFF);
            // measured: 4.5e-4 or more
            assert!(largest_defect(&Dop853Tableau::A, &embedded, 1.0, order + 1) > 5e-5);
        }
    }
}
