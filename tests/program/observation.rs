//! Observables of motions that are known without integration.
//!
//! Laws: energies and momenta of golden truth (25 digits) are those of the equations, point by point, and are conserved to
//! rounding; closed-form motions give their closed-form numbers; skipped groups change no bit of the others; every
//! instruction set gives the same bits. Counter-tests: a small change of one state or one inertia is seen in the errors.

use std::collections::HashMap;

use crate::support::golden::Golden;
use spindrift::math::Isa;
use spindrift::math::vector::{cross, dcm_from_quaternion, hamilton, product, sum};
use spindrift::observables::nominal_attitude::NominalAttitude;
use spindrift::observables::{Group, Groups, Observer, Request, Series};
use spindrift::run::{Grid, StateField, StateFields, StateTable};
use spindrift::run::{LocalErrors, Outcome, Status, StepStatistics};
use spindrift::scene::Scene;

/// Energies and momenta of states that are rounded to f64: a few roundings of the state, doubled by squares, and some dozens of
/// operations.
const ROUNDING: f64 = 2e-14;

/// A state that is written to a table: (time; q_es, omega, wheel rates, v_c).
type Motion<'a> = &'a dyn Fn(f64) -> ([f64; 4], [f64; 3], [f64; 2], [f64; 3]);

fn table1() -> (Golden, Scene) {
    let golden = Golden::load("table1");
    let scene = Scene::resolve(&golden.scene).expect("the report's scene");
    (golden, scene)
}

fn request(groups: Groups, debris: bool, actuated: bool) -> Request {
    Request { groups, debris, actuated, constrained: false }
}

fn done(points: usize, time: f64) -> Outcome {
    let effort = StepStatistics { steps: 12, rejected: 3, evaluations: 91 };
    Outcome { status: Status::Done, time, points, effort, local_errors: LocalErrors::default() }
}

/// Every field except those of constraints, so that one table serves every request.
fn everything() -> StateFields {
    StateField::ALL
        .into_iter()
        .filter(|block| !matches!(block, StateField::Dcm | StateField::Residuals | StateField::KineticEnergies))
        .fold(StateFields::NONE, StateFields::with)
}

fn golden_table(golden: &Golden, scene: &Scene) -> (Grid, StateTable) {
    let grid = Grid::at(golden.times());
    let mut table = StateTable::new(everything(), 2, grid.points());
    for (point, truth) in golden.truth.iter().enumerate() {
        let turning = product(dcm_from_quaternion(truth.q_es), cross(truth.omega_se_s, scene.mass.center));
        table.set(StateField::Rate, point, truth.omega_se_s);
        table.set(StateField::Attitude, point, truth.q_es);
        table.set(StateField::WheelRates, point, truth.wheel_rates);
        table.set(StateField::ComVelocity, point, sum(truth.v_po_e, turning));
        table.set(StateField::DebrisVelocity, point, truth.v_gdo_e);
        table.set(StateField::DebrisAttitude, point, truth.q_ed);
        table.set(StateField::DebrisRate, point, truth.omega_de_d);
    }
    table.pad();
    (grid, table)
}

/// A table of a motion in closed form; the debris rests.
fn motion_table(grid: &Grid, motion: Motion<'_>) -> StateTable {
    let mut table = StateTable::new(everything(), 2, grid.points());
    for (point, time) in grid.times().iter().enumerate() {
        let (q, omega, rates, v_c) = motion(*time);
        table.set(StateField::Attitude, point, q);
        table.set(StateField::Rate, point, omega);
        table.set(StateField::WheelRates, point, rates);
        table.set(StateField::ComVelocity, point, v_c);
        table.set(StateField::DebrisAttitude, point, [1.0, 0.0, 0.0, 0.0]);
    }
    table.pad();
    table
}

