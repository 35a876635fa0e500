//! The screen of `spindrift compare` has the numbers of rows and file.

use crate::prelude::*;

use crate::commands::screen_numbers::{numbers, template};
use crate::small_campaign::RADIANS;

fn runs(scratch: &ScratchFolder, sides: [&str; 2]) -> [[f64; 2]; 2] {
    sides.map(|side| {
        let ended = ended(&scratch.rows(side));
        [ended[1..].iter().filter(|(_, status)| status == "ok").count() as f64, ended.len() as f64 - 1.0]
    })
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

#[test]
fn a_comparison_fits_a_screen() {
    let scratch = folder("compare-brief");
    let require =
        "\n[[require]]\nobservable = \"omega_se_s_z_final_rad_s\"\nfraction = 0.9\nat_most = \"2000 deg/s\"\n";
    let first = campaign_without_debris().replace(RADIANS, "") + require;
    let nominal = "31.41592653589793]";
    assert!(first.contains(nominal));
    scratch.file("slow.toml", &first);
    scratch.file("fast.toml", &first.replace(nominal, "36.0]"));
    scratch.prints("campaign slow.toml --out slow --no-report", 0);
    scratch.prints("campaign fast.toml --out fast --no-report", 3);
    for (sides, code, mark, last) in [
        ("slow fast", 3, "WORSE", "FAIL: 1 verdict is worse than before"),
        ("fast slow", 0, "BETTER", "PASS: 1 verdict is better, none is worse"),
    ] {
        let said = scratch.prints_at(&format!("compare {sides}"), code, 80);
        assert_fits(&said, 24, 80);
        for (line, name) in said.lines().zip(sides.split(' ')) {
            assert!(line.ends_with(&format!(" {name}, 599 of 599 runs ok")), "{line}");
        }
        let mut lines =
            said.lines().skip_while(|line| !line.contains("angular velocity about s3 at the end <= 2000 deg/s in 90%"));
        let verdict = lines.nth(1).unwrap();
        assert!(verdict.ends_with(mark) && verdict.contains("PASS") && verdict.contains("FAIL"), "{said}");
        assert_says(&said, [" 1800] deg/s", " 2062.6] deg/s"]);
        let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains("compared sample by sample: 599 samples drawn alike"), "{said}");
        assert_eq!(said.lines().last(), Some(last));
    }
}

