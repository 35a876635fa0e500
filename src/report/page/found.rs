//! [`findings`]: what a campaign has found, as the page shows it. Requirements have their findings in
//! [`crate::findings::requirement`]; of drivers, losses, missions and outcomes it takes the sentences of this layer.

use crate::analysis::drivers::{Question, Ranked, Ranking};
use crate::analysis::event::Event;
use crate::analysis::missions::MissionShare;
use crate::analysis::noise_share::NoiseShare;
use crate::analysis::order_statistics::share_interval;
use crate::analysis::population::Population;
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::survey::SurveyedOutcome;
use crate::campaign::Plan;
use crate::ensemble::FailureReason;
use crate::findings::{Figures, Finding, Findings, Kind, Number, names, requirement};
use crate::report::drivers_text::{self, ranked, refused, verb};
use crate::report::failure_text::{readable, remedy};
use crate::report::page::Analysis;
use crate::report::page::influence::part;
use crate::report::{mission_text, share_text, stopping_text};
use crate::statistics::quantile::percent;

/// Errors that are named in a sentence, each with what it is of.
const ERRORS: [(&str, &str); 4] = [
    ("energy_error_max", "energy"),
    ("angular_momentum_error_max", "angular momentum"),
    ("linear_momentum_error_max", "linear momentum"),
    ("state_error_estimate", "estimated state error"),
];

/// What `analysed` says of `plan`; `noise`: the share of noise in its outcomes, where that was measured.
pub fn findings(plan: &Plan, analysed: &Analysis<'_>, noise: &[NoiseShare]) -> Findings {
    let statistics = &analysed.statistics;
    let warning = |text: &String| {
        let (word, rest) = text.split_once(": ").unwrap_or(("", text));
        Finding::new(Kind::Warning, "warning", word, rest)
    };
    let note = |text: &String| {
        let (word, rest) = text.split_once(": ").unwrap_or(("", text));
        Finding::new(Kind::Note, "note", word, rest)
    };
    let mut list: Vec<Finding> = analysed.warnings.iter().map(warning).collect();
    list.extend(requirement::findings(plan, &analysed.verdicts, statistics));
    let together = requirement::together(&analysed.verdicts).into_iter();
    list.extend(together.map(|said| Finding::new(Kind::Verdicts, "together", "", said)));
    let stop = analysed.stopping.as_ref().map(|found| stopping_text::text(plan, found));
    list.extend(stop.map(|said| Finding::new(Kind::Stop, "stop", "", said)));
    list.push(losses(analysed));
    list.extend(missions(analysed));
    // why no driver was tested is said where drivers are
    let refused = refused(plan, analysed.sensitivities);
    list.extend(analysed.notes.iter().filter(|text| Some(*text) != refused.as_ref()).map(note));
    let outcomes = analysed.survey.outcomes.iter().filter(|outcome| outcome.is_outcome);
    list.extend(outcomes.filter_map(|outcome| of_outcome(plan, analysed, outcome)));
    list.extend(drivers(plan, analysed));
    let of_noise = noise.iter().map(|one| {
        let name = names::of_column(&one.observable, "");
        let said = share_text::of_noise(one);
        Finding { rank: 1, ..Finding::new(Kind::Driver, format!("noise_{}", one.observable), name, said) }
    });
    list.extend(of_noise);
    if plan.law.is_some() && noise.is_empty() && plan.rows() > 1 {
        let said = "noise in the loop is not an input; `spindrift report . --noise 256` measures its share";
        list.push(Finding::new(Kind::Driver, "noise", "", said));
    }
    list.extend(errors(analysed));
    Findings::new(list, statistics.confidence)
}