fn row(isa: Isa, request: Request, grid: &Grid, scene: &Scene, table: &StateTable) -> HashMap<&'static str, f64> {
    let has_attitude = table.has(StateField::Attitude);
    let nominal = has_attitude.then(|| NominalAttitude::of(table, &done(grid.points(), grid.duration())));
    let mut observer = Observer::new(request, grid).with_nominal(nominal);
    let columns = request.columns();
    let mut row = vec![0.0; columns.len()];
    observer.observe(isa, scene, table, &done(grid.points(), grid.duration()), &mut row);
    columns.iter().map(|column| column.quantity.name()).zip(row).collect()
}

fn free_row(grid: &Grid, scene: &Scene, table: &StateTable) -> HashMap<&'static str, f64> {
    row(Isa::best(), request(Groups::ALL, false, false), grid, scene, table)
}

#[track_caller]
fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} != {expected}");
}

/// A rotation by `angle` about the unit vector `axis`, as a quaternion.
fn rotation(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let s = libm::sin(0.5 * angle);
    [libm::cos(0.5 * angle), s * axis[0], s * axis[1], s * axis[2]]
}

#[test]
fn energies_at_time_zero_are_those_of_the_report() {
    let (golden, scene) = table1();
    let (grid, table) = golden_table(&golden, &scene);
    let row = row(Isa::best(), request(Groups::ALL, true, false), &grid, &scene, &table);
    for (name, energy) in [
        ("energy_fuselage_initial_j", 1060915.388498418),
        ("energy_wheel1_initial_j", 88406.50864294029),
        ("energy_wheel2_initial_j", 36464.21707185995),
        ("energy_debris_initial_j", 1871.7717632047218),
    ] {
        close(row[name], energy, 1e-15 * 4.0);
    }
    close(
        row["energy_total_initial_j"],
        1060915.388498418 + 88406.50864294029 + 36464.21707185995 + 1871.7717632047218,
        ROUNDING,
    );
}

#[test]
fn golden_truth_has_the_energies_of_the_equations_and_conserves() {
    for name in ["table1", "forced"] {
        let golden = Golden::load(name);
        let scene = Scene::resolve(&golden.scene).expect("a physical scene");
        let (grid, table) = golden_table(&golden, &scene);
        let request = request(Groups::ALL, true, false);
        let mut observer = Observer::new(request, &grid);
        let mut row = vec![0.0; request.columns().len()];
        observer.observe(Isa::best(), &scene, &table, &done(grid.points(), grid.duration()), &mut row);
        let value =
            |name: &str| row[request.columns().iter().position(|column| column.quantity.name() == name).unwrap()];
        let bodies = [Series::EnergyFuselage, Series::EnergyWheel1, Series::EnergyWheel2, Series::EnergyDebris];
        for (series, values) in observer.series() {
            let Some(body) = bodies.iter().position(|energy| *energy == series) else { continue };
            for (truth, found) in golden.truth.iter().zip(values) {
                close(found, truth.energies[body], ROUNDING);
            }
        }
        let l = golden.truth[0].momentum_c_e;
        close(value("angular_momentum_initial_n_m_s"), (l[0] * l[0] + l[1] * l[1] + l[2] * l[2]).sqrt(), ROUNDING);
        if name == "table1" {
            for error in ["energy_error", "linear_momentum_error", "angular_momentum_error", "energy_com_error"] {
                assert!(value(&format!("{error}_max")) <= ROUNDING, "{error} {}", value(&format!("{error}_max")));
            }
            assert!(value("debris_angular_momentum_error_max") <= ROUNDING);
            assert!(value("dcm_orthonormality_max") <= 1e-15);
        } else {
            // actuators work in this scene, and the request above does not count their work: the balance must not close
            assert!(value("energy_error_max") > 1e-4 && value("linear_momentum_error_max") > 1e-4);
        }
        assert!(value("exchange_frequency_hz").is_nan(), "an uneven grid has no frequency");
    }
}

