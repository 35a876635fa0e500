//! [`Page`]: the report of a campaign as one offline HTML file, a pure function of plan and rows.
//!
//! [`crate::findings`] supplies the words; this module arranges them with the figures. Scripts and styles are in
//! `assets/report/`.

pub mod answer;
mod bands;
pub(in crate::report) mod document;
mod errors;
mod fates;
pub(in crate::report) mod figure_json;
pub mod influence;
mod input_rows;
mod live;
mod outcomes;
pub(in crate::report) mod payload;
mod pictures;
pub(in crate::report) mod readable;
mod replay;
pub mod runs;
mod sky;
pub mod tables;

use serde_json::{Value, json};

use self::answer::full;
use self::document::{PageSection, document};
use self::fates::Fate;
use self::figure_json::json_of;
use self::payload::Payload;
use self::runs::{KnownRow, ShownRun};
use crate::analysis::analysed::Analysed;
use crate::analysis::outcomes::unique;
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::survey::{self, Survey, SurveyedOutcome};
use crate::campaign::{Plan, ShownUnit};
use crate::ensemble::run_cost::replays;
use crate::ensemble::{Ensemble, SingleRun};
use crate::findings::numerics::BEYOND_TOLERANCE;
use crate::findings::outcome::event_time;
use crate::findings::requirement::required;
use crate::findings::{Finding, Findings, Kind, loss, names};
use crate::report::figure::{Figure, FigureSection, Mark, Scale};
use crate::report::inputs::DrawnInputs;
use crate::report::over_time::curves::{Curves, TimeBands};
use crate::sampling::{Design, SampleId};

#[derive(Clone, Debug)]
pub struct Contents<'a> {
    pub analysed: &'a Analysed,
    pub found: &'a Findings,
    /// Listed runs in order, with reasons ([`runs::listed`]).
    pub listed: Vec<(SampleId, String)>,
    pub rows: Vec<KnownRow>,
    /// Names and SHA-256 of the files of the result.
    pub files: Vec<(String, String)>,
}

impl Contents<'_> {
    /// Number of replayed runs: a single run always, else as many as the time allows.
    fn replays(&self, plan: &Plan) -> usize {
        let evaluations = self.analysed.statistics.column("evaluations").and_then(|row| row.moments.mean());
        replays(plan.rows(), evaluations.unwrap_or(0.0)).max(usize::from(plan.rows() == 1))
    }
}

#[derive(Clone, Debug)]
pub struct Page {
    pub html: String,
    pub figures: Vec<Figure>,
    pub left_out: Option<String>,
}

/// True if the dispersed runs are independent: order statistics need that for intervals.
pub fn is_independent(plan: &Plan) -> bool {
    matches!(plan.design, Design::Random(_))
}

fn event_times(plan: &Plan, statistics: &[ColumnStatistics]) -> Vec<Mark> {
    let times = statistics.iter().filter_map(|column| event_time(plan, column));
    times.map(|(label, at)| Mark::Limit { label, at, vertical: true }).collect()
}

impl Page {
    /// Replays the nominal and the worst samples and assembles the page.
    pub fn new(ensemble: &Ensemble<'_>, contents: &Contents<'_>) -> Self {
        let (plan, analysed, found) = (ensemble.plan(), contents.analysed, contents.found);
        let survey = &analysed.survey;
        let flown = contents.replays(plan);
        let shown = runs::shown_runs(plan, (&contents.listed, &contents.rows), flown, ensemble.isa());
        let first = shown.iter().find(|run| run.sample == SampleId(0));
        let nominal = first.and_then(|run| run.run.as_ref());
        let bands = analysed.bands.as_ref().map_or_else(Vec::new, bands::time_bands);
        let flown: Vec<&SingleRun> = shown.iter().filter_map(|run| run.run.as_ref()).collect();
        let figures = figures(ensemble, (analysed, found), (nominal, flown), &bands);

        let mut payload = Payload::default();
        let drawn: Vec<Value> = figures.iter().map(|figure| json_of(figure, &mut payload)).collect();
        let motions: Vec<Value> = shown.iter().filter_map(|run| replay::motion(plan, run, &mut payload)).collect();
        let has_replay = !motions.is_empty();
        let data = json!({
            "name": plan.name,
            "figures": drawn,
            "replay": has_replay.then(|| json!({ "scene": replay::scene(plan), "runs": motions })),
            "pairs": pairs(plan, survey, &mut payload),
        });
        let end = first.and_then(|run| loss::of_run(&run.row)).filter(|_| plan.law.is_some() && plan.rows() > 1);
        let first_screen = [
            answer::header(plan, found, survey),
            answer::first(found),
            answer::table(plan, found, &figures),
            answer::ended(found, end.as_deref()),
        ];
        let word = answer::word(found, survey);
        let title = word.map_or_else(|| plan.name.clone(), |word| format!("{word}: {}", plan.name));
        let sections = sections(plan, contents, &shown, has_replay, &figures);
        let answers = if found.verdict.is_some() { "Verdicts" } else { answer::FOUND };
        let html = document(&title, (&first_screen.concat(), Some(answers)), &sections, &data, &payload.text());
        Page { html, figures, left_out: runs::left_out(&shown) }
    }
}

