//! [`PropagationSettings`]: scenes in, tables of physical states out, by whichever method the plan chose.
//!
//! The settings are fixed once per plan: method, tolerance, grid, and which components are integrated at all. Every worker then
//! has one [`Engine`], compiled for its instruction set, with all the memory that runs need.

use fearless_simd::Simd;

use super::method::Method;
use super::null_space_engine::NullSpaceEngine;
use super::runge_kutta_engine::{Adaptive, Fixed, LaneIntegrator, RungeKuttaEngine};
use super::taylor::engine::TaylorEngine;
use crate::dynamics::actuation::Laws;
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
use crate::scene::{Arc, Scene};

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
    /// Whether thrust or body torque may act.
    pub thrust: bool,
    /// Whether motor torque may act.
    pub motors: bool,
    /// Whether runs may have laws of their own ([`Engine::propagate_under`]): then all components are integrated.
    pub feedback: bool,
}

/// A run that has ended.
#[derive(Clone, Copy, Debug)]
pub struct CompletedRun<'a> {
    /// The index among the scenes.
    pub index: usize,
    /// The states at the observation points.
    pub table: &'a StateTable,
    /// How the run ended.
    pub outcome: &'a Outcome,
    /// The arcs that were flown, in order, from time zero without a gap. As the schedule of a scene they give the same run.
    pub arcs: &'a [Arc],
}

/// Receives a run that has ended.
pub type CompletionCallback<'a> = dyn FnMut(CompletedRun<'_>) + 'a;

/// The memory and code of a method for one worker and one instruction set.
pub trait Engine: Send {
    /// Runs every scene once by the schedule of its own and passes it to `finish`, in the order in which the runs end; results depend
    /// on the scene alone.
    fn propagate(&mut self, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        self.propagate_under(Laws::OpenLoop, scenes, finish);
    }

    /// The same under `laws`: each run asks its law for one arc after another; results depend on the scene and its law alone.
    ///
    /// # Panics
    /// Where the settings are not for feedback ([`PropagationSettings::with_feedback`]) and a law is given, and where a law's answer
    /// ends before it starts.
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>);
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
            feedback: false,
        }
    }

    /// The same settings for runs that have laws of their own: anything may act, and every component is integrated, because a law
    /// sees the whole state.
    #[must_use]
    pub fn with_feedback(self) -> Self {
        PropagationSettings { thrust: true, motors: true, feedback: true, ..self }
    }

    /// Checks that runs of these settings can be flown under `laws`.
    ///
    /// # Panics
    /// Where they cannot.
    pub(super) fn check_laws(&self, laws: &Laws<'_>) {
        assert!(self.feedback || matches!(laws, Laws::OpenLoop), "laws need PropagationSettings::with_feedback");
    }

    /// Number of components that the gyrostat kernel integrates for this propagator.
    pub fn components(&self) -> usize {
        if self.feedback {
            return WITH_THRUST;
        }
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
