//! [`ShownRun`]: the runs that the page shows in full: the nominal one, those that failed first, those with the largest errors.

use crate::analysis::survey::Survey;
use crate::analysis::worst_runs::WorstRuns;
use crate::campaign::Plan;
use crate::ensemble::{DrawnScenes, SingleRun};
use crate::findings::names;
use crate::math::Isa;
use crate::observables::Group;
use crate::report::failure_text::{readable, status_words};
use crate::report::page::readable::with_unit;
use crate::run::{Grid, Status, points_before, points_to};
use crate::sampling::SampleId;

/// Places of a list of worst runs after the first, in words.
const PLACES: [&str; 9] = ["second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth"];

/// How many runs are in the table of the worst.
pub const WORST: usize = 10;
/// Failed runs among them, at most.
const MOST_FAILED: usize = 5;
/// Intervals of a run in the page, at least where the campaign's grid is coarser.
const FEWEST: usize = 240;
/// Intervals of a run in the page, at most.
const MOST: usize = 600;
/// Points of a campaign's grid up to which a shown run has its row: the memory of more is not worth a few numbers.
const MOST_OF_ROW: usize = 20_000;
/// A turn between two pictures, rad: enough pictures that a motion is seen as such.
const TURN: f64 = 0.6;

/// The groups whose series the page and plots show.
pub const GROUPS: [Group; 8] = [
    Group::EnergyConservation,
    Group::MomentumConservation,
    Group::Attitude,
    Group::Energies,
    Group::EnergiesCom,
    Group::Constraints,
    Group::Motion,
    Group::Orbit,
];

/// A run that the page shows.
#[derive(Clone, Debug)]
pub struct ShownRun {
    pub sample: SampleId,
    pub why: String,
    /// How it ended; the reason where it is not ok.
    pub status: Status,
    /// Why it is not ok; empty where it is.
    pub reason: String,
    pub inputs: Vec<f64>,
    /// The numbers of its row, by the names of their columns, as the campaign has them: the run may be shown at other times. Empty where it has none.
    pub row: Vec<(String, f64)>,
    /// The run itself; `None` where its scene is not physical.
    pub run: Option<SingleRun>,
}

impl ShownRun {
    /// Whether it was not computed, or its mission failed.
    pub fn has_failed(&self) -> bool {
        let is =
            |name: &str, fails: fn(f64) -> bool| self.row.iter().any(|(column, value)| column == name && fails(*value));
        self.status != Status::Done || is("failure", |code| code >= 1.0) || is("launched", |launched| launched == 0.0)
    }
}

/// The nominal run and the worst ones, run again with all of their states.
pub fn shown_runs(plan: &Plan, survey: &Survey, isa: Isa) -> Vec<ShownRun> {
    let grid = grid(plan, isa);
    let mut list = vec![(SampleId(0), "nominal".to_owned())];
    for (sample, why) in worst(plan, survey) {
        if !list.iter().any(|(other, _)| *other == sample) && list.len() <= WORST {
            list.push((sample, why));
        }
    }
    let panicked = survey.statuses.failed().filter(|ended| ended.status == Status::InternalError);
    let panicked: Vec<&(SampleId, String)> = panicked.flat_map(|ended| &ended.first).collect();
    let one = |(sample, why): (SampleId, String)| match panicked.iter().find(|(other, _)| *other == sample) {
        // a run that ended in a panic would do so again
        Some((_, reason)) => {
            let (inputs, reason) = (inputs(plan, sample), reason.clone());
            ShownRun { sample, why, status: Status::InternalError, reason, inputs, row: Vec::new(), run: None }
        }
        None => shown(plan, sample, why, &grid, isa),
    };
    list.into_iter().map(one).collect()
}

/// The inputs of a sample as applied.
fn inputs(plan: &Plan, sample: SampleId) -> Vec<f64> {
    let drawn = DrawnScenes::new(plan, sample, 1);
    drawn.columns.iter().filter_map(|column| column.first().copied()).collect()
}

