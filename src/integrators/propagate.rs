//! [`Propagator`]: scenes in, tables of physical states out, by whichever method the plan chose.
//!
//! A propagator is decided once per plan: method, tolerance, grid, and which components are integrated at all. A worker then
//! holds one [`Engine`], compiled for its instruction set, with all the memory that runs need.

use fearless_simd::Simd;

use super::embedded::{Dop853, DormandPrince, Embedded};
use super::fixed::{FixedStep, RungeKutta4};
use super::gauss_legendre::GaussLegendre;
use super::method::Method;
use super::reference_engine::ReferenceEngine;
use super::runge_kutta_engine::{Adaptive, Fixed, March, RungeKuttaEngine};
use super::step_control::Control;
use super::taylor::engine::TaylorEngine;
use crate::dynamics::gyrostat::completion::components;
use crate::dynamics::gyrostat::{RATES_ONLY, WITH_ANGLES, WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST};
use crate::dynamics::outcome::Outcome;
use crate::dynamics::table::{Block, Blocks, Grid, StateTable};
use crate::math::isa::Work;
use crate::math::{Isa, Lanes};
use crate::scene::Scene;

/// What a campaign's runs have in common: how they are integrated and what of them is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Propagator {
    /// Kernel and method.
    pub method: Method,
    /// Tolerances and limits.
    pub control: Control,
    /// Observation times.
    pub grid: Grid,
    /// What the tables hold.
    pub blocks: Blocks,
    /// Whether any scene has thrust in its schedule.
    pub thrust: bool,
    /// Whether any scene has motor torque in its schedule.
    pub motors: bool,
}

/// Hands over a finished run: its index among the scenes, its states, how it ended.
pub type Finish<'a> = dyn FnMut(usize, &StateTable, &Outcome) + 'a;

/// A propagator's memory and code for one worker and one instruction set.
pub trait Engine: Send {
    /// Runs every scene once and hands each over, in whatever order they end; results depend on the scene alone.
    fn propagate(&mut self, scenes: &[Scene], finish: &mut Finish<'_>);
}

impl Propagator {
    /// The propagator for scenes that have the schedule of `nominal` (its sizes may differ from run to run).
    pub fn new(method: Method, control: Control, grid: Grid, blocks: Blocks, nominal: &Scene) -> Self {
        let any = |acts: fn(&crate::scene::Actuation) -> bool| nominal.schedule.iter().any(acts);
        Propagator {
            method,
            control,
            grid,
            blocks,
            thrust: any(|act| act.thrust != [0.0; 3]),
            motors: any(|act| act.torque != [0.0; 2]),
        }
    }

    /// Number of components that the gyrostat kernel integrates for this propagator.
    pub fn components(&self) -> usize {
        components(|block| self.blocks.contains(block), self.thrust, self.motors)
    }

    /// Memory and code for one worker.
    pub fn engine(&self, isa: Isa) -> Box<dyn Engine> {
        isa.run(Build(self))
    }
}

/// Builds the engine of a propagator for the instruction set `S`.
struct Build<'a>(&'a Propagator);

impl Work for Build<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let plan = self.0;
        match plan.method {
            Method::Auto | Method::Taylor => taylor(simd, plan),
            Method::DormandPrince => adaptive(simd, plan, DormandPrince),
            Method::Dop853 => adaptive(simd, plan, Dop853),
            Method::RungeKutta4 => fixed(simd, plan, RungeKutta4),
            Method::GaussLegendre => fixed(simd, plan, GaussLegendre),
            Method::Reference => Box::new(ReferenceEngine::new(simd, plan)),
        }
    }
}

/// The Taylor engine with the components that the plan needs.
///
/// A forced run integrates at least what motors ask for: fewer kernels to compile, and hardly slower.
fn taylor<S: Simd>(simd: S, plan: &Propagator) -> Box<dyn Engine> {
    let zero = Lanes::broadcast(simd, 0.0);
    match (plan.components(), plan.thrust || plan.motors) {
        (RATES_ONLY, false) => Box::new(TaylorEngine::<S, Lanes<S>, RATES_ONLY, false>::new(simd, zero, plan)),
        (WITH_ATTITUDE, false) => Box::new(TaylorEngine::<S, Lanes<S>, WITH_ATTITUDE, false>::new(simd, zero, plan)),
        (WITH_ANGLES, false) => Box::new(TaylorEngine::<S, Lanes<S>, WITH_ANGLES, false>::new(simd, zero, plan)),
        (WITH_THRUST, _) => Box::new(TaylorEngine::<S, Lanes<S>, WITH_THRUST, true>::new(simd, zero, plan)),
        _ => Box::new(TaylorEngine::<S, Lanes<S>, WITH_MOTORS, true>::new(simd, zero, plan)),
    }
}

/// A Runge-Kutta engine that follows the tolerance.
fn adaptive<S: Simd, M: Embedded + Send + 'static>(simd: S, plan: &Propagator, method: M) -> Box<dyn Engine> {
    runge_kutta(simd, plan, Adaptive(method))
}

/// A Runge-Kutta engine with a fixed step.
fn fixed<S: Simd, M: FixedStep + Send + 'static>(simd: S, plan: &Propagator, method: M) -> Box<dyn Engine> {
    runge_kutta(simd, plan, Fixed(method))
}

/// A Runge-Kutta engine: attitude and angles always, thrust where it is scheduled; two kernels a method are enough to compile.
fn runge_kutta<S: Simd, M: March + Send + 'static>(simd: S, plan: &Propagator, march: M) -> Box<dyn Engine> {
    if plan.thrust || plan.motors {
        Box::new(RungeKuttaEngine::<S, M, WITH_THRUST>::new(simd, march, plan))
    } else {
        Box::new(RungeKuttaEngine::<S, M, WITH_ANGLES>::new(simd, march, plan))
    }
}

/// Whether the table needs the rotation of the debris at all.
pub fn observes_debris_rotation(blocks: Blocks) -> bool {
    blocks.contains(Block::DebrisRate) || blocks.contains(Block::DebrisAttitude)
}
