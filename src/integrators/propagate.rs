//! [`Propagator`]: scenes in, tables of physical states out, by whichever method the plan chose.
//!
//! A propagator is decided once per plan: method, tolerance, grid, and which components are integrated at all. A worker then
//! holds one [`Engine`], compiled for its instruction set, with all the memory that runs need.

use fearless_simd::Simd;

use super::method::Method;
use super::system::Tolerance;
use super::taylor::engine::TaylorEngine;
use crate::dynamics::gyrostat::completion::components;
use crate::dynamics::gyrostat::{RATES_ONLY, WITH_ANGLES, WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST};
use crate::dynamics::outcome::Outcome;
use crate::dynamics::table::{Block, Blocks, Grid, StateTable};
use crate::math::isa::Work;
use crate::math::{Isa, Lanes};
use crate::scene::Scene;

/// Tolerances and limits of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Tolerance of methods that follow one.
    pub tolerance: Tolerance,
    /// Step of methods with a fixed step, s.
    pub step: Option<f64>,
    /// Steps after which a run is given up.
    pub max_steps: u64,
}

/// How many runs stand side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Eight.
    Lanes,
    /// One; the bits are the same.
    Scalar,
}

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
    /// How many runs stand side by side.
    pub width: Width,
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
            width: Width::Lanes,
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
        let forced = plan.thrust || plan.motors;
        // a forced run integrates at least what motors ask for: one kernel less to compile, and hardly slower
        match (plan.components(), forced) {
            (RATES_ONLY, false) => taylor::<S, RATES_ONLY, false>(simd, plan),
            (WITH_ATTITUDE, false) => taylor::<S, WITH_ATTITUDE, false>(simd, plan),
            (WITH_ANGLES, false) => taylor::<S, WITH_ANGLES, false>(simd, plan),
            (WITH_THRUST, _) => taylor::<S, WITH_THRUST, true>(simd, plan),
            _ => taylor::<S, WITH_MOTORS, true>(simd, plan),
        }
    }
}

/// The Taylor engine in the width that the plan asks for.
fn taylor<S: Simd, const N: usize, const FORCED: bool>(simd: S, plan: &Propagator) -> Box<dyn Engine> {
    let zero = Lanes::broadcast(simd, 0.0);
    match plan.width {
        Width::Lanes => Box::new(TaylorEngine::<S, Lanes<S>, N, FORCED>::new(simd, zero, plan)),
        Width::Scalar => Box::new(TaylorEngine::<S, f64, N, FORCED>::new(simd, 0.0, plan)),
    }
}

/// Whether the table needs the rotation of the debris at all.
pub fn observes_debris_rotation(blocks: Blocks) -> bool {
    blocks.contains(Block::DebrisRate) || blocks.contains(Block::DebrisAttitude)
}
