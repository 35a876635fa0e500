//! Single runs, the nominal run, inputs and axes on page and screen, against the rows.

use crate::prelude::*;

use crate::page::numbers::read_number;

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * expected.abs().max(1e-300), "{what}: {found} for {expected}");
}

fn ends(values: &[f64]) -> [f64; 2] {
    [f64::min, f64::max].map(|end| values.iter().copied().reduce(end).unwrap())
}

fn last(values: &[f64]) -> f64 {
    *values.last().unwrap()
}

/// Law: the numbers beside a replayed run are those of its row, in the unit shown, derived ones included.
#[test]
fn numbers_beside_the_replay_are_of_the_row() {
    let found = found("replay", &motion());
    let names = ["angular_rate_final_rad_s", "nutation_angle_min_rad", "omega_se_s_z_final_rad_s"];
    let columns = found.all(&names);
    let runs = found.shown_runs();
    assert_eq!(runs.len(), 11, "the nominal run and ten");
    let sizes = |list: &str, key: &str| -> Vec<Value> {
        let list = found.data["replay"]["scene"][list].as_array().unwrap().iter();
        list.map(|shape| shape[key].clone()).collect()
    };
    assert_eq!(sizes("parts", "size"), [serde_json::json!([1.0, 3.0])]);
    assert_eq!(
        [sizes("wheels", "radius"), sizes("wheels", "length")],
        [0.25, 0.1].map(|size| vec![Value::from(size); 2])
    );
    assert_eq!(found.data["replay"]["scene"]["debris"], serde_json::json!([0.2, 0.2, 0.2]));
    for run in runs {
        let row = run["sample"].as_u64().unwrap() as usize;
        let [rate, nutation, spin] = [0, 1, 2].map(|column| columns[column][row]);
        let shown = |title: &str| -> String {
            let list = run["numbers"].as_array().unwrap();
            let one = list.iter().find(|one| one[0] == title).unwrap_or_else(|| panic!("{title}: {list:?}"));
            one[1].as_str().unwrap().to_owned()
        };
        for (title, unit, expected) in [
            ("Angular rate at the end", "deg/s", degrees(rate)),
            ("Minimum nutation angle", "deg", degrees(nutation)),
            ("Spin ratio", "", spin / rate),
            ("Angular velocity about s3 at the end", "rad/s", spin),
        ] {
            let text = shown(title);
            let number = text.strip_suffix(unit).unwrap_or_else(|| panic!("{title}: {text}"));
            near(read_number(number), expected, 6e-4, &format!("{title} of sample {row}"));
        }
    }
}

/// Law: the nominal run is sample 0 in curves and histograms, and an input has the unit in which it was written.
#[test]
fn nominal_is_nominal() {
    let text = motion().replace("std = [0.5, 0.5, 1.5]", "std = [\"30 deg/s\", \"30 deg/s\", \"90 deg/s\"]");
    let found = found("nominal", &text);
    let names = ["angular_rate_final_rad_s", "rate_w1_final_rad_s", "initial_angular_velocity_z_rad_s"];
    let columns = found.all(&names);
    let curve = |figure: &str| last(&found.array(&found.mark(figure, "nominal run")["y"]));
    near(curve("angular_rate_rad_s"), degrees(columns[0][0]), 1e-6, "rate");
    near(curve("speed_w1_rad_s"), columns[1][0], 1e-6, "wheel");
    near(
        found.mark("histogram_angular_rate_final_rad_s", "nominal")["at"].as_f64().unwrap(),
        degrees(columns[0][0]),
        1e-9,
        "mark",
    );

    let figure = found.figure("input_initial_angular_velocity_z_rad_s");
    assert_eq!(figure["x"]["unit"], "deg/s");
    assert!(figure["caption"].as_str().unwrap().contains("normal, std 90 deg/s"), "{figure}");
    let bars = found.mark("input_initial_angular_velocity_z_rad_s", "samples");
    let [edges, heights] = ["edges", "heights"].map(|key| found.array(&bars[key]));
    let inputs: Vec<f64> = columns[2][1..].iter().copied().map(degrees).collect();
    assert_eq!(heights.iter().sum::<f64>(), 299.0);
    for (edge, end) in [edges[0], last(&edges)].into_iter().zip(ends(&inputs)) {
        near(edge, end, 1e-6, "the end of the bars");
    }
    let center = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / y.iter().sum::<f64>();
    let middles: Vec<f64> = edges.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
    let mean = inputs.iter().sum::<f64>() / 299.0;
    assert!((center(&middles, &heights) - mean).abs() < edges[1] - edges[0]);
    let expected = found.mark("input_initial_angular_velocity_z_rad_s", "expected counts");
    let [x, y] = ["x", "y"].map(|key| found.array(&expected[key]));
    near(y.iter().sum(), 299.0, 0.02, "expected samples");
    near(center(&x, &y), degrees(columns[2][0]), 0.01, "centre");
    let said = found.scratch.prints_wide("check c.toml --verbose", 0);
    let row = said.lines().find(|line| line.starts_with("  initial.angular_velocity_rad_s.z ")).unwrap();
    let words: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(words[1], "deg/s", "{row}");
    near(words[2].parse().unwrap(), degrees(columns[2][0]), 1e-3, "nominal");
    near(words[5].parse::<f64>().unwrap() - words[3].parse::<f64>().unwrap(), 2.0 * 2.326 * 90.0, 0.15, "1% to 99%");
    assert!(row.ends_with("normal, std 90 deg/s"), "{row}");
}

