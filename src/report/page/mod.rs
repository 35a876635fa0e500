//! [`Page`]: the report of a campaign as one HTML file that needs no network.
//!
//! It is a pure function of the plan and the rows (and what was computed from them): the same result gives the same bytes.
//!
//! - `runs`: the runs that are shown in full.
//! - `errors`, [`influence`], `inputs`: the figures, with those of [`crate::report::over_time`]. - `figure_json`: what the scripts need to draw them.
//! - [`gather`]: what statistics, verdicts, sensitivities and bands are on the page. - [`cards`], `first_screen`, [`tables`], `document`: the HTML. - `replay` (with `live`, `sky`, `still`): the 3D replay. - `payload`: numbers in the page.
//!
//! The scripts and styles are in `assets/report/`.

pub mod cards;
mod document;
mod errors;
mod fates;
mod figure_json;
mod first_screen;
pub mod gather;
pub mod influence;
mod input_rows;
mod inputs;
mod live;
mod outcomes;
mod payload;
pub(in crate::report) mod readable;
mod replay;
pub mod runs;
mod sky;
mod still;
pub mod tables;

use serde_json::{Value, json};

use self::cards::Card;
use self::document::{PageSection, document};
use self::fates::Fate;
use self::figure_json::json_of;
use self::influence::Influence;
use self::payload::Payload;
use self::runs::KnownRow;
use crate::analysis::missions::Missions;
use crate::analysis::population::Loss;
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::survey::{self, Survey};
use crate::campaign::Plan;
use crate::campaign::event::Event;
use crate::ensemble::Ensemble;
use crate::ensemble::run_cost::replays;
use crate::findings::names;
use crate::findings::number::counted;
use crate::report::figure::{Figure, FigureSection, Mark, Scale};
use crate::report::mission_text;
use crate::report::over_time::curves::{Curves, TimeBands};
use crate::sampling::{Design, SampleId};

/// What the page is made of.
#[derive(Clone, Debug)]
pub struct Contents {
    /// What was taken from the rows.
    pub survey: Survey,
    /// How missions ended, under a control loop.
    pub missions: Missions,
    /// Quantiles over time; empty where they were not made.
    pub bands: Vec<TimeBands>,
    /// Of the observables that a run has.
    pub statistics: Vec<ColumnStatistics>,
    /// Confidence of their intervals; `None` where the design has none.
    pub confidence: Option<f64>,
    pub influences: Vec<Influence>,
    /// What comes before every number; mostly nothing.
    pub warnings: Vec<String>,
    /// What the numbers leave unsaid.
    pub notes: Vec<String>,
    pub loss: Loss,
    /// The verdicts of the requirements; empty where the file has none.
    pub verdicts: Vec<Card>,
    /// What `[stop]` and the verdicts together say, as sentences.
    pub said: Vec<String>,
    /// The rows of the runs that it lists ([`runs::listed`]).
    pub rows: Vec<KnownRow>,
    /// Names and SHA-256 of the files of the result.
    pub files: Vec<(String, String)>,
}

impl Contents {
    /// How many runs are flown again: of a campaign of one run that one, else as many as a page has the time for.
    fn replays(&self, plan: &Plan) -> usize {
        let evaluations = self.statistics.iter().find(|row| row.quantity.name() == "evaluations");
        replays(plan.rows(), evaluations.and_then(|row| row.moments.mean()).unwrap_or(0.0))
            .max(usize::from(plan.rows() == 1))
    }
}

#[derive(Clone, Debug)]
pub struct Page {
    pub html: String,
    /// Its figures, in their order.
    pub figures: Vec<Figure>,
    /// How many of the runs that it lists it does not show, and the command that does; nothing where there is none.
    pub left_out: Option<String>,
}

/// What stands in place of an interval where there is none.
pub(crate) const NO_INTERVAL: &str = "No interval: these runs are no random part of all.";

/// Whether the dispersed runs are independent, so that the intervals of order statistics hold.
pub fn is_independent(plan: &Plan) -> bool {
    matches!(plan.design, Design::Random(_))
}

/// When the events of the file happen: the median of each over the runs in which it does, and how many these are.
fn event_times(plan: &Plan, statistics: &[ColumnStatistics]) -> Vec<Mark> {
    let of = |event: &Event| {
        let name = format!("{}_time_s", event.name);
        let row = statistics.iter().find(|row| row.quantity.name() == name)?;
        let at = row.quantiles.iter().find(|one| one.p == 0.5)?.value?;
        let label = format!("{}, median of {}", event.name.replace('_', " "), counted(row.moments.count(), "run"));
        at.is_finite().then_some(Mark::Limit { label, at, vertical: true })
    };
    plan.events.iter().filter_map(of).collect()
}

