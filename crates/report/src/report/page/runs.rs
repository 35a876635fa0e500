//! [`ShownRun`]: the runs shown in full: nominal, failed, and worst.

use crate::analysis::survey::Survey;
use crate::analysis::worst_runs::WorstRuns;
use crate::campaign::Plan;
use crate::ensemble::replays::replayed;
use crate::ensemble::{DrawnScenes, SingleRun};
use crate::findings::loss::{readable, status_words};
use crate::findings::names;
use crate::findings::requirement::{LAUNCHED, against};
use crate::math::Isa;
use crate::report::page::readable::with_unit;
use crate::run::Status;
use crate::sampling::SampleId;

const PLACES: [&str; 9] = ["second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth"];

pub const WORST: usize = 10;
/// Maximum number of failed runs among them.
const MOST_FAILED: usize = 5;
/// Maximum number of runs that miss requirements: the worst of each outcome have room, too.
const MOST_MISSING: usize = 3;

#[derive(Clone, Debug)]
pub struct KnownRow {
    pub sample: SampleId,
    pub status: Status,
    pub reason: String,
    /// Numbers by column name.
    pub numbers: Vec<(String, f64)>,
}

#[derive(Clone, Debug)]
pub struct ShownRun {
    pub sample: SampleId,
    pub why: String,
    pub status: Status,
    pub reason: String,
    pub inputs: Vec<f64>,
    /// Numbers by column name.
    pub row: Vec<(String, f64)>,
    /// `None` if not replayed, or unphysical.
    pub run: Option<SingleRun>,
}

impl ShownRun {
    /// True if it was not computed, or its mission failed.
    pub fn has_failed(&self) -> bool {
        let is =
            |name: &str, fails: fn(f64) -> bool| self.row.iter().any(|(column, value)| column == name && fails(*value));
        self.status != Status::Done || is("failure", |code| code >= 1.0) || is("launched", |launched| launched == 0.0)
    }
}

/// The nominal run and the worst ones with reasons; the worst of the first of `asked`, the required observables, comes
/// first.
pub fn listed(plan: &Plan, survey: &Survey, asked: &[String]) -> Vec<(SampleId, String)> {
    let mut list = vec![(SampleId(0), "nominal".to_owned())];
    for (sample, why) in worst(plan, survey, asked) {
        let has_room = list.len() <= WORST;
        match list.iter_mut().find(|(other, _)| *other == sample) {
            Some((SampleId(0), _)) => {}
            Some((_, known)) => *known += &format!("; {why}"),
            None if has_room => list.push((sample, why)),
            None => {}
        }
    }
    list
}

/// The runs of `list` with their `rows`; the first `flown` are replayed with all states.
pub fn shown_runs(
    plan: &Plan,
    (list, rows): (&[(SampleId, String)], &[KnownRow]),
    flown: usize,
    isa: Isa,
) -> Vec<ShownRun> {
    let row = |sample: SampleId| rows.iter().find(|row| row.sample == sample);
    // a panic would recur
    let is_flown = |sample: &SampleId| row(*sample).is_none_or(|row| row.status != Status::InternalError);
    let samples: Vec<SampleId> = list.iter().map(|(sample, _)| *sample).filter(is_flown).take(flown).collect();
    let numbers = rows.iter().filter(|row| samples.contains(&row.sample)).flat_map(|row| &row.numbers);
    let ends = numbers.filter(|(name, end)| name == "end_time_s" && end.is_finite()).map(|(_, end)| *end);
    let mut runs = replayed(plan, &samples, ends, isa);
    let one = |(sample, why): &(SampleId, String)| {
        let known = row(*sample);
        let run = runs.iter().position(|(other, _)| other == sample).map(|place| runs.swap_remove(place).1);
        ShownRun {
            sample: *sample,
            why: why.clone(),
            status: known.map_or(Status::Done, |row| row.status),
            reason: known.map_or_else(String::new, |row| readable(&row.reason)),
            inputs: inputs(plan, *sample),
            row: known.map_or_else(Vec::new, |row| row.numbers.clone()),
            run,
        }
    };
    list.iter().map(one).collect()
}

pub fn left_out(runs: &[ShownRun]) -> Option<String> {
    let unflown = runs.iter().filter(|run| run.run.is_none());
    let left = unflown.filter(|run| !matches!(run.status, Status::InternalError | Status::InvalidSample)).count();
    let said =
        "runs are not replayed, which would take longer than a tenth of the campaign; the commands are in the list";
    (left > 0).then(|| format!("{left} of {} {said}", runs.len()))
}

fn inputs(plan: &Plan, sample: SampleId) -> Vec<f64> {
    let drawn = DrawnScenes::new(plan, sample, 1);
    drawn.columns.iter().filter_map(|column| column.first().copied()).collect()
}

