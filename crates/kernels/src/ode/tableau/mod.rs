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
    use super::trees::largest_defect;
    use super::*;

    /// Coefficients up to 50 in products of up to seven sums; measured 5e-15.
    const ROUND_OFF: f64 = 4e-14;

    /// Law: the weights `b` have the order `order`, and no higher one; a slip shows.
    fn has_order<T: Tableau<S>, const S: usize>(b: &[f64; S], order: usize) {
        let defect = |b: &[f64; S], order: usize| largest_defect(&T::A, b, order);
        assert!(defect(b, order) < ROUND_OFF, "order {order}: {:e}", defect(b, order));
        // measured 2.7e-5 or more
        assert!(defect(b, order + 1) > 3e-6, "order {order}");
        let mut slip = *b;
        slip[0] += 1e-10;
        assert!(defect(&slip, order) > 5e-11);
    }

    fn of_method<T: Tableau<S>, const S: usize>(order: usize, errors: &[(&[f64; S], usize)]) {
        for (row, node) in T::A.iter().zip(T::C) {
            assert!((row.iter().sum::<f64>() - node).abs() < ROUND_OFF, "row sum for the node {node}");
        }
        has_order::<T, S>(&T::B, order);
        for (error, order) in errors {
            has_order::<T, S>(&std::array::from_fn(|i| T::B[i] - error[i]), *order);
        }
    }

    #[test]
    fn solutions_and_embedded_ones_have_their_orders() {
        of_method::<DormandPrinceTableau, 7>(5, &[(&DormandPrinceTableau::E, 4)]);
        of_method::<Dop853Tableau, 16>(8, &[(&Dop853Tableau::E5, 5), (&Dop853Tableau::E3, 3)]);
        of_method::<RungeKutta4Tableau, 4>(4, &[]);
        of_method::<GaussLegendreTableau, 3>(6, &[]);
        // Cooper 1987: b_i a_ij + b_j a_ji = b_i b_j.
        let (a, b) = (GaussLegendreTableau::A, GaussLegendreTableau::B);
        for i in 0..3 {
            for j in 0..3 {
                // products of weights below a half; measured 2.8e-17
                assert!((b[i] * a[i][j] + b[j] * a[j][i] - b[i] * b[j]).abs() < 1e-16);
            }
        }
    }
}
