//! [`measured`]: what the control loop of a plan does to the errors of its runs, by pilots
//! ([`crate::observables::loop_error`]).
//!
//! Pilots are the nominal sample, which is judged by itself, and the first drawn samples, which judge all others. They
//! depend on the plan alone, not on its number of rows. A pilot and its twin share noise, filter, limits and ticks, but
//! no step.

use crate::campaign::{Plan, Requirement, SceneDraws};
use crate::ensemble::event_finder::{self, EventFinder, RunEnd};
use crate::ensemble::flights::{Judge, LawDraw, Means, Runs, end_of, nominal_attitude};
use crate::ensemble::loop_errors::LoopErrors;
use crate::ensemble::settings::{Engines, FIRST_DRAWN};
use crate::ensemble::supervision::{Alone, Crew};
use crate::ensemble::threads::unpoisoned;
use crate::loops::callback::is_law_of;
use crate::math::Isa;
use crate::observables::loop_error::{LoopError, Pilot};
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::window::NO_WINDOWS;
use crate::observables::{Group, Groups, Request};
use crate::ode::Tolerance;
use crate::propagation::{CompletedRun, RotationError, rotation_difference};
use crate::run::{Grid, LocalErrors, StateField, StateFields, StateTable, Status, points_to, rate_scale_of};
use crate::sampling::SampleId;
use crate::scene::Scene;
use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Steps of a pilot over those of a run, at most.
const PATIENCE: u64 = 4;

/// How much finer a loop is integrated than in its campaign.
#[derive(Clone, Copy, Debug)]
pub struct Finer {
    /// Parts of each arc.
    pub parts: u32,
    /// Factor on the tolerance.
    tolerance: f64,
    /// Factor on the step of fixed-step methods.
    step: f64,
}

pub const TWIN: Finer = Finer { parts: 2, tolerance: 1e-3, step: 0.25 };
pub const TRUTH: Finer = Finer { parts: 3, tolerance: 1e-5, step: 0.125 };

/// Smallest tolerance of the finer runs: rounding rejects steps below.
const LEAST: f64 = 1e-15;

impl Finer {
    pub fn plan(self, plan: &Plan) -> Plan {
        let Tolerance { relative, absolute } = plan.tolerance;
        let factor = (relative * self.tolerance).max(LEAST).min(relative) / relative;
        let tolerance = Tolerance { relative: relative * factor, absolute: absolute * factor };
        let max_steps = plan.max_steps.saturating_mul(64);
        Plan { tolerance, step_s: plan.step_s.map(|step| step * self.step), max_steps, ..plan.clone() }
    }
}

/// A run with the states that are compared.
#[derive(Clone, Debug)]
pub struct Flown {
    pub table: StateTable,
    pub filled: usize,
    pub status: Status,
    pub local: LocalErrors,
    /// Its row without columns of a nominal run, if observed.
    pub row: Vec<f64>,
}

impl Flown {
    pub fn of(run: &CompletedRun<'_>, row: &[f64], grid: &Grid) -> Self {
        Flown {
            table: run.table.clone(),
            filled: run.outcome.points.min(points_to(grid.times(), end_of(run))),
            status: run.outcome.status,
            local: run.outcome.local_errors,
            row: row.to_vec(),
        }
    }

    /// The error of this run against `truth`; infinite if they end differently.
    pub fn error(&self, truth: &Flown, times: &[f64]) -> RotationError {
        let filled = self.filled.min(truth.filled);
        if self.status != truth.status || self.filled.abs_diff(truth.filled) > 1 || filled == 0 {
            return RotationError { omega: f64::INFINITY, attitude: f64::INFINITY };
        }
        rotation_difference(&truth.table, &self.table, times, filled)
    }

    /// A run that reached its end, and its twin.
    fn pilot(&self, twin: &Flown, times: &[f64]) -> Option<Pilot> {
        let made = || self.local.inherited(rate_scale_of(&self.table, times, self.filled));
        let is_whole = self.status == Status::Done && self.filled > 0;
        is_whole.then(|| Pilot { error: self.error(twin, times).state(), made: made() })
    }
}

/// For the nominal sample, and for all others, where `wanted`; none without a law. A callback is asked by `crew`.
pub fn measured(plan: &Plan, isa: Isa, wanted: [bool; 2], crew: &dyn Crew) -> LoopErrors {
    let of = |samples| Pilots::of(plan, isa, samples, crew).error(None);
    let [nominal, drawn] = wanted.map(|wanted| wanted && plan.law.is_some());
    LoopErrors { nominal: nominal.then(|| of(0..=0)), drawn: drawn.then(|| of(1..=FIRST_DRAWN)) }
}

