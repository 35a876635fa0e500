//! Dispersion of every key that the scene has.

use crate::prelude::*;
use spindrift::ensemble::influence;

use crate::support::campaigns::THRUSTERS;

const HEAD: &str = r#"
[campaign]
name = "test"
samples = 9
seed = 1
duration_s = DURATION
[observe]
points = 11
groups = ["energy_conservation"]
"#;

const INITIAL: &str = "[initial]\nangular_velocity_rad_s = [0, 3, 31]\n";

fn plan(text: &str) -> Result<Plan, String> {
    plan_over(1.0, text)
}

pub fn plan_over(duration_s: f64, text: &str) -> Result<Plan, String> {
    let head = HEAD.replace("DURATION", &format!("{duration_s:?}"));
    let scene = [&head, FUSELAGE, WHEEL1_AT_REST, &THRUSTERS.concat(), INITIAL].concat();
    parsed(&format!("{scene}{text}")).map_err(|error| error.to_string())
}

pub fn dispersed(parameter: &str) -> String {
    with(parameter, "distribution = \"uniform\"\nhalf_width = 0.01")
}

fn with(parameter: &str, distribution: &str) -> String {
    format!("[[disperse]]\nparameter = {parameter:?}\n{distribution}\n")
}

fn arc(start: f64) -> String {
    format!(
        "[[actuation]]\nstart_s = {start:?}\nend_s = {:?}\nthrust_n = {{ p1 = 10, p3 = 5 }}\ntorque_n_m = {{ w1 = 1 \
        }}\n",
        start + 1.0
    )
}

fn notes(text: &str) -> Vec<String> {
    let plan = plan(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    influence::notes(&plan, Isa::best())
}

const UNSEEN: &str = "does not affect any requested column";
const CONSTANT: &str = "is never varied";

#[test]
fn what_changes_nothing_is_noted() {
    let (p2, p3, on) = ("thrusters.p2.thrust_scale", "thrusters.p3.thrust_scale", "actuators.switch_on_delay_s");
    let moved = |parameter: &str, ends: &str| with(parameter, &format!("distribution = \"uniform\"\n{ends}"));
    let late = moved(on, "min = -0.2\nmax = 0.0");
    let (radius, rates) = ("wheels.w1.radius_m", "initial.angular_velocity_rad_s");
    let seldom = |parameter: &str, keys: &str| with(parameter, &format!("distribution = \"bernoulli\"\n{keys}"));
    let no_thrust = arc(0.0) + "thrust_scale = 0.0\n";
    let density = "body.parts.fuselage.density_kg_m3";
    let cases = [
        (UNSEEN, p2, arc(0.0) + &dispersed(p2), arc(0.0) + &dispersed(p3)),
        (UNSEEN, p3, arc(1.01) + &dispersed(p3), arc(0.9) + &dispersed(p3)),
        (UNSEEN, on, dispersed(on), arc(0.5) + &dispersed(on)),
        (UNSEEN, on, arc(0.0) + &late, arc(0.1) + &late),
        (UNSEEN, p3, no_thrust.clone() + &dispersed(p3), arc(0.0) + &dispersed(p3)),
        (CONSTANT, "initial.attitude", dispersed("initial.attitude.w"), dispersed(radius)),
        (UNSEEN, "initial.position_m", dispersed("initial.position_m"), dispersed(rates)),
        (UNSEEN, "initial.position_m.z", dispersed("initial.position_m.z"), dispersed(density)),
        (
            UNSEEN,
            "initial.position_m.x",
            seldom("initial.position_m.x", "value = 0.3\nprobability = 0.2"),
            seldom(radius, "value = 0.3\nprobability = 0.2"),
        ),
        (
            CONSTANT,
            radius,
            with(radius, "distribution = \"normal\"\nstd = 0"),
            with(radius, "distribution = \"normal\"\nstd = 1e-6"),
        ),
        (
            CONSTANT,
            "initial.angular_velocity_rad_s.x",
            with(rates, "distribution = \"normal\"\nrelative_std = 0.1"),
            with(rates, "distribution = \"normal\"\nstd = 0.1"),
        ),
        (
            CONSTANT,
            radius,
            with(radius, "distribution = \"choice\"\nvalues = [0.25, 0.25]"),
            with(radius, "distribution = \"choice\"\nvalues = [0.25, 0.26]"),
        ),
    ];
    for (says, name, idle, acting) in cases {
        let found = notes(&idle);
        assert!(
            matches!(&found[..], [note] if note.starts_with(&format!("{name} ")) && note.contains(says)),
            "{idle}: {found:?}"
        );
        assert_eq!(notes(&acting), [""; 0], "{acting}");
    }
}

/// Law: what has an effect in some draws alone, through a derived parameter, or where other draws move it, has one.
#[test]
fn what_acts_in_some_draws_is_not_noted() {
    let tilt = dispersed("thrusters.p3.tilt_rad.1");
    let on = with("actuation.0.thrust_scale", "distribution = \"bernoulli\"\nvalue = 1.0\nprobability = 0.3");
    let derived = "[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"0.25 * thrusters.p2.thrust_scale\"\n";
    let off = with("actuators.switch_off_delay_s", "distribution = \"uniform\"\nhalf_width = 0.5");
    for text in [
        format!("{}thrust_scale = 0.0\n{on}{tilt}", arc(0.0)),
        format!("{}{}{derived}", arc(0.0), dispersed("thrusters.p2.thrust_scale")),
        format!("{}{off}", arc(0.3)),
        dispersed("initial.position_m") + "[[observable]]\nname = \"far\"\nexpression = \"2 * initial.position_m.x\"\n",
    ] {
        assert_eq!(notes(&text), [""; 0], "{text}");
    }
    let negative = with("wheels.w1.radius_m", "distribution = \"bernoulli\"\nvalue = -1.0\nprobability = 0.9");
    assert_eq!(notes(&negative), [""; 0]);
}

#[test]
fn columns_are_of_commands_that_act() {
    let thrust = |text: &str| plan(text).unwrap_or_else(|error| panic!("{text}: {error}")).request().actuated.thrusters;
    assert!(thrust(&arc(0.5)) && !thrust(&arc(1.0)));
    assert!(thrust(&(arc(1.005) + &dispersed("actuators.switch_on_delay_s"))), "early in some draws");
    assert!(plan(&arc(1.0)).unwrap().request_over(1.5).actuated.thrusters, "in a longer run");
}

#[test]
fn what_a_plan_alone_says_is_noted() {
    let has = |plan: Plan, says: &str| plan.notes().iter().any(|note| note.contains(says));
    let same = "all 9 samples are the nominal scene";
    assert!(has(plan("").unwrap(), same));
    assert!(!has(plan(&dispersed("wheels.w1.radius_m")).unwrap(), same));
    for (groups, is_blind) in [
        ("[\"motion\", \"exchange\"]", true),
        ("[\"effort\", \"energies\"]", true),
        ("[\"numerics\"]", false),
        ("[\"motion\", \"momentum_conservation\"]", false),
    ] {
        let head = HEAD.replace("DURATION", "1.0").replace("[\"energy_conservation\"]", groups);
        let text = [&head, FUSELAGE, WHEEL1_AT_REST, INITIAL].concat();
        let plan = planned(&text);
        assert_eq!(has(plan, "none can end as inaccurate"), is_blind, "{groups}");
    }
}
