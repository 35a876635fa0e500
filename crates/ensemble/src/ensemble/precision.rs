//! [`Precision`]: work-precision diagrams of methods and settings on samples of a campaign (E. Hairer, S. P. Norsett &
//! G. Wanner, *Solving Ordinary Differential Equations I*, 1993, section II.10).
//!
//! Errors are relative to the [`ReferenceSolution`] in double-double. Time is the CPU time of one thread that
//! propagates a campaign's batches with states at all observation points, without observation and files.

use crate::campaign::{Plan, SceneDraws};
use crate::dynamics::gyrostat::Gyrostat;
use crate::ensemble::run_cost::thread_seconds;
use crate::ensemble::single::states;
use crate::ensemble::worker::BATCH;
use crate::math::Isa;
use crate::math::lanes::WIDTH;
use crate::observables::{ErrorStatistic, Group, Observer, Request, Series, error_id};
use crate::ode::{Control, Tolerance};
use crate::propagation::taylor::reference_solution::{self, ReferenceSolution};
use crate::propagation::{CompletedRun, Engine, Method, PropagationSettings, rotation_errors};
use crate::run::{StateField, StateFields, Status};
use crate::sampling::SampleId;
use crate::scene::Scene;
use rayon::prelude::*;

/// Shortest repetition, s: thousands of ticks of the clock.
const SHORTEST: f64 = 5e-3;

/// Excess over the limit that stops a first pass.
const EXCESS: f64 = 2.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// Relative and absolute tolerance of an adaptive method.
    Tolerance(f64),
    /// Step of a fixed-step method, s.
    Step(f64),
}

/// Over samples and observation points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    pub max: f64,
    pub rms: f64,
}

/// Errors are `None` if their states are not integrated or all runs failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    pub method: Method,
    pub setting: Setting,
    /// CPU time of a run, s: median and minimum of the repetitions.
    pub cpu: [f64; 2],
    pub repeats: usize,
    /// All, and failed ones.
    pub runs: [usize; 2],
    /// Mean accepted steps of a run.
    pub steps: f64,
    /// |omega - reference| over the run's largest |omega|.
    pub rate: Option<Deviation>,
    /// Twice the distance of the quaternions, rad: the angle if the norm is kept.
    pub attitude: Option<Deviation>,
    /// Relative error of the energy balance.
    pub energy: Option<Deviation>,
    /// Relative error of the balance of angular momentum.
    pub momentum: Option<Deviation>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skipped {
    pub method: Method,
    pub setting: Setting,
    /// Predicted time of a pass, s.
    pub predicted: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    pub repeats: usize,
    /// CPU time of a pass, s.
    pub limit: f64,
}

pub struct Precision<'p> {
    plan: &'p Plan,
    isa: Isa,
    fields: StateFields,
    request: Request,
    scenes: Vec<Scene>,
    references: Vec<ReferenceSolution>,
}

impl<'p> Precision<'p> {
    /// The first `samples` physical samples with reference solutions, on all cores. Integrated are all states of the
    /// scene, as in `simulate`, or `is_observed` those of the campaign's groups, and omega.
    ///
    /// # Errors
    /// A sample whose reference solution fails.
    pub fn new(plan: &'p Plan, isa: Isa, samples: usize, is_observed: bool) -> Result<Self, (SampleId, Status)> {
        let mut draws = SceneDraws::new(plan);
        let drawn: Vec<(SampleId, Scene)> = (0..plan.samples)
            .filter_map(|id| Some((SampleId(id), draws.scene(SampleId(id)).ok()?)))
            .take(samples)
            .collect();
        let balances = [Group::EnergyConservation, Group::MomentumConservation];
        let plain = Request { constrained: false, ..plan.request() };
        let of_balances = Request { groups: balances.into_iter().collect(), ..plain };
        let (request, fields) = match is_observed {
            false => (of_balances, states(&plain).union(of_balances.fields())),
            true => (plain, plain.fields().with(StateField::Rate)),
        };
        let compared = [StateField::Rate, StateField::Attitude].into_iter().filter(|field| fields.contains(*field));
        let compared = compared.fold(StateFields::NONE, StateFields::with);
        let solve = |(id, scene): &(SampleId, Scene)| {
            ReferenceSolution::new(isa, scene, &plan.grid, compared, reference_solution::TOLERANCE)
                .map_err(|status| (*id, status))
        };
        let references = drawn.par_iter().map(solve).collect::<Result<Vec<_>, _>>()?;
        let scenes = drawn.into_iter().map(|(_, scene)| scene).collect();
        Ok(Precision { plan, isa, fields, request, scenes, references })
    }

