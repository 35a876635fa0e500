//! Embedded explicit pairs: a step with an estimate of its error, and the state anywhere inside it.
//!
//! - [`DormandPrince`] behaves as ode45 does: Shampine & Reichelt 1997, *The MATLAB ODE Suite*, and ode45.m.
//! - [`Dop853`] behaves as DOP853 does: Hairer, Norsett & Wanner 1993, sections II.4 to II.6, and dop853.f.
//!
//! The norm of an error is the kernel's ([`super::System::error_ratio`]). The step control is in [`super::adaptive`].

mod dop853;
mod dormand_prince;
mod pair;

pub use dop853::Dop853;
pub use dormand_prince::{DormandPrince, DormandPrinceRestepped};
pub use pair::{Embedded, PairAttempt};