/// Samples with their twins.
pub struct Pilots<'p> {
    plan: &'p Plan,
    isa: Isa,
    crew: &'p dyn Crew,
    patient: Plan,
    finer: Plan,
    scenes: Vec<Scene>,
    draws: Vec<LawDraw>,
    twins: Vec<Option<Flown>>,
}

impl<'p> Pilots<'p> {
    /// For the nominal sample, which is compared as it is flown; `None` where no column estimates the error of a loop.
    pub fn of_nominal(plan: &'p Plan, isa: Isa) -> Option<Self> {
        let is_judged = plan.law.is_some() && plan.request().groups.contains(Group::Numerics);
        is_judged.then(|| Self::of(plan, isa, 0..=0, &Alone))
    }

    fn of(plan: &'p Plan, isa: Isa, samples: RangeInclusive<u64>, crew: &'p dyn Crew) -> Self {
        let (mut scenes, mut draws, mut source) = (Vec::new(), Vec::new(), SceneDraws::new(plan));
        for sample in samples.map(SampleId) {
            // a list has what it has, and some draws are not physical
            let Ok(scene) = source.scene(sample) else { continue };
            scenes.push(scene);
            draws.extend(LawDraw::of(plan, sample, source.drawn()));
        }
        // the limit of steps of the campaign's runs is no limit of what is known of them
        let patient = Plan { max_steps: plan.max_steps.saturating_mul(PATIENCE), ..plan.clone() };
        let mut pilots = Pilots { plan, isa, crew, patient, finer: TWIN.plan(plan), scenes, draws, twins: Vec::new() };
        pilots.twins = pilots.fly(pilots.plans()[1]);
        pilots
    }

    /// The judge of the nominal run, as it is flown at the campaign's points.
    pub fn judge(self) -> Judge<'p> {
        Box::new(move |run| self.error(Some(Flown::of(run, &[], &self.plan.grid))))
    }

    /// The plans of a pilot and of its twin, with the parts of their arcs.
    fn plans(&self) -> [(&Plan, u32); 2] {
        [(&self.patient, 1), (&self.finer, TWIN.parts)]
    }

    fn runs(&self, pilots: Range<usize>) -> Runs<'_> {
        Runs { scenes: &self.scenes[pilots.clone()], draws: &self.draws[pilots] }
    }

    fn fly(&self, (plan, parts): (&Plan, u32)) -> Vec<Option<Flown>> {
        let fly = |runs| {
            catch_unwind(AssertUnwindSafe(|| outcomes(plan, parts, self.isa, runs, &Wanted::nothing(plan)))).ok()
        };
        let pilots = self.scenes.len();
        // runs of a callback take turns, and lanes would ask it one by one
        let is_callback = self.plan.loop_spec().is_some_and(is_law_of);
        if let Some(all) = (!is_callback).then(|| fly(self.runs(0..pilots))).flatten() {
            return all.into_iter().map(Some).collect();
        }
        // as in a campaign, a panic ends one run only
        let alone = |pilot| fly(self.runs(pilot..pilot + 1))?.pop();
        let (next, found) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
        self.crew.work(&|| {
            while let pilot = next.fetch_add(1, Ordering::Relaxed)
                && pilot < pilots
            {
                let flown = alone(pilot);
                unpoisoned(found.lock()).insert(pilot, flown);
            }
        });
        unpoisoned(found.into_inner()).into_values().collect()
    }

    /// What the loop does to the errors of the pilots, the only one of which may be `flown` at the campaign's points.
    pub fn error(&self, flown: Option<Flown>) -> LoopError {
        let own = match flown.filter(|run| run.status != Status::StepLimit) {
            Some(run) => vec![Some(run)],
            None => self.fly(self.plans()[0]),
        };
        let pairs = own.iter().zip(&self.twins).filter_map(|(own, twin)| own.as_ref().zip(twin.as_ref()));
        let mut found = LoopError::of_pilots(pairs.filter_map(|(own, twin)| own.pilot(twin, self.plan.grid.times())));
        if found.parts {
            let agree = || outcomes_agree(self.plans(), self.isa, self.runs(0..self.scenes.len()));
            found.outcomes_agree = catch_unwind(AssertUnwindSafe(agree)).unwrap_or(false);
        }
        found
    }
}

/// Largest difference of equal outcomes, as a share of the largest value among the pilots: below the digits that are
/// printed.
const EQUAL: f64 = 1e-3;

