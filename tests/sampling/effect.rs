//! What may be dispersed: parameters that act on a run. What acts and is not seen by a requested column is told.

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::influence::without_effect;
use spindrift::math::Isa;

use crate::support::campaigns::{FUSELAGE, THRUSTERS, WHEEL1_AT_REST};

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

/// The plan of a campaign with one wheel and three thrusters, and what `text` adds.
fn plan(text: &str) -> Result<Plan, String> {
    plan_over(1.0, text)
}

/// The same over `duration_s`.
pub fn plan_over(duration_s: f64, text: &str) -> Result<Plan, String> {
    let head = HEAD.replace("DURATION", &format!("{duration_s:?}"));
    let scene = [&head, FUSELAGE, WHEEL1_AT_REST, &THRUSTERS.concat(), INITIAL].concat();
    Plan::from_text("test.toml", &format!("{scene}{text}"), Overrides::default()).map_err(|error| error.to_string())
}

/// The lines that disperse a parameter.
pub fn dispersed(parameter: &str) -> String {
    format!("[[disperse]]\nparameter = {parameter:?}\ndistribution = \"uniform\"\nhalf_width = 0.01\n")
}

fn arc(start: f64) -> String {
    format!(
        "[[actuation]]\nstart_s = {start:?}\nend_s = {:?}\nthrust_n = {{ p1 = 10, p3 = 5 }}\ntorque_n_m = {{ w1 = 1 }}\n",
        start + 1.0
    )
}

#[test]
fn what_acts_after_the_end_only_is_refused() {
    for parameter in ["thrusters.p3.thrust_scale", "wheels.w1.torque_scale", "actuators.switch_on_delay_s"] {
        let refused = plan(&format!("{}{}", arc(1.01), dispersed(parameter))).expect_err(parameter);
        assert!(refused.contains("disperse[0].parameter") && refused.contains("start later"), "{refused}");
        plan(&format!("{}{}", arc(0.999), dispersed(parameter))).expect("an arc within the run");
        plan(&format!("{}{}{}", arc(0.5), arc(1.5), dispersed(parameter))).expect("one of two arcs within the run");
    }
}

/// Law: a delay of arcs that command nothing is refused, with what it would act on.
#[test]
fn a_delay_of_no_command_is_refused() {
    let delay = dispersed("actuators.switch_on_delay_s");
    let zero = arc(0.0).replace("p1 = 10, p3 = 5", "p1 = 0.0").replace("w1 = 1", "w1 = 0.0");
    for arcs in [String::new(), zero] {
        let refused = plan(&format!("{arcs}{delay}")).expect_err("nothing is switched");
        assert!(
            refused.contains("let an arc of [[actuation]] command a thrust or a torque that is not zero"),
            "{refused}"
        );
    }
}

/// Law: a delay that is dispersed counts with its earliest draw: what some draw moves into the run has an effect.
#[test]
fn arcs_count_with_their_earliest_start_and_end() {
    let (early, scale) = (dispersed("actuators.switch_on_delay_s"), dispersed("thrusters.p3.thrust_scale"));
    // half_width 0.01: the earliest start is 0.99 or 1.001
    plan(&format!("{}{early}{scale}", arc(1.0))).expect("starts within the run in some draws");
    let refused = plan(&format!("{}{early}{scale}", arc(1.011))).expect_err("starts after the end in all draws");
    assert_eq!(refused.matches("start later, in every draw").count(), 2, "{refused}");
    // arc(start) ends a second later
    for parameter in ["actuators.switch_off_delay_s", "actuation.0.switch_off_delay_s"] {
        let off = dispersed(parameter);
        plan(&format!("{}{off}", arc(0.0))).expect("ends within the run in some draws");
        let refused = plan(&format!("{}{off}", arc(0.011))).expect_err("ends after the end in all draws");
        assert!(refused.contains("disperse[0].parameter") && refused.contains("end later, in every draw"), "{refused}");
        // together, two delays are early enough
        let other = dispersed(if parameter.starts_with("actuators") {
            "actuation.0.switch_off_delay_s"
        } else {
            "actuators.switch_off_delay_s"
        });
        plan(&format!("{}{off}{other}", arc(0.011))).expect("ends within the run where both delays are small");
    }
    // an arc that acts in the nominal scene, and in no draw, has an effect
    let pushed = dispersed("actuators.switch_on_delay_s").replace("half_width = 0.01", "min = 0.6\nmax = 0.7");
    plan(&format!("{}{pushed}", arc(0.5))).expect("moved after the end");
    let unbounded = dispersed("actuators.switch_off_delay_s").replace("uniform", "normal").replace("half_width", "std");
    plan(&format!("{}{unbounded}", arc(0.07))).expect("seven standard deviations are drawn");
    plan(&format!("{}{unbounded}", arc(0.09))).expect_err("nine are not");
}

