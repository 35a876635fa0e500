//! Observables of motions that are known without integration.
//!
//! Laws: closed-form motions give their closed-form numbers. Counter-test: a balance without the work that is fed in
//! does not close.

use crate::observables::observed_tables::{
    ROUNDING, close, free_row, motion_table, observation, request, request_of_balances, rotation, row, table1,
};
use spindrift::math::Isa;
use spindrift::math::vector::hamilton;
use spindrift::observables::{Group, Groups, Series};
use spindrift::run::{Grid, StateField};

#[test]
fn a_steady_spin_about_a_principal_axis_exchanges_nothing() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let grid = Grid::uniform(10.0, 101);
    let spin = 3.0;
    let table =
        motion_table(&grid, &|t| (rotation([0.0, 0.0, 1.0], spin * t), [0.0, 0.0, spin], [0.0, 50.0], [1.0, 2.0, 3.0]));
    let row = free_row(&grid, &scene, &table);
    let wheel2 = scene.mass.wheels[1];
    close(row["energy_com_w2_mean_j"], 0.5 * wheel2.axial * (spin + 50.0) * (spin + 50.0), ROUNDING);
    close(row["energy_com_body_mean_j"], 0.5 * scene.mass.body.inertia[2][2] * spin * spin, ROUNDING);
    close(row["linear_momentum_initial_n_s"], scene.mass.total * 14.0_f64.sqrt(), ROUNDING);
    let balances = self::row(Isa::best(), request_of_balances(false), &grid, &scene, &table);
    for (row, error) in [
        (&row, "energy_error"),
        (&row, "angular_momentum_error"),
        (&row, "dcm_orthonormality"),
        (&balances, "linear_momentum_error"),
    ] {
        assert!(row[format!("{error}_max").as_str()] <= ROUNDING, "{error}");
        assert!(row[format!("{error}_rate_per_s").as_str()].abs() <= ROUNDING, "{error}");
    }
    assert!(
        !row.contains_key("linear_momentum_error_max"),
        "nothing changes the velocity of c, and nobody integrates it"
    );
    for name in ["exchange_w1_correlation", "exchange_w2_correlation", "exchange_w1_gross_j"] {
        assert_eq!(row[name], 0.0, "{name}");
    }
    assert!(row["exchange_frequency_hz"].is_nan(), "what is constant has no frequency");
}

#[test]
fn wheels_alone_hold_energy_and_momentum() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let grid = Grid::uniform(1.0, 17);
    let table = motion_table(&grid, &|_| ([0.5, 0.5, -0.5, 0.5], [0.0; 3], [10.0, -20.0], [0.0; 3]));
    let row = free_row(&grid, &scene, &table);
    let [a, b] = [0, 1].map(|wheel| scene.mass.wheels[wheel].axial);
    close(row["energy_w1_final_j"], 0.5 * a * 100.0, ROUNDING);
    close(row["energy_com_w2_min_j"], 0.5 * b * 400.0, ROUNDING);
    assert_eq!(row["energy_body_max_j"], 0.0);
    close(row["angular_momentum_max_n_m_s"], 10.0 * (a * a + 4.0 * b * b).sqrt(), ROUNDING);
    // at rest: |p| is zero everywhere, so that its error is absolute, and zero
    let balances = self::row(Isa::best(), request_of_balances(false), &grid, &scene, &table);
    assert_eq!((balances["linear_momentum_max_n_s"], balances["linear_momentum_error_max"]), (0.0, 0.0));
}

