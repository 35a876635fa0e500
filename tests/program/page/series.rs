//! Every series of every figure of outcomes, errors, inputs and quantities over time, against rows and summary.

use crate::prelude::*;

use crate::page::answers::same;
use crate::page::numbers::{failing, quantile, read_number};

fn scale(axis: &Value) -> f64 {
    if axis["unit"].as_str().unwrap().starts_with("deg") { degrees(1.0) } else { 1.0 }
}

fn text<'v>(value: &'v Value, key: &str) -> &'v str {
    value[key].as_str().unwrap_or_default()
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{what}: {found} for {expected}");
}

const BUCKET: f64 = 2e-3;

fn share(values: &[f64], limit: f64) -> f64 {
    values.iter().filter(|value| **value <= limit).count() as f64 / values.len() as f64
}

fn probability(label: &str) -> Option<f64> {
    if label == "median" { Some(0.5) } else { Some(label.strip_suffix("% quantile")?.parse::<f64>().ok()? / 100.0) }
}

fn bars_are(found: &Found, mark: &Value, values: &[f64], what: &str) {
    let [edges, heights] = ["edges", "heights"].map(|key| found.array(&mark[key]));
    assert_eq!(heights.iter().sum::<f64>(), values.len() as f64, "{what}");
    let slack = 1e-9 * (edges[edges.len() - 1] - edges[0]);
    let up_to = |edge: f64| values.iter().filter(|value| **value <= edge).count() as f64;
    for (ends, height) in edges.windows(2).zip(heights) {
        let [least, most] = [slack, -slack].map(|by| up_to(ends[1] - by) - up_to(ends[0] + by));
        assert!(least <= height && height <= most + 1.0, "{what}: {height} for {least} to {most} in {ends:?}");
    }
}

fn limits_on(found: &Found, column: &str) -> Vec<(f64, f64)> {
    let summary = found.scratch.summary("r");
    let list = summary["requirements"]["list"].as_array().unwrap().clone();
    let of_column = list.iter().filter(|one| one["observable"] == column && one["statement"] != "mean");
    let limit = |one: &Value| match one["at_most"].as_f64() {
        Some(limit) => (limit, 1.0),
        None => (one["at_least"].as_f64().unwrap(), -1.0),
    };
    of_column.map(limit).collect()
}

