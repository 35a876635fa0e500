//! [`measured`]: what the control loop of a plan does to the errors of its runs, by pilots
//! ([`crate::observables::loop_error`]).
//!
//! Pilots are the nominal sample, which is judged by itself, and the first drawn samples, which judge all others. They
//! depend on the plan alone, not on its number of rows. A pilot and its twin share noise, filter, limits and ticks, but
//! no step: the twin's arcs are halved and its tolerance is a thousandth.

use crate::campaign::{Plan, Requirement, SceneDraws};
use crate::ensemble::event_finder::{self, EventFinder, RunEnd};
use crate::ensemble::flights::{LawDraw, Means, Runs, end_of, nominal_attitude};
use crate::ensemble::loop_errors::LoopErrors;
use crate::ensemble::run_cost::has_callback;
use crate::ensemble::settings::Engines;
use crate::ensemble::supervision::Crew;
use crate::ensemble::threads::unpoisoned;
use crate::math::Isa;
use crate::observables::loop_error::{LoopError, Pilot};
use crate::observables::nominal_attitude::NominalAttitude;
use crate::observables::window::NO_WINDOWS;
use crate::observables::{Groups, Request};
use crate::ode::Tolerance;
use crate::propagation::{RotationError, rotation_difference};
use crate::run::{Grid, LocalErrors, StateField, StateFields, StateTable, Status, points_to, rate_scale_of};
use crate::sampling::SampleId;
use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of drawn pilots: with the nominal sample they fill the lanes.
const DRAWN: u64 = 7;

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
pub struct Flown {
    pub table: StateTable,
    pub filled: usize,
    pub status: Status,
    pub local: LocalErrors,
    /// Its row without columns of a nominal run, if observed.
    pub row: Vec<f64>,
}

impl Flown {
    /// The error of this run against `truth`; infinite if they end differently.
    pub fn error(&self, truth: &Flown, times: &[f64]) -> RotationError {
        let filled = self.filled.min(truth.filled);
        if self.status != truth.status || self.filled.abs_diff(truth.filled) > 1 || filled == 0 {
            return RotationError { omega: f64::INFINITY, attitude: f64::INFINITY };
        }
        rotation_difference(&truth.table, &self.table, times, filled)
    }

    /// A run that reached its end, and its twin.
    fn pilot(&self, twin: &Flown, grid: &Grid) -> Option<Pilot> {
        let made = || self.local.total(rate_scale_of(&self.table, grid.times(), self.filled));
        let is_whole = self.status == Status::Done && self.filled > 0;
        is_whole.then(|| Pilot { error: self.error(twin, grid.times()).state(), made: made() })
    }
}

/// For the nominal sample, and for all others, where `wanted`; none without a law. A callback is asked by `crew`.
pub fn measured(plan: &Plan, isa: Isa, wanted: [bool; 2], crew: &dyn Crew) -> LoopErrors {
    if plan.law.is_none() || wanted == [false; 2] {
        return LoopErrors::default();
    }
    let finer = TWIN.plan(plan);
    let of_drawn = 1..if wanted[1] { DRAWN + 1 } else { 1 };
    let samples = wanted[0].then_some(0).into_iter().chain(of_drawn).map(SampleId);
    let (mut scenes, mut draws, mut source) = (Vec::new(), Vec::new(), SceneDraws::new(plan));
    for sample in samples {
        // a list has what it has, and some draws are not physical
        let Ok(scene) = source.scene(sample) else { continue };
        scenes.push(scene);
        draws.extend(LawDraw::of(plan, sample, source.drawn()));
    }
    // the limit of steps of the campaign's runs is no limit of what is known of them
    let patient = Plan { max_steps: plan.max_steps.saturating_mul(PATIENCE), ..plan.clone() };
    let plans = [(&patient, 1), (&finer, TWIN.parts)];
    // as in a campaign, a panic ends one run only
    let fly = |(plan, parts): (&Plan, u32), which: Range<usize>| {
        let runs = Runs { scenes: &scenes[which.clone()], draws: &draws[which] };
        catch_unwind(AssertUnwindSafe(|| outcomes(plan, parts, isa, runs, &Wanted::nothing(plan)))).ok()
    };
    let together = || {
        let [own, twins] = plans.map(|plan| fly(plan, 0..scenes.len()));
        Some(own?.into_iter().zip(twins?).map(Some).collect())
    };
    let apart = || {
        let (next, found) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
        crew.work(&|| {
            while let flight = next.fetch_add(1, Ordering::Relaxed)
                && flight < 2 * scenes.len()
            {
                let flown = fly(plans[flight % 2], flight / 2..flight / 2 + 1);
                unpoisoned(found.lock()).insert(flight, flown.and_then(|mut flown| flown.pop()));
            }
        });
        let mut found = unpoisoned(found.into_inner()).into_values();
        std::iter::from_fn(|| Some(found.next()?.zip(found.next()?))).collect()
    };
    // runs of a callback take turns, and lanes would ask it one by one
    let together = if has_callback(plan) { None } else { together() };
    let pairs: Vec<Option<(Flown, Flown)>> = together.unwrap_or_else(apart);
    let nominals = draws.iter().take_while(|draw| draw.sample == SampleId(0)).count();
    let of = |which: Range<usize>| {
        let pilots = pairs[which.clone()].iter().flatten();
        let mut found = LoopError::of_pilots(pilots.filter_map(|(own, twin)| own.pilot(twin, &plan.grid)));
        if found.parts {
            let runs = Runs { scenes: &scenes[which.clone()], draws: &draws[which] };
            found.outcomes_agree = catch_unwind(AssertUnwindSafe(|| outcomes_agree(plans, isa, runs))).unwrap_or(false);
        }
        found
    };
    LoopErrors { nominal: wanted[0].then(|| of(0..nominals)), drawn: wanted[1].then(|| of(nominals..scenes.len())) }
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
        let filled = seen.run.outcome.points.min(points_to(grid.times(), end_of(&seen.run)));
        let (status, local) = (seen.run.outcome.status, seen.run.outcome.local_errors);
        let (table, row) = (seen.run.table.clone(), seen.row.to_vec());
        found[seen.run.index] = Some(Flown { table, filled, status, local, row });
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
