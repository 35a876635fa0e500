//! What a campaign says drives its outcomes, on the screen, on the cards and in the charts, against its rows.

use crate::prelude::*;

/// Law: where a thruster is dead in a few runs and these miss a limit, screen, card and chart name it first.
#[test]
fn a_dead_thruster_is_named() {
    const SCALE: &str = "parameter = \"thrusters.p2.thrust_scale\"\ndistribution = \"normal\"\nstd = 0.03";
    let dead =
        "parameter = \"thrusters.p2.thrust_scale\"\ndistribution = \"bernoulli\"\nvalue = 0.0\nprobability = 0.04";
    assert!(DETUMBLE.contains(SCALE));
    // what the same runs miss is said of both, and drawn once; a number that is noise has no driver
    let twice = "\n[[observable]]\nname = \"twice\"\nunit = \"s\"\nexpression = \"2 * phase_rest_begin_s\"\n\
                 [[require]]\nobservable = \"twice\"\nfraction = 0.95\nat_most = 128\n";
    let text = DETUMBLE.replace(SCALE, dead).replace("samples = 1024", "samples = 400");
    let found = found("dead", &(text.replace("\"5 min\"", "\"64 s\"") + twice));
    let rows = found.scratch.rows("r");
    let [scale, began] = ["thrusters_p2_thrust_scale", "phase_rest_begin_s"].map(|name| column(&rows, name));
    let runs = |value: f64| (1..400).filter(|row| scale[*row] == value).collect::<Vec<_>>();
    let missed = |rows: &[usize]| rows.iter().filter(|row| began[**row].is_nan() || began[**row] > 64.0).count();
    let [dead, alive] = [0.0, 1.0].map(runs);
    let counts = [missed(&dead), dead.len(), missed(&alive), alive.len()];
    assert!(counts[0] >= 4 && counts[2] < 4, "{counts:?}");
    let [a, m, b, n] = counts;
    let words =
        format!("thruster p2 thrust scale = 0: {a} of {m} miss the limit; = 1: {b} of {n} miss the limit (risk ratio");
    let is_said = |line: &str| line.trim_start().starts_with("time until phase rest") && line.contains(&words);
    assert!(found.said.lines().any(is_said), "{words}: {}", found.said);
    assert!(found.visible().contains(&words[1..]));
    // four events give no shares of a variance: the picture has the share of the runs by the levels of the driver
    let chart = found.figure("shares_phase_rest_begin_s_thrusters_p2_thrust_scale");
    assert!(chart["title"].as_str().unwrap().contains("thruster p2 thrust scale"), "{chart}");
    let names: Vec<&str> = found.figures().iter().filter_map(|figure| figure["name"].as_str()).collect();
    assert!(!names.contains(&"influence_twice_event") && names.contains(&"influence_propellant_kg"), "{names:?}");
    let is_said = |line: &str| {
        line.trim_start().starts_with("propellant")
            && line.contains("initial angular velocity x")
            && line.contains("not monotonic")
    };
    assert!(found.said.lines().any(is_said), "{}", found.said);
}