/// True if `runs` of both plans meet the same requirements and have equal values of all else that the file lists or
/// locates in time; without any of these, of all columns of the law.
fn outcomes_agree(plans: [(&Plan, u32); 2], isa: Isa, runs: Runs<'_>) -> bool {
    let (plan, _) = plans[0];
    let request = plan.request();
    let [own, twins] =
        plans.map(|(plan, parts)| outcomes(plan, parts, isa, runs, &Wanted::of(plan, request, &plan.grid, isa)));
    let columns = request.columns();
    let pairs = |place: usize| own.iter().zip(&twins).map(move |(own, twin)| [own.row[place], twin.row[place]]);
    let are_equal = |place: usize| {
        let finite = pairs(place).flatten().filter(|value| value.is_finite());
        let largest = finite.fold(0.0, |most: f64, value| most.max(value.abs()));
        pairs(place).all(|[own, twin]| (own - twin).abs() <= EQUAL * largest || own.is_nan() && twin.is_nan())
    };
    // what no column of a run has is not proved
    let at = |name: &str| columns.iter().position(|column| column.quantity.name() == name);
    let meets_alike = |one: &Requirement| {
        let is_met = |place: usize| pairs(place).all(|pair| one.limit.is_met(pair[0]) == one.limit.is_met(pair[1]));
        let of_runs = one.of_runs().and_then(at).is_some_and(is_met);
        of_runs || one.observable().and_then(at).is_some_and(are_equal)
    };
    let (required, listed) = (&plan.analysis.requirements, &plan.analysis.summary_columns);
    let events = request.places_of_events();
    if required.is_empty() && listed.is_empty() && events.is_empty() {
        return request.places_of_law().all(are_equal);
    }
    let mut listed = listed.iter().map(|name| at(name));
    required.iter().all(meets_alike) && listed.all(|place| place.is_some_and(are_equal)) && { events }.all(are_equal)
}

/// The states that are compared.
pub fn compared(request: &Request) -> StateFields {
    let spacecraft = StateFields::NONE.with(StateField::Rate).with(StateField::Attitude);
    if request.debris { spacecraft.with(StateField::DebrisRate).with(StateField::DebrisAttitude) } else { spacecraft }
}

/// What is observed of runs that are compared.
pub struct Wanted<'a> {
    pub request: Request,
    pub grid: &'a Grid,
    pub end: Option<RunEnd>,
    pub nominal: Option<NominalAttitude>,
    pub errors: LoopErrors,
}

impl<'a> Wanted<'a> {
    /// States alone.
    fn nothing(plan: &'a Plan) -> Self {
        let request = Request { groups: Groups::NONE, windows: NO_WINDOWS, debris: false, ..plan.request() };
        Wanted { request, grid: &plan.grid, end: None, nominal: None, errors: LoopErrors::default() }
    }

    fn of(plan: &Plan, request: Request, grid: &'a Grid, isa: Isa) -> Self {
        let nominal = nominal_attitude(plan, &request, grid, isa);
        Wanted { request, grid, end: None, nominal, errors: LoopErrors::default() }
    }
}

/// `runs` of `plan` with the arcs of their laws in `parts`, with rows: columns of law and events included.
pub fn outcomes(plan: &Plan, parts: u32, isa: Isa, runs: Runs<'_>, wanted: &Wanted<'_>) -> Vec<Flown> {
    let Wanted { request, grid, end, nominal, errors } = wanted;
    let means = Means { request: *request, ..Means::new(plan, Engines::of(isa)) };
    let mut observed =
        means.runs_with(grid, compared(request).union(request.fields()), nominal.clone()).judged(*errors);
    observed.flights = observed.flights.divided(parts);
    let is_observed = request.groups != Groups::NONE;
    let events = if is_observed { EventFinder::new(plan, grid, means.engines) } else { None };
    let mut events = events.map(|events| events.ended_by(*end));
    if let Some(events) = &mut events {
        events.restart(runs.scenes.len());
    }
    let mut found: Vec<Option<Flown>> = runs.scenes.iter().map(|_| None).collect();
    observed.fly(runs, &mut |seen| {
        if let Some(events) = &mut events {
            events.look(&seen.run, seen.observer, seen.status);
        }
        found[seen.run.index] = Some(Flown::of(&seen.run, seen.row, grid));
    });
    let mut found: Vec<Flown> = found.into_iter().flatten().collect();
    if let Some(events) = &mut events {
        events.locate(runs);
    }
    for (run, flown) in found.iter_mut().enumerate().filter(|(_, flown)| flown.status == Status::Done) {
        observed.flights.report(run, &mut flown.row[request.places_of_law()]);
        if let Some(events) = &events {
            let places = event_finder::places(plan, request);
            flown.row[places].iter_mut().zip(events.values(run)).for_each(|(place, value)| *place = value);
        }
    }
    found
}