fn series_is(found: &Found, kind: &str, column: &str, (mark, factor): (&Value, f64), values: &[f64], nominal: f64) {
    let label = text(mark, "label");
    let what = format!("{label} of {kind}{column}");
    let of = |key: &str| found.array(&mark[key]);
    let interval_of = |p: f64| {
        let interval = found.quantile(column, &p.into())["interval"].clone();
        [0, 1].map(|end| factor * interval[end].as_f64().unwrap_or(f64::NAN))
    };
    let count = values.len() as f64;
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    match (kind, text(mark, "kind"), label) {
        ("histogram_", "bars", "runs") => bars_are(found, mark, values, &what),
        ("histogram_", "bars", "of these, miss its limit") => {
            let all = found.array(&found.mark(&format!("{kind}{column}"), "runs")["heights"]);
            let missed = of("heights");
            assert!(missed.iter().zip(&all).all(|(missed, all)| missed <= all), "{what}: {missed:?} of {all:?}");
            let limits = limits_on(found, column);
            let beyond =
                values.iter().filter(|value| limits.iter().any(|(limit, sign)| sign * (*value / factor - limit) > 0.0));
            assert_eq!(missed.iter().sum::<f64>(), beyond.count() as f64, "{what}: {limits:?}");
            assert!(missed.iter().sum::<f64>() > 0.0, "{what}");
        }
        ("histogram_", "limit", "nominal") => near(mark["at"].as_f64().unwrap(), nominal, 1e-9, &what),
        ("histogram_" | "cumulative_", "limit", _) => {
            let at = mark["at"].as_f64().unwrap() / factor;
            let (side, value) = label.split_at(if label.starts_with("at most") { 7 } else { 8 });
            same(value.trim_start(), &at.into(), &what);
            let summary = found.scratch.summary("r");
            let of_column = |one: &&Value| one["observable"] == column && one[side.replace(' ', "_")].is_number();
            let list = summary["requirements"]["list"].as_array().unwrap();
            let limits = list.iter().filter(of_column).map(|one| one[side.replace(' ', "_")].as_f64().unwrap());
            assert!(limits.into_iter().any(|limit| (limit / at - 1.0).abs() < 1e-9), "{what}: {at}");
        }
        ("cumulative_", "line", "fraction of runs") => {
            let width = 5e-3 * (high - low);
            for (x, y) in of("x").into_iter().zip(of("y")) {
                let [least, most] = [-width, width].map(|by| share(values, x + by));
                assert!(least <= y && y <= most, "{what}: {y} up to {x}, {least} to {most}");
            }
            assert_eq!((of("y")[0], of("y").last()), (1.0 / count, Some(&1.0)));
        }
        ("tail_", "line", "fraction of runs above") => {
            for (x, y) in of("x").into_iter().zip(of("y")) {
                let [most, least] = [1.0 - BUCKET, 1.0 + BUCKET].map(|by| 1.0 - share(values, x * by));
                assert!(least - 1e-12 <= y && y <= most + 1e-12, "{what}: {y} from {x} on, {least} to {most}");
            }
        }
        ("tail_", "points", "largest") => {
            near(of("x")[0], high, BUCKET, &what);
            let rows = found.rows(&[column]);
            let largest = rows.iter().max_by(|a, b| a.1[0].abs().total_cmp(&b.1[0].abs())).unwrap();
            assert_eq!((of("y"), of("samples")), (vec![1.0 / count], vec![largest.0 as f64]), "{what}");
        }
        ("cumulative_" | "tail_", "band", "95% interval") => {
            let line = if kind == "tail_" { "fraction of runs above" } else { "fraction of runs" };
            let shares = found.array(&found.mark(&format!("{kind}{column}"), line)["y"]);
            for ((low, high), share) in of("low").iter().zip(of("high")).zip(shares) {
                assert!(*low <= share && share <= high && *low < high, "{what}: {share} in {low} to {high}");
                assert!(high - low < 2.25 / count.sqrt(), "{what}: four standard deviations of a half are 2/sqrt(n)");
            }
        }
        ("convergence_", "band", "95% interval") => {
            let [low, high] = ["low", "high"].map(|key| *of(key).last().unwrap());
            let [from, to] = interval_of(0.99);
            near(low, from, BUCKET, &what);
            near(high, to, BUCKET, &what);
        }
        ("convergence_", "line", _) => {
            let p = probability(label).unwrap();
            for (runs, y) in of("x").into_iter().zip(of("y")) {
                near(y, quantile(&values[..runs as usize], p), BUCKET, &format!("{what} from {runs} runs"));
            }
            assert_eq!(of("x").last(), Some(&count));
        }
        ("cumulative_", "points", _) => {
            let p = probability(label).unwrap();
            near(of("x")[0], quantile(values, p), BUCKET, &what);
            assert_eq!(of("y"), [p]);
        }
        ("cumulative_", "line", _) => {
            let p = probability(label).unwrap();
            let [from, to] = interval_of(p);
            assert_eq!((of("y"), from < to), (vec![p; 2], true), "{what}");
            near(of("x")[0], from, BUCKET, &what);
            near(of("x")[1], to, BUCKET, &what);
        }
        other => panic!("nothing is known of {other:?} in {kind}{column}"),
    }
}

const LAST: [(&str, &str); 4] = [
    ("nadir_angle_rad", "nadir_angle_final_rad"),
    ("angular_rate_rad_s", "angular_rate_final_rad_s"),
    ("speed_w1_rad_s", "rate_w1_final_rad_s"),
    ("speed_w2_rad_s", "rate_w2_final_rad_s"),
];

