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
        let refused = plan(&format!("{}{}", arc(1.0), dispersed(parameter))).expect_err(parameter);
        assert!(refused.contains("disperse[0].parameter") && refused.contains("start later"), "{refused}");
        plan(&format!("{}{}", arc(0.999), dispersed(parameter))).expect("an arc within the run");
        plan(&format!("{}{}{}", arc(0.5), arc(1.5), dispersed(parameter))).expect("one of two arcs within the run");
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
        without_effect(&plan, Isa::best()).expect("short runs").iter().map(|parameter| parameter.name()).collect()
    };
    let both = format!("{}{}", dispersed("initial.position_m"), dispersed("initial.angular_velocity_rad_s"));
    assert_eq!(names(&both), ["initial.position_m"]);
    let used = "[[derive]]\nparameter = \"wheels.w1.length_m\"\nexpression = \"0.1 + 0.1 * initial.position_m.x\"\n";
    assert!(names(&format!("{both}{used}")).is_empty());
}