fn shown(plan: &Plan, sample: SampleId, why: String, grid: &Grid, isa: Isa) -> ShownRun {
    let inputs = inputs(plan, sample);
    let on = |grid: Grid| SingleRun::with_series(plan, sample, grid, isa, &GROUPS);
    // a mission ends between two times of the grid: where it ends is shown too
    let to_its_end = |run: SingleRun| {
        let end = run.arcs.last().filter(|arc| arc.applied.ends_run).and_then(|arc| with_time(grid, arc.start));
        end.and_then(|grid| on(grid).ok()).unwrap_or(run)
    };
    match on(grid.clone()).map(to_its_end) {
        Ok(run) => {
            let (status, reason) = (run.outcome.status, readable(&run.reason));
            let row = row(plan, &run, &inputs, isa, sample);
            ShownRun { sample, why, status, reason, inputs, row, run: Some(run) }
        }
        Err(errors) => {
            let reason = readable(&errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "));
            ShownRun { sample, why, status: Status::InvalidSample, reason, inputs, row: Vec::new(), run: None }
        }
    }
}

/// The row of a sample, which is shown as `run`: of a campaign with other times, from another run, where that is not too large.
fn row(plan: &Plan, run: &SingleRun, inputs: &[f64], isa: Isa, sample: SampleId) -> Vec<(String, f64)> {
    let another = if plan.grid == run.grid || plan.grid.points() > MOST_OF_ROW {
        None
    } else {
        SingleRun::new(plan, sample, plan.grid.clone(), isa).ok()
    };
    let has_row = another.is_some() || plan.grid == run.grid;
    let run = another.as_ref().unwrap_or(run);
    let names = run.request.columns().into_iter().map(|column| column.quantity.name().to_owned());
    // what depends on the times between is not known then
    let of_run = names.zip(run.row.iter().copied()).filter(|(name, _)| has_row || name.contains("_final"));
    let columns = plan.dispersions.columns().iter().zip(inputs);
    let of_inputs = columns.map(|(column, value)| (column.parameter.column_name(column.component), *value));
    of_run.chain(of_inputs).collect()
}

/// Failed runs, the first of each kind first, then the worst values of each outcome in turn; of the errors where the campaign has no outcome.
fn worst(plan: &Plan, survey: &Survey) -> Vec<(SampleId, String)> {
    let mut first: Vec<(usize, SampleId, String)> = Vec::new();
    for ended in survey.statuses.failed() {
        let of_kind = ended.first.iter().enumerate();
        first.extend(of_kind.map(|(place, (sample, _))| (place, *sample, status_words(ended.status).to_owned())));
    }
    first.sort_by_key(|(place, sample, _)| (*place, *sample));
    let mut list: Vec<(SampleId, String)> =
        first.into_iter().take(MOST_FAILED).map(|(_, sample, why)| (sample, why)).collect();
    let outcomes: Vec<_> = survey.outcomes.iter().filter(|outcome| outcome.is_outcome).collect();
    let errors: Vec<_> = survey.outcomes.iter().filter(|outcome| outcome.is_error && !outcome.is_outcome).collect();
    let outcomes = if outcomes.is_empty() { errors } else { outcomes };
    let deepest = outcomes.iter().map(|outcome| outcome.worst.runs.len()).max().unwrap_or(0);
    for place in 0..deepest {
        for outcome in &outcomes {
            let is_low = outcome.worst.is_low;
            if let Some((sample, value)) = outcome.worst.runs.get(place).filter(|(_, value)| is_low || *value != 0.0) {
                if outcome.quantity.name() == "launched" {
                    // the others are no worse than each other
                    if *value == 0.0 {
                        list.push((*sample, "mission did not launch".to_owned()));
                    }
                    continue;
                }
                let (first, tie) = tied(&outcome.worst, *value);
                let side = if is_low { "smallest" } else { "largest" };
                let rank = match first.checked_sub(1) {
                    None => side.to_owned(),
                    Some(before) => {
                        let which =
                            PLACES.get(before).map_or_else(|| format!("{}th", first + 1), |word| (*word).to_owned());
                        format!("{which} {side}")
                    }
                };
                let quantity = &outcome.quantity;
                let shown = plan.analysis.display.of(quantity.name(), quantity.unit());
                let value = with_unit(shown.value(*value), &shown.unit);
                let name = names::of_quantity(quantity);
                // "largest highest pointing error" is one word too many
                let said =
                    if is_low { ["lowest ", "minimum ", "smallest "] } else { ["highest ", "maximum ", "largest "] };
                let name = said.into_iter().find_map(|word| name.strip_prefix(word)).unwrap_or(&name);
                list.push((*sample, format!("{rank} {name} ({value}{tie})")));
            }
        }
    }
    list
}

/// The first place in `worst` of the runs that are as bad as one with `value`, and how many these are, in words: they have no order.
fn tied(worst: &WorstRuns, value: f64) -> (usize, String) {
    let size = |value: f64| if worst.is_low { value } else { value.abs() };
    let is_same = |(_, other): &(SampleId, f64)| size(*other) == size(value);
    let first = worst.runs.iter().position(is_same).unwrap_or(0);
    let count = worst.runs[first..].iter().take_while(|run| is_same(run)).count();
    // others that are not kept may be as bad
    let more = if worst.is_full() && first + count == worst.runs.len() { " or more" } else { "" };
    (first, if count > 1 { format!("; {count}{more} runs tie") } else { String::new() })
}

/// The times of the runs in the page: the campaign's, with divided intervals where it is coarse or the motion fast.
fn grid(plan: &Plan, isa: Isa) -> Grid {
    let given = plan.grid.points().saturating_sub(1).max(1);
    // the memory of the page does not depend on the campaign's grid
    let looked_at = Grid::uniform(plan.grid.duration(), given.min(MOST) + 1);
    let fastest = SingleRun::with_series(plan, SampleId(0), looked_at, isa, &[]).map_or(0.0, |run| {
        let points = run.outcome.points.min(run.grid.points());
        let rate = |point: usize| crate::math::vector::norm(run.table.at(crate::run::StateField::Rate, point));
        (0..points).map(rate).filter(|rate| rate.is_finite()).fold(0.0, f64::max)
    });
    // of a mission, whose phases are shorter than its longest duration, as many as there are
    let fewest = if plan.law.is_some() { MOST } else { FEWEST };
    let wanted = (fastest * plan.grid.duration() / TURN).clamp(fewest as f64, MOST as f64) as usize;
    let intervals = if given >= wanted { given.min(MOST) } else { given * (wanted / given).max(1) };
    Grid::uniform(plan.grid.duration(), intervals + 1)
}

/// `grid` with one more time; `None` where it has this one, or ends before it.
fn with_time(grid: &Grid, time: f64) -> Option<Grid> {
    let place = points_before(grid.times(), time);
    if place == grid.points() || points_to(grid.times(), time) > place {
        return None;
    }
    let mut times = grid.times().to_vec();
    times.insert(place, time);
    Some(Grid::at(times))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;

    /// Law: what is shown of a mission ends when the mission does, and not at the last time of the grid before it.
    #[test]
    fn a_mission_is_shown_to_its_end() {
        let text = include_str!("../../../campaigns/net_launch.toml");
        let plan = Plan::from_text("net_launch", text, Overrides::default()).expect("valid");
        let run = shown(&plan, SampleId(0), String::new(), &Grid::uniform(plan.grid.duration(), 31), Isa::best());
        let end = run.row.iter().find(|(name, _)| name == "end_time_s").expect("a column").1;
        let flown = run.run.expect("physical");
        assert_eq!(flown.grid.times()[flown.outcome.points - 1], end);
        assert_eq!(with_time(&flown.grid, end), None);
        assert_eq!(with_time(&flown.grid, 1e9), None);
    }

    /// Law: equal runs have the place of the first of them and say how many they are, at least where more than are kept may be equal; a run that is alone says nothing.
    #[test]
    fn equal_runs_have_no_order() {
        let found = |is_low: bool, most: usize, values: &[f64]| {
            let mut worst = WorstRuns::new(most, is_low);
            values.iter().enumerate().for_each(|(sample, value)| worst.add(SampleId(sample as u64), *value));
            worst.runs.iter().map(|(_, value)| tied(&worst, *value)).collect::<Vec<_>>()
        };
        let of = |places: &[(usize, &str)]| {
            places.iter().map(|(place, text)| (*place, (*text).to_owned())).collect::<Vec<_>>()
        };
        let two = "; 2 runs tie";
        assert_eq!(found(false, 10, &[3.0, 5.0, -5.0, 1.0]), of(&[(0, two), (0, two), (2, ""), (3, "")]));
        assert_eq!(found(true, 10, &[3.0, 5.0, -5.0, 3.0]), of(&[(0, ""), (1, two), (1, two), (3, "")]));
        assert_eq!(found(false, 2, &[1.0, 1.0, 1.0]), of(&[(0, "; 2 or more runs tie"); 2]));
        assert_eq!(found(false, 2, &[2.0, 1.0]), of(&[(0, ""), (1, "")]));
    }
}