/// Law: each band over time contains the narrower one, and ends as the rows do.
pub(crate) fn bands_are(found: &Found, figure: &Value) {
    let name = text(figure, "name");
    let marks = figure["marks"].as_array().unwrap();
    let named = |label: &str, key: &str| -> Vec<f64> {
        let mark = marks.iter().find(|mark| text(mark, "label").ends_with(label));
        found.array(&mark.unwrap_or_else(|| panic!("no {label} in {name}"))[key])
    };
    let five =
        [("5 to 95%", "low"), ("25 to 75%", "low"), ("median", "y"), ("25 to 75%", "high"), ("5 to 95%", "high")];
    let five = five.map(|(label, key)| named(label, key));
    for point in 0..five[0].len() {
        assert!(five.windows(2).all(|pair| pair[0][point] <= pair[1][point]), "{name}, point {point}");
    }
    let caption = format!(
        "of {} dispersed runs that were computed, at each of {} times",
        found.column("energy_error_max").len(),
        five[0].len()
    );
    assert!(text(figure, "caption").contains(&caption), "{figure}");
    let Some((_, last)) = LAST.iter().find(|(one, _)| *one == name) else { return };
    let values: Vec<f64> = found.column(last).into_iter().map(|value| value * scale(&figure["y"])).collect();
    let spread = quantile(&values, 0.95) - quantile(&values, 0.05);
    for (series, p) in five.iter().zip([0.05, 0.25, 0.5, 0.75, 0.95]) {
        let (end, known) = (*series.last().unwrap(), quantile(&values, p));
        assert!((end - known).abs() < 1e-2 * spread, "{p} of {name}: {end} for {known}");
    }
}

/// Law: the share of an event in a class of an input is that of the runs of the class, within its interval.
fn shares_are(found: &Found, figure: &Value) {
    let mark = &figure["marks"][0];
    let [x, low, high] = ["x", "low", "high"].map(|key| found.array(&mark[key]));
    let counts = figure["y"]["names"].as_array().unwrap().iter().map(|name| {
        let (_, counts) = name.as_str().and_then(|name| name.rsplit_once(": ")).unwrap();
        let (events, runs) = counts.split_once(" of ").unwrap();
        [events, runs].map(|count| count.parse::<f64>().unwrap())
    });
    let counts: Vec<[f64; 2]> = counts.collect();
    for (place, [events, runs]) in counts.iter().enumerate() {
        assert_eq!(x[place], events / runs, "{figure}");
        assert!(low[place].is_nan() || low[place] <= x[place] && x[place] <= high[place], "{figure}");
    }
    let name = text(figure, "name").strip_prefix("shares_").unwrap().to_owned();
    let summary = found.scratch.summary("r");
    let outcomes = summary["observables"].as_array().unwrap().iter().map(|one| text(one, "name"));
    let column = outcomes.filter(|one| name.starts_with(one)).max_by_key(|one| one.len()).unwrap();
    let mut rows = found.rows(&[&name[column.len() + 1..], column]);
    assert_eq!(counts.iter().map(|[_, runs]| runs).sum::<f64>(), rows.len() as f64, "{figure}");
    rows.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    let limits = limits_on(found, column);
    if !text(&figure["x"], "quantity").ends_with("miss the limit") {
        return;
    }
    let mut rows = rows.iter();
    for [events, runs] in counts {
        let class = rows.by_ref().take(runs as usize);
        let missed = class.filter(|(_, row)| limits.iter().any(|(limit, sign)| sign * (row[1] - limit) > 0.0));
        assert_eq!(missed.count() as f64, events, "{figure}");
    }
}

/// Law: each point of an outcome against an input is the run of its sample, and a failed one is at the lower edge.
fn scatter_is(found: &Found, figure: &Value, outcomes: &[&str]) {
    let name = text(figure, "name").strip_prefix("scatter_").unwrap();
    let is_of = |outcome: &&&str| name.strip_prefix(**outcome).is_some_and(|rest| rest.starts_with('_'));
    let outcome = outcomes.iter().filter(is_of).max_by_key(|outcome| outcome.len()).unwrap();
    let columns = found.all(&[&name[outcome.len() + 1..], outcome]);
    let ok: Vec<f64> = found.rows(&[]).into_iter().map(|(sample, _)| sample as f64).collect();
    let scales = ["x", "y"].map(|axis| scale(&figure[axis]));
    let mut lowest = f64::INFINITY;
    let mut all = Vec::new();
    for mark in figure["marks"].as_array().unwrap() {
        let is_ok = ["computed", "meets its limit", "misses its limit"].contains(&text(mark, "label"));
        let [samples, x, y] = ["samples", "x", "y"].map(|key| found.array(&mark[key]));
        for (k, sample) in samples.iter().enumerate() {
            let row = *sample as usize;
            assert_eq!(ok.contains(sample), is_ok, "{row} of {name}");
            near(x[k], columns[0][row] * scales[0], 1e-12, name);
            if is_ok {
                let value = columns[1][row] * scales[1];
                near(y[k], if *outcome == "energy_error_max" { value.abs() } else { value }, 1e-12, name);
                lowest = lowest.min(y[k]);
            } else {
                assert_eq!(y[k], lowest, "{name}");
            }
        }
        all.extend(samples);
    }
    assert_eq!(all.len(), columns[0].len() - 1, "every dispersed run once");
}