#[test]
fn the_screen_is_the_file() {
    let scratch = folder("compare-screen");
    let text = mixed_failures().replace(RADIANS, "");
    scratch.file("first.toml", &text.replace("samples = 600", "samples = 300"));
    scratch.file("second.toml", &text.replace("samples = 600", "samples = 400").replace("0.5, 15]", "0.5, 5]"));
    for (first, second) in [("first", "second"), ("second", "first")] {
        for side in [first, second] {
            scratch.prints(&format!("campaign {side}.toml --out {side} --no-report --overwrite"), 1);
        }
        let command = format!("compare {first} {second} --verbose --tolerance 0.01 --out c.json");
        let said = scratch.prints_at(&command, 3, 250);
        let found: Value = serde_json::from_str(&scratch.text("c.json")).unwrap();
        let [of_first, of_second] = runs(&scratch, [first, second]);
        for (name, known) in [(first, of_first), (second, of_second)] {
            assert_eq!(numbers(&said, &format!("{name}, # of # runs ok")), known);
        }
        let observables = found["observables"].as_array().unwrap();
        let count = |is: &dyn Fn(&Value) -> bool| observables.iter().filter(|one| is(one)).count() as f64;
        let shifted = count(&|one| one["is_shifted"] == 1);
        assert_eq!(numbers(&said, "# of # columns are shifted"), [shifted, observables.len() as f64]);
        assert_eq!(numbers(&said, "p adjusted for # tests")[0], count(&|one| !one["p_value"].is_null()));
        let (head, table) = said.split_once("\n  column ").unwrap();
        for key in found["differing_keys"].as_array().unwrap() {
            assert!(head.contains(key["key"].as_str().unwrap()), "{key} in:\n{head}");
        }
        let rows: Vec<&str> = table.lines().skip(1).take_while(|line| line.starts_with("  ")).collect();
        for line in &rows {
            let text = line.trim_start();
            let name = text.split([' ', ',']).next().unwrap();
            let one = observables.iter().find(|one| one["observable"] == name).unwrap_or_else(|| panic!("{name}"));
            let unit = text.strip_prefix(name).and_then(|rest| rest.strip_prefix(", "));
            let unit = unit.and_then(|rest| rest.split("  ").next()).unwrap_or("");
            let size = match (one["unit"].as_str().unwrap(), unit) {
                ("rad", "deg") | ("rad/s", "deg/s") => DEGREES,
                ("rad/s", "rpm") => 30.0 / std::f64::consts::PI,
                (own, shown) => {
                    assert!(own == shown && !own.starts_with("rad"), "{line}");
                    1.0
                }
            };
            let is_moved = one["is_moved"] == 1;
            let p = if is_moved { "adjusted_p_value_moved" } else { "adjusted_p_value" };
            let keys = ["mean_first", "mean_shift", "mean_shift_lower", "mean_shift_upper"];
            let mut known: Vec<f64> = keys.into_iter().filter_map(|key| Some(size * one[key].as_f64()?)).collect();
            known.extend([p, "largest_shift"].into_iter().filter_map(|key| one[key].as_f64()));
            let after = text.strip_prefix(&format!("{name}, {unit}")).unwrap_or(text);
            let found = template(after).1;
            // a shift has the digits that its interval supports
            let near = |found: f64, known: f64, digit: f64| (found - known).abs() <= 1.1e-2 * known.abs() + digit;
            let digit = (known[3.min(known.len() - 1)] - known[2.min(known.len() - 1)]).abs() / 10.0;
            let is_same = |(place, (found, known)): (usize, (&f64, &f64))| {
                near(*found, *known, if (1..4).contains(&place) { digit } else { 0.0 })
            };
            assert_eq!(found.len(), known.len(), "{line}: {known:?}");
            assert!(found.iter().zip(&known).enumerate().all(is_same), "{line}: {known:?}");
            assert_says(line, [&format!(" {} by ", one["largest_shift_of"].as_str().unwrap())]);
            assert_eq!(line.contains("(beyond)"), known.last() > Some(&0.01), "{line}");
            let word = if one["is_shifted"] == 1 { "shifted," } else { "within chance," };
            assert_says(line, [if is_moved { "moved," } else { word }]);
        }
        assert!(rows.len() > 10, "{said}");
        assert_fits(&scratch.prints_at(&format!("compare {first} {second} --verbose"), 0, 80), usize::MAX, 80);
    }
}

#[test]
fn a_result_without_numbers_is_not_compared() {
    let scratch = folder("compare-lost");
    scratch.file("c.toml", &campaign_without_debris());
    scratch.prints("campaign c.toml --samples 20 --out some --no-report", 0);
    scratch.prints("campaign c.toml --samples 20 --set integrator.max_steps=1 --out none --no-report", 1);
    for sides in ["some none", "none some"] {
        let said = scratch.prints_wide(&format!("compare {sides}"), 0);
        assert_says(&said, ["no column is compared: a result has no dispersed run with numbers"]);
        assert!(!said.contains("the same statistics"), "{said}");
    }
}

#[test]
fn different_campaigns_are_named() {
    let scratch = folder("compare-names");
    let text = campaign_without_debris().replace(RADIANS, "");
    for (name, spin) in [("one", "0.17453292519943295]"), ("two", "0.25]")] {
        let text = text.replace("name = \"small\"", &format!("name = \"{name}\"")).replace("31.41592653589793]", spin);
        scratch.file("c.toml", &text);
        scratch.prints(&format!("campaign c.toml --samples 20 --out {name} --no-report"), 0);
    }
    let said = scratch.prints_wide("compare one two", 0);
    assert!(said.starts_with("different campaigns: one and two\nbefore: one"), "{said}");
    assert_says(
        said.lines().find(|line| line.contains("initial.angular_velocity_rad_s")).unwrap(),
        ["10] deg/s", "14.324] deg/s"],
    );
    assert!(scratch.prints_wide("compare one one", 0).starts_with("before: one"));
}
