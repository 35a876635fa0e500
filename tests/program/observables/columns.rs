//! Columns of a row: skipped groups, padding and the instruction set change no bit of others.

use crate::{
    observables::observed_tables::{
        Motion, done, free_row, golden_table, motion_table, observation, request, rotation, row, table1,
    },
    prelude::*,
};
use spindrift::{observables::Column, scene::Orbit};

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
            assert_eq!(free_row(&grid, &scene, &dirty)[&name].to_bits(), value.to_bits(), "{name}");
        }
    }
}

/// Law: the fraction is the swing over the largest total about c; net is the last minus the first value.
#[test]
fn fraction_and_net_are_relative_to_the_right_points() {
    let (_, mut scene) = table1();
    scene.mass.debris = None;
    let grid = Grid::uniform(6.0, 61);
    let spin = |t: f64| 3.0 - 1.5 * libm::sin(t);
    let table =
        motion_table(&grid, &|t| (rotation([0.0, 0.0, 1.0], t), [0.0, 0.0, spin(t)], [10.0, 20.0 + t], [0.0; 3]));
    let request = request(Groups::ALL, false, true);
    let (row, observer) = observation(Isa::best(), request, &grid, &scene, &table);
    let series = |of: Series| -> Vec<f64> { observer.series().find(|(series, _)| *series == of).unwrap().1.collect() };
    let total = series(Series::ComTotal);
    let largest = total.iter().copied().fold(0.0, f64::max);
    // measured: 2.2
    assert!(largest > 1.5 * total[0], "a denominator of the initial total would be noticed");
    let wheel = |index| Series::ComWheel.of_wheel(index);
    for (of, body) in [(Series::ComBody, "body"), (wheel(0), "w1"), (wheel(1), "w2"), (Series::ComWheels, "wheels")] {
        let energy = series(of);
        let smallest = energy.iter().copied().fold(f64::INFINITY, f64::min);
        let swing = energy.iter().copied().fold(f64::NEG_INFINITY, f64::max) - smallest;
        assert!(energy[0] > smallest && energy[0] != energy[60], "{body}: {energy:?}");
        assert_eq!(row[format!("exchange_{body}_fraction").as_str()], swing / largest, "{body}");
        assert_eq!(row[format!("exchange_{body}_net_j").as_str()], energy[60] - energy[0], "{body}");
        assert_eq!(row[format!("exchange_{body}_peak_to_peak_j").as_str()], swing, "{body}");
    }
}

#[test]
fn every_column_of_every_kind_of_scene_has_a_value() {
    let (_, mut scene) = table1();
    let epoch = Epoch::parse("2026-11-24T00:00:00Z");
    scene.environment.magnetic_field = Some(FieldModel::Dipole);
    scene.environment.magnetic_dipole_a_m2 = Some([1.0, 2.0, 3.0]);
    let orbit =
        Orbit { mu: 1.0, position: [1.0, 2.0, 3.0], velocity: [0.1, 0.0, 0.0], body_radius: 0.0, j2: None, epoch };
    scene.orbit = Some(orbit);
    (scene.environment.drag, scene.environment.solar_pressure) = (true, true);
    let effects = Effect::ALL.into_iter().fold(ForceModel::NONE, ForceModel::with);
    let grid = Grid::uniform(10.0, 101);
    let every_field = StateField::ALL.into_iter().fold(StateFields::NONE, StateFields::with);
    let mut table = StateTable::new(every_field, 2, grid.points());
    for (point, time) in grid.times().iter().enumerate() {
        let q = rotation([0.0, 0.6, 0.8], 3.0 * time);
        let c = dcm_from_quaternion(q);
        table.set(StateField::Attitude, point, q);
        table.set::<9>(StateField::Dcm, point, from_fn(|k| c[k % 3][k / 3]));
        table.set(StateField::Rate, point, [0.1, 1.8, 2.4 + 0.1 * libm::sin(*time)]);
        table.set(StateField::WheelRates, point, [40.0 + time, 50.0]);
        table.set(StateField::ComVelocity, point, [1.0, 2.0, 3.0 + 0.1 * time]);
        table.set(StateField::ComPosition, point, [1.0, 2.0, 3.0 + 0.1 * time]);
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
            let request = Request { constrained, effects, ..request(groups, debris, actuated) };
            for (name, value) in row(Isa::best(), request, &grid, &scene, &table) {
                assert!(value.is_finite(), "{name} of {request:?} is {value}");
                seen.insert(name);
            }
        }
    }
    let of_two = |column: &Column| if column.is_of_wheel() { 2 } else { 1 };
    let count: usize = spindrift::observables::table::all().map(of_two).sum();
    assert_eq!(seen.len(), count, "every column is of some kind of scene");
}

#[test]
fn a_failed_run_has_its_effort_and_its_last_finite_state() {
    let (golden, scene) = table1();
    let (grid, mut table) = golden_table(&golden, &scene);
    let request = request(Groups::ALL, true, false);
    let mut observer = Observer::new(request, &grid);
    let columns = request.columns();
    let mut row = vec![0.0; columns.len()];
    observer.observe(Isa::best(), &scene, &table, &done(grid.points(), grid.duration()), &mut row);
    table.set(StateField::Rate, 3, [f64::NAN; 3]);
    let effort = StepStatistics { steps: 7, rejected: 1, evaluations: 50 };
    let failed = Outcome { status: Status::NonFinite, effort, ..done(4, 1.5) };
    observer.observe(Isa::best(), &scene, &table, &failed, &mut row);
    let truth = &golden.truth[2];
    for (column, value) in columns.iter().zip(&row) {
        match column.quantity.name() {
            "time_reached_s" => assert_eq!(*value, 1.5),
            "time_final_s" => assert_eq!(*value, truth.time),
            "omega_se_s_y_final_rad_s" => assert_eq!(*value, truth.omega_se_s[1]),
            "steps" => assert_eq!(*value, 7.0),
            name => {
                let is_known =
                    matches!(column.group, Group::FinalState | Group::StepStatistics | Group::MassProperties);
                assert_eq!(value.is_finite(), is_known, "{name}");
            }
        }
    }
    let effort = StepStatistics::default();
    let invalid = Outcome { status: Status::InvalidSample, effort, ..done(0, 0.0) };
    observer.observe(Isa::best(), &scene, &table, &invalid, &mut row);
    for (column, value) in columns.iter().zip(&row) {
        let is_known = matches!(column.group, Group::StepStatistics | Group::MassProperties);
        let known = is_known || column.quantity.name() == "time_reached_s";
        assert_eq!(value.is_finite(), known, "{}", column.quantity.name());
    }
    for (series, values) in observer.series() {
        assert_eq!(values.len(), 0, "{series:?}");
    }
}
