//! The first screen: header, run status, verdicts. Static HTML, readable before any script and without.

use crate::analysis::missions::Missions;
use crate::analysis::survey::Survey;
use crate::campaign::Plan;
use crate::findings::names::sentence;
use crate::report::escaped::escaped;
use crate::report::failure_text::{readable, status_words};
use crate::report::mission_text;
use crate::report::page::cards::{Card, Judged, overall};
use crate::report::page::readable::{grouped, number};
use crate::report::requirements;
use crate::run::Status;

/// A requirement as an example, where the file has none.
const EXAMPLE: &str =
    "[[require]]\nobservable = \"energy_error_max\"\nquantile = 0.99\nat_most = 1e-9\nconfidence = 0.95";

/// Name with the verdict, question, and the facts of the campaign.
///
/// `has_intervals`: whether the page has numbers in brackets, which are said here once for all of it.
pub fn header(plan: &Plan, verdicts: &[Card], survey: &Survey, has_intervals: bool) -> String {
    let dispersed = plan.dispersed_rows();
    let runs = if plan.chosen.is_some() {
        format!("{} chosen runs of {} samples", grouped(plan.rows()), grouped(plan.samples))
    } else if dispersed == 0 {
        "1 run, the nominal one".to_owned()
    } else {
        format!("{} dispersed runs and the nominal one", grouped(dispersed))
    };
    let steps = match plan.step_s {
        Some(step) => format!("steps of {} s", number(step)),
        None => format!("tolerance {}", number(plan.tolerance.relative)),
    };
    let hash = plan.hash();
    let question = plan
        .description
        .as_deref()
        .map_or(String::new(), |text| format!("<p class=\"question\">{}</p>", escaped(&sentence(text))));
    let intervals = match has_intervals {
        true => format!(" \u{b7} in brackets: {}", requirements::intervals(plan.analysis.confidence)),
        false => String::new(),
    };
    format!(
        "<h1>{}{}</h1>{question}\n<p class=\"facts\">{runs} \u{b7} design {} \u{b7} seed {} \u{b7} {} s each \u{b7} method {}, {steps} \u{b7} spindrift {} \u{b7} plan <button type=\"button\" class=\"hash\" data-copy=\"{hash}\" title=\"Copy the whole hash\">{}</button>{intervals}</p>\n",
        escaped(&plan.name),
        if verdicts.is_empty() { lost(survey) } else { verdict(verdicts) },
        escaped(plan.design.name()),
        plan.seed,
        number(plan.grid.duration()),
        escaped(plan.method.name()),
        env!("CARGO_PKG_VERSION"),
        &hash[..8],
    )
}

/// The verdict on all requirements, and how many have each; nothing without any.
fn verdict(verdicts: &[Card]) -> String {
    let Some(overall) = overall(verdicts) else { return String::new() };
    let count = |judged: Judged| verdicts.iter().filter(|card| card.judged == judged).count();
    let of = |judged: Judged| (count(judged) > 0).then(|| format!("{} {}", count(judged), judged.word()));
    let counts: Vec<String> = [Judged::Pass, Judged::Fail, Judged::Undecided].into_iter().filter_map(of).collect();
    format!(
        " <span class=\"overall {}\">{}</span> <span class=\"quiet counts\">{}</span>",
        overall.class(),
        overall.word(),
        counts.join(", ")
    )
}

/// What is said in place of a verdict where most runs were not computed.
pub const NOT_COMPUTED: &str = "NOT COMPUTED";

/// Whether fewer than half of the runs were computed.
pub fn is_mostly_lost(survey: &Survey) -> bool {
    2 * survey.statuses.ok() < survey.statuses.runs()
}

/// How many runs were not computed, where these are most, in place of a verdict.
fn lost(survey: &Survey) -> String {
    if !is_mostly_lost(survey) {
        return String::new();
    }
    let (ok, all) = (survey.statuses.ok(), survey.statuses.runs());
    format!(
        " <span class=\"overall fail\">{NOT_COMPUTED}</span> <span class=\"quiet counts\">{} of {} runs</span>",
        grouped(all - ok),
        grouped(all)
    )
}

