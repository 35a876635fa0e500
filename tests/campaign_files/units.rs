//! Units in values, against a table of their own.

use crate::prelude::*;

const FILE: &str = r#"[campaign]
name = "units"
samples = 2
seed = 1
duration_s = @s@
[body]
includes_wheels = false
inertia_scale = @1@
mass_kg = @kg@
inertia_kg_m2 = [[30, 0, 0], [0, 30, 0], [0, 0, 20]]
[[wheels]]
name = "w1"
axis = [0, 0, 1]
radius_m = @m@
length_m = 0.1
density_kg_m3 = @kg/m^3@
torque_bias_n_m = @N m@
[[wheels]]
name = "w2"
axis = [0, 0, 1]
mass_kg = 1
axial_inertia_kg_m2 = @kg m^2@
transverse_inertia_kg_m2 = 1e9
angle_rad = @rad@
rate_rad_s = @rad/s@
[[thrusters]]
name = "p1"
position_m = [0, 0, 0]
direction = [0, 0, 1]
[[actuation]]
start_s = 0
end_s = 1
thrust_n = { p1 = @N@ }
torque_n_m = { w1 = 1 }
[initial]
velocity_m_s = [@m/s@, 0, 0]
angular_velocity_rad_s = [0, 0, 1]
"#;

/// SI units, and others with their sizes: exact (BIPM, *The International System of Units*, 9th edition, tables 5, 7
/// and 8; NIST SP 811, appendix B.8), those with pi to 20 digits.
#[expect(clippy::excessive_precision, clippy::approx_constant, reason = "digits of a table, not of this machine")]
const TABLE: [(&str, &[(&str, f64)]); 11] = [
    (
        "rad",
        &[
            ("deg", 0.017453292519943295769),
            ("arcmin", 0.00029088820866572159615),
            ("arcsec", 0.0000048481368110953599359),
            ("mrad", 0.001),
            ("rev", 6.2831853071795864769),
        ],
    ),
    (
        "rad/s",
        &[
            ("deg/s", 0.017453292519943295769),
            ("deg/min", 0.00029088820866572159615),
            ("deg/h", 0.0000048481368110953599359),
            ("mrad/s", 0.001),
            ("rpm", 0.10471975511965977462),
            ("rev/s", 6.2831853071795864769),
        ],
    ),
    ("s", &[("ms", 0.001), ("min", 60.0), ("h", 3600.0), ("day", 86_400.0)]),
    ("m", &[("mm", 0.001), ("cm", 0.01), ("km", 1000.0)]),
    ("m/s", &[("mm/s", 0.001), ("cm/s", 0.01), ("km/s", 1000.0), ("km/h", 0.27777777777777777778)]),
    ("kg", &[("g", 0.001), ("t", 1000.0)]),
    ("kg/m^3", &[("g/cm^3", 1000.0)]),
    ("kg m^2", &[("kg cm^2", 0.0001), ("g cm^2", 1e-7)]),
    ("N", &[("mN", 0.001), ("kN", 1000.0)]),
    ("N m", &[("mN m", 0.001), ("kN m", 1000.0)]),
    ("1", &[("%", 0.01)]),
];

fn file(unit: &str, value: &str) -> String {
    let with = |text: String, si: &str| text.replace(&format!("@{si}@"), if si == unit { value } else { "1" });
    TABLE.iter().fold(FILE.to_owned(), |text, (si, _)| with(text, si))
}

#[test]
fn units_have_their_sizes() {
    let plan = |text: &str| parsed(text);
    for (si, units) in TABLE {
        let error = plan(&file(si, "\"1 furlong\"")).expect_err("no unit").to_string();
        let listed = error.split_once("one with a unit (").and_then(|(_, rest)| rest.split(')').next());
        let mut listed: Vec<&str> = listed.unwrap_or_else(|| panic!("{error}")).split(", ").collect();
        let mut known: Vec<&str> =
            units.iter().map(|(unit, _)| *unit).chain(Some(si).filter(|si| *si != "1")).collect();
        listed.sort_unstable();
        known.sort_unstable();
        assert_eq!(listed, known, "of {si}");
        for (unit, size) in units {
            for number in [1.0, 0.3, 7e3] {
                let written = plan(&file(si, &format!("\"{number} {unit}\""))).unwrap();
                // three roundings: of the size here, of the product, and of the program's quotient
                let near = |steps: i32| {
                    let exact = number * size;
                    let value =
                        (0..steps.abs()).fold(exact, |x, _| if steps < 0 { x.next_down() } else { x.next_up() });
                    plan(&file(si, &format!("{value:?}"))).is_ok_and(|plain| plain.text() == written.text())
                };
                assert!((-3..=3).any(near), "{number} {unit} is not {number} times {size} {si}:\n{}", written.text());
            }
        }
    }
}
