//! [`EventFinder`]: the times at which quantities of runs cross values, and how often.
//!
//! A crossing shows in the values of a run at two neighbouring observation points. Where its time is asked for, the same sample is flown again, with
//! observation points between these two (`crossing`): what is observed does not change how a run is integrated, so that this works for every
//! engine, effect and control loop, and a run without a crossing costs nothing. Runs are flown again in lanes, a few at a time, since each brings its
//! own observation points.

use crate::campaign::event::{Direction, Event, Which};
use crate::campaign::{Plan, event_columns};
use crate::ensemble::crossing::{Found, Wanted, nodes, of_curve, of_steps};
use crate::ensemble::flights::{Flights, LawDraw, nominal_attitude, observe};
use crate::ensemble::settings::{EngineMaker, propagator};
use crate::math::Isa;
use crate::observables::band_reader::BandReader;
use crate::observables::band_series::{BandSeries, event_series};
use crate::observables::window::NO_WINDOWS;
use crate::observables::{Group, Groups, Observer, Request};
use crate::run::{Grid, StateFields, StateTable};
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
    /// Run by run, event by event.
    found: Vec<Occurrence>,
    pending: Vec<Pending>,
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
            found: Vec::new(),
            pending: Vec::new(),
        })
    }

    /// Forgets all runs; `runs` come.
    pub fn restart(&mut self, runs: usize) {
        let none = Occurrence { time: f64::NAN, count: 0 };
        self.found.clear();
        self.found.resize(runs * self.watched.len(), none);
        self.pending.clear();
    }

    /// Looks at the run number `run` with the states `table`, which `observer` has observed last.
    pub fn look(&mut self, run: usize, observer: &Observer, table: &StateTable) {
        let (times, events) = (self.grid.times(), self.watched.len());
        let kept = self.reader.kept(observer, table);
        for (index, watched) in self.watched.iter().enumerate() {
            let values = (0..times.len()).map(|point| watched.value(&self.sources, kept, times.len(), point));
            let seen = Seen::of(values, watched.event.direction);
            let found = &mut self.found[run * events + index];
            found.count = seen.count;
            let (place, is_last) = match watched.event.which {
                Which::First => (seen.first, false),
                Which::Last => (seen.last, true),
                Which::Stays => (seen.stays, true),
            };
            match place {
                None => {}
                Some(Place::Point(point)) => found.time = times[point],
                Some(Place::Crossing { before, is_rising }) => self.pending.push(Pending {
                    run,
                    event: index,
                    wanted: Wanted { is_rising, is_last },
                    between: [times[before], times[before + 1]],
                    nodes: Vec::new(),
                }),
            }
        }
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
        of_run.iter().flat_map(|found| [found.time, f64::from(found.count)])
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
            let kept = reader.kept(&observer, run.table);
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

/// Where something begins that an event is about.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// Between this point and the next.
    Crossing { before: usize, is_rising: bool },
    /// At this point: the quantity is not known before.
    Point(usize),
}

/// The crossings in the values of a run at its observation points.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    count: u32,
    first: Option<Place>,
    last: Option<Place>,
    /// Where the quantity comes to the side on which it stays to the end.
    stays: Option<Place>,
}

impl Seen {
    /// Those in `direction`; NaN is a value that is not known, and no crossing.
    fn of(values: impl Iterator<Item = f64>, direction: Direction) -> Self {
        let mut seen = Seen { count: 0, first: None, last: None, stays: None };
        let mut before: Option<bool> = None;
        for (point, value) in values.enumerate() {
            if value.is_nan() {
                before = None;
                continue;
            }
            let is_above = value > 0.0;
            let is_there = is_above == (direction != Direction::Falling);
            match before {
                Some(was_above) if was_above != is_above => {
                    let crossing = Place::Crossing { before: point - 1, is_rising: is_above };
                    if direction == Direction::Either || is_there {
                        seen.count += 1;
                        seen.first = seen.first.or(Some(crossing));
                        seen.last = Some(crossing);
                    }
                    seen.stays = is_there.then_some(crossing);
                }
                None => seen.stays = is_there.then_some(Place::Point(point)),
                Some(_) => {}
            }
            before = Some(is_above);
        }
        seen
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

    /// Law: crossings are counted in their direction; a value on the limit is not beyond it; what is not known crosses nothing; a quantity stays on a side
    /// from its last crossing on, or from where it is known.
    #[test]
    fn crossings_are_counted() {
        let nan = f64::NAN;
        let up = |before| Some(Place::Crossing { before, is_rising: true });
        let down = |before| Some(Place::Crossing { before, is_rising: false });
        let of = |values: &[f64], direction| Seen::of(values.iter().copied(), direction);
        let wave = [-1.0, 1.0, 2.0, -1.0, -2.0, 0.0, 1.0];
        let rising = of(&wave, Direction::Rising);
        assert_eq!(rising, Seen { count: 2, first: up(0), last: up(5), stays: up(5) });
        let falling = of(&wave, Direction::Falling);
        assert_eq!(falling, Seen { count: 1, first: down(2), last: down(2), stays: None });
        let either = of(&wave, Direction::Either);
        assert_eq!((either.count, either.first, either.last), (3, up(0), up(5)));
        let always = of(&[-1.0; 4], Direction::Falling);
        assert_eq!(always, Seen { count: 0, first: None, last: None, stays: Some(Place::Point(0)) });
        let gap = of(&[1.0, nan, -1.0, -2.0], Direction::Falling);
        assert_eq!(gap, Seen { count: 0, first: None, last: None, stays: Some(Place::Point(2)) });
        assert_eq!(of(&[nan; 3], Direction::Rising), Seen { count: 0, first: None, last: None, stays: None });
    }

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
