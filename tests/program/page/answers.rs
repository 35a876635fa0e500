//! Every answer and every run of the list of worst runs against summary and rows, in the unit that is shown.

use crate::prelude::*;

use crate::page::numbers::{failing, read_number};
use crate::small_campaign::RADIANS;

pub(crate) fn between<'t>(text: &'t str, from: &str, to: &str) -> &'t str {
    let (_, rest) = text.split_once(from).unwrap_or_else(|| panic!("no {from} in {text}"));
    rest.split_once(to).unwrap_or_else(|| panic!("no {to} in {rest}")).0
}

pub(crate) fn si(text: &str) -> f64 {
    let percent = || Some((text.strip_suffix('%')?, "%"));
    let (number, unit) = text.split_once(['\u{a0}', ' ']).or_else(percent).unwrap_or((text, ""));
    let scale = match unit {
        "deg" | "deg/s" => degrees(1.0),
        "%" => 100.0,
        _ => 1.0,
    };
    if ["?", "-"].contains(&text) { f64::NAN } else { read_number(number) / scale }
}

pub(crate) fn same(text: &str, expected: &Value, what: &str) {
    let (found, expected) = (si(text), expected.as_f64().unwrap_or(f64::NAN));
    let is_same = found.is_nan() && expected.is_nan() || (found - expected).abs() <= 6e-3 * expected.abs();
    assert!(is_same, "{what}: {text} for {expected}");
}

fn plain(markup: &str) -> String {
    let parts = markup.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text));
    parts.collect::<String>().replace("&lt;", "<").replace("&gt;", ">")
}

fn answers(page: &str) -> Vec<(&str, &str)> {
    let list = page.split("<details class=\"answer ").skip(1);
    list.map(|row| row.split_once("</details>").unwrap().0.split_once('"').unwrap()).collect()
}

/// Number, ends and unit of an answer, and the places of its dot and of its limit on the scale.
fn answer_shows(row: &str, name: &str, value: &Value, interval: &Value, limit: Option<(&Value, bool)>) {
    let cell = between(row, "<span class=\"number\">", "</span></span><span>").replace("<br>", "|");
    let said = plain(&cell);
    let (number, statistic) = said.split_once('|').unwrap();
    // the row of a mean goes on with its assumption
    assert_eq!(statistic.split('|').next(), Some(name), "{row}");
    let (estimate, ends) = number.split_once(" [").unwrap_or((number, "?, ?]"));
    let (ends, unit) = ends.split_once(']').unwrap();
    let unit = if estimate.ends_with('%') { "%".to_owned() } else { unit.to_owned() };
    let with = |text: &str| {
        if text == "?" || text.ends_with('%') { text.to_owned() } else { format!("{}{unit}", text.trim()) }
    };
    same(&with(estimate), value, name);
    let (low, high) = ends.split_once(", ").unwrap();
    for (place, (text, sign)) in [(low, 1.0), (high, -1.0)].into_iter().enumerate() {
        let (shown, found) = (si(&with(text)), interval[place].as_f64().unwrap_or(f64::NAN));
        let beyond = sign * (found - shown);
        let is_right =
            shown.is_nan() && found.is_nan() || beyond >= -1e-9 * found.abs() && beyond <= 2e-2 * found.abs();
        assert!(is_right, "{name}, end {place}: {text} for {found}");
    }
    let Some((limit, is_most)) = limit else { return };
    let scale = between(row, "<svg class=\"scale\"", "</svg>");
    let place = |class: &str, key: &str| -> f64 {
        let mark = between(scale, &format!("class=\"{class}\" "), "/>");
        between(mark, &format!("{key}=\""), "\"").parse().unwrap()
    };
    let (dot, line) = (place("dot", "cx"), place("limit", "x1"));
    let beyond = limit.as_f64().unwrap() - value.as_f64().unwrap();
    assert!(beyond * (line - dot) >= 0.0, "the limit is on the other side: {scale}");
    if scale.contains("class=\"whisker\"") {
        assert!(place("whisker", "x1") <= dot && dot <= place("whisker", "x2"), "{scale}");
    }
    let [x, width] = ["x", "width"].map(|key| place("within", key));
    assert!(if is_most { x == 0.0 && (width - line).abs() < 0.11 } else { (x - line).abs() < 0.11 }, "{scale}");
}