/// Keys to add, each after a place in the text of a scene, and the parameters to disperse.
type Case<'a> = (&'a [(&'a str, &'a str)], &'a [&'a str]);

/// Law: what a scale of zero takes away in every draw is not dispersed; a scale that is dispersed itself, or a bias, leaves something.
#[test]
fn what_a_scale_of_zero_takes_away_is_refused() {
    let with = |keys: &[(&str, &str)], parameters: &[&str]| {
        let head = HEAD.replace("DURATION", "1.0");
        let mut scene = [&head, FUSELAGE, WHEEL1_AT_REST, &THRUSTERS.concat(), INITIAL, &arc(0.0)].concat();
        for (place, key) in keys {
            assert_eq!(scene.matches(place).count(), 1, "{place}");
            scene = scene.replace(place, &format!("{place}\n{key}"));
        }
        let tables: String = parameters.iter().map(|parameter| dispersed(parameter)).collect();
        Plan::from_text("test.toml", &(scene + &tables), Overrides::default()).map(|_| ()).map_err(|e| e.to_string())
    };
    let (p3, w1, arc) = ("name = \"p3\"", "name = \"w1\"", "torque_n_m = { w1 = 1 }");
    let no_thrust = "thrust_scale = 0.0";
    let no_torque = "torque_scale = 0.0";
    let refused: &[Case<'_>] = &[
        (&[(p3, no_thrust)], &["thrusters.p3.tilt_rad[0]"]),
        (&[(p3, no_thrust)], &["thrusters.p3.position_m"]),
        (&[(arc, no_thrust)], &["thrusters.p3.thrust_scale"]),
        (&[(arc, no_thrust), (arc, no_torque)], &["actuators.switch_on_delay_s"]),
        (&[(w1, no_torque)], &["actuation.0.torque_scale"]),
        (&[(w1, "torque_scale = 0.0\ntorque_bias_n_m = 0.1")], &["actuation.0.torque_scale"]),
        (&[(arc, no_torque)], &["wheels.w1.torque_bias_n_m"]),
    ];
    for (keys, parameters) in refused {
        let refused = with(keys, parameters).expect_err(parameters[0]);
        let said = refused.contains("disperse[0].parameter") && refused.contains("a scale of 0 takes away");
        assert!(said, "{keys:?} {parameters:?}: {refused}");
    }
    let accepted: &[Case<'_>] = &[
        (&[(p3, no_thrust)], &["thrusters.p3.thrust_scale", "thrusters.p3.tilt_rad[0]"]),
        (&[(p3, no_thrust)], &["thrusters.p1.tilt_rad[0]", "actuators.switch_on_delay_s", "actuation.0.thrust_scale"]),
        (&[(arc, no_thrust)], &["thrusters.p3.thrust_scale", "actuation.0.thrust_scale"]),
        (&[(arc, no_thrust)], &["actuators.switch_on_delay_s"]),
        (&[(w1, no_torque)], &["wheels.w1.torque_bias_n_m"]),
        (&[(w1, no_torque)], &["wheels.w1.torque_scale", "actuation.0.torque_scale"]),
    ];
    for (keys, parameters) in accepted {
        with(keys, parameters).unwrap_or_else(|error| panic!("{keys:?} {parameters:?}: {error}"));
    }
}

