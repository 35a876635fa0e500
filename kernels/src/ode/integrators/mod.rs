//! The list of integrators of ordinary differential equations: one row each, from which everything that enumerates them
//! follows.
//!
//! A row declares the integrator's own file and states its name in campaign files. To add one, write its file and its
//! row: the names in messages, `spindrift precision` and the engine of each gyrostat follow.
//!
//! - [`DormandPrince`] behaves as ode45 does: Shampine & Reichelt 1997, *The MATLAB ODE Suite*, and ode45.m.
//! - [`Dop853`] behaves as DOP853 does: Hairer, Norsett & Wanner 1993, sections II.4 to II.6, and dop853.f.
//!
//! The norm of an error is the kernel's ([`super::System::error_ratio`]). Step control is in [`super::adaptive`] and
//! [`super::fixed`]; coefficients of the published methods are in [`super::tableau`].

use super::adaptive::Adaptive;
use super::fixed::Fixed;
use super::stepper::LaneMethod;

/// Does something with the method of an integrator, whichever it is.
pub trait Visitor {
    /// What comes out.
    type Output;

    /// Does it with `method`.
    fn visit<M: LaneMethod + Send + 'static>(self, method: M) -> Self::Output;
}

/// `Type, file, "name", its method with step control, "what it is";` for each integrator, in the order in which they
/// are listed to a user.
macro_rules! integrators {
    ($($Type:ident, $file:ident, $name:literal, $method:expr, $meaning:literal;)+) => {
        $(mod $file; pub use $file::$Type;)+

        /// An integrator of the list.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Integrator { $(#[doc = concat!($meaning, ".")] $Type,)+ }

        impl Integrator {
            /// All integrators, in the order in which they are listed to a user.
            pub const ALL: &'static [Integrator] = &[$(Integrator::$Type),+];

            /// The name in campaign files and tables.
            pub const fn name(self) -> &'static str {
                match self { $(Integrator::$Type => $name),+ }
            }

            /// Passes the method to `visitor`.
            pub fn visit<V: Visitor>(self, visitor: V) -> V::Output {
                match self { $(Integrator::$Type => visitor.visit($method)),+ }
            }
        }
    };
}

integrators! {
    DormandPrince, dormand_prince, "dormand_prince", Adaptive(DormandPrince), "Dormand-Prince 5(4)";
    Dop853, dop853, "dop853", Adaptive(Dop853), "Dormand-Prince 8(5,3)";
    RungeKutta4, runge_kutta_4, "runge_kutta_4", Fixed(RungeKutta4),
    "The classical Runge-Kutta method of order 4 with a fixed step";
    GaussLegendre, gauss_legendre, "gauss_legendre_6", Fixed(GaussLegendre),
    "Gauss-Legendre collocation of order 6 with a fixed step";
}

pub use dormand_prince::DormandPrinceRestepped;

#[cfg(test)]
mod still;

impl Integrator {
    /// Whether it takes steps of a fixed length (`integrator.step_s`) instead of following the tolerance.
    pub fn has_fixed_step(self) -> bool {
        struct HasFixedStep;
        impl Visitor for HasFixedStep {
            type Output = bool;
            fn visit<M: LaneMethod + Send + 'static>(self, _: M) -> bool {
                M::HAS_FIXED_STEP
            }
        }
        self.visit(HasFixedStep)
    }
}
