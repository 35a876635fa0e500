//! Intervals around curves, the motion of the replay, correlations and their directions on the page.

use crate::prelude::*;

/// Spearman's coefficient of values without ties: 1 - 6 sum d^2 / (n (n^2 - 1)).
fn spearman(x: &[f64], y: &[f64]) -> f64 {
    let ranks = |values: &[f64]| -> Vec<f64> {
        let rank = |value: &f64| values.iter().filter(|other| *other < value).count() as f64;
        values.iter().map(rank).collect()
    };
    let n = x.len() as f64;
    let squares: f64 = ranks(x).iter().zip(ranks(y)).map(|(a, b)| (a - b).powi(2)).sum();
    1.0 - 6.0 * squares / (n * (n * n - 1.0))
}

fn dispersed(found: &Found, name: &str) -> Vec<f64> {
    found.all(&[name])[0][1..].to_vec()
}

/// Law: the replay has the rates, attitude and wheel angles of the row at the end, and its momentum throughout.
#[test]
fn the_replay_moves_as_the_run() {
    let found = found("moves", &motion());
    let names = ["omega_se_s_x_final_rad_s", "omega_se_s_y_final_rad_s", "omega_se_s_z_final_rad_s"];
    let quaternion = ["q_es_w_final", "q_es_x_final", "q_es_y_final", "q_es_z_final"];
    let (rates, attitudes) = (found.all(&names), found.all(&quaternion));
    let wheels = found.all(&["rate_w1_final_rad_s", "rate_w2_final_rad_s"]);
    let momentum = found.all(&["angular_momentum_initial_n_m_s"]);
    for run in found.shown_runs() {
        let row = run["sample"].as_u64().unwrap() as usize;
        let [omega, attitude, angles, times, h] =
            ["omega", "attitude", "angles", "times", "momentum"].map(|key| found.array(&run[key]));
        let points = times.len();
        let near = |value: f64, expected: f64, scale: f64, what: &str| {
            assert!((value - expected).abs() < 1e-5 * scale, "{what} of {row}: {value} for {expected}");
        };
        for k in 0..3 {
            near(omega[3 * (points - 1) + k], rates[k][row], 40.0, "rate");
        }
        for k in 0..4 {
            near(attitude[4 * (points - 1) + k], attitudes[k][row], 1.0, "attitude");
        }
        for (wheel, rate) in wheels.iter().enumerate() {
            let [before, after] = [points - 2, points - 1].map(|point| angles[2 * point + wheel]);
            let step = times[points - 1] - times[points - 2];
            let turned = core::f64::consts::TAU;
            let expected = (rate[row] * step).rem_euclid(turned);
            let moved = (after - before).rem_euclid(turned);
            let off = (moved - expected).abs();
            assert!(off.min(turned - off) < 0.02, "wheel {wheel} of {row}: {moved} for {expected}");
        }
        for vector in h.chunks_exact(3) {
            let size = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
            near(size, momentum[0][row], momentum[0][row], "momentum");
        }
    }
}

/// Law: the matrix of correlations has Spearman's coefficients of the inputs, with their signs.
#[test]
fn correlations_have_their_signs() {
    let found = found("signs", &motion());
    let figure = found.figure("correlation_achieved");
    let names = figure["y"]["names"].as_array().unwrap().iter();
    let names: Vec<String> = names.map(|name| name.as_str().unwrap().to_owned()).collect();
    let column = |name: &String| dispersed(&found, &found.column_called(name));
    let columns: Vec<Vec<f64>> = names.iter().map(column).collect();
    assert_eq!(columns.len(), 3);
    let values = found.array(&figure["marks"][0]["values"]);
    let expected = (0..9).map(|k| spearman(&columns[k / 3], &columns[k % 3]));
    let mut negative = 0;
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-9, "{value} for {expected}");
        negative += usize::from(*value < 0.0);
    }
    assert!(negative > 0, "a sign to be seen");
}

