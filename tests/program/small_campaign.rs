//! The campaign that the tests of the commands run, in a folder of its own.

use crate::prelude::*;

use crate::support::campaigns::{DEBRIS, DEBRIS_STATE};

const HEAD: &str = r#"
[campaign]
name = "small"
samples = 600
seed = 7
duration_s = 1.0
[integrator]
method = "auto"
tolerance = 1e-10
[observe]
points = 11
"#;

/// A third of these wall thicknesses is negative.
pub const NEGATIVE_WALLS: &str = r#"
[[disperse]]
parameter = "body.parts.fuselage.wall_thickness_m"
distribution = "uniform"
min = -0.02
max = 0.04
"#;

pub const RADIANS: &str = "[display]\nunits = [\"rad\", \"rad/s\"]\n";

pub fn campaign() -> String {
    [HEAD, RADIANS, FUSELAGE, WHEEL1, WHEEL2, DEBRIS, SPACECRAFT_STATE, DEBRIS_STATE, SPIN_DISPERSION].concat()
}

pub fn sized(samples: u64) -> String {
    campaign().replace("samples = 600", &format!("samples = {samples}"))
}

pub fn campaign_without_debris() -> String {
    [HEAD, RADIANS, FUSELAGE, WHEEL1, WHEEL2, SPACECRAFT_STATE, SPIN_DISPERSION].concat()
}

pub fn mixed_failures() -> String {
    let text = campaign_without_debris()
        .replace("method = \"auto\"\ntolerance = 1e-10", "method = \"runge_kutta_4\"\nstep_s = 0.02")
        .replace("std = [0.5, 0.5, 1.5]", "std = [0.5, 0.5, 15]");
    [text.as_str(), NEGATIVE_WALLS].concat()
}

pub fn table(samples: impl Iterator<Item = (bool, f64)>) -> (String, String) {
    let row = |(fails, spin): (bool, f64)| format!("{},{spin:?}\n", if fails { "-0.01" } else { "0.03" });
    let names = "body.parts.fuselage.wall_thickness_m,initial.angular_velocity_rad_s.z\n";
    let text = campaign_without_debris().replace("samples = 600\n", "").replace(SPIN_DISPERSION, "");
    let design = "[design]\nkind = \"table\"\nfile = \"table.csv\"\n";
    (names.to_owned() + &samples.map(row).collect::<String>(), text + design)
}

pub fn folder(name: &str) -> ScratchFolder {
    let folder = ScratchFolder::new(&format!("cli-{name}"));
    fs::create_dir(folder.path("campaigns")).unwrap();
    folder.file("small.toml", &campaign());
    folder
}
