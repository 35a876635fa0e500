//! Angles, rates, speeds and momenta of motions in closed form.

use crate::prelude::*;

use crate::observables::observed_tables::{done, motion_table, request, rotation};

/// Roundings of numbers of size one.
const ROUNDING: f64 = 4e-15;

/// Attitude, omega, wheel rates, positions of c and of the debris.
type State = ([f64; 4], [f64; 3], [f64; 2], [f64; 3], [f64; 3]);

fn grid() -> Grid {
    Grid::uniform(2.0, 21)
}

fn table(motion: &dyn Fn(f64) -> State) -> StateTable {
    let grid = grid();
    let mut table = motion_table(&grid, &|t| {
        let (q, omega, rates, ..) = motion(t);
        (q, omega, rates, [0.0; 3])
    });
    for (point, time) in grid.times().iter().enumerate() {
        let (.., own, debris) = motion(*time);
        table.set(StateField::ComPosition, point, own);
        table.set(StateField::DebrisPosition, point, debris);
    }
    table.pad();
    table
}

fn outcome(points: usize) -> Outcome {
    done(points, 2.0)
}

fn row(scene: &Scene, nominal: Option<&NominalAttitude>, motion: &dyn Fn(f64) -> State) -> HashMap<String, f64> {
    let request = request(Groups::NONE.with(Group::Motion), true, false);
    let (table, outcome) = (table(motion), outcome(21));
    let on = |isa| observed(isa, request, &grid(), scene, (&table, &outcome), nominal.cloned()).0;
    let best = on(Isa::best());
    for isa in Isa::available() {
        for (name, value) in on(isa) {
            assert!(value.to_bits() == best[&name].to_bits(), "{name} on {}: {value:e}", isa.name());
        }
    }
    best
}

fn scene() -> Scene {
    resolved(&Golden::load("table1").scene)
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= ROUNDING * expected.abs().max(1.0), "{found:e} {expected:e}");
}

/// Law: s3 is at the angle atan2(|H across s3|, H along s3) from H, with extremes also where wheels change H.
#[test]
fn rates_nutation_and_wheels() {
    let mut scene = scene();
    scene.mass.inertia = [[200.0, 0.0, 0.0], [0.0, 200.0, 0.0], [0.0, 0.0, 50.0]];
    for (wheel, axis) in scene.mass.wheels.iter_mut().zip([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]) {
        (wheel.axis, wheel.axial) = (axis, 0.25);
    }
    let rates = |t: f64| [-40.0 + 10.0 * (t - 1.0).abs(), 100.0 - 30.0 * t];
    let motion = |t: f64| -> State {
        let omega = [0.3 * libm::cos(t), 0.0, 2.0];
        (rotation([0.6, 0.0, 0.8], t), omega, rates(t), [0.0; 3], [1.0, 0.0, 0.0])
    };
    let found = row(&scene, None, &motion);
    near(found["angular_rate_max_rad_s"], (0.09_f64 + 4.0).sqrt());
    near(found["angular_rate_final_rad_s"], ((0.3 * libm::cos(2.0)).powi(2) + 4.0).sqrt());
    near(found["attitude_from_initial_max_rad"], 2.0);
    near(found["attitude_from_initial_final_rad"], 2.0);
    near(found["speed_w1_max_rad_s"], 40.0);
    near(found["speed_w2_max_rad_s"], 100.0);
    near(found["momentum_w1_max_n_m_s"], 0.25 * 40.0);
    near(found["momentum_w2_max_n_m_s"], 0.25 * 102.0);
    let angles: Vec<f64> = grid()
        .times()
        .iter()
        .map(|t| {
            let [first, second] = rates(*t);
            libm::atan2(libm::hypot(200.0 * 0.3 * libm::cos(*t), 0.25 * first), 50.0 * 2.0 + 0.25 * second)
        })
        .collect();
    near(found["nutation_angle_max_rad"], angles.iter().copied().fold(0.0, f64::max));
    near(found["nutation_angle_min_rad"], angles.iter().copied().fold(9.0, f64::min));
    near(found["nutation_angle_mean_rad"], angles.iter().sum::<f64>() / angles.len() as f64);
    // measured: 0.22 rad apart
    assert!(angles[0] > angles[20] + 1e-3);
}

#[test]
fn attitudes_are_compared_with_the_nominal_run() {
    let scene = scene();
    let state = |q: [f64; 4]| -> State { (q, [0.0; 3], [0.0; 2], [0.0; 3], [1.0, 0.0, 0.0]) };
    let nominal_motion =
        |t: f64| state(hamilton(rotation([0.6, 0.0, 0.8], 3.0 * t), rotation([0.0, 1.0, 0.0], 5.0 * t)));
    let nominal = NominalAttitude::of(&table(&nominal_motion), &outcome(21));
    for angle in [1e-9, 0.3, std::f64::consts::PI - 1e-6] {
        let turned = |t: f64| {
            let (q, ..) = nominal_motion(t);
            state(hamilton(q, rotation([0.48, 0.64, 0.6], angle * (1.0 - (t - 1.0).abs() * 0.25))))
        };
        let found = row(&scene, Some(&nominal), &turned);
        near(found["attitude_from_nominal_max_rad"], angle);
        near(found["attitude_from_nominal_final_rad"], 0.75 * angle);
        let negative = |t: f64| state(turned(t).0.map(|x| -x));
        near(row(&scene, Some(&nominal), &negative)["attitude_from_nominal_max_rad"], angle);
    }
    near(row(&scene, Some(&nominal), &nominal_motion)["attitude_from_nominal_max_rad"], 0.0);
    assert!(row(&scene, None, &nominal_motion)["attitude_from_nominal_max_rad"].is_nan());
    let short = NominalAttitude::of(&table(&nominal_motion), &outcome(20));
    assert!(row(&scene, Some(&short), &nominal_motion)["attitude_from_nominal_final_rad"].is_nan());
}

#[test]
fn the_debris_is_seen_at_its_angle() {
    let scene = scene();
    for distance in [1e-3, 1.0, 1e6] {
        let angle = |t: f64| 0.25 + 0.5 * t;
        let motion = |t: f64| -> State {
            let own = [3.0, -2.0, t].map(|x| x * distance);
            let (sine, cosine) = libm::sincos(angle(t));
            let debris = [own[0] + distance * sine * 0.6, own[1] - distance * sine * 0.8, own[2] + distance * cosine];
            (rotation([0.0, 0.0, 1.0], 0.7 * t), [0.0; 3], [0.0; 2], own, debris)
        };
        let found = row(&scene, None, &motion);
        near(found["spin_axis_debris_angle_min_rad"], 0.25);
        near(found["spin_axis_debris_angle_max_rad"], 1.25);
        near(found["spin_axis_debris_angle_final_rad"], 1.25);
    }
    let together = |_: f64| -> State { ([1.0, 0.0, 0.0, 0.0], [0.0; 3], [0.0; 2], [1.0; 3], [1.0; 3]) };
    assert_eq!(row(&scene, None, &together)["spin_axis_debris_angle_max_rad"], 0.0);
}
