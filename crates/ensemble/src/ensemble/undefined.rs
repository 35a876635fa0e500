//! [`notes`]: quantities of events and extremes that are NaN in the first samples.

use crate::campaign::watched_quantity::parsed;
use crate::campaign::{Plan, SceneDraws};
use crate::ensemble::event_finder::EndFinder;
use crate::ensemble::flights::{LawDraw, Means, Runs};
use crate::ensemble::lookup::Lookup;
use crate::ensemble::probe::limited;
use crate::ensemble::settings::Engines;
use crate::math::Isa;
use crate::observables::band_series::event_series;
use crate::sampling::SampleId;

const TRIED: u64 = 8;

/// Runs in which a quantity is NaN, and the first with its time, s.
#[derive(Clone, Copy)]
struct Undefined {
    runs: usize,
    sample: SampleId,
    time_s: f64,
}

/// A sentence for each quantity that is NaN at an observation point of the first samples.
pub fn notes(plan: &Plan, isa: Isa) -> Vec<String> {
    let series = event_series(&plan.request());
    let events = plan.events.iter().map(|one| ("event", &one.name, &one.quantity, parsed(&one.quantity, &series)));
    let extremes =
        plan.extremes.iter().map(|one| ("extreme", &one.name, &one.quantity, parsed(&one.quantity, &series)));
    let partial = events.chain(extremes).filter_map(|(table, name, quantity, parsed)| {
        let parsed = parsed.filter(|(expression, _)| !expression.is_total())?;
        Some(((table, name, quantity), parsed))
    });
    let (watched, parsed): (Vec<_>, Vec<_>) = partial.unzip();
    if watched.is_empty() {
        return Vec::new();
    }
    let plan = &limited(plan);
    let (grid, engines) = (&plan.grid, Engines::of(isa));
    let mut lookup = Lookup::new(plan, grid, engines, parsed.into_iter());
    let mut runs = Means::new(plan, engines).runs(grid);
    let mut ends = EndFinder::new(plan, engines);
    let mut draws = SceneDraws::new(plan);
    let mut found: Vec<Option<Undefined>> = vec![None; watched.len()];
    let tried = plan.rows().min(TRIED);
    for sample in (0..tried).map(SampleId) {
        let Ok(scene) = draws.scene(sample) else { continue };
        let draw = LawDraw::of(plan, sample, draws.drawn());
        let end = ends.as_mut().and_then(|ends| ends.end(&scene, draw.as_slice()));
        let end = end.map_or(f64::INFINITY, |end| end.time);
        runs.fly(Runs::one(&scene, draw.as_slice()), &mut |seen| {
            let values = lookup.read(seen.observer, seen.run.table);
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