/// Law: of an outcome with several limits, crosses are the runs beyond the one that their label names, and discs are
/// all others; without a named limit there are none.
#[test]
fn crosses_mean_the_limit_of_their_row() {
    let scratch = ScratchFolder::new("series-crosses");
    let file = root().join("campaigns/acceptance.toml");
    scratch.prints(&format!("campaign {} --samples 400 --out r", file.display()), 3);
    let found = Found::read(scratch, String::new());
    let columns = found.all(&["energy_error_max"]);
    let mut seen = 0;
    for figure in found.figures().iter().filter(|figure| text(figure, "name").starts_with("scatter_")) {
        for mark in figure["marks"].as_array().unwrap() {
            let label = text(mark, "label");
            let Some((verb, limit)) = label.split_once(" the limit, at most ") else {
                assert_eq!(label, "computed", "{figure}");
                continue;
            };
            let limit = read_number(limit);
            for sample in found.array(&mark["samples"]) {
                assert_eq!(columns[0][sample as usize] > limit, verb == "misses", "sample {sample}: {label}");
                seen += 1;
            }
        }
    }
    assert!(seen >= 399, "{seen} points");
}

/// Law: where a page has not all runs, the points of its scatter plots are those of the samples that they name.
#[test]
fn thinned_points_are_of_their_samples() {
    const SAMPLES: usize = 17_000;
    let campaign = crate::small_campaign::campaign().replace("samples = 600", &format!("samples = {SAMPLES}"));
    let found = found("series-thinned", &campaign);
    let figures = found.figures();
    let mut points = 0;
    for figure in figures.iter().filter(|figure| text_of_scatter(figure).is_some()) {
        let (outcome, input) = text_of_scatter(figure).unwrap();
        let columns = found.all(&[&input, &outcome]);
        let scales = ["x", "y"].map(|axis| scale(&figure[axis]));
        for mark in figure["marks"].as_array().unwrap().iter().filter(|mark| text(mark, "kind") == "points") {
            let [samples, x, y] = ["samples", "x", "y"].map(|key| found.array(&mark[key]));
            assert!(samples.iter().any(|sample| *sample > 16_384.0), "of all runs");
            for ((sample, x), y) in samples.iter().zip(x).zip(y) {
                near(x, columns[0][*sample as usize] * scales[0], 1e-12, &input);
                near(y.abs(), columns[1][*sample as usize].abs() * scales[1], 1e-12, &outcome);
                points += 1;
            }
        }
    }
    assert!(points >= 2_000, "{points}");
}

fn text_of_scatter(figure: &Value) -> Option<(String, String)> {
    let name = text(figure, "name").strip_prefix("scatter_")?;
    let at = name.find("_initial_")?;
    Some((name[..at].to_owned(), name[at + 1..].to_owned()))
}

/// Law: any two columns to choose are those of the rows in the unit shown, and failed runs are marked.
#[test]
fn chosen_columns_are_of_the_rows() {
    let found = found("series-chosen", &failing());
    let pairs = &found.data["pairs"];
    let [samples, fates] = ["samples", "fates"].map(|key| found.array(&pairs[key]));
    assert_eq!((samples.len(), &pairs["all"]), (600, &600.into()));
    let ok = found.rows(&[]);
    for (sample, fate) in samples.iter().zip(fates) {
        let is_ok = *sample == 0.0 || ok.iter().any(|(one, _)| *one as f64 == *sample);
        assert_eq!(fate == 2.0, !is_ok, "{sample}");
    }
    let columns = pairs["columns"].as_array().unwrap();
    for column in columns {
        let name = text(column, "column");
        let (values, rows) = (found.array(&column["values"]), found.all(&[name]).swap_remove(0));
        for (sample, value) in samples.iter().zip(values) {
            let known = (rows[*sample as usize] * scale(column)) as f32;
            assert!(
                value == f64::from(known)
                    || value.is_nan() && known.is_nan()
                    || (value / f64::from(known) - 1.0).abs() < 1e-6,
                "{name} of {sample}: {value} for {known}"
            );
        }
    }
    assert!(columns.len() > 10 && columns.iter().any(|column| column["unit"] == "deg/s"));
}