/// Law: each requirement is one row with what the summary says; failures come first.
#[test]
fn answers_are_the_summary() {
    let lower = "[[require]]\nobservable = \"nutation_angle_max_rad\"\nquantile = 0.05\nat_least = \"1 deg\"\n";
    let more = motion().replace("\"1e-4 deg\"", "\"9 deg\"") + lower;
    for (name, text) in [("answers", more), ("answers-failing", failing())] {
        let found = found(name, &text);
        let (summary, page) = (found.scratch.summary("r"), found.visible());
        let list = summary["requirements"]["list"].as_array().unwrap();
        let confidence = summary["requirements"]["confidence_of_intervals"].as_f64().unwrap();
        let said = format!("in brackets: two-sided {}% intervals", 100.0 * confidence);
        assert_eq!(page.matches(&said).count(), 1, "{said}");
        let rows = answers(&page);
        assert_eq!(rows.len(), list.len());
        let classes: Vec<&str> = rows.iter().map(|(class, _)| *class).collect();
        let order = ["fail", "undecided", "pass"];
        let places = classes.iter().map(|class| order.iter().position(|one| one == class).unwrap());
        assert!(places.clone().is_sorted(), "{classes:?}");
        for (class, row) in rows {
            let place: usize = between(row, "id=\"answer_requirement_", "\"").parse().unwrap();
            let one = &list[place - 1];
            let verdict = one["verdict"].as_str().unwrap();
            assert!(
                class == verdict.to_lowercase() && row.contains(&format!("<b class=\"word\">{verdict}</b>")),
                "{row}"
            );
            let (side, is_most) = if one["at_most"].is_null() { ("at_least", false) } else { ("at_most", true) };
            let number = |key: &str| one[key].as_f64().unwrap_or_else(|| panic!("{key}: {one}"));
            let asked = plain(between(row, "<span class=\"asked\">", "</span>"));
            let (_, limit) = asked.split_once(if is_most { "\u{2264} " } else { "\u{2265} " }).unwrap();
            same(limit.split(" in ").next().and_then(|text| text.split(", ").next()).unwrap(), &one[side], &asked);
            let share = Value::from(one["target"].as_f64().map_or(f64::NAN, |target| {
                if one["statement"] == "quantile" && !is_most { 1.0 - target } else { target }
            }));
            let [runs, violations, missing] = ["runs", "violations", "runs_without_a_value"].map(number);
            let within = "runs within the limit";
            match one["statement"].as_str() {
                Some("mean") => {
                    answer_shows(row, "mean", &one["estimate"], &one["interval"], Some((&one[side], is_most)));
                }
                Some("quantile") if !one["value"].is_null() => {
                    let quantile = found.quantile(one["observable"].as_str().unwrap(), &one["target"]);
                    let name = format!("p{}", 100.0 * number("target"));
                    answer_shows(row, &name, &one["value"], &quantile["interval"], Some((&one[side], is_most)));
                }
                _ => answer_shows(row, within, &one["estimate"], &one["interval"], Some((&share, false))),
            }
            let counts = format!("{} of {runs} runs {}", runs - violations, "within the limit");
            assert!(one["statement"] == "mean" || plain(row).contains(&counts), "{counts}: {row}");
            let is_said = [row.contains(&format!("{missing} runs without a value")), row.contains("without a value")];
            assert!(missing == 0.0 || is_said.contains(&true), "{row}");
        }
    }
}

/// Outcomes, one of them negative in some runs, shown in another unit than that of their columns.
const SHOWN: [(&str, &str, bool); 4] = [
    ("angular rate at the end", "angular_rate_final_rad_s", false),
    ("maximum nutation angle", "nutation_angle_max_rad", false),
    ("angular velocity about s1 at the end", "omega_se_s_x_final_rad_s", false),
    ("maximum energy error", "energy_error_max", false),
];