/// Law: a delay that leaves the start of its arcs at that of the run in every draw is refused.
#[test]
fn a_delay_before_the_start_is_refused() {
    let delay = |min: f64, max: f64| {
        dispersed("actuators.switch_on_delay_s").replace("half_width = 0.01", &format!("min = {min:?}\nmax = {max:?}"))
    };
    let refused = plan(&format!("{}{}", arc(0.0), delay(-0.2, 0.0))).expect_err("never after the start");
    assert!(refused.contains("start with the run, in every draw"), "{refused}");
    plan(&format!("{}{}", arc(0.0), delay(-0.2, 0.01))).expect("late in some draws");
    plan(&format!("{}{}", arc(0.1), delay(-0.2, -0.05))).expect("early in some draws");
    plan(&format!("{}{}", arc(0.1), delay(-0.3, -0.2))).expect("late in the nominal scene");
    plan(&format!("{}{}{}", arc(0.0), arc(1.0), delay(-0.2, -0.1))).expect("another arc starts within the run");
    plan(&format!("{}{}{}", arc(0.0), arc(1.5), delay(-0.2, -0.1))).expect_err("another arc starts after it");
    let of_arc = |index: usize| delay(-0.2, -0.1).replace("actuators", &format!("actuation.{index}"));
    plan(&format!("{}{}{}", arc(0.0), arc(1.0), of_arc(0))).expect_err("of the first arc");
    plan(&format!("{}{}{}", arc(0.0), arc(1.0), of_arc(1))).expect("of the second arc");
}

/// Law: a design with one level of a parameter, which is its nominal value, is refused; another level is a value of its own.
#[test]
fn one_level_that_is_nominal_is_refused() {
    let radius = dispersed("wheels.w1.radius_m");
    let moved = radius.replace("half_width = 0.01", "min = 0.2\nmax = 0.4");
    let rates = dispersed("initial.angular_velocity_rad_s").replace("uniform", "normal").replace("half_width", "std");
    let head = HEAD.replace("DURATION", "1.0").replace("samples = 9\n", "");
    let with = |design: &str, tables: &[&str]| {
        let text = [&head, FUSELAGE, WHEEL1_AT_REST, INITIAL, "[design]\n", design, "\n"].concat() + &tables.concat();
        Plan::from_text("test.toml", &text, Overrides::default()).map(|_| ()).map_err(|error| error.to_string())
    };
    for kind in ["grid", "one_at_a_time"] {
        let with = |levels: &str, tables: &[&str]| with(&format!("kind = {kind:?}\n{levels}"), tables);
        for (levels, tables) in [
            ("levels = 1", &[&radius[..]][..]),
            ("levels = [3, 1, 3, 1]", &[&rates, &radius]),
            ("quantiles = [0.5]", &[&radius]),
            ("quantiles = [0.5, 0.5]", &[&radius]),
        ] {
            let refused = with(levels, tables).expect_err(levels);
            assert!(refused.contains("design.kind") && refused.contains("which is its nominal value"), "{refused}");
        }
        with("levels = 1", &[&moved]).expect("another value than the nominal one");
        with("quantiles = [0.25]", &[&radius]).expect("another value than the nominal one");
        with("levels = 2", &[&radius, &rates]).expect("two levels");
        with("levels = [1, 3, 1]", &[&rates]).expect("a component of the vector has levels");
    }
}

