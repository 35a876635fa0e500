//! Any number of wheels, anywhere, about any axis, in any mode, with up to sixteen thrusters.

use crate::prelude::*;
use rayon::prelude::*;

use crate::support::{
    runs::{base_point, relative_field},
    scenes::COUNTS,
};
use spindrift::scene::Arc;

const HORIZON: f64 = 1.0;
const TOLERANCE: f64 = 1e-11;
const TAYLOR_TOLERANCE: f64 = 1e-16;

/// Rounding of a Taylor step per radian: coefficients and constants, a few ulps.
const TAYLOR_ROUNDING: f64 = 4.0 * f64::EPSILON;

const SCENES: u64 = 200;
const POINTS: usize = 9;

/// Every method, its tolerance or step, and the bound of its balances. Measured: 1.3e-15 by the Taylor methods, 2e-11
/// Dormand-Prince, 1.9e-10 DOP853 and Runge-Kutta 4, 1.1e-10 Gauss-Legendre, 3e-11 null-space.
const METHODS: [(Method, Control, f64); 7] = [
    (Method::Auto, adaptive(TAYLOR_TOLERANCE), 1e-14),
    (Method::Taylor, adaptive(TAYLOR_TOLERANCE), 1e-14),
    (DORMAND_PRINCE, adaptive(TOLERANCE), 2e-10),
    (DOP853, adaptive(TOLERANCE), 1.5e-9),
    (RUNGE_KUTTA, fixed(1e-3), 1.5e-9),
    (GAUSS_LEGENDRE, fixed(1e-2), 1e-9),
    (Method::NullSpace, adaptive(TOLERANCE), 3e-10),
];

fn input(k: u64) -> SceneInput {
    let turn = COUNTS.len() as u64;
    let mut input = many_wheels(COUNTS[(k % turn) as usize], k, (k / turn) % 2 == 1, HORIZON);
    input.debris = match k % 5 {
        1 | 2 => Some(DebrisInput::Cube { side_m: 0.3, density_kg_m3: 2000.0 }),
        3 | 4 => Some(DebrisInput::Box { size_m: [0.1, 0.3, 0.5], density_kg_m3: 2000.0 }),
        _ => None,
    };
    if k.is_multiple_of(4) {
        input.environment.body_torque_n_m = Some([30.0, -20.0, 10.0]);
    }
    input
}

fn angle(scene: &Scene) -> f64 {
    let initial = &scene.initial;
    let wheels = initial.wheel_rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
    HORIZON * norm(initial.omega_se_s).max(norm(initial.omega_de_d)).max(wheels)
}

/// The largest, J, of the terms whose difference the error of the work is, at least one.
fn work_scale(scene: &Scene, expected: &StateTable) -> f64 {
    let points = 0..expected.points();
    let omega = points.clone().map(|point| norm(expected.at::<3>(StateField::Rate, point))).fold(0.0, f64::max);
    let terms = scene.mass.wheels.iter().zip(scene.initial.wheel_rates).enumerate().map(|(index, (wheel, rate))| {
        if wheel.mode == WheelMode::SpeedHeld {
            return (wheel.axial * rate).abs() * omega;
        }
        let rates = expected.column(StateField::WheelRates, index);
        let fastest = rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs())) + omega;
        let on = |arc: &Arc| arc.applied.motor_torque[index].abs() * (arc.end() - arc.start);
        scene.schedule.iter().map(on).sum::<f64>() * fastest
    });
    let pushed = scene.environment.body_torque_n_m.map_or(0.0, |torque| norm(torque) * omega * HORIZON);
    terms.chain([pushed]).fold(1.0, f64::max)
}

