//! The numbers of the page, of the screen and of JUnit against the rows: every figure is computed here by another way.

use crate::prelude::*;
use std::io::Read as _;

use base64::Engine as _;

use crate::support::scratch_folder;

const MORE: &str = r#"
[audit]
fraction = 0.2
[[observable]]
name = "spin_ratio"
expression = "omega_se_s_z_final_rad_s / angular_rate_final_rad_s"
[[require]]
observable = "angular_rate_final_rad_s"
quantile = 0.95
at_most = "2100 deg/s"
[[require]]
observable = "nutation_angle_min_rad"
fraction = 0.9
at_least = "1e-4 deg"
confidence = 0.9
[[require]]
observable = "angular_rate_final_rad_s"
mean = true
at_most = 40
"#;

pub(crate) struct Found {
    pub scratch: ScratchFolder,
    pub said: String,
    pub data: Value,
    bytes: Vec<u8>,
}

fn unpacked(page: &str, id: &str) -> Vec<u8> {
    let start = page.find(&format!("id=\"{id}\">")).unwrap_or_else(|| panic!("no block {id}")) + id.len() + 6;
    let text = &page[start..start + page[start..].find('<').unwrap()];
    let compressed = base64::engine::general_purpose::STANDARD.decode(text).unwrap();
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(&compressed[..]).read_to_end(&mut bytes).unwrap();
    bytes
}

pub(crate) fn found(name: &str, text: &str) -> Found {
    let scratch = ScratchFolder::new(&format!("page-{name}"));
    scratch.file("c.toml", text);
    let mut command = scratch.command("campaign c.toml --out r --junit junit.xml --verbose");
    let output = command.env("COLUMNS", "220").output().unwrap();
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    Found::read(scratch, said)
}

impl Found {
    pub fn read(scratch: ScratchFolder, said: String) -> Self {
        let page = scratch.text("r/report.html");
        let data = Found::data_of(&page);
        let bytes = unpacked(&page, "numbers");
        Found { scratch, said, data, bytes }
    }

    pub fn column_called(&self, words: &str) -> String {
        let columns = self.data["pairs"]["columns"].as_array().unwrap();
        let column = columns.iter().find(|column| column["name"] == words).unwrap_or_else(|| panic!("no {words}"));
        column["column"].as_str().unwrap().to_owned()
    }

    pub fn of_page(page: &str) -> Self {
        let scratch = ScratchFolder::new("page-of-figures");
        Found { scratch, said: String::new(), data: Found::data_of(page), bytes: unpacked(page, "numbers") }
    }

    pub fn data_of(page: &str) -> Value {
        serde_json::from_slice(&unpacked(page, "data")).unwrap()
    }

    pub fn shown_on(page: &str) -> Vec<(String, Vec<String>)> {
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let labels =
            |figure: &Value| figure["marks"].as_array().unwrap().iter().map(|one| text(&one["label"])).collect();
        let data = Found::data_of(page);
        let figures = data["figures"].as_array().unwrap();
        figures.iter().map(|figure| (text(&figure["title"]), labels(figure))).collect()
    }

