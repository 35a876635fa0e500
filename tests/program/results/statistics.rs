//! `statistics.parquet` and `sensitivity.parquet` are those of the rows, for any number of threads.

use crate::prelude::*;

use spindrift::statistics::quantile::{Ranks, interval_ranks};
use spindrift::statistics::replicates::{Step, mean_bounds, quantile_interval};

pub const MORE: &str = r#"
[[observable]]
name = "error_ratio"
expression = "energy_error_max / angular_momentum_error_max"
[[observable]]
name = "spin"
unit = "rad/s"
expression = "sqrt(initial.angular_velocity_rad_s.x^2 + initial_angular_velocity_y_rad_s^2)"
[[observable]]
name = "half"
expression = "sqrt(initial.angular_velocity_rad_s.x)"
[summary]
columns = ["spin", "steps", "energy_body_max_j"]
"#;

fn values(rows: &[RecordBatch], name: &str) -> Vec<f64> {
    let values = column(rows, name).into_iter().zip(ended(rows));
    let counted = values.filter(|(value, (sample, status))| *sample > 0 && status == "ok" && !value.is_nan());
    counted.map(|(value, _)| value).collect()
}

fn interval(ascending: &[f64], p: f64) -> [Option<f64>; 2] {
    let Ranks { lower, upper } = interval_ranks(ascending.len() as u64, p, 0.95);
    [lower, upper].map(|rank| rank.map(|rank| ascending[rank as usize - 1]))
}

fn number(table: &RecordBatch, name: &str, row: usize) -> Option<f64> {
    let column = table.column_by_name(name).unwrap_or_else(|| panic!("no column {name}"));
    let column = column.as_primitive::<Float64Type>();
    (!column.is_null(row)).then(|| column.value(row))
}

#[test]
fn statistics_are_those_of_the_files() {
    let scratch = folder("statistics-table");
    scratch.file("thin.toml", &(campaign() + NEGATIVE_WALLS + MORE));
    scratch.prints("campaign thin.toml --out r", 1);
    let rows = scratch.rows("r");
    let ok = ended(&rows).iter().filter(|(sample, status)| *sample > 0 && status == "ok").count();
    let table = scratch.table("r/statistics.parquet");
    let names = texts(&table, "observable");
    assert!(table.num_rows() > 100);
    let mut checked = 0;
    for row in 0..table.num_rows() {
        let name = names.value(row);
        let of = |column: &str| number(&table, column, row);
        let count = |column: &str| table.column_by_name(column).expect(column).as_primitive::<Int64Type>().value(row);
        let mut x = match name {
            "error_ratio" => {
                let [a, b] = ["energy_error_max", "angular_momentum_error_max"].map(|name| values(&rows, name));
                a.iter().zip(&b).map(|(a, b)| a / b).collect()
            }
            "spin" => {
                let [a, b] = ["x", "y"].map(|axis| values(&rows, &format!("initial_angular_velocity_{axis}_rad_s")));
                a.iter().zip(&b).map(|(a, b)| (libm::pow(*a, 2.0) + libm::pow(*b, 2.0)).sqrt()).collect()
            }
            "half" => {
                let x = values(&rows, "initial_angular_velocity_x_rad_s");
                x.iter().filter(|x| **x >= 0.0).map(|x| x.sqrt()).collect()
            }
            _ => values(&rows, name),
        };
        let n = x.len();
        assert_eq!(count("count"), n as i64, "{name}");
        assert_eq!(count("without_value"), (ok - n) as i64, "{name}");
        assert_eq!(count("count_ok") + count("count_invalid_sample"), 599);
        assert_eq!(count("count_ok"), ok as i64);
        assert!(count("count_invalid_sample") > 100 && n > if name == "half" { 150 } else { 300 }, "{name}: {n}");
        x.sort_by(f64::total_cmp);
        assert_eq!((of("min"), of("max")), (Some(x[0]), Some(x[n - 1])), "{name}");
        let mean = x.iter().sum::<f64>() / n as f64;
        let deviation = (x.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1) as f64).sqrt();
        let scale = 1e-12 * mean.abs().max(deviation);
        assert!((of("mean").unwrap() - mean).abs() <= scale, "{name}");
        assert!((of("standard_deviation").unwrap() - deviation).abs() <= scale, "{name}");
        for (column, p) in [("p0_1", 0.001), ("p5", 0.05), ("p50", 0.5), ("p99_9", 0.999)] {
            let place = (n - 1) as f64 * p;
            let (low, part) = (x[place as usize], place.fract());
            let high = x[(place as usize + 1).min(n - 1)];
            let exact = if part < 0.5 { low + part * (high - low) } else { high - (1.0 - part) * (high - low) };
            assert_eq!(of(column), Some(exact), "{name} {column}");
        }
        for (column, p) in [("p0_1", 0.001), ("p5", 0.05), ("p50", 0.5), ("p99_9", 0.999)] {
            let ends = [of(&format!("{column}_lower")), of(&format!("{column}_upper"))];
            assert_eq!(ends, interval(&x, p), "{name} {column} of {n}");
        }
        // some 400 runs bound the median, and p99.9 from below only
        assert!(of("p50_lower") <= of("p50") && of("p50") <= of("p50_upper"), "{name}");
        assert!(of("p99_9_lower").is_some() && of("p99_9_upper").is_none() && of("p0_1_lower").is_none(), "{name}");
        let notes = texts(&table, "p99_9_note");
        // ln 0.025 / ln 0.999 = 3687.04, ln 0.05 / ln 0.999 = 2994.2
        assert_eq!(notes.value(row), "p99.9 with 95% confidence needs 3688 runs (2995 for a bound on one side)");
        checked += 1;
    }
    assert_eq!(names.iter().flatten().filter(|name| ["spin", "error_ratio", "half"].contains(name)).count(), 3);
    assert_eq!(checked, table.num_rows());
}

