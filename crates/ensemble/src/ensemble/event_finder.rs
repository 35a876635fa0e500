//! [`EventFinder`]: times and numbers of crossings.
//!
//! A crossing shows between two neighbouring observation points and is then located in repeated flights (`lookup`,
//! `crossing`); a run without one costs nothing. Time and count are null if the quantity is NaN at some point.
//!
//! A run with a [`RunEnd`] is flown again up to there: its row is that of a campaign of this duration, with the same
//! points and its end.

use crate::campaign::event::{Event, Which};
use crate::campaign::watched_quantity::parsed;
use crate::campaign::{Plan, event_columns};
use crate::ensemble::crossing::{Located, ROUNDING, Wanted, of_curve, of_steps};
use crate::ensemble::extreme_finder::ExtremeFinder;
use crate::ensemble::flights::{LawDraw, Means, ObservedRuns, Runs};
use crate::ensemble::lookup::{ERRORS, Lookup, Search, ticks};
use crate::ensemble::settings::Engines;
use crate::ensemble::sightings::{Place, Seen};
use crate::observables::band_series::event_series;
use crate::observables::{Observer, Request};
use crate::propagation::CompletedRun;
use crate::run::{Grid, Status};
use crate::scene::Scene;

/// Most ticks looked up between two points.
const MOST_TICKS: f64 = 64.0;
/// Shortest run over the campaign's duration: the order of errors of times.
const SHORTEST: f64 = 1e-12;

/// Time, NaN if it never happens; count, NaN if the quantity is NaN.
#[derive(Clone, Copy, Debug)]
struct Occurrence {
    time: f64,
    count: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Ends {
    Sought,
    Known(Option<RunEnd>),
}

/// Finds events, and extremes, which may begin with events.
pub struct EventFinder<'p> {
    plan: &'p Plan,
    lookup: Lookup<'p>,
    grid: Grid,
    ends: Ends,
    found: Vec<Occurrence>,
    pending: Vec<Search<Wanted>>,
    ended_by_law: Vec<bool>,
    extremes: ExtremeFinder<'p>,
}

impl<'p> EventFinder<'p> {
    pub fn new(plan: &'p Plan, grid: &Grid, engines: Engines) -> Option<Self> {
        if plan.events.is_empty() && plan.extremes.is_empty() {
            return None;
        }
        let series = event_series(&plan.request());
        let parsed = plan.events.iter().filter_map(|event| parsed(&event.quantity, &series));
        Some(EventFinder {
            plan,
            lookup: Lookup::new(plan, grid, engines, parsed),
            grid: grid.clone(),
            ends: Ends::Sought,
            found: Vec::new(),
            pending: Vec::new(),
            ended_by_law: Vec::new(),
            extremes: ExtremeFinder::new(plan, grid, engines),
        })
    }

    /// For runs ended by `end`, or by no event, at the end of their grid.
    pub fn ended_by(self, end: Option<RunEnd>) -> Self {
        EventFinder { ends: Ends::Known(end), ..self }
    }

    pub fn restart(&mut self, runs: usize) {
        let none = Occurrence { time: f64::NAN, count: 0.0 };
        self.found.clear();
        self.found.resize(runs * self.plan.events.len(), none);
        self.pending.clear();
        self.ended_by_law.clear();
        self.ended_by_law.resize(runs, false);
        self.extremes.restart(runs);
    }

    /// Looks at `run`, observed last by `observer`. True if an event ends it: then only its end is searched, which
    /// [`EventFinder::end`] gives after [`EventFinder::locate`]. A run may fail after its end.
    pub fn look(&mut self, run: &CompletedRun<'_>, observer: &Observer, status: Status) -> bool {
        let events = &self.plan.events;
        let values = self.lookup.read(observer, run.table);
        let seen = |index: usize| {
            let Event { value, direction, .. } = events[index];
            let rounding = |point| values.rounding(index, point) + ROUNDING * value.abs();
            Seen::of(values.all(index).map(|known| known - value), direction, rounding)
        };
        let of_run = run.index * events.len();
        let mut ends = Vec::new();
        let known_end = if let Ends::Known(end) = self.ends { end } else { None };
        if self.ends == Ends::Sought {
            ends.extend((0..events.len()).filter(|index| events[*index].ends_run && seen(*index).first.is_some()));
        }
        if let Some(end) = known_end {
            self.found[of_run + end.event] = Occurrence { time: end.time, count: 1.0 };
        }
        let is_ended = !ends.is_empty();
        let looked_at = if is_ended {
            ends
        } else if matches!(status, Status::Done | Status::Inaccurate) {
            (0..events.len()).filter(|index| known_end.is_none_or(|end| end.event != *index)).collect()
        } else {
            Vec::new()
        };
        for index in looked_at {
            let seen = seen(index);
            let found = &mut self.found[of_run + index];
            if !is_ended && seen.has_gap && values.undefined(index).next().is_some() {
                *found = Occurrence { time: f64::NAN, count: f64::NAN };
                continue;
            }
            if events[index].ends_run && !is_ended {
                continue;
            }
            found.count = f64::from(seen.count);
            let (place, is_last) = match events[index].which {
                Which::First => (seen.first, false),
                Which::Last => (seen.last, true),
                Which::Stays => (seen.stays, true),
            };
            let times = self.grid.times();
            match place {
                None => {}
                Some(Place::Point(point)) => found.time = times[point],
                Some(Place::Crossing { before, is_rising }) => self.pending.push(Search {
                    run: run.index,
                    quantity: index,
                    wanted: Wanted { is_rising, is_last },
                    between: [times[before], times[before + 1]],
                }),
            }
        }
        self.ended_by_law[run.index] = run.arcs.last().is_some_and(|arc| arc.applied.ends_run);
        if !is_ended && matches!(status, Status::Done | Status::Inaccurate) {
            self.extremes.look(run, observer);
        }
        is_ended
    }