/// Law: s3 of a torque-free axisymmetric body moves on a cone about L, so that its largest angle from the initial
/// direction is twice the nutation angle v, and after the time t it is 2 asin(sin v |sin(p t/2)|), p the rate of
/// precession.
#[test]
fn the_spin_axis_of_a_free_symmetric_body_moves_on_a_cone() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let precession = 2.0;
    for nutation in [1e-6, 0.3, 1.5] {
        let motion = |t: f64| {
            let lean = rotation([1.0, 0.0, 0.0], nutation);
            let q =
                hamilton(rotation([0.0, 0.0, 1.0], precession * t), hamilton(lean, rotation([0.0, 0.0, 1.0], 7.0 * t)));
            (q, [0.0; 3], [0.0; 2], [0.0; 3])
        };
        // one and a quarter turns of precession: the farthest point of the cone is on the grid
        let grid = Grid::uniform(2.5 * std::f64::consts::PI / precession, 101);
        let table = motion_table(&grid, &motion);
        let request = request(Groups::NONE.with(Group::Attitude), false, false);
        let (row, observer) = observation(Isa::best(), request, &grid, &scene, &table);
        // a few roundings of the attitude
        let near = |found: f64, expected: f64| assert!((found - expected).abs() <= 4e-15, "{found:e} {expected:e}");
        near(row["spin_axis_angle_max_rad"], 2.0 * nutation);
        near(
            row["spin_axis_angle_final_rad"],
            2.0 * libm::asin(libm::sin(nutation) * libm::sin(0.25 * std::f64::consts::PI)),
        );
        let (_, angles) = observer.series().find(|(series, _)| *series == Series::SpinAxisAngle).expect("a series");
        for (time, angle) in grid.times().iter().zip(angles) {
            near(angle, 2.0 * libm::asin(libm::sin(nutation) * libm::sin(0.5 * precession * time).abs()));
        }
    }
}

/// A symmetric top whose spin axis nutates: body rate (w cos kt, w sin kt, n) with k = n (J3 - J1) / J1.
#[test]
fn a_nutating_top_swings_its_tilted_wheel_at_twice_the_body_nutation_rate() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    // without wheels' spin and with a transverse inertia made equal, the whole is a symmetric top
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
        // omega across s3 lies in the plane of e3 and s3: at body angle pi/2 - angle for a tilt about s1
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
    // the body differs from a symmetric body by what the wheels (fixed) add: its energy swings with cos(2 k t)
    let expected = nutation.abs() / std::f64::consts::PI;
    // measured: a tenth of that, 6.3e-4 of the 1/30 Hz between the lines of 30 s
    assert!(
        (row["exchange_frequency_hz"] - expected).abs() <= 0.006 / 30.0,
        "{} {expected}",
        row["exchange_frequency_hz"]
    );
    // what one gains the other loses, apart from the constant energy of the second wheel
    close(row["exchange_w1_correlation"], -1.0, ROUNDING);
    let swing = row["exchange_body_peak_to_peak_j"];
    let whole_swings = 2.0 * 30.0 * expected;
    // 30 s are not a whole number of swings; measured: 0.008
    close(row["exchange_body_gross_j"], swing * whole_swings, 0.05);
    // the largest of 301 points is below the maximum between them; measured: 0.0083
    close(row["exchange_body_power_max_w"], 0.5 * swing * 2.0 * nutation.abs(), 0.05);
}

/// Thrust along s3 through c, at rest otherwise: p = F t, W = F^2 t^2 / 2m.
#[test]
fn thrust_along_the_axis_balances_and_without_its_work_it_does_not() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let grid = Grid::uniform(5.0, 51);
    let (force, mass) = (100.0, scene.mass.total);
    let mut table = motion_table(&grid, &|t| ([1.0, 0.0, 0.0, 0.0], [0.0; 3], [0.0; 2], [0.0, 0.0, force / mass * t]));
    for (point, t) in grid.times().iter().enumerate() {
        table.set(StateField::Work, point, [force * force / mass * 0.5 * t * t, 0.0]);
        table.set(StateField::Impulse, point, [0.0, 0.0, force * t]);
    }
    table.pad();
    let all = request(Groups::ALL, false, true);
    let balanced = row(Isa::best(), all, &grid, &scene, &table);
    close(balanced["work_thrusters_final_j"], force * force / mass * 12.5, ROUNDING);
    assert_eq!(balanced["work_motors_final_j"], 0.0);
    assert!(balanced["energy_error_max"] <= ROUNDING && balanced["linear_momentum_error_max"] <= ROUNDING);
    close(balanced["linear_momentum_max_n_s"], force * 5.0, ROUNDING);
    table.column_mut(StateField::Work, 0).fill(0.0);
    table.column_mut(StateField::Impulse, 2).fill(0.0);
    let open = row(Isa::best(), all, &grid, &scene, &table);
    close(open["energy_error_max"], 1.0, ROUNDING);
    close(open["linear_momentum_error_final"], 1.0, ROUNDING);
    // |error| / scale = t / 5 s, a line
    close(open["linear_momentum_error_rate_per_s"], 0.2, ROUNDING);
}
