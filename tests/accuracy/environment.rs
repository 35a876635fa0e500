//! A constant torque of the environment in closed form, by every method.

use crate::prelude::*;

/// Methods with their largest relative distances. Measured: 6.6e-15, 6.6e-15, 5.8e-13, 1.1e-11, 5.5e-15, 1.1e-8,
/// 5.9e-11.
const METHODS: [(Method, Control, f64); 7] = [
    (Method::Auto, adaptive(1e-16), 5e-14),
    (Method::Taylor, adaptive(1e-16), 5e-14),
    (DOP853, adaptive(1e-13), 5e-12),
    (DORMAND_PRINCE, adaptive(1e-12), 1e-10),
    (GAUSS_LEGENDRE, fixed(1e-3), 5e-14),
    (RUNGE_KUTTA, fixed(1e-3), 1e-7),
    (Method::NullSpace, adaptive(1e-11), 5e-10),
];

fn off<const K: usize>(run: &Run, field: StateField, point: usize, expected: [f64; K]) -> f64 {
    let found = run.table.at::<K>(field, point);
    let size = expected.iter().map(|x| x * x).sum::<f64>().sqrt().max(1.0);
    found.iter().zip(expected).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt() / size
}

/// Law: a torque about the axis of an axisymmetric body makes its rate grow by tau t/J.
#[test]
fn an_axisymmetric_body_spins_up() {
    let (rate, torque) = (0.5, 40.0);
    let mut input = SceneInput::default();
    input.initial.angular_velocity_rad_s = [0.0, 0.0, rate];
    input.environment.body_torque_n_m = Some([0.0, 0.0, torque]);
    let scene = resolved(&input);
    let moment = scene.mass.inertia[2][2];
    let grid = Grid::uniform(12.0, 25);
    for (method, control, bound) in METHODS {
        let run = propagate_one(method, control, &grid, &scene);
        let mut worst = 0.0_f64;
        for (point, time) in grid.times().iter().enumerate() {
            let spun = rate + torque * time / moment;
            let (sin, cos) = libm::sincos(0.5 * (rate * time + 0.5 * torque * time * time / moment));
            let work = 0.5 * moment * (spun * spun - rate * rate);
            let sign = if run.table.at::<4>(StateField::Attitude, point)[0] * cos < 0.0 { -1.0 } else { 1.0 };
            let errors = [
                off(&run, StateField::Rate, point, [0.0, 0.0, spun]),
                off(&run, StateField::Attitude, point, [sign * cos, 0.0, 0.0, sign * sin]),
                off(&run, StateField::Work, point, [work, 0.0]),
                off(&run, StateField::AngularImpulse, point, [0.0, 0.0, torque * time]),
                off(&run, StateField::Impulse, point, [0.0; 3]),
            ];
            assert!(errors.iter().all(|error| *error <= bound), "{} at {time} s: {errors:?}", method.name());
            worst = errors.into_iter().fold(worst, f64::max);
        }
    }
}
