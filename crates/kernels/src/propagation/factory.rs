//! Engines from settings: kernels and instruction sets of each method.

use core::marker::PhantomData;

use fearless_simd::Simd;

use super::engine::{CompletionCallback, Engine};
use super::method::Method;
use super::null_space_engine::{ALL_WHEELS, NullSpaceEngine, TWO_WHEELS};
use super::runge_kutta_engine::RungeKuttaEngine;
use super::settings::PropagationSettings;
use super::taylor::engine::TaylorEngine;
use crate::dynamics::actuation::Laws;
use crate::dynamics::effects::within_arcs::{Acting, NoEffects, WithinArcs};
use crate::dynamics::gyrostat::{RATES_ONLY, WITH_ANGLES, WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST};
use crate::math::isa::LaneWork;
use crate::math::{Isa, Real};
use crate::ode::integrators::Visitor;
use crate::ode::{self, Adaptive, Dop853, DormandPrince, Integrator};
use crate::scene::{MAX_WHEELS, Scene};

impl PropagationSettings {
    /// The engine for one worker on the instruction set `isa`.
    ///
    /// # Panics
    /// If the method does not integrate an effect of the scenes ([`Method::integrates`]).
    pub fn engine(&self, isa: Isa) -> Box<dyn Engine> {
        let Self { method, forces, .. } = self;
        assert!(method.integrates(*forces), "{} leaves out an effect of {forces:?}", method.name());
        if self.has_narrow_kernel() {
            Box::new(ByNumber { settings: self.clone(), isa, few: None, many: None })
        } else {
            self.engine_in_lanes(isa)
        }
    }

    /// True if loops fly one at a time ([`BuildNarrow`]).
    fn has_narrow_kernel(&self) -> bool {
        match self.method {
            Method::Auto | Method::Taylor => {
                self.feedback && (self.thrust || self.motors) && !self.changes_within_arcs()
            }
            Method::Gyrostat(Integrator::DormandPrince) => self.feedback && self.changes_within_arcs(),
            _ => false,
        }
    }

    fn engine_in_lanes(&self, isa: Isa) -> Box<dyn Engine> {
        match self.method {
            Method::Auto | Method::Taylor if self.changes_within_arcs() => isa.run_eight(BuildActing(self)),
            Method::Auto | Method::Taylor => isa.run_wide(BuildTaylor(self)),
            Method::Gyrostat(Integrator::Dop853) if self.changes_within_arcs() => {
                isa.run_eight(BuildUnderEffects(self, Adaptive(Dop853)))
            }
            Method::Gyrostat(Integrator::DormandPrince) if self.changes_within_arcs() => {
                isa.run_eight(BuildUnderEffects(self, Adaptive(DormandPrince)))
            }
            Method::Gyrostat(integrator) => isa.run_narrow(BuildGyrostat(self, integrator)),
            Method::NullSpace => isa.run_narrow(BuildNullSpace(self)),
        }
    }
}

/// Most runs of a loop that are flown one after the other: each takes an eighth to a quarter of the time of full lanes.
const FEW: usize = 3;

/// Flies few runs of a loop one after the other, and more in lanes, with the same bits.
struct ByNumber {
    settings: PropagationSettings,
    isa: Isa,
    few: Option<Box<dyn Engine>>,
    many: Option<Box<dyn Engine>>,
}

impl Engine for ByNumber {
    fn propagate_under(&mut self, laws: Laws<'_>, scenes: &[Scene], finish: &mut CompletionCallback<'_>) {
        let Self { settings, isa, few, many } = self;
        let engine = if scenes.len() <= FEW {
            few.get_or_insert_with(|| isa.run_one(BuildNarrow(settings)))
        } else {
            many.get_or_insert_with(|| settings.engine_in_lanes(*isa))
        };
        engine.propagate_under(laws, scenes, finish);
    }
}

/// The kernels of loops that fly one at a time.
struct BuildNarrow<'a>(&'a PropagationSettings);

impl LaneWork for BuildNarrow<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
        let settings = self.0;
        match settings.method {
            Method::Auto | Method::Taylor => BuildForced(settings).run(simd, zero),
            _ => OnGyrostats { simd, zero, settings, effects: PhantomData::<Acting<R>> }.visit(Adaptive(DormandPrince)),
        }
    }
}