/// Law: what changes the length of an attitude or a direction alone changes nothing, and is refused.
#[test]
fn a_length_without_effect_is_refused() {
    let normal = |parameter: &str, keys: &str| {
        format!("[[disperse]]\nparameter = {parameter:?}\ndistribution = \"normal\"\n{keys}\n")
    };
    let (w, x) = (normal("initial.attitude.w", "std = 0.01"), normal("initial.attitude.x", "std = 0.01"));
    // p1 pushes along s3
    let along = |spread: &str| arc(0.0) + &normal("thrusters.p1.direction", spread);
    let z = arc(0.0) + &dispersed("thrusters.p1.direction.z");
    for text in [&w, &z, &along("std = [0, 0, 0.01]"), &along("relative_std = [0.01, 0.01, 0.01]")] {
        let refused = plan(text).expect_err(text);
        assert!(
            refused.contains("disperse[0].parameter") && refused.contains("the other components are 0"),
            "{refused}"
        );
    }
    let turned = z.replace("half_width = 0.01", "min = -1.0\nmax = -0.5");
    for text in [&(w + &x), &x, &along("std = [0, 0.01, 0.01]"), &turned] {
        plan(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    }
}

/// Law: a file of samples that has the nominal value in every row is refused.
#[test]
fn rows_that_are_nominal_are_refused() {
    let scratch = crate::support::scratch_folder::ScratchFolder::new("nominal-rows");
    let head = HEAD.replace("DURATION", "1.0").replace("samples = 9\n", "");
    let design = "[design]\nkind = \"table\"\nfile = \"rows.csv\"\nparameters = [\"wheels.w1.radius_m\"]\n";
    let text = [&head, FUSELAGE, WHEEL1_AT_REST, INITIAL, design].concat();
    let with = |rows: &str| {
        std::fs::write(scratch.0.join("rows.csv"), rows).unwrap();
        Plan::from_text_in(&scratch.0, "test.toml", &text, Overrides::default()).map(|_| ()).map_err(|e| e.to_string())
    };
    with("wheels.w1.radius_m\n0.25\n0.26\n").expect("another value");
    let refused = with("wheels.w1.radius_m\n0.25\n0.25\n").expect_err("nominal rows");
    assert!(refused.contains("design.kind") && refused.contains("other than the nominal one"), "{refused}");
}

/// Law: samples without dispersions are told to be all the same.
#[test]
fn samples_without_dispersions_are_told() {
    assert!(plan("").expect("legal").notes().iter().any(|note| note.contains("all 9 samples are the nominal scene")));
    let notes = plan(&dispersed("wheels.w1.radius_m")).expect("legal").notes();
    assert!(notes.iter().all(|note| !note.contains("nothing is dispersed")), "{notes:?}");
}

/// Law: a component whose spread is 0, or relative to 0, is told; those that vary are not.
#[test]
fn a_component_that_never_varies_is_told() {
    let notes = |spread: &str| {
        let table = "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\n";
        let plan = plan(&format!("{table}{spread}\n")).unwrap_or_else(|error| panic!("{error}"));
        plan.notes().into_iter().filter(|note| note.contains("never varied")).collect::<Vec<_>>()
    };
    // the nominal value of x is 0
    let relative = notes("relative_std = 0.1");
    assert!(
        relative.len() == 1 && relative[0].starts_with("initial.angular_velocity_rad_s.x is never"),
        "{relative:?}"
    );
    assert_eq!(notes("std = [0.1, 0, 0]").len(), 1);
    assert!(notes("std = 0.1").is_empty());
}

/// Law: commands that act in no draw within the run have no columns: after its end, or with a scale of zero; those of some draws have.
#[test]
fn columns_are_of_commands_that_act() {
    let thrust = |text: &str| {
        let plan = plan(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        plan.request().actuated.thrusters
    };
    let zero = |start: f64| arc(start) + "thrust_scale = 0.0\n";
    assert!(thrust(&arc(0.5)) && !thrust(&arc(1.0)) && !thrust(&zero(0.5)));
    assert!(thrust(
        &(zero(0.5) + &dispersed("actuation.0.thrust_scale").replace("half_width = 0.01", "min = 0\nmax = 1"))
    ));
    assert!(thrust(&(arc(1.005) + &dispersed("actuators.switch_on_delay_s"))), "early in some draws");
    assert!(plan(&arc(1.0)).expect("legal").request_over(1.5).actuated.thrusters, "in a longer run");
}

/// Law: a dispersion that gives the nominal value in every draw is refused, one that gives another value in every draw is not.
#[test]
fn a_distribution_without_width_is_refused() {
    let table = |parameter: &str, keys: &str| plan(&format!("[[disperse]]\nparameter = {parameter:?}\n{keys}\n"));
    let (radius, rates, attitude) = ("wheels.w1.radius_m", "initial.angular_velocity_rad_s", "initial.attitude");
    for (parameter, keys) in [
        (radius, "distribution = \"uniform\"\nhalf_width = 0"),
        (radius, "distribution = \"uniform\"\nrelative_half_width = 0"),
        (radius, "distribution = \"normal\"\nstd = 0"),
        (radius, "distribution = \"normal\"\nstd = 1e-30"),
        (radius, "distribution = \"choice\"\nvalues = [0.25, 0.25]"),
        (rates, "distribution = \"normal\"\nrelative_std = 0"),
        (rates, "distribution = \"normal\"\nstd = [0, 0, 0]"),
        (attitude, "distribution = \"attitude_error\"\nstd_rad = 0"),
        (
            attitude,
            "distribution = \"about_axis\"\naxis = [0, 0, 1]\nangle_rad = { distribution = \"normal\", std = 0 }",
        ),
    ] {
        let refused = table(parameter, keys).expect_err(keys);
        assert!(refused.contains("disperse[0].distribution") && refused.contains("every draw is"), "{keys}: {refused}");
    }
    for (parameter, keys) in [
        (radius, "distribution = \"uniform\"\nhalf_width = 1e-9"),
        (radius, "distribution = \"choice\"\nvalues = [0.3, 0.3]"),
        (rates, "distribution = \"normal\"\nstd = [0, 0, 1e-3]"),
        (attitude, "distribution = \"attitude_error\"\nstd_rad = [0, 1e-6, 0]"),
    ] {
        table(parameter, keys).unwrap_or_else(|error| panic!("{keys}: {error}"));
    }
}

/// Law: where no requested column says how accurate a run is, a note says so; one group that does is enough.
#[test]
fn what_cannot_be_judged_is_told() {
    let noted = |groups: &str| {
        let head = HEAD.replace("DURATION", "1.0").replace("[\"energy_conservation\"]", groups);
        let text = [&head, FUSELAGE, WHEEL1_AT_REST, INITIAL].concat();
        let plan = Plan::from_text("test.toml", &text, Overrides::default()).expect("legal");
        plan.notes().iter().any(|note| note.contains("none can end as inaccurate"))
    };
    for groups in ["[\"final_state\"]", "[\"motion\", \"exchange\"]", "[\"effort\", \"energies\"]"] {
        assert!(noted(groups), "{groups}");
    }
    for groups in ["[\"numerics\"]", "[\"motion\", \"momentum_conservation\"]", "[\"energy_conservation\"]"] {
        assert!(!noted(groups), "{groups}");
    }
}

/// A scale of a thruster that is never fired has no effect of its own; where a derived parameter is made of it, it has.
#[test]
fn inputs_of_derived_parameters_count_as_used() {
    let scale = "thrusters.p2.thrust_scale";
    let refused = plan(&format!("{}{}", arc(0.0), dispersed(scale))).expect_err("never fired");
    assert!(refused.contains("a key that the scene has"), "{refused}");
    let derived = format!(
        "{}{}[[derive]]\nparameter = \"wheels.w1.radius_m\"\nexpression = \"0.25 * thrusters.p2.thrust_scale\"\n",
        arc(0.0),
        dispersed(scale)
    );
    let plan = plan(&derived).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(without_effect(&plan, Isa::best()), Some(Vec::new()));
}

#[test]
fn what_no_requested_column_shows_is_told() {
    let names = |text: &str| -> Vec<String> {
        let plan = plan(text).unwrap_or_else(|error| panic!("{error}"));
        without_effect(&plan, Isa::best()).expect("short runs")
    };
    let both = format!("{}{}", dispersed("initial.position_m"), dispersed("initial.angular_velocity_rad_s"));
    assert_eq!(names(&both), ["initial.position_m"]);
    let used = "[[derive]]\nparameter = \"wheels.w1.length_m\"\nexpression = \"0.1 + 0.1 * initial.position_m.x\"\n";
    assert!(names(&format!("{both}{used}")).is_empty());
    assert_eq!(names(&dispersed("initial.position_m.z")), ["initial.position_m.z"]);
    // a value that is seldom drawn is found; what no draw changes, or only to what is not physical, is not called without effect
    let seldom = "[[disperse]]\nparameter = \"wheels.w1.radius_m\"\ndistribution = \"bernoulli\"\nvalue = 0.3\nprobability = 0.2\n";
    assert!(names(seldom).is_empty());
    assert!(names(&seldom.replace("0.2", "1e-9")).is_empty());
    assert!(names(&seldom.replace("0.3", "-1.0").replace("0.2", "0.9")).is_empty());
    // what has an effect in some draws alone: an end that most draws have after the run, a tilt under a scale that is mostly 0
    let off = dispersed("actuators.switch_off_delay_s").replace("half_width = 0.01", "half_width = 0.5");
    assert!(names(&format!("{}{off}", arc(0.3))).is_empty());
    let scale = seldom.replace("wheels.w1.radius_m", "actuation.0.thrust_scale").replace("0.3", "1.0");
    let tilt = dispersed("thrusters.p3.tilt_rad[0]");
    assert!(names(&format!("{}thrust_scale = 0.0\n{scale}{tilt}", arc(0.0))).is_empty());
    let unseen = seldom.replace("wheels.w1.radius_m", "initial.position_m.x");
    assert_eq!(names(&unseen), ["initial.position_m.x"]);
}