    pub fn samples(&self) -> usize {
        self.scenes.len()
    }

    /// `tolerances`, or as many fixed steps, each half of the one before, from twice the time scale of the first
    /// sample's motion.
    pub fn settings(&self, method: Method, tolerances: &[f64]) -> Vec<Setting> {
        if !method.has_fixed_step() {
            return tolerances.iter().map(|tolerance| Setting::Tolerance(*tolerance)).collect();
        }
        let duration = self.plan.grid.duration();
        let unit = self.scenes.first().map_or(duration, |scene| Gyrostat::new(0.0, scene, duration).time_unit());
        let mut step = 2.0 * unit.min(duration);
        tolerances
            .iter()
            .map(|_| {
                step *= 0.5;
                Setting::Step(step)
            })
            .collect()
    }

    /// Measures `method` from coarse to fine `settings` until a pass is predicted to exceed the limit; returns the
    /// skipped settings.
    pub fn sweep(
        &self,
        method: Method,
        settings: &[Setting],
        limits: Limits,
        report: &mut dyn FnMut(Measurement),
    ) -> Vec<Skipped> {
        let mut passes: Vec<f64> = Vec::new();
        for (done, setting) in settings.iter().enumerate() {
            let predicted = prediction(&passes);
            let pass = if predicted <= limits.limit { self.first_pass(method, *setting, limits) } else { None };
            let Some(pass) = pass else {
                let predicted = if predicted <= limits.limit { EXCESS * limits.limit } else { predicted };
                let skip = |setting: &Setting| Skipped { method, setting: *setting, predicted };
                return settings[done..].iter().map(skip).collect();
            };
            passes.push(pass.seconds);
            let (cpu, repeats) = self.timed(method, *setting, limits, pass.seconds);
            let runs = self.scenes.len();
            report(Measurement {
                method,
                setting: *setting,
                cpu,
                repeats,
                runs: [runs, pass.failed],
                steps: pass.steps as f64 / runs.max(1) as f64,
                rate: pass.rate.deviation(),
                attitude: pass.attitude.deviation(),
                energy: pass.energy.deviation(),
                momentum: pass.momentum.deviation(),
            });
        }
        Vec::new()
    }

    fn engine(&self, method: Method, setting: Setting) -> Option<Box<dyn Engine>> {
        let (tolerance, step) = match setting {
            Setting::Tolerance(tolerance) => (tolerance, None),
            // Gauss-Legendre iterates stages to this tolerance
            Setting::Step(step) => (f64::EPSILON, Some(step)),
        };
        let tolerance = Tolerance { relative: tolerance, absolute: tolerance };
        let control = Control { tolerance, step, max_steps: self.plan.max_steps };
        let nominal = self.scenes.first()?;
        Some(PropagationSettings::new(method, control, self.plan.grid.clone(), self.fields, nominal).engine(self.isa))
    }

