//! Every card and every run of the list of worst runs against summary and rows, in the unit that is shown.

use std::collections::BTreeSet;

use serde_json::Value;

use crate::commands::screen_numbers::says;
use crate::page::numbers::{Found, degrees, failing, found, motion, read_number};
use crate::small_campaign::RADIANS;

/// What is between two texts.
pub(crate) fn between<'t>(text: &'t str, from: &str, to: &str) -> &'t str {
    let (_, rest) = text.split_once(from).unwrap_or_else(|| panic!("no {from} in {text}"));
    rest.split_once(to).unwrap_or_else(|| panic!("no {to} in {rest}")).0
}

/// A number of the page in the unit of its column; NaN where there is none.
pub(crate) fn si(text: &str) -> f64 {
    let percent = || Some((text.strip_suffix('%')?, "%"));
    let (number, unit) = text.split_once('\u{a0}').or_else(percent).unwrap_or((text, ""));
    let scale = match unit {
        "deg" | "deg/s" => degrees(1.0),
        "%" => 100.0,
        _ => 1.0,
    };
    if text == "not bounded" { f64::NAN } else { read_number(number) / scale }
}

/// The text is the number, in the digits that are shown: three before a power of ten, else four.
pub(crate) fn same(text: &str, expected: &Value, what: &str) {
    let (found, expected) = (si(text), expected.as_f64().unwrap_or(f64::NAN));
    let digits = if text.contains(['\u{d7}', '%']) { 5e-3 } else { 6e-4 };
    let is_same = found.is_nan() && expected.is_nan() || (found - expected).abs() <= digits * expected.abs();
    assert!(is_same, "{what}: {text} for {expected}");
}

/// What a card has: its statistic, estimate, ends of the interval; word and value of the limit.
struct Known<'v> {
    statistic: String,
    estimate: &'v Value,
    ends: &'v Value,
    limit: Option<(&'v str, &'v Value)>,
}

/// Text and picture of a card are of what is known.
fn card_shows(card: &str, known: &Known<'_>) {
    let detail = between(card, "<p class=\"detail\"><b>", "</p>");
    let (statistic, rest) = detail.split_once(":</b> ").expect("a statistic");
    assert_eq!(statistic, known.statistic, "{card}");
    let (number, interval) = rest.split_once(" [").expect("an interval");
    let (ends, unit) = interval.split_once(']').expect("one notation");
    let (low, high) = ends.split_once(", ").expect("two ends");
    let unit = if number.ends_with('%') { "%" } else { unit };
    let of =
        |end: &str| if end == "not bounded" { end.to_owned() } else { format!("{}{unit}", end.trim_end_matches('%')) };
    let (estimate, low, high) = (of(number), of(low), of(high));
    let (estimate, low, high) = (estimate.as_str(), low.as_str(), high.as_str());
    same(estimate, known.estimate, statistic);
    contains([low, high], known.ends);
    // an end that is not bounded is NaN
    assert!([low, estimate, high].map(si).into_iter().filter(|end| !end.is_nan()).is_sorted(), "{detail}");

    // the picture: the dot in its whisker, the limit on its side, both with their numbers
    let place = |class: &str, key: &str| -> f64 {
        between(between(card, &format!("class=\"{class}\" "), "/>"), &format!("{key}=\""), "\"")
            .parse()
            .expect("a place")
    };
    let dot = place("dot", "cx");
    assert!(place("whisker", "x1") <= dot && dot <= place("whisker", "x2"), "{card}");
    let texts: Vec<&str> = card.split("<text ").skip(1).map(|text| between(text, ">", "<")).collect();
    // of a finding also the smallest and the largest value, at the ends of what was found
    let ends = if card.contains("card finding") { 2 } else { 0 };
    assert_eq!((texts[0], texts.len()), (estimate, 1 + usize::from(known.limit.is_some()) + ends));
    if ends > 0 {
        let [low, high] =
            [("smallest ", 1), ("largest ", 2)].map(|(word, at)| si(texts[at].strip_prefix(word).expect(word)));
        assert!(low <= si(estimate) && si(estimate) <= high, "{card}");
        let (_, largest) = card.split_once("largest is ").or(card.split_once(" and ")).expect("the extremes");
        assert!(largest.contains(texts[2].strip_prefix("largest ").expect("the largest")), "{card}");
    }
    if let Some((side, limit)) = known.limit {
        same(texts[1].strip_prefix(side).expect(side).trim_start(), limit, "limit");
        let (beyond, right) = (limit.as_f64().expect("a limit") - si(estimate), place("limit", "x1") - dot);
        assert!(beyond * right > 0.0, "{card}");
    }
}

