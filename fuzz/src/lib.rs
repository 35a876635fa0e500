//! What the fuzz targets have in common.

/// The text of a campaign of a box of 10 kg, with `keys` in the table `[campaign]`; further tables may follow it.
pub fn campaign(keys: &str) -> String {
    format!("[campaign]\n{keys}\n{REST}")
}

const REST: &str = "seed = 1
duration_s = 1.0
[body]
mass_kg = 10.0
center_of_mass_m = [0, 0, 0]
inertia_kg_m2 = [[2, 0, 0], [0, 3, 0], [0, 0, 4]]
includes_wheels = false
[initial]
angular_velocity_rad_s = [0.01, 1.0, 0.01]
attitude = [1, 0, 0, 0]
";