    pub fn array(&self, place: &Value) -> Vec<f64> {
        let [at, count, width] = [0, 1, 2].map(|k| usize::try_from(place[k].as_u64().unwrap()).unwrap());
        let bytes = &self.bytes[at..at + count * width];
        match width {
            8 => bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().unwrap())).collect(),
            _ => bytes.chunks_exact(4).map(|four| f64::from(f32::from_le_bytes(four.try_into().unwrap()))).collect(),
        }
    }

    pub fn figures(&self) -> &[Value] {
        self.data["figures"].as_array().unwrap()
    }

    /// The runs that are shown moving.
    pub fn shown_runs(&self) -> &[Value] {
        self.data["replay"]["runs"].as_array().unwrap()
    }

    pub fn figure(&self, name: &str) -> &Value {
        self.figures().iter().find(|figure| figure["name"] == name).unwrap_or_else(|| panic!("no figure {name}"))
    }

    pub fn mark(&self, figure: &str, label: &str) -> &Value {
        let marks = self.figure(figure)["marks"].as_array().unwrap();
        marks.iter().find(|mark| mark["label"] == label).unwrap_or_else(|| panic!("no {label} in {figure}: {marks:?}"))
    }

    pub fn column(&self, name: &str) -> Vec<f64> {
        self.rows(&[name]).into_iter().map(|(_, row)| row[0]).collect()
    }

    pub fn all(&self, names: &[&str]) -> Vec<Vec<f64>> {
        let watch = Quiet::default();
        let results = Results::open(self.scratch.path("r"), Session::new(&watch).unwrap()).unwrap();
        let derived = |name: &str| scratch_folder::column(&batches(&self.scratch.path("r/observables.parquet")), name);
        names.iter().map(|name| results.column(name).unwrap_or_else(|_| derived(name))).collect()
    }

    pub fn quantile(&self, name: &str, p: &Value) -> Value {
        let list = self.scratch.summary("r")["observables"].take();
        let one = list.as_array().unwrap().iter().find(|one| one["name"] == name).expect(name);
        one["quantiles"].as_array().unwrap().iter().find(|one| one["p"] == *p).unwrap().clone()
    }

    pub fn visible(&self) -> String {
        self.scratch.text("r/report.html").split_once("<script").unwrap().0.replace('\u{a0}', " ")
    }

    pub fn rows(&self, names: &[&str]) -> Vec<(u64, Vec<f64>)> {
        let columns = self.all(names);
        let ended = ended(&self.scratch.rows("r"));
        let dispersed = (1..ended.len()).filter(|row| ended[*row].1 == "ok");
        dispersed.map(|row| (row as u64, columns.iter().map(|column| column[row]).collect())).collect()
    }
}

/// The type-7 quantile (Hyndman & Fan 1996).
pub(crate) fn quantile(values: &[f64], p: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = p * (sorted.len() - 1) as f64;
    let (low, part) = (at.floor() as usize, at.fract());
    sorted[low] + part * (sorted[(low + 1).min(sorted.len() - 1)] - sorted[low])
}

pub(crate) fn degrees(value: f64) -> f64 {
    value * 180.0 / core::f64::consts::PI
}

const GROUPS: &str = "groups = [\"energy_conservation\", \"momentum_conservation\", \"final_state\", \"numerics\", \
    \"motion\", \"energies_com\", \"exchange\"]";

pub(crate) fn motion() -> String {
    sized(300).replace("points = 11", &format!("points = 11\n{GROUPS}")) + MORE
}

pub(crate) fn failing() -> String {
    const REQUIRED: &str = "[audit]\nfraction = 0.2\n\
        [[require]]\nobservable = \"angular_rate_final_rad_s\"\nquantile = 0.95\nat_most = \"2100 deg/s\"\n\
        [[require]]\nobservable = \"rate_w1_final_rad_s\"\nfraction = 0.5\nat_most = 315.0\n";
    mixed_failures().replace("points = 11", &format!("points = 11\n{GROUPS}")) + REQUIRED
}

/// Law: captions count the dispersed runs, an audit is where its row says, and an influence is within its interval.
#[test]
fn figures_show_the_rows() {
    let found = found("figures", &motion());
    let audits = found.mark("audits", "audited runs");
    let [samples, estimates, truths] = ["samples", "x", "y"].map(|key| found.array(&audits[key]));
    assert!(samples.len() > 30);
    let rows = found.rows(&["state_error_estimate", "audit_state_error"]);
    for k in 0..samples.len() {
        let Some((_, row)) = rows.iter().find(|(sample, _)| *sample as f64 == samples[k]) else { continue };
        assert_eq!([estimates[k], truths[k]], row[..], "sample {}", samples[k]);
    }
    let below = (0..samples.len()).filter(|k| truths[*k] > estimates[*k]).count();
    assert_says(
        found.figure("audits")["caption"].as_str().unwrap(),
        [&format!("the estimate is too small: {below} of those shown")],
    );
    let whiskers = found.figures().iter().flat_map(|figure| figure["marks"].as_array().unwrap());
    let whiskers: Vec<&Value> = whiskers.filter(|mark| mark["kind"] == "whiskers").collect();
    assert!(!whiskers.is_empty());
    for mark in whiskers {
        let [low, x, high] = ["low", "x", "high"].map(|key| found.array(&mark[key]));
        for k in 0..x.len() {
            assert!(low[k].is_nan() || low[k] <= x[k] && x[k] <= high[k], "{} in {} to {}", x[k], low[k], high[k]);
        }
    }
    assert_eq!(found.figure("audits")["x"]["quantity"], "state error estimate");
}

