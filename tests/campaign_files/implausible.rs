//! Numbers that look like a mistake are noted, not refused: each with its key and what is usual.

use std::path::Path;

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::plausibility::implausible;

const USUAL: &str = r#"[campaign]
name = "x"
samples = 200
seed = 7
duration_s = 60.0
[observe]
points = 121
[body]
mass_kg = 300
inertia_kg_m2 = [[60, 1, 0.5], [1, 75, 0.2], [0.5, 0.2, 90]]
includes_wheels = false
[[wheels]]
name = "rx"
axis = [1, 0, 0]
mass_kg = 5
axial_inertia_kg_m2 = 0.03
transverse_inertia_kg_m2 = 0.02
rate_rad_s = "2000 rpm"
[[thrusters]]
name = "ta"
position_m = [0.5, 0, 0]
direction = [0, 0, 1]
[debris]
size_m = [0.3, 0.5, 0.9]
density_kg_m3 = 500
[initial]
angular_velocity_rad_s = [0.02, 0.1, 0.05]
[[actuation]]
start_s = 5.0
end_s = 10.0
torque_n_m = { rx = 0.1 }
[[disperse]]
parameter = "initial.angular_velocity_rad_s"
distribution = "normal"
std = 0.01
[[disperse]]
parameter = "wheels.rx.tilt_rad"
distribution = "normal"
std = "0.1 deg"
[[disperse]]
parameter = "wheels.rx.angle_rad"
distribution = "uniform"
min = 0
max = "360 deg"
[[disperse]]
parameter = "wheels.rx.rate_rad_s"
distribution = "normal"
relative_std = 0.1
"#;

fn notes(text: &str) -> Vec<String> {
    implausible(
        &Plan::from_text("x.toml", text, Overrides::default()).unwrap_or_else(|error| panic!("{error}\n{text}")),
    )
}

/// Law: usual numbers have no note; each implausible one has one, which says key and value. The campaign is accepted.
#[test]
fn each_implausible_number_has_its_note() {
    assert_eq!(notes(USUAL), [""; 0]);
    for (from, to, starts, says) in [
        ("[0.02, 0.1, 0.05]", "[0.6, 0.8, 0]", "initial.angular_velocity_rad_s: 1 rad/s", "57.3 deg/s"),
        ("std = 0.01", "std = 0.5", "initial.angular_velocity_rad_s, as dispersed", "30 deg/s"),
        ("0.05]\n", "0.05]\ndebris_relative_angular_velocity_rad_s = [3, 0, 0]\n", "initial.debris_rel", "3 rad/s"),
        ("\"2000 rpm\"", "2000", "wheels.rx.rate_rad_s: 2000 rad/s", "19100 rpm"),
        ("rx = 0.1", "rx = 7", "wheels.rx: the torques of [[actuation]]", "13140 rpm"),
        ("\"0.1 deg\"", "0.1", "wheels.rx.tilt_rad, as dispersed", "0.1 deg"),
        ("\"360 deg\"", "360", "wheels.rx.angle_rad, as dispersed", "0 to 2 pi"),
        ("relative_std = 0.1", "relative_std = 0.5", "wheels.rx.rate_rad_s, relative_std = 0.5", "half the nominal"),
        ("mass_kg = 300", "mass_kg = 300000", "the spacecraft has a mass of 300000 kg", "usual values are"),
        ("points = 121", "points = 3", "observe.points = 3:", "turns from one point to the next"),
        ("5.0\nend_s = 10.0", "60.0\nend_s = 70.0", "actuation[0].start_s = 60.0", "at the end of the run or later"),
    ] {
        assert_eq!(USUAL.matches(from).count(), 1, "{from}");
        let found = notes(&USUAL.replace(from, to));
        let [note] = &found[..] else { panic!("{to}: {found:#?}") };
        assert!(note.starts_with(starts) && note.contains(says), "{to}: {note}");
    }
}

/// Law: a shipped campaign has a note only where its question is such a number: Berdoz's spacecraft turns at 10 pi rad/s, its debris at 100 rad/s.
#[test]
fn shipped_campaigns_have_the_notes_that_are_true() {
    let (mut files, mut noted) = (0, 0);
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns")).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let plan = Plan::load(&path, Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
            let found = implausible(&plan);
            (files, noted) = (files + 1, noted + usize::from(!found.is_empty()));
            // the shapes of one campaign make 63 tons, and what turns so fast turns between the points
            // and Berdoz's thrusters have torque about s1 alone
            let keys = [
                "angular_velocity_rad_s: ",
                "rate_rad_s: ",
                "a mass of 63420 kg",
                "observe.points = ",
                "off s3",
                "about one axis alone",
            ];
            let is_true = |note: &String| keys.iter().any(|key| note.contains(key));
            assert!(found.iter().all(is_true), "{}: {found:#?}", plan.name);
        }
    }
    assert!(files >= 20 && noted < files, "{noted} of {files}");
}