/// Law: each input that is named as a driver has the direction of its rank correlation with the outcome.
#[test]
fn every_named_driver_has_its_direction() {
    let text = motion().replace(
        "omega_se_s_z_final_rad_s / angular_rate_final_rad_s",
        "initial.angular_velocity_rad_s.y - 0.3 * initial.angular_velocity_rad_s.z",
    );
    let found = found("directions", &text);
    let start = found.said.find("\n  drivers").unwrap();
    let said = &found.said[start..start + found.said[start..].find("\n\n").unwrap()];
    let mut seen = [0; 2];
    for line in said.lines().skip(1).filter(|line| line.contains("with it")) {
        let (outcome, drivers) = line.trim_start().split_once("  ").unwrap();
        let ordinates = if outcome == "spin ratio" {
            let [y, z] = ["y", "z"].map(|axis| dispersed(&found, &format!("initial_angular_velocity_{axis}_rad_s")));
            y.iter().zip(z).map(|(y, z)| y - 0.3 * z).collect()
        } else {
            dispersed(&found, &found.column_called(outcome))
        };
        for driver in drivers.split("), ").filter(|driver| driver.contains("with it")) {
            let (input, _) = driver.trim_start().split_once(" (").unwrap();
            let input = input
                .split_once("% [")
                .map_or(input, |(before, _)| before.rsplit_once(' ').unwrap().0.trim_end_matches(" explains"));
            let rises = spearman(&dispersed(&found, &found.column_called(input)), &ordinates) > 0.0;
            assert!(driver.contains(if rises { "rises with it" } else { "falls with it" }), "{line}");
            seen[usize::from(rises)] += 1;
        }
    }
    assert!(seen[0] > 0 && seen[1] > 0, "both directions: {said}");
}

/// Law: the dominant frequency is at the largest amplitude, within a bin, and that of the nominal row.
#[test]
fn the_dominant_frequency_is_that_of_the_peak() {
    let found = found(
        "peak",
        &motion().replace("duration_s = 1.0", "duration_s = 10.0").replace("points = 11", "points = 101"),
    );
    let curve = found.mark("energy_spectrum", "amplitude");
    let [x, y] = ["x", "y"].map(|key| found.array(&curve[key]));
    let top = (0..y.len()).max_by(|a, b| y[*a].total_cmp(&y[*b])).unwrap();
    let marks = found.figure("energy_spectrum")["marks"].as_array().unwrap();
    let limit = marks.iter().find(|mark| mark["kind"] == "limit").unwrap();
    let at = limit["at"].as_f64().unwrap();
    let of_row = found.all(&["exchange_frequency_hz"])[0][0];
    for expected in [x[top], of_row] {
        assert!((at - expected).abs() <= x[1] - x[0], "{at} for {expected}");
    }
    let said = limit["label"].as_str().unwrap().trim_start_matches("dominant: ").trim_end_matches(" Hz");
    assert!((said.parse::<f64>().unwrap() / at - 1.0).abs() < 1e-3, "{said} for {at}");
}

/// Law: the energy of a body over time reaches the largest value of its row, within its points.
#[test]
fn energies_are_of_their_bodies() {
    let found = found("energies", &crate::small_campaign::sized(60));
    for body in ["body", "w1", "w2"] {
        let largest = found.all(&[&format!("energy_{body}_max_j")])[0][0];
        let curve = found.array(&found.mark(&format!("energy_{body}_j"), "nominal run")["y"]);
        let top = curve.into_iter().fold(0.0, f64::max);
        assert!(top >= largest * (1.0 - 1e-6) && top < 1.05 * largest, "{body}: {top} for {largest}");
        let title = found.figure(&format!("energy_{body}_j"))["title"].as_str().unwrap().to_owned();
        assert!(title.ends_with(&format!(" {body}")), "{title} of energy_{body}_j");
    }
}
