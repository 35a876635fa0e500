//! [`Lookup`]: quantities of runs at their observation points, and at any other times.
//!
//! For other times the same sample is flown again with observation points there: what is observed does not change how a
//! run is integrated, so that this works for every engine, effect and control loop. Runs are flown again in lanes, a
//! few at a time, since each brings its own times.

use crate::campaign::Plan;
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
/// Most times at which they are looked at together, beyond those of one question.
const MOST_TIMES: usize = 4096;

/// Rounding of a quantity over time, over its size: that of the dozen products and sums by which it follows from the
/// state.
const ROUNDING_OF_VARIABLES: f64 = 16.0 * f64::EPSILON;

/// An expression of quantities over time.
struct WatchedQuantity {
    expression: Expression,
    /// The variables of the expression, by their places among those that are read.
    variables: Vec<usize>,
    /// Whether they change at the ticks of a control loop alone.
    changes_at_ticks: bool,
}

/// What quantity number `quantity` of run `run` is at `times`, s.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    pub run: usize,
    pub quantity: usize,
    pub times: Vec<f64>,
}

/// Reads quantities of the runs of a plan.
pub(super) struct Lookup<'p> {
    plan: &'p Plan,
    isa: Isa,
    own_engines: Option<EngineMaker>,
    fields: StateFields,
    quantities: Vec<WatchedQuantity>,
    sources: Vec<BandSeries>,
    /// What is observed where runs are flown again: no more than these quantities.
    request: Request,
    reader: BandReader,
    grid: Grid,
}

/// The values of a run at its observation points.
pub(super) struct PointValues<'a> {
    quantities: &'a [WatchedQuantity],
    sources: &'a [BandSeries],
    kept: &'a [f64],
    points: usize,
}

impl PointValues<'_> {
    /// That of source `place` at point `point`.
    fn source(&self, place: usize, point: usize) -> f64 {
        self.sources[place].form.shown(self.kept[place * self.points + point])
    }

    /// That of quantity number `quantity` at point `point`; NaN where it is not known.
    pub fn at(&self, quantity: usize, point: usize) -> f64 {
        let WatchedQuantity { expression, variables, .. } = &self.quantities[quantity];
        expression.value(|variable: usize| self.source(variables[variable], point))
    }

    /// The points at which quantity number `quantity` is not a number though all that it is computed from is known.
    pub fn undefined(&self, quantity: usize) -> impl DoubleEndedIterator<Item = usize> + '_ {
        let variables = &self.quantities[quantity].variables;
        let is_known = move |point: usize| variables.iter().all(|place| !self.source(*place, point).is_nan());
        (0..self.points).filter(move |point| self.at(quantity, *point).is_nan() && is_known(*point))
    }

    /// How far rounding may move quantity number `quantity` at point `point`: the sum over its variables of how far it
    /// moves with each. A variable rounds as its largest value in the run does, an angle at least as the components of
    /// unit vectors do, from which it is computed.
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
        // what is not finite, at an end of what the expression takes, tells nothing of rounding
        changes.map(|both| both.into_iter().filter(|change| change.is_finite()).fold(0.0, f64::max)).sum()
    }

    /// Those of quantity number `quantity` at all points.
    pub fn all(&self, quantity: usize) -> impl Iterator<Item = f64> + '_ {
        (0..self.points).map(move |point| self.at(quantity, point))
    }
}

