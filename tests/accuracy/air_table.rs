//! A table of the air: Vallado's again, one exponential, and layers that an orbit crosses.

use crate::support::{exact::distance, orbits::in_thin_air, prelude::*};
use spindrift::dynamics::environment::air::AirTable;

fn methods() -> impl Iterator<Item = Method> {
    let model = ForceModel::of(&in_thin_air(1, 3)[0]);
    Method::ALL.into_iter().filter(move |method| method.integrates(model) && !method.has_fixed_step())
}

fn in_air(scenes: &[Scene], environment: impl Fn(&mut EnvironmentInput)) -> Vec<Scene> {
    let changed = |mut scene: Scene| {
        environment(&mut scene.environment);
        scene
    };
    scenes.iter().cloned().map(changed).collect()
}

#[test]
fn the_same_table_gives_the_same_bits() {
    let grid = Grid::uniform(6_000.0, 31);
    let built_in = in_thin_air(8, 17);
    let own = in_air(&built_in, |environment| {
        environment.air_heights_m = Some(AirTable::VALLADO.heights);
        environment.air_densities_kg_m3 = Some(AirTable::VALLADO.densities);
    });
    let mixed: Vec<Scene> =
        built_in.iter().zip(&own).enumerate().map(|(k, (a, b))| if k % 2 == 0 { a } else { b }.clone()).collect();
    let double = in_air(&built_in, |environment| {
        environment.air_heights_m = Some(&[0.0, 7e5]);
        environment.air_densities_kg_m3 = Some(&[1e-3, 1e-15]);
    });
    for method in methods() {
        let runs = [&built_in, &own, &mixed, &double].map(|scenes| {
            propagate(method, adaptive(1e-10), &grid, scenes).iter().map(|run| run.bits()).collect::<Vec<_>>()
        });
        assert!(runs[0] == runs[1] && runs[0] == runs[2], "{}", method.name());
        assert!(runs[0].iter().zip(&runs[3]).all(|(a, b)| a != b), "{}: the table does nothing", method.name());
    }
}

#[test]
fn a_table_of_one_exponential_is_that_atmosphere() {
    let grid = Grid::uniform(6_000.0, 31);
    let (base, scale) = (4e5, 5.5e4);
    let density = |height: f64| 4e-12 * ((base - height) / scale).exp();
    let scenes = in_thin_air(8, 19);
    let keys = in_air(&scenes, |environment| {
        environment.base_density_kg_m3 = Some(4e-12);
        environment.base_height_m = Some(base);
        environment.scale_height_m = Some(scale);
    });
    let kept = |heights: &[f64]| -> [&'static [f64]; 2] {
        let densities = heights.iter().map(|height| density(*height)).collect();
        [Vec::leak(heights.to_vec()), Vec::leak(densities)]
    };
    for heights in [vec![1e5, 9e5], vec![4.2e5, 4.4e5], (0..40).map(|k| 2e5 + 1e4 * f64::from(k)).collect()] {
        let [heights, densities] = kept(&heights);
        let table = in_air(&scenes, |environment| {
            environment.air_heights_m = Some(heights);
            environment.air_densities_kg_m3 = Some(densities);
        });
        for method in methods() {
            let run = |scenes: &[Scene]| propagate(method, adaptive(1e-13), &grid, scenes);
            let mut worst = 0.0_f64;
            for (a, b) in run(&keys).iter().zip(run(&table)) {
                for component in 0..4 {
                    for point in 0..grid.points() {
                        let at =
                            |run: &crate::support::runs::Run| run.table.column(StateField::Attitude, component)[point];
                        worst = worst.max((at(a) - at(&b)).abs());
                    }
                }
            }
            assert!(worst < 1e-10, "{}, {} heights: {worst:e}", method.name(), heights.len());
        }
    }
}

/// Law: every method finds the reference solution where layers of different scale heights meet.
#[test]
fn every_method_crosses_the_layers() {
    let grid = Grid::uniform(6_000.0, 31);
    let scenes = in_air(&in_thin_air(3, 23), |environment| {
        environment.air_heights_m = Some(&[3.9e5, 4.3e5, 4.5e5, 4.6e5, 4.9e5]);
        environment.air_densities_kg_m3 = Some(&[9e-12, 2e-12, 1.9e-12, 6e-13, 5e-13]);
    });
    let fields = rotational();
    for scene in &scenes {
        let reference = solved(scene, &grid, fields);
        for method in methods() {
            let run = propagate_one(method, adaptive(1e-12), &grid, scene);
            let [omega, attitude] = distance(&run.table, &grid, &reference);
            assert!(omega < 1e-9 && attitude < 1e-9, "{}: {omega:e}, {attitude:e} rad", method.name());
        }
    }
}
