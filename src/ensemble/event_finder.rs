//! [`EventFinder`]: the times at which quantities of runs cross values, and how often.
//!
//! A crossing shows in the values of a run at two neighbouring observation points. Where its time is asked for, the same sample is flown again, with
//! observation points between these two (`crossing`): what is observed does not change how a run is integrated, so that this works for every
//! engine, effect and control loop, and a run without a crossing costs nothing. Runs are flown again in lanes, a few at a time, since each brings its
//! own observation points.

use crate::campaign::event::{Event, Which};
use crate::campaign::{Plan, event_columns};
use crate::ensemble::crossing::{Found, Wanted, nodes, of_curve, of_steps};
use crate::ensemble::flights::{Flights, LawDraw, nominal_attitude, observe};
use crate::ensemble::run_end::RunEnd;
use crate::ensemble::settings::{EngineMaker, propagator};
use crate::ensemble::sightings::{Place, Seen};
use crate::math::Isa;
use crate::observables::band_reader::BandReader;
use crate::observables::band_series::{BandSeries, event_series};
use crate::observables::window::NO_WINDOWS;
use crate::observables::{Group, Groups, Observer, Request};
use crate::propagation::CompletedRun;
use crate::run::{Grid, StateFields, Status};
use crate::sampling::expression::Expression;
use crate::scene::Scene;

/// Runs that are flown again together: one of each lane.
const TOGETHER: usize = 8;
/// Most points that are looked at between two others of a quantity that changes at the ticks of a loop.
const MOST_TICKS: f64 = 64.0;
/// How often a run is flown again at most: a jump between two points an hour apart is then located to 1e-12 s.
const MOST_FLIGHTS: usize = 24;
/// Errors of the time of a crossing over the duration of a run: that of the integration, but within these limits.
const ERRORS: [f64; 2] = [1e-13, 1e-9];
/// The shortest run that an event ends, over the duration of the campaign: of the order of the errors of times.
const SHORTEST: f64 = 1e-12;

/// An event, ready to be looked for.
struct Watched {
    event: Event,
    expression: Expression,
    /// The variables of the expression, by their places among those that are read.
    variables: Vec<usize>,
    /// Whether they change at the ticks of a control loop alone.
    changes_at_ticks: bool,
}

/// What is known of an event in a run.
#[derive(Clone, Copy, Debug)]
struct Occurrence {
    time: f64,
    count: u32,
}

/// What is known of the events that end runs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ends {
    /// Nothing yet: they are looked for.
    Sought,
    /// Which one ends each run, where one does.
    Known(Option<RunEnd>),
}

/// A crossing to be located: the event `event` of the run `run`.
#[derive(Clone, Debug)]
struct Pending {
    run: usize,
    event: usize,
    wanted: Wanted,
    /// Times before and after it, s.
    between: [f64; 2],
    nodes: Vec<f64>,
}

/// Finds the events of the runs of a plan.
pub struct EventFinder<'p> {
    plan: &'p Plan,
    isa: Isa,
    own_engines: Option<EngineMaker>,
    fields: StateFields,
    watched: Vec<Watched>,
    sources: Vec<BandSeries>,
    /// What is observed where a crossing is located: no more than these quantities.
    request: Request,
    reader: BandReader,
    grid: Grid,
    ends: Ends,
    /// Run by run, event by event.
    found: Vec<Occurrence>,
    pending: Vec<Pending>,
    /// Run by run, whether its law has ended it.
    ended_by_law: Vec<bool>,
}

