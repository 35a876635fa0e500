//! [`Contents`] from what other modules computed of a result: statistics, verdicts, sensitivities, bands, and a survey of the rows.

use crate::analysis::assessment::Assessment;
use crate::analysis::drivers::{Question, Ranking};
use crate::analysis::event::Occurs;
use crate::analysis::input_sensitivity::InputSensitivity;
use crate::analysis::missions::Missions;
use crate::analysis::noise_share::NoiseShare;
use crate::analysis::order_statistics::without_value;
use crate::analysis::statistics::Statistics;
use crate::analysis::stopping::Stopping;
use crate::analysis::survey::Survey;
use crate::analysis::verdicts::Verdicts;
use crate::campaign::{Plan, Statement};
use crate::ensemble::Bands;
use crate::findings::names;
use crate::findings::names::sentence;
use crate::report::drivers_text::{self, outcomes, ranked, verb};
use crate::report::over_time::curves::{FEWEST, TimeBands};
use crate::report::page::Contents;
use crate::report::page::cards::{Card, Judged, driven_by};
use crate::report::page::influence::{Influence, counted_list};
use crate::report::page::readable::{grouped, number, with_unit};
use crate::report::page::runs::KnownRow;
use crate::report::requirements::{assumed, decided_by, runs_needed, together};
use crate::report::share_text;
use crate::report::stopping_text;
use crate::statistics::binomial::Decision;
use crate::statistics::gate::GateLimit;

/// A regression that explains less of the variance is not worth a word.
const LEAST_REGRESSION: f64 = 0.05;
/// Quantiles of the bands of the page.
const BANDS: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// What a campaign ends with.
#[derive(Clone, Copy, Debug)]
pub struct Analysis<'a> {
    pub statistics: &'a Statistics,
    pub verdicts: &'a Verdicts,
    /// What every input means for the main observables.
    pub sensitivities: &'a [InputSensitivity],
    /// How missions ended, under a control loop.
    pub missions: &'a Missions,
    /// What noise within the loop makes of the outcomes, where that was measured.
    pub noise: &'a [NoiseShare],
    /// Quantiles over time, where they were kept.
    pub bands: Option<&'a Bands>,
    /// What a reader has to know before any number.
    pub warnings: &'a [String],
    /// What the numbers leave unsaid.
    pub notes: &'a [String],
    /// The rows of the runs that the page lists.
    pub rows: &'a [KnownRow],
    /// The look that ended the campaign, where it has `[stop]`.
    pub stopping: Option<&'a Stopping>,
}

impl Contents {
    /// What `analysis` says of `plan`, and the `survey` of its rows. `files`: names and SHA-256.
    pub fn new(plan: &Plan, survey: Survey, analysis: Analysis<'_>, files: Vec<(String, String)>) -> Self {
        let influences = influences(plan, analysis.sensitivities, analysis.noise, &survey);
        let verdicts = &analysis.verdicts.list;
        let mut said = together(analysis.verdicts);
        said.extend(analysis.stopping.map(|found| stopping_text::text(plan, found)));
        Contents {
            warnings: analysis.warnings.to_vec(),
            notes: analysis.notes.to_vec(),
            loss: analysis.statistics.loss(),
            bands: analysis.bands.map_or_else(Vec::new, time_bands),
            confidence: analysis.statistics.population.has_intervals().then_some(analysis.statistics.confidence),
            statistics: analysis
                .statistics
                .columns
                .iter()
                .filter(|column| column.moments.count() > 0)
                .cloned()
                .collect(),
            verdicts: verdicts.iter().map(|one| card(one, &survey, analysis.statistics, &influences)).collect(),
            survey,
            missions: analysis.missions.clone(),
            influences,
            said,
            rows: analysis.rows.to_vec(),
            files,
        }
    }
}

fn time_bands(bands: &Bands) -> Vec<TimeBands> {
    let points = bands.times().len();
    let count = |series: usize, point: usize| bands.count(series, point);
    let all = 0..bands.layout().series.len();
    // some series are null in some phases; those of the motion never are
    let in_flight = |point: usize| all.clone().map(|series| count(series, point)).max().unwrap_or(0);
    let in_flight: Vec<u64> = (0..points).map(in_flight).collect();
    let values = |series: usize, point: usize| {
        let is_shown = bands.counted(series, point) >= FEWEST;
        bands.quantiles(series, point, BANDS).map(|value| value.filter(|_| is_shown).unwrap_or(f64::NAN))
    };
    let of_points = |series: usize| (0..points).map(|point| values(series, point)).collect::<Vec<_>>();
    let turned = |of_points: Vec<[f64; BANDS.len()]>| {
        std::array::from_fn(|which| of_points.iter().map(|quantiles| quantiles[which]).collect())
    };
    let of_series = |series: usize| TimeBands {
        name: bands.quantity(series).name().to_owned(),
        times: bands.times().to_vec(),
        quantiles: turned(of_points(series)),
        runs: bands.runs(),
        counted: bands.counted_runs(),
        in_flight: in_flight.clone(),
    };
    let series = all.clone().map(of_series);
    series.filter(|series| series.quantiles[2].iter().any(|value| value.is_finite())).collect()
}

