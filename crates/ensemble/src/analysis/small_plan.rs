//! The plan of tests in `analysis`: a free body with dispersed rates about two axes.

use crate::campaign::Plan;
use spindrift_control::control::tables::Overrides;

const TEXT: &str = r#"
initial = { angular_velocity_rad_s = [0.0, 0.1, 0.5] }
integrator = { method = "auto", tolerance = 1e-10 }
observe = { points = 11 }
DESIGN

[campaign]
name = "small"
seed = 1
duration_s = 1.0
samples = 7

[body]
mass_kg = 500.0
center_of_mass_m = [0.0, 0.0, 0.0]
inertia_kg_m2 = [[120.0, 0.0, 0.0], [0.0, 150.0, 0.0], [0.0, 0.0, 90.0]]
includes_wheels = false

[[disperse]]
parameter = "initial.angular_velocity_rad_s.x"
distribution = "normal"
std = 0.05

[[disperse]]
parameter = "initial.angular_velocity_rad_s.y"
distribution = "normal"
std = 0.05
"#;

/// With this many samples; `design` is a line of the campaign file.
pub(super) fn small_plan(samples: u64, design: &str) -> Plan {
    let overrides = Overrides { samples: Some(samples), ..Overrides::default() };
    Plan::from_text("small.toml", &TEXT.replace("DESIGN", design), overrides).expect("a plan")
}
