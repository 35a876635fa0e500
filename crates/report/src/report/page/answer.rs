//! The first screen of the page as static HTML: name, verdict, warnings, and a table of requirements, or of outcomes if
//! nothing is required.

use crate::analysis::survey::Survey;
use crate::campaign::{Plan, Requirement, Statement};
use crate::findings::names::sentence;
use crate::findings::number::{duration, trimmed, typeset, unbroken};
use crate::findings::numerics::WORST_RUN;
use crate::findings::requirement::limit_text;
use crate::findings::{Finding, Findings, Kind, Verdict};
use crate::report::figure::Figure;
use crate::report::page::pictures::{self, HATCH};
use crate::statistics::gate::GateLimit;
use crate::table::html::escaped;

const EXAMPLE: &str = "[[require]]\nobservable = \"energy_error_max\"\nquantile = 0.99\nat_most = 1e-9";
const MOST_OUTCOMES: usize = 8;
pub const FOUND: &str = "What was found";

/// A text of a finding as HTML.
pub fn text(said: &str) -> String {
    escaped(&unbroken(&typeset(said)))
}

/// A sentence of a finding as HTML with its full stop; keys become code.
pub fn full(said: &str) -> String {
    coded(sentence(said).trim_end_matches('.')) + "."
}

/// A text as HTML, in which keys, and what stands in backticks, become code.
fn coded(said: &str) -> String {
    let quoted: Vec<&str> = said.split('`').collect();
    let code = |(place, part): (usize, &&str)| match place % 2 {
        1 if place + 1 < quoted.len() => format!("<code>{}</code>", escaped(part)),
        _ => with_keys(part),
    };
    quoted.iter().enumerate().map(code).collect()
}

fn with_keys(said: &str) -> String {
    let said = text(said);
    let word = |word: &str| {
        // escaped quotation marks are no part of a key
        let parts =
            word.split(['&', ';']).map(|part| part.trim_matches(|letter: char| !letter.is_ascii_alphanumeric()));
        // frames such as F_e, abbreviations such as e.g. and numbers are no keys
        let is_name = |word: &str| word.len() > 1 && word.bytes().all(|letter| letter.is_ascii_lowercase());
        let is_dotted = |part: &str| part.contains('.') && part.split('.').all(is_name);
        let is_key = |part: &&str| part.contains('_') && part.len() > "omega_es".len() || is_dotted(part);
        match parts.into_iter().find(is_key) {
            Some(key) => word.replace(key, &format!("<code>{key}</code>")),
            None => word.to_owned(),
        }
    };
    said.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// The shape of a verdict: a disc with a tick, a square with a cross, a diamond with a question mark.
const fn shape(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => r#"<circle cx="12" cy="12" r="11"/><path class="sign" d="M6 12.5l4 4 8-9"/>"#,
        Verdict::Fail => {
            r#"<rect x="1.5" y="1.5" width="21" height="21" rx="2"/><path class="sign" d="M7 7l10 10M17 7L7 17"/>"#
        }
        Verdict::Undecided => {
            concat!(
                r#"<path d="M12 0.5L23.5 12L12 23.5L0.5 12z"/>"#,
                r#"<path class="sign" d="M9 10c0-4 6-4 6-1c0 2-3 2-3 4.5M12 16.2v1.2"/>"#
            )
        }
    }
}

const fn class(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "pass",
        Verdict::Fail => "fail",
        Verdict::Undecided => "undecided",
    }
}

/// For the browser's tab: the overall verdict, or that most runs have no numbers.
pub fn word(found: &Findings, survey: &Survey) -> Option<&'static str> {
    let lost = is_mostly_lost(survey).then_some("NOT COMPUTED");
    found.verdict.map(Verdict::word).or(lost)
}

fn is_mostly_lost(survey: &Survey) -> bool {
    2 * survey.statuses.ok() < survey.statuses.runs()
}

