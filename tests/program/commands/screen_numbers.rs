//! Every number in a sentence of the screen is counted again: from rows, files, tables and the summary.

use std::path::PathBuf;

use serde_json::Value;

use crate::page::numbers::{failing, quantile};
use crate::reliability::failing_store::contents;
use crate::small_campaign::mixed_failures;
use crate::support::scratch_folder::{ScratchFolder, batches, column, ended};
use spindrift::statistics::binomial::interval;

/// A line with `#` in place of each number, and the numbers; digits within a word are none, and a `#` of the line
/// itself is `@`.
pub(crate) fn template(line: &str) -> (String, Vec<f64>) {
    let (mut text, mut numbers) = (String::new(), Vec::new());
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let is_within = text.ends_with(|last: char| last.is_alphanumeric() || "_.".contains(last));
        let digits = rest.strip_prefix('-').unwrap_or(rest);
        let mut end = 0;
        if !is_within && digits.starts_with(|digit: char| digit.is_ascii_digit()) {
            let all = rest.find(|c: char| !(c.is_ascii_digit() || "-.e".contains(c))).unwrap_or(rest.len());
            end = (1..=all).rev().find(|end| rest[..*end].parse::<f64>().is_ok()).unwrap_or(0);
        }
        if end > 0 {
            numbers.push(rest[..end].parse().expect("a number"));
            text.push('#');
            rest = &rest[end..];
        } else {
            text.push(if first == '#' { '@' } else { first });
            rest = &rest[first.len_utf8()..];
        }
    }
    (text, numbers)
}

/// The numbers of a text where its first line that has the pattern has a `#`.
pub(crate) fn numbers(said: &str, pattern: &str) -> Vec<f64> {
    let of = |line: &str| {
        let (text, numbers) = template(line);
        let before = text[..text.find(pattern)?].matches('#').count();
        Some(numbers[before..before + pattern.matches('#').count()].to_vec())
    };
    said.lines().find_map(of).unwrap_or_else(|| panic!("no `{pattern}` in:\n{said}"))
}

/// The numbers of the pattern are these: counts all of them, others in four digits, or in three where there are shares.
pub(crate) fn says(said: &str, pattern: &str, expected: &[f64]) {
    let found = numbers(said, pattern);
    // the ends of an interval are rounded outward to three digits
    let digits = if pattern.contains("[#") {
        1.01e-2
    } else if pattern.contains('%') {
        5.1e-3
    } else {
        6e-4
    };
    let is_same = |(found, expected): (&f64, &f64)| {
        let digits = if expected.fract() == 0.0 { 6e-4 } else { digits };
        (found - expected).abs() <= digits * expected.abs()
    };
    // an estimate and its interval have digits to the tenth of its half width
    let ends = pattern.find("[#, #]").map(|at| pattern[..at].matches('#').count());
    let half = ends.map_or(0.0, |at| 0.05 * (expected[at + 1] - expected[at]).abs());
    let of_interval = |place: usize| ends.is_some_and(|at| (at.saturating_sub(1)..at + 2).contains(&place));
    let is_right = |(place, pair): (usize, (&f64, &f64))| {
        is_same(pair) || of_interval(place) && (pair.0 - pair.1).abs() <= half * 1.0001
    };
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).enumerate().all(is_right),
        "{pattern}: {found:?}, {expected:?}"
    );
}