macro_rules! taylor {
    ($self:ident, $simd:ident, $zero:ident, $Effects:ty, $components:ident, $series:ident, $forced:literal) => {
        Box::new(TaylorEngine::<S, R, $Effects, $components, $series, $forced>::new($simd, $zero, $self.0))
    };
}

/// The Taylor engine under effects within arcs: all integrals by series.
struct BuildActing<'a>(&'a PropagationSettings);

impl LaneWork for BuildActing<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
        taylor!(self, simd, zero, Acting<R>, WITH_THRUST, WITH_THRUST, true)
    }
}

/// The Taylor engine with the needed components. Forced runs always have the motors': fewer kernels to compile.
struct BuildTaylor<'a>(&'a PropagationSettings);

impl LaneWork for BuildTaylor<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
        if self.0.thrust || self.0.motors {
            return BuildForced(self.0).run(simd, zero);
        }
        match self.0.components() {
            RATES_ONLY => taylor!(self, simd, zero, NoEffects, RATES_ONLY, RATES_ONLY, false),
            WITH_ATTITUDE => taylor!(self, simd, zero, NoEffects, WITH_ATTITUDE, WITH_ATTITUDE, false),
            _ => taylor!(self, simd, zero, NoEffects, WITH_ANGLES, WITH_ANGLES, false),
        }
    }
}

struct BuildForced<'a>(&'a PropagationSettings);

impl LaneWork for BuildForced<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
        match self.0.components() {
            WITH_THRUST => taylor!(self, simd, zero, NoEffects, WITH_THRUST, WITH_ANGLES, true),
            _ => taylor!(self, simd, zero, NoEffects, WITH_MOTORS, WITH_ANGLES, true),
        }
    }
}

struct BuildGyrostat<'a>(&'a PropagationSettings, Integrator);

impl LaneWork for BuildGyrostat<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
        let BuildGyrostat(settings, integrator) = self;
        match integrator {
            _ if settings.changes_within_arcs() => {
                integrator.visit(OnGyrostats { simd, zero, settings, effects: PhantomData::<Acting<R>> })
            }
            // only Dormand-Prince has a kernel without actuation: the other integrators are for comparison
            Integrator::DormandPrince if !(settings.thrust || settings.motors) => {
                Box::new(RungeKuttaEngine::<S, R, _, NoEffects, WITH_ANGLES>::new(
                    simd,
                    zero,
                    Adaptive(DormandPrince),
                    settings,
                ))
            }
            _ => integrator.visit(OnGyrostats { simd, zero, settings, effects: PhantomData::<NoEffects> }),
        }
    }
}

/// A method under effects within arcs.
struct BuildUnderEffects<'a, M>(&'a PropagationSettings, M);

impl<M: ode::LaneMethod + Send + 'static> LaneWork for BuildUnderEffects<'_, M> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output {
        let BuildUnderEffects(settings, method) = self;
        OnGyrostats { simd, zero, settings, effects: PhantomData::<Acting<R>> }.visit(method)
    }
}

struct BuildNullSpace<'a>(&'a PropagationSettings);

impl LaneWork for BuildNullSpace<'_> {
    type Output = Box<dyn Engine>;

    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, _: R) -> Self::Output {
        // a kernel for Berdoz's two wheels, and one for any number
        if self.0.wheels <= 2 {
            Box::new(NullSpaceEngine::<S, 2, TWO_WHEELS>::new(simd, self.0))
        } else {
            Box::new(NullSpaceEngine::<S, MAX_WHEELS, ALL_WHEELS>::new(simd, self.0))
        }
    }
}

struct OnGyrostats<'a, S, R, E> {
    simd: S,
    zero: R,
    settings: &'a PropagationSettings,
    effects: PhantomData<E>,
}

impl<S: Simd, R: Real + Send + 'static, E: WithinArcs<R> + Send + 'static> Visitor for OnGyrostats<'_, S, R, E> {
    type Output = Box<dyn Engine>;

    fn visit<M: ode::LaneMethod + Send + 'static>(self, method: M) -> Box<dyn Engine> {
        let OnGyrostats { simd, zero, settings, .. } = self;
        Box::new(RungeKuttaEngine::<S, R, M, E, WITH_THRUST>::new(simd, zero, method, settings))
    }
}