/// The interval that is shown contains the one that was found, and is hardly larger: at most a step of three digits.
fn contains(shown: [&str; 2], found: &Value) {
    for (place, sign) in [(0, 1.0), (1, -1.0)] {
        let (shown, found) = (si(shown[place]), found[place].as_f64().unwrap_or(f64::NAN));
        let beyond = sign * (found - shown);
        let is_right =
            shown.is_nan() && found.is_nan() || beyond >= -1e-9 * found.abs() && beyond <= 1.01e-2 * found.abs();
        assert!(is_right, "end {place}: {shown} for {found}");
    }
}

fn cards(page: &str) -> Vec<&str> {
    page.split("<article").skip(1).map(|card| card.split("</article>").next().expect("a card")).collect()
}

/// Law: the card of every requirement has verdict, limit, estimate, bounds, confidence and counts of the summary, lower end first.
#[test]
fn cards_of_requirements_are_the_summary() {
    let lower = "[[require]]\nobservable = \"nutation_angle_max_rad\"\nquantile = 0.05\nat_least = \"1 deg\"\n";
    let more = motion().replace("\"1e-4 deg\"", "\"9 deg\"") + lower;
    for (name, text) in [("cards", more), ("cards-failing", failing())] {
        let found = found(name, &text);
        let (summary, page) = (found.scratch.summary("r"), found.visible());
        let list = summary["requirements"]["list"].as_array().expect("requirements");
        let confidence = summary["requirements"]["confidence_of_intervals"].as_f64().expect("one of all");
        let cards = cards(&page);
        assert_eq!(cards.len(), list.len());
        // the confidence of what is in brackets is said once
        let said = format!("in brackets: two-sided {}% intervals", 100.0 * confidence);
        assert_eq!((page.matches(&said).count(), page.matches("% interval").count()), (1, 1), "{said}");
        for (card, one) in cards.into_iter().zip(list) {
            assert!(
                card.contains(&format!("<span class=\"word\">{}</span>", one["verdict"].as_str().unwrap())),
                "{card}"
            );
            let side = if one["at_most"].is_null() { "at least" } else { "at most" };
            let limit = &one[side.replace(' ', "_")];
            let number = |key: &str| one[key].as_f64().unwrap_or_else(|| panic!("{key}: {one}"));
            // the sentence
            let sentence = between(card, "</h3><p>", "</p>");
            let (kept, rest) = sentence.split_once(&format!(" {side} ")).expect(side);
            same(rest.split(", with ").next().unwrap(), limit, sentence);
            let confidence = rest.split(", with ").nth(1).and_then(|rest| rest.strip_suffix("% confidence."));
            assert!((read_number(confidence.expect("a confidence")) - 100.0 * number("confidence")).abs() < 1e-9);
            let share = match (one["statement"].as_str(), side) {
                (Some("mean"), _) => None,
                (Some("quantile"), "at least") => Some(1.0 - number("target")),
                _ => Some(number("target")),
            };
            assert_eq!(
                kept.split_once("% of the runs").map(|(share, _)| read_number(share.trim_start_matches("In ")) / 100.0),
                share,
                "{sentence}"
            );
            // estimate and bounds
            let quantile;
            let (statistic, estimate, ends, limit) = match one["statement"].as_str() {
                Some("mean") => ("Mean".to_owned(), &one["estimate"], &one["interval"], (side, limit)),
                Some("fraction") => {
                    let statistic = "Runs within the limit".to_owned();
                    (statistic, &one["estimate"], &one["interval"], ("at least", &one["target"]))
                }
                _ => {
                    quantile = found.quantile(one["observable"].as_str().expect("a name"), &one["target"]);
                    let statistic = format!("{}% quantile", 100.0 * number("target"));
                    (statistic, &one["value"], &quantile["interval"], (side, limit))
                }
            };
            let [runs, violations, missing] = ["runs", "violations", "runs_without_a_value"].map(number);
            // a twentieth without a value is enough to have p95 among them
            if one["statement"] == "quantile" && missing > 0.05 * runs {
                assert!(estimate.is_null() && !card.contains(&format!("<b>{statistic}")), "{card}");
            } else {
                card_shows(card, &Known { statistic, estimate, ends, limit: Some(limit) });
            }
            // counts
            let note = between(card, "<b>Note:</b> ", "</p>");
            assert!(note.starts_with(&format!("{} of {runs} runs are within the limit.", runs - violations)), "{note}");
            let counted = format!("{missing} runs without a value count as violations.");
            let is_said = [note.contains(&counted), note.contains("without a value")];
            assert_eq!(is_said, [missing > 0.0; 2], "{note}");
        }
    }
}