impl<'p> EventFinder<'p> {
    /// Of the events of `plan` in runs that are observed on `grid`; `None` where it has none.
    pub fn new(plan: &'p Plan, grid: &Grid, (isa, own_engines): (Isa, Option<EngineMaker>)) -> Option<Self> {
        if plan.events.is_empty() {
            return None;
        }
        let request = plan.request();
        let series = event_series(&request);
        let mut sources: Vec<BandSeries> = Vec::new();
        let watched = plan.events.iter().filter_map(|event| {
            let (expression, variables) = event.parsed(&series)?;
            let changes_at_ticks = variables.iter().all(BandSeries::changes_at_ticks);
            let mut place = |band: BandSeries| {
                sources.iter().position(|known| *known == band).unwrap_or_else(|| {
                    sources.push(band);
                    sources.len() - 1
                })
            };
            let variables = variables.into_iter().map(&mut place).collect();
            Some(Watched { event: event.clone(), expression, variables, changes_at_ticks })
        });
        let watched = watched.collect();
        Some(EventFinder {
            plan,
            isa,
            own_engines,
            fields: request.fields(),
            watched,
            request: narrowed(request, &sources),
            reader: BandReader::new(sources.clone(), (0..grid.points()).collect()),
            sources,
            grid: grid.clone(),
            ends: Ends::Sought,
            found: Vec::new(),
            pending: Vec::new(),
            ended_by_law: Vec::new(),
        })
    }

    /// The same of runs that `end` ends where their grid does, or no event.
    pub fn ended_by(self, end: Option<RunEnd>) -> Self {
        EventFinder { ends: Ends::Known(end), ..self }
    }

    /// Forgets all runs; `runs` come.
    pub fn restart(&mut self, runs: usize) {
        let none = Occurrence { time: f64::NAN, count: 0 };
        self.found.clear();
        self.found.resize(runs * self.watched.len(), none);
        self.pending.clear();
        self.ended_by_law.clear();
        self.ended_by_law.resize(runs, false);
    }

    /// Looks at `run`, which `observer` has observed last with `status`. Returns whether an event ends it: then nothing else is looked for in it, and
    /// [`EventFinder::end`] knows when, after [`EventFinder::locate`]. A run that fails may do so after its end.
    pub fn look(&mut self, run: &CompletedRun<'_>, observer: &Observer, status: Status) -> bool {
        let (points, events) = (self.grid.points(), self.watched.len());
        let kept = self.reader.kept(observer, run.table, points);
        let seen = |watched: &Watched| {
            let values = (0..points).map(|point| watched.value(&self.sources, kept, points, point));
            Seen::of(values, watched.event.direction)
        };
        let of_run = run.index * events;
        let mut ends = Vec::new();
        match self.ends {
            Ends::Sought => ends.extend((0..events).filter(|index| {
                let watched = &self.watched[*index];
                watched.event.ends_run && seen(watched).first.is_some()
            })),
            Ends::Known(None) => {}
            Ends::Known(Some(end)) => self.found[of_run + end.event] = Occurrence { time: end.time, count: 1 },
        }
        let is_ended = !ends.is_empty();
        let looked_at = if is_ended {
            ends
        } else if matches!(status, Status::Done | Status::Inaccurate) {
            (0..events).filter(|index| !self.watched[*index].event.ends_run).collect()
        } else {
            Vec::new()
        };
        for index in looked_at {
            let watched = &self.watched[index];
            let seen = seen(watched);
            let found = &mut self.found[of_run + index];
            found.count = seen.count;
            let (place, is_last) = match watched.event.which {
                Which::First => (seen.first, false),
                Which::Last => (seen.last, true),
                Which::Stays => (seen.stays, true),
            };
            let times = self.grid.times();
            match place {
                None => {}
                Some(Place::Point(point)) => found.time = times[point],
                Some(Place::Crossing { before, is_rising }) => self.pending.push(Pending {
                    run: run.index,
                    event: index,
                    wanted: Wanted { is_rising, is_last },
                    between: [times[before], times[before + 1]],
                    nodes: Vec::new(),
                }),
            }
        }
        self.ended_by_law[run.index] = run.arcs.last().is_some_and(|arc| arc.applied.ends_run);
        is_ended
    }

    /// What ends run `run`: the first of the events that do.
    pub fn end(&self, run: usize) -> Option<RunEnd> {
        if self.ends != Ends::Sought {
            return None;
        }
        let events = self.watched.len();
        let of_run = self.found[run * events..(run + 1) * events].iter().zip(&self.watched).enumerate();
        let ends = of_run.filter(|(_, (found, watched))| watched.event.ends_run && !found.time.is_nan());
        let earliest = ends.min_by(|(_, (a, _)), (_, (b, _))| a.time.total_cmp(&b.time));
        earliest.map(|(event, (found, _))| RunEnd { event, time: found.time.max(SHORTEST * self.grid.duration()) })
    }