#[test]
fn a_perturbed_state_or_inertia_shows_in_the_errors() {
    const OFF: f64 = 1e-9;
    let (golden, scene) = table1();
    let (grid, table) = golden_table(&golden, &scene);
    let all = request(Groups::ALL, true, false);
    let shows = |scene: &Scene, table: &StateTable, names: &[&str]| {
        let row = row(Isa::best(), all, &grid, scene, table);
        for name in names {
            assert!(row[name] > 10.0 * ROUNDING, "{name} {}", row[name]);
        }
    };
    for (block, names) in [
        (StateField::Rate, &["energy_error_max", "angular_momentum_error_max", "energy_com_error_max"][..]),
        (StateField::WheelRates, &["energy_error_max", "angular_momentum_error_max", "energy_com_error_max"]),
        (StateField::ComVelocity, &["linear_momentum_error_max"]),
        (StateField::Attitude, &["dcm_orthonormality_max", "angular_momentum_error_max"]),
        (StateField::DebrisRate, &["energy_error_max", "debris_angular_momentum_error_max"]),
        (StateField::DebrisAttitude, &["debris_angular_momentum_error_max"]),
        (StateField::DebrisVelocity, &["debris_linear_momentum_error_max"]),
    ] {
        let mut wrong = table.clone();
        for component in 0..table.width(block) {
            wrong.column_mut(block, component)[3] *= 1.0 + OFF * 100.0;
        }
        shows(&scene, &wrong, names);
    }
    let mut wrong = scene.clone();
    wrong.mass.fuselage.inertia[0][0] *= 1.0 + OFF;
    shows(&wrong, &table, &["energy_error_max"]);
    let mut wrong = scene.clone();
    wrong.mass.inertia[0][0] *= 1.0 + OFF;
    shows(&wrong, &table, &["angular_momentum_error_max"]);
}

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
    close(row["energy_com_wheel2_mean_j"], 0.5 * wheel2.axial * (spin + 50.0) * (spin + 50.0), ROUNDING);
    close(row["energy_com_fuselage_mean_j"], 0.5 * scene.mass.fuselage.inertia[2][2] * spin * spin, ROUNDING);
    close(row["linear_momentum_initial_n_s"], scene.mass.total * 14.0_f64.sqrt(), ROUNDING);
    for error in ["energy_error", "angular_momentum_error", "linear_momentum_error", "dcm_orthonormality"] {
        assert!(row[format!("{error}_max").as_str()] <= ROUNDING, "{error}");
        assert!(row[format!("{error}_rate_per_s").as_str()].abs() <= ROUNDING, "{error}");
    }
    for name in [
        "exchange_wheel1_correlation",
        "exchange_wheel2_correlation",
        "exchange_frequency_hz",
        "exchange_wheel1_gross_j",
    ] {
        assert_eq!(row[name], 0.0, "{name}");
    }
}

#[test]
fn wheels_alone_hold_energy_and_momentum() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let grid = Grid::uniform(1.0, 17);
    let table = motion_table(&grid, &|_| ([0.5, 0.5, -0.5, 0.5], [0.0; 3], [10.0, -20.0], [0.0; 3]));
    let row = free_row(&grid, &scene, &table);
    let [a, b] = [0, 1].map(|wheel| scene.mass.wheels[wheel].axial);
    close(row["energy_wheel1_final_j"], 0.5 * a * 100.0, ROUNDING);
    close(row["energy_com_wheel2_min_j"], 0.5 * b * 400.0, ROUNDING);
    assert_eq!(row["energy_fuselage_max_j"], 0.0);
    close(row["angular_momentum_max_n_m_s"], 10.0 * (a * a + 4.0 * b * b).sqrt(), ROUNDING);
    // at rest: |p| is zero everywhere, so that its error is absolute, and zero
    assert_eq!((row["linear_momentum_max_n_s"], row["linear_momentum_error_max"]), (0.0, 0.0));
}

