//! Observables of golden truth (25 digits): its energies and momenta are those of the equations, point by point, and
//! are conserved to rounding. Counter-test: a small change of one state or one inertia is seen in the errors.

use crate::observables::observed_tables::{
    ROUNDING, close, golden_table, observation, request, request_of_balances, row, table1,
};
use crate::support::golden::Golden;
use spindrift::math::Isa;
use spindrift::math::vector::dcm_from_quaternion;
use spindrift::observables::{Groups, Request, Series};
use spindrift::run::{StateField, StateTable};
use spindrift::scene::Scene;

#[test]
fn golden_truth_has_the_energies_of_the_equations_and_conserves() {
    for name in ["table1", "forced"] {
        let golden = Golden::load(name);
        let scene = Scene::resolve(&golden.scene).expect("a physical scene");
        let (grid, table) = golden_table(&golden, &scene);
        let request = request(Groups::ALL, true, false);
        let (row, observer) = observation(Isa::best(), request, &grid, &scene, &table);
        let value = |name: &str| row[name];
        let bodies = [
            Series::EnergyBody,
            Series::EnergyWheel.of_wheel(0),
            Series::EnergyWheel.of_wheel(1),
            Series::EnergyDebris,
        ];
        for (series, values) in observer.series() {
            let Some(body) = bodies.iter().position(|energy| *energy == series) else { continue };
            for (truth, found) in golden.truth.iter().zip(values) {
                close(found, truth.energies[body], ROUNDING);
            }
        }
        let balances = self::row(Isa::best(), request_of_balances(true), &grid, &scene, &table);
        let l = golden.truth[0].momentum_c_e;
        close(value("angular_momentum_initial_n_m_s"), (l[0] * l[0] + l[1] * l[1] + l[2] * l[2]).sqrt(), ROUNDING);
        if name == "table1" {
            for error in ["energy_error", "angular_momentum_error", "energy_com_error"] {
                assert!(value(&format!("{error}_max")) <= ROUNDING, "{error} {}", value(&format!("{error}_max")));
            }
            assert!(value("debris_angular_momentum_error_max") <= ROUNDING);
            for error in ["linear_momentum_error_max", "debris_linear_momentum_error_max"] {
                assert!(balances[error] <= ROUNDING, "{error} {}", balances[error]);
            }
            // four ulps of sums of three squares; measured: 3.1e-16
            assert!(value("dcm_orthonormality_max") <= 1e-15);
        } else {
            // actuators work in this scene, and the request above does not count their work: the balance must not close
            assert!(value("energy_error_max") > 1e-4 && balances["linear_momentum_error_max"] > 1e-4);
        }
        assert!(value("exchange_frequency_hz").is_nan(), "an uneven grid has no frequency");
    }
}

#[test]
fn a_perturbed_state_or_inertia_shows_in_the_errors() {
    // a fault of an inertia; that of a state is a hundred times as large. Measured: 5100 times ROUNDING or more
    const OFF: f64 = 1e-9;
    let (golden, scene) = table1();
    let (grid, table) = golden_table(&golden, &scene);
    let shows = |scene: &Scene, table: &StateTable, names: &[&str]| {
        let mut row = self::row(Isa::best(), request_of_balances(true), &grid, scene, table);
        row.extend(self::row(Isa::best(), request(Groups::ALL, true, false), &grid, scene, table));
        for &name in names {
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
    wrong.mass.body.inertia[0][0] *= 1.0 + OFF;
    shows(&wrong, &table, &["energy_error_max"]);
    let mut wrong = scene.clone();
    wrong.mass.inertia[0][0] *= 1.0 + OFF;
    shows(&wrong, &table, &["angular_momentum_error_max"]);
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
    for name in ["energy_w1_mean_j", "energy_body_final_j"] {
        close(good[name], plain[name], ROUNDING);
    }
    // measured: 3.3e-16 and 1.7e-16
    assert!(good["dcm_orthonormality_max"] <= 2e-15 && good["angular_momentum_error_max"] <= ROUNDING);
    with.column_mut(StateField::Dcm, 5)[2] += 1e-9;
    // the energies of redundant states are the kernel's own: one joule too much in one of them is seen
    with.column_mut(StateField::KineticEnergies, 1)[3] += 1.0;
    let bad = row(Isa::best(), constrained, &grid, &scene, &with);
    // 1 J of 1.19 MJ is 8.4e-7; the entry of 1e-9 makes 9.4e-10 of orthonormality and 4700 times ROUNDING of momentum
    assert!(good["energy_error_max"] <= ROUNDING && bad["energy_error_max"] > 1e-7);
    assert!(bad["dcm_orthonormality_max"] > 1e-11 && bad["angular_momentum_error_max"] > 10.0 * ROUNDING);
}
