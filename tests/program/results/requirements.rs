//! How many runs would decide a requirement that is undecided, and at which confidence one that fails alone would.

use crate::{commands::screen_numbers::junit_counts, prelude::*};

/// Law: half the distance between estimate and limit takes four times as many runs.
#[test]
fn half_the_distance_takes_four_times_the_runs() {
    let scratch = folder("runs-that-decide");
    // normal with mean zero, known without a run
    let observable = "[[observable]]\nname = \"spin\"\nexpression = \"initial.angular_velocity_rad_s.x\"\n";
    let designs =
        ["random\"", "sobol\"\nreplicates = 8", "latin_hypercube\"\nreplicates = 10", "halton\"\nreplicates = 5"];
    for design in designs {
        let samples = campaign_without_debris().replace("samples = 600", "samples = 401");
        let text = format!("{samples}[design]\nkind = \"{design}\n{observable}");
        let answers = |statements: &[String], code: i32| -> Vec<Value> {
            let require = |statement: &String| format!("[[require]]\nobservable = \"spin\"\n{statement}\n");
            scratch.file("asked.toml", &(text.clone() + &statements.iter().map(require).collect::<String>()));
            scratch.prints("campaign asked.toml --out r --overwrite --no-report", code);
            scratch.summary("r")["requirements"]["list"].as_array().unwrap().clone()
        };
        let statements: [fn(f64) -> String; 2] = [
            |limit| format!("mean = true\nat_least = {limit:?}"),
            |fraction| format!("fraction = {fraction:?}\nat_most = 0.1"),
        ];
        for (statement, passes) in statements.into_iter().zip([-1e3, 0.01]) {
            let found = &answers(&[statement(passes)], 0)[0];
            let [estimate, lower] = [&found["estimate"], &found["bounds"][0]].map(|value| value.as_f64().unwrap());
            // within the bounds nothing is decided
            let limits = [0.4, 0.2].map(|part| statement(estimate - part * (estimate - lower)));
            let found = answers(&limits, 5);
            let runs = [0, 1].map(|index| found[index]["runs_that_would_decide"].as_f64().unwrap());
            // fractions: their variance is that at another target; whole numbers of runs
            assert!(
                runs[0] > 400.0 && (runs[1] / runs[0] / 4.0 - 1.0).abs() < 0.06,
                "{design}: {runs:?} runs, {found:?}"
            );
        }
    }
}

/// Law: a requirement that fails by itself and not at its share of the errors is undecided, with both confidences.
#[test]
fn a_requirement_may_fail_alone() {
    let scratch = folder("fails-alone");
    let observable = "[[observable]]\nname = \"spin\"\nexpression = \"initial.angular_velocity_rad_s.x\"\n";
    let text = campaign_without_debris().replace("samples = 600", "samples = 300") + observable;
    scratch.file("drawn.toml", &text);
    scratch.prints("campaign drawn.toml --out drawn --no-report", 0);
    let mut drawn = column(&scratch.rows("drawn"), "initial_angular_velocity_x_rad_s").split_off(1);
    drawn.sort_by(f64::total_cmp);
    let require = |limit: f64| format!("[[require]]\nobservable = \"spin\"\nfraction = 0.5\nat_most = {limit:?}\n");
    scratch.file("asked.toml", &(text + &require(0.5 * (drawn[132] + drawn[133])) + &require(1e3)));
    let mut command = scratch.command("campaign asked.toml --out r --no-report --junit junit.xml --verbose");
    let said = scratch.outputs(command.env("COLUMNS", "300"), 5);
    let one = &scratch.summary("r")["requirements"]["list"][0];
    assert_eq!((&one["verdict"], &one["violations"]), (&"UNDECIDED".into(), &166.into()));
    let known = ["confidence_of_pass_and_bounds", "confidence_of_fail"].map(|key| 100.0 * one[key].as_f64().unwrap());
    assert!((known[0] - 95.0).abs() < 1e-9 && (known[1] - 97.5).abs() < 1e-9, "{known:?}");
    let junit = scratch.text("junit.xml");
    assert!(said.contains("UNDECIDED  ") && junit_counts(&junit)[1..] == [0, 1], "{said}{junit}");
    assert_says(&junit, ["<error type=\"undecided\""]);
    for said in [said, junit] {
        says(&said, "missed at #%, not at the #% that all requirements together ask for", &known);
    }
}

/// Law: of requirements with one verdict, that whose limit is fewest half-widths of its interval away is first.
#[test]
fn the_nearest_to_its_limit_is_first() {
    let scratch = folder("nearest");
    let asked = "[[observable]]\nname = \"off\"\nexpression = \"abs(initial.angular_velocity_rad_s.x)\"\n\
                 [[require]]\nobservable = \"off\"\nfraction = 0.6\nat_most = 1.3\n\
                 [[require]]\nobservable = \"off\"\nmean = true\nat_most = 0.75\n";
    scratch.file("asked.toml", &(campaign_without_debris() + asked));
    let said = scratch.prints_wide("campaign asked.toml --out r --no-report", 0);
    let place = |words: &str| said.find(words).unwrap_or_else(|| panic!("{words}: {said}"));
    assert!(place("mean of off <= 0.75") < place("off <= 1.3 in 60%"), "{said}");
}
