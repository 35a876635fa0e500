//! Extremes of numbers: refused with a message, or answered with a status; never a panic, and never a file that is not
//! there.

use std::fs;

use crate::small_campaign::{campaign, folder};
use arrow_array::Array;
use arrow_array::cast::AsArray;
use spindrift::findings::loss::readable;

/// What is changed in the campaign, and to what.
const CHANGES: &[(&str, &str)] = &[
    // times
    ("duration_s = 1.0", "duration_s = 1e300"),
    ("duration_s = 1.0", "duration_s = 1.7976931348623157e308"),
    ("duration_s = 1.0", "duration_s = 1e-300"),
    ("duration_s = 1.0", "duration_s = 5e-324"),
    ("duration_s = 1.0", "duration_s = 1e-29"), // an observation every 1e-30 s
    ("duration_s = 1.0", "duration_s = 0"),
    ("duration_s = 1.0", "duration_s = inf"),
    ("duration_s = 1.0", "duration_s = 1e100"),
    ("points = 11", "points = 2"),
    ("points = 11", "points = 1"),
    ("points = 11", "points = 1000000000000000000"),
    // tolerances
    ("tolerance = 1e-10", "tolerance = 0"),
    ("tolerance = 1e-10", "tolerance = nan"),
    ("tolerance = 1e-10", "tolerance = -nan"),
    ("tolerance = 1e-10", "tolerance = 1e-300"),
    ("tolerance = 1e-10", "tolerance = 1e300"),
    ("tolerance = 1e-10", "tolerance = 1e-16"),
    ("tolerance = 1e-10", "max_steps = 1"),
    ("method = \"auto\"\ntolerance = 1e-10", "method = \"runge_kutta_4\"\nstep_s = 1e-300"),
    ("method = \"auto\"\ntolerance = 1e-10", "method = \"runge_kutta_4\"\nstep_s = 5e-324"),
    ("method = \"auto\"\ntolerance = 1e-10", "method = \"runge_kutta_4\"\nstep_s = 1.0"),
    ("method = \"auto\"", "method = \"null_space\""),
    // rates
    ("[0, 3.141592653589793, 31.41592653589793]", "[0, 0, 1e300]"),
    ("[0, 3.141592653589793, 31.41592653589793]", "[1e160, 1e160, 1e160]"),
    ("[0, 3.141592653589793, 31.41592653589793]", "[1e10, 1e10, 0]"),
    ("[0, 3.141592653589793, 31.41592653589793]", "[0, 0, 0]"),
    ("[0, 3.141592653589793, 31.41592653589793]", "[5e-324, 5e-324, 5e-324]"),
    ("[0, 3.141592653589793, 31.41592653589793]", "[1e-160, 1e-160, 1e-160]"),
    ("rate_rad_s = 314.1592653589793", "rate_rad_s = 1e300"),
    ("rate_rad_s = 314.1592653589793", "rate_rad_s = -1.7976931348623157e308"),
    ("= [100, 0, 0]", "= [1e300, 1e300, 0]"),
    ("= [100, 0, 0]", "= [1e7, 0, 0]"),
    // places and attitudes
    ("position_m = [0, 0, 0]", "position_m = [1e300, -1e300, 1e300]"),
    ("velocity_m_s = [10, 0, 0]", "velocity_m_s = [1e300, 1e300, 1e300]"),
    ("velocity_m_s = [10, 0, 0]", "velocity_m_s = [1.7976931348623157e308, 0, 0]"),
    ("attitude = [1, 0, 0, 0]", "attitude = [1e-300, 0, 0, 0]"),
    ("attitude = [1, 0, 0, 0]", "attitude = [1e300, 1e300, 1e300, 1e300]"),
    ("attitude = [1, 0, 0, 0]", "attitude = [0, 0, 0, 0]"),
    ("position_m = [0, 0, 1.5]", "position_m = [1e300, 0, 0]"),
    // masses and sizes
    ("density_kg_m3 = 2700.0", "density_kg_m3 = 1e300"),
    ("density_kg_m3 = 2700.0", "density_kg_m3 = 1e-300"),
    ("density_kg_m3 = 2700.0", "density_kg_m3 = 5e-324"),
    ("length_m = 3.0", "length_m = 1e200"),
    ("length_m = 3.0", "length_m = 1e-200"),
    ("outer_radius_m = 1.0", "outer_radius_m = 1e154"),
    ("side_m = 0.2", "side_m = 1e-110"),
    ("side_m = 0.2", "side_m = 1e110"),
    ("radius_m = 0.25", "radius_m = 1e-160"),
    // draws
    ("std = [0.5, 0.5, 1.5]", "std = [1e300, 1e300, 1e300]"),
    ("std = [0.5, 0.5, 1.5]", "std = [5e-324, 1e-300, 0]"),
    ("seed = 7", "seed = 9223372036854775807"),
    ("seed = 7", "seed = 18446744073709551615"),
];

