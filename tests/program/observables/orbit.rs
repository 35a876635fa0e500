//! Distance, nadir angle and gravity-gradient torque against closed forms.

use crate::prelude::*;

const MU: f64 = 3.986004418e14;
const AXIS: f64 = 7e6;

fn row(more: &str, duration: f64, points: usize, of_body: &str) -> HashMap<String, f64> {
    let text = format!(
        "[campaign]\nname = \"orbit\"\nsamples = 1\nseed = 1\nduration_s = {duration:?}\n\
         [observe]\npoints = {points}\ngroups = [\"orbit\"]\n\
         [body]\nmass_kg = 300.0\n{of_body}\n\
         [orbit]\nsemi_major_axis_m = {AXIS:?}\n{more}"
    );
    let plan = planned(&text);
    rows(&plan).columns().map(|(name, column)| (name.to_owned(), column[0])).collect()
}

/// s3 along -e1: a turn of -90 degrees about e2.
const DOWN: &str = "attitude = [0.7071067811865476, 0.0, -0.7071067811865476, 0.0]";

#[test]
fn a_body_at_rest_is_left_by_nadir() {
    let inertia = "principal_moments_kg_m2 = [90.0, 100.0, 40.0]";
    let body = format!("{inertia}\n[initial]\n{DOWN}\nangular_velocity_rad_s = [0.0, 0.0, 0.0]");
    let rate = (MU / AXIS.powi(3)).sqrt();
    for passed in [0.1, 1.0, 2.5] {
        let row = row("", passed / rate, 33, &body);
        let (last, most, mean) =
            (row["nadir_angle_final_rad"], row["nadir_angle_max_rad"], row["nadir_angle_mean_rad"]);
        assert!((last - passed).abs() < 1e-13 && most == last, "{passed}: {last}, {most}");
        assert!((mean - 0.5 * passed).abs() < 1e-12, "{passed}: {mean}");
        assert!(!row.contains_key("gravity_gradient_torque_max_n_m"), "nothing turns the body");
        for name in ["orbit_distance_min_m", "orbit_distance_max_m"] {
            assert!((row[name] / AXIS - 1.0).abs() < 1e-14, "{name} {}", row[name]);
        }
    }
    let far = row("", 4.0 / rate, 4_001, &body);
    assert!((far["nadir_angle_final_rad"] - (2.0 * PI - 4.0)).abs() < 1e-13);
    assert!((far["nadir_angle_max_rad"] - PI).abs() < 1e-3);
    let ellipse = row("eccentricity = 0.05", 2.0 * PI / rate, 201, &body);
    for (name, distance) in [("orbit_distance_min_m", 0.95 * AXIS), ("orbit_distance_max_m", 1.05 * AXIS)] {
        assert!((ellipse[name] / distance - 1.0).abs() < 1e-12, "{name} {}", ellipse[name]);
    }
}

/// Law: a body turned by t about a principal axis has the torque 3 mu/(2 r^3) |J3 - J1| sin 2t.
#[test]
fn the_torque_is_that_of_the_textbook() {
    for turned in [0.2_f64, PI / 4.0, 1.2, 3.0] {
        let half = 0.5 * (-PI / 2.0 + turned);
        let (w, y) = (half.cos(), half.sin());
        let body = format!(
            "principal_moments_kg_m2 = [90.0, 100.0, 40.0]\n[initial]\nattitude = [{w:?}, 0.0, {y:?}, \
            0.0]\nangular_velocity_rad_s = [0.0, 0.0, 0.0]\n\
             [environment]\ngravity_gradient = true"
        );
        let row = row("", 1e-3, 2, &body);
        let expected = 1.5 * MU / AXIS.powi(3) * 50.0 * (2.0 * turned).sin().abs();
        let torque = row["gravity_gradient_torque_max_n_m"];
        assert!((torque / expected - 1.0).abs() < 1e-5, "{turned}: {torque} for {expected}");
        assert!((row["nadir_angle_max_rad"] - turned).abs() < 1e-5, "{turned}: {}", row["nadir_angle_max_rad"]);
    }
}

/// Law: the field is that of the package, and the torque of a dipole across it their product.
#[test]
fn a_dipole_is_turned_by_the_field() {
    // `pyIGRF14` at the first instant of 2025 on the e1 axis, in F_e: see tests/accuracy/magnetic_torque.rs
    let with = |dipole: [f64; 3]| {
        let body = format!(
            "principal_moments_kg_m2 = [90.0, 100.0, 40.0]\n[initial]\nangular_velocity_rad_s = [0.0, 0.0, 0.0]\n\
             [environment]\nmagnetic_field = \"igrf\"\nmagnetic_dipole_a_m2 = {dipole:?}"
        );
        row("epoch = \"2025-01-01T00:00:00Z\"", 1e-3, 2, &body)
    };
    const FIELD: [f64; 3] = [-6_513.290_588_998_474, 2_186.644_337_215_031, 21_391.717_240_425_576];
    let size = FIELD.iter().map(|b| b * b).sum::<f64>().sqrt();
    let along = with(FIELD.map(|b| 2.0 * b / size));
    assert!((1e9 * along["magnetic_field_max_t"] / size - 1.0).abs() < 1e-6, "{along:?}");
    assert!((along["magnetic_field_mean_t"] / along["magnetic_field_max_t"] - 1.0).abs() < 1e-6);
    assert!(along["magnetic_torque_max_n_m"] < 1e-6 * 2e-9 * size);
    let across = with([0.0, 3.0 * FIELD[2] / size, -3.0 * FIELD[1] / size]);
    let expected = 3e-9 * size * (1.0 - (FIELD[0] / size).powi(2)).sqrt();
    assert!((across["magnetic_torque_max_n_m"] / expected - 1.0).abs() < 1e-6, "{across:?} {expected}");
}

#[test]
fn the_group_is_of_scenes_on_an_orbit() {
    assert!(!Group::DEFAULT.contains(&Group::Orbit));
    let text = "[campaign]\nname = \"none\"\nsamples = 1\nseed = 1\nduration_s = 1.0\n[observe]\ngroups = [\"orbit\", \
        \"effort\"]\n\
                [body]\nmass_kg = 1.0\nprincipal_moments_kg_m2 = [1.0, 2.0, 2.5]\n";
    let plan = planned(text);
    assert!(plan.request().columns().iter().all(|column| column.group != Group::Orbit));
}