/// What drives the first outcome for which that is known, in a sentence, unless all missions fail; nothing where it is not.
pub fn drivers(cards: &[Card], missions: &Missions) -> String {
    if let Some(why) = mission_text::all_failed(missions) {
        return format!("<p id=\"drivers\"><b>What drives failures:</b> {why}.</p>\n");
    }
    let found = cards.iter().find(|card| !card.drivers.is_empty());
    found.map_or_else(String::new, |card| {
        let (first, _) = card.drivers.split_once(". Spread: ").unwrap_or((&card.drivers, ""));
        format!(
            "<p id=\"drivers\"><b>What drives it:</b> {}: {}. <a href=\"#influence\">More</a></p>\n",
            escaped(&card.quantity),
            escaped(first)
        )
    })
}

/// What the numbers leave unsaid, a paragraph each.
pub fn notes(notes: &[String]) -> String {
    notes.iter().map(|note| format!("<p class=\"note\"><b>Note:</b> {}.</p>\n", escaped(note))).collect()
}

/// What comes before every number; nothing where there is no warning.
pub fn warnings(warnings: &[String]) -> String {
    let line = |text: &String| {
        let (word, rest) = text.split_once(':').unwrap_or(("", text));
        format!("<p><b>{}:</b>{}.</p>", escaped(word), escaped(rest))
    };
    let lines: String = warnings.iter().map(line).collect();
    if lines.is_empty() { lines } else { format!("<section id=\"warnings\" role=\"alert\">{lines}</section>\n") }
}

/// The stacked bar of statuses with their counts, the first reason, and the command that replays it.
pub fn status(plan: &Plan, survey: &Survey) -> String {
    let (ok, all) = (survey.statuses.ok(), survey.statuses.runs());
    let (mut x, mut bars, mut legend) = (0.0, String::new(), String::new());
    for ended in survey.statuses.list().iter().filter(|ended| ended.count > 0 || ended.status == Status::Done) {
        let share = 100.0 * ended.count as f64 / all.max(1) as f64;
        let class = ended.status.name();
        // a few runs among a million are still seen
        let width = if ended.count > 0 { share.max(0.6) } else { 0.0 };
        bars += &format!(
            "<rect class=\"status {class}\" x=\"{x:.3}%\" y=\"0\" width=\"{width:.3}%\" height=\"22\"><title>{}: {}</title></rect>",
            status_words(ended.status),
            grouped(ended.count)
        );
        x += width;
        let percent = if ended.count == all { "all".to_owned() } else { format!("{}%", number(share)) };
        legend += &format!(
            "<li><svg class=\"key\" viewBox=\"0 0 14 14\" aria-hidden=\"true\"><rect class=\"status {class}\" width=\"14\" height=\"14\"/></svg><b>{}</b> {} <span class=\"quiet\">({percent})</span></li>",
            grouped(ended.count),
            status_words(ended.status),
        );
    }
    let reasons: String = survey
        .statuses
        .failed()
        .filter_map(|ended| ended.first.first().map(|first| (ended, first)))
        .map(|(ended, (sample, reason))| {
            format!(
                "<p class=\"reason\"><b>{}</b> first in sample {sample}: {}. Replay in this folder: <code>spindrift simulate plan.toml --sample {sample}</code></p>",
                status_words(ended.status),
                escaped(readable(reason).trim_end_matches('.')),
            )
        })
        .collect();
    let verdict = match (ok, all) {
        (ok, all) if ok == all => {
            if all == 1 {
                "The run was computed.".to_owned()
            } else {
                format!("All {} runs were computed.", grouped(all))
            }
        }
        (0, all) => format!("None of {} runs was computed: there are no statistics.", grouped(all)),
        (ok, all) => {
            let nominal = if survey.statuses.has_nominal() { ", the nominal one among them" } else { "" };
            let of = if plan.dispersed_rows() > 0 { "dispersed ones" } else { "others" };
            format!(
                "{} of {} runs were computed{nominal}; the statistics below are of the {of}.",
                grouped(ok),
                grouped(all)
            )
        }
    };
    if ok == all {
        // nothing to tell apart
        return format!("<section id=\"status\"><p class=\"lead\">{verdict}{}</p></section>\n", numerics(plan, survey));
    }
    format!(
        "<section id=\"status\"><h2>Did it run?</h2><p class=\"lead\">{verdict}{}</p><svg class=\"statusbar\" role=\"img\" aria-label=\"{verdict}\" preserveAspectRatio=\"none\" height=\"22\" width=\"100%\">{bars}</svg><ul class=\"legend\">{legend}</ul>{reasons}</section>\n",
        numerics(plan, survey)
    )
}

