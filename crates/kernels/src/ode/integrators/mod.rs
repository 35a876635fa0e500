//! The list of integrators, from which their names, `spindrift precision` and the engines of gyrostats follow.
//!
//! - [`DormandPrince`] follows ode45: Shampine & Reichelt 1997, *The MATLAB ODE Suite*, and ode45.m.
//! - [`Dop853`] follows DOP853: Hairer, Norsett & Wanner 1993, sections II.4 to II.6, and dop853.f.
//!
//! Kernels define the norm of errors ([`super::System::error_ratio`]).

use super::adaptive::Adaptive;
use super::fixed::Fixed;
use super::stepper::LaneMethod;

/// An operation on the method of any integrator.
pub trait Visitor {
    /// Result.
    type Output;

    /// Applies the operation to `method`.
    fn visit<M: LaneMethod + Send + 'static>(self, method: M) -> Self::Output;
}

/// `Type, file, "name", method with step control, "meaning";` for each integrator.
macro_rules! integrators {
    ($($Type:ident, $file:ident, $name:literal, $method:expr, $meaning:literal;)+) => {
        $(mod $file; pub use $file::$Type;)+

        /// An integrator of the list.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Integrator { $(#[doc = concat!($meaning, ".")] $Type,)+ }

        impl Integrator {
            /// All integrators, in the order shown to users.
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

impl Integrator {
    /// True if it takes fixed steps (`integrator.step_s`) instead of following the tolerance.
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
