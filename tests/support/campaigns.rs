//! Parts of campaign files, to be put together: the report's spacecraft, table by table.

/// The fuselage.
pub const FUSELAGE: &str = "\
[[body.parts]]
name = \"fuselage\"
shape = \"hollow_cylinder\"
wall_thickness_m = 0.03
outer_radius_m = 1.0
length_m = 3.0
density_kg_m3 = 2700.0
position_m = [0, 0, 1.5]
";

/// Wheel 1, with its initial rate.
pub const WHEEL1: &str = "\
[[wheels]]
name = \"w1\"
axis = [0, 1, 0]
position_m = [0, 0, 1]
radius_m = 0.25
length_m = 0.1
density_kg_m3 = 2700.0
rate_rad_s = 314.1592653589793
";

/// Wheel 2, with its initial rate.
pub const WHEEL2: &str = "\
[[wheels]]
name = \"w2\"
axis = [0, 0, 1]
position_m = [0, 0, 2]
radius_m = 0.25
length_m = 0.1
density_kg_m3 = 2700.0
rate_rad_s = 157.07963267948966
";

/// The debris.
pub const DEBRIS: &str = "\
[debris]
side_m = 0.2
density_kg_m3 = 2700.0
";

/// The initial state of the spacecraft: the last table of a scene, so that [`DEBRIS_STATE`] may follow.
pub const SPACECRAFT_STATE: &str = "\
[initial]
position_m = [0, 0, 0]
velocity_m_s = [10, 0, 0]
attitude = [1, 0, 0, 0]
angular_velocity_rad_s = [0, 3.141592653589793, 31.41592653589793]
";

/// The initial state of the debris.
pub const DEBRIS_STATE: &str = "\
debris_position_m = [0, 0, 0]
debris_velocity_m_s = [10, 0, 0]
debris_attitude = [1, 0, 0, 0]
debris_relative_angular_velocity_rad_s = [100, 0, 0]
";

/// A spin that differs from sample to sample.
pub const SPIN_DISPERSION: &str = "\
[[disperse]]
parameter = \"initial.angular_velocity_rad_s\"
distribution = \"normal\"
std = [0.5, 0.5, 1.5]
";
