//! [`ExtremeFinder`]: largest and smallest values, also between observation points.
//!
//! A largest value lies near a point above its neighbours or at an end of the interval, where the sample is flown again
//! with more points (`peak`); quantities of a control loop are looked up at every tick. An extreme is a value of the
//! quantity itself, null if that is NaN at a point of the interval.

use crate::campaign::Plan;
use crate::campaign::extreme::Extreme;
use crate::campaign::watched_quantity::parsed;
use crate::ensemble::flights::{Runs, end_of};
use crate::ensemble::lookup::{ERRORS, Lookup, Search, ticks};
use crate::ensemble::peak::{BEYOND, largest, may_exceed, of_curve};
use crate::ensemble::settings::Engines;
use crate::observables::Observer;
use crate::observables::band_series::event_series;
use crate::propagation::CompletedRun;
use crate::run::Grid;

const TICKS: usize = 16_384;

pub(super) struct ExtremeFinder<'p> {
    plan: &'p Plan,
    lookup: Lookup<'p>,
    times: Vec<f64>,
    /// Ends of runs, s; NaN for others.
    ends: Vec<f64>,
    /// By run and extreme; negated for smallest values.
    values: Vec<f64>,
    found: Vec<f64>,
    /// Last time with NaN, s; NaN for never.
    undefined: Vec<f64>,
}

fn sign(extreme: &Extreme) -> f64 {
    if extreme.is_highest { 1.0 } else { -1.0 }
}

impl<'p> ExtremeFinder<'p> {
    pub fn new(plan: &'p Plan, grid: &Grid, engines: Engines) -> Self {
        let series = event_series(&plan.request());
        let parsed = plan.extremes.iter().filter_map(|extreme| parsed(&extreme.quantity, &series));
        ExtremeFinder {
            plan,
            lookup: Lookup::new(plan, grid, engines, parsed),
            times: grid.times().to_vec(),
            ends: Vec::new(),
            values: Vec::new(),
            found: Vec::new(),
            undefined: Vec::new(),
        }
    }

    pub fn restart(&mut self, runs: usize) {
        let extremes = self.plan.extremes.len();
        for (list, count) in [
            (&mut self.ends, runs),
            (&mut self.values, runs * extremes * self.times.len()),
            (&mut self.found, runs * extremes),
            (&mut self.undefined, runs * extremes),
        ] {
            list.clear();
            list.resize(count, f64::NAN);
        }
    }

    pub fn look(&mut self, run: &CompletedRun<'_>, observer: &Observer) {
        let (extremes, points) = (&self.plan.extremes, self.times.len());
        if extremes.is_empty() {
            return;
        }
        self.ends[run.index] = end_of(run);
        let known = self.lookup.read(observer, run.table);
        let of_run = self.values[run.index * extremes.len() * points..].chunks_exact_mut(points);
        for (quantity, (extreme, values)) in extremes.iter().zip(of_run).enumerate() {
            values.iter_mut().zip(known.all(quantity)).for_each(|(value, known)| *value = sign(extreme) * known);
            if values.iter().any(|value| value.is_nan()) {
                let last = known.undefined(quantity).next_back();
                self.undefined[run.index * extremes.len() + quantity] =
                    last.map_or(f64::NAN, |point| self.times[point]);
            }
        }
    }

    /// Locates the extremes; `time_of` gives the time of an event of a run.
    pub fn locate(&mut self, runs: Runs<'_>, time_of: &dyn Fn(usize, usize) -> f64) {
        let mut pending = Vec::new();
        for run in 0..self.ends.len() {
            for (index, extreme) in self.plan.extremes.iter().enumerate() {
                let event =
                    extreme.after.as_ref().and_then(|name| self.plan.events.iter().position(|one| one.name == *name));
                let start = event.map_or(0.0, |event| time_of(run, event)) + extreme.delay_s;
                let end = self.ends[run];
                let is_undefined = self.undefined[run * self.plan.extremes.len() + index] >= start;
                if start <= end && !is_undefined {
                    let places = self.places(run, index, [start, end]);
                    let search = |between| Search { run, quantity: index, wanted: (), between };
                    pending.extend(places.into_iter().map(search));
                }
            }
        }
        let (extremes, found, lookup) = (&self.plan.extremes, &mut self.found, &self.lookup);
        let error = self.plan.tolerance.relative.clamp(ERRORS[0], ERRORS[1]);
        lookup.refine(pending, runs, f64::INFINITY, &mut |one, times, values| {
            let values: Vec<f64> = values.iter().map(|value| sign(&extremes[one.quantity]) * value).collect();
            let found = &mut found[one.run * extremes.len() + one.quantity];
            *found = found.max(largest(&values));
            if lookup.period(one.quantity).is_some() { Vec::new() } else { of_curve(times, &values, error) }
        });
    }

    /// Intervals that may hold the largest value of an extreme, besides the points.
    fn places(&mut self, run: usize, extreme: usize, [start, end]: [f64; 2]) -> Vec<[f64; 2]> {
        if let Some(period) = self.lookup.period(extreme) {
            let ticks = ticks(period, start, end, f64::INFINITY);
            return ticks.chunks(TICKS).map(|chunk| [chunk[0], chunk[chunk.len() - 1]]).collect();
        }
        let (times, extremes) = (&self.times, self.plan.extremes.len());
        let values = &self.values[(run * extremes + extreme) * times.len()..][..times.len()];
        let [first, after] = [times.partition_point(|time| *time <= start), times.partition_point(|time| *time <= end)];
        if first >= after {
            return vec![[start, end]];
        }
        let known = largest(&values[first..after]);
        let can_be = |point: &usize| {
            let [before, here, next] = [values[point - 1], values[*point], values[point + 1]];
            // an unknown neighbour is no larger
            let has_larger = [before, next].into_iter().any(|beside| beside > here);
            !has_larger && (before != here || next != here) && may_exceed([before, here, next], known)
        };
        let inner = (first + 1..after.saturating_sub(1)).filter(can_be);
        let mut places: Vec<[f64; 2]> = inner.map(|point| [times[point - 1], times[point + 1]]).collect();
        let stays_below = |limit: f64, three: [usize; 3]| {
            let [edge, beside, third] = three.map(|point| values[point]);
            let bound = edge.max(beside) + BEYOND * (edge - 2.0 * beside + third).abs();
            times[three[0]] == limit && bound < known
        };
        let has_three = after - first >= 3;
        if !has_three || !stays_below(start, [first, first + 1, first + 2]) {
            places.push([start, times[(first + 1).min(after - 1)]]);
        }
        if !has_three || !stays_below(end, [after - 1, after - 2, after - 3]) {
            places.push([times[after.saturating_sub(2).max(first)], end]);
        }
        let found = &mut self.found[run * extremes + extreme];
        *found = found.max(known);
        places
    }

    pub fn values(&self, run: usize) -> impl Iterator<Item = f64> + '_ {
        let extremes = &self.plan.extremes;
        let of_run = &self.found[run * extremes.len()..(run + 1) * extremes.len()];
        of_run.iter().zip(extremes).map(|(found, extreme)| sign(extreme) * found)
    }
}