    pub fn end(&self, run: usize) -> Option<RunEnd> {
        if self.ends != Ends::Sought {
            return None;
        }
        let events = self.plan.events.len();
        let of_run = self.found[run * events..(run + 1) * events].iter().zip(&self.plan.events).enumerate();
        let ends = of_run.filter(|(_, (found, event))| event.ends_run && !found.time.is_nan());
        let earliest = ends.min_by(|(_, (a, _)), (_, (b, _))| a.time.total_cmp(&b.time));
        earliest.map(|(event, (found, _))| RunEnd { event, time: found.time.max(SHORTEST * self.grid.duration()) })
    }

    pub fn locate(&mut self, runs: Runs<'_>) {
        let (events, lookup, found) = (&self.plan.events, &self.lookup, &mut self.found);
        let error = self.plan.tolerance.relative.clamp(ERRORS[0], ERRORS[1]) * self.grid.duration();
        let left = lookup.refine(std::mem::take(&mut self.pending), runs, MOST_TICKS, &mut |one, times, values| {
            let values: Vec<f64> = values.iter().map(|value| value - events[one.quantity].value).collect();
            let located = match lookup.period(one.quantity) {
                Some(period) => {
                    let is_next = |before: f64, after: f64| ticks(period, before, after, MOST_TICKS).len() <= 2;
                    of_steps(times, &values, one.wanted, is_next)
                }
                None => of_curve(times, &values, one.wanted, error),
            };
            match located {
                Located::At(time) => {
                    found[one.run * events.len() + one.quantity].time = time;
                    Vec::new()
                }
                Located::Between(start, end) => vec![[start, end]],
            }
        });
        // a jump, located to rounding
        for one in left {
            found[one.run * events.len() + one.quantity].time = one.between[1];
        }
        let found = &self.found;
        self.extremes.locate(runs, &|run, event| found[run * events.len() + event].time);
    }

    pub fn values(&self, run: usize) -> impl Iterator<Item = f64> + '_ {
        let events = &self.plan.events;
        let of_run = &self.found[run * events.len()..(run + 1) * events.len()];
        let before = |event: usize| events[..event].iter().filter(|event| event.ends_run).count();
        let others = 1 + usize::from(self.plan.law.is_some());
        let ended_by = match self.ends {
            Ends::Known(Some(end)) => others + before(end.event),
            _ => usize::from(self.ended_by_law[run]),
        };
        let ended_by = (before(events.len()) > 0).then_some(ended_by as f64);
        let of_events = of_run.iter().flat_map(|found| [found.time, found.count]);
        of_events.chain(ended_by).chain(self.extremes.values(run))
    }
}

/// Columns of events in a row of `request`, after those of failures.
pub fn places(plan: &Plan, request: &Request) -> std::ops::Range<usize> {
    let all = request.places_of_events();
    all.start + event_columns::EACH * plan.nominal.failures.len()..all.end
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunEnd {
    pub event: usize,
    /// s, positive.
    pub time: f64,
}

impl RunEnd {
    /// The points of `grid` before this end, and the end; and how many are points of `grid`.
    pub fn grid(self, grid: &Grid) -> (Grid, usize) {
        let before = grid.times().partition_point(|time| *time < self.time);
        let is_point = grid.times().get(before) == Some(&self.time);
        let times = grid.times()[..before].iter().copied().chain([self.time]).collect();
        (Grid::at(times), before + usize::from(is_point))
    }
}

/// Finds ends of runs as the campaign does.
pub struct EndFinder<'p> {
    runs: ObservedRuns<'p>,
    events: EventFinder<'p>,
}

impl<'p> EndFinder<'p> {
    /// `None` if no event ends runs.
    pub fn new(plan: &'p Plan, engines: Engines) -> Option<Self> {
        if !plan.events.iter().any(|event| event.ends_run) {
            return None;
        }
        let runs = Means::new(plan, engines).runs(&plan.grid);
        Some(EndFinder { runs, events: EventFinder::new(plan, &plan.grid, engines)? })
    }

    pub fn end(&mut self, scene: &Scene, draw: &[LawDraw]) -> Option<RunEnd> {
        let EndFinder { runs, events } = self;
        let one = Runs::one(scene, draw);
        events.restart(1);
        let mut is_ended = false;
        runs.fly(one, &mut |seen| is_ended = events.look(&seen.run, seen.observer, seen.status));
        if !is_ended {
            return None;
        }
        events.locate(one);
        events.end(0)
    }
}
