//! Berdoz's null-space formulation: fuselage, wheels and debris in redundant states, 62 with Berdoz's two wheels.
//!
//! Source: F. Berdoz, *Final Report - ADR Spacecraft*; equation numbers in this folder are those of that report.
//! Notation of J. Forbes, *A systematic approach to dynamics* (2019); Berdoz's own symbols (Gamma, S, Pi, M, Omega,
//! a_non, B, nu-hat) are used only here. With these corrections, each verified against an independent 40-digit
//! solution:
//! - a-hat_non,s (end of section XVIII) is `+ (C_es^T v_p)^x c_s^x omega_s`; printed with a minus, energy is not
//!   conserved;
//! - the lever arm of B_s (72) is rho_p, not rho_s; P2 acts at (0, -rho_p, l_s), P3 at (0, +rho_p, l_s), both along
//!   -s3;
//! - omega_e^se = C_es omega_s (section IX prints them as equal, which is true only while C_es = 1);
//! - S (68) contains each body's own third column.
//!
//! The states: q contains, for each of S, the wheels and D, the position (p, g_i, g_d) and C_eb by columns; nu, per
//! body, [velocity in F_e, angular velocity in the body's frame]; nu-hat = [v_p, omega_s, the wheel rates, v_gd,
//! omega_d]. With Berdoz's two wheels they have 48, 24 and 14 components. A wheel's frame is F_s while its angle is
//! zero, so that its axis has the same components in both frames: the second axis of Berdoz's W1, the third of its W2,
//! any unit vector in general. nu = Pi nu-hat (58), q-dot = Gamma nu (9), and with M-hat = Pi^T M Pi (25) `M-hat
//! nu-hat-dot = Pi^T (-M-dot nu - M Pi-dot nu-hat - Omega M nu + a_non + B u)` (39).
//!
//! - [`state`]: the layout of the components, and Sigma (59).
//! - [`parameters`]: the constants of a scene.
//! - [`kinematics`]: S, Gamma, Pi, Pi-dot, block by block.
//! - [`mass_matrix`]: M-hat and its Cholesky solution.
//! - [`forces`]: M-dot, Omega, a_non, B, body by body.
//! - [`kernel`]: the right-hand side.
//! - [`mod@residuals`]: the constraints (27)-(34). [`energy`]: kinetic energies (36). [`completion`]: to a table of
//!   physical states.
//!
//! That this block form equals Berdoz's matrices as printed is a test (`tests/accuracy/null_space.rs`).
//!
//! Not here: the fast reduced form ([`super::gyrostat`]), and integration.

pub mod completion;
pub mod energy;
pub mod forces;
pub mod kernel;
pub mod kinematics;
pub mod mass_matrix;
pub mod parameters;
pub mod residuals;
pub mod state;

pub use completion::{complete, observed_state};
pub use energy::{KineticEnergies, kinetic_energies};
pub use kernel::Kernel;
pub use parameters::Parameters;
pub use residuals::residuals;
pub use state::{Pose, State, components, sigma, states};
