//! [`notes`]: the quantities of events and extremes that are not a number somewhere in the first samples, found by
//! flying these.

use std::slice::from_ref;

use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::end_finder::EndFinder;
use crate::ensemble::flights::{Flights, LawDraw, nominal_attitude, observe};
use crate::ensemble::lookup::Lookup;
use crate::ensemble::probe::limited;
use crate::ensemble::settings::propagator;
use crate::math::Isa;
use crate::observables::Observer;
use crate::observables::band_series::event_series;
use crate::sampling::SampleId;

/// How many samples are flown.
const TRIED: u64 = 8;

/// What a quantity is not a number in: how many runs, and the first one of them with the time, s.
#[derive(Clone, Copy)]
struct Undefined {
    runs: usize,
    sample: SampleId,
    time_s: f64,
}

/// The quantities of events and extremes of `plan` that are not a number at some observation point of its first
/// samples, a sentence each.
pub fn notes(plan: &Plan, isa: Isa) -> Vec<String> {
    let series = event_series(&plan.request());
    let events = plan.events.iter().map(|one| ("event", &one.name, &one.quantity, one.parsed(&series)));
    let extremes = plan.extremes.iter().map(|one| ("extreme", &one.name, &one.quantity, one.parsed(&series)));
    let partial = events.chain(extremes).filter_map(|(table, name, quantity, parsed)| {
        let parsed = parsed.filter(|(expression, _)| !expression.is_total())?;
        Some(((table, name, quantity), parsed))
    });
    let (watched, parsed): (Vec<_>, Vec<_>) = partial.unzip();
    if watched.is_empty() {
        return Vec::new();
    }
    let plan = &limited(plan);
    let (request, grid) = (plan.request(), &plan.grid);
    let mut lookup = Lookup::new(plan, grid, (isa, None), parsed.into_iter());
    let mut observer = Observer::new(request, grid).with_nominal(nominal_attitude(plan, &request, grid, isa));
    let mut flights = Flights::new(plan, &propagator(plan, grid.clone(), request.fields()), (isa, None));
    let mut ends = EndFinder::new(plan, (isa, None));
    let mut draws = SceneDraws::new(plan);
    let mut ignored = vec![f64::NAN; request.columns().len()];
    let mut found: Vec<Option<Undefined>> = vec![None; watched.len()];
    let tried = plan.rows().min(TRIED);
    for sample in (0..tried).map(SampleId) {
        let Ok(scene) = draws.scene(sample) else { continue };
        let draw = plan.law.as_ref().map(|_| LawDraw { sample, parameters: draws.drawn().control.clone() });
        let end = ends.as_mut().and_then(|ends| ends.end(&scene, draw.as_slice()));
        let end = end.map_or(f64::INFINITY, |end| end.time);
        flights.fly(from_ref(&scene), draw.as_slice(), &mut |run, of_law| {
            observe(plan, &mut observer, isa, &scene, (&run, of_law), &mut ignored);
            let values = lookup.read(&observer, run.table);
            for (quantity, found) in found.iter_mut().enumerate() {
                let time = values.undefined(quantity).next().map(|point| grid.times()[point]);
                let Some(time_s) = time.filter(|time| *time < end) else { continue };
                let first = found.get_or_insert(Undefined { runs: 0, sample, time_s });
                first.runs += 1;
            }
        });
    }
    let note = |((table, name, quantity), found): (&(&str, &String, &String), &Option<Undefined>)| {
        let Undefined { runs, sample, time_s } = (*found)?;
        Some(format!(
            "[[{table}]] {name}: {quantity} is not a number in {runs} of the first {tried} samples, first in sample \
            {sample} at {time_s} s: the values of such a run \
             are null, and leave a requirement undecided"
        ))
    };
    watched.iter().zip(&found).filter_map(note).collect()
}