/// Law: the heads of a JUnit file count the elements in it; returns tests, failures and errors.
pub(crate) fn junit_counts(junit: &str) -> [usize; 3] {
    let counts = ["<testcase ", "<failure ", "<error "].map(|element| junit.matches(element).count());
    let heads = format!("tests=\"{}\" failures=\"{}\" errors=\"{}\"", counts[0], counts[1], counts[2]);
    assert_eq!(junit.matches(&heads).count(), 2, "{heads}: {junit}");
    counts
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Law: what `campaign` says of runs, requirements, errors, audits and files is what they are, also of a campaign that
/// was continued; JUnit says the same.
#[test]
fn a_campaign_counts_what_it_has() {
    let scratch = ScratchFolder::new("screen-campaign");
    scratch.file("c.toml", &failing().replace("duration_s = 1.0", "duration_s = 5.0"));
    let run = |options: &str| {
        let mut command = scratch.command(&format!("campaign c.toml --out r --threads 1 --verbose {options}"));
        scratch.outputs(command.env("COLUMNS", "200"), 3)
    };
    run("--samples 512");
    let before = scratch.parts("r");
    let said = run("--junit junit.xml");
    let made = scratch.parts("r").into_iter().zip(scratch.part_files("r")).filter(|(part, _)| !before.contains(part));
    let made: usize = made.flat_map(|(_, file)| batches(&file)).map(|batch| batch.num_rows()).sum();
    let (rows, summary) = (scratch.rows("r"), scratch.summary("r"));
    let ended = ended(&rows);
    let count = |status: &str| ended.iter().filter(|(_, one)| one == status).count() as f64;
    let of = |status: &str| {
        ended.iter().filter(|(_, one)| one == status).map(|(sample, _)| *sample as f64).collect::<Vec<_>>()
    };
    let (ok, invalid, inaccurate) = (count("ok"), count("invalid_sample"), count("inaccurate"));
    assert!(ok + invalid + inaccurate == 600.0 && invalid > 100.0 && inaccurate > 20.0);

    let headline = numbers(&said, "small: # of # runs (# nominal) computed, # of them now, in # s (#/s), seed #");
    let [computed, samples, nominal, now, seconds, rate, seed] = headline[..] else { panic!("{headline:?}") };
    assert_eq!([computed, samples, nominal, now, seed], [ok, 600.0, 1.0, made as f64, 7.0]);
    assert!((1..600).contains(&made), "continued");
    // seconds have two decimals, and the rate none
    let rounded = 0.0051 + 0.51 * seconds / rate;
    assert!((now / rate - seconds).abs() < rounded && seconds > 0.015, "{now} in {seconds} s, {rate} per second");

    says(&said, "small: # samples already there, # to run", &[samples - now, now]);
    let [_, share] = numbers(&said, "audits: # s of CPU time, #% of the total")[..] else { panic!("{said}") };
    assert!((50.0..100.0).contains(&share), "an audit takes a hundred times a run: {share}");

    says(&said, "# of # runs were computed", &[ok, 600.0]);
    says(&said, "# of # dispersed runs were not computed and are left out", &[600.0 - ok, 599.0]);
    says(&said, "# of # samples (#%) are not physical", &[invalid, 599.0, 100.0 * invalid / 599.0]);
    for (status, count) in [("invalid_sample", invalid), ("inaccurate", inaccurate)] {
        let first = of(status);
        says(&said, &format!("the first {status}: spindrift simulate c.toml --sample #"), &first[..1]);
        let listed = said.lines().filter(|line| line.starts_with("    ") && line.contains(&format!(" {status}: ")));
        assert_eq!(listed.map(|line| template(line).1[0]).sum::<f64>(), count, "{said}");
    }

    // requirements: on the screen and in JUnit
    let junit = scratch.text("junit.xml");
    let list = summary["requirements"]["list"].as_array().expect("requirements");
    // a case for the runs and one for the audits
    assert_eq!(junit_counts(&junit), [list.len() + 2, list.len() + 1, 0]);
    says(&junit, "message=\"# of # runs were computed\"", &[ok, 600.0]);
    for one in list {
        let sentence = one["in_short"].as_str().expect("a text");
        let [runs, violations, missing] = ["runs", "violations", "runs_without_a_value"].map(|key| number(&one[key]));
        // one convention everywhere: two-sided, Clopper and Pearson
        let [low, high] = interval((runs - violations) as u64, runs as u64, 0.95);
        assert_eq!([low, high], [0, 1].map(|end| number(&one["interval"][end])));
        let pattern = "# of # runs within the limit: #% [#, #]; # runs without a value count as violations";
        let within = runs - violations;
        let known = [within, runs, 100.0 * within / runs, 100.0 * low, 100.0 * high, missing];
        assert_eq!(missing, inaccurate);
        for text in [&said, &junit] {
            says(text.replace("&lt;", "<").split_once(sentence).expect("the requirement").1, pattern, &known);
        }
    }

    // the worst runs, among all that have a row
    let of_row = |names: &[&str]| -> Vec<f64> {
        let columns: Vec<Vec<f64>> = names.iter().map(|name| column(&rows, name)).collect();
        (0..600).map(|row| columns.iter().map(|values| values[row].abs()).fold(0.0, f64::max)).collect()
    };
    let balances = ["energy_error_max", "angular_momentum_error_max"];
    for (name, errors) in
        [("conservation error", of_row(&balances)), ("state error estimate", of_row(&["state_error_estimate"]))]
    {
        // of equal ones the first
        let worst = (0..600).rev().max_by(|a, b| errors[*a].total_cmp(&errors[*b])).expect("rows");
        let pattern = format!("worst {name} #: spindrift simulate c.toml --sample #");
        says(&said, &pattern, &[errors[worst], worst as f64]);
    }

    // errors and audits
    let line = |name: &str| {
        let list = summary["observables"].as_array().expect("observables");
        list.iter().find(|one| one["name"] == name).unwrap_or_else(|| panic!("no {name}"))
    };
    let largest = ["energy_error_max", "angular_momentum_error_max", "state_error_estimate"];
    let sentence = "largest errors, relative: energy #, angular momentum #, estimated state error #";
    says(&said, sentence, &largest.map(|name| number(&line(name)["max"])));
    let audit = &summary["audit"];
    let audited = number(&audit["audited"]);
    says(
        &said,
        "audit: # runs compared with reference solutions, # of them",
        &[audited, number(&audit["in_double_double"])],
    );
    let covered = number(&audit["estimate"]["covered"]);
    let known = [covered, audited, 100.0 * covered / audited, number(&audit["estimate"]["median_ratio"])];
    let found = numbers(&said, "state error estimate covers # of # true errors (#%), # times the error");
    assert!(found.iter().zip(known).all(|(found, known)| (found - known).abs() <= 6e-4 * known + 0.05), "{found:?}");
    let errors = [
        ("audit_state_error", "audit state error "),
        ("audit_omega_error", "audit omega error "),
        ("audit_attitude_error_rad", "audit attitude error, rad "),
    ];
    for (name, words) in errors {
        let errors: Vec<f64> = column(&rows, name).into_iter().skip(1).filter(|error| !error.is_nan()).collect();
        let known = [0.5, 0.95, 0.99, 1.0].map(|p| quantile(&errors, p));
        let row = said.lines().find(|line| line.trim_start().starts_with(words)).expect(name);
        let (_, found) = template(row);
        assert!(
            found.is_sorted() && found.iter().zip(known).all(|(a, b)| (a / b - 1.0).abs() < 2e-3),
            "{row}: {known:?}"
        );
    }
    // numerical errors of observables: all that the screen shows, under their heads
    let table = said.split_once("numerical error, and how much of the spread (p95 - p5) it is").expect("a table").1;
    assert_eq!(
        table.lines().nth(1).expect("heads").split_whitespace().collect::<Vec<_>>(),
        ["median", "p95", "max", "share"]
    );
    let mut listed = 0;
    for row in table.lines().skip(2).take_while(|row| !row.is_empty()) {
        let title = row.trim_start().split("  ").next().expect("a name");
        let list = summary["observables"].as_array().expect("observables");
        let words = |one: &Value| {
            let [name, unit] = ["name", "unit"].map(|key| one[key].as_str().expect(key));
            let unit_of = if unit.is_empty() { String::new() } else { format!(", {unit}") };
            spindrift::findings::names::of_column(name, unit) + &unit_of
        };
        let one = list.iter().find(|one| words(one) == title).expect(title);
        let error = &one["numerical_error"];
        let known = ["median", "p95", "max", "share_of_spread"].map(|key| number(&error[key]));
        let found = template(row).1;
        assert!(found.iter().zip(known).all(|(a, b)| (a / b - 1.0).abs() < 6e-4), "{row}: {known:?}");
        assert!(found.len() == 4 && found[..3].is_sorted(), "{row}");
        let values = column(&rows, one["name"].as_str().expect("a name"));
        let values: Vec<f64> = (1..600).filter(|row| ended[*row].1 == "ok").map(|row| values[row]).collect();
        let spread = quantile(&values, 0.95) - quantile(&values, 0.05);
        assert!((known[1] / spread / known[3] - 1.0).abs() < 2e-3, "{row}: {spread}");
        listed += 1;
    }
    assert!(listed > 1, "{table}");

    // files
    let size = |folder: &str| -> u64 {
        let entries = std::fs::read_dir(scratch.path(folder)).expect("a folder");
        entries.map(|entry| entry.expect("an entry").metadata().expect("a file").len()).sum()
    };
    let found = numbers(&said, "r: # files of rows, # MB");
    assert_eq!(found[0], scratch.part_files("r").len() as f64);
    assert!((found[1] - (size("r/runs") + size("r/bands")) as f64 / 1e6).abs() < 0.051, "{found:?}");
}

/// Law: what `check` estimates is of the campaign, and the disk that it promises what is written, within a half.
#[test]
fn a_check_estimates_what_is_made() {
    let scratch = ScratchFolder::new("screen-check");
    scratch.file("c.toml", &failing());
    let said = scratch.prints_wide("check c.toml", 0);
    scratch.prints("campaign c.toml --out r", 3);
    let columns = scratch.rows("r")[0].num_columns() as f64;
    let found = numbers(&said, "# columns; # files of rows, page and tables: about # MB; memory: at most # MB");
    assert_eq!(found[..2], [columns, scratch.parts("r").len() as f64]);
    let written = contents(&scratch.path("r")).values().map(Vec::len).sum::<usize>() as f64 / 1e6;
    assert!((0.67..1.5).contains(&(found[2] / written)), "{} MB for {written}", found[2]);
    // the program itself has 30 MB
    assert!((30.0..300.0).contains(&found[3]), "{said}");
    let [milliseconds, samples, cores, seconds] =
        numbers(&said, "# ms per run on one core; # samples on # cores: about # s")[..]
    else {
        panic!("{said}")
    };
    assert_eq!(samples, 600.0);
    // three digits each
    assert!((seconds * cores * 1e3 / samples - milliseconds).abs() < 1.1e-2 * milliseconds, "{said}");
    let found =
        numbers(&said, "audit of # of the samples, from # audits: # ms each; about # audits on # cores: # s more");
    let [fraction, _, milliseconds, audits, cores, seconds] = found[..] else { panic!("{said}") };
    assert_eq!([fraction, audits], [0.2, 120.0]);
    assert!((seconds * cores * 1e3 / audits - milliseconds).abs() < 6e-4 * milliseconds + 0.05, "{said}");
}

/// Law: `sample` and `simulate` count what they draw, compute and write.
#[test]
fn samples_and_points_are_counted() {
    let scratch = ScratchFolder::new("screen-samples");
    scratch.file("c.toml", &failing());
    let said = scratch.prints("sample c.toml --samples 300 --out s.csv --plot s.html", 0);
    let table = scratch.text("s.csv");
    let head: Vec<&str> = table.lines().next().expect("a head").split(',').collect();
    let invalid = table.lines().filter(|line| line.contains(",invalid_sample,")).count();
    says(&said, "of # draws (sample # is nominal)", &[299.0, 0.0]);
    says(&said, "s.csv: # samples, # columns", &[300.0, head.len() as f64]);
    says(&said, "# of # samples are not physical", &[invalid as f64, 300.0]);
    let numbers_drawn = head.iter().filter(|name| name.starts_with("initial_") || name.starts_with("body_")).count();
    says(&said, "s.html: # numbers of # samples", &[numbers_drawn as f64, 299.0]);

    // rates in deg/s and wheel speeds in rpm, or as the file asks; the file of numbers stays in SI
    let (degrees, turns) = (180.0 / std::f64::consts::PI, 30.0 / std::f64::consts::PI);
    for (points, units, [of_body, of_wheels]) in [
        (5, "[\"deg\",\"deg/s\"]", [("deg/s", degrees), ("rpm", turns)]),
        (200, "[\"rad\",\"rad/s\"]", [("rad/s", 1.0); 2]),
    ] {
        let set = format!("--set display.units={units} --set observe.points={points}");
        let mut command = scratch.command(&format!("simulate c.toml {set}"));
        let said = scratch.outputs(command.env("COLUMNS", "200"), 0);
        let rows: Vec<Vec<f64>> =
            said.lines().filter_map(|line| line.split_whitespace().map(|word| word.parse().ok()).collect()).collect();
        let shown = rows.len();
        let heads: Vec<&str> =
            said.lines().next().expect("heads").split_whitespace().filter(|word| *word != "rate").collect();
        let (shown, points_there) = (shown as f64, f64::from(points));
        match shown == points_there {
            true => says(&said, "(all # points;", &[points_there]),
            false => says(&said, "(# of # points;", &[shown, points_there]),
        }
        let below: Vec<&str> = said.lines().nth(1).expect("units").split_whitespace().collect();
        let count = |unit: &str| below.iter().filter(|word| **word == unit).count();
        let wheels = heads.iter().filter(|head| head.starts_with('w')).count();
        assert!(wheels > 0 && count(of_wheels.0) == wheels + if points == 200 { 3 } else { 0 }, "{said}");
        assert_eq!(count(of_body.0), if points == 200 { 3 + wheels } else { 3 }, "{said}");
        let said = scratch.prints(&format!("simulate c.toml {set} --out t.csv"), 0);
        let table = scratch.text("t.csv");
        let columns = table.lines().next().expect("a head").split(',').count();
        assert_eq!(table.lines().count(), points as usize + 1);
        says(&said, "t.csv: # points, # columns", &[f64::from(points), columns as f64]);
        // each number of the table is that of the file at its time, under its head, in the digits that are shown
        let names: Vec<&str> = table.lines().next().expect("a head").split(',').collect();
        let name_of = |head: &str| match head {
            "time" => "time_s".to_owned(),
            "energy" => "energy_error".to_owned(),
            "ang.mom." => "angular_momentum_error".to_owned(),
            wheel if wheel.starts_with('w') => format!("rate_{wheel}_rad_s"),
            _ => head.strip_prefix("omega_").map_or(head.to_owned(), |axis| format!("omega_se_s_{axis}_rad_s")),
        };
        let file: Vec<Vec<f64>> = table
            .lines()
            .skip(1)
            .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect())
            .collect();
        for row in &rows {
            let point =
                file.iter().min_by(|a, b| (a[0] - row[0]).abs().total_cmp(&(b[0] - row[0]).abs())).expect("points");
            assert_eq!(heads.len(), row.len(), "{said}");
            for (head, value) in heads.iter().zip(row) {
                let name = name_of(head);
                let known = point[names.iter().position(|one| *one == name).unwrap_or_else(|| panic!("{name}"))];
                let known = known
                    * match &name {
                        wheel if wheel.starts_with("rate_") => of_wheels.1,
                        rate if rate.starts_with("omega_") => of_body.1,
                        _ => 1.0,
                    };
                let digits = if name.ends_with("error") { 0.051 } else { 6e-4 };
                assert!((value - known).abs() <= digits * known.abs() + 6e-5, "{head}: {value} for {known}");
            }
        }
    }
}

