//! Extremes of numbers are refused with a message or answered with a status, and never cause a panic.

use crate::prelude::*;

use arrow_array::Array as _;
use spindrift::findings::loss::readable;
const SPIN: &str = "[0, 3.141592653589793, 31.41592653589793]";

const CHANGES: &[(&str, &str, &[&str])] = &[
    ("duration_s = ", "1.0", &["1e300", "1.7976931348623157e308", "1e-300", "5e-324", "1e-29", "0", "inf", "1e100"]),
    ("points = ", "11", &["2", "1", "1000000000000000000"]),
    ("tolerance = ", "1e-10", &["0", "nan", "-nan", "1e-300", "1e300", "1e-16"]),
    ("", "tolerance = 1e-10", &["max_steps = 1"]),
    ("\ntolerance = ", "1e-10", &["1e-10\nstep_s = 1e-300"]),
    ("method = ", "\"auto\"", &["\"null_space\""]),
    (
        "method = ",
        "\"auto\"\ntolerance = 1e-10",
        &[
            "\"runge_kutta_4\"\nstep_s = 1e-300",
            "\"runge_kutta_4\"\nstep_s = 5e-324",
            "\"runge_kutta_4\"\nstep_s = 1.0",
        ],
    ),
    (
        "angular_velocity_rad_s = ",
        SPIN,
        &[
            "[0, 0, 1e300]",
            "[1e160, 1e160, 1e160]",
            "[1e10, 1e10, 0]",
            "[0, 0, 0]",
            "[5e-324, 5e-324, 5e-324]",
            "[1e-160, 1e-160, 1e-160]",
        ],
    ),
    ("rate_rad_s = ", "314.1592653589793", &["1e300", "-1.7976931348623157e308"]),
    ("= ", "[100, 0, 0]", &["[1e300, 1e300, 0]", "[1e7, 0, 0]"]),
    ("position_m = ", "[0, 0, 0]", &["[1e300, -1e300, 1e300]"]),
    ("velocity_m_s = ", "[10, 0, 0]", &["[1e300, 1e300, 1e300]", "[1.7976931348623157e308, 0, 0]"]),
    ("attitude = ", "[1, 0, 0, 0]", &["[1e-300, 0, 0, 0]", "[1e300, 1e300, 1e300, 1e300]", "[0, 0, 0, 0]"]),
    ("position_m = ", "[0, 0, 1.5]", &["[1e300, 0, 0]"]),
    ("density_kg_m3 = ", "2700.0", &["1e300", "1e-300", "5e-324"]),
    ("length_m = ", "3.0", &["1e200", "1e-200"]),
    ("outer_radius_m = ", "1.0", &["1e154"]),
    ("side_m = ", "0.2", &["1e-110", "1e110"]),
    ("radius_m = ", "0.25", &["1e-160"]),
    ("std = ", "[0.5, 0.5, 1.5]", &["[1e300, 1e300, 1e300]", "[5e-324, 1e-300, 0]"]),
    ("seed = ", "7", &["9223372036854775807", "18446744073709551615"]),
];

/// Law: each extreme is refused with code 2 and its key, or gives sound rows with a status each, and never a panic.
#[test]
fn extremes_are_refused_or_answered() {
    let scratch = folder("extremes");
    let (mut refused, mut answered) = (0, 0);
    let changes = CHANGES.iter().flat_map(|(key, old, values)| values.iter().map(move |new| (key, old, new)));
    for (key, old, to) in changes {
        let (good, from) = (sized(5), format!("{key}{old}"));
        assert!(good.contains(&from), "{from}");
        let limit = if to.contains("max_steps") { "[observe]" } else { "max_steps = 3000\n[observe]" };
        let text = good.replacen(&from, &format!("{key}{to}"), 1).replace("[observe]", limit);
        scratch.file("extreme.toml", &text);
        let output = scratch.command("campaign extreme.toml --out r --yes").output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{to}: {said}");
        match output.status.code() {
            Some(2) => {
                refused += 1;
                assert!(said.contains("extreme.toml") && said.contains("must be"), "{to}: {said}");
                assert!(!scratch.path("r").exists(), "{to}");
            }
            Some(0 | 1) => {
                answered += 1;
                let rows = &scratch.table("r/runs/part-000000.parquet");
                let statuses = texts(rows, "status");
                assert_eq!(statuses.len(), 5, "{to}");
                assert!(statuses.iter().flatten().all(|status| status != "internal_error"), "{to}");
                let reasons = texts(rows, "reason");
                let is_reason = |row| (statuses.value(row) == "ok") == reasons.is_null(row);
                assert!((0..5).all(is_reason), "{to}");
                scratch.prints("verify r --fraction 1", 0);
                fs::remove_dir_all(scratch.path("r")).unwrap();
            }
            code => panic!("{to}: exit code {code:?}\n{said}"),
        }
    }
    assert!(refused > 15 && answered > 20, "{refused} refused, {answered} answered");
}

