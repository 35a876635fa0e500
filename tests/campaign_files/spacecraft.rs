use crate::prelude::*;

/// By mass and tensor, one wheel, a thruster with an alignment error, a spin in degrees per second.
pub const NEWCOMER: &str = r#"[campaign]
name = "first"
samples = 8
seed = 1
duration_s = "20 min"
[body]
mass_kg = 500
inertia_kg_m2 = [[120, -3, 1], [-3, 150, 2], [1, 2, 90]]
includes_wheels = false
[[wheels]]
name = "w1"
axis = [0, 1, 0]
mass_kg = 53
axial_inertia_kg_m2 = 1.66
transverse_inertia_kg_m2 = 0.87
rate_rad_s = "3000 rpm"
[[thrusters]]
name = "p1"
position_m = [0, 0, -1]
direction = [0, 0, 1]
tilt_rad = ["0.5 deg", 0]
[initial]
angular_velocity_rad_s = [0, 0, "5 deg/s"]
"#;

fn read(text: &str) -> Result<Plan, CampaignError> {
    parsed(text)
}

fn plan(text: &str) -> Plan {
    read(text).unwrap()
}

fn changed(from: &str, to: &str) -> String {
    assert!(NEWCOMER.contains(from), "{from}");
    NEWCOMER.replacen(from, to, 1)
}

#[test]
fn the_newcomers_spacecraft_takes_25_lines_and_runs() {
    assert!(NEWCOMER.lines().count() <= 25, "{} lines", NEWCOMER.lines().count());
    let plan = plan(NEWCOMER);
    let run = single(&plan, 0);
    assert_eq!(run.outcome.status, Status::Done);
    // measured: 3.6e-16 and 1.2e-14
    for (name, bound) in [("energy_error_max", 3e-15), ("angular_momentum_error_max", 1e-13)] {
        assert!(value(&run, name) < bound, "{name}: {:e}", value(&run, name));
    }
    // half of 1.66 kg m^2 times (100 pi rad/s)^2, and little more from the rotation of the body; measured: 4.0e-8
    let energy = value(&run, "energy_w1_initial_j");
    assert!((energy / (0.5 * 1.66 * (100.0 * std::f64::consts::PI).powi(2)) - 1.0).abs() < 4e-7, "{energy}");
    let columns = run.request.columns();
    let names: Vec<&str> = columns.iter().map(|column| column.quantity.name()).collect();
    assert!(names.contains(&"exchange_w1_peak_to_peak_j") && !names.iter().any(|name| name.contains("_w2_")));
    assert!(!names.iter().any(|name| name.contains("_wheels_")), "one wheel is all wheels together");
}

#[test]
fn names_are_lower_case_letters_digits_and_underscores_and_unique() {
    for name in ["a", "w1", "wheel_1", "x23456789012345678901_3"] {
        let plan = plan(&changed("\"w1\"", &format!("{name:?}")));
        assert_eq!(plan.nominal.wheels[0].name.as_str(), name);
        plan_of_thruster(name);
    }
    let lists = [("\"w1\"", "wheels"), ("\"p1\"", "thrusters")];
    for name in ["", "1w", "_w", "W1", "w-1", "w 1", "w.1", "räder", "a23456789012345678901234"] {
        for (written, list) in lists {
            let error = read(&changed(written, &format!("{name:?}"))).expect_err(name);
            assert_eq!(error.problems.len(), 1, "{error}");
            let problem = &error.problems[0];
            assert_eq!(
                (problem.key.as_str(), problem.value.as_deref()),
                (&*format!("{list}[0].name"), Some(&*format!("{name:?}")))
            );
            assert!(problem.allowed.contains("lower-case letters, digits and underscores"), "{problem}");
        }
    }
    let part = |name: &str| format!("[[body.parts]]\nname = {name:?}\nshape = \"point_mass\"\nmass_kg = 1\n");
    let twice = |first: &str, second: &str| {
        let parts = NEWCOMER.find("[body]").unwrap()..NEWCOMER.find("[[wheels]]").unwrap();
        let mut text = NEWCOMER.to_owned();
        text.replace_range(
            parts,
            &format!(
                "[body]\ninertia_scale = 1\n{}{}[[body.parts]]\nname = \"box\"\nshape = \
            \"box\"\nsize_m = [1, 1, 1]\nmass_kg = 9\n",
                part(first),
                part(second)
            ),
        );
        read(&text)
    };
    assert!(twice("tip", "top").is_ok());
    let error = twice("tip", "tip").expect_err("two parts of one name");
    assert!(error.to_string().contains("must be another name than that of the other [[body.parts]] tables"), "{error}");
    plan(&changed("\"w1\"", "\"p1\""));
}

fn plan_of_thruster(name: &str) {
    assert_eq!(plan(&changed("\"p1\"", &format!("{name:?}"))).nominal.thrusters[0].name.as_str(), name);
}

#[test]
fn units_hold_in_distributions_and_schedules() {
    let more = "[[actuation]]\nstart_s = 0\nend_s = \"500 ms\"\nthrust_n = { p1 = \"2 mN\" }\ntorque_n_m = { w1 = \"-5 \
        mN m\" }\n\
        [[disperse]]\nparameter = \"wheels.w1.rate_rad_s\"\ndistribution = \"normal\"\nstd = \"60 rpm\"\n\
        [[disperse]]\nparameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\nstd_rad = \"1 deg\"\n\
        [[disperse]]\nparameter = \"body.mass_kg\"\ndistribution = \"truncated_normal\"\nrelative_std = \"2 %\"\nlower \
        = \"0.4 t\"\n";
    let plan = plan(&format!("{NEWCOMER}{more}"));
    let arc = plan.nominal.actuation[0];
    assert_eq!((arc.end_s, arc.thrust_n[0], arc.torque_n_m[0]), (0.5, 0.002, -0.005));
    let pi = std::f64::consts::PI;
    let plain = more.replace("\"500 ms\"", "0.5").replace("\"2 mN\"", "0.002").replace("\"-5 mN m\"", "-0.005");
    let plain = plain.replace("\"60 rpm\"", &format!("{:?}", 60.0 * pi / 30.0));
    let plain =
        plain.replace("\"1 deg\"", &format!("{:?}", pi / 180.0)).replace("\"2 %\"", "0.02").replace("\"0.4 t\"", "400");
    let plain = self::plan(&format!("{NEWCOMER}{plain}"));
    assert_eq!((plain.row_text(), &plain.nominal), (plan.row_text(), &plan.nominal));
}
