//! The list of integrators. A row has an integrator's file, name, method with step control and meaning; names in
//! messages, `spindrift precision` and the engine of each gyrostat follow.
//!
//! - [`DormandPrince`] follows ode45: Shampine & Reichelt 1997, *The MATLAB ODE Suite*, and ode45.m.
//! - [`Dop853`] follows DOP853: Hairer, Norsett & Wanner 1993, sections II.4 to II.6, and dop853.f.
//!
//! The kernel defines the norm of errors ([`super::System::error_ratio`]); step control is in [`super::adaptive`] and
//! [`super::fixed`], coefficients in [`super::tableau`].

use super::adaptive::Adaptive;
use super::fixed::Fixed;
use super::stepper::LaneMethod;

/// An operation on the method of any integrator.
pub trait Visitor {
    /// Its result.
    type Output;

    /// Applies it to `method`.
    fn visit<M: LaneMethod + Send + 'static>(self, method: M) -> Self::Output;
}

/// `Type, file, "name", method with step control, "meaning";` for each integrator, in the order of lists for a user.
macro_rules! integrators {
    ($($Type:ident, $file:ident, $name:literal, $method:expr, $meaning:literal;)+) => {
        $(mod $file; pub use $file::$Type;)+

        /// An integrator of the list.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Integrator { $(#[doc = concat!($meaning, ".")] $Type,)+ }

        impl Integrator {
            /// All integrators, in the order of lists for a user.
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
