//! What drives an outcome, in words: on the screen and on the cards of the page.

use crate::analysis::drivers::drivers;
use crate::analysis::sensitivity::InputSensitivity;
use crate::campaign::Plan;
use crate::statistics::correlation::Estimate;

/// Inputs that are named.
const NAMED: usize = 2;

/// The observables of `all` whose drivers are shown: the outcomes of the campaign.
pub fn outcomes<'a>(plan: &Plan, all: &'a [InputSensitivity]) -> Vec<&'a str> {
    let mut names: Vec<&str> = all.iter().map(|one| one.observable.as_str()).collect();
    names.dedup();
    let order = crate::analysis::outcomes::outcomes(plan);
    let place = |name: &&str| order.iter().position(|outcome| outcome == name);
    names.retain(|name| place(name).is_some());
    names.sort_by_key(place);
    names
}

/// The strongest inputs of an outcome, with their share of its variance and the direction; empty where no influence was estimated.
pub fn driven_by(all: &[InputSensitivity], outcome: &str) -> String {
    let mut of = all.iter().filter(|one| one.observable == outcome && one.influence().is_some());
    let Some(first) = of.next() else { return String::new() };
    let found = drivers(all, outcome);
    if found.is_empty() {
        return "no input with an influence that these runs can show".to_owned();
    }
    let name = |(one, influence): &(&InputSensitivity, Estimate)| {
        let direction = match one.rises() {
            Some(true) => ", rises with it",
            Some(false) => ", falls with it",
            None => "",
        };
        format!("{} ({:.2}{direction})", one.input, influence.value)
    };
    let names: Vec<String> = found.iter().take(NAMED).map(name).collect();
    let measure = if first.total.is_some() { "total Sobol index" } else { "share of the variance" };
    format!("{}; {measure}", names.join(", "))
}

/// A line for each outcome; nothing where no influence was estimated.
pub fn text(plan: &Plan, all: &[InputSensitivity]) -> String {
    let outcomes = outcomes(plan, all);
    let width = outcomes.iter().map(|outcome| outcome.len()).max().unwrap_or(0);
    let lines = outcomes.iter().map(|outcome| (outcome, driven_by(all, outcome))).filter(|(_, text)| !text.is_empty());
    let text: String = lines.map(|(outcome, drivers)| format!("  {outcome:<width$}  {drivers}\n")).collect();
    if text.is_empty() { text } else { format!("\n  driven by\n{text}") }
}