impl<'p> Lookup<'p> {
    /// Of the quantities that `parsed` are, of runs of `plan` that are observed on `grid`.
    pub fn new(
        plan: &'p Plan,
        grid: &Grid,
        (isa, own_engines): (Isa, Option<EngineMaker>),
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
            plan,
            isa,
            own_engines,
            fields: request.fields(),
            quantities,
            request: narrowed(request, &sources),
            reader: BandReader::new(sources.clone(), (0..grid.points()).collect()),
            sources,
            grid: grid.clone(),
        }
    }

    /// The period of the ticks at which alone quantity number `quantity` changes, s.
    pub fn period(&self, quantity: usize) -> Option<f64> {
        let spec = self.plan.law.as_ref()?.spec()?;
        self.quantities[quantity].changes_at_ticks.then_some(spec.period)
    }

    /// The values of the run with the states `table`, which `observer` has observed last.
    pub fn read(&mut self, observer: &Observer, table: &StateTable) -> PointValues<'_> {
        let points = self.grid.points();
        let kept = self.reader.kept(observer, table, points);
        PointValues { quantities: &self.quantities, sources: &self.sources, kept, points }
    }

    /// Answers each of `asked`, in the order of their runs, those of `scenes` with the draws of their laws: with its
    /// number and the values at its times.
    pub fn answer(&self, asked: &[Asked], of_runs: (&[Scene], &[LawDraw]), take: &mut dyn FnMut(usize, &[f64])) {
        let mut first = 0;
        while first < asked.len() {
            let (mut runs, mut times, mut next): (Vec<usize>, usize, usize) = (Vec::new(), 0, first);
            while let Some(one) = asked.get(next) {
                let is_new = runs.last() != Some(&one.run);
                times += one.times.len();
                if next > first && (is_new && runs.len() == TOGETHER || times > MOST_TIMES) {
                    break;
                }
                if is_new {
                    runs.push(one.run);
                }
                next += 1;
            }
            self.fly_again(&runs, &asked[first..next], of_runs, &mut |index, values| take(first + index, values));
            first = next;
        }
    }

    /// Flies the runs `runs` again, with points where `asked` look.
    fn fly_again(
        &self,
        runs: &[usize],
        asked: &[Asked],
        (scenes, draws): (&[Scene], &[LawDraw]),
        take: &mut dyn FnMut(usize, &[f64]),
    ) {
        let mut times = vec![0.0, self.grid.duration()];
        times.extend(asked.iter().flat_map(|one| &one.times));
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        let grid = Grid::at(times);
        let settings = propagator(self.plan, grid.clone(), self.fields);
        let mut flights = Flights::new(self.plan, &settings, (self.isa, self.own_engines));
        let is_compared = self.sources.iter().any(BandSeries::is_from_nominal);
        let nominal = is_compared.then(|| nominal_attitude(self.plan, &self.request, &grid, self.isa)).flatten();
        let mut observer = Observer::new(self.request, &grid).with_nominal(nominal);
        let points = grid.points();
        let mut reader = BandReader::new(self.sources.clone(), (0..points).collect());
        let mut ignored = vec![f64::NAN; self.request.columns().len()];
        let scenes: Vec<Scene> = runs.iter().map(|run| scenes[*run].clone()).collect();
        let draws: Vec<LawDraw> =
            if draws.is_empty() { Vec::new() } else { runs.iter().map(|run| draws[*run].clone()).collect() };
        let (plan, isa) = (self.plan, self.isa);
        flights.fly(&scenes, &draws, &mut |run, of_law| {
            observe(plan, &mut observer, isa, &scenes[run.index], (&run, of_law), &mut ignored);
            let kept = reader.kept(&observer, run.table, points);
            let known = PointValues { quantities: &self.quantities, sources: &self.sources, kept, points };
            for (index, one) in asked.iter().enumerate().filter(|(_, one)| one.run == runs[run.index]) {
                let point = |time: &f64| grid.times().partition_point(|other| other < time);
                let values: Vec<f64> = one.times.iter().map(|time| known.at(one.quantity, point(time))).collect();
                take(index, &values);
            }
        });
    }
}

/// `start` and `end`, and the ticks of a loop between them; of more than `most` some that are evenly distributed.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: ticks are the whole multiples of the period between the ends, no more of them than are asked for.
    #[test]
    fn ticks_are_multiples_of_the_period() {
        assert_eq!(ticks(0.25, 1.0, 2.0, 64.0), [1.0, 1.25, 1.5, 1.75, 2.0]);
        assert_eq!(ticks(0.25, 1.1, 1.6, 64.0), [1.1, 1.25, 1.5, 1.6]);
        assert_eq!(ticks(0.25, 1.25, 1.5, 64.0), [1.25, 1.5]);
        let many = ticks(0.1, 0.0, 1000.0, 64.0);
        assert!(many.len() <= 66 && many.iter().all(|time| (time / 0.1 - (time / 0.1).round()).abs() < 1e-9));
    }
}