fn figures(
    ensemble: &Ensemble<'_>,
    (analysed, found): (&Analysed, &Findings),
    (nominal, flown): (Option<&SingleRun>, Vec<&SingleRun>),
    bands: &[TimeBands],
) -> Vec<Figure> {
    let (plan, survey, statistics) = (ensemble.plan(), &analysed.survey, &analysed.statistics);
    let has_intervals = is_independent(plan) && !statistics.loss().is_big();
    let wheels = ensemble.request().wheels.to_vec();
    let curves = Curves::of_page(plan, nominal, bands, &wheels);
    let curves = curves.among(flown).ordered_by(&required(plan, found.of(Kind::Requirement)));
    let events = event_times(plan, &statistics.columns);
    let marked = |mut figure: Figure| {
        // rows of names leave no room for labels
        let is_marked = figure.is_over_time && !matches!(figure.y.scale, Scale::Names(_));
        figure.marks.extend(events.iter().filter(|_| is_marked).cloned());
        figure
    };
    let mut figures = influence::figures(plan, survey, &analysed.sensitivities, has_intervals);
    figures.extend(curves.figures().into_iter().map(marked));
    figures.extend(curves.drift());
    figures.extend(outcomes::figures(plan, survey, &statistics.columns, has_intervals));
    figures.extend(errors::figures(survey, has_intervals));
    if plan.rows() > 1 {
        let rows = (0..survey.thinned.samples.len()).filter(|row| survey.thinned.samples[*row] != 0);
        let rows: Vec<usize> = rows.collect();
        let of = |column: &Vec<f64>| rows.iter().map(|row| column[*row]).collect();
        let columns = survey.thinned.inputs.iter().map(of).collect();
        figures.extend(DrawnInputs { columns, all: survey.statuses.runs().saturating_sub(1) }.figures(plan));
    }
    let converging = survey.outcomes.iter().zip(&survey.thinned.outcomes);
    let converging = converging.filter(|(outcome, values)| outcome.is_outcome && !outcome.is_yes_or_no(values));
    figures.extend(converging.map(|(outcome, _)| influence::convergence(outcome, has_intervals)));
    figures.retain(Figure::is_visible);
    figures.into_iter().map(|figure| figure.in_units(&plan.analysis.display)).collect()
}

