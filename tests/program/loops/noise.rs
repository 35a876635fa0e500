//! The share of the variance due to noise within control loops, from `report --noise`.

use crate::prelude::*;
use crate::support::campaigns::small_wheel;

fn noisy() -> String {
    const HEAD: &str = r#"[campaign]
name = "noisy"
samples = 401
seed = 5
duration_s = 4
[observe]
points = 3
"#;
    const REST: &str = r#"[control]
period_s = 0.5
estimator = "raw"
wheels = ["w1"]
[[sensors]]
name = "tracker"
kind = "star_tracker"
noise_rad = [1e-3, 0, 0]
[[sensors]]
name = "tachometers"
kind = "tachometers"
[[guidance]]
phase = "damp"
law = "rate_damping"
gain_n_m_s = 0.1
[[disperse]]
parameter = "body.inertia_scale"
distribution = "normal"
std = 0.001
[summary]
columns = ["attitude_estimate_error_final_rad"]
[[observable]]
name = "of_scene"
expression = "body.inertia_scale"
[[observable]]
name = "of_both"
expression = "body.inertia_scale + attitude_estimate_error_final_rad"
"#;
    [HEAD, SMALL_BODY, &small_wheel("w1", [1, 0, 0]), REST].concat()
}

fn said(text: &str, outcome: &str) -> [f64; 3] {
    let line = text
        .lines()
        .find(|line| line.trim_start().starts_with(&format!("{outcome}: ")))
        .unwrap_or_else(|| panic!("{text}"));
    let (_, numbers) = line.split_once("noise within the loop is ").unwrap();
    let mut numbers = numbers.split(['%', '[', ',', ']']).filter_map(|word| word.trim().parse::<f64>().ok());
    from_fn(|_| numbers.next().unwrap())
}

fn variance(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64
}

/// Law: an outcome of the scene has no noise, one of a sensor is all noise, a sum has the share of its parts.
#[test]
fn noise_is_told_from_scenes() {
    let run = found("noise", &noisy());
    let parts = run.rows(&["attitude_estimate_error_final_rad", "body_inertia_scale"]);
    let [of_noise, of_scene] = [0, 1].map(|k| variance(&parts.iter().map(|(_, row)| row[k]).collect::<Vec<f64>>()));
    assert!(run.visible().contains("report . --noise 256"), "the page says how");
    let text = run.scratch.prints_wide("report r --noise 400", 0);
    run.scratch.prints("verify r --fraction 0", 0);
    assert_says(&text, ["of scene: noise within the loop changes it in none of 400 scenes"]);
    let [share, low, high] = said(&text, "attitude estimate error at the end");
    assert!(share > 90.0 && low < 100.0 && high == 100.0, "{text}");
    let [share, low, high] = said(&text, "of both");
    let expected = 100.0 * of_noise / (of_noise + of_scene);
    assert!((20.0..60.0).contains(&expected) && (low..high).contains(&expected), "{expected}: {text}");
    assert!((share / expected - 1.0).abs() < 0.2 && high - low < 20.0, "{expected}: {text}");
    let again = Found::read(run.scratch, String::new());
    let page = again.visible();
    let words = format!(
        "oise within the loop is {}",
        text.split_once("of both").unwrap().1.split_once("loop is ").unwrap().1.lines().next().unwrap()
    );
    assert!(page.contains(&words), "{page} does not say {words}");

    let scratch = again.scratch;
    let noisy = noisy();
    let start = noisy.find("[control]").unwrap();
    let end = noisy.find("[[disperse]]").unwrap();
    let text = noisy.replace(&noisy[start..end], "").replace("attitude_estimate_error_final_rad", "energy_error_max");
    scratch.file("open.toml", &text);
    scratch.prints("campaign open.toml --out open", 0);
    assert_says(scratch.prints("report open --noise 8", 2), ["no control loop", "leave out --noise"]);
}