fn found_outcomes(name: &str) -> Found {
    let columns: Vec<String> = SHOWN.iter().map(|(_, column, _)| format!("{column:?}")).collect();
    let text = motion().replace(RADIANS, "").split("[audit]").next().unwrap().to_owned()
        + &format!("[summary]\ncolumns = [{}]\n[display]\nunits = [\"deg\", \"deg/s\"]\n", columns.join(", "));
    found(name, &text)
}

/// Law: without requirements each outcome is a row, and the page has an example that the program accepts.
#[test]
fn outcomes_are_the_summary() {
    let found = found_outcomes("answers-found");
    let page = found.visible();
    let rows = answers(&page);
    assert!(rows.len() >= SHOWN.len(), "{}", rows.len());
    for (words, name, _) in SHOWN {
        let (class, row) = rows.iter().find(|(_, row)| row.contains(&format!("id=\"answer_{name}\""))).expect(name);
        let asked = plain(between(row, "<span class=\"asked\">", "</span>"));
        assert!(*class == "finding" && asked.to_lowercase().starts_with(words), "{asked}");
        let median = found.quantile(name, &0.5.into());
        answer_shows(row, "median", &median["value"], &median["interval"], None);
    }
    let example = plain(between(&page, "<details class=\"example\">", "</code>"));
    let example = example.replace("&#10;", "\n").replace("&quot;", "\"");
    let (_, example) = example.split_once("[[require]]").unwrap();
    let text = motion().split("[[require]]").next().unwrap().to_owned() + "[[require]]" + example + "\n";
    found.scratch.file("example.toml", &text);
    found.scratch.prints("check example.toml", 0);
}

/// Law: a small picture has the non-empty classes of the large histogram, the runs that miss the limit, and the limit.
#[test]
fn small_pictures_are_the_figures() {
    let found = found("answers-pictures", &motion().replace("2100 deg/s", "1500 deg/s"));
    let page = found.visible();
    let (_, row) = answers(&page).into_iter().find(|(_, row)| row.contains("answer_requirement_1\"")).unwrap();
    let picture = between(row, "<svg class=\"small\"", "</svg>");
    let figure = found.figure("histogram_angular_rate_final_rad_s");
    let bars = |kind: &str| {
        let marks = figure["marks"].as_array().unwrap().iter().filter(|mark| mark["kind"] == "bars");
        let missed = marks.filter(|mark| (mark["label"] == "runs") == (kind == "runs"));
        missed.flat_map(|mark| found.array(&mark["heights"])).filter(|height| *height > 0.0).count()
    };
    let missed = picture.matches("class=\"missed\"").count();
    assert_eq!([picture.matches("<rect").count(), missed], [bars("runs"), bars("missed")]);
    assert!(missed > 0 && picture.contains("class=\"limit\"") && plain(picture).contains("1500 deg/s"), "{picture}");
}