/// Law: s3 of a torque-free axisymmetric body moves on a cone about L, so that its largest angle from the initial direction is
/// twice the nutation angle v, and after the time t it is 2 asin(sin v |sin(p t/2)|), p the rate of precession.
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
        let mut observer = Observer::new(request, &grid);
        let mut row = vec![0.0; request.columns().len()];
        observer.observe(Isa::best(), &scene, &table, &done(grid.points(), grid.duration()), &mut row);
        let value = |name: &str| {
            row[request.columns().iter().position(|column| column.quantity.name() == name).expect("a column")]
        };
        // a few roundings of the attitude
        let near = |found: f64, expected: f64| assert!((found - expected).abs() <= 4e-15, "{found:e} {expected:e}");
        near(value("spin_axis_angle_max_rad"), 2.0 * nutation);
        near(
            value("spin_axis_angle_final_rad"),
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
    scene.mass.fuselage.inertia[1][1] -= excess;
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
    assert!(row["angular_momentum_error_max"] <= 100.0 * ROUNDING, "{}", row["angular_momentum_error_max"]);
    close(row["angular_momentum_initial_n_m_s"], h, ROUNDING);
    // the fuselage differs from a symmetric body by what the wheels (fixed) add: its energy swings with cos(2 k t)
    let expected = nutation.abs() / std::f64::consts::PI;
    assert!(
        (row["exchange_frequency_hz"] - expected).abs() <= 0.05 / 30.0,
        "{} {expected}",
        row["exchange_frequency_hz"]
    );
    // what one gains the other loses, apart from the constant energy of the second wheel
    close(row["exchange_wheel1_correlation"], -1.0, 1e-6);
    let swing = row["exchange_fuselage_peak_to_peak_j"];
    let whole_swings = 2.0 * 30.0 * expected;
    close(row["exchange_fuselage_gross_j"], swing * whole_swings, 0.2);
    close(row["exchange_fuselage_power_max_w"], 0.5 * swing * 2.0 * nutation.abs(), 0.05);
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

#[test]
fn the_dcm_gives_the_attitude_where_the_method_integrates_it() {
    let (golden, scene) = table1();
    let (grid, table) = golden_table(&golden, &scene);
    let constrained = Request { constrained: true, ..request(Groups::ALL, true, false) };
    let mut with = StateTable::new(constrained.fields(), 2, grid.points());
    for block in StateField::ALL {
        if with.has(block) && table.has(block) {
            for component in 0..table.width(block) {
                with.column_mut(block, component).copy_from_slice(table.column(block, component));
            }
        }
    }
    for (point, truth) in golden.truth.iter().enumerate() {
        let c = dcm_from_quaternion(truth.q_es);
        with.set::<9>(StateField::Dcm, point, std::array::from_fn(|k| c[k % 3][k / 3]));
        with.set::<4>(StateField::KineticEnergies, point, truth.energies);
    }
    let good = row(Isa::best(), constrained, &grid, &scene, &with);
    let plain = row(Isa::best(), request(Groups::ALL, true, false), &grid, &scene, &table);
    for name in ["energy_wheel1_mean_j", "energy_fuselage_final_j"] {
        close(good[name], plain[name], ROUNDING);
    }
    assert!(good["dcm_orthonormality_max"] <= 2e-15 && good["angular_momentum_error_max"] <= ROUNDING);
    with.column_mut(StateField::Dcm, 5)[2] += 1e-9;
    // the energies of redundant states are the kernel's own: one joule too much in one of them is seen
    with.column_mut(StateField::KineticEnergies, 1)[3] += 1.0;
    let bad = row(Isa::best(), constrained, &grid, &scene, &with);
    assert!(good["energy_error_max"] <= ROUNDING && bad["energy_error_max"] > 1e-7);
    assert!(bad["dcm_orthonormality_max"] > 1e-11 && bad["angular_momentum_error_max"] > 10.0 * ROUNDING);
}

#[test]
fn padding_leaves_no_trace() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    for points in [9, 15, 101] {
        let grid = Grid::uniform(2.0, points);
        let motion: Motion<'_> =
            &|t| (rotation([0.6, 0.0, 0.8], t), [0.1 + t, 1.0 - t, t * t], [t, 2.0 * t], [t, 0.0, 1.0]);
        let clean = motion_table(&grid, motion);
        let mut dirty = clean.clone();
        for block in StateField::ALL.into_iter().filter(|block| clean.has(*block)) {
            for component in 0..clean.width(block) {
                dirty.column_mut(block, component)[points..].fill(f64::NAN);
            }
        }
        for (name, value) in free_row(&grid, &scene, &clean) {
            assert_eq!(free_row(&grid, &scene, &dirty)[name].to_bits(), value.to_bits(), "{name}");
        }
    }
}