/// The influences on each outcome, the strongest first.
fn influences(plan: &Plan, all: &[InputSensitivity], noise: &[NoiseShare], survey: &Survey) -> Vec<Influence> {
    let of_noise = |name: &str| match noise.iter().find(|one| one.observable == name) {
        Some(share) => format!(" {}.", sentence(&share_text::of_noise(share))),
        None => String::new(),
    };
    let of_outcome = |name: &str| {
        let of_ranking = |ranking: &Ranking<'_>| influence(plan, all, name, ranking, &of_noise(name));
        ranked(plan, all, name).iter().filter_map(of_ranking).collect::<Vec<_>>()
    };
    let seen = outcomes(plan, all).into_iter().filter(|name| survey.outcome(name).is_some());
    seen.flat_map(of_outcome).collect()
}

/// A ranking of the inputs of the outcome `name`, and what is known of the `noise`.
fn influence(
    plan: &Plan,
    all: &[InputSensitivity],
    name: &str,
    ranking: &Ranking<'_>,
    noise: &str,
) -> Option<Influence> {
    let first = ranking.inputs.first()?.input;
    let is_total = first.total.is_some();
    let drivers = ranking.drivers().count();
    let driven = match drivers {
        0 => "no input is a significant driver".to_owned(),
        1 => "the first input is a significant driver".to_owned(),
        count => format!("the first {count} inputs are significant drivers"),
    };
    let measure = if is_total { "total Sobol index" } else { "share of the variance" };
    let (event, meaning) = match &ranking.question {
        Question::Spread => (None, meaning(plan, first, all, &driven) + noise),
        Question::Event(event) => {
            let of = event.of;
            let meaning = format!(
                "{} of {} runs {}; {driven}.",
                grouped(of.events),
                grouped(of.runs),
                verb(plan, name, event, of.events)
            );
            (Some(*event), meaning)
        }
    };
    Some(Influence {
        outcome: name.to_owned(),
        event: event.map(|event| {
            let part = match event.occurs {
                Occurs::Missed { requirement, is_only: false } => format!("_event_{}", requirement + 1),
                _ if event.has_few_values => String::new(),
                _ => "_event".to_owned(),
            };
            (verb(plan, name, &event, u64::MAX), part)
        }),
        measure: measure.to_owned(),
        meaning,
        inputs: ranking
            .inputs
            .iter()
            .map(|one| {
                let share = one.share.map_or([f64::NAN; 3], |share| [share.value, share.lower, share.upper]);
                (one.input.input.clone(), share)
            })
            .collect(),
        shown: drivers,
        drivers: drivers_text::sentence(plan, name, ranking),
    })
}

fn meaning(plan: &Plan, first: &InputSensitivity, all: &[InputSensitivity], driven: &str) -> String {
    let of_observable = || all.iter().filter(|one| one.observable == first.observable);
    let mut text = format!("Of {} runs; {driven}.", grouped(first.rows));
    if let Some(share) = first.r_squared.filter(|share| share.value >= LEAST_REGRESSION) {
        text += &format!(
            " A linear regression on all inputs explains {}%.",
            number(libm::round(1000.0 * share.value) / 10.0)
        );
    }
    let correlated: Vec<String> = of_observable()
        .filter_map(|one| {
            let (other, r) = one.correlated_with.as_ref()?;
            let [name, other] = [&one.input, other].map(|column| names::of_input_column(plan, column));
            Some(format!("{name} with {other} ({r:.2})"))
        })
        .collect();
    if !correlated.is_empty() {
        text += &format!(" Correlated inputs share what they explain together: {}.", counted_list(&correlated));
    } else if !plan.correlated.is_empty() {
        text += " Some inputs are correlated and share what they explain together.";
    }
    text
}

