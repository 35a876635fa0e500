//! From settings to an [`Engine`]: the list of methods, each with the kernels and instruction sets that it is compiled for.
//!
//! A separate file, because the engines know the settings, and the settings do not know the engines.

use fearless_simd::Simd;

use super::engine::Engine;
use super::method::Method;
use super::null_space_engine::NullSpaceEngine;
use super::runge_kutta_engine::RungeKuttaEngine;
use super::settings::PropagationSettings;
use super::taylor::engine::TaylorEngine;
use crate::dynamics::gyrostat::{RATES_ONLY, WITH_ANGLES, WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST};
use crate::math::isa::{NarrowWork, WideWork};
use crate::math::{Isa, Lanes, Real};
use crate::ode::{self, Adaptive, Dop853, DormandPrince, Fixed, GaussLegendre, RungeKutta4};

impl PropagationSettings {
    /// The engine for one worker on the instruction set `isa`.
    pub fn engine(&self, isa: Isa) -> Box<dyn Engine> {
        match self.method {
            Method::Auto | Method::Taylor => isa.run_wide(BuildTaylor(self)),
            _ => isa.run_narrow(BuildRungeKutta(self)),
        }
    }
}

/// Builds the engine of a Taylor method.
struct BuildTaylor<'a>(&'a PropagationSettings);

impl WideWork for BuildTaylor<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
        taylor(simd, zero, self.0)
    }
}

/// Builds the engine of a Runge-Kutta method.
struct BuildRungeKutta<'a>(&'a PropagationSettings);

impl NarrowWork for BuildRungeKutta<'_> {
    type Output = Box<dyn Engine>;

    fn in_lanes<S: Simd>(self, simd: S) -> Self::Output {
        runge_kutta(simd, Lanes::broadcast(simd, 0.0), self.0)
    }

    fn in_scalars<S: Simd>(self, simd: S) -> Self::Output {
        runge_kutta(simd, 0.0, self.0)
    }
}

/// The Taylor engine with the components that the settings need.
///
/// A forced run integrates at least what motors need: fewer kernels to compile, and hardly slower.
fn taylor<S: Simd, R: Real + Send + 'static>(simd: S, zero: R, settings: &PropagationSettings) -> Box<dyn Engine> {
    match (settings.components(), settings.thrust || settings.motors) {
        (RATES_ONLY, false) => Box::new(TaylorEngine::<S, R, RATES_ONLY, RATES_ONLY, false>::new(simd, zero, settings)),
        (WITH_ATTITUDE, false) => {
            Box::new(TaylorEngine::<S, R, WITH_ATTITUDE, WITH_ATTITUDE, false>::new(simd, zero, settings))
        }
        (WITH_ANGLES, false) => {
            Box::new(TaylorEngine::<S, R, WITH_ANGLES, WITH_ANGLES, false>::new(simd, zero, settings))
        }
        (WITH_THRUST, _) => Box::new(TaylorEngine::<S, R, WITH_THRUST, WITH_ANGLES, true>::new(simd, zero, settings)),
        _ => Box::new(TaylorEngine::<S, R, WITH_MOTORS, WITH_ANGLES, true>::new(simd, zero, settings)),
    }
}

/// The engine of a Runge-Kutta method; `zero` determines the number of lanes.
///
/// Only Dormand-Prince has a separate kernel for scenes without actuation: every kernel costs compile time, and the other methods
/// are for comparison.
fn runge_kutta<S: Simd, R: Real + Send + 'static>(simd: S, zero: R, settings: &PropagationSettings) -> Box<dyn Engine> {
    match settings.method {
        Method::NullSpace => Box::new(NullSpaceEngine::new(simd, settings)),
        Method::Dop853 => on_gyrostats::<WITH_THRUST, _, _, _>(simd, zero, settings, Adaptive(Dop853)),
        Method::RungeKutta4 => on_gyrostats::<WITH_THRUST, _, _, _>(simd, zero, settings, Fixed(RungeKutta4)),
        Method::GaussLegendre => on_gyrostats::<WITH_THRUST, _, _, _>(simd, zero, settings, Fixed(GaussLegendre)),
        _ if settings.thrust || settings.motors => {
            on_gyrostats::<WITH_THRUST, _, _, _>(simd, zero, settings, Adaptive(DormandPrince))
        }
        _ => on_gyrostats::<WITH_ANGLES, _, _, _>(simd, zero, settings, Adaptive(DormandPrince)),
    }
}

/// A method on the first `N` components of gyrostats.
fn on_gyrostats<const N: usize, S: Simd, R: Real + Send + 'static, M: ode::Method + Send + 'static>(
    simd: S,
    zero: R,
    settings: &PropagationSettings,
    method: M,
) -> Box<dyn Engine> {
    Box::new(RungeKuttaEngine::<S, R, M, N>::new(simd, zero, method, settings))
}
