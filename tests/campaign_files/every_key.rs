//! A campaign file with every table, and with tables of every distribution and design: what the tests of wrong files change.

/// A valid file with every table that a file can have.
pub const EVERY_TABLE: &str = r#"[campaign]
name = "every"
description = "What is refused?"
samples = 10
seed = 1
duration_s = 10.0

[integrator]
method = "auto"
tolerance = 1e-10
max_steps = 100000

[observe]
points = 11
groups = ["effort", "energy_conservation"]

[body]
mass_scale = 1.0

[[body.parts]]
name = "fuselage"
shape = "hollow_cylinder"
wall_thickness_m = 0.03
outer_radius_m = 1.0
length_m = 3.0
density_kg_m3 = 2700.0
position_m = [0, 0, 1.5]

[[body.parts]]
name = "tank"
shape = "sphere"
radius_m = 0.1
mass_kg = 5.0

[[wheels]]
name = "w1"
axis = [0, 1, 0]
position_m = [0, 0, 1]
radius_m = 0.25
length_m = 0.1
density_kg_m3 = 2700.0
rate_rad_s = 314.0

[[wheels]]
name = "w2"
axis = [0, 0, 1]
mass_kg = 50.0
axial_inertia_kg_m2 = 1.5
transverse_inertia_kg_m2 = 0.8
mode = "locked"

[[thrusters]]
name = "p1"
position_m = [0, 0, 0]
direction = [0, 0, 1]

[debris]
side_m = 0.2
density_kg_m3 = 2700.0

[initial]
position_m = [0, 0, 0]
velocity_m_s = [10, 0, 0]
attitude = [1, 0, 0, 0]
angular_velocity_rad_s = [0, 3.0, 31.0]
debris_position_m = [0, 0, 0]
debris_velocity_m_s = [10, 0, 0]
debris_attitude = [1, 0, 0, 0]
debris_relative_angular_velocity_rad_s = [100, 0, 0]

[environment]
body_torque_n_m = [0, 0.001, 0]

[actuators]
switch_on_delay_s = 0.001

[[actuation]]
name = "burn"
start_s = 0.0
end_s = 3.0
thrust_n = { p1 = 100 }
thrust_scale = 0.99
torque_n_m = { w1 = 0.5 }

[design]
kind = "random"

[[disperse]]
parameter = "wheels.w1.radius_m"
distribution = "uniform"
half_width = 0.002

[[disperse]]
parameter = "body.parts.fuselage.density_kg_m3"
distribution = "normal"
relative_std = 0.02

[[correlate]]
parameters = ["wheels.w1.radius_m", "body.parts.fuselage.density_kg_m3"]
rank_correlation = 0.5

[[derive]]
parameter = "body.parts.fuselage.position_m.z"
expression = "body.parts.fuselage.length_m / 2"

[bands]
points = 5

[audit]
fraction = 0.1

[output]
compression = "zstd"

[[observable]]
name = "twice"
unit = "J"
expression = "2 * energy_error_max"

[statistics]
quantiles = [0.5, 0.9]
confidence = 0.9

[summary]
columns = ["steps"]

[[require]]
observable = "energy_error_max"
quantile = 0.99
at_most = 1e-9

[stop]
observable = "energy_error_max"
quantile = 0.95
half_width = 1e-12
max_samples = 5000

[retain]
trajectories = "failed"
"#;

/// Tables of distributions, each with the name of the distribution.
pub fn distributions() -> Vec<(&'static str, String)> {
    let scalar = [
        "normal",
        "truncated_normal",
        "uniform",
        "log_normal",
        "log_uniform",
        "triangular",
        "pert",
        "beta",
        "gamma",
        "weibull",
        "exponential",
        "rayleigh",
        "student_t",
        "bernoulli",
        "choice",
        "empirical",
        "offset",
    ];
    let table = |parameter: &str, name: &str| {
        format!("\n[[disperse]]\nparameter = \"{parameter}\"\ndistribution = \"{name}\"\n")
    };
    let scalar = scalar.map(|name| (name, table("body.parts.tank.mass_kg", name)));
    let directions =
        ["uniform_direction", "cone", "von_mises_fisher"].map(|name| (name, table("thrusters.p1.direction", name)));
    let attitudes =
        ["uniform_attitude", "attitude_error", "about_axis"].map(|name| (name, table("initial.attitude", name)));
    let rows = ("bootstrap", "\n[[disperse]]\ndistribution = \"bootstrap\"\n".to_owned());
    scalar.into_iter().chain(directions).chain(attitudes).chain([rows]).collect()
}