/// Name with the verdict, question, and the facts of the campaign.
pub fn header(plan: &Plan, found: &Findings, survey: &Survey) -> String {
    let dispersed = plan.dispersed_rows();
    let runs = match (&plan.chosen, dispersed) {
        (Some(_), _) => format!("{} chosen runs of {} samples", plan.rows(), plan.samples),
        (None, 0) => "1 run, the nominal one".to_owned(),
        (None, _) => format!("{dispersed} dispersed runs and the nominal one"),
    };
    let steps = match plan.step_s {
        Some(step) => format!("steps of {} s", trimmed(step, 4)),
        None => format!("tolerance {}", trimmed(plan.tolerance.relative, 4)),
    };
    let verdicts: Vec<Verdict> = found.of(Kind::Requirement).filter_map(|one| one.verdict).collect();
    let count = |verdict: Verdict| verdicts.iter().filter(|one| **one == verdict).count();
    let of = |verdict: Verdict| (count(verdict) > 0).then(|| format!("{} {}", count(verdict), verdict.word()));
    let counts: Vec<String> = [Verdict::Pass, Verdict::Fail, Verdict::Undecided].into_iter().filter_map(of).collect();
    let (class, counts) = match found.verdict {
        Some(verdict) => (class(verdict), counts.join(", ")),
        None => {
            ("fail", format!("{} of {} runs", survey.statuses.runs() - survey.statuses.ok(), survey.statuses.runs()))
        }
    };
    let verdict = word(found, survey).map_or_else(String::new, |word| {
        format!(" <span class=\"overall {class}\">{word}</span> <span class=\"quiet counts\">{counts}</span>")
    });
    let question = plan.description.as_deref();
    let question =
        question.map_or_else(String::new, |said| format!("<p class=\"question\">{}</p>", coded(&sentence(said))));
    let hash = plan.hash();
    let duration = duration(plan.grid.duration());
    let (each, design) = match plan.samples {
        1 => ("", String::new()),
        _ => (" each", format!("{} design, ", plan.design.name())),
    };
    let facts = [
        runs,
        format!("{duration}{each}"),
        format!("{design}seed {}", plan.seed),
        format!("method {}, {steps}", plan.method.name()),
        format!("spindrift {}", env!("CARGO_PKG_VERSION")),
    ];
    let brackets = found.brackets().map_or_else(String::new, |said| format!(" \u{b7} in brackets: {}", text(&said)));
    format!(
        "<h1>{}{verdict}</h1>{question}\n<p class=\"facts\">{} \u{b7} plan <button type=\"button\" class=\"hash\" \
         data-copy=\"{hash}\" title=\"Copy the whole hash\">{}</button>{brackets}</p>{}\n",
        escaped(&plan.name),
        facts.map(|fact| text(&fact)).join(" \u{b7} "),
        &hash[..8],
        look(found),
    )
}

fn look(found: &Findings) -> String {
    let worst = found.of(Kind::Runs).find(|one| one.rank == 0 && one.id == WORST_RUN);
    worst.and_then(|one| one.sample.map(|sample| (one, sample))).map_or_else(String::new, |(one, sample)| {
        format!("<p class=\"look\"><a href=\"#replay\">{}: sample {sample}</a></p>", text(&sentence(&one.title)))
    })
}

/// Warnings, and the lost runs with reasons and replay commands.
pub fn first(found: &Findings) -> String {
    let warning = |one: &Finding| format!("<p><b>{}:</b> {}</p>", escaped(&one.title), full(&one.sentence));
    let mut lines: String = found.of(Kind::Warning).map(warning).collect();
    for lost in found.of(Kind::Loss).filter(|one| !one.children.is_empty()) {
        let reasons: Vec<String> = lost.children.iter().map(reason).collect();
        let count = full(&lost.sentence);
        lines += &format!("<p class=\"reason\">{count} {}</p>", reasons.join("</p><p class=\"reason\">"));
    }
    if lines.is_empty() { lines } else { format!("<section id=\"warnings\" role=\"alert\">{lines}</section>\n") }
}

fn reason(one: &Finding) -> String {
    let notes: String = one.notes.iter().map(|note| format!(" {}", full(note))).collect();
    let command = one.command("plan.toml");
    let command = command.map(|command| format!(" To replay it, in this folder: <code>{}</code>", escaped(&command)));
    format!(
        "<b>{}</b>: {}.{notes}{}",
        text(&one.title),
        text(one.sentence.trim_end_matches('.')),
        command.unwrap_or_default()
    )
}

struct Row<'f> {
    finding: &'f Finding,
    outcome: Option<&'f Finding>,
    /// The large figure: of the outcome, or over time for a band.
    figure: Option<&'f Figure>,
    /// The limit of single runs, and its name in the figure.
    limit: Option<(GateLimit, String)>,
    /// True if no single run can violate the requirement.
    is_of_mean: bool,
    drivers: Vec<&'f Finding>,
}