/// Law: each is refused with exit code 2 and a message about a key, or gives rows with a status each, failed ones among
/// them; the program never panics, and what it wrote is sound.
#[test]
fn extremes_are_refused_or_answered() {
    let scratch = folder("extremes");
    let (mut refused, mut answered) = (0, 0);
    for (index, (from, to)) in CHANGES.iter().enumerate() {
        let good = campaign().replace("samples = 600", "samples = 5");
        assert!(good.contains(from), "{from}");
        let changed = good.replacen(from, to, 1);
        let text = if to.contains("max_steps") {
            changed
        } else {
            changed.replace("[observe]", "max_steps = 3000\n[observe]")
        };
        scratch.file("extreme.toml", &text);
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_spindrift"))
            .args(["campaign", "extreme.toml", "--out", &format!("r{index}"), "--yes"])
            .current_dir(&scratch.0)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{to}: {said}");
        match output.status.code() {
            Some(2) => {
                refused += 1;
                assert!(said.contains("extreme.toml") && said.contains("must be"), "{to}: {said}");
                assert!(!scratch.path(&format!("r{index}")).exists(), "{to}");
            }
            Some(0 | 1) => {
                answered += 1;
                let rows = &scratch.table(&format!("r{index}/runs/part-000000.parquet"));
                let statuses = rows.column_by_name("status").unwrap().as_string::<i32>();
                assert_eq!(statuses.len(), 5, "{to}");
                assert!(statuses.iter().flatten().all(|status| status != "internal_error"), "{to}");
                let reasons = rows.column_by_name("reason").unwrap().as_string::<i32>();
                assert!(
                    (0..5).all(|row| (statuses.value(row) == "ok") == reasons.iter().nth(row).unwrap().is_none()),
                    "{to}"
                );
                scratch.prints(&format!("verify r{index} --fraction 1"), 0);
                fs::remove_dir_all(scratch.path(&format!("r{index}"))).unwrap();
            }
            code => panic!("{to}: exit code {code:?}\n{said}"),
        }
    }
    assert!(refused > 15 && answered > 20, "{refused} refused, {answered} answered");
}

/// What takes hours or more: rates that no step resolves, a wheel that is larger than a planet.
const LONG: &[(&str, &str)] = &[
    ("[0, 3.141592653589793, 31.41592653589793]", "[1e9, 1e9, 0]"),
    ("[0, 3.141592653589793, 31.41592653589793]", "[0, 1e308, 1e308]"),
    ("radius_m = 0.25", "radius_m = 1e9"),
];

