//! Layer 1: integrators of ordinary differential equations, which know no physics.

pub mod adaptive;
pub mod embedded;
pub mod explicit;
pub mod fixed;
pub mod gauss_legendre;
pub mod step_control;
pub mod system;
pub mod tableau;
pub mod workspace;

pub use step_control::Control;
pub use system::{Runs, System, Tolerance};
pub use workspace::Workspace;