impl<'f> Row<'f> {
    fn of(plan: &Plan, found: &'f Findings, finding: &'f Finding, figures: &'f [Figure]) -> Self {
        let place = finding.id.strip_prefix("requirement_").and_then(|place| place.parse::<usize>().ok());
        let requirement = place.and_then(|place| plan.analysis.requirements.get(place - 1));
        let name = requirement.map_or(finding.id.as_str(), |one| one.observable().unwrap_or(one.name()));
        let over_time = requirement.map_or(name, |one| one.name());
        let called = [format!("histogram_{name}"), format!("share_{name}"), name.to_owned(), over_time.to_owned()];
        let ranking = format!("drivers_{name}");
        let is_of_it = |one: &&Finding| {
            one.id.strip_prefix(&ranking).is_some_and(|rest| rest.is_empty() || rest.starts_with("_event"))
        };
        let outcome = found.of(Kind::Outcome).find(|one| one.id == name);
        let of_runs = |one: &Requirement| {
            let unit = outcome.and_then(|outcome| outcome.numbers.first()).map_or("", |number| &number.unit);
            (one.limit, typeset(&limit_text(one.limit, &plan.analysis.display.of(name, unit))))
        };
        Row {
            finding,
            outcome,
            figure: called.iter().find_map(|called| figures.iter().find(|figure| figure.name == *called)),
            limit: requirement.filter(|one| one.statement != Statement::Mean).map(of_runs),
            is_of_mean: requirement.is_some_and(|one| one.statement == Statement::Mean),
            drivers: found.of(Kind::Driver).filter(is_of_it).filter(|one| !one.title.is_empty()).collect(),
        }
    }

    fn judged(&self) -> String {
        let Some(verdict) = self.finding.verdict else { return String::new() };
        format!(
            "<svg class=\"verdict\" viewBox=\"0 0 24 24\" aria-hidden=\"true\">{}</svg><b class=\"word\">{}</b>",
            shape(verdict),
            verdict.word()
        )
    }

    fn found(&self) -> String {
        let Some(number) = self.finding.numbers.first() else { return String::new() };
        let said = number.text();
        let (value, rest) =
            said.split_once(" [").map_or((said.as_str(), String::new()), |(value, rest)| (value, format!("[{rest}")));
        // the assumption of a verdict on a mean, or the bound on one side that decides where the interval does not
        let is_decided = matches!(self.finding.verdict, Some(Verdict::Pass | Verdict::Fail));
        let why = self.finding.notes.first().filter(|_| self.is_of_mean || is_decided);
        // the only number of a single run needs no name
        let name = Some(&number.name).filter(|name| (self.is_of_mean || why.is_none()) && *name != "value");
        let below = name.into_iter().chain(why);
        let below: String = below.map(|line| format!("<br><span class=\"quiet\">{}</span>", text(line))).collect();
        format!("<b>{}</b> <span class=\"quiet\">{}</span>{below}", text(value), text(&rest))
    }

    fn picture(&self) -> String {
        let yes = self.outcome.and_then(|one| one.number("yes"));
        let picture = match (yes, self.figure) {
            (Some(yes), _) => pictures::shares(yes),
            (None, Some(figure)) => pictures::histogram(figure, self.limit.as_ref(), None),
            (None, None) => String::new(),
        };
        let below = self.outcome.map_or_else(String::new, pictures::said_of);
        let below = if below.is_empty() { below } else { format!("<span class=\"quiet\">{}</span>", escaped(&below)) };
        picture + &below
    }

    fn html(&self, pictures: &str) -> String {
        let finding = self.finding;
        let line = |said: String| format!("<p class=\"detail\">{said}</p>");
        let mut details: String = Some(&finding.sentence)
            .into_iter()
            .filter(|said| !said.is_empty())
            .chain(&finding.notes)
            .map(|said| line(full(said)))
            .collect();
        let driver = |one: &&Finding| line(format!("<b>{}:</b> {}", text(&sentence(&one.title)), full(&one.sentence)));
        details += &self.drivers.iter().map(driver).collect::<String>();
        if let Some(figure) = self.figure {
            details += &format!("<div class=\"place\" data-shows=\"{}\"></div>", escaped(&figure.name));
        }
        format!(
            "<details class=\"answer {}\" id=\"answer_{}\"><summary><span class=\"judged\">{}</span><span \
            class=\"asked\">{}</span><span \
            class=\"number\">{}</span>{pictures}</summary>{details}</details>\n",
            finding.verdict.map_or("finding", class),
            escaped(&finding.id),
            self.judged(),
            text(&sentence(&finding.title).replace("<=", "\u{2264}").replace(">=", "\u{2265}")),
            self.found(),
        )
    }
}