/// How many runs were computed, and below it why the others were not.
fn losses(analysed: &Analysis<'_>) -> Finding {
    let statuses = &analysed.survey.statuses;
    let (runs, ok) = (statuses.runs(), statuses.ok());
    let said = match (runs, ok) {
        (1, 1) => "the run was computed".to_owned(),
        (runs, ok) if runs == ok => format!("all {runs} runs were computed"),
        (runs, ok) => format!("{ok} of {runs} runs were computed"),
    };
    let reason = |one: &&FailureReason| {
        let which = if one.count == 1 { "" } else { "first " };
        let sentence = format!("{} ({which}sample {})", readable(&one.text).trim_end_matches('.'), one.first);
        let found = Finding::new(Kind::Loss, "reason", format!("{} {}", one.count, one.status.name()), sentence);
        let notes = remedy(one.status).map(str::to_owned).into_iter().collect();
        Finding { notes, sample: Some(one.first), ..found }
    };
    let children = statuses.reasons().groups().iter().map(reason).collect();
    Finding { children, ..Finding::new(Kind::Loss, "computed", "runs", said) }
}

/// How missions ended: a finding for each way; nothing without a loop.
fn missions(analysed: &Analysis<'_>) -> Vec<Finding> {
    let of = |one: &MissionShare| {
        let (ended, runs) = (mission_text::ended(one), one.runs);
        let said = match (one.end, one.count == runs) {
            ("not_failed", true) => format!("none of {runs} missions failed"),
            _ => format!("{} of {runs} missions {ended}: {}", one.count, mission_text::share(one)),
        };
        let number = Number::share("share of the missions", one.shares()[0], one.interval, runs);
        let found = Finding::new(Kind::Mission, format!("mission_{}", one.end), ended, said);
        Finding { numbers: vec![number], ..found }
    };
    let missing = mission_text::missing(&analysed.missions);
    let missing = missing.map(|said| Finding::new(Kind::Mission, "missing", "", said));
    analysed.missions.iter().map(of).chain(missing).collect()
}

/// How an outcome is distributed; `None` where no run has it.
fn of_outcome(plan: &Plan, analysed: &Analysis<'_>, outcome: &SurveyedOutcome) -> Option<Finding> {
    let (statistics, name) = (&analysed.statistics, outcome.quantity.name());
    let column: &ColumnStatistics = statistics.column(name)?;
    let moments = &column.moments;
    let count = moments.count();
    let known = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let [min, max] = [moments.min()?, moments.max()?];
    let shown = plan.analysis.display.of(name, outcome.quantity.unit()).of_time(max.abs(), None);
    let unit = outcome.quantity.unit();
    let number = |what: &str, value: f64, interval: [f64; 2]| Number::new(what, (value, interval), count, unit, &shown);
    let all = count + column.without_value;
    let of = if column.without_value > 0 { format!(" (in {count} of {all} runs)") } else { String::new() };
    let found = Finding::new(Kind::Outcome, name, format!("{}{of}", names::of_quantity(&outcome.quantity)), "");
    let (index, _) = analysed.survey.outcome(name)?;
    if plan.rows() == 1 {
        return Some(Finding { numbers: vec![number("value", max, [f64::NAN; 2])], ..found });
    }
    if outcome.is_yes_or_no(&analysed.survey.thinned.outcomes[index]) {
        let yes = libm::round(known(moments.mean()) * count as f64) as u64;
        let interval = match statistics.population {
            Population::Independent if column.without_value == 0 => {
                share_interval(yes, [count, statistics.loss().missing], statistics.confidence)
            }
            _ => [f64::NAN; 2],
        };
        let share = Number::share("yes", yes as f64 / count.max(1) as f64, interval, count);
        let sentence = format!("yes in {}", share.text());
        return Some(Finding { numbers: vec![share], sentence, ..found });
    }
    let mut quantiles: Vec<(f64, Number)> = (column.quantiles.iter())
        .map(|one| {
            let what = if one.p == 0.5 { "median".to_owned() } else { format!("p{}", percent(one.p)) };
            (one.p, number(&what, known(one.value), one.interval.map(known)))
        })
        .collect();
    quantiles.sort_by_key(|(p, _)| *p != 0.5);
    let mut numbers: Vec<Number> = quantiles.into_iter().map(|(_, number)| number).collect();
    numbers.extend([number("min", min, [f64::NAN; 2]), number("max", max, [f64::NAN; 2])]);
    let text = |name: &str| numbers.iter().find(|one| one.name == name).map(Number::text);
    let spread = match (text("p5"), text("p95")) {
        (Some(low), Some(high)) => format!("in 90% of the runs from {low} to {high}; "),
        _ => String::new(),
    };
    let ends = [min, max].map(|end| number("", end, [f64::NAN; 2]).text());
    Some(Finding { sentence: format!("{spread}the extremes are {} and {}", ends[0], ends[1]), numbers, ..found })
}

