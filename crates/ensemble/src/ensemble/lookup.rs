//! [`Lookup`]: quantities of runs at observation points and other times, for which the sample is flown again with
//! points there: observation does not change the integration of any engine, effect and loop. Each run has its own
//! times, so a few are flown at once, in lanes. A loop is flown no further than the last of these times.

use crate::campaign::Plan;
use crate::ensemble::crossing::nodes;
use crate::ensemble::flights::{LawDraw, Means, Runs, nominal_attitude};
use crate::ensemble::settings::Engines;
use crate::observables::band_reader::BandReader;
use crate::observables::band_series::{BandSeries, event_series};
use crate::observables::window::NO_WINDOWS;
use crate::observables::{Group, Groups, Observer, Request};
use crate::run::{Grid, StateFields, StateTable};
use crate::sampling::expression::Expression;
use crate::scene::Scene;

/// One in each lane.
const TOGETHER: usize = 8;
/// Most times of one flight, beyond those of one query.
const MOST_TIMES: usize = 16_384;

/// Relative rounding of a dozen products and sums from state to quantity.
const ROUNDING_OF_VARIABLES: f64 = 16.0 * f64::EPSILON;

struct WatchedQuantity {
    expression: Expression,
    /// Indices of its variables among the sources.
    variables: Vec<usize>,
    /// True if they only change at ticks of a control loop.
    changes_at_ticks: bool,
}

#[derive(Clone, Debug)]
struct Query {
    run: usize,
    quantity: usize,
    times: Vec<f64>,
}

/// Most pieces of an interval in one flight of a loop, which bends a curve at its ticks.
const MOST_PIECES: f64 = 64.0;
/// Most flights of a search: they locate a jump or corner between points an hour apart to rounding.
const MOST_FLIGHTS: usize = 24;
/// Limits of a search's relative error, which is that of the integration within them.
pub(super) const ERRORS: [f64; 2] = [1e-13, 1e-9];

#[derive(Clone, Copy, Debug)]
pub(super) struct Search<T> {
    pub run: usize,
    pub quantity: usize,
    pub wanted: T,
    pub between: [f64; 2],
}

pub(super) struct Lookup<'p> {
    /// Requests only the columns of the quantities.
    means: Means<'p>,
    fields: StateFields,
    quantities: Vec<WatchedQuantity>,
    sources: Vec<BandSeries>,
    reader: BandReader,
    grid: Grid,
}

pub(super) struct PointValues<'a> {
    quantities: &'a [WatchedQuantity],
    sources: &'a [BandSeries],
    kept: &'a [f64],
    points: usize,
}

impl PointValues<'_> {
    fn source(&self, place: usize, point: usize) -> f64 {
        self.sources[place].form.shown(self.kept[place * self.points + point])
    }

    /// The value of a quantity at a point; NaN if unknown.
    pub fn at(&self, quantity: usize, point: usize) -> f64 {
        let WatchedQuantity { expression, variables, .. } = &self.quantities[quantity];
        expression.value(|variable: usize| self.source(variables[variable], point))
    }

    /// Points at which a quantity is NaN though its sources are known.
    pub fn undefined(&self, quantity: usize) -> impl DoubleEndedIterator<Item = usize> + '_ {
        let variables = &self.quantities[quantity].variables;
        let is_known = move |point: usize| variables.iter().all(|place| !self.source(*place, point).is_nan());
        (0..self.points).filter(move |point| self.at(quantity, *point).is_nan() && is_known(*point))
    }

    /// The rounding of a quantity at a point, summed over its variables: each rounds as its largest value in the run,
    /// an angle at least as unit vectors.
    pub fn rounding(&self, quantity: usize, point: usize) -> f64 {
        let WatchedQuantity { expression, variables, .. } = &self.quantities[quantity];
        let value = self.at(quantity, point);
        let moved = |which: usize| {
            let place = variables[which];
            let least = if self.sources[place].quantity.unit() == "rad" { 1.0 } else { 0.0 };
            let size = (0..self.points).fold(least, |size: f64, point| size.max(self.source(place, point).abs()));
            let change = |by: f64| {
                let of = |variable: usize| if variable == which { by } else { 0.0 };
                (expression.value(|variable| self.source(variables[variable], point) + of(variable)) - value).abs()
            };
            [change(ROUNDING_OF_VARIABLES * size), change(-ROUNDING_OF_VARIABLES * size)]
        };
        let changes = (0..variables.len()).map(moved).chain([[ROUNDING_OF_VARIABLES * value.abs(); 2]]);
        changes.map(|both| both.into_iter().filter(|change| change.is_finite()).fold(0.0, f64::max)).sum()
    }

    pub fn all(&self, quantity: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.points).map(move |point| self.at(quantity, point))
    }
}