/// Law: screen and JUnit have the numbers and verdicts of `summary.json`, verdicts first.
#[test]
fn screen_and_junit_say_what_the_summary_has() {
    let found = found("screen", &motion());
    let summary = found.scratch.summary("r");
    let said = &found.said;
    assert!(said.find("requirement").unwrap() < said.find("runs were computed").unwrap(), "verdicts first: {said}");
    assert!(said.find("runs were computed").unwrap() < said.find("outcome").unwrap());
    for absent in ["q_es_w_final", "time_reached_s", "steps"] {
        assert!(!said.contains(absent), "{absent}: {said}");
    }
    let line = said.lines().position(|line| line.trim_start().starts_with("angular rate at the end, ")).expect(said);
    let numbers = |text: &str| -> Vec<f64> {
        let cleaned = text.replace(['[', ']', ','], " ");
        cleaned.split_whitespace().filter_map(|word| word.parse().ok()).collect()
    };
    let all = numbers(said.lines().nth(line).unwrap());
    let (values, ends) = ([0, 3, 6].map(|place| all[place]), [all[1], all[2]]);
    assert!(said.lines().nth(line).unwrap().contains("deg/s"));
    let head = said.lines().find(|line| line.contains("median")).unwrap();
    let order: Vec<&str> = head.split_whitespace().skip(1).collect();
    assert_eq!(order, ["median", "p5", "p95", "mean", "min", "max"]);
    let of = |name: &str| {
        let list = summary["observables"].as_array().unwrap();
        list.iter().find(|one| one["name"] == name).unwrap_or_else(|| panic!("{name}")).clone()
    };
    let rate = of("angular_rate_final_rad_s");
    let near = |found: f64, expected: f64, what: &str| {
        assert!((found / expected - 1.0).abs() < 2e-3, "{what}: {found} for {expected}");
    };
    let quantile_of = |p: f64| {
        let list = rate["quantiles"].as_array().unwrap();
        list.iter().find(|one| one["p"] == p).unwrap().clone()
    };
    for (k, p) in [0.5, 0.05, 0.95].into_iter().enumerate() {
        near(values[k], degrees(quantile_of(p)["value"].as_f64().unwrap()), &format!("p{p}"));
        near(
            degrees(quantile_of(p)["value"].as_f64().unwrap()),
            quantile(&found.column("angular_rate_final_rad_s"), p) * 180.0 / core::f64::consts::PI,
            "rows",
        );
    }
    near(*all.last().unwrap(), degrees(rate["max"].as_f64().unwrap()), "max");
    let median_interval = quantile_of(0.5)["interval"].clone();
    near(ends[0], degrees(median_interval[0].as_f64().unwrap()), "lower end");
    near(ends[1], degrees(median_interval[1].as_f64().unwrap()), "upper end");
    assert!(ends[0] < values[0] && values[0] < ends[1], "{ends:?}");

    let junit = found.scratch.text("junit.xml");
    for one in summary["requirements"]["list"].as_array().unwrap() {
        let (sentence, verdict) = (one["in_short"].as_str().unwrap(), one["verdict"].as_str().unwrap());
        assert!(said.contains(&format!("{verdict:<10} {sentence}")), "{sentence}");
        let case = junit
            .split("<testcase")
            .find(|case| case.contains(&sentence.replace('<', "&lt;").replace('>', "&gt;")))
            .unwrap_or_else(|| panic!("{junit}"));
        let expected = [("PASS", [false, false]), ("FAIL", [true, false]), ("UNDECIDED", [false, true])];
        let (_, expected) = expected.iter().find(|(word, _)| *word == verdict).unwrap();
        assert_eq!([case.contains("<failure"), case.contains("<error")], *expected, "{case}");
        if sentence.contains("p95") {
            assert_says(sentence, ["<= 2100 deg/s"]);
        }
    }
}

