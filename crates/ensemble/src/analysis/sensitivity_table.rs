//! `sensitivity.parquet`: one row per pair of observable and input.

use crate::analysis::effects::{Dependence, Direction, OnEvent};
use crate::analysis::input_sensitivity::InputSensitivity;
use crate::statistics::correlation::Estimate;
use crate::table::Table;

type Measure = (&'static str, &'static str, fn(&InputSensitivity) -> Option<Estimate>);

type EstimatePart = (&'static str, &'static str, fn(Estimate) -> f64);

const PARTS: [EstimatePart; 3] = [
    ("", "", |estimate| estimate.value),
    ("_lower", ": lower end of its interval", |estimate| estimate.lower),
    ("_upper", ": upper end of its interval", |estimate| estimate.upper),
];

const MEASURES: [Measure; 9] = [
    ("pearson", "Pearson's correlation coefficient", |one| one.pearson),
    ("spearman", "Spearman's rank correlation coefficient", |one| one.spearman),
    ("partial_rank", "Partial rank correlation coefficient, the other inputs held fixed", |one| one.partial_rank),
    ("regression", "Standardised regression coefficient", |one| one.regression),
    (
        "r_squared",
        "Share of the variance that the regression on all inputs explains, corrected for their number",
        |one| one.r_squared,
    ),
    (
        "first_order",
        "First-order sensitivity index, the share of the variance of this input alone; an interval from 0 to 1 means \
         that it is unknown",
        |one| one.first_order,
    ),
    ("total", "Total sensitivity index, with the interactions of this input", |one| one.total),
    ("event_share", "Share of the variance of whether the event of the observable occurs", |one| {
        one.on_events.first().and_then(|effect| effect.share)
    }),
    (
        "event_ratio",
        "Risk ratio of the event at event_level against the other runs, by Koopman's score test; null if the input has \
        many values, if the event occurs in no other run, and at an end without a bound",
        |one| match one.on_events.first()?.dependence {
            Dependence::Levels { ratio, .. } => {
                let [value, lower, upper] =
                    [ratio.value, ratio.lower, ratio.upper].map(|end| if end.is_finite() { end } else { f64::NAN });
                Some(Estimate { value, lower, upper })
            }
            _ => None,
        },
    ),
];

pub fn table(list: &[InputSensitivity]) -> Table<'_> {
    let on_event = |one: &InputSensitivity, of: fn(&OnEvent) -> Option<f64>| one.on_events.first().and_then(of);
    let mut table = Table::of(list);
    table
        .text("observable", "Name of the observable.", |one| Some(&*one.observable))
        .text("input", "Column of the input; of a saltelli design what one distribution disperses.", |one| {
            Some(&*one.input)
        })
        .count("rows", "Number of rows: the first that are ok.", |one| one.rows);
    for (name, meaning, of) in MEASURES {
        for (suffix, what, part) in PARTS {
            table.real(&format!("{name}{suffix}"), &format!("{meaning}{what}."), |one| of(one).map(part));
        }
    }
    table
        .real(
            "p_value",
            "Probability of an influence on the spread as strong as this one where no input has any, of all inputs \
             together (Holm).",
            |one| one.p_value,
        )
        .text("direction", "How the observable goes with the input, where it is a driver of the spread.", |one| {
            Some(match one.direction? {
                Direction::Rises => "rises",
                Direction::Falls => "falls",
                Direction::NotMonotonic => "not_monotonic",
            })
        })
        .text(
            "event",
            "What occurs in some runs: missed (the first requirement that some miss), value, other_value, worst (the \
             tail).",
            |one| Some(one.on_events.first()?.event.occurs.name()),
        )
        .real("event_runs", "In how many runs it occurs.", |one| on_event(one, |on| Some(on.event.of.events as f64)))
        .real(
            "event_p_value",
            "Probability of a dependence of the event as strong as this one where it depends on no input, of all \
             inputs together (Holm).",
            |one| on_event(one, |on| Some(on.p_value)),
        )
        .real(
            "event_level",
            "Value of an input with few values at which the event differs most from the other runs; null for all \
             values but the most frequent one.",
            |one| {
                on_event(one, |on| match &on.dependence {
                    Dependence::Levels { levels, most, .. } => levels[*most].value,
                    _ => None,
                })
            },
        )
        .real(
            "event_chance",
            "For an input with many values, the chance that a run with the event has the larger one; null if the event \
             comes with distance from the median.",
            |one| {
                on_event(one, |on| match on.dependence {
                    Dependence::Shift { chance, .. } => Some(chance),
                    _ => None,
                })
            },
        )
        .text("correlated_with", "The input that this one is most correlated with, where that is notable.", |one| {
            one.correlated_with.as_ref().map(|(name, _)| &**name)
        })
        .real("largest_correlation", "Rank correlation of the two.", |one| {
            one.correlated_with.as_ref().map(|(_, r)| *r)
        })
        .text("note", "What to know about these numbers.", |one| one.note.as_deref())
        .finish()
}