/// Law: a quantile of the table has its own interval, lower end first.
#[test]
fn intervals_are_in_order() {
    let visible = found("intervals", &motion()).visible();
    let row = visible.split("<tr>").find(|row| row.contains("title=\"angular_rate_final_rad_s: ")).unwrap();
    let cells: Vec<&str> = row.split("<td data-value").filter(|cell| cell.contains(" [")).collect();
    assert!(cells.len() >= 5, "{row}");
    for cell in cells {
        let value: f64 = cell.split('"').nth(1).unwrap().parse().unwrap();
        let words = cell.split_once(" [").unwrap().1.split(']').next().unwrap();
        let (low, high) = words.split_once(", ").unwrap();
        let [low, high] = [low, high].map(|end| if end == "?" { f64::NAN } else { read_number(end) });
        assert!(!(low > value || high < value), "{value} in {low} to {high}");
    }
}

/// Law: the strongest input comes first with the share of the screen; the bars descend.
#[test]
fn bars_of_influence_descend() {
    let found = found("influence", &motion());
    for (outcome, words) in [("angular_rate_final_rad_s", "angular rate at the end"), ("spin_ratio", "spin ratio")] {
        let figure = format!("influence_{outcome}");
        let shares = found.array(&found.mark(&figure, "95% interval")["x"]);
        assert!(shares.windows(2).all(|pair| pair[0] >= pair[1]), "{shares:?}");
        let first = found.figure(&figure)["y"]["names"][0].as_str().unwrap();
        let line = found.said.lines().find(|line| line.trim_start().starts_with(words) && line.contains("with it"));
        let line = line.unwrap_or_else(|| panic!("{outcome}: {}", found.said));
        let (_, said) = line.split_once(&format!("{first} explains ")).expect(line);
        let share: f64 = said.split('%').next().unwrap().parse().unwrap();
        assert!((0.01 * share - shares[0]).abs() < 0.006, "{share}: {shares:?}");
        assert_eq!(found.figure(&figure)["x"]["quantity"], "share of the variance");
        says(found.figure(&figure)["caption"].as_str().unwrap(), "Of # runs", &[299.0]);
    }
}

/// Law: each way of failing is counted, its first run listed with reason and command, and no failed run is among the
/// ok.
#[test]
fn two_statuses_are_told_apart() {
    let scratch = ScratchFolder::new("page-statuses");
    scratch.file("c.toml", &mixed_failures().replace("samples = 600", "samples = 300"));
    scratch.prints("campaign c.toml --out r", 1);
    let found = Found::read(scratch, String::new());
    let summary = found.scratch.summary("r");
    let page = found.scratch.text("r/report.html");
    let visible = page.split_once("<script").unwrap().0;
    let worst = crate::page::answers::between(visible, "id=\"worst\"", "</section>");
    let rows: Vec<&str> = worst.split("<tr>").collect();
    for (status, said) in [("invalid_sample", "Invalid: not physical"), ("inaccurate", "Inaccurate")] {
        let reasons = summary["failure_reasons"].as_array().unwrap();
        let of = reasons.iter().filter(|one| one["status"] == status);
        let sample = of.map(|one| one["sample"].as_u64().unwrap()).min().unwrap();
        let row = rows.iter().find(|row| row.contains(&format!("<td class=\"text\">{said}<"))).unwrap();
        assert_says(row, [&format!("<b>{status}</b>: ")]);
        assert!(row.starts_with(&format!("<th scope=\"row\">{sample}</th>")), "{sample}: {row}");
        let counts = reasons.iter().filter(|one| one["status"] == status);
        for (count, first) in counts.map(|one| (&one["count"], &one["sample"])) {
            let is_of_it = |said: &&str| {
                said.contains(&format!("<b>{count} {status}</b>")) && said.contains(&format!("--sample {first}</code>"))
            };
            assert!(visible.split("<p class=\"reason\">").any(|said| is_of_it(&said)), "{count} {status}, {first}");
        }
        assert_says(row, [&format!("--sample {sample}</code>")]);
    }
    let is_ok = |row: &&&str| row.contains("<td class=\"text\">") && !row.contains("class=\"ended\"");
    assert!(rows.iter().filter(is_ok).count() >= 5, "{worst}");
    let scatter = found.data["figures"]
        .as_array()
        .unwrap()
        .iter()
        .find(|figure| figure["name"].as_str().is_some_and(|name| name.starts_with("scatter_")));
    let marks = scatter.unwrap()["marks"].as_array().unwrap();
    let samples = |label: &str| -> Vec<f64> {
        let mark = marks.iter().find(|mark| mark["label"].as_str().is_some_and(|name| name.starts_with(label)));
        found.array(&mark.unwrap()["samples"])
    };
    let ok = summary["statuses"]["ok"].as_u64().unwrap();
    let dispersed_ok = ok - 1; // the nominal run is ok
    assert_eq!(samples("computed").len() as u64, dispersed_ok);
    assert_eq!(samples("not computed").len() as u64, 300 - ok);
    assert!(!samples("computed").contains(&0.0));
    assert!(samples("not computed").iter().all(|sample| !samples("computed").contains(sample)));
}
