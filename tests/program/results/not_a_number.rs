//! Campaigns whose expressions are not a number: what is null, what is undecided, and what `check` says of it.

use crate::prelude::*;

const TEXT: &str = r#"[campaign]
name = "not_a_number"
samples = 60
seed = 1
duration_s = 20.0
[observe]
points = 41
groups = ["attitude", "motion"]
[body]
mass_kg = 10.0
center_of_mass_m = [0, 0, 0]
principal_moments_kg_m2 = [30, 30, 20]
[initial]
angular_velocity_rad_s = [0.3, 0.0, 0.6]
[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = 0.01
[[event]]
name = "never"
quantity = "ln(-1 - spin_axis_angle_rad)"
value = 0.0
[[event]]
name = "tipped"
quantity = "spin_axis_angle_rad"
value = 3.0
[[extreme]]
name = "root"
quantity = "sqrt(-1 - spin_axis_angle_rad)"
[[observable]]
name = "slow"
expression = "if(sqrt(initial.angular_velocity_rad_s.y) < 1, 1, 0)"
"#;

fn required(observable: &str, more: &str) -> String {
    format!("[[require]]\nobservable = \"{observable}\"\n{more}\n")
}

/// Law: what is not a number passes nothing: each requirement on it is UNDECIDED and says why.
#[test]
fn what_is_not_a_number_passes_nothing() {
    let scratch = ScratchFolder::new("not-a-number");
    let share = "fraction = 0.5\n";
    let requirements = [
        ("never_count", format!("{share}at_most = 0"), "UNDECIDED"),
        ("never_time_s", format!("{share}at_least = 10\nnever = \"meets\""), "UNDECIDED"),
        ("never_time_s", "quantile = 0.5\nat_most = 10".to_owned(), "UNDECIDED"),
        ("never_count", "mean = true\nat_most = 1".to_owned(), "UNDECIDED"),
        ("root", format!("{share}at_most = 1\nnever = \"meets\""), "UNDECIDED"),
        ("slow", format!("{share}at_least = 1"), "UNDECIDED"),
        ("tipped_count", format!("{share}at_most = 0"), "PASS"),
        ("tipped_time_s", format!("{share}at_least = 10\nnever = \"meets\""), "PASS"),
    ];
    let tables: String = requirements.iter().map(|(name, more, _)| required(name, more)).collect();
    scratch.file("c.toml", &(TEXT.to_owned() + &tables));
    let said = scratch.prints("campaign c.toml --out r --verbose", 5);
    // an outcome without values is a sentence: it has no row of numbers and no driver
    assert_says(&said, ["no run has a value of time until never"]);
    assert!(!said.contains("(in 0 of") && !said.lines().any(|line| line.ends_with(": ")), "{said}");
    let rows = scratch.rows("r");
    for (name, ..) in requirements.iter().filter(|(name, ..)| *name != "slow") {
        let is_null = |batch: &RecordBatch| batch.column_by_name(name).expect(name).null_count() == batch.num_rows();
        assert_eq!(rows.iter().all(is_null), *name != "tipped_count", "{name}");
    }
    let summary = scratch.summary("r");
    let list = summary["requirements"]["list"].as_array().unwrap();
    for (one, (name, more, word)) in list.iter().zip(&requirements) {
        assert_eq!(one["verdict"], *word, "{name} {more}: {one}");
        let reason = one["reason"].as_str().unwrap_or_default();
        assert_eq!(reason.starts_with(&format!("{name} is not a number in ")), *word == "UNDECIDED", "{one}");
        assert_eq!(one["estimate"].is_null(), *word == "UNDECIDED", "{one}");
    }
    assert_says(&said, ["never_count is not a number in 59 runs"]);
    let mut check = scratch.command("check c.toml");
    let said = scratch.outputs(check.env("COLUMNS", "400"), 0);
    for text in [
        "[[event]] never: ln(-1 - spin_axis_angle_rad) is not a number in 8 of the first 8 samples, first in sample 0 \
        at 0 s",
        "[[extreme]] root: sqrt(-1 - spin_axis_angle_rad) is not a number in 8 of the first 8 samples",
        "[[observable]] slow: it is not a number in ",
    ] {
        assert_says(&said, [text]);
    }
    assert!(!said.contains("tipped: spin_axis_angle_rad is not"), "{said}");
}