/// The worst run against the requirements, the first failures of each kind, the next worst runs, then the worst values
/// of each outcome in turn, or of the errors if there are no outcomes.
fn worst(plan: &Plan, survey: &Survey, asked: &[String]) -> Vec<(SampleId, String)> {
    let mut first: Vec<(usize, SampleId, String)> = Vec::new();
    for ended in survey.statuses.failed() {
        let of_kind = ended.first.iter().enumerate();
        first.extend(of_kind.map(|(place, (sample, _))| (place, *sample, status_words(ended.status).to_owned())));
    }
    first.sort_by_key(|(place, sample, _)| (*place, *sample));
    let mut list: Vec<(SampleId, String)> =
        first.into_iter().take(MOST_FAILED).map(|(_, sample, why)| (sample, why)).collect();
    let mut outcomes: Vec<_> = survey.outcomes.iter().filter(|outcome| outcome.is_outcome).collect();
    let place = |name: &str| asked.iter().position(|one| one == name).unwrap_or(usize::MAX);
    outcomes.sort_by_key(|outcome| place(outcome.quantity.name()));
    let errors: Vec<_> = survey.outcomes.iter().filter(|outcome| outcome.is_error && !outcome.is_outcome).collect();
    let outcomes = if outcomes.is_empty() { errors } else { outcomes };
    let lost = list.len();
    let missing = survey.against.runs.iter().enumerate().filter(|(place, (_, missed))| *place == 0 || *missed >= 1.0);
    list.extend(missing.take(MOST_MISSING).map(|(_, (sample, missed))| (*sample, against(plan, *missed))));
    let deepest = outcomes.iter().map(|outcome| outcome.worst.runs.len()).max().unwrap_or(0);
    for place in 0..deepest {
        for outcome in &outcomes {
            let is_low = outcome.worst.is_low;
            if let Some((sample, value)) = outcome.worst.runs.get(place).filter(|(_, value)| is_low || *value != 0.0) {
                if outcome.quantity.name() == LAUNCHED {
                    continue;
                }
                let (first, tie) = tied(&outcome.worst, *value);
                let rank = first.checked_sub(1).map_or_else(String::new, |before| {
                    PLACES.get(before).map_or_else(|| format!("{}th ", first + 1), |word| format!("{word} "))
                });
                let quantity = &outcome.quantity;
                let shown = plan.analysis.display.of(quantity.name(), quantity.unit());
                let value = with_unit(shown.value(*value), &shown.unit);
                let name = names::of_extreme(&names::of_quantity(quantity), is_low);
                list.push((*sample, format!("{rank}{name} ({value}{tie})")));
            }
        }
    }
    if !asked.is_empty() && list.len() > lost {
        // the run to look at precedes lost runs
        list[..=lost].rotate_right(1);
    }
    list
}

/// The first place of runs as bad as `value`, and the number of ties in words.
fn tied(worst: &WorstRuns, value: f64) -> (usize, String) {
    let size = |value: f64| if worst.is_low { value } else { value.abs() };
    let is_same = |(_, other): &(SampleId, f64)| size(*other) == size(value);
    let first = worst.runs.iter().position(is_same).unwrap_or(0);
    let count = worst.runs[first..].iter().take_while(|run| is_same(run)).count();
    // runs beyond the kept ones may tie
    let more = if worst.is_full() && first + count == worst.runs.len() { " or more" } else { "" };
    (first, if count > 1 { format!("; {count}{more} runs tie") } else { String::new() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::shipped;

    /// Law: the first listed runs are replayed; the others are counted; a run that panicked is neither.
    #[test]
    fn runs_that_are_not_flown_are_counted() {
        let plan = shipped::plan("spin_sweep");
        let list: Vec<(SampleId, String)> = [0, 7, 3, 9].map(|sample| (SampleId(sample), String::new())).to_vec();
        let row = |(sample, _): &(SampleId, String)| KnownRow {
            sample: *sample,
            status: if sample.0 == 7 { Status::InternalError } else { Status::Done },
            reason: String::new(),
            numbers: Vec::new(),
        };
        let rows: Vec<KnownRow> = list.iter().map(row).collect();
        for (flown, said) in [(0, Some("3 of 4")), (1, Some("2 of 4")), (2, Some("1 of 4")), (3, None), (9, None)] {
            let shown = shown_runs(&plan, (&list, &rows), flown, Isa::best());
            assert_eq!(shown.iter().filter(|run| run.run.is_some()).count(), flown.min(3));
            let left = left_out(&shown);
            assert_eq!(left.map(|text| text[..6].to_owned()).as_deref(), said, "{flown}");
        }
    }
}
