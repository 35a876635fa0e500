//! The campaign that the tests of the commands run, in a folder of its own.

use std::fs;

use crate::support::campaigns::{DEBRIS, DEBRIS_STATE, FUSELAGE, SPACECRAFT_STATE, SPIN_DISPERSION, WHEEL1, WHEEL2};
use crate::support::scratch_folder::ScratchFolder;

/// Six hundred samples are three parts.
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

/// The text of the campaign.
pub fn campaign() -> String {
    [HEAD, FUSELAGE, WHEEL1, WHEEL2, DEBRIS, SPACECRAFT_STATE, DEBRIS_STATE, SPIN_DISPERSION].concat()
}

/// The same without debris.
pub fn campaign_without_debris() -> String {
    [HEAD, FUSELAGE, WHEEL1, WHEEL2, SPACECRAFT_STATE, SPIN_DISPERSION].concat()
}

/// A folder with the campaign as `small.toml` and an empty folder `campaigns`.
pub fn folder(name: &str) -> ScratchFolder {
    let folder = ScratchFolder::new(&format!("cli-{name}"));
    fs::create_dir(folder.path("campaigns")).unwrap();
    folder.file("small.toml", &campaign());
    folder
}
