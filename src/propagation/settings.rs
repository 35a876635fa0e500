//! [`PropagationSettings`]: scenes in, tables of physical states out, by whichever method the plan chose.
//!
//! A propagator is decided once per plan: method, tolerance, grid, and which components are integrated at all. A worker then
//! holds one [`Engine`], compiled for its instruction set, with all the memory that runs need.

use fearless_simd::Simd;

use super::method::Method;
use super::null_space_engine::NullSpaceEngine;
use super::runge_kutta_engine::{Adaptive, Fixed, LaneIntegrator, RungeKuttaEngine};
use super::taylor::engine::TaylorEngine;
use crate::dynamics::gyrostat::completion::components;
use crate::dynamics::gyrostat::{RATES_ONLY, WITH_ANGLES, WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST};
use crate::math::isa::{NarrowWork, WideWork};
use crate::math::{Isa, Lanes, Real};
use crate::ode::embedded::{Dop853, DormandPrince};
use crate::ode::fixed::RungeKutta4;
use crate::ode::gauss_legendre::GaussLegendre;
use crate::ode::step_control::Control;
use crate::run::Outcome;
use crate::run::{Grid, StateField, StateFields, StateTable};
use crate::scene::Scene;

/// What a campaign's runs have in common: how they are integrated and what of them is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct PropagationSettings {
    /// Kernel and method.
    pub method: Method,
    /// Tolerances and limits.
    pub control: Control,
    /// Observation times.
    pub grid: Grid,
    /// What the tables hold.
    pub blocks: StateFields,
    /// Whether the schedule commands thrust.
    pub thrust: bool,
    /// Whether the schedule commands motor torque.
    pub motors: bool,
}

/// Hands over a finished run: its index among the scenes, its states, how it ended.
pub type CompletionCallback<'a> = dyn FnMut(usize, &StateTable, &Outcome) + 'a;

/// A propagator's memory and code for one worker and one instruction set.
pub trait Engine: Send {
    /// Runs every scene once and hands each over, in whatever order they end; results depend on the scene alone.
    fn propagate(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>);
}

impl PropagationSettings {
    /// The propagator for scenes that have the schedule of `nominal` (its sizes may differ from run to run).
    pub fn new(method: Method, control: Control, grid: Grid, blocks: StateFields, nominal: &Scene) -> Self {
        PropagationSettings {
            method,
            control,
            grid,
            blocks,
            thrust: nominal.commands_thrust,
            motors: nominal.commands_torque,
        }
    }

    /// Number of components that the gyrostat kernel integrates for this propagator.
    pub fn components(&self) -> usize {
        components(|block| self.blocks.contains(block), self.thrust, self.motors)
    }

    /// Memory and code for one worker.
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

/// The Taylor engine with the components that the plan needs.
///
/// A forced run integrates at least what motors ask for: fewer kernels to compile, and hardly slower.
fn taylor<S: Simd, R: Real + Send + 'static>(simd: S, zero: R, plan: &PropagationSettings) -> Box<dyn Engine> {
    match (plan.components(), plan.thrust || plan.motors) {
        (RATES_ONLY, false) => Box::new(TaylorEngine::<S, R, RATES_ONLY, RATES_ONLY, false>::new(simd, zero, plan)),
        (WITH_ATTITUDE, false) => {
            Box::new(TaylorEngine::<S, R, WITH_ATTITUDE, WITH_ATTITUDE, false>::new(simd, zero, plan))
        }
        (WITH_ANGLES, false) => Box::new(TaylorEngine::<S, R, WITH_ANGLES, WITH_ANGLES, false>::new(simd, zero, plan)),
        (WITH_THRUST, _) => Box::new(TaylorEngine::<S, R, WITH_THRUST, WITH_ANGLES, true>::new(simd, zero, plan)),
        _ => Box::new(TaylorEngine::<S, R, WITH_MOTORS, WITH_ANGLES, true>::new(simd, zero, plan)),
    }
}

/// The engine of a Runge-Kutta method; `zero` says in how many lanes.
///
/// Only Dormand-Prince has a kernel of its own for scenes without actuators: every kernel costs compile time, and the others
/// are there for comparison.
fn runge_kutta<S: Simd, R: Real + Send + 'static>(simd: S, zero: R, plan: &PropagationSettings) -> Box<dyn Engine> {
    match plan.method {
        Method::NullSpace => Box::new(NullSpaceEngine::new(simd, plan)),
        Method::Dop853 => marched::<WITH_THRUST, _, _, _>(simd, zero, plan, Adaptive(Dop853)),
        Method::RungeKutta4 => marched::<WITH_THRUST, _, _, _>(simd, zero, plan, Fixed(RungeKutta4)),
        Method::GaussLegendre => marched::<WITH_THRUST, _, _, _>(simd, zero, plan, Fixed(GaussLegendre)),
        _ if plan.thrust || plan.motors => marched::<WITH_THRUST, _, _, _>(simd, zero, plan, Adaptive(DormandPrince)),
        _ => marched::<WITH_ANGLES, _, _, _>(simd, zero, plan, Adaptive(DormandPrince)),
    }
}

/// The engine of a march of the first `N` components.
fn marched<const N: usize, S: Simd, R: Real + Send + 'static, M: LaneIntegrator + Send + 'static>(
    simd: S,
    zero: R,
    plan: &PropagationSettings,
    march: M,
) -> Box<dyn Engine> {
    Box::new(RungeKuttaEngine::<S, R, M, N>::new(simd, zero, march, plan))
}

/// Whether the table needs the rotation of the debris at all.
pub fn observes_debris_rotation(blocks: StateFields) -> bool {
    blocks.contains(StateField::DebrisRate) || blocks.contains(StateField::DebrisAttitude)
}