/// Takes a search with times of its interval (of a curve, the [`nodes`] of its pieces) and their values; returns
/// intervals for another look.
pub type Narrow<'n, T> = dyn FnMut(Search<T>, &[f64], &[f64]) -> Vec<[f64; 2]> + 'n;

impl<'p> Lookup<'p> {
    pub fn new(
        plan: &'p Plan,
        grid: &Grid,
        engines: Engines,
        parsed: impl Iterator<Item = (Expression, Vec<BandSeries>)>,
    ) -> Self {
        let request = plan.request();
        let mut sources: Vec<BandSeries> = Vec::new();
        let mut place = |band: BandSeries| {
            sources.iter().position(|known| *known == band).unwrap_or_else(|| {
                sources.push(band);
                sources.len() - 1
            })
        };
        let quantities = parsed.map(|(expression, variables)| WatchedQuantity {
            expression,
            changes_at_ticks: variables.iter().all(BandSeries::changes_at_ticks),
            variables: variables.into_iter().map(&mut place).collect(),
        });
        let quantities = quantities.collect();
        Lookup {
            means: Means { request: narrowed(request, &sources), ..Means::new(plan, engines) },
            fields: request.fields(),
            quantities,
            reader: BandReader::new(sources.clone(), (0..grid.points()).collect()),
            sources,
            grid: grid.clone(),
        }
    }

    /// Period of the ticks at which a quantity changes, s; `None` if it also changes between them.
    pub fn period(&self, quantity: usize) -> Option<f64> {
        self.means.plan.loop_spec().filter(|_| self.quantities[quantity].changes_at_ticks).map(|spec| spec.period)
    }

    /// The times at which a search looks at its interval.
    fn times<T>(&self, &Search { quantity, between: [start, end], .. }: &Search<T>, most_ticks: f64) -> Vec<f64> {
        if start == end {
            return vec![start];
        }
        match (self.period(quantity), self.means.plan.loop_spec()) {
            (Some(period), _) => ticks(period, start, end, most_ticks),
            (None, Some(spec)) => {
                let ends = ticks(spec.period, start, end, MOST_PIECES);
                ends.windows(2).flat_map(|piece| nodes(piece[0], piece[1])).collect()
            }
            (None, None) => nodes(start, end).collect(),
        }
    }

