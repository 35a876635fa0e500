//! The figures over time on the page of a control loop, against file, rows and telemetry.

use crate::prelude::*;

use crate::{
    commands::screen_numbers,
    page::{answers::between, numbers},
    small_campaign::RADIANS,
};

const SAMPLES: usize = 60;
const WHEEL_FAILURE: &str = include_str!("../../../campaigns/wheel_failure.toml");
const SPIN_SWEEP: &str = include_str!("../../../campaigns/spin_sweep.toml");

fn page(name: &str, text: &str) -> Found {
    let scratch = ScratchFolder::new(&format!("loop-page-{name}"));
    scratch.file("slew_closed.toml", SLEW_CLOSED);
    scratch.file("c.toml", &(text.to_owned() + RADIANS));
    scratch.command(&format!("campaign c.toml --samples {SAMPLES} --out r")).output().unwrap();
    Found::read(scratch, String::new())
}

fn over_time(found: &Found) -> Vec<&Value> {
    let figures = found.figures();
    figures.iter().filter(|figure| figure["section"] == "time").collect()
}

fn name(figure: &Value) -> &str {
    figure["name"].as_str().unwrap()
}

fn marks<'v>(figure: &'v Value, kind: &'v str) -> impl Iterator<Item = &'v Value> {
    figure["marks"].as_array().unwrap().iter().filter(move |mark| mark["kind"] == kind)
}

fn limits(figure: &Value) -> Vec<(String, f64)> {
    let limit = |mark: &Value| (mark["label"].as_str().unwrap_or("").to_owned(), mark["at"].as_f64().unwrap());
    marks(figure, "limit").map(limit).collect()
}

fn called(text: &str) -> Vec<&'static str> {
    let has = |what: &str| text.contains(what);
    let (debris, filter) = (has("[debris]"), has("estimator = \"mekf\""));
    [
        ("pointing_error_rad", has("target = ")),
        ("phases", true),
        ("attitude_estimate_error_rad", filter),
        ("rate_estimate_error_rad_s", filter),
        ("relative_position_estimate_error_m", filter && debris),
        ("relative_velocity_estimate_error_m_s", filter && debris),
        ("debris_distance_m", debris),
        ("debris_relative_speed_m_s", debris),
        ("spin_axis_debris_angle_rad", debris),
        ("angular_rate_rad_s", true),
        ("wheel_torque", has("[[wheels]]")),
        ("wheel_speed", has("[[wheels]]")),
        ("thrust", has("[[thrusters]]")),
        ("impulse_n_s", has("[[thrusters]]")),
        ("propellant", has("isp_s")),
    ]
    .into_iter()
    .filter_map(|(name, is_called)| is_called.then_some(name))
    .collect()
}

/// Law: the page of a loop has the figures of its scene; that of a spinning body has energies.
#[test]
fn a_loop_has_the_figures_of_a_loop() {
    for (file, text) in [("net_launch", NET_LAUNCH), ("slew_closed", SLEW_CLOSED), ("detumble", DETUMBLE)] {
        let found = page(file, text);
        let drawn = over_time(&found);
        let mut names: Vec<&str> = drawn.iter().map(|figure| name(figure)).collect();
        let bears = |figure: &&Value| limits(figure).iter().any(|(label, _)| label.starts_with("at "));
        let bearing: Vec<bool> = drawn.iter().map(bears).collect();
        assert!(bearing.windows(2).all(|pair| pair[0] >= pair[1]), "{file}: {names:?}, {bearing:?}");
        let mut expected = called(text);
        names.sort_unstable();
        expected.sort_unstable();
        assert_eq!(names, expected, "{file}");
    }
    let groups = DETUMBLE.replace("\"numerics\"]", "\"numerics\", \"energies\"]");
    let asks = groups + "\n[[require]]\nobservable = \"energy_body_final_j\"\nquantile = 0.9\nat_most = 1e6\n";
    let found = page("asks", &asks);
    let names: Vec<&str> = over_time(&found).into_iter().map(name).collect();
    assert!(names.contains(&"energy_body_j") && names.contains(&"phases"), "{names:?}");
    let found = page("free", SPIN_SWEEP);
    let names: Vec<&str> = over_time(&found).into_iter().map(name).collect();
    assert!(names.contains(&"energy_body_j") && names.contains(&"energy_transfer"), "{names:?}");
    let of_loops = ["pointing_error_rad", "phases", "wheel_torque", "thrust", "propellant"];
    assert!(of_loops.iter().all(|name| !names.contains(name)), "{names:?}");
}

