//! Numbers that look like a mistake are noted, not refused: each with key, value, reason, and what is usual.

use std::path::Path;

use spindrift::campaign::{Overrides, Plan};

const HEAD: &str = "[campaign]\nname = \"x\"\nsamples = 200\nseed = 7\nduration_s = 60.0\n[observe]\npoints = 3\n";
/// Radius of gyration: 0.61 m.
const BY_MASS: &str = "[body]\nmass_kg = 300\ncenter_of_mass_m = [0, 0, 0.4]\ninertia_kg_m2 = [[60, 1, 0.5], [1, 75, 0.2], [0.5, 0.2, 90]]\nincludes_wheels = false\n";
const BY_PART: &str = "[[body.parts]]\nname = \"bus\"\nshape = \"box\"\nsize_m = [1, 1, 1]\nmass_kg = 100\n";
const BY_POINT: &str =
    "[[body.parts]]\nname = \"tip\"\nshape = \"point_mass\"\nmass_kg = 1\nposition_m = [0, 0, 0.6]\n";
/// Radius of gyration: 0.077 m.
const WHEEL: &str = "[[wheels]]\nname = \"rx\"\naxis = [1, 0, 0]\nposition_m = [0.2, 0, 0.3]\nmass_kg = 5\n\
    axial_inertia_kg_m2 = 0.03\ntransverse_inertia_kg_m2 = 0.02\nrate_rad_s = \"2000 rpm\"\n";
const DISC: &str = "[[wheels]]\nname = \"rz\"\naxis = [0, 0, 1]\nradius_m = 0.25\nlength_m = 0.1\ndensity_kg_m3 = 2700\nrate_rad_s = 100\n";
const THRUSTER: &str = "[[thrusters]]\nname = \"ta\"\nposition_m = [0.5, 0, 0]\ndirection = [0, 0, 1]\n";
const DEBRIS: &str = "[debris]\nsize_m = [0.3, 0.5, 0.9]\ndensity_kg_m3 = 500\n";
const INITIAL: &str = "[initial]\nangular_velocity_rad_s = [0.02, 0.1, 0.05]\n";
const AWAY: &str = "debris_position_m = [10, 5, 0]\n";
const ARC: &str = "[[actuation]]\nstart_s = 5.0\nend_s = 10.0\nthrust_n = { ta = 1.0 }\n";

fn disperse(parameter: &str, distribution: &str) -> String {
    format!("[[disperse]]\nparameter = \"{parameter}\"\n{distribution}\n")
}