/// How the missions of a control loop ended: a bar for each way, with its interval; nothing without a loop. `nominal` is how that of the nominal run did, in words.
pub fn missions(missions: &Missions, nominal: Option<&str>) -> String {
    let mut lines = String::new();
    if let [only] = &missions[..]
        && only.end == "not_failed"
        && only.missing == 0
    {
        return String::new();
    }
    for one in missions {
        let at = |share: f64| format!("{:.3}%", 100.0 * share);
        let [share, _] = one.shares();
        let class = match one.end {
            "launched" | "not_failed" => "ok",
            "flying" => "flying",
            _ => "failed",
        };
        let [low, high] = one.interval;
        let whisker = if low.is_finite() {
            format!("<line class=\"whisker\" x1=\"{}\" x2=\"{}\" y1=\"11\" y2=\"11\"/>", at(low), at(high))
        } else {
            String::new()
        };
        lines += &format!(
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"bar\"><svg width=\"100%\" height=\"22\" role=\"img\" aria-label=\"{}\"><rect class=\"mission {class}\" x=\"0\" y=\"3\" width=\"{}\" height=\"16\"/>{whisker}</svg></td></tr>",
            escaped(&mission_text::ended(one)),
            grouped(one.count),
            mission_text::share(one),
            escaped(&mission_text::share(one)),
            at(share),
        );
    }
    if lines.is_empty() {
        return lines;
    }
    format!(
        "<section id=\"missions\"><h2>How did the missions end?</h2><table class=\"missions\"><thead><tr><th>end</th><th>runs</th><th>share</th><th></th></tr></thead><tbody>{lines}</tbody></table><p class=\"caption\">Of the dispersed runs{}. The nominal run has no sensor noise; its {}.</p></section>\n",
        mission_text::missing(missions).map_or_else(String::new, |note| format!("; {}", escaped(&note))),
        escaped(nominal.unwrap_or("mission did not end before the run did"))
    )
}

/// The errors of the balances and of the state that are named in a sentence, each with what it is of.
const ERRORS: [(&str, &str); 3] = [
    ("energy_error_max", "energy"),
    ("angular_momentum_error_max", "angular momentum"),
    ("state_error_estimate", "estimated state error"),
];

/// How well it was computed, in a sentence; empty where no error was observed.
fn numerics(plan: &Plan, survey: &Survey) -> String {
    let largest = |(name, of): &(&str, &str)| Some(format!("{of} {}", number(survey.outcome(name)?.1.sketch.max()?)));
    let errors: Vec<String> = ERRORS.iter().filter_map(largest).collect();
    if errors.is_empty() {
        return String::new();
    }
    let judged = if is_above_tolerance(plan, survey) {
        ": <b>above what the tolerance promises</b>, see <a href=\"#numerics\">Numerics</a>"
    } else {
        ""
    };
    format!(" Largest relative errors: {}{judged}.", errors.join(", "))
}

/// Whether the balance of any run is off by more than the tolerance that its method follows explains, or the error of its state is estimated to be seen.
pub fn is_above_tolerance(plan: &Plan, survey: &Survey) -> bool {
    /// A thousandth of a degree.
    const SEEN: f64 = 2e-5;
    /// The tolerance bounds the error of one step, and a balance shows what all steps of a run have left. In the worst of 1,000 runs of `assets/start.toml`,
    /// of five steps each, that is 1.2 to 2.7 times the tolerance, for tolerances of 1e-15 to 1e-12. The roundings of N steps leave about
    /// 3e-16 sqrt(N) (`tests/accuracy/round_off.rs`): ten times 1e-14 after 1e5 steps.
    const STEPS: f64 = 10.0;
    let tolerance = if plan.method.has_fixed_step() { SEEN } else { STEPS * plan.tolerance.relative };
    survey.outcomes.iter().filter(|outcome| outcome.is_error).any(|outcome| {
        let limit = if outcome.quantity.name().ends_with("estimate") { SEEN } else { tolerance };
        outcome.sketch.max().is_some_and(|max| max > limit)
    })
}

