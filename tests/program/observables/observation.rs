//! Observables of motions that are known without integration.

use crate::observables::observed_tables::{ROUNDING, close, free_row, motion_table, rotation, table1};
use crate::prelude::*;

/// A symmetric top whose spin axis nutates: body rate (w cos kt, w sin kt, n) with k = n (J3 - J1) / J1.
#[test]
fn a_nutating_top_swings_its_tilted_wheel_at_twice_the_body_nutation_rate() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let transverse = scene.mass.inertia[0][0];
    let excess = scene.mass.inertia[1][1] - transverse;
    scene.mass.inertia[1][1] -= excess;
    scene.mass.body.inertia[1][1] -= excess;
    let axial = scene.mass.inertia[2][2];
    let (across, spin) = (0.4, 5.0);
    let nutation = spin * (axial - transverse) / transverse;
    let h = ((transverse * across).powi(2) + (axial * spin).powi(2)).sqrt();
    // C_es = Rot(e3, precession) Rot(tilt) Rot(s3, body), L along e3
    let precession = h / transverse;
    let tilt = libm::atan2(transverse * across, axial * spin);
    let motion = |t: f64| {
        let angle = nutation * t;
        let omega = [across * libm::cos(angle), across * libm::sin(angle), spin];
        // omega across s3 lies in the plane of e3 and s3
        let lean = rotation([1.0, 0.0, 0.0], tilt);
        let body = rotation([0.0, 0.0, 1.0], std::f64::consts::FRAC_PI_2 - angle);
        let q = hamilton(rotation([0.0, 0.0, 1.0], precession * t), hamilton(lean, body));
        (q, omega, [0.0, 0.0], [0.1, 0.2, 0.3])
    };
    let grid = Grid::uniform(30.0, 301);
    let row = free_row(&grid, &scene, &motion_table(&grid, &motion));
    // h / J1 * t is some dozens of radians, rounded
    assert!(row["energy_error_max"] <= ROUNDING, "{}", row["energy_error_max"]);
    // measured: 1.0e-15
    assert!(row["angular_momentum_error_max"] <= 3.0 * ROUNDING, "{}", row["angular_momentum_error_max"]);
    close(row["angular_momentum_initial_n_m_s"], h, ROUNDING);
    let expected = nutation.abs() / std::f64::consts::PI;
    // measured: a tenth of that, 6.3e-4 of the 1/30 Hz between the lines of 30 s
    let frequency = row["exchange_frequency_hz"];
    assert!((frequency - expected).abs() <= 0.006 / 30.0, "{frequency} {expected}");
    close(row["exchange_w1_correlation"], -1.0, ROUNDING);
    let swing = row["exchange_body_peak_to_peak_j"];
    let whole_swings = 2.0 * 30.0 * expected;
    // 30 s are not a whole number of swings; measured: 0.008
    close(row["exchange_body_gross_j"], swing * whole_swings, 0.05);
    // the largest of 301 points is below the maximum between them; measured: 0.0083
    close(row["exchange_body_power_max_w"], 0.5 * swing * 2.0 * nutation.abs(), 0.05);
}