    /// The values of the run observed last by `observer`.
    pub fn read(&mut self, observer: &Observer, table: &StateTable) -> PointValues<'_> {
        let points = self.grid.points();
        let kept = self.reader.kept(observer, table, points);
        PointValues { quantities: &self.quantities, sources: &self.sources, kept, points }
    }

    /// Answers `queries`, those of one flight side by side: passes the index of each with the values at its times.
    fn answer(&self, queries: &[Query], of_runs: Runs<'_>, take: &mut dyn FnMut(usize, &[f64])) {
        let mut first = 0;
        while first < queries.len() {
            let (mut runs, mut times, mut next): (Vec<usize>, Vec<f64>, usize) = (Vec::new(), Vec::new(), first);
            while let Some(one) = queries.get(next) {
                let is_new = !runs.contains(&one.run);
                let mut with_own = [&times[..], &one.times].concat();
                with_own.sort_unstable_by(f64::total_cmp);
                with_own.dedup();
                if next > first && (is_new && runs.len() == TOGETHER || with_own.len() > MOST_TIMES) {
                    break;
                }
                times = with_own;
                if is_new {
                    runs.push(one.run);
                }
                next += 1;
            }
            let queries = &queries[first..next];
            self.fly_again(&runs, (queries, times), of_runs, &mut |index, values| take(first + index, values));
            first = next;
        }
    }

    /// Narrows down `searches` by repeated flights; returns those without an end.
    pub fn refine<T: Copy>(
        &self,
        mut searches: Vec<Search<T>>,
        runs: Runs<'_>,
        most_ticks: f64,
        narrow: &mut Narrow<'_, T>,
    ) -> Vec<Search<T>> {
        for _ in 0..MOST_FLIGHTS {
            if searches.is_empty() {
                break;
            }
            // flights end with their last search
            searches.sort_by(|one, other| one.between[1].total_cmp(&other.between[1]).then(one.run.cmp(&other.run)));
            let query =
                |one: &Search<T>| Query { run: one.run, quantity: one.quantity, times: self.times(one, most_ticks) };
            let queries: Vec<Query> = searches.iter().map(query).collect();
            let mut again = Vec::new();
            self.answer(&queries, runs, &mut |index, values| {
                let between = narrow(searches[index], &queries[index].times, values);
                again.extend(between.into_iter().map(|between| Search { between, ..searches[index] }));
            });
            searches = again;
        }
        searches
    }

    fn fly_again(
        &self,
        runs: &[usize],
        (queries, mut times): (&[Query], Vec<f64>),
        Runs { scenes, draws }: Runs<'_>,
        take: &mut dyn FnMut(usize, &[f64]),
    ) {
        let Means { plan, request, engines } = self.means;
        // the arc of the last time keeps its length
        let beyond = plan.loop_spec().map_or(f64::INFINITY, |spec| spec.period);
        let end = times.last().map_or(0.0, |last| last + beyond);
        times.extend([0.0, self.grid.duration().min(end)]);
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        let grid = Grid::at(times);
        let is_compared = self.sources.iter().any(BandSeries::is_from_nominal);
        let nominal = is_compared.then(|| nominal_attitude(plan, &request, &grid, engines.isa)).flatten();
        let mut observed = self.means.runs_with(&grid, self.fields, nominal);
        let points = grid.points();
        let mut reader = BandReader::new(self.sources.clone(), (0..points).collect());
        let scenes: Vec<Scene> = runs.iter().map(|run| scenes[*run].clone()).collect();
        let draws: Vec<LawDraw> =
            if draws.is_empty() { Vec::new() } else { runs.iter().map(|run| draws[*run].clone()).collect() };
        observed.fly(Runs { scenes: &scenes, draws: &draws }, &mut |seen| {
            let kept = reader.kept(seen.observer, seen.run.table, points);
            let known = PointValues { quantities: &self.quantities, sources: &self.sources, kept, points };
            for (index, one) in queries.iter().enumerate().filter(|(_, one)| one.run == runs[seen.run.index]) {
                let point = |time: &f64| grid.times().partition_point(|other| other < time);
                let values: Vec<f64> = one.times.iter().map(|time| known.at(one.quantity, point(time))).collect();
                take(index, &values);
            }
        });
    }
}

/// `start`, `end` and the ticks between, thinned evenly to at most `most`.
pub(super) fn ticks(period: f64, start: f64, end: f64, most: f64) -> Vec<f64> {
    let [first, last] = [(start / period).floor() + 1.0, (end / period).ceil() - 1.0];
    let count = (last - first + 1.0).max(0.0);
    let every = (count / most).ceil().max(1.0);
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