fn notes(text: &str) -> Vec<String> {
    Plan::from_text("x.toml", text, Overrides::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
        .implausible()
}

/// The scene with everything, each number as usual.
fn usual(body: &str) -> String {
    let spread = disperse("initial.angular_velocity_rad_s", "distribution = \"normal\"\nstd = 0.01")
        + &disperse("wheels.rx.tilt_rad", "distribution = \"normal\"\nstd = \"0.1 deg\"")
        + &disperse("thrusters.ta.tilt_rad", "distribution = \"normal\"\nstd = 0.01")
        + &disperse("wheels.rx.angle_rad", "distribution = \"uniform\"\nmin = 0\nmax = \"360 deg\"")
        + &disperse("wheels.rx.rate_rad_s", "distribution = \"normal\"\nrelative_std = 0.1")
        + &disperse("initial.attitude", "distribution = \"attitude_error\"\nstd_rad = 0.1");
    [HEAD, body, WHEEL, DISC, THRUSTER, DEBRIS, INITIAL, AWAY, ARC].concat() + &spread
}

#[test]
fn usual_numbers_have_no_note() {
    for body in [BY_MASS, BY_PART, &[BY_PART, BY_POINT].concat()] {
        assert_eq!(notes(&usual(body)), Vec::<String>::new());
    }
}

/// Law: one implausible number is one note, which says key, value, why, and what is usual; the campaign is accepted.
#[test]
fn each_implausible_number_has_its_note() {
    let both = [BY_PART, BY_POINT].concat();
    for (body, from, to, starts, said) in [
        (
            BY_MASS,
            "[0.02, 0.1, 0.05]",
            "[30, 45, 10]",
            "initial.angular_velocity_rad_s = [30.0, 45.0, 10.0]: ",
            "55 rad/s is 3151 deg/s, 8.754 turns/s",
        ),
        (
            BY_MASS,
            "[10, 5, 0]",
            "[10, 5, 0]\ndebris_relative_angular_velocity_rad_s = [0, 90, 0]",
            "initial.debris_relative_angular_velocity_rad_s = [0.0, 90.0, 0.0]: ",
            "14.32 turns/s",
        ),
        (
            BY_MASS,
            "std = 0.01\n[[disperse]]\nparameter = \"wheels",
            "std = 15\n[[disperse]]\nparameter = \"wheels",
            "initial.angular_velocity_rad_s, as dispersed: 1 draw in 100 is beyond",
            " turns/s; usual",
        ),
        (
            BY_MASS,
            "rate_rad_s = 100",
            "rate_rad_s = 100\ntilt_rad = [0, 3]",
            "wheels.rz.tilt_rad = [0.0, 3.0]: ",
            "3 rad is 171.9 deg",
        ),
        (
            BY_MASS,
            "[0.5, 0, 0]",
            "[0.5, 0, 0]\ntilt_rad = [0, 3]",
            "thrusters.ta.tilt_rad = [0.0, 3.0]: ",
            "3 rad is 171.9 deg",
        ),
        (BY_MASS, "std = \"0.1 deg\"", "std = 5", "wheels.rx.tilt_rad, as dispersed: ", "an alignment error of "),
        (BY_MASS, "max = \"360 deg\"", "max = 360", "wheels.rx.angle_rad, as dispersed: ", "more than a turn"),
        (BY_MASS, "std_rad = 0.1", "std_rad = 10", "disperse[5].std_rad of initial.attitude: ", "10 rad is 573 deg"),
        (
            BY_MASS,
            "std_rad = 0.1",
            "covariance_rad2 = [[0.1, 0, 0], [0, 100, 0], [0, 0, 0.1]]",
            "disperse[5].covariance_rad2 of initial.attitude: ",
            "10 rad is 573 deg",
        ),
        (
            BY_MASS,
            "\"attitude_error\"\nstd_rad = 0.1",
            "\"about_axis\"\naxis = [0, 0, 1]\nangle_rad = { distribution = \"normal\", std = 30 }",
            "disperse[5].angle_rad of initial.attitude: ",
            "beyond an angle of 69.79 rad, 3999 deg",
        ),
        (
            BY_MASS,
            "\"2000 rpm\"",
            "\"60000 rpm\"",
            "wheels.rx.rate_rad_s = 6283.185307179587: ",
            "60000 rpm, 486.7 m/s at its radius of gyration, more at the rim",
        ),
        (
            BY_MASS,
            "rate_rad_s = 100",
            "rate_rad_s = -60000",
            "wheels.rz.rate_rad_s = -60000.0: ",
            "573000 rpm, 15000 m/s at the rim",
        ),
        // below 60,000 rpm the speed of the rim decides
        (
            BY_MASS,
            "rate_rad_s = 100",
            "rate_rad_s = 2100",
            "wheels.rz.rate_rad_s = 2100.0: ",
            "20050 rpm, 525 m/s at the rim",
        ),
        (BY_MASS, "relative_std = 0.1", "std = 6000", "wheels.rx.rate_rad_s, as dispersed: ", " rpm, "),
        (
            BY_MASS,
            "[0.2, 0, 0.3]",
            "[20, 0, 0.3]",
            "wheels.rx.position_m = [20.0, 0.0, 0.3]: ",
            "it is 20 m from the body's centre of mass, whose radius of gyration is 0.6124 m",
        ),
        (
            BY_MASS,
            "[0.5, 0, 0]",
            "[0.5, 300, 0]",
            "thrusters.ta.position_m = [0.5, 300.0, 0.0]: ",
            "it is 300 m from the body's centre of mass",
        ),
        (
            BY_MASS,
            AWAY,
            "",
            "initial.debris_position_m = [0.0, 0.0, 0.0]: ",
            "its centre is 0.4 m from the body's centre of mass",
        ),
        (
            BY_PART,
            "[0.2, 0, 0.3]",
            "[3, 0, 0]",
            "wheels.rx.position_m = [3.0, 0.0, 0.0]: ",
            "its centre is 2.5 m outside of body.parts.bus, the nearest part, which a wheel of 0.1095 m does not reach",
        ),
        (
            BY_PART,
            "[0.5, 0, 0]",
            "[0.5, 3, 0]",
            "thrusters.ta.position_m = [0.5, 3.0, 0.0]: ",
            "it is 2.5 m outside of body.parts.bus",
        ),
        (
            BY_PART,
            "[0.5, 0, 0]",
            "[0.3, 0, 0]",
            "thrusters.ta.position_m = [0.3, 0.0, 0.0]: ",
            "it is 0.2 m within body.parts.bus, which its jet would hit",
        ),
        (
            BY_PART,
            "[10, 5, 0]",
            "[0, 0.6, 0]",
            "initial.debris_position_m = [0.0, 0.6, 0.0]: ",
            "within body.parts.bus",
        ),
        (
            &both,
            "[0.2, 0, 0.3]",
            "[30, 0, 0]",
            "wheels.rx.position_m = [30.0, 0.0, 0.0]: ",
            "from the body's centre of mass",
        ),
        (BY_MASS, "end_s = 10.0", "end_s = 100.0", "actuation[0].end_s = 100.0: ", "the run ends before"),
        (
            BY_MASS,
            "end_s = 10.0\nthrust_n = { ta = 1.0 }",
            "end_s = 10.0\nthrust_n = { ta = 1.0 }\n[[actuation]]\nstart_s = 70\nend_s = 80\n[[actuation]]\nstart_s = 80\nend_s = 90",
            "actuation[1].start_s = 70.0, and one more arc: ",
            "never acts",
        ),
    ] {
        let usual = usual(body);
        assert!(usual.contains(from), "{from}");
        let found = notes(&usual.replacen(from, to, 1));
        let [note] = &found[..] else { panic!("{to}: {found:#?}") };
        assert!(note.starts_with(starts) && note.contains(said) && note.contains("; usual are "), "{to}: {note}");
    }
}

/// Law: a shipped campaign has no such note unless it is true: each of those below was compared with its file.
#[test]
fn shipped_campaigns_have_the_notes_that_are_true() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    // 10 pi rad/s about s3 are five turns a second; the report has the debris at p, on the lower plate, at 100 rad/s
    let report: &[&str] = &[
        "initial.angular_velocity_rad_s = [0.0, 3.141592653589793, 31.41592653589793]: an angular velocity of 31.57 rad/s",
        "initial.debris_relative_angular_velocity_rad_s = [100.0, 0.0, 0.0]: an angular velocity of 100 rad/s",
        "initial.debris_position_m = [0.0, 0.0, 0.0]: at the start the debris is, in whole or in part, within body.parts.fuselage",
    ];
    let mut files = 0;
    for entry in std::fs::read_dir(&folder).expect("a folder of campaigns") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        files += 1;
        let plan = Plan::load(&path, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        let expected = match plan.name.as_str() {
            "correlated" | "report_1e-6" | "report_1e-8" | "sobol" | "spin_sweep" | "table" => report,
            // the same spacecraft without debris
            "acceptance" | "no_debris" | "stress_scales" => &report[..1],
            "stress_horizon" => &report[2..],
            // its question is what happens at such rates
            "stress_rates" => &[
                "wheels.w1.rate_rad_s = 100000.0: a rate of 100000 rad/s is 954900 rpm, 25000 m/s at the rim",
                "wheels.w2.rate_rad_s = -100000.0: ",
                "initial.angular_velocity_rad_s = [100000.0, -500000.0, 1000000.0]: ",
                "initial.debris_relative_angular_velocity_rad_s = [10000.0, 2000.0, -5000.0]: ",
                report[2],
            ],
            _ => &[],
        };
        let found = plan.implausible();
        let fits = found.len() == expected.len()
            && found.iter().zip(expected).all(|(found, expected)| found.starts_with(expected));
        assert!(fits, "{}: {found:#?}", plan.name);
    }
    assert!(files >= 20, "{files}");
}