/// Law: under designs whose samples are not independent there is no interval, and the table says why.
#[test]
fn designs_without_independent_samples_have_no_intervals() {
    let scratch = folder("statistics-designs");
    for (design, says) in [
        ("kind = \"sobol\"", "not independent"),
        ("kind = \"latin_hypercube\"", "not independent"),
        ("kind = \"halton\"", "not independent"),
        ("kind = \"saltelli\"", "chosen"),
        ("kind = \"one_at_a_time\"\nlevels = 5", "chosen"),
    ] {
        let samples = match design {
            _ if design.contains("one_at_a_time") => "",
            _ if design.contains("saltelli") => "samples = 101\n",
            _ => "samples = 65\n",
        };
        let text = campaign().replace("samples = 600\n", samples);
        scratch.file("design.toml", &format!("{text}[design]\n{design}\n"));
        let screens = ["", " --verbose"].map(|more| {
            let mut command = scratch.command(&format!("campaign design.toml --out r --overwrite{more}"));
            String::from_utf8(command.env("COLUMNS", "1000").output().unwrap().stdout).unwrap()
        });
        let table = scratch.table("r/statistics.parquet");
        let intervals = texts(&table, "intervals");
        assert!(
            intervals.value(0).starts_with("none: ") && intervals.value(0).contains(says),
            "{}",
            intervals.value(0)
        );
        for row in 0..table.num_rows() {
            assert!(number(&table, "p50", row).is_some() && number(&table, "mean", row).is_some());
            for name in ["p50_lower", "p50_upper", "mean_lower", "mean_upper", "mean_standard_error"] {
                assert_eq!(number(&table, name, row), None, "{design}: {name}");
            }
        }
        let inputs = scratch.table("r/sensitivity.parquet");
        let total = inputs.column_by_name("total").unwrap();
        assert_eq!(total.null_count() == total.len(), !design.contains("saltelli"), "{design}");
        // 64 points of one Sobol sequence bind five inputs to each other
        let first = inputs.column_by_name("first_order").unwrap();
        let is_bound = design.contains("sobol");
        assert!(first.null_count() == first.len() || !is_bound, "{design}");
        let [short, long] = screens;
        let files = ["r/report.html", "r/summary.json"].map(|file| scratch.text(file));
        for (place, said) in [short, long].iter().chain(&files).enumerate() {
            let is_said = said.contains("o driver was tested");
            assert_eq!(is_said, is_bound, "{design}, {place}: {said}");
            let denials = ["o significant driver", "no input was found", "no single input"];
            let is_denied = denials.iter().any(|no| said.contains(no));
            assert!(!(is_said && is_denied), "{design}, {place}: {said}");
        }
    }
}

#[test]
fn a_magnitude_is_driven_by_what_it_is_made_of() {
    const SPIN: &str = r#"
[[observable]]
name = "cross_spin"
unit = "rad/s"
expression = "sqrt(initial.angular_velocity_rad_s.x^2 + (initial.angular_velocity_rad_s.y - 3.141592653589793)^2)"
[[require]]
observable = "cross_spin"
at_most = 5.0
quantile = 0.9
"#;
    let scratch = folder("statistics-drivers");
    scratch.file("spin.toml", &(campaign() + SPIN));
    let mut command = scratch.command("campaign spin.toml --out r --verbose");
    let screen = scratch.outputs(command.env("COLUMNS", "200"), 0);
    let inputs = scratch.table("r/sensitivity.parquet");
    let name = |column: &str, row: usize| texts(&inputs, column).value(row).to_owned();
    let rows: Vec<usize> = (0..inputs.num_rows()).filter(|row| name("observable", *row) == "cross_spin").collect();
    let drives = |row: usize| number(&inputs, "first_order_lower", row).unwrap() > 0.0;
    let mut drivers: Vec<usize> = rows.into_iter().filter(|row| drives(*row)).collect();
    drivers.sort_by(|a, b| {
        let influence = |row: &usize| number(&inputs, "first_order", *row).unwrap();
        influence(b).total_cmp(&influence(a))
    });
    let names: Vec<String> = drivers.iter().map(|row| name("input", *row)).collect();
    for axis in ["x", "y"] {
        assert!(names.contains(&format!("initial_angular_velocity_{axis}_rad_s")), "{names:?}");
    }
    let share = number(&inputs, "first_order", drivers[0]).unwrap();
    let said = |name: &str| name.strip_suffix("_rad_s").unwrap_or(name).replace('_', " ");
    let words = format!("{} explains ", said(&names[0]));
    let page = scratch.text("r/report.html");
    let line = screen.lines().find(|line| line.contains(&words)).unwrap_or_else(|| panic!("{words}: {screen}"));
    let drivers = line.trim_start().trim_start_matches("cross spin").trim();
    let (_, found) = line.split_once(&words).unwrap();
    let found: f64 = found.split('%').next().unwrap().parse().unwrap();
    assert!((0.01 * found - share).abs() < 0.006, "{found}: {share}");
    assert!(page.contains(&drivers[1..]) && drivers.contains(&said(&names[1])), "{drivers}");
}