/// What decides the outcomes: those with a driver first, the strongest before others.
fn drivers(plan: &Plan, analysed: &Analysis<'_>) -> Vec<Finding> {
    let all = &analysed.sensitivities;
    let about = |id: &str, said: String| Finding::new(Kind::Driver, id, "", said);
    if let Some(why) = mission_text::all_failed(&analysed.missions) {
        return vec![about("all_fail", why)];
    }
    if let Some(why) = refused(plan, all) {
        return vec![about("untold", why)];
    }
    let mut found = Vec::new();
    for outcome in drivers_text::outcomes(plan, all) {
        found.extend(ranked(plan, all, outcome).iter().map(|ranking| driven(plan, analysed, outcome, ranking)));
    }
    // what was found before what was not, the strongest first
    let share = |one: &Finding| one.children.first().and_then(|driver| driver.numbers.first()).map(|share| share.value);
    let strength = |one: &Finding| share(one).filter(|share| share.is_finite()).unwrap_or(0.0);
    found.sort_by(|one: &Finding, other: &Finding| {
        let order = one.children.is_empty().cmp(&other.children.is_empty());
        order.then(strength(other).total_cmp(&strength(one)))
    });
    if found.iter().all(|one| one.children.is_empty()) && !found.is_empty() {
        let runs = analysed.survey.statuses.ok();
        let said = format!("no significant driver was found in {runs} runs that were computed");
        found.insert(0, about("no_driver", said));
    }
    found
}

fn driven(plan: &Plan, analysed: &Analysis<'_>, outcome: &str, ranking: &Ranking<'_>) -> Finding {
    let unit = analysed.statistics.column(outcome).map_or("", |column| column.quantity.unit());
    let name = names::of_column(outcome, unit);
    let which = |event: &Event| format!("{name}: which runs {}", verb(plan, outcome, event, u64::MAX));
    let (title, part) = match &ranking.question {
        Question::Spread => (name.clone(), String::new()),
        Question::Event(event) => (which(event), part(event)),
    };
    let driver = |ranked: &Ranked<'_>| {
        let input = &ranked.input.input;
        let figures = Figures { small: Some(format!("scatter_{outcome}_{input}")), large: None };
        let share = ranked.share.map(|share| {
            Number::share("share of the variance", share.value, [share.lower, share.upper], ranked.input.rows)
        });
        let found = Finding::new(Kind::Driver, input, names::of_input_column(plan, input), "");
        Finding { numbers: share.into_iter().collect(), figures, ..found }
    };
    let figures = Figures { small: None, large: Some(format!("influence_{outcome}{part}")) };
    let said = drivers_text::sentence(plan, outcome, ranking);
    let found = Finding::new(Kind::Driver, format!("drivers_{outcome}{part}"), title, said);
    Finding { children: ranking.drivers().map(driver).collect(), rank: 1, figures, ..found }
}

/// The largest errors of the balances and of the state; `None` where none was observed.
fn errors(analysed: &Analysis<'_>) -> Option<Finding> {
    let largest = |(name, of): &(&str, &str)| {
        let column = analysed.statistics.column(name)?;
        let value = (column.moments.max()?, [f64::NAN; 2]);
        Some(Number::new(of, value, column.moments.count(), "", &crate::campaign::ShownUnit::own("")))
    };
    let numbers: Vec<Number> = ERRORS.iter().filter_map(largest).collect();
    let said: Vec<String> = numbers.iter().map(|one| format!("{} {}", one.name, one.text())).collect();
    let found = Finding::new(Kind::Numerics, "errors", "largest errors, relative", said.join(", "));
    (!numbers.is_empty()).then_some(Finding { numbers, rank: 1, ..found })
}