/// Law: other commands on a result count its parts, rows, failures and bytes, and those of its shards.
#[test]
fn other_commands_count_what_is_there() {
    let scratch = ScratchFolder::new("screen-others");
    scratch.file("c.toml", &mixed_failures());
    scratch.prints("campaign c.toml --out r", 1);
    let failed = ended(&scratch.rows("r")).iter().filter(|(_, status)| status != "ok").count() as f64;
    let parts = scratch.part_files("r");
    let rows = |file: &PathBuf| batches(file).iter().map(|batch| batch.num_rows()).sum::<usize>() as f64;
    assert!(parts.len() > 1 && failed > 100.0);
    let (count, all) = (parts.len() as f64, parts.iter().map(rows).sum::<f64>());
    let size = std::fs::metadata(scratch.path("r/report.html")).expect("a page").len() as f64;
    for (command, code, pattern, known) in [
        (
            "verify r --fraction 1",
            0,
            "# parts, # rows: checksums compared; # parts with # rows",
            vec![count, all, count, all],
        ),
        (
            "verify r --fraction 0",
            0,
            "# parts, # rows: checksums compared; # parts with # rows",
            vec![count, all, 0.0, 0.0],
        ),
        ("campaign c.toml --out r", 1, "already complete in r (# samples, # of them failed)", vec![all, failed]),
        ("campaign c.toml --out s --shard 1/2", 0, "shard #/# is complete", vec![1.0, 2.0]),
        ("campaign c.toml --out s --shard 2/2", 0, "shard #/# is complete", vec![2.0, 2.0]),
        ("finish s", 1, "small: # of # runs (# nominal) computed", vec![all - failed, all, 1.0]),
    ] {
        says(&scratch.prints(command, code), pattern, &known);
    }
    let shown = numbers(&scratch.prints("report r", 0), "r/report.html (# kB)")[0];
    assert!((shown - size / 1e3).abs() < 0.051, "{shown} kB of {size} bytes");
    // the samples of shards are those of their parts
    scratch.prints("campaign c.toml --out t --shard 1/2", 0);
    let first: f64 = scratch.part_files("t").iter().map(rows).sum();
    let said = scratch.prints("campaign c.toml --out t --shard 2/2", 0);
    let second = scratch.part_files("t").iter().map(rows).sum::<f64>() - first;
    assert_eq!(numbers(&said, "is complete (# samples in # s)")[0], second, "{said}");
    assert!(first > 0.0 && second > 0.0 && first + second == all);
}
