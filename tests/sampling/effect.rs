//! What may be dispersed: parameters that act on a run. What acts and is not seen by a requested column is told.

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::influence::without_effect;
use spindrift::math::Isa;

const SCENE: &str = "[campaign]\nname = \"test\"\nsamples = 9\nseed = 1\nduration_s = 1.0\n[observe]\npoints = 11\n\
    groups = [\"energy_conservation\"]\n[fuselage]\nwall_thickness_m = 0.03\nouter_radius_m = 1.0\nlength_m = 3.0\n\
    density_kg_m3 = 2700.0\nthruster_offset_m = 0.5\n[wheel1]\nradius_m = 0.25\nlength_m = 0.1\nstation_m = 1.0\n\
    density_kg_m3 = 2700.0\n[initial]\nangular_velocity_rad_s = [0, 3, 31]\n";

fn plan(text: &str) -> Result<Plan, String> {
    Plan::from_text("test.toml", &format!("{SCENE}{text}"), Overrides::default()).map_err(|error| error.to_string())
}

fn dispersed(parameter: &str) -> String {
    format!("[[disperse]]\nparameter = {parameter:?}\ndistribution = \"uniform\"\nhalf_width = 0.01\n")
}

fn arc(start: f64) -> String {
    format!(
        "[[actuation]]\nstart_s = {start:?}\nend_s = {:?}\nthrust_n = [10, 0, 5]\ntorque_n_m = [1, 0]\n",
        start + 1.0
    )
}

#[test]
fn what_acts_after_the_end_only_is_refused() {
    for parameter in ["actuators.thrust_scale", "actuators.torque_scale[0]", "actuators.switch_on_delay_s"] {
        let parameter = if parameter == "actuators.thrust_scale" { "actuators.thrust_scale[2]" } else { parameter };
        let refused = plan(&format!("{}{}", arc(1.0), dispersed(parameter))).expect_err(parameter);
        assert!(refused.contains("disperse[0].parameter") && refused.contains("start later"), "{refused}");
        plan(&format!("{}{}", arc(0.999), dispersed(parameter))).expect("an arc within the run");
        plan(&format!("{}{}{}", arc(0.5), arc(1.5), dispersed(parameter))).expect("one of two arcs within the run");
    }
}

/// A scale of a thruster that is never fired has no effect of its own; where a derived parameter is made of it, it has.
#[test]
fn inputs_of_derived_parameters_count_as_used() {
    let scale = "actuators.thrust_scale[1]";
    let refused = plan(&format!("{}{}", arc(0.0), dispersed(scale))).expect_err("never fired");
    assert!(refused.contains("a key that the scene has"), "{refused}");
    let derived = format!(
        "{}{}[[derive]]\nparameter = \"wheel1.radius_m\"\nexpression = \"0.25 * actuators.thrust_scale[1]\"\n",
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
    let used = "[[derive]]\nparameter = \"wheel1.length_m\"\nexpression = \"0.1 + 0.1 * initial.position_m.x\"\n";
    assert!(names(&format!("{both}{used}")).is_empty());
}
