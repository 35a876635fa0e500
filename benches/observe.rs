//! Observation of one run: every group without debris at 101 points, and the energies about the centre of mass alone.

use criterion::{Criterion, criterion_group, criterion_main};
use spindrift::dynamics::outcome::{Effort, Outcome, Status};
use spindrift::dynamics::table::{Block, Grid, StateTable};
use spindrift::math::Isa;
use spindrift::observables::{Group, Groups, Observer, Request};
use spindrift::scene::{FuselageInput, InitialInput, Scene, SceneInput, WheelInput};

fn scene() -> Scene {
    let wheel = |station_m| WheelInput { radius_m: 0.25, length_m: 0.1, station_m, density_kg_m3: 2700.0 };
    let input = SceneInput {
        fuselage: FuselageInput {
            wall_thickness_m: 0.03,
            outer_radius_m: 1.0,
            length_m: 3.0,
            density_kg_m3: 2700.0,
            thruster_offset_m: 0.5,
            mass_kg: None,
            center_of_mass_m: None,
            inertia_kg_m2: None,
        },
        wheels: [Some(wheel(1.0)), Some(wheel(2.0))],
        debris: None,
        initial: InitialInput {
            position_m: [0.0; 3],
            velocity_m_s: [10.0, 0.0, 0.0],
            attitude: [1.0, 0.0, 0.0, 0.0],
            angular_velocity_rad_s: [0.0, 3.0, 31.0],
            wheel_angles_rad: [0.0; 2],
            wheel_rates_rad_s: [314.0, 157.0],
            debris_position_m: [0.0; 3],
            debris_velocity_m_s: [0.0; 3],
            debris_attitude: [1.0, 0.0, 0.0, 0.0],
            debris_relative_angular_velocity_rad_s: [0.0; 3],
        },
        actuation: Vec::new(),
    };
    Scene::resolve(&input).expect("the report's scene is physical")
}

fn observe(criterion: &mut Criterion) {
    let scene = scene();
    let grid = Grid::uniform(10.0, 101);
    let com = Groups::NONE.with(Group::EnergiesCom);
    for (name, groups) in [("all", Groups::ALL), ("com", com), ("com_exchange", com.with(Group::Exchange))] {
        let request = Request { groups, debris: false, actuated: false, constrained: false };
        let mut table = StateTable::new(request.blocks(), grid.points());
        for (point, t) in grid.times().iter().enumerate() {
            let (s, c) = (libm::sin(3.0 * t), libm::cos(3.0 * t));
            table.set(Block::Rate, point, [3.0 * s, 3.0 * c, 31.0]);
            table.set(Block::WheelRates, point, [314.0 - 3.0 * c, 157.0]);
            if table.has(Block::Attitude) {
                table.set(Block::Attitude, point, [c, 0.0, 0.6 * s, 0.8 * s]);
                table.set(Block::ComVelocity, point, [10.0, -4.0, 0.0]);
            }
        }
        table.pad();
        let outcome = Outcome { status: Status::Done, time: 10.0, points: 101, effort: Effort::default() };
        let mut observer = Observer::new(request, &grid);
        let mut row = vec![0.0; request.columns().len()];
        for isa in Isa::available().into_iter().filter(|isa| isa.name() != "plain") {
            criterion.bench_function(&format!("observe/{name}/{}", isa.name()), |bencher| {
                bencher.iter(|| observer.observe(isa, &scene, &table, &outcome, std::hint::black_box(&mut row)));
            });
        }
    }
}

criterion_group!(benches, observe);
criterion_main!(benches);