fn sections(
    plan: &Plan,
    contents: &Contents<'_>,
    shown: &[ShownRun],
    has_replay: bool,
    drawn: &[Figure],
) -> Vec<PageSection> {
    let (analysed, found) = (contents.analysed, contents.found);
    let (survey, statistics) = (&analysed.survey, &analysed.statistics);
    let has = |section: FigureSection| drawn.iter().any(|figure| figure.section == section);
    let figures = |section: FigureSection, title, lead: &str, html: String| {
        has(section).then(|| PageSection { has_figures: true, ..PageSection::new(section.anchor(), title, lead, html) })
    };
    let replay = "<div class=\"replay\"><p>The replay needs JavaScript and WebGL.</p></div>".to_owned();
    let drivers: Vec<&str> = found.of(Kind::Driver).flat_map(|one| &one.children).map(|one| one.id.as_str()).collect();
    let drivers = unique(drivers.into_iter());
    let worst = if shown.len() > 1 { tables::worst_runs(plan, survey, &drivers, shown) } else { String::new() };
    let left_out = runs::left_out(shown).map_or_else(String::new, |text| format!(" {}", full(&text)));
    let one = if plan.rows() == 1 {
        "The run in three dimensions."
    } else {
        "The worst run in three dimensions; the next worst, and the nominal one, in the list."
    };
    let replay = PageSection::new(
        "replay",
        "The run to look at",
        format!("{one}{left_out}"),
        if has_replay { replay } else { String::new() } + &worst,
    );
    let errors = found.of(Kind::Numerics).filter(|one| one.rank < 2 && !one.sentence.is_empty());
    let errors: String = errors
        .map(|one| format!("{}: {}. ", answer::text(&names::sentence(&one.title)), answer::text(&one.sentence)))
        .collect();
    let is_off = found.of(Kind::Note).any(|one| one.id == BEYOND_TOLERANCE);
    let table = tables::statistics(&statistics.columns, statistics.population.has_intervals(), &plan.analysis.display);
    let inputs = input_rows::rows(plan, drawn) + "<div class=\"figures\"></div>";
    let curves = outcomes::folded_curves(drawn);
    [
        decides(found, drawn).filter(|_| plan.rows() > 1),
        (has_replay || !worst.is_empty()).then_some(replay),
        figures(
            FigureSection::Time,
            "Over time",
            "The nominal run, and where the dispersed runs are at each time. The \
            slider of the replay moves a cursor through these figures; a click in one moves the \
            replay.",
            String::new(),
        ),
        figures(FigureSection::Outcome, "How the outcomes are distributed", "", curves),
        figures(FigureSection::Numerics, "Numerics", &errors, String::new())
            .map(|section| PageSection { fold: Some(is_off), ..section }),
        figures(
            FigureSection::Inputs,
            "Inputs",
            "What was drawn, compared with the distributions of the campaign \
            file.",
            inputs,
        )
        .map(|section| PageSection { has_figures: false, fold: Some(false), ..section }),
        Some(PageSection {
            has_figures: has(FigureSection::Statistics),
            fold: Some(false),
            ..PageSection::new("statistics", "Statistics", "", table)
        }),
        Some(PageSection::new("provenance", "Provenance", "", tables::provenance(plan, survey, &contents.files))),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The drivers, strongest first, with their figures; `None` if none were sought.
fn decides(found: &Findings, drawn: &[Figure]) -> Option<PageSection> {
    let is_drawn = |name: &String| drawn.iter().any(|figure| figure.name == *name);
    let mut placed: Vec<String> = Vec::new();
    let entry = |one: &Finding| {
        let of_inputs = one.children.iter().filter_map(|child| child.figures.small.as_ref());
        let of_inputs = of_inputs.flat_map(|name| [name.replacen("scatter_", "shares_", 1), name.clone()]);
        let mut names: Vec<String> = of_inputs.chain(one.figures.large.clone()).filter(is_drawn).collect();
        names.retain(|name| !placed.contains(name));
        placed.extend(names.iter().cloned());
        let title = if one.title.is_empty() { String::new() } else { answer::text(&names::sentence(&one.title)) };
        let said = full(&one.sentence);
        match names.is_empty() {
            true if title.is_empty() => format!("<p class=\"detail\">{said}</p>\n"),
            true => format!("<p class=\"detail\"><b>{title}:</b> {said}</p>\n"),
            false => format!(
                "<article class=\"driver\"><h3>{title}</h3><p>{said}</p>\
                 <div class=\"figures\" data-figure=\"{}\"></div></article>\n",
                names.join(" ")
            ),
        }
    };
    let all: Vec<&Finding> = found.of(Kind::Driver).filter(|one| !one.sentence.is_empty()).collect();
    if all.is_empty() {
        return None;
    }
    // with figures first, the rest folded into lines
    let (with, without): (Vec<String>, Vec<String>) =
        all.into_iter().map(entry).partition(|said| said.starts_with("<article"));
    let others = match with.is_empty() || without.is_empty() {
        true => without.concat(),
        false => {
            format!("<details><summary>What was found of the other outcomes</summary>{}</details>", without.concat())
        }
    };
    let list = with.concat();
    let pairs = "<details id=\"pairs\"><summary>Plot any two columns against each other</summary><div></div></details>";
    let html = format!("{list}{others}{pairs}");
    Some(PageSection::new(FigureSection::Influence.anchor(), "What decides it", "", html))
}

/// Columns for the reader's own scatter plots: thinned, single precision.
fn pairs(plan: &Plan, survey: &Survey, payload: &mut Payload) -> Value {
    let thinned = &survey.thinned;
    let rows = survey::chosen(&thinned.samples, survey::SCATTER);
    if rows.len() < 2 {
        return Value::Null;
    }
    let display = &plan.analysis.display;
    let inputs = plan.dispersions.columns().iter().enumerate().map(|(place, column)| {
        let column = column.parameter.column_name(column.component);
        (names::of_input(plan, place), column, names::unit_of_input(plan, place), true)
    });
    let outcomes = survey.outcomes.iter().map(|SurveyedOutcome { quantity, .. }| {
        let shown = display.of(quantity.name(), quantity.unit());
        (names::of_quantity(quantity), quantity.name().to_owned(), shown, false)
    });
    let column = |((name, column, shown, is_input), values): ((String, String, ShownUnit, bool), &Vec<f64>)| {
        let values = payload.singles(&rows.iter().map(|row| shown.value(values[*row])).collect::<Vec<f64>>());
        json!({ "name": name, "column": column, "unit": shown.unit, "input": is_input, "values": values })
    };
    let columns = inputs.zip(&thinned.inputs).chain(outcomes.zip(&thinned.outcomes));
    let columns: Vec<Value> = columns.map(column).collect();
    let samples: Vec<f64> = rows.iter().map(|row| thinned.samples[*row] as f64).collect();
    let fates = fates::fates(plan, survey);
    let shown: Vec<f64> = rows.iter().map(|row| fates[*row].place()).collect();
    let judged = fates.contains(&Fate::Missed) || !plan.analysis.requirements.is_empty();
    json!({ "columns": columns, "samples": payload.array(&samples), "fates": payload.singles(&shown),
        "judged": judged, "fateWords": fates::words(plan), "all": survey.statuses.runs() })
}