    /// Every sample once; `None` if it takes too long.
    fn first_pass(&self, method: Method, setting: Setting, limits: Limits) -> Option<Pass> {
        let mut engine = self.engine(method, setting)?;
        let mut observer = Observer::new(self.request, &self.plan.grid);
        let max_and_rms = |group: Group, series: Series| {
            let place = |statistic| self.request.position(error_id(group, series, statistic));
            place(ErrorStatistic::Max).zip(place(ErrorStatistic::Rms))
        };
        let energy = max_and_rms(Group::EnergyConservation, Series::EnergyError)
            .or_else(|| max_and_rms(Group::EnergiesCom, Series::ComError));
        let momentum = max_and_rms(Group::MomentumConservation, Series::AngularMomentumError);
        let mut row = vec![f64::NAN; self.request.columns().len()];
        let mut pass = Pass::default();
        let start = thread_seconds();
        for first in (0..self.scenes.len()).step_by(WIDTH) {
            let chunk = &self.scenes[first..self.scenes.len().min(first + WIDTH)];
            engine.propagate(chunk, &mut |CompletedRun { index, table, outcome, .. }| {
                pass.steps += outcome.effort.steps;
                if outcome.status != Status::Done {
                    pass.failed += 1;
                    return;
                }
                observer.observe(self.isa, &chunk[index], table, outcome, &mut row);
                let points = outcome.points;
                for (sum, columns) in [(&mut pass.energy, energy), (&mut pass.momentum, momentum)] {
                    if let Some((max, rms)) = columns {
                        sum.add_many(row[max], row[rms], points);
                    }
                }
                let reference = &self.references[first + index];
                for error in rotation_errors(reference, &self.plan.grid, table) {
                    pass.rate.add(error.omega);
                    if reference.high.has(StateField::Attitude) {
                        pass.attitude.add(error.attitude);
                    }
                }
            });
            if thread_seconds() - start > EXCESS * limits.limit {
                return None;
            }
        }
        pass.seconds = thread_seconds() - start;
        Some(pass)
    }

    /// Median and minimum CPU time of a run, and number of repetitions.
    fn timed(&self, method: Method, setting: Setting, limits: Limits, pass: f64) -> ([f64; 2], usize) {
        let Some(mut engine) = self.engine(method, setting) else { return ([f64::NAN; 2], 0) };
        // batches of a campaign's size, unless the samples alone take long enough
        let count = if pass > SHORTEST { self.scenes.len() } else { self.scenes.len().next_multiple_of(BATCH) };
        let batch: Vec<Scene> = self.scenes.iter().cycle().take(count).cloned().collect();
        let expected = pass * count as f64 / self.scenes.len() as f64;
        let rounds = (SHORTEST / expected).ceil().clamp(1.0, 1e4) as usize;
        let affordable = (limits.limit / expected).floor().clamp(1.0, limits.repeats as f64) as usize;
        let mut sum = 0;
        let mut times: Vec<f64> = (0..affordable)
            .map(|_| {
                let start = thread_seconds();
                for _ in 0..rounds {
                    for part in batch.chunks(BATCH) {
                        engine.propagate(part, &mut |run| sum += run.outcome.points);
                    }
                }
                (thread_seconds() - start) / (rounds * count) as f64
            })
            .collect();
        std::hint::black_box(sum);
        times.sort_by(f64::total_cmp);
        ([times[times.len() / 2], times[0]], times.len())
    }
}

/// The predicted time of the next pass: growth as before (1.5 at first), at most threefold.
fn prediction(passes: &[f64]) -> f64 {
    match passes {
        [] => 0.0,
        [only] => 1.5 * only,
        [.., before, last] => last * (last / before).clamp(1.0, 3.0),
    }
}

#[derive(Default)]
struct Pass {
    seconds: f64,
    failed: usize,
    steps: u64,
    rate: Sum,
    attitude: Sum,
    energy: Sum,
    momentum: Sum,
}

#[derive(Default)]
struct Sum {
    max: f64,
    squares: f64,
    count: usize,
}

impl Sum {
    fn add(&mut self, error: f64) {
        self.add_many(error, error, 1);
    }

    fn add_many(&mut self, max: f64, rms: f64, count: usize) {
        self.max = if max.is_nan() || max > self.max { max } else { self.max };
        self.squares += rms * rms * count as f64;
        self.count += count;
    }

    fn deviation(&self) -> Option<Deviation> {
        (self.count > 0).then(|| Deviation { max: self.max, rms: (self.squares / self.count as f64).sqrt() })
    }
}
