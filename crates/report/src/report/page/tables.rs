//! Tables of the page as static HTML: worst runs, statistics, provenance; a script sorts and searches them.

use crate::analysis::statistic::{STATISTICS, Statistic};
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::survey::Survey;
use crate::campaign::{Display, Plan};
use crate::findings::names::{sentence, unit_of_input};
use crate::findings::{loss, names};
use crate::loops::{ControlLaw, callback};
use crate::report::page::readable::{in_brackets, number, with_unit};
use crate::report::page::runs::ShownRun;
use crate::run::{Quantity, Status};
use crate::sampling::Transform;
use crate::table::html::{self, escaped};
use crate::table::text::Align;
use crate::table::{Cell, Column, Content, Table, Values};

const MOST_INPUTS: usize = 3;

type Heading<'v> = (String, Box<dyn Fn(&ColumnStatistics) -> f64 + 'v>);

pub fn statistics(rows: &[ColumnStatistics], has_intervals: bool, display: &Display) -> String {
    let Some(first) = rows.first() else { return "<p>No run was computed: there are no statistics.</p>".to_owned() };
    let shown = |row: &ColumnStatistics| display.of(row.quantity.name(), row.quantity.unit());
    let mut table = Table::with([("observable", Align::Title), ("unit", Align::Left)]);
    for row in rows {
        table.row([names::of_quantity(&row.quantity), shown(row).unit]);
    }
    let of_list = |one: &'static Statistic| -> Heading<'_> {
        let value = move |row: &ColumnStatistics| shown(row).value((one.value)(row).unwrap_or(f64::NAN));
        (one.head.unwrap_or_default().to_owned(), Box::new(value))
    };
    let mut columns: Vec<Heading<'_>> = Vec::new();
    columns.extend(STATISTICS.iter().filter(|one| one.head.is_some()).map(of_list));
    // quantiles precede the last statistic
    let last = columns.pop();
    columns.insert(0, ("runs".to_owned(), Box::new(|row: &ColumnStatistics| row.moments.count() as f64)));
    let start = table.columns.len() + columns.len();
    for (place, one) in first.quantiles.iter().enumerate() {
        let value = move |row: &ColumnStatistics| shown(row).value(row.quantiles[place].numbers()[1]);
        columns.push((format!("{}%", number(100.0 * one.p)), Box::new(value)));
    }
    for (head, value) in columns.into_iter().chain(last) {
        let quantity = Quantity::named(head, String::new(), String::new());
        let values: Vec<f64> = rows.iter().map(value).collect();
        table.push(Column::new(quantity, Content::Real), Values::Real(values.into()));
    }
    let cell = |[row, column]: [usize; 2], cell: Cell<'_>| {
        let row = &rows[row];
        let Cell::Real(value) = cell else {
            let [_, content] = html::plain(cell);
            let meaning = format!(" title=\"{}: {}\"", escaped(row.quantity.name()), escaped(row.quantity.meaning()));
            return [[meaning, " class=\"unit\"".to_owned(), String::new()][column.min(2)].clone(), content];
        };
        let mut shown_value = [format!(" data-value=\"{value:e}\""), number(value)];
        if let Some(quantile) = column.checked_sub(start).and_then(|place| row.quantiles.get(place)) {
            let [_, _, low, high] = quantile.numbers().map(|number| shown(row).value(number));
            if low.is_finite() || high.is_finite() {
                shown_value[0] += &format!(" title=\"{}\"", in_brackets(value, [low, high]));
            }
            shown_value[1] += if low.is_finite() && high.is_finite() { "" } else { "<sup>*</sup>" };
        }
        shown_value
    };
    let caption = match has_intervals {
        false => "The design has no intervals",
        true => "These runs do not bound this quantile from both sides; the interval of others appears on hover",
    };
    format!(
        "<div class=\"table\" tabindex=\"0\">{}</div><p class=\"caption\">Of the dispersed runs that were computed. \
        <sup>*</sup> {caption}.</p>\n",
        html::html(&table, "sortable searchable", cell)
    )
}