/// A number of the page: `1.23 x 10^-4` with superscripts, `1,234`.
pub(crate) fn read_number(text: &str) -> f64 {
    let plain = text.trim().replace('\u{2212}', "-").replace([',', '\u{202f}', '\u{a0}'], "").replace("\u{d7}10", "e");
    let digits = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let letter = |c: char| match digits.chars().position(|digit| digit == c) {
        Some(place) => char::from(b'0' + place as u8),
        None if c == '⁻' => '-',
        None => c,
    };
    plain.chars().map(letter).collect::<String>().parse().unwrap_or_else(|_| panic!("{text:?} is no number"))
}

/// Law: the numbers and the table of the static page are those of the rows, in the unit shown.
#[test]
fn static_numbers_are_those_of_the_rows() {
    let found = found("static", &motion());
    let page = found.scratch.text("r/report.html");
    let visible = page.split_once("<script").unwrap().0;
    assert!(visible.contains(">2100 deg/s</text>"), "the limit on the scale");
    let sentence = visible.split_once("Largest numerical errors, relative: energy ").unwrap().1;
    let largest = found.column("energy_error_max").into_iter().fold(0.0, f64::max);
    let shown = read_number(sentence.split(", angular").next().unwrap());
    assert!((shown / largest - 1.0).abs() < 0.02, "{shown} for {largest}");
    let rates: Vec<f64> = found.column("angular_rate_final_rad_s").into_iter().map(degrees).collect();
    let row = visible.split("<tr>").find(|row| row.contains("title=\"angular_rate_final_rad_s: ")).unwrap();
    assert_says(row, ["<td class=\"unit\">deg/s</td>"]);
    let cells: Vec<f64> =
        row.split("data-value=\"").skip(1).map(|cell| cell.split('"').next().unwrap().parse().unwrap()).collect();
    let mean = rates.iter().sum::<f64>() / rates.len() as f64;
    let deviation = (rates.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (rates.len() - 1) as f64).sqrt();
    let ends = [f64::min, f64::max].map(|end| rates.iter().copied().reduce(end).unwrap());
    let quantiles = [0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999].map(|p| quantile(&rates, p));
    let expected = [&[rates.len() as f64, mean, deviation, ends[0]][..], &quantiles, &[ends[1]]].concat();
    assert_eq!(cells.len(), expected.len());
    for (cell, expected) in cells.iter().zip(&expected) {
        assert!((cell / expected - 1.0).abs() < 2e-3, "{cell} for {expected} in {cells:?}");
    }
}

/// Law: the screen counts the runs left out, a reason is escaped on the page, and a failed run has no derived
/// observable.
#[test]
fn runs_that_failed_are_left_out() {
    let scratch = ScratchFolder::new("page-left-out");
    let derived = "[[observable]]\nname = \"twice\"\nexpression = \"2 * energy_error_max\"\n";
    scratch.file("c.toml", &(mixed_failures().replace("samples = 600", "samples = 200") + derived));
    let said = scratch.prints("campaign c.toml --out r --verbose", 1);
    let summary = scratch.summary("r");
    let ok = summary["statuses"]["ok"].as_u64().unwrap();
    let nominal = 1;
    let treatment = summary["statistics"]["failed_runs"].as_str().unwrap();
    assert!(treatment.starts_with(&format!("{} of 199", 199 + nominal - ok)), "{treatment}: {ok} of 200 are ok");
    assert_says(&said, [treatment, &format!("{ok} of 200 runs were computed")]);
    let table = batches(&scratch.path("r/observables.parquet"));
    let (statuses, values) = (ended(&table), scratch_folder::column(&table, "twice"));
    assert!(values.len() == 200 && values.iter().filter(|value| !value.is_nan()).count() as u64 == ok);
    assert!(statuses.iter().zip(values).all(|((_, status), value)| value.is_nan() == (status != "ok")));
    let reasons = summary["failure_reasons"].as_array().unwrap();
    let reason = |status: &str| reasons.iter().find(|one| one["status"] == status).unwrap()["reason"].as_str().unwrap();
    let page = scratch.text("r/report.html");
    let visible = page.split_once("<script").unwrap().0;
    let escaped =
        reason("invalid_sample").replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
    let (key, rest) = escaped.trim_end_matches('.').split_once(" = ").unwrap();
    // nobody wrote the value, so that advice on it is left out
    let (value, why) = rest.split_once("; ").unwrap().0.split_once(": ").unwrap();
    let value: f64 = value.parse().unwrap();
    let is_said = visible.split(&format!("{key} = ")).skip(1).any(|shown| {
        let Some((shown, _)) = shown.split_once(&format!(": {why}")) else { return false };
        shown.len() < 12 && shown.parse::<f64>().is_ok_and(|shown| (shown - value).abs() < 1e-5 * value.abs())
    });
    assert!(is_said, "{escaped}");
    assert!(!visible.contains("<img"), "no markup");
}