impl Page {
    /// The page of a campaign. Runs the nominal and the worst samples again, to show them over time.
    pub fn new(ensemble: &Ensemble<'_>, contents: &Contents) -> Self {
        let (plan, survey) = (ensemble.plan(), &contents.survey);
        let has_intervals = is_independent(plan) && !contents.loss.is_big();
        let list = runs::listed(plan, survey);
        let shown = runs::shown_runs(plan, (&list, &contents.rows), contents.replays(plan), ensemble.isa());
        let first = shown.iter().find(|run| run.sample == SampleId(0));
        let nominal_end = first.and_then(|run| mission_text::of_run(&run.row));
        let nominal = first.and_then(|run| run.run.as_ref());
        let wheels = ensemble.request().wheels.to_vec();
        let curves = Curves::of_page(plan, nominal, &contents.bands, &wheels);
        let mut figures = outcomes::figures(plan, survey, &contents.statistics, has_intervals);
        let events = event_times(plan, &contents.statistics);
        figures.extend(curves.figures().into_iter().map(|mut figure| {
            // rows of names, as of phases, have no place for more words
            let is_marked = figure.is_over_time && !matches!(figure.y.scale, Scale::Names(_));
            figure.marks.extend(events.iter().filter(|_| is_marked).cloned());
            figure
        }));
        figures.extend(curves.drift());
        figures.extend(errors::figures(survey, has_intervals));
        figures.extend(influence::figures(plan, survey, &contents.influences));
        figures.extend(inputs::figures(plan, survey));
        let main = survey
            .outcomes
            .iter()
            .zip(&survey.thinned.outcomes)
            .filter(|(outcome, values)| !outcome.is_yes_or_no(values))
            .map(|(outcome, _)| outcome)
            .filter(|outcome| contents.influences.iter().any(|influence| influence.outcome == outcome.quantity.name()));
        figures.extend(main.map(|outcome| influence::convergence(outcome, has_intervals)));
        figures.retain(Figure::is_visible);
        let figures: Vec<Figure> = figures.into_iter().map(|figure| figure.in_units(&plan.analysis.display)).collect();

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
        let cards = if contents.verdicts.is_empty() {
            cards::findings(
                survey,
                (&contents.statistics, contents.confidence),
                &contents.influences,
                &plan.analysis.display,
            )
        } else {
            contents.verdicts.clone()
        };
        let first = [
            first_screen::header(plan, &contents.verdicts, survey, has_brackets(contents, &cards)),
            first_screen::warnings(&contents.warnings),
            first_screen::missions(&contents.missions, nominal_end.as_deref()),
            first_screen::verdicts(&cards, !contents.verdicts.is_empty(), &contents.said),
            first_screen::drivers(&cards, &contents.missions),
            first_screen::notes(&contents.notes),
            first_screen::status(plan, survey),
        ];
        let word = match cards::overall(&contents.verdicts) {
            Some(judged) => Some(judged.word()),
            None => first_screen::is_mostly_lost(survey).then_some(first_screen::NOT_COMPUTED),
        };
        let title = word.map_or_else(|| plan.name.clone(), |word| format!("{word}: {}", plan.name));
        let sections = sections(plan, contents, &shown, has_replay, &figures);
        let html = document(&title, &first.concat(), &sections, &data, &payload.text());
        Page { html, figures, left_out: runs::left_out(&shown) }
    }
}

/// Whether the page has intervals, which stand in brackets.
fn has_brackets(contents: &Contents, cards: &[Card]) -> bool {
    let ends = contents.missions.iter().map(|one| one.interval).chain(cards.iter().map(|card| card.interval));
    let quantiles =
        contents.statistics.iter().flat_map(|row| row.quantile_numbers()).map(|[.., low, high]| [low, high]);
    ends.chain(quantiles).flatten().any(f64::is_finite)
}