/// The table of requirements, nearest to the limit first, or of outcomes with an example requirement; then the remarks
/// on verdicts and numbers.
pub fn table(plan: &Plan, found: &Findings, figures: &[Figure]) -> String {
    let has_verdicts = found.verdict.is_some();
    let outcomes = || found.of(Kind::Outcome).filter(|one| one.rank == 0 && !one.numbers.is_empty());
    let shown: Vec<&Finding> = match has_verdicts {
        true => found.of(Kind::Requirement).collect(),
        false => outcomes().take(MOST_OUTCOMES).collect(),
    };
    let rows: Vec<Row<'_>> = shown.iter().map(|one| Row::of(plan, found, one, figures)).collect();
    let scales = pictures::scales(&shown);
    let (title, heads, example) = match has_verdicts {
        true => (
            "Requirements, by verdict, then nearest to their limit first",
            ["required", "found", "dashed: limit; shaded: required side", "runs (hatched: beyond the limit)"],
            String::new(),
        ),
        false => (
            FOUND,
            ["outcome", "found", "interval, on the scale of all values", "runs"],
            format!(
                "<details class=\"example\"><summary>The campaign file has no requirement. Add one to get a verdict \
                here</summary>\
                 <pre><code>{}</code></pre></details>",
                escaped(EXAMPLE)
            ),
        ),
    };
    let cells: Vec<[String; 2]> = rows.iter().zip(scales).map(|(row, scale)| [scale, row.picture()]).collect();
    // one run has nothing to draw
    let is_drawn = cells.iter().flatten().any(|cell| !cell.is_empty());
    let spans = |cells: &[String]| cells.iter().map(|cell| format!("<span>{cell}</span>")).collect::<String>();
    let drawn = |cells: &[String]| if is_drawn { spans(cells) } else { String::new() };
    let body: String = rows.iter().zip(&cells).map(|(row, cells)| row.html(&drawn(cells))).collect();
    let heads = heads.map(str::to_owned);
    let (heads, class) = (spans(&heads[..2]) + &drawn(&heads[2..]), if is_drawn { "" } else { " bare" });
    let body = match body.is_empty() {
        true => "<p>No results: no dispersed run produced a value for any outcome.</p>".to_owned(),
        false => {
            format!(
                "{HATCH}<div class=\"answers{class}\"><p class=\"answer head\"><span></span>{heads}</p>\n{body}</div>"
            )
        }
    };
    let needed = found.of(Kind::Verdicts).filter(|one| one.rank == 0);
    let notes = needed.chain(found.of(Kind::Stop)).chain(found.of(Kind::Note)).map(|one| {
        let title =
            if one.title.is_empty() { String::new() } else { format!("<b>{}:</b> ", text(&sentence(&one.title))) };
        format!("<p class=\"note\">{title}{}</p>", full(&one.sentence))
    });
    let unsaid = found.of(Kind::Outcome).filter(|one| one.rank == 0 && one.numbers.is_empty() && !shown.is_empty());
    let unsaid = unsaid.map(|one| format!("<p class=\"caption\">{}</p>", full(&one.sentence)));
    let together = found.of(Kind::Verdicts).filter(|one| one.rank > 0);
    let together: String = together.map(|one| format!("<p class=\"quiet\">{}</p>", full(&one.sentence))).collect();
    let together = match together.is_empty() {
        true => together,
        false => format!("<details><summary>How to read these verdicts together</summary>{together}</details>"),
    };
    format!(
        "<section id=\"verdicts\"><h2>{title}</h2>{body}{}{together}{example}</section>\n",
        notes.chain(unsaid).collect::<String>()
    )
}

/// Ends of runs and missions, and accuracy, one line each.
pub fn ended(found: &Findings, nominal_end: Option<&str>) -> String {
    let all: String =
        found.of(Kind::Loss).filter(|one| one.children.is_empty()).map(|one| full(&one.sentence)).collect();
    let errors = found.of(Kind::Numerics).find(|one| one.id == "errors");
    let errors =
        errors.map_or_else(String::new, |one| format!(" {}: {}.", text(&sentence(&one.title)), text(&one.sentence)));
    let mission = |one: &Finding| {
        let share = one.numbers.first().filter(|number| number.value.is_finite());
        let bar = share.map_or_else(String::new, |share| {
            format!("<span class=\"bar\" style=\"--share: {:.3}\"></span>", share.value)
        });
        format!("<li class=\"{}\">{bar}{}</li>", escaped(&one.id), full(&one.sentence))
    };
    let missions: Vec<String> = found.of(Kind::Mission).filter(|one| one.id != "missions").map(mission).collect();
    let missions =
        if missions.is_empty() { String::new() } else { format!("<ul class=\"missions\">{}</ul>", missions.concat()) };
    let nominal = nominal_end.map_or_else(String::new, |end| {
        format!("<p class=\"caption\">The nominal run has no sensor noise; its {}.</p>", text(end))
    });
    if all.is_empty() && errors.is_empty() && missions.is_empty() {
        return String::new();
    }
    format!("<section id=\"status\">{missions}{nominal}<p class=\"lead\">{all}{errors}</p></section>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a key is code, without the marks around it.
    #[test]
    fn keys_are_code() {
        for (said, html) in [
            ("write body.mass_kg.", "write <code>body.mass_kg</code>."),
            ("environment.drag acts, e.g. by 0.3", "<code>environment.drag</code> acts, e.g. by 0.3"),
            ("design \"latin_hypercube\"; or", "design &quot;<code>latin_hypercube</code>&quot;; or"),
            ("`a & b` in F_e", "<code>a &amp; b</code> in F_e"),
        ] {
            assert_eq!(coded(said), html);
        }
    }
}
