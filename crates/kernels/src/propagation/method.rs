//! [`Method`]: the integration methods and their names in campaign files.

use super::integrated_effects::{by_evaluation, by_null_space, by_series};
use crate::dynamics::effects::ForceModel;
use crate::ode::Integrator;

/// A formulation of the equations of motion with an integration method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Gyrostat, Taylor series with periodic folding, or what else is the fastest ([`Method::chosen`],
    /// [`super::PropagationSettings::with_feedback`] and `turning_by`).
    Auto,
    /// Gyrostat, Taylor series, order and step from the tolerance (Jorba & Zou 2005).
    Taylor,
    /// Gyrostat, an integrator of `ode::integrators`.
    Gyrostat(Integrator),
    /// Berdoz's 62-state null-space formulation, Dormand-Prince 5(4).
    NullSpace,
}

impl Method {
    /// All methods, in the order of lists for a user.
    pub const ALL: [Method; 3 + Integrator::ALL.len()] = {
        let mut all = [Method::Auto; 3 + Integrator::ALL.len()];
        all[1] = Method::Taylor;
        let mut index = 0;
        while index < Integrator::ALL.len() {
            all[2 + index] = Method::Gyrostat(Integrator::ALL[index]);
            index += 1;
        }
        all[2 + index] = Method::NullSpace;
        all
    };

    /// The name in campaign files and tables.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Auto => "auto",
            Method::Taylor => "taylor",
            Method::Gyrostat(integrator) => integrator.name(),
            Method::NullSpace => "null_space",
        }
    }

    /// The method called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// True if the engine of the method integrates every effect of `model`.
    pub fn integrates(self, model: ForceModel) -> bool {
        match self {
            Method::Auto => self.chosen(model) != self || model.is_integrated(by_series),
            Method::Gyrostat(integrator) if !integrator.has_fixed_step() => model.is_integrated(by_evaluation),
            Method::Taylor | Method::Gyrostat(_) => model.is_integrated(by_series),
            Method::NullSpace => model.is_integrated(by_null_space),
        }
    }

    /// The method used under the effects of `model`: `auto` becomes the fastest method that integrates all.
    #[must_use]
    pub fn chosen(self, model: ForceModel) -> Method {
        if self != Method::Auto || model.is_integrated(by_series) {
            return self;
        }
        let others = [Integrator::Dop853, Integrator::DormandPrince].map(Method::Gyrostat);
        others.into_iter().find(|method| method.integrates(model)).unwrap_or(self)
    }

    /// True if the method takes fixed steps (`integrator.step_s`) instead of following the tolerance.
    pub fn has_fixed_step(self) -> bool {
        matches!(self, Method::Gyrostat(integrator) if integrator.has_fixed_step())
    }
}
