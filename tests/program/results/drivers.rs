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

/// Law: where a limit is missed on both sides of the median of one input, or of two, it is these and no others that are
/// said to be farther from it.
#[test]
fn distances_from_medians_are_named() {
    let scratch = folder("distances");
    let [x, y] = ["x", "y - 3.14"].map(|input| format!("(initial.angular_velocity_rad_s.{input})^2"));
    let name = |axis: &str| format!("initial angular velocity {axis}");
    for (expression, words) in [
        (x.clone(), format!("{} is farther from its median in the runs", name("x"))),
        (x + " + " + &y, format!("{} and {} are farther from their medians in the runs", name("y"), name("x"))),
    ] {
        let asked = format!(
            "[[observable]]\nname = \"off\"\nexpression = \"{expression}\"\n\
             [[require]]\nobservable = \"off\"\nfraction = 0.5\nat_most = 0.7\n"
        );
        scratch.file("asked.toml", &(campaign_without_debris() + &asked));
        let said = scratch.prints_wide("campaign asked.toml --out r --overwrite --no-report", 0);
        assert_says(&said, [&format!(" limit: {words} that miss the limit")]);
    }
}

/// Law: where nothing is required, the drivers of three outcomes are on the screen, and the other outcomes are counted.
#[test]
fn three_outcomes_have_their_drivers_on_the_screen() {
    let scratch = folder("three-outcomes");
    let observable = |times: usize| {
        ["x", "y", "z"].map(|axis| {
            let expression = format!("{times} * initial.angular_velocity_rad_s.{axis}");
            format!("[[observable]]\nname = \"{axis}_{times}\"\nexpression = \"{expression}\"\n")
        })
    };
    let observables = [1, 2].map(observable).concat().concat();
    scratch.file("asked.toml", &(campaign_without_debris() + &observables));
    let said = scratch.prints_wide("campaign asked.toml --out r --no-report", 0);
    assert_eq!(said.matches("what drives ").count(), 3, "{said}");
    assert_says(&said, ["  and 3 more outcomes with drivers; --verbose shows all"]);
}

/// Law: beside an input with heavy tails, whose rare values the runs may lack, no share of another is bounded below.
#[test]
fn beside_tails_no_share_is_bounded_below() {
    let scratch = folder("beside-tails");
    let disperse = |axis: &str, kind: &str| {
        format!("[[disperse]]\nparameter = \"initial.angular_velocity_rad_s.{axis}\"\ndistribution = \"{kind}\n")
    };
    let lower = ["normal\"\nstd = 0.5", "log_normal\"\nlog_std = 2"].map(|kind| {
        let inputs = disperse("x", "normal\"\nstd = 0.5") + &disperse("y", kind);
        let twice = "[[observable]]\nname = \"twice\"\nexpression = \"2 * initial.angular_velocity_rad_s.x\"\n";
        scratch.file("asked.toml", &(campaign_without_debris().replace(SPIN_DISPERSION, "") + &inputs + twice));
        scratch.prints("campaign asked.toml --out r --overwrite --no-report", 0);
        let table = scratch.table("r/sensitivity.parquet");
        let [names, inputs] = ["observable", "input"].map(|name| texts(&table, name));
        let is_x = |row: &usize| names.value(*row) == "twice" && inputs.value(*row).contains("_x_");
        floats(&table, "first_order_lower")[(0..table.num_rows()).find(is_x).unwrap()]
    });
    assert!(lower[0] > 0.9 && lower[1] <= 0.0, "{lower:?}");
}