/// Law: limits are drawn in the units of the file: requirements, wheels on both sides, thrusters, keep-out and station.
#[test]
fn limits_are_those_of_the_file() {
    let found = page("limits", NET_LAUNCH);
    let of = |figure: &str| limits(found.figure(figure));
    let near = |found: &[(String, f64)], expected: &[(&str, f64)]| {
        let is_one = |(a, b): (&(String, f64), &(&str, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= 1e-12 * b.1.abs();
        assert!(found.len() == expected.len() && found.iter().zip(expected).all(is_one), "{found:?} {expected:?}");
    };
    near(&of("wheel_torque"), &[("limit \u{b1}4\u{a0}N m", 4.0), ("", -4.0)]);
    near(&of("wheel_speed"), &[("limit 125.7\u{a0}rad/s", 40.0 * core::f64::consts::PI)]);
    near(&of("thrust"), &[("limit of p2, p3 10\u{a0}N", 10.0), ("limit of p1 20\u{a0}N", 20.0)]);
    near(&of("debris_distance_m"), &[("keep-out 5\u{a0}m", 5.0), ("station 10\u{a0}m", 10.0)]);
    near(&of("impulse_n_s"), &[("at most 4000 N s", 4000.0)]);
    near(&of("debris_relative_speed_m_s"), &[("at most 5 cm/s at launch", 5.0)]);
    near(&of("spin_axis_debris_angle_rad"), &[("at most 2 deg at launch", 2.0)]);
    near(&of("angular_rate_rad_s"), &[("at most 0.2 deg/s at launch", 0.2)]);
    let found = page("limits-of-slew", SLEW_CLOSED);
    let figure = found.figure("pointing_error_rad");
    near(&limits(figure), &[("at most 0.1 deg at the end", 0.1)]);
    assert!(figure["y"]["log"] == true && figure["y"]["unit"] == "deg", "{}", figure["y"]);
    assert_eq!(found.figure("wheel_speed")["y"]["range"][0], 0.0);
}

/// Law: every figure over time but phases and drifts marks each event at the median of its times, with its count.
#[test]
fn events_are_marked_at_their_medians() {
    let found = page("events", WHEEL_FAILURE);
    let figures = over_time(&found);
    assert!(figures.len() > 5);
    for event in ["settled", "fast_wheel"] {
        let mut times = found.column(&format!("{event}_time_s"));
        times.retain(|time| time.is_finite());
        times.sort_by(f64::total_cmp);
        let middle = times[(times.len() - 1) / 2]..=times[times.len() / 2];
        let label = format!("{}, median of ", event.replace('_', " "));
        let all = found.column("sample_id").len();
        let label = match times.len() {
            some if some < all => format!("{label}the {some} of {all} runs that do"),
            _ => format!("{label}{all} runs"),
        };
        for figure in
            figures.iter().filter(|figure| !["phases", "drift_energy", "drift_momentum"].contains(&name(figure)))
        {
            let is_of_event = |mark: &&Value| mark["label"] == label.as_str() && mark["vertical"] == true;
            let found: Vec<&Value> = marks(figure, "limit").filter(is_of_event).collect();
            let all: Vec<&Value> = marks(figure, "limit").map(|mark| &mark["label"]).collect();
            assert_eq!(found.len(), 1, "{label:?} in {}: {all:?}", name(figure));
            let at = found[0]["at"].as_f64().unwrap();
            assert!(middle.contains(&at), "{event}: {at} of {middle:?}");
        }
    }
}

/// Law: bands end with fewer than twenty runs in flight, the axis with one in a hundred or the nominal run.
#[test]
fn bands_end_with_their_runs() {
    let found = page("flight", NET_LAUNCH);
    let ends: Vec<f64> = found.column("end_time_s");
    let left = |time: f64| ends.iter().filter(|end| end.is_nan() || **end >= time - 1e-6).count();
    let columns = found.all(&["end_time_s", "impulse_total_n_s", "propellant_kg"]);
    let nominal: Vec<f64> = columns.into_iter().map(|column| column[0]).collect();
    let mut bands = 0;
    for figure in over_time(&found) {
        let strip = marks(figure, "flight").next().unwrap_or_else(|| panic!("{}", name(figure)));
        assert_eq!(strip["runs"].as_f64(), Some(ends.len() as f64));
        let [times, counts] = ["x", "counts"].map(|key| found.array(&strip[key]));
        assert!(times.len() >= 200, "{} points", times.len());
        for (time, count) in times.iter().zip(&counts) {
            assert_eq!(*count, left(*time) as f64, "{} at {time} s", name(figure));
        }
        assert!(counts[0] == ends.len() as f64 && counts[counts.len() - 1] < 20.0);
        let axis = figure["x"]["range"][1].as_f64().unwrap();
        let last = times.iter().copied().find(|time| left(*time) as f64 <= 0.01 * ends.len() as f64);
        let run = nominal[0];
        assert!(axis >= last.unwrap() - 1e-9 && axis <= last.unwrap().max(run) + 1e-9, "{axis} {last:?} {run}");
        for mark in marks(figure, "band").filter(|mark| mark["label"].as_str().is_some_and(|label| label.contains('%')))
        {
            bands += 1;
            let x = found.array(&mark["x"]);
            assert!(x.iter().all(|time| left(*time) >= 20), "{} of {}", mark["label"], name(figure));
        }
        for mark in marks(figure, "line") {
            assert!(found.array(&mark["y"]).iter().all(|value| value.is_finite()), "{}", name(figure));
        }
    }
    assert!(bands > 15, "{bands} bands");
    let last = |figure: &str, label: &str| *found.array(&found.mark(figure, label)["y"]).last().unwrap();
    for (found, expected) in
        [(last("impulse_n_s", "nominal run"), nominal[1]), (last("propellant", "nominal run"), nominal[2])]
    {
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }
}

/// Law: the bound of an estimation error is three standard deviations of the filter's covariance at that time.
#[test]
fn bounds_are_of_the_filter() {
    let found = page("bounds", NET_LAUNCH);
    let plan = planned(NET_LAUNCH);
    let start = 3.0 * 3.0_f64.sqrt();
    for (figure, column, expected) in [
        ("attitude_estimate_error_rad", "attitude_expected_error_rad", start * 2.0_f64.to_radians()),
        ("relative_position_estimate_error_m", "relative_position_expected_error_m", start * 2.0_f64.sqrt()),
        ("relative_velocity_estimate_error_m_s", "relative_velocity_expected_error_m_s", start * 2.0_f64.sqrt() * 0.02),
    ] {
        let mark = found.mark(figure, "3 sigma of the filter");
        let [x, y] = ["x", "y"].map(|key| found.array(&mark[key]));
        assert!((y[0] / expected - 1.0).abs() < 1e-6, "{figure}: {} {expected}", y[0]);
        let grid = Grid::at(x.clone());
        let run = single_on(&plan, 0, grid);
        let place = run.telemetry.quantities.iter().position(|one| one.name() == column).unwrap();
        let held = &run.telemetry.held_at(&x)[place];
        for (point, (bound, known)) in y.iter().zip(held).enumerate() {
            assert!((bound / (3.0 * known) - 1.0).abs() < 1e-6, "{figure} at {} s: {bound} {known}", x[point]);
        }
        assert!(y[y.len() - 1] < 0.2 * y[0], "{figure}");
    }
}

/// Law: `simulate --plot` draws the figures of the page, and `simulate` prints the quantities of requirements first.
#[test]
fn simulate_shows_what_the_scene_calls_for() {
    let scratch = ScratchFolder::new("loop-plot");
    scratch.file("slew.toml", SLEW_CLOSED);
    scratch.file("detumble.toml", DETUMBLE);
    scratch.prints("simulate slew.toml --sample 3 --plot slew.html", 0);
    scratch.prints("simulate detumble.toml --plot detumble.html", 0);
    let titles =
        |file: &str| Found::shown_on(&scratch.text(file)).into_iter().map(|(title, _)| title).collect::<Vec<_>>();
    let [slew, detumble] = ["slew.html", "detumble.html"].map(titles);
    let has = |list: &[String], start: &str| list.iter().any(|title| title.starts_with(start));
    for title in
        ["Pointing error", "Phases", "Error of the estimated attitude", "Torque of the wheels", "Speed of the wheels"]
    {
        assert!(has(&slew, title), "{title}: {slew:?}");
    }
    for title in ["Phases", "Thrust", "Impulse of the thrusters", "Propellant", "Angular rate of the body"] {
        assert!(has(&detumble, title), "{title}: {detumble:?}");
    }
    for list in [&slew, &detumble] {
        assert!(!has(list, "Kinetic energy") && !has(list, "Attitude quaternion"));
    }
    let said = scratch.prints("simulate slew.toml", 0);
    let header = said.lines().next().unwrap().split_whitespace().collect::<Vec<_>>();
    assert_eq!(header[..3], ["time", "phase", "pointing"], "{said}");
    assert!(!header.contains(&"q_es_w"), "{said}");
}

/// Law: an overconfident filter is named with its factor on screen, page and in the summary, and no other; so is what
/// it does not know.
#[test]
fn filters_that_do_not_know_their_errors_are_named() {
    for (name, bias, is_named) in [("biased", "20 arcsec", true), ("right", "0.01 arcsec", false)] {
        let text = SLEW_CLOSED.replace("std = \"20 arcsec\"", &format!("std = \"{bias}\""));
        let found = numbers::found(&format!("filter-{name}"), &text.replace("samples = 1024", "samples = 80"));
        let squares = &column(&found.scratch.rows("r"), "attitude_nees_final")[1..];
        let median = numbers::quantile(squares, 0.5);
        let summary = found.scratch.summary("r");
        let notes = summary["notes"].as_array().unwrap();
        assert_eq!(notes.len(), if is_named { 2 } else { 0 }, "{notes:?}, a median of {median}");
        let html = found.scratch.text("r/report.html");
        let shown = [found.said.contains("overconfident"), html.contains("overconfident")];
        assert_eq!(shown, [is_named; 2], "{}", found.said);
        if is_named {
            let factor = "median error of attitude and gyro bias # sigma";
            assert!(median > 2.0, "{median}");
            // the filter estimates the gyro's bias
            assert_eq!(notes[1], "dispersed, and known to no filter: gyro scale, tracker bias");
            let html = html.to_lowercase().replace('\u{a0}', " ");
            for said in [notes[0].as_str().unwrap(), &found.said, &html] {
                let of = screen_numbers::numbers(said, factor);
                assert!((of[0] / median.sqrt() - 1.0).abs() < 6e-3, "{of:?} for {median}");
            }
        } else {
            assert!((0.4..1.8).contains(&median), "{median}");
        }
    }
}

/// Law: a run whose mission failed misses what the campaign requires, even within every limit.
#[test]
fn failed_missions_are_missed() {
    let (mission, _) = NET_LAUNCH.split_once("[[require]]").unwrap();
    let mission = mission.replace("timeout_s = 600.0", "timeout_s = 300.0");
    let found =
        page("fates", &(mission + "[[require]]\nobservable = \"impulse_total_n_s\"\nquantile = 0.9\nat_most = 1e5\n"));
    let pairs = &found.data["pairs"];
    let [samples, fates] = ["samples", "fates"].map(|key| found.array(&pairs[key]));
    let failures = found.all(&["failure"]).remove(0);
    let failed: Vec<f64> = samples.iter().map(|sample| failures[*sample as usize]).collect();
    assert!(failed.contains(&1.0), "a phase took too long in none: {failed:?}");
    let expected: Vec<f64> = failed.iter().map(|code| f64::from(u8::from(*code >= 1.0))).collect();
    assert_eq!(fates, expected);
}

/// Law: bands and medians of wheels are those of the file of bands.
#[test]
fn bands_of_wheels_are_those_of_the_file() {
    let found = page("wheel-bands", SLEW_CLOSED);
    let bands = found.scratch.table("r/bands.parquet");
    let series = texts(&bands, "series").clone();
    let [times, p05, p50, p95] = ["time_s", "p05", "p50", "p95"].map(|name| floats(&bands, name));
    let mut seen = 0;
    for (figure, column) in [("wheel_speed", "speed_{}_rad_s"), ("wheel_torque", "torque_{}_n_m")] {
        for wheel in ["w1", "w2", "w3", "w4"] {
            let name = column.replace("{}", wheel);
            let rows: Vec<usize> = (0..times.len()).filter(|row| series.value(*row) == name).collect();
            assert!(rows.len() > 100, "{name}");
            let of = |label: &str, key: &str| {
                let mark = found.mark(figure, &format!("{wheel}, {label}"));
                (found.array(&mark["x"]), found.array(&mark[key]))
            };
            for (label, key, known) in [("5 to 95%", "low", &p05), ("5 to 95%", "high", &p95), ("median", "y", &p50)] {
                let (x, y) = of(label, key);
                for (x, y) in x.iter().zip(y) {
                    let row = rows.iter().find(|row| times[**row] == *x).unwrap_or_else(|| panic!("{name} at {x} s"));
                    let scale = p95[*row].abs().max(p05[*row].abs());
                    assert!(
                        (y - known[*row]).abs() <= 1e-6 * scale,
                        "{name}, {label} at {x} s: {y} for {}",
                        known[*row]
                    );
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 1000, "{seen}");
}

/// Law: where the required quantile is a run without a value, screen and page show the share within the limit instead.
#[test]
fn a_quantile_without_a_number_is_a_share() {
    let scratch = ScratchFolder::new("loop-page-without-a-number");
    scratch.file("detumble.toml", DETUMBLE);
    let said = scratch.prints("campaign detumble.toml --samples 64 --set campaign.duration_s=30 --out r", 3);
    let found = Found::read(scratch, said);
    let summary = found.scratch.summary("r");
    let one = &summary["requirements"]["list"][0];
    assert_eq!((one["statement"].as_str(), one["verdict"].as_str()), (Some("quantile"), Some("FAIL")), "{one}");
    assert!(one["value"].is_null(), "{one}");
    let runs = ["runs", "violations"].map(|key| one[key].as_f64().expect(key));
    let share = 100.0 * (runs[0] - runs[1]) / runs[0];
    let row = found.said.lines().find(|line| line.contains("time until phase rest (in ")).unwrap();
    assert!(row.contains(&format!(" of {} runs)", runs[0])), "{row}");
    let page = found.visible();
    let row = page.split("<details class=\"answer ").nth(1).unwrap();
    let shown = numbers::read_number(between(row, "<span class=\"number\"><b>", "%</b>"));
    assert!((shown - share).abs() < 0.051 && row.contains("runs within the limit</span>"), "{share}: {row}");
    assert_says(row, [">95%</text>"]);
}