#[test]
fn bits_depend_neither_on_the_instruction_set_nor_on_what_else_is_observed() {
    let (golden, scene) = table1();
    let (grid, table) = golden_table(&golden, &scene);
    for (debris, actuated) in [(false, false), (true, true)] {
        let reference = row(Isa::best(), request(Groups::ALL, debris, actuated), &grid, &scene, &table);
        for isa in Isa::available() {
            for groups in Group::ALL.map(|group| Groups::NONE.with(group)).into_iter().chain([Groups::ALL]) {
                let request = request(groups, debris, actuated);
                // a table with only the needed fields
                let mut lean = StateTable::new(request.fields(), 2, grid.points());
                for block in StateField::ALL.into_iter().filter(|block| request.fields().contains(*block)) {
                    for component in 0..table.width(block) {
                        lean.column_mut(block, component).copy_from_slice(table.column(block, component));
                    }
                }
                for (name, value) in row(isa, request, &grid, &scene, &lean) {
                    assert_eq!(value.to_bits(), reference[name].to_bits(), "{name} on {}", isa.name());
                }
            }
        }
    }
}

/// Law: the fraction is the swing over the largest total about the centre of mass, also where the total changes (under thrust), and
/// net is the last minus the first value, also where the first is not the smallest.
#[test]
fn fraction_and_net_are_relative_to_the_right_points() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let grid = Grid::uniform(6.0, 61);
    // the spin slows down, then grows beyond its initial value: first, smallest, last and largest differ
    let spin = |t: f64| 3.0 - 1.5 * libm::sin(t);
    let table =
        motion_table(&grid, &|t| (rotation([0.0, 0.0, 1.0], t), [0.0, 0.0, spin(t)], [10.0, 20.0 + t], [0.0; 3]));
    let request = request(Groups::ALL, false, true);
    let row = row(Isa::best(), request, &grid, &scene, &table);
    let mut observer = Observer::new(request, &grid);
    let mut ignored = vec![0.0; request.columns().len()];
    observer.observe(Isa::best(), &scene, &table, &done(grid.points(), grid.duration()), &mut ignored);
    let series = |of: Series| -> Vec<f64> { observer.series().find(|(series, _)| *series == of).unwrap().1.collect() };
    let total = series(Series::ComTotal);
    let largest = total.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1.5 * total[0], "a denominator of the initial total would be noticed");
    for (of, body) in [(Series::ComFuselage, "fuselage"), (Series::ComWheel1, "wheel1"), (Series::ComWheel2, "wheel2")]
    {
        let energy = series(of);
        let smallest = energy.iter().copied().fold(f64::INFINITY, f64::min);
        let swing = energy.iter().copied().fold(f64::NEG_INFINITY, f64::max) - smallest;
        assert!(energy[0] > smallest && energy[0] != energy[60], "{body}: {energy:?}");
        assert_eq!(row[format!("exchange_{body}_fraction").as_str()], swing / largest, "{body}");
        assert_eq!(row[format!("exchange_{body}_net_j").as_str()], energy[60] - energy[0], "{body}");
        assert_eq!(row[format!("exchange_{body}_peak_to_peak_j").as_str()], swing, "{body}");
    }
}

