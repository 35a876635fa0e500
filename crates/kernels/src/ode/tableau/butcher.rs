//! [`Tableau`]: the coefficients of a Runge-Kutta method (Butcher 1963).

/// A Runge-Kutta method of `S` stages: k_i = f(t + C_i h, y + h sum_j A_ij k_j), y' = y + h sum_i B_i k_i.
pub trait Tableau<const S: usize> {
    /// Nodes.
    const C: [f64; S];
    /// Weights of stages in stages; strictly lower triangular for explicit methods.
    const A: [[f64; S]; S];
    /// Weights of the stages in the step.
    const B: [f64; S];
}