/// The sections after the first screen; one that has nothing to show is left out.
fn sections(
    plan: &Plan,
    contents: &Contents,
    shown: &[runs::ShownRun],
    has_replay: bool,
    drawn: &[Figure],
) -> Vec<PageSection> {
    let has = |section: FigureSection| drawn.iter().any(|figure| figure.section == section);
    let input_rows = input_rows::rows(plan, drawn);
    let figures = |section: FigureSection, title, lead: &str, html: &str| {
        let shown = PageSection {
            anchor: section.anchor(),
            title,
            lead: lead.to_owned(),
            html: html.to_owned(),
            has_figures: true,
            fold: None,
        };
        has(section).then_some(shown)
    };
    let plain = |anchor, title, lead: &str, html: String| {
        Some(PageSection { anchor, title, lead: lead.to_owned(), html, has_figures: false, fold: None })
    };
    let pairs = "<details id=\"pairs\"><summary>Plot any two columns against each other</summary><div></div></details>";
    let still = shown.iter().find_map(|run| run.run.as_ref()).map_or_else(String::new, |run| still::still(plan, run));
    let replay = format!("<div class=\"replay\">{still}<p>The replay needs JavaScript and WebGL.</p></div>");
    let table = tables::statistics(&contents.statistics, contents.confidence.is_some(), &plan.analysis.display);
    let folded = |section: PageSection, is_open: bool| PageSection { fold: Some(is_open), ..section };
    let inputs = input_rows + "<div class=\"figures\"></div>";
    let influence = PageSection {
        anchor: FigureSection::Influence.anchor(),
        title: "What drives it",
        lead: influence::lead(plan, &contents.survey, &contents.influences),
        html: pairs.to_owned(),
        has_figures: false,
        fold: None,
    };
    let is_off = first_screen::is_above_tolerance(plan, &contents.survey);
    let curves = outcomes::folded_curves(drawn);
    [
        figures(FigureSection::Outcome, "Outcome", "How each outcome is distributed over the runs.", &curves),
        plain("replay", "Replay", &format!("The nominal run and the worst ones in three dimensions. {}", runs::left_out(shown).map_or_else(String::new, |text| text + ".")), replay).filter(|_| has_replay),
        figures(FigureSection::Time, "Over time", "The nominal run, and where the dispersed runs are at each time. The slider of the replay moves a cursor through these figures; a click in one moves the replay.", ""),
        Some(PageSection { has_figures: has(FigureSection::Influence), ..influence }),
        plain("worst", "Worst runs", "The nominal run, runs that failed, and those with the worst outcomes. Run in the folder of this page, each command repeats its run bit for bit.", tables::worst_runs(plan, &contents.survey, shown)),
        figures(FigureSection::Numerics, "Numerics", "How large the numerical errors are. They should be small and not grow over time.", "").map(|section| folded(section, is_off)),
        figures(FigureSection::Inputs, "Inputs", "What was drawn, compared with the distributions of the campaign file.", &inputs).map(|section| PageSection { has_figures: false, ..folded(section, false) }),
        Some(PageSection { anchor: "statistics", title: "Statistics", lead: String::new(), html: table, has_figures: has(FigureSection::Statistics), fold: Some(false) }),
        plain("provenance", "Provenance", "", tables::provenance(plan, &contents.survey, &contents.files)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Columns that the reader may plot against each other: thinned, in single precision.
fn pairs(plan: &Plan, survey: &Survey, payload: &mut Payload) -> Value {
    let thinned = &survey.thinned;
    let rows = survey::chosen(&thinned.samples, survey::SCATTER);
    if rows.len() < 2 {
        return Value::Null;
    }
    let mut of = |column: &[f64]| payload.singles(&rows.iter().map(|row| column[*row]).collect::<Vec<f64>>());
    let display = &plan.analysis.display;
    let inputs = plan.dispersions.columns().iter().zip(&thinned.inputs).map(|(column, values)| {
        let unit = if column.parameter.unit() == "1" { "" } else { column.parameter.unit() };
        let shown = display.of(&column.parameter.name(), unit);
        let values = of(&values.iter().map(|value| shown.value(*value)).collect::<Vec<f64>>());
        let name = names::of_component(column.parameter, column.component);
        json!({ "name": name, "column": column.parameter.column_name(column.component), "unit": shown.unit, "input": true, "values": values })
    });
    let inputs: Vec<Value> = inputs.collect();
    let outcomes = survey.outcomes.iter().zip(&thinned.outcomes).map(|(outcome, values)| {
        let shown = display.of(outcome.quantity.name(), outcome.quantity.unit());
        let values = of(&values.iter().map(|value| shown.value(*value)).collect::<Vec<f64>>());
        let name = names::of_quantity(&outcome.quantity);
        json!({ "name": name, "column": outcome.quantity.name(), "unit": shown.unit, "input": false, "values": values })
    });
    let columns: Vec<Value> = inputs.into_iter().chain(outcomes).collect();
    let samples: Vec<f64> = rows.iter().map(|row| thinned.samples[*row] as f64).collect();
    let fates = fates::fates(plan, survey);
    let shown: Vec<f64> = rows.iter().map(|row| fates[*row].place()).collect();
    let judged = fates.contains(&Fate::Missed) || !plan.analysis.requirements.is_empty();
    json!({ "columns": columns, "samples": payload.array(&samples), "fates": payload.singles(&shown), "judged": judged, "fateWords": fates::words(plan), "all": survey.statuses.runs() })
}