#[test]
fn a_mean_of_replicates_has_its_interval_from_the_replicates() {
    const REPLICATES: usize = 8;
    let scratch = folder("statistics-replicates");
    let design = "[design]\nkind = \"latin_hypercube\"\nreplicates = 8\n";
    scratch.file("many.toml", &(sized(601) + design + MORE));
    scratch.prints("campaign many.toml --out r --no-report", 0);
    let rows = scratch.rows("r");
    let table = scratch.table("r/statistics.parquet");
    let names = texts(&table, "observable");
    let mut checked = 0;
    for row in 0..table.num_rows() {
        let name = names.value(row);
        if ["spin", "error_ratio", "half"].contains(&name) {
            continue;
        }
        let x = values(&rows, name);
        assert_eq!(x.len(), 600, "{name}");
        let of_replicate =
            |first: usize| x[first..].iter().step_by(REPLICATES).sum::<f64>() / (600 / REPLICATES) as f64;
        let means: Vec<f64> = (0..REPLICATES).map(of_replicate).collect();
        let (of_means, whole) = (Moments::of(means.iter().copied()), Moments::of(x));
        let error = of_means.mean_error().unwrap();
        // a spread of rounding errors is left out
        if error <= 1e-9 * whole.mean().unwrap().abs() {
            continue;
        }
        for (column, end) in ["mean_lower", "mean_upper"].into_iter().zip(mean_bounds(&means, &whole, 0.975)) {
            let found = number(&table, column, row);
            assert_eq!(found.is_some(), end.is_finite(), "{name} {column}: {found:?} {end:?}");
            // rounding of the mean, of numbers that are up to 1e9 times as large as its error, and of the skewness
            assert!(
                found.is_none_or(|found| (found - end).abs() < 1e-5 * error),
                "{name} {column}: {found:?} for {end}"
            );
        }
        let found = number(&table, "mean_standard_error", row).unwrap();
        assert!((found / error - 1.0).abs() < 1e-6, "{name}: {found} for {error}");
        checked += 1;
    }
    assert!(checked > 20, "{checked}");
    // so has the median, of few runs too
    scratch.file("few.toml", &(sized(65) + design + MORE));
    scratch.prints("campaign few.toml --out few --no-report", 0);
    let (rows, table) = (scratch.rows("few"), scratch.table("few/statistics.parquet"));
    let names = texts(&table, "observable");
    for row in (0..table.num_rows()).filter(|row| !["spin", "error_ratio", "half"].contains(&names.value(*row))) {
        let x = values(&rows, names.value(row)).into_iter().enumerate();
        let step = |(k, value)| Step { value, lower: value, replicate: k % REPLICATES, count: 1 };
        let mut steps: Vec<Step> = x.map(step).collect();
        steps.sort_by(|a, b| a.value.total_cmp(&b.value));
        let found = ["p50_lower", "p50_upper"].map(|column| number(&table, column, row));
        assert_eq!(found, quantile_interval(&steps, &[8; REPLICATES], 0.5, 0.95), "{}", names.value(row));
    }
}

#[test]
fn a_negative_correlation_is_one_too() {
    let scratch = folder("statistics-partners");
    for r in [0.9, -0.9] {
        let correlate = format!(
            "[[correlate]]\nparameters = [\"initial.angular_velocity_rad_s\"]\n\
             rank_correlation = [[1, {r}, 0.3], [{r}, 1, 0], [0.3, 0, 1]]\n"
        );
        scratch.file("partners.toml", &(campaign() + &correlate));
        scratch.prints("campaign partners.toml --out r --overwrite --no-report", 0);
        let table = scratch.table("r/sensitivity.parquet");
        let text = |name: &str, row: usize| texts(&table, name).value(row).to_owned();
        let input = |axis: &str| format!("initial_angular_velocity_{axis}_rad_s");
        assert!(table.num_rows() >= 3);
        for row in 0..table.num_rows() {
            let of = text("input", row);
            let [x, y] = ["x", "y"].map(input);
            let (partner, expected) = match &of {
                of if *of == x => (&y, r),
                of if *of == y => (&x, r),
                _ => (&x, 0.3),
            };
            assert_eq!(&text("correlated_with", row), partner, "{r}: {of}");
            // the standard error of 599 pairs without correlation is 0.041
            let found = number(&table, "largest_correlation", row).unwrap();
            assert!((found - expected).abs() < 0.16, "{r}: {of}: {found}");
        }
    }
}
