//! Parts of campaign files, to be put together: Berdoz's spacecraft, table by table.

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

/// A wheel by name, axis and position, as literals.
macro_rules! wheel {
    ($name:literal, $axis:literal, $position:literal) => {
        concat!(
            "[[wheels]]\nname = \"",
            $name,
            "\"\naxis = ",
            $axis,
            "\nposition_m = ",
            $position,
            "\nradius_m = 0.25\nlength_m = 0.1\ndensity_kg_m3 = 2700.0\n"
        )
    };
}

pub const WHEEL1_AT_REST: &str = wheel!("w1", "[0, 1, 0]", "[0, 0, 1]");

pub const WHEEL2_AT_REST: &str = wheel!("w2", "[0, 0, 1]", "[0, 0, 2]");

pub const WHEEL1: &str = concat!(wheel!("w1", "[0, 1, 0]", "[0, 0, 1]"), "rate_rad_s = 314.1592653589793\n");

pub const WHEEL2: &str = concat!(wheel!("w2", "[0, 0, 1]", "[0, 0, 2]"), "rate_rad_s = 157.07963267948966\n");

/// The thrusters p1, p2 and p3, each a table of its own, so that keys may follow.
pub const THRUSTERS: [&str; 3] = [
    "[[thrusters]]\nname = \"p1\"\nposition_m = [0, 0, 0]\ndirection = [0, 0, 1]\n",
    "[[thrusters]]\nname = \"p2\"\nposition_m = [0, -0.5, 3]\ndirection = [0, 0, -1]\n",
    "[[thrusters]]\nname = \"p3\"\nposition_m = [0, 0.5, 3]\ndirection = [0, 0, -1]\n",
];

pub const DEBRIS: &str = "\
[debris]
side_m = 0.2
density_kg_m3 = 2700.0
";

/// The last table of a scene, so that [`DEBRIS_STATE`] may follow.
pub const SPACECRAFT_STATE: &str = "\
[initial]
position_m = [0, 0, 0]
velocity_m_s = [10, 0, 0]
attitude = [1, 0, 0, 0]
angular_velocity_rad_s = [0, 3.141592653589793, 31.41592653589793]
";

pub const DEBRIS_STATE: &str = "\
debris_position_m = [0, 0, 0]
debris_velocity_m_s = [10, 0, 0]
debris_attitude = [1, 0, 0, 0]
debris_relative_angular_velocity_rad_s = [100, 0, 0]
";

pub const SPIN_DISPERSION: &str = "\
[[disperse]]
parameter = \"initial.angular_velocity_rad_s\"
distribution = \"normal\"
std = [0.5, 0.5, 1.5]
";

/// The wheels add nothing to its inertia diag(30, 36, 24) kg m^2.
pub const SMALL_BODY: &str = "[body]\nmass_kg = 100\ncenter_of_mass_m = [0, 0, 0]\n\
    inertia_kg_m2 = [[30, 0, 0], [0, 36, 0], [0, 0, 24]]\nincludes_wheels = true\n";

pub fn small_wheel(name: &str, axis: [u8; 3]) -> String {
    format!(
        "[[wheels]]\nname = {name:?}\naxis = {axis:?}\nmass_kg = 1\naxial_inertia_kg_m2 = \
        0.01\ntransverse_inertia_kg_m2 = 0.006\n"
    )
}

pub const NET_LAUNCH: &str = include_str!("../../campaigns/net_launch.toml");
pub const SLEW_CLOSED: &str = include_str!("../../campaigns/slew_closed.toml");
pub const DETUMBLE: &str = include_str!("../../campaigns/detumble.toml");
pub const DETUMBLE_MAGNETIC: &str = include_str!("../../campaigns/detumble_magnetic.toml");