/// Law: every series is what its label says, of the dispersed runs that are ok, in the unit of its axis.
#[test]
fn every_series_is_of_its_label() {
    let failing = failing();
    let bounded = motion().replace("samples = 300", "samples = 400");
    for (campaign, text_of, least) in [("series", bounded, 8), ("series-failing", failing, 8)] {
        let found = found(campaign, &text_of);
        let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
        let summary = found.scratch.summary("r");
        let outcomes: Vec<&str> =
            summary["observables"].as_array().unwrap().iter().map(|one| text(one, "name")).collect();
        for figure in found.figures() {
            let name = text(figure, "name");
            let marks = figure["marks"].as_array().unwrap();
            if marks.iter().any(|mark| text(mark, "label").ends_with("5 to 95%")) {
                bands_are(&found, figure);
                *seen.entry("bands").or_default() += 1;
            }
            if name.starts_with("scatter_") {
                scatter_is(&found, figure, &outcomes);
                *seen.entry("scatter_").or_default() += 1;
            }
            if name.starts_with("shares_") {
                shares_are(&found, figure);
                *seen.entry("shares_").or_default() += 1;
            }
            for kind in ["histogram_", "cumulative_", "tail_", "convergence_"] {
                let Some(column) = name.strip_prefix(kind) else { continue };
                let factor = scale(&figure[if kind == "convergence_" { "y" } else { "x" }]);
                let is_error = column.contains("error") || column.contains("orthonormality");
                let shown = |value: &f64| factor * if is_error { value.abs() } else { *value };
                let values: Vec<f64> = found.column(column).iter().map(shown).collect();
                let nominal = shown(&found.all(&[column])[0][0]);
                let count = format!("{} runs", values.len());
                assert!(kind == "convergence_" || text(figure, "caption").contains(&count), "{figure}");
                for mark in marks {
                    series_is(&found, kind, column, (mark, factor), &values, nominal);
                }
                *seen.entry(kind).or_default() += marks.len();
            }
            if let Some(column) = name.strip_prefix("input_") {
                let mut values = found.all(&[column]).swap_remove(0).split_off(1);
                let counted = format!("{} dispersed samples; ", values.len());
                assert!(text(figure, "caption").starts_with(&counted), "{figure}");
                values.iter_mut().for_each(|value| *value *= scale(&figure["x"]));
                bars_are(&found, &marks[0], &values, name);
                *seen.entry("input_").or_default() += 1;
            }
        }
        for (label, key) in [("body, 5% of runs", "low"), ("body, 95% of runs", "high")] {
            let band = found.array(&found.mark("exchange_body_j", "5 to 95%")[key]);
            assert_eq!(found.array(&found.mark("energy_transfer", label)["y"]), band, "{label}");
        }
        for (label, own) in [("body", "exchange_body_j"), ("wheel w1", "exchange_w1_j"), ("wheel w2", "exchange_w2_j")]
        {
            let part = found.mark("energy_transfer", label);
            let [low, high] = ["low", "high"].map(|key| found.array(&part[key]));
            let change = found.array(&found.mark(own, "nominal run")["y"]);
            let most = change.iter().fold(0.0, |most: f64, change| most.max(change.abs()));
            let heights = low.iter().zip(high).map(|(low, high)| high - low);
            assert!(heights.zip(change).all(|(height, change)| (height - change.abs()).abs() < 1e-5 * most), "{label}");
        }
        let audited = found.all(&["audit_state_error"])[0].iter().filter(|error| error.is_finite()).count();
        let caption = format!("{audited} of {audited} audited runs, each compared");
        assert!(text(found.figure("audits"), "caption").starts_with(&caption), "{audited}");
        let rows = found.all(&["energy_error_max"])[0].len();
        let caption = format!("coefficient of {} dispersed samples", rows - 1);
        assert!(text(found.figure("correlation_achieved"), "caption").contains(&caption));
        says(&found.visible(), "<p># samples of plan", &[rows as f64]);
        let kinds = ["bands", "histogram_", "cumulative_", "tail_", "convergence_", "input_", "scatter_", "shares_"];
        assert!(kinds.iter().all(|kind| seen.contains_key(kind)) && seen["histogram_"] >= least, "{seen:?}");
    }
}