/// The cards, and what they `said` together; an example of a requirement where there is none.
pub fn verdicts(cards: &[Card], has_requirements: bool, said: &[String]) -> String {
    let cards = match cards {
        [] => "<p>No results: no dispersed run produced a value for any outcome.</p>".to_owned(),
        cards => cards.iter().map(Card::html).collect(),
    };
    let said: String =
        said.iter().map(|text| format!("<p class=\"quiet\">{}.</p>", escaped(&sentence(text)))).collect();
    let said = if said.is_empty() {
        said
    } else {
        format!("<details><summary>How to read these verdicts together</summary>{said}</details>")
    };
    let (title, example) = if has_requirements {
        ("Are the requirements met?", String::new())
    } else {
        let text = format!(
            "<details class=\"example\"><summary>The campaign file has no requirement. Add one to get a verdict here</summary><pre><code>{}</code></pre></details>",
            escaped(EXAMPLE)
        );
        ("What was found?", text)
    };
    format!("<section id=\"verdicts\"><h2>{title}</h2><div class=\"cards\">{cards}</div>{said}{example}</section>\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::population::Population;
    use crate::analysis::statuses::Statuses;
    use crate::analysis::survey::Thinned;
    use crate::campaign::Overrides;
    use crate::ode::Integrator;
    use crate::propagation::Method;
    use crate::report::page::runs::ShownRun;
    use crate::report::page::tables::worst_runs;
    use crate::sampling::SampleId;

    /// Law: where no run has an outcome there is no card, and the page says so.
    #[test]
    fn without_outcomes_there_is_no_card() {
        let text = verdicts(&[], false, &[]);
        assert!(text.contains("No results: no dispersed run") && !text.contains("<article"), "{text}");
    }

    /// Law: a reason is text, whatever is in it, at the head of the page and in the list of worst runs.
    #[test]
    fn reasons_are_text() {
        const REASON: &str = "a law said: rate < 0 & <img src=x onerror=alert(1)>";
        const ESCAPED: &str = "a law said: rate &lt; 0 &amp; &lt;img src=x onerror=alert(1)&gt;";
        let text = include_str!("../../../campaigns/spin_sweep.toml");
        let plan = Plan::from_text("spin_sweep", text, Overrides::default()).expect("valid");
        let mut statuses = Statuses::none(Population::Independent);
        statuses.add(SampleId(3), Status::InternalError, REASON);
        let survey =
            Survey { statuses, outcomes: Vec::new(), thinned: Thinned::default(), audits: Vec::new(), audited: 0 };
        let run = ShownRun {
            sample: SampleId(3),
            why: "failed".to_owned(),
            status: Status::InternalError,
            reason: REASON.to_owned(),
            inputs: Vec::new(),
            row: Vec::new(),
            run: None,
        };
        for html in [status(&plan, &survey), worst_runs(&plan, &survey, &[run])] {
            assert!(html.contains(ESCAPED) && !html.contains("<img"), "{html}");
        }
    }

    /// Law: the facts of a campaign name its tolerance, or the length of its steps where these are fixed.
    #[test]
    fn a_tolerance_is_that_of_a_method_that_follows_it() {
        let text = include_str!("../../../campaigns/spin_sweep.toml");
        let plan = Plan::from_text("spin_sweep", text, Overrides::default()).expect("valid");
        let statuses = Statuses::none(Population::Independent);
        let survey =
            Survey { statuses, outcomes: Vec::new(), thinned: Thinned::default(), audits: Vec::new(), audited: 0 };
        let adaptive = header(&plan, &[], &survey, true);
        assert!(adaptive.contains("method auto, tolerance ") && !adaptive.contains("steps of"), "{adaptive}");
        let fixed = header(
            &Plan { method: Method::Gyrostat(Integrator::RungeKutta4), step_s: Some(0.25), ..plan },
            &[],
            &survey,
            false,
        );
        assert!(fixed.contains("runge_kutta_4, steps of 0.25") && !fixed.contains("tolerance"), "{fixed}");
        let said = "in brackets: two-sided 95% intervals";
        assert!(adaptive.contains(said) && !fixed.contains("brackets"), "{adaptive}{fixed}");
    }
}