/// Law: every column of every kind of scene has a value, whether its group is observed alone or with all others.
#[test]
fn every_column_of_every_kind_of_scene_has_a_value() {
    let (_, scene) = table1();
    let grid = Grid::uniform(10.0, 101);
    let every_field = StateField::ALL.into_iter().fold(StateFields::NONE, StateFields::with);
    let mut table = StateTable::new(every_field, 2, grid.points());
    for (point, time) in grid.times().iter().enumerate() {
        let q = rotation([0.0, 0.6, 0.8], 3.0 * time);
        let c = dcm_from_quaternion(q);
        table.set(StateField::Attitude, point, q);
        table.set::<9>(StateField::Dcm, point, std::array::from_fn(|k| c[k % 3][k / 3]));
        table.set(StateField::Rate, point, [0.1, 1.8, 2.4 + 0.1 * libm::sin(*time)]);
        table.set(StateField::WheelRates, point, [40.0 + time, 50.0]);
        table.set(StateField::ComVelocity, point, [1.0, 2.0, 3.0 + 0.1 * time]);
        table.set(StateField::DebrisAttitude, point, rotation([1.0, 0.0, 0.0], *time));
        table.set(StateField::DebrisRate, point, [1.0, 0.0, 0.0]);
        table.set(StateField::DebrisVelocity, point, [1.0, 0.0, 0.0]);
    }
    table.pad();
    let mut seen = std::collections::HashSet::new();
    for kind in 0..8 {
        let [debris, actuated, constrained] = [kind & 1, kind & 2, kind & 4].map(|bit| bit != 0);
        let alone = Group::ALL.into_iter().map(|group| Groups::NONE.with(group));
        for groups in alone.chain([Groups::ALL]) {
            let request = Request { groups, debris, actuated, constrained };
            for (name, value) in row(Isa::best(), request, &grid, &scene, &table) {
                assert!(value.is_finite(), "{name} of {request:?} is {value}");
                seen.insert(name);
            }
        }
    }
    assert_eq!(seen.len(), spindrift::observables::table::all().count(), "every column is of some kind of scene");
}

#[test]
fn a_failed_run_has_its_effort_and_its_last_finite_state() {
    let (golden, scene) = table1();
    let (grid, mut table) = golden_table(&golden, &scene);
    let request = request(Groups::ALL, true, false);
    let mut observer = Observer::new(request, &grid);
    let columns = request.columns();
    let mut row = vec![0.0; columns.len()];
    // numbers of an earlier run remain in the table, and none of them may be used
    observer.observe(Isa::best(), &scene, &table, &done(grid.points(), grid.duration()), &mut row);
    table.set(StateField::Rate, 3, [f64::NAN; 3]);
    let failed = Outcome {
        status: Status::NonFinite,
        time: 1.5,
        points: 4,
        effort: StepStatistics { steps: 7, rejected: 1, evaluations: 50 },
        local_errors: LocalErrors::default(),
    };
    observer.observe(Isa::best(), &scene, &table, &failed, &mut row);
    let truth = &golden.truth[2];
    for (column, value) in columns.iter().zip(&row) {
        match column.quantity.name() {
            "time_reached_s" => assert_eq!(*value, 1.5),
            "time_final_s" => assert_eq!(*value, truth.time),
            "omega_se_s_y_final_rad_s" => assert_eq!(*value, truth.omega_se_s[1]),
            "steps" => assert_eq!(*value, 7.0),
            _ => assert_eq!(
                value.is_finite(),
                matches!(column.group, Group::FinalState | Group::StepStatistics),
                "{}",
                column.quantity.name()
            ),
        }
    }
    let invalid = Outcome {
        status: Status::InvalidSample,
        time: 0.0,
        points: 0,
        effort: StepStatistics::default(),
        local_errors: LocalErrors::default(),
    };
    observer.observe(Isa::best(), &scene, &table, &invalid, &mut row);
    for (column, value) in columns.iter().zip(&row) {
        let known = column.group == Group::StepStatistics || column.quantity.name() == "time_reached_s";
        assert_eq!(value.is_finite(), known, "{}", column.quantity.name());
    }
    assert!(observer.series().all(|(_, values)| values.len() == 0));
}
