//! [`Method`]: the integration methods and their names in campaign files.

/// A formulation of the equations of motion together with an integration method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Gyrostat, Taylor series with periodic folding where the motion is periodic: the fastest.
    Auto,
    /// Gyrostat, Taylor series with order and step chosen from the tolerance (Jorba & Zou 2005).
    Taylor,
    /// Gyrostat, Dormand-Prince 5(4).
    DormandPrince,
    /// Gyrostat, Dormand-Prince 8(5,3).
    Dop853,
    /// Gyrostat, the classical Runge-Kutta method of order 4 with a fixed step.
    RungeKutta4,
    /// Gyrostat, Gauss-Legendre collocation of order 6 with a fixed step.
    GaussLegendre,
    /// The report's 62-state null-space formulation, Dormand-Prince 5(4).
    NullSpace,
}

impl Method {
    /// All methods, in the order in which they are listed to a user.
    pub const ALL: [Method; 7] = [
        Method::Auto,
        Method::Taylor,
        Method::DormandPrince,
        Method::Dop853,
        Method::RungeKutta4,
        Method::GaussLegendre,
        Method::NullSpace,
    ];

    /// The name in campaign files and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::Taylor => "taylor",
            Method::DormandPrince => "dormand_prince",
            Method::Dop853 => "dop853",
            Method::RungeKutta4 => "runge_kutta_4",
            Method::GaussLegendre => "gauss_legendre_6",
            Method::NullSpace => "null_space",
        }
    }

    /// The method called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// Whether the method takes steps of a fixed length (`integrator.step_s`) instead of following the tolerance.
    pub const fn has_fixed_step(self) -> bool {
        matches!(self, Method::RungeKutta4 | Method::GaussLegendre)
    }
}
