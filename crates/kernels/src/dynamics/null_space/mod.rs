//! Berdoz's null-space formulation: fuselage, wheels and debris in redundant states, 62 with Berdoz's two wheels.
//!
//! Source: F. Berdoz, *Final Report - ADR Spacecraft*, with its equation numbers, in the notation of J. Forbes, *A
//! systematic approach to dynamics* (2019).
//! Corrections, each verified by an independent 40-digit solution:
//! - a-hat_non,s (end of section XVIII) is `+ (C_es^T v_p)^x c_s^x omega_s`; the printed minus violates conservation of
//!   energy;
//! - the lever arm of B_s (72) is rho_p, not rho_s; P2 acts at (0, -rho_p, l_s), P3 at (0, +rho_p, l_s), both along
//!   -s3;
//! - omega_e^se = C_es omega_s (printed as equal in section IX, true only for C_es = 1);
//! - S (68) contains each body's own third column.
//!
//! States: q holds position (p, g_i, g_d) and C_eb by columns for S, the wheels and D; nu holds [velocity in F_e,
//! angular velocity in the body's frame] per body; nu-hat = [v_p, omega_s, wheel rates, v_gd, omega_d]. A wheel's frame
//! is F_s at angle zero. nu = Pi nu-hat (58), q-dot = Gamma nu (9), M-hat = Pi^T M Pi (25), and `M-hat nu-hat-dot =
//! Pi^T (-M-dot nu - M Pi-dot nu-hat - Omega M nu + a_non + B u)` (39). `tests/accuracy/null_space.rs` proves that this
//! block form equals Berdoz's printed matrices.

pub(crate) mod completion;
pub(crate) mod energy;
pub mod forces;
pub mod kernel;
pub(crate) mod kinematics;
pub(crate) mod mass_matrix;
pub mod parameters;
pub(crate) mod residuals;
pub mod state;

pub use completion::{complete, observed_state};
pub use energy::{KineticEnergies, kinetic_energies};
pub use kernel::Kernel;
pub use parameters::Parameters;
pub use residuals::residuals;
pub use state::{Pose, State, components, sigma, states};