/// Law: a derived observable is a file by sample; a changed expression makes it anew and runs nothing.
#[test]
fn derived_observables_are_a_file() {
    let found = found("derived", &motion());
    let column = |name: &str| scratch_folder::column(&batches(&found.scratch.path("r/observables.parquet")), name);
    let rows = found.rows(&["omega_se_s_z_final_rad_s", "angular_rate_final_rad_s"]);
    let (samples, ratio) = (column("sample_id"), column("spin_ratio"));
    for (sample, row) in &rows {
        let place = samples.iter().position(|one| *one == *sample as f64).unwrap();
        assert_eq!(ratio[place], row[0] / row[1], "sample {sample}");
    }
    let before = found.scratch.parts("r");
    found.scratch.file(
        "c.toml",
        &motion().replace("omega_se_s_z_final_rad_s / angular_rate", "2 * omega_se_s_z_final_rad_s / angular_rate"),
    );
    found.scratch.command("campaign c.toml --out r").output().unwrap();
    assert_eq!(found.scratch.parts("r"), before, "no run is repeated");
    assert_eq!(column("spin_ratio"), ratio.iter().map(|value| 2.0 * value).collect::<Vec<_>>());
    let without = motion().replace(
        "[[observable]]\nname = \"spin_ratio\"\nexpression = \"omega_se_s_z_final_rad_s / angular_rate_final_rad_s\"\n",
        "",
    );
    found.scratch.file("c.toml", &without);
    found.scratch.command("campaign c.toml --out r").output().unwrap();
    assert!(!found.scratch.path("r/observables.parquet").exists());
}

/// Law: a yes-or-no outcome is a share with its interval against the number of runs, at the confidence of the file.
#[test]
fn yes_or_no_is_a_share() {
    let derived = "[[observable]]\nname = \"is_fast\"\nexpression = \"angular_rate_final_rad_s > 30\"\n";
    let found = found("yes", &(motion() + derived + "[statistics]\nconfidence = 0.9\n"));
    let names: Vec<&str> = found.figures().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert!(!names.contains(&"histogram_is_fast") && !names.contains(&"cumulative_is_fast"), "{names:?}");
    assert!(names.contains(&"histogram_angular_rate_final_rad_s"), "others have one: {names:?}");
    let [x, y] = ["x", "y"].map(|key| found.array(&found.mark("share_is_fast", "share of runs")[key]));
    let values = found.column("is_fast");
    assert_eq!(x.last(), Some(&(values.len() as f64)));
    let band = found.mark("share_is_fast", "90% interval");
    let [low, high] = ["low", "high"].map(|key| found.array(&band[key]));
    for k in 0..x.len() {
        let share = values[..x[k] as usize].iter().sum::<f64>() / x[k];
        assert!((y[k] - share).abs() < 1e-12 && low[k] <= y[k] && y[k] <= high[k], "{} of {}: {share}", y[k], x[k]);
    }
    let last = x.len() - 1;
    assert!(high[last] - low[last] < high[0] - low[0], "narrower with more runs");
    for figure in ["cumulative_angular_rate_final_rad_s", "tail_energy_error_max"] {
        found.mark(figure, "90% interval");
    }
}
