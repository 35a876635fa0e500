//! Tables of the page as static HTML: worst runs, statistics, provenance; a script sorts and searches them.

use crate::analysis::order_statistics::QuantileStatistic;
use crate::analysis::statistic::{STATISTICS, Statistic};
use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::survey::Survey;
use crate::campaign::{Display, Plan};
use crate::control::ControlLaw;
use crate::control::laws::callback;
use crate::findings::loss;
use crate::findings::names;
use crate::findings::names::sentence;
use crate::findings::names::unit_of_input;
use crate::report::escaped::escaped;
use crate::report::page::readable::{in_brackets, number, with_unit};
use crate::report::page::runs::ShownRun;
use crate::run::Status;
use crate::sampling::Transform;

/// Listed inputs of a run: the farthest from nominal in units of their spread.
const MOST_INPUTS: usize = 3;

/// A sortable cell.
fn cell(value: f64) -> String {
    if value.is_finite() {
        format!("<td data-value=\"{value:e}\">{}</td>", number(value))
    } else {
        "<td>-</td>".to_owned()
    }
}

/// The statistics of every observable, with intervals if the design has them.
pub fn statistics(rows: &[ColumnStatistics], has_intervals: bool, display: &Display) -> String {
    let Some(first) = rows.first() else { return "<p>No run was computed: there are no statistics.</p>".to_owned() };
    let quantiles: String = first.quantiles.iter().map(|one| format!("<th>{}%</th>", number(100.0 * one.p))).collect();
    // quantiles precede the last statistic
    let of_list = |quantiles: String, text: &dyn Fn(&Statistic, &str) -> String| {
        let shown: Vec<String> = STATISTICS.iter().filter_map(|one| Some(text(one, one.head?))).collect();
        shown.split_last().map_or(String::new(), |(last, before)| before.concat() + &quantiles + last)
    };
    let heads = of_list(quantiles, &|_, head| format!("<th>{head}</th>"));
    let caption = if !has_intervals {
        "The design has no intervals".to_owned()
    } else {
        "These runs do not bound this quantile from both sides; the interval of others appears on hover".to_owned()
    };
    let mut body = String::new();
    for row in rows {
        let quantity = &row.quantity;
        let shown = display.of(quantity.name(), quantity.unit());
        let cell = |value: Option<f64>| cell(shown.value(value.unwrap_or(f64::NAN)));
        let quantile = |one: &QuantileStatistic| {
            let [_, value, low, high] = one.numbers();
            if !value.is_finite() {
                return "<td>-</td>".to_owned();
            }
            let value = shown.value(value);
            let ends = [low, high].map(|end| shown.value(end));
            let interval = match ends.iter().any(|end| end.is_finite()) {
                true => format!(" title=\"{}\"", in_brackets(value, ends)),
                false => String::new(),
            };
            let mark = if low.is_finite() && high.is_finite() { "" } else { "<sup>*</sup>" };
            format!("<td data-value=\"{value:e}\"{interval}>{}{mark}</td>", number(value))
        };
        let quantiles: String = row.quantiles.iter().map(quantile).collect();
        let cells = of_list(quantiles, &|one, _| cell((one.value)(row)));
        body += &format!(
            "<tr><th scope=\"row\" title=\"{}: {}\">{}</th><td class=\"unit\">{}</td>{}{cells}</tr>\n",
            escaped(quantity.name()),
            escaped(quantity.meaning()),
            escaped(&names::of_quantity(quantity)),
            escaped(&shown.unit),
            self::cell(row.moments.count() as f64),
        );
    }
    format!(
        "<div class=\"table\" tabindex=\"0\"><table class=\"sortable \
        searchable\"><thead><tr><th>observable</th><th>unit</th><th>runs</th>{heads}</tr></thead><tbody>\n\
        {body}</tbody></table></div>\
        <p class=\"caption\">Of the dispersed runs that were computed. <sup>*</sup> {caption}.</p>\n"
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

/// The nominal and the worst runs with inputs, reason, and replay command.
pub fn worst_runs(plan: &Plan, survey: &Survey, runs: &[ShownRun]) -> String {
    let columns = plan.dispersions.columns();
    let spreads: Vec<f64> =
        columns.iter().zip(&survey.thinned.inputs).map(|(column, values)| spread(values, column.nominal)).collect();
    let mut body = String::new();
    for shown in runs {
        let mut inputs: Vec<(f64, String)> = columns
            .iter()
            .zip(&shown.inputs)
            .enumerate()
            .map(|(index, (column, value))| {
                let shown = unit_of_input(plan, index);
                let name = names::of_component(column.parameter, column.component);
                let sigmas = (value - column.nominal).abs() / spreads[index];
                let values = drawn([*value, column.nominal].map(|value| shown.value(value)), &shown.unit);
                let text = match plan.dispersions.distribution_of(index) {
                    // deviations of a discrete distribution have no sigma
                    Some(Transform::Scalar(distribution)) if distribution.steps().is_some() => values
                        .strip_suffix(", ")
                        .map_or(values.trim_end_matches(" (").to_owned(), |of| format!("{of})")),
                    _ => format!("{values}{}\u{a0}\u{3c3})", number(libm::round(10.0 * sigmas) / 10.0)),
                };
                (sigmas, format!("{name} {text}"))
            })
            .collect();
        inputs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let listed: Vec<String> = inputs.into_iter().take(MOST_INPUTS).map(|(_, text)| escaped(&text)).collect();
        let listed = if shown.sample.0 == 0 { "nominal values".to_owned() } else { listed.join("<br>") };
        let reached = shown.run.as_ref().is_some_and(|run| run.outcome.points.min(run.grid.points()) > 1);
        let why = if shown.sample.0 == 0 { "nominal run" } else { &shown.why };
        // a computed run without an end has nothing to add
        let ended = if shown.status == Status::Done {
            loss::of_row(&shown.row).map(|end| escaped(&sentence(&end)))
        } else {
            Some(format!("<b>{}</b>: {}", shown.status.name(), escaped(&shown.reason)))
        };
        let status = ended.map_or_else(String::new, |ended| format!("<p class=\"ended\">{ended}</p>"));
        let load = if reached {
            format!("<button type=\"button\" class=\"load\" data-sample=\"{}\">show</button>", shown.sample)
        } else {
            "not run".to_owned()
        };
        body += &format!(
            "<tr><th scope=\"row\">{}</th><td class=\"text\">{}{status}</td><td class=\"text \
            small\">{listed}</td><td><code>spindrift simulate plan.toml --sample {}</code></td><td>{load}</td></tr>\n",
            shown.sample,
            escaped(&sentence(why)),
            shown.sample,
        );
    }
    format!(
        "<div class=\"table\" id=\"worst\" tabindex=\"0\"><table><thead><tr><th>sample</th><th>why it is listed</th>\
        <th>inputs farthest from nominal</th><th>command</th><th>3D</th></tr></thead><tbody>\n{body}</tbody></table>\
        </div>\n"
    )
}

/// Plan, files, reproduction, glossary, licences.
pub fn provenance(plan: &Plan, survey: &Survey, files: &[(String, String)]) -> String {
    let listed: String = files
        .iter()
        .map(|(name, hash)| {
            format!("<tr><th scope=\"row\">{}</th><td><code>{}</code></td></tr>", escaped(name), escaped(hash))
        })
        .collect();
    let files = if files.is_empty() {
        String::new()
    } else {
        format!(
            "<details><summary>Files and their SHA-256</summary><div \
            class=\"table\"><table><tbody>{listed}</tbody></table></div></details>"
        )
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