/// Changes that take hours or more: rates that no step resolves, a wheel that is larger than a planet.
const LONG: &[(&str, &str)] =
    &[(SPIN, "[1e9, 1e9, 0]"), (SPIN, "[0, 1e308, 1e308]"), ("radius_m = 0.25", "radius_m = 1e9")];

/// Law: a run for which `integrator.max_steps` does not suffice ends as soon as its pace shows it.
#[test]
fn what_is_out_of_reach_ends_at_once() {
    let scratch = folder("out-of-reach");
    for (from, to) in LONG {
        let text = sized(3).replace("\"auto\"", "\"taylor\"").replacen(from, to, 1);
        scratch.file("long.toml", &text);
        let said = scratch.prints_wide("check long.toml", 0);
        let (_, why) =
            said.split_once("cannot be estimated: sample 0 needs more than 20000 steps, which lead to ").expect(&said);
        assert!(
            why.contains(
                "s of 1 s; at that pace the steps do not suffice; to fix: increase integrator.max_steps (10000000)"
            ),
            "{to}: {why}"
        );
        let said = scratch.prints("simulate long.toml", 1);
        assert!(said.contains("step_limit: integrator.max_steps does not suffice: the run reached "), "{to}: {said}");
        let said = scratch.prints("campaign long.toml --samples 3000 --out many", 2);
        assert!(
            said.contains("cannot be estimated: sample 0 needs more than 20000 steps") && !said.contains("hours"),
            "{said}"
        );
        scratch.prints("campaign long.toml --out r --overwrite", 1);
        let rows = &scratch.table("r/runs/part-000000.parquet");
        let statuses = texts(rows, "status");
        assert!(statuses.iter().all(|status| status == Some("step_limit")), "{to}: {statuses:?}");
    }
    let fast = campaign().replace(SPIN, "[1e9, 1e9, 0]");
    for method in spindrift::propagation::Method::ALL {
        let step = if method.has_fixed_step() { "\nstep_s = 1e-10" } else { "" };
        let written = format!("method = \"{}\"\ntolerance = 1e-10{step}", method.name());
        scratch.file("fast.toml", &fast.replace("method = \"auto\"\ntolerance = 1e-10", &written));
        let is_periodic = method == spindrift::propagation::Method::Auto;
        let said = scratch.prints("simulate fast.toml", if is_periodic { 0 } else { 1 });
        let is_given_up = said.contains("step_limit: integrator.max_steps does not suffice");
        assert_eq!(is_given_up, !is_periodic, "{}: {said}", method.name());
    }
}

/// Law: giving up a run does not depend on the runs beside it: each ends as it does alone, to all digits.
#[test]
fn outliers_end_alone() {
    let scratch = folder("outliers");
    let text = sized(40);
    let at = text.find("[[disperse]]").unwrap();
    let radius = "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"empirical\"\nfile = \
        \"radii.csv\"\ncolumn = \"x\"\n";
    scratch.file("outliers.toml", &format!("{}{radius}", &text[..at]));
    scratch.file("radii.csv", &format!("x\n{}1e9\n1e7\n", "0.25\n0.26\n".repeat(3)));
    assert_says(scratch.prints_wide("check outliers.toml", 0), ["cannot be estimated: sample "]);
    scratch.prints("campaign outliers.toml --out r", 1);
    let rows = &scratch.table("r/runs/part-000000.parquet");
    let [statuses, reasons] = ["status", "reason"].map(|name| texts(rows, name).clone());
    let limited: Vec<usize> = (0..40).filter(|row| statuses.value(*row) == "step_limit").collect();
    assert!((5..20).contains(&limited.len()), "{limited:?}");
    assert_eq!(limited.len() + statuses.iter().filter(|status| *status == Some("ok")).count(), 40, "{statuses:?}");
    for row in limited {
        let said = scratch.prints(&format!("simulate outliers.toml --sample {row}"), 1);
        let reason = readable(reasons.value(row));
        assert!(said.contains(&format!("the run ended with step_limit: {reason};")), "{row}: {said}");
    }
}

/// Law: masses whose products overflow are refused with the limit in every shipped campaign, and none is shown
/// infinite.
#[test]
fn masses_that_overflow_are_refused() {
    let scratch = folder("large-masses");
    for path in files() {
        let mut refused = 0;
        for key in ["body.mass_kg", "debris.mass_kg", "wheels.w1.mass_kg"] {
            let command = format!("check {} --set {key}=1e308", path.display());
            let output = scratch.command(&command).output().unwrap();
            let said = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
            assert_eq!(output.status.code(), Some(2), "{path:?} {key}: {said}");
            assert!(!said.contains("panicked") && !said.contains("inf kg"), "{path:?} {key}: {said}");
            refused += usize::from(said.contains("at most 1e150"));
        }
        assert!(refused > 0, "{path:?}");
    }
}

/// Law: a campaign of the nominal sample alone is checked, without draws and percentiles.
#[test]
fn a_campaign_of_one_sample_is_checked() {
    assert_says(
        folder("one-sample").says("check", "slew.toml", "--set campaign.samples=1 --verbose", 0),
        ["of 0 draws (sample 0 is nominal)"],
    );
}