fn distance(scene: &Scene, found: &StateTable, expected: &StateTable) -> (f64, &'static str) {
    let mut worst = (0.0, "nothing");
    let mut take = |error: f64, what| {
        if error > worst.0 {
            worst = (error, what);
        }
    };
    for point in 0..expected.points() {
        macro_rules! compare {
            ($block:ident, $width:literal) => {
                let error =
                    relative::<$width>(found.at(StateField::$block, point), expected.at(StateField::$block, point));
                take(error, stringify!($block));
            };
        }
        compare!(Rate, 3);
        take(relative_field(found, expected, StateField::WheelRates, point), "WheelRates");
        take(relative_field(found, expected, StateField::WheelAngles, point), "WheelAngles");
        compare!(ComPosition, 3);
        compare!(ComVelocity, 3);
        let (work, exact) = (found.at::<2>(StateField::Work, point), expected.at::<2>(StateField::Work, point));
        let scale = work_scale(scene, expected);
        take(relative(work.map(|x| x / scale), exact.map(|x| x / scale)), "Work");
        compare!(Impulse, 3);
        compare!(AngularImpulse, 3);
        take(up_to_sign(found.at(StateField::Attitude, point), expected.at(StateField::Attitude, point)), "Attitude");
        let (here, there) = (base_point(scene, found, point), base_point(scene, expected, point));
        take(relative(here[0], there[0]).max(relative(here[1], there[1])), "base point");
        if scene.mass.debris.is_some() {
            compare!(DebrisPosition, 3);
            compare!(DebrisVelocity, 3);
            compare!(DebrisRate, 3);
            let q =
                up_to_sign(found.at(StateField::DebrisAttitude, point), expected.at(StateField::DebrisAttitude, point));
            take(q, "DebrisAttitude");
        }
    }
    worst
}

fn bound(scene: &Scene, method: Method, outcome: &Outcome) -> f64 {
    let steps = outcome.effort.steps as f64 * TOLERANCE;
    let local = match method {
        Method::Auto | Method::Taylor => TAYLOR_ROUNDING,
        Method::NullSpace => 0.015 * steps,
        Method::Gyrostat(Integrator::RungeKutta4 | Integrator::GaussLegendre) => 0.05 * steps,
        Method::Gyrostat(_) => steps,
    };
    local * (1.0 + angle(scene))
}

fn truth(scene: &Scene, grid: &Grid) -> ReferenceSolution {
    solved(scene, grid, everything(Method::Taylor))
}

fn run(scene: &Scene, grid: &Grid, method: Method, control: Control) -> Run {
    done(method, control, grid, everything(method), scene)
}

fn balances(input: &SceneInput, scene: &Scene, grid: &Grid, method: Method, run: &Run) -> [f64; 3] {
    let request = Request {
        actuated: Actuated::of(input),
        wheels: input.turning_wheels(),
        ..request(Groups::ALL, 0, input.debris.is_some(), false, method == Method::NullSpace)
    };
    let (row, _) = observed(Isa::best(), request, grid, scene, (&run.table, &run.outcome), None);
    let linear = row.get("linear_momentum_error_max").copied().unwrap_or(0.0);
    [row["energy_error_max"], linear, row["angular_momentum_error_max"]]
}

#[derive(Clone, Copy)]
struct Off {
    method: usize,
    state: f64,
    what: &'static str,
    balance: f64,
}

fn offs(k: u64) -> Vec<Off> {
    let grid = Grid::uniform(HORIZON, POINTS);
    let input = input(k);
    let scene = resolved(&input);
    let truth = truth(&scene, &grid);
    let turning = input.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked).count();
    assert_eq!(scene.mass.wheels.len(), turning);
    let off = |(method, (kernel, control, balance)): (usize, (Method, Control, f64))| {
        let run = run(&scene, &grid, kernel, control);
        for field in [StateField::WheelRates, StateField::WheelAngles] {
            assert_eq!(run.table.width(field), turning, "no columns of what is not there");
        }
        let (error, what) = distance(&scene, &run.table, &truth.high);
        let worst = balances(&input, &scene, &grid, kernel, &run).into_iter().fold(0.0, f64::max);
        Off { method, state: error / bound(&scene, kernel, &run.outcome), what, balance: worst / balance }
    };
    METHODS.into_iter().enumerate().map(off).collect()
}

#[test]
fn every_kernel_and_method_agrees_with_the_double_double_solution() {
    let all: Vec<(u64, Vec<Off>)> = (0..SCENES).into_par_iter().map(|k| (k, offs(k))).collect();
    let mut wrong = Vec::new();
    for (method, (kernel, ..)) in METHODS.into_iter().enumerate() {
        let mut worst = [0.0_f64; 2];
        for (k, offs) in &all {
            let Off { state, what, balance, .. } = offs[method];
            assert_eq!(offs[method].method, method);
            worst = [worst[0].max(state), worst[1].max(balance)];
            if !(state <= 1.0 && balance <= 1.0) {
                wrong.push(format!("{}, scene {k}: {what} {state:.2e}, balances {balance:.2e}", kernel.name()));
            }
        }
    }
    assert!(wrong.is_empty(), "of their bounds:\n{}", wrong.join("\n"));
}
