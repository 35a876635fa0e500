//! Parts of campaign files, to be put together: the report's spacecraft, table by table.

/// The fuselage.
pub const FUSELAGE: &str = "\
[fuselage]
wall_thickness_m = 0.03
outer_radius_m = 1.0
length_m = 3.0
density_kg_m3 = 2700.0
thruster_offset_m = 0.5
";

/// Wheel 1.
pub const WHEEL1: &str = "\
[wheel1]
radius_m = 0.25
length_m = 0.1
station_m = 1.0
density_kg_m3 = 2700.0
";

/// Wheel 2.
pub const WHEEL2: &str = "\
[wheel2]
radius_m = 0.25
length_m = 0.1
station_m = 2.0
density_kg_m3 = 2700.0
";

/// The debris.
pub const DEBRIS: &str = "\
[debris]
side_m = 0.2
density_kg_m3 = 2700.0
";

/// The initial state of the spacecraft with both wheels: the last table of a scene, so that [`DEBRIS_STATE`] may follow.
pub const SPACECRAFT_STATE: &str = "\
[initial]
position_m = [0, 0, 0]
velocity_m_s = [10, 0, 0]
attitude = [1, 0, 0, 0]
angular_velocity_rad_s = [0, 3.141592653589793, 31.41592653589793]
wheel_angles_rad = [0, 0]
wheel_rates_rad_s = [314.1592653589793, 157.07963267948966]
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