/// Outcomes of which one is negative in some runs, in another unit than that of their columns.
const SHOWN: [(&str, &str, bool); 4] = [
    ("angular rate at the end", "angular_rate_final_rad_s", false),
    ("maximum nutation angle", "nutation_angle_max_rad", false),
    ("angular velocity about s1 at the end", "omega_se_s_x_final_rad_s", false),
    ("maximum energy error", "energy_error_max", false),
];

/// A campaign of these without requirements.
fn found_outcomes(name: &str) -> Found {
    let columns: Vec<String> = SHOWN.iter().map(|(_, column, _)| format!("{column:?}")).collect();
    let text = motion().replace(RADIANS, "").split("[audit]").next().expect("a campaign").to_owned()
        + &format!("[summary]\ncolumns = [{}]\n[display]\nunits = [\"deg\", \"deg/s\"]\n", columns.join(", "));
    found(name, &text)
}

/// Law: without requirements each outcome has a card with quantile, interval and extremes of the summary.
#[test]
fn cards_of_outcomes_are_the_summary() {
    let found = found_outcomes("cards-found");
    let (summary, page) = (found.scratch.summary("r"), found.visible());
    let cards = cards(&page);
    assert_eq!(cards.len(), SHOWN.len());
    says(
        &page,
        "# dispersed runs and the nominal one \u{b7} design random \u{b7} seed # \u{b7} # s each",
        &[299.0, 7.0, 1.0],
    );
    let mut seen = [0; 2];
    for (card, (words, name, _)) in cards.into_iter().zip(SHOWN) {
        let of = |p: f64| found.quantile(name, &p.into());
        let list = summary["observables"].as_array().expect("observables");
        let one = list.iter().find(|one| one["name"] == name).expect(name);
        let high = of(0.99);
        let (statistic, estimate, ends) = ("99% quantile".to_owned(), &high["value"], &high["interval"]);
        card_shows(card, &Known { statistic, estimate, ends, limit: None });
        let sentence = between(card, "</h3><p>", ".</p>");
        assert!(sentence.contains(words), "{sentence}");
        let is_negative = one["min"].as_f64().expect("a number") < 0.0;
        let (before, numbers, known) = match is_negative {
            true => ("In 90%", [" between ", " and ", "; the extremes are ", " and "].as_slice(), vec![0.05, 0.95]),
            false => ("In 99%", [" below ", "; the largest is "].as_slice(), vec![0.99]),
        };
        seen[usize::from(is_negative)] += 1;
        let known: Vec<Value> = known.into_iter().map(|p| of(p)["value"].clone()).collect();
        let ends = if is_negative { vec![one["min"].clone(), one["max"].clone()] } else { vec![one["max"].clone()] };
        assert!(sentence.starts_with(before), "{sentence}");
        let mut rest = sentence;
        for (place, (word, known)) in numbers.iter().zip(known.iter().chain(&ends)).enumerate() {
            rest = rest.split_once(word).unwrap_or_else(|| panic!("{word}: {sentence}")).1;
            let end = numbers.get(place + 1).and_then(|next| rest.find(next)).unwrap_or(rest.len());
            same(&rest[..end], known, sentence);
        }
        let unbounded = "299 runs do not bound the 99% quantile from above with 95% confidence.";
        assert_eq!(card.contains(unbounded), high["interval"][1].is_null(), "{card}");
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
}

/// Law: a listed run has the rank that is said, among the dispersed runs that are ok, with the value of its row; its inputs are those of its row,
/// those that are farthest from nominal first; its command is that of its sample.
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
        let (mut first, mut later) = (0, 0);
        for row in between(&page, "id=\"worst\"", "</section>").split("<tr>").skip(2) {
            let sample = between(row, "<th scope=\"row\">", "</th>");
            assert!(row.contains(&format!("--sample {sample}</code>")), "{row}");
            let why = between(row, "<td class=\"text\">", "</td>").split("<p").next().expect("why").to_lowercase();
            let why = why.as_str();
            if let Some((what, value)) = why.split_once(" (") {
                // the rank says what a maximum or a minimum is
                let short = |words: &'static str| {
                    words.strip_prefix("maximum ").or(words.strip_prefix("minimum ")).unwrap_or(words)
                };
                let of = |(words, ..): &&(&'static str, &str, bool)| what.ends_with(short(words));
                let (words, column, is_low) = outcomes.iter().find(of).unwrap_or_else(|| panic!("{what}"));
                let rank = what.strip_suffix(short(words)).expect("a rank").trim_end();
                assert!(!rank.ends_with("maximum") && !rank.ends_with("minimum"), "{what}");
                let side = if *is_low { "smallest" } else { "largest" };
                let place = rank.strip_suffix(side).expect(side).trim_end();
                let place = ["", "second", "third", "fourth", "fifth"].iter().position(|word| *word == place);
                let place = place.unwrap_or_else(|| panic!("{rank}"));
                let ordered = ordered(column, *is_low);
                assert_eq!(sample, ordered[place].0.to_string(), "{why}");
                same(value.trim_end_matches(')'), &ordered[place].1[0].into(), why);
                *if place == 0 { &mut first } else { &mut later } += 1;
            } else {
                let not_computed = ["computation failed: ", "invalid: not physical", "inaccurate"];
                let is_said = not_computed.iter().any(|words| why.starts_with(words));
                assert!(is_said || (why, sample) == ("nominal run", "0"), "{why}");
            }
            if sample == "0" {
                continue;
            }
            let sample: usize = sample.parse().expect("a sample");
            let mut last = f64::INFINITY;
            for input in between(row, "<td class=\"text small\">", "</td>").split("<br>") {
                let place = inputs.iter().position(|(one, _)| input.starts_with(&format!("{one} ")));
                let place = place.unwrap_or_else(|| panic!("{input}"));
                let name = &inputs[place].0;
                let (values, nominal) = (&columns[place], columns[place][0]);
                let (value, rest) = input[name.len() + 1..].split_once(" (").expect("a value");
                let rest = rest.strip_suffix("\u{a0}\u{3c3})").expect("sigmas");
                // a nominal value of zero goes without saying
                let (known, sigmas) = rest.rsplit_once(", ").unwrap_or(("nominal 0", rest));
                same(value, &values[sample].into(), name);
                same(known.strip_prefix("nominal ").expect("the nominal value"), &nominal.into(), name);
                let squares: f64 = values.iter().map(|value| (value - nominal).powi(2)).sum();
                let distance = (values[sample] - nominal).abs() / squares.sqrt();
                // one decimal is shown, and the nominal row may be among those that the spread is of
                let spread = (squares / (values.len() - 1) as f64).sqrt();
                assert!(((values[sample] - nominal).abs() / spread - read_number(sigmas)).abs() < 0.1, "{input}");
                assert!(distance <= last, "{row}");
                last = distance;
            }
        }
        // where all have cards: a run that is the first of two outcomes is listed once
        let distinct =
            || outcomes.iter().map(|(_, column, is_low)| ordered(column, *is_low)[0].0).collect::<BTreeSet<_>>();
        let shown = if shown == outcomes.len() { distinct().len() } else { shown };
        assert_eq!(first, shown, "the first of each outcome");
        assert!(later > 2, "{later} others");
    }
}