/// Relative difference below which values are shown by their difference.
const ALIKE: f64 = 1e-3;

/// Root mean square deviation from the nominal value.
fn spread(values: &[f64], nominal: f64) -> f64 {
    let squares: Vec<f64> = values.iter().map(|value| (value - nominal).powi(2)).filter(|x| x.is_finite()).collect();
    libm::sqrt(squares.iter().sum::<f64>() / squares.len().max(1) as f64).max(f64::MIN_POSITIVE)
}

/// A drawn value with the nominal one, as a difference if nearly equal; a nominal zero goes without saying.
fn drawn([value, nominal]: [f64; 2], unit: &str) -> String {
    let off = value - nominal;
    if nominal == 0.0 {
        return format!("{} (", with_unit(value, unit));
    }
    if off.abs() < ALIKE * nominal.abs() && off != 0.0 {
        let sign = if off < 0.0 { "\u{2212}" } else { "+" };
        return format!("{} {sign} {} (", with_unit(nominal, unit), with_unit(off.abs(), unit));
    }
    format!("{} (nominal {}, ", with_unit(value, unit), with_unit(nominal, unit))
}

/// The nominal and the worst runs with reason, inputs and replay command: first the `drivers`, by column, then the
/// inputs farthest from nominal.
pub fn worst_runs(plan: &Plan, survey: &Survey, drivers: &[&str], runs: &[ShownRun]) -> String {
    let columns = plan.dispersions.columns();
    let spreads: Vec<f64> =
        columns.iter().zip(&survey.thinned.inputs).map(|(column, values)| spread(values, column.nominal)).collect();
    let name = |index: usize| columns[index].parameter.column_name(columns[index].component);
    let decide: Vec<usize> =
        drivers.iter().filter_map(|driver| (0..columns.len()).find(|index| name(*index) == *driver)).collect();
    let input = |run: &ShownRun, index: usize| {
        let (column, value) = (&columns[index], run.inputs[index]);
        let shown = unit_of_input(plan, index);
        let name = names::of_component(column.parameter, column.component);
        let values = drawn([value, column.nominal].map(|value| shown.value(value)), &shown.unit);
        let text = match plan.dispersions.distribution_of(index) {
            // deviations of a discrete distribution have no sigma
            Some(Transform::Scalar(distribution)) if distribution.steps().is_some() => {
                values.strip_suffix(", ").map_or(values.trim_end_matches(" (").to_owned(), |of| format!("{of})"))
            }
            _ => {
                let sigmas = (value - column.nominal).abs() / spreads[index];
                format!("{values}{}\u{a0}\u{3c3})", number(libm::round(10.0 * sigmas) / 10.0))
            }
        };
        escaped(&format!("{name} {text}"))
    };
    let inputs = |run: &ShownRun| {
        let mut order: Vec<usize> = (0..columns.len().min(run.inputs.len())).collect();
        let sigmas = |index: &usize| (run.inputs[*index] - columns[*index].nominal).abs() / spreads[*index];
        order.sort_by(|a, b| sigmas(b).total_cmp(&sigmas(a)));
        let others = order.iter().filter(|index| !decide.contains(index));
        let listed = decide.iter().chain(others).take(MOST_INPUTS).map(|index| input(run, *index));
        if run.sample.0 == 0 { "nominal values".to_owned() } else { listed.collect::<Vec<_>>().join("<br>") }
    };
    let why = |run: &ShownRun| {
        let why = if run.sample.0 == 0 { "nominal run" } else { &run.why };
        // a computed run without an end has nothing to add
        let ended = match run.status {
            Status::Done => loss::of_row(&run.row).map(|end| escaped(&sentence(&end))),
            status => Some(format!("<b>{}</b>: {}", status.name(), escaped(&run.reason))),
        };
        let ended = ended.map_or_else(String::new, |ended| format!("<p class=\"ended\">{ended}</p>"));
        escaped(&sentence(why)) + &ended
    };
    let replay = |run: &ShownRun| match &run.run {
        Some(flown) if flown.outcome.points.min(flown.grid.points()) > 1 => {
            format!("<button type=\"button\" class=\"load\" data-sample=\"{}\">show</button>", run.sample)
        }
        _ => "not run".to_owned(),
    };
    let which = if decide.is_empty() {
        "inputs farthest from nominal"
    } else {
        "inputs that decide, then farthest from nominal"
    };
    let mut table = Table::with(
        ["sample", "why it is listed", which, "command, in this folder", "3D"]
            .map(|head| (head, if head == "sample" { Align::Title } else { Align::Left })),
    );
    for run in runs {
        let command = format!("<code>spindrift simulate plan.toml --sample {}</code>", run.sample);
        table.row([run.sample.to_string(), why(run), inputs(run), command, replay(run)]);
    }
    let attributes = ["", " class=\"text\"", " class=\"text small\"", "", ""];
    let cell = |[_, column]: [usize; 2], cell: Cell<'_>| [attributes[column].to_owned(), html::markup(cell)];
    format!("<div class=\"table\" id=\"worst\" tabindex=\"0\">{}</div>\n", html::html(&table, "", cell))
}