/// Law: a listed run has its rank, value, inputs (farthest first) and command.
#[test]
fn listed_runs_have_their_ranks() {
    let of_requirements = [
        ("angular rate at the end", "angular_rate_final_rad_s", false),
        ("minimum nutation angle", "nutation_angle_min_rad", true),
        ("spin ratio", "spin_ratio", false),
        ("rate w1 at the end", "rate_w1_final_rad_s", false),
    ];
    let inputs = ["x", "y", "z"]
        .map(|axis| (format!("initial angular velocity {axis}"), format!("initial_angular_velocity_{axis}_rad_s")));
    let wall = ["fuselage wall thickness", "body_parts_fuselage_wall_thickness_m"].map(str::to_owned);
    for (found, outcomes, shown) in [
        (found("listed", &motion()), of_requirements, 3),
        (found("listed-failing", &failing()), of_requirements, 2),
        (found_outcomes("listed-found"), SHOWN, SHOWN.len()),
    ] {
        let ordered = |column: &str, is_low: bool| {
            let mut ordered = found.rows(&[column]);
            let size = |row: &(u64, Vec<f64>)| if is_low { -row.1[0] } else { row.1[0].abs() };
            ordered.sort_by(|a, b| size(b).total_cmp(&size(a)));
            ordered
        };
        let page = found.visible();
        let mut inputs = inputs.to_vec();
        if page.contains(&wall[0]) {
            inputs.push((wall[0].clone(), wall[1].clone()));
        }
        let columns = found.all(&inputs.iter().map(|(_, column)| column.as_str()).collect::<Vec<_>>());
        let (mut first, mut later, mut missed) = (0, 0, u64::MAX);
        let are_decisive = page.contains("<th scope=\"col\">inputs that decide");
        for row in between(&page, "id=\"worst\"", "</section>").split("<tr>").skip(2) {
            let sample = between(row, "<th scope=\"row\">", "</th>");
            assert_says(row, [&format!("--sample {sample}</code>")]);
            let why = between(row, "<td class=\"text\">", "</td>").split("<p").next().unwrap().to_lowercase();
            for why in why.split("; ") {
                if let Some((what, value)) = why.split_once(" (") {
                    // the rank says what a maximum or a minimum is
                    let short = |words: &'static str| {
                        words.strip_prefix("maximum ").or(words.strip_prefix("minimum ")).unwrap_or(words)
                    };
                    let of = |(words, ..): &&(&'static str, &str, bool)| what.ends_with(short(words));
                    let (words, column, is_low) = outcomes.iter().find(of).unwrap_or_else(|| panic!("{what}"));
                    let rank = what.strip_suffix(short(words)).unwrap().trim_end();
                    assert!(!rank.ends_with("maximum") && !rank.ends_with("minimum"), "{what}");
                    let side = if *is_low { "smallest" } else { "largest" };
                    let place = rank.strip_suffix(side).expect(side).trim_end();
                    let place = "|second|third|fourth|fifth|sixth|seventh|eighth|ninth|tenth"
                        .split('|')
                        .position(|word| word == place);
                    let place = place.unwrap_or_else(|| panic!("{rank}"));
                    let ordered = ordered(column, *is_low);
                    assert_eq!(sample, ordered[place].0.to_string(), "{why}");
                    same(value.trim_end_matches(')'), &ordered[place].1[0].into(), why);
                    *if place == 0 { &mut first } else { &mut later } += 1;
                } else if let Some(count) = why.strip_prefix("misses ") {
                    // the more requirements a run misses, the sooner it is listed
                    let count = count.split(' ').next().unwrap().parse().unwrap_or(1);
                    assert!(0 < count && count <= missed, "{why}");
                    missed = count;
                } else if !why.starts_with("nearest to ") {
                    let not_computed = ["computation failed: ", "invalid: not physical", "inaccurate"];
                    let is_said = not_computed.iter().any(|words| why.starts_with(words));
                    assert!(is_said || (why, sample) == ("nominal run", "0"), "{why}");
                }
            }
            if sample == "0" {
                continue;
            }
            let sample: usize = sample.parse().unwrap();
            let mut last = f64::INFINITY;
            for input in between(row, "<td class=\"text small\">", "</td>").split("<br>") {
                let place = inputs.iter().position(|(one, _)| input.starts_with(&format!("{one} ")));
                let place = place.unwrap_or_else(|| panic!("{input}"));
                let name = &inputs[place].0;
                let (values, nominal) = (&columns[place], columns[place][0]);
                let (value, rest) = input[name.len() + 1..].split_once(" (").unwrap();
                let rest = rest.strip_suffix(" \u{3c3})").unwrap();
                let (known, sigmas) = rest.rsplit_once(", ").unwrap_or(("nominal 0", rest));
                same(value, &values[sample].into(), name);
                same(known.strip_prefix("nominal ").unwrap(), &nominal.into(), name);
                let squares: f64 = values.iter().map(|value| (value - nominal).powi(2)).sum();
                let distance = (values[sample] - nominal).abs() / squares.sqrt();
                let spread = (squares / (values.len() - 1) as f64).sqrt();
                assert!(((values[sample] - nominal).abs() / spread - read_number(sigmas)).abs() < 0.1, "{input}");
                assert!(are_decisive || distance <= last, "{row}");
                last = distance;
            }
        }
        assert!((shown..=outcomes.len()).contains(&first), "the first of each outcome: {first}");
        assert!(later > 2, "{later} others");
    }
}
