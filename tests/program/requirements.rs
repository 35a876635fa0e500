//! How many runs would decide a requirement that is undecided.

use serde_json::Value;

use super::small_campaign::{campaign_without_debris, folder};

/// Law: half the distance between estimate and limit takes four times as many runs, of means and fractions, of independent samples and of
/// replicates.
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