/// Law: a run that `integrator.max_steps` does not suffice for ends as soon as its pace says so, in all methods: as a
/// row with that status and reason. `check` says what it cannot estimate. (Without the first these commands take
/// minutes.)
#[test]
fn what_is_out_of_reach_ends_at_once() {
    let scratch = folder("out-of-reach");
    for (from, to) in LONG {
        // `auto` finds the period of such rates
        let text =
            campaign().replace("samples = 600", "samples = 3").replace("\"auto\"", "\"taylor\"").replacen(from, to, 1);
        scratch.file("long.toml", &text);
        let said = scratch.prints_wide("check long.toml", 0);
        let (_, why) = said
            .split_once("cannot be estimated: sample 0 needs more than 20000 steps, which lead to ")
            .unwrap_or_else(|| panic!("{to}: {said}"));
        assert!(why.contains("s of 1 s; at that pace integrator.max_steps (10000000) does not suffice"), "{to}: {why}");
        let said = scratch.prints("simulate long.toml", 1);
        assert!(said.contains("step_limit: integrator.max_steps does not suffice: the run reached "), "{to}: {said}");
        // the time of many is not known, and no number stands for it
        let said = scratch.prints("campaign long.toml --samples 3000 --out many", 2);
        assert!(
            said.contains("cannot be estimated: sample 0 needs more than 20000 steps") && !said.contains("hours"),
            "{said}"
        );
        scratch.prints("campaign long.toml --out r --overwrite", 1);
        let rows = &scratch.table("r/runs/part-000000.parquet");
        let statuses = rows.column_by_name("status").unwrap().as_string::<i32>();
        assert!(statuses.iter().all(|status| status == Some("step_limit")), "{to}: {statuses:?}");
    }
    let fast = campaign().replace("[0, 3.141592653589793, 31.41592653589793]", "[1e9, 1e9, 0]");
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

/// Law: whether a run is given up does not depend on the runs beside it: those of a campaign end as each does alone, at
/// the same time to all digits. A sample that is not out of reach is not given up.
#[test]
fn outliers_end_alone() {
    let scratch = folder("outliers");
    let text = campaign().replace("samples = 600", "samples = 40");
    let at = text.find("[[disperse]]").unwrap();
    let radius = "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"empirical\"\nfile = \
        \"radii.csv\"\ncolumn = \"x\"\n";
    scratch.file("outliers.toml", &format!("{}{radius}", &text[..at]));
    scratch.file("radii.csv", &format!("x\n{}1e9\n1e7\n", "0.25\n0.26\n".repeat(3)));
    let said = scratch.prints_wide("check outliers.toml", 0);
    assert!(said.contains("cannot be estimated: sample "), "{said}");
    scratch.prints("campaign outliers.toml --out r", 1);
    let rows = &scratch.table("r/runs/part-000000.parquet");
    let [statuses, reasons] =
        ["status", "reason"].map(|name| rows.column_by_name(name).unwrap().as_string::<i32>().clone());
    let limited: Vec<usize> = (0..40).filter(|row| statuses.value(*row) == "step_limit").collect();
    assert!((5..20).contains(&limited.len()), "{limited:?}");
    assert_eq!(limited.len() + statuses.iter().filter(|status| *status == Some("ok")).count(), 40, "{statuses:?}");
    for row in limited {
        let said = scratch.prints(&format!("simulate outliers.toml --sample {row}"), 1);
        let reason = readable(reasons.value(row));
        assert!(said.contains(&format!("the run ended with step_limit: {reason};")), "{row}: {said}");
    }
}

/// Law: masses whose products overflow are refused with the limit, whatever has them, in every shipped campaign; no
/// number of a mass that is shown is infinite.
#[test]
fn masses_that_overflow_are_refused() {
    let scratch = folder("large-masses");
    for entry in fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/campaigns")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let mut refused = 0;
        for key in ["body.mass_kg", "debris.mass_kg", "wheels.w1.mass_kg"] {
            let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_spindrift"));
            let command = command.arg("check").arg(&path).arg("--set").arg(format!("{key}=1e308"));
            let output = command.current_dir(&scratch.0).output().unwrap();
            let said =
                format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
            assert_eq!(output.status.code(), Some(2), "{path:?} {key}: {said}");
            assert!(!said.contains("panicked") && !said.contains("inf kg"), "{path:?} {key}: {said}");
            refused += usize::from(said.contains("at most 1e150"));
        }
        assert!(refused > 0, "{path:?}");
    }
}

/// Law: a campaign of the nominal sample alone is checked: it has no draws, and so no percentiles.
#[test]
fn a_campaign_of_one_sample_is_checked() {
    let said = folder("one-sample").says("check", "slew.toml", "--set campaign.samples=1 --verbose", 0);
    assert!(said.contains("of 0 draws (sample 0 is nominal)"), "{said}");
}
