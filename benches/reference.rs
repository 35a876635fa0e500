//! Time of one right-hand side of the reference kernel (62 states and 10 integrals), on each instruction set of this machine.
//!
//! `cargo bench --bench reference`

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use fearless_simd::Simd;
use spindrift::dynamics::reference::{COMPONENTS, Kernel, SignOfANon, sigma};
use spindrift::math::Isa;
use spindrift::math::isa::Work;
use spindrift::scene::{DebrisInput, DebrisShape, FuselageInput, InitialInput, Scene, SceneInput, WheelInput};

/// Evaluations per measurement: a chain, each from the last, as in an integration.
const EVALUATIONS: usize = 1000;

struct Chain<'a> {
    kernel: &'a Kernel,
    state: [f64; COMPONENTS],
}

impl Work for Chain<'_> {
    type Output = [f64; COMPONENTS];
    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> [f64; COMPONENTS] {
        let mut x = self.state;
        for _ in 0..EVALUATIONS {
            let f = self.kernel.derivative(&x);
            x = std::array::from_fn(|i| x[i] + 1e-9 * f[i]);
        }
        x
    }
}

/// Tables I and II of the report.
fn report_scene() -> Scene {
    let wheel = |station_m| Some(WheelInput { radius_m: 0.25, length_m: 0.1, station_m, density_kg_m3: 2700.0 });
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
        wheels: [wheel(1.0), wheel(2.0)],
        debris: Some(DebrisInput { shape: DebrisShape::Cube { side_m: 0.2 }, density_kg_m3: 2700.0 }),
        initial: InitialInput {
            position_m: [0.0; 3],
            velocity_m_s: [10.0, 0.0, 0.0],
            attitude: [1.0, 0.0, 0.0, 0.0],
            angular_velocity_rad_s: [0.0, 3.141592653589793, 31.41592653589793],
            wheel_angles_rad: [0.0; 2],
            wheel_rates_rad_s: [314.1592653589793, 157.07963267948966],
            debris_position_m: [0.0; 3],
            debris_velocity_m_s: [10.0, 0.0, 0.0],
            debris_attitude: [1.0, 0.0, 0.0, 0.0],
            debris_relative_angular_velocity_rad_s: [100.0, 0.0, 0.0],
        },
        actuation: Vec::new(),
    };
    Scene::resolve(&input).expect("the report's scene is physical")
}

fn right_hand_side(criterion: &mut Criterion) {
    let scene = report_scene();
    let kernel = Kernel::new(&scene, SignOfANon::Corrected);
    let mut group = criterion.benchmark_group("reference/right-hand side");
    group.throughput(criterion::Throughput::Elements(EVALUATIONS as u64));
    for isa in Isa::available() {
        group.bench_function(isa.name(), |bencher| {
            bencher
                .iter(|| black_box(isa.run(Chain { kernel: &kernel, state: black_box(sigma(&scene).components()) })));
        });
    }
    group.finish();
}

criterion_group!(benches, right_hand_side);
criterion_main!(benches);