    /// Locates the crossings of the runs that were looked at: those of `scenes`, with the draws of their laws.
    pub fn locate(&mut self, scenes: &[Scene], draws: &[LawDraw]) {
        for _ in 0..MOST_FLIGHTS {
            if self.pending.is_empty() {
                return;
            }
            let mut left = std::mem::take(&mut self.pending);
            left.sort_by_key(|pending| (pending.run, pending.event));
            while !left.is_empty() {
                let mut runs: Vec<usize> = left.iter().map(|pending| pending.run).collect();
                runs.dedup();
                runs.truncate(TOGETHER);
                let after = left.partition_point(|pending| runs.last().is_some_and(|last| pending.run <= *last));
                let rest = left.split_off(after);
                self.fly_again(&runs, left, (scenes, draws));
                left = rest;
            }
        }
        // a jump, as near as numbers are
        for pending in std::mem::take(&mut self.pending) {
            self.found[pending.run * self.watched.len() + pending.event].time = pending.between[1];
        }
    }

    /// The values of the columns of the events of run `run`.
    pub fn values(&self, run: usize) -> impl Iterator<Item = f64> + '_ {
        let events = self.watched.len();
        let of_run = &self.found[run * events..(run + 1) * events];
        let ends: Vec<usize> = (0..events).filter(|index| self.watched[*index].event.ends_run).collect();
        let others = 1 + usize::from(self.plan.law.is_some());
        let ended_by = match self.ends {
            Ends::Known(Some(end)) => others + ends.iter().take_while(|index| **index < end.event).count(),
            _ => usize::from(self.ended_by_law[run]),
        };
        let ended_by = (!ends.is_empty()).then_some(ended_by as f64);
        of_run.iter().flat_map(|found| [found.time, f64::from(found.count)]).chain(ended_by)
    }

    /// Flies the runs `runs` again, with points where `pending` look.
    fn fly_again(&mut self, runs: &[usize], mut pending: Vec<Pending>, (scenes, draws): (&[Scene], &[LawDraw])) {
        let mut times = vec![0.0, self.grid.duration()];
        for one in &mut pending {
            one.nodes = self.nodes(one);
            times.extend(&one.nodes);
        }
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        let grid = Grid::at(times);
        let settings = propagator(self.plan, grid.clone(), self.fields);
        let engine = match self.own_engines {
            Some(new_engine) => new_engine(&settings, self.isa),
            None => settings.engine(self.isa),
        };
        let mut flights = Flights::new(self.plan, engine, &grid);
        let is_compared = self.sources.iter().any(BandSeries::is_from_nominal);
        let nominal = is_compared.then(|| nominal_attitude(self.plan, &self.request, &grid, self.isa)).flatten();
        let mut observer = Observer::new(self.request, &grid).with_nominal(nominal);
        let mut reader = BandReader::new(self.sources.clone(), (0..grid.points()).collect());
        let mut ignored = vec![f64::NAN; self.request.columns().len()];
        let scenes: Vec<Scene> = runs.iter().map(|run| scenes[*run].clone()).collect();
        let draws: Vec<LawDraw> =
            if draws.is_empty() { Vec::new() } else { runs.iter().map(|run| draws[*run].clone()).collect() };
        let (plan, isa, points) = (self.plan, self.isa, grid.points());
        let (watched, sources, found) = (&self.watched, &self.sources, &mut self.found);
        let (again, duration) = (&mut self.pending, self.grid.duration());
        flights.fly(&scenes, &draws, &mut |run, of_law| {
            observe(plan, &mut observer, isa, &scenes[run.index], (&run, of_law), &mut ignored);
            let kept = reader.kept(&observer, run.table, points);
            for one in pending.iter().filter(|one| one.run == runs[run.index]) {
                let watched_one = &watched[one.event];
                let point = |time: &f64| grid.times().partition_point(|other| other < time);
                let value = |time: &f64| watched_one.value(sources, kept, points, point(time));
                let values: Vec<f64> = one.nodes.iter().map(value).collect();
                match watched_one.located(one, &values, (plan, duration)) {
                    Found::At(time) => found[one.run * watched.len() + one.event].time = time,
                    Found::Between(start, end) => again.push(Pending { between: [start, end], ..one.clone() }),
                }
            }
        });
    }

    /// Where to look between the times of `pending`.
    fn nodes(&self, pending: &Pending) -> Vec<f64> {
        let [start, end] = pending.between;
        match period(self.plan).filter(|_| self.watched[pending.event].changes_at_ticks) {
            Some(period) => ticks(period, start, end),
            None => nodes(start, end).collect(),
        }
    }
}

