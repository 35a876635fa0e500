//! Extremes of numbers: refused with a message, or answered with a status; never a panic, and never a file that is not there.

use std::fs;

use super::small_campaign::{campaign, folder};
use crate::support::scratch_folder::batches;
use arrow_array::Array;
use arrow_array::cast::AsArray;

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

/// Law: each is refused with exit code 2 and a message about a key, or gives rows with a status each, failed ones among them; the
/// program never panics, and what it wrote is sound.
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
                let rows = &batches(&scratch.path(&format!("r{index}/runs/part-000000.parquet")))[0];
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