/// Plan, files, reproduction, glossary, licences.
pub fn provenance(plan: &Plan, survey: &Survey, files: &[(String, String)]) -> String {
    let mut table = Table::with([("", Align::Title), ("", Align::Left)]);
    files.iter().for_each(|(name, hash)| table.row([name.as_str(), hash]));
    let cell = |[_, column]: [usize; 2], cell: Cell<'_>| {
        let [attributes, content] = html::plain(cell);
        [attributes, if column == 0 { content } else { format!("<code>{content}</code>") }]
    };
    let files = match files.is_empty() {
        true => String::new(),
        false => format!(
            "<details><summary>Files and their SHA-256</summary><div class=\"table\">{}</div></details>",
            html::html(&table, "", cell)
        ),
    };
    let glossary: String = survey
        .outcomes
        .iter()
        .map(|outcome| {
            let unit = if outcome.quantity.unit().is_empty() {
                String::new()
            } else {
                format!(" ({})", escaped(outcome.quantity.unit()))
            };
            format!(
                "<dt>{}{unit}</dt><dd>{} Column <code>{}</code>.</dd>",
                escaped(&names::title(&outcome.quantity)),
                escaped(outcome.quantity.meaning()),
                escaped(outcome.quantity.name())
            )
        })
        .collect();
    let kept = if plan.law.as_ref().and_then(ControlLaw::spec).is_some_and(callback::is_law_of) {
        "The law of attitude is a function of Python, which is not part of the plan: the rows cannot be made again \
        without it."
    } else {
        "Neither the number of threads nor the machine changes a bit of the rows, and the same rows give this page \
        again, byte for byte."
    };
    format!(
        "<p>{} samples of plan <code>{}</code>, spindrift {}. {kept}</p>
<p>To make it again, in this folder: <code>spindrift report .</code> from the rows, or <code>spindrift campaign \
plan.toml --out elsewhere</code> from scratch.</p>
<details><summary>The whole plan</summary><pre class=\"plan\"><code>{}</code></pre></details>{files}
<details><summary>What the columns on this page mean</summary><dl class=\"glossary\">{glossary}</dl></details>
<details><summary>Libraries in this page, and their licences</summary><p>Apache ECharts 6.1.0 (Apache-2.0) with \
ZRender (BSD-3-Clause) and tslib (0BSD) draws the plots, three.js 0.187.0 (MIT) the replay.</p><pre id=\"licences\" \
class=\"plan\"></pre></details>\n",
        survey.statuses.runs(),
        plan.hash(),
        env!("CARGO_PKG_VERSION"),
        escaped(&plan.text()),
    )
}