/// The card of a requirement.
fn card(one: &Assessment, survey: &Survey, statistics: &Statistics, influences: &[Influence]) -> Card {
    let requirement = &one.requirement;
    let outcome = requirement.observable().and_then(|name| survey.outcome(name)).map(|(_, outcome)| outcome);
    let of_run = outcome.filter(|_| requirement.band().is_none());
    let name = of_run.map_or_else(
        || names::of_column(requirement.name(), &one.unit),
        |outcome| names::of_quantity(&outcome.quantity),
    );
    let confidence = number(100.0 * requirement.confidence);
    let percent = |fraction: f64| number(100.0 * fraction);
    let (limit, is_upper) = (requirement.limit.value(), matches!(requirement.limit, GateLimit::AtMost(_)));
    let shown = &one.shown;
    let (word, text) = (if is_upper { "at most" } else { "at least" }, with_unit(shown.written(limit), &shown.unit));
    let text_of = match requirement.statement {
        Statement::Mean => format!("The mean of the {name} is {word} {text}, with {confidence}% confidence."),
        Statement::Quantile(share) | Statement::Fraction(share) => {
            let is_quantile = matches!(requirement.statement, Statement::Quantile(_));
            let share = percent(if is_quantile { requirement.limit.fraction(share) } else { share });
            let kept = match requirement.observable() {
                Some("launched") if !is_upper => format!("{share}% of the runs launch the net"),
                _ => format!("in {share}% of the runs, the {name} is {word} {text}"),
            };
            match (requirement.band(), requirement.window()) {
                (Some(_), None) => format!(
                    "{}, {kept}, with {confidence}% confidence; at another time these may be other runs.",
                    sentence(requirement.times().trim_start())
                ),
                _ => format!("{}{}, with {confidence}% confidence.", sentence(&kept), requirement.times()),
            }
        }
    };
    let within = one.runs.saturating_sub(one.violations);
    let mut notes = vec![match (within, one.runs) {
        (0, 1) => "The run is not within the limit.".to_owned(),
        (_, 1) => "The run is within the limit.".to_owned(),
        _ => format!("{} of {} runs are within the limit.", grouped(within), grouped(one.runs)),
    }];
    if let Some(worst) = &one.worst {
        let at = format!("At {}, where the fewest are: ", with_unit(worst.time_s, "s"));
        notes[0] = format!("{at}{}", notes[0]);
        notes.push(format!("Tested at {} points of time.", worst.points));
    }
    if one.missing > 0 {
        notes.push(format!("{}.", without_value(&grouped(one.missing))));
    }
    if let Some(assumed) = assumed(one) {
        notes.push(format!("{}.", sentence(&assumed)));
    }
    match (&one.reason, one.gate.decision) {
        (Some(reason), _) => notes.push(format!("{}.", crate::findings::names::sentence(reason))),
        (None, Decision::Undecided(runs)) => {
            notes.push(format!("{}.", sentence(&runs_needed(runs.map(grouped).as_deref()))));
        }
        _ => {}
    }
    let is_fraction = matches!(requirement.statement, Statement::Fraction(_));
    let is_share = is_fraction || matches!(requirement.statement, Statement::Quantile(_)) && one.value.is_none();
    let (statistic, estimate, ends, limit, unit) = match requirement.statement {
        Statement::Mean => (
            "mean".to_owned(),
            shown.value(one.gate.estimate),
            one.interval.map(|end| shown.value(end)),
            shown.written(limit),
            shown.unit.clone(),
        ),
        Statement::Quantile(p) if one.value.is_some() => {
            let quantile = statistics.required(requirement);
            let ends = quantile
                .map_or([None; 2], |quantile| quantile.interval)
                .map(|end| shown.value(end.unwrap_or(f64::NAN)));
            let value = shown.value(one.value.unwrap_or(f64::NAN));
            (format!("{}% quantile", percent(p)), value, ends, shown.written(limit), shown.unit.clone())
        }
        // of a quantile that is a run without a value too
        Statement::Fraction(target) | Statement::Quantile(target) => {
            let fraction = if is_fraction { target } else { requirement.limit.fraction(target) };
            let hundred = |value: f64| 100.0 * value;
            (
                "runs within the limit".to_owned(),
                hundred(one.gate.estimate),
                one.interval.map(hundred),
                hundred(fraction),
                "%".to_owned(),
            )
        }
    };
    notes.extend(one.note.as_ref().map(|note| format!("{}.", crate::findings::names::sentence(note))));
    Card {
        judged: match one.gate.decision {
            Decision::Pass => Judged::Pass,
            Decision::Fail => Judged::Fail,
            Decision::Undecided(_) => Judged::Undecided,
        },
        quantity: sentence(&name),
        sentence: text_of,
        statistic,
        estimate,
        interval: ends,
        extremes: [f64::NAN; 2],
        decided_by: decided_by(one).unwrap_or_default(),
        limit: Some((limit, is_upper && !is_share)),
        unit,
        note: notes.join(" "),
        drivers: driven_by(requirement.observable().unwrap_or(requirement.name()), influences),
    }
}