/// The period of the control loop of `plan`, s.
fn period(plan: &Plan) -> Option<f64> {
    plan.law.as_ref()?.spec().map(|spec| spec.period)
}

/// `start` and `end`, and the ticks of a loop between them; of many some that are evenly distributed.
fn ticks(period: f64, start: f64, end: f64) -> Vec<f64> {
    let [first, last] = [(start / period).floor() + 1.0, (end / period).ceil() - 1.0];
    let count = (last - first + 1.0).max(0.0);
    let every = (count / MOST_TICKS).ceil().max(1.0);
    let mut times = vec![start];
    let mut tick = first;
    while tick <= last {
        times.push(tick * period);
        tick += every;
    }
    times.push(end);
    times.retain(|time| (start..=end).contains(time));
    times.dedup();
    times
}

/// What of `request` the quantities `sources` need.
fn narrowed(mut request: Request, sources: &[BandSeries]) -> Request {
    request.windows = NO_WINDOWS;
    let all = request.groups;
    let mut missing: Vec<&BandSeries> = sources.iter().collect();
    let mut groups = Groups::NONE;
    for group in Group::ALL.into_iter().filter(|group| all.contains(*group)) {
        request.groups = Groups::NONE.with(group);
        let known = event_series(&request);
        let before = missing.len();
        missing.retain(|source| !known.contains(source));
        if missing.len() < before {
            groups = groups.with(group);
        }
    }
    request.groups = if missing.is_empty() { groups } else { all };
    request
}

impl Watched {
    /// What the quantity is beyond the value, at point `point` of `points` of a run of which `kept` was read.
    fn value(&self, sources: &[BandSeries], kept: &[f64], points: usize, point: usize) -> f64 {
        let of = |variable: usize| {
            let place = self.variables[variable];
            sources[place].form.shown(kept[place * points + point])
        };
        self.expression.value(of) - self.event.value
    }

    /// The crossing `pending`, where the quantity has `values` beyond the value at its nodes, in a run of `duration` seconds.
    fn located(&self, pending: &Pending, values: &[f64], (plan, duration): (&Plan, f64)) -> Found {
        let Pending { nodes, wanted, .. } = pending;
        match period(plan).filter(|_| self.changes_at_ticks) {
            Some(period) => of_steps(nodes, values, *wanted, |before, after| ticks(period, before, after).len() <= 2),
            None => {
                let error = plan.tolerance.relative.clamp(ERRORS[0], ERRORS[1]);
                of_curve(nodes, values, *wanted, error * duration)
            }
        }
    }
}

/// The places of the columns of events in a row of `request`: those of failures are before them.
pub fn places(plan: &Plan, request: &Request) -> std::ops::Range<usize> {
    let all = request.places_of_events();
    all.start + event_columns::EACH * plan.nominal.failures.len()..all.end
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: ticks are the whole multiples of the period between the ends, no more of them than are asked for.
    #[test]
    fn ticks_are_multiples_of_the_period() {
        assert_eq!(ticks(0.25, 1.0, 2.0), [1.0, 1.25, 1.5, 1.75, 2.0]);
        assert_eq!(ticks(0.25, 1.1, 1.6), [1.1, 1.25, 1.5, 1.6]);
        assert_eq!(ticks(0.25, 1.25, 1.5), [1.25, 1.5]);
        let many = ticks(0.1, 0.0, 1000.0);
        assert!(many.len() <= 66 && many.iter().all(|time| (time / 0.1 - (time / 0.1).round()).abs() < 1e-9));
    }
}
