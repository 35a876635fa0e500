//! Spacecraft and debris beside an orbit, against two orbits in 40 to 60 digits and the equation of motion.

use crate::support::{
    orbits::{leaving, runge_kutta},
    prelude::*,
};

fn ellipse() -> OrbitInput {
    let (position_m, velocity_m_s) = (Some([7e6, 1e6, -2e5]), Some([100.0, 7100.0, 2900.0]));
    OrbitInput { position_m, velocity_m_s, body_radius_m: 6e6, ..OrbitInput::DEFAULT }
}

/// Place and velocity of the debris relative to the spacecraft at some of 145 points of a day.
type Truth = [(usize, [f64; 3], [f64; 3]); 3];

/// Debris minus spacecraft on their Kepler orbits, by the formulas of [`spindrift::dynamics::orbit`] in 60 digits
/// (mpmath), Kepler's equation by Newton's method.
#[rustfmt::skip]
const ON_KEPLER_ORBITS: Truth = [
    (1, [10.060910493415184, 18.72826942103942, -10.566069684440404],
        [-0.023299242344201943, -0.05749368418867563, 0.04003900345890729]),
    (10, [59.452973274557486, 68.61577226276867, -36.40678669510857],
        [-0.09749830793769558, -0.027480624408078563, 0.01560395266348882]),
    (144, [105.0297089243777, -143.30146523220634, -35.478107522816096],
        [0.12832737508065187, 0.07574724923777497, -0.04684339230709328]),
];

/// About a flattened body, each integrated by itself with series of order 25 in 40 digits (Python's mpmath; steps of
/// 60 s):
///
/// ```text
/// mu, k, H = mpf('3.986004418e14'), 3*mpf('1.08262668e-3')*mpf(6378137)**2/2, 60
/// # r'' = -(s + f - g z^2) r - 2 f z e3 with s, f, g = mu/|r|^3, mu k/|r|^5, 5 mu k/|r|^7, by recurrences of powers
/// ```
#[rustfmt::skip]
const FLATTENED: Truth = [
    (1, [10.093299787952885, 18.730262952229378, -10.544377540078449],
        [-0.023210398093648006, -0.05747716922548002, 0.04010769346141533]),
    (10, [57.923857132733204, 66.95363522409342, -36.374771687715054],
        [-0.09455702480407123, -0.029778131227822385, 0.015596368593675625]),
    (144, [112.9597982124801, -104.60364169149003, -34.31954339458144],
        [0.09807094104096233, 0.09291008102550678, -0.03969129108386968]),
];

#[test]
fn a_day_beside_an_orbit_without_thrust() {
    let j2 = Some(1.08262668e-3 * (6_378_137.0 / 6e6) * (6_378_137.0 / 6e6));
    let grid = Grid::uniform(86_400.0, 145);
    for (j2, has_gradient, truth) in
        [(None, false, ON_KEPLER_ORBITS), (None, true, ON_KEPLER_ORBITS), (j2, true, FLATTENED)]
    {
        let mut input = body([90.0, 100.0, 40.0], OrbitInput { j2, ..ellipse() });
        input.debris = Some(DebrisInput::Cube { side_m: 0.3, density_kg_m3: 2700.0 });
        input.initial.position_m = [-28.0, -14.0, 18.0];
        input.initial.velocity_m_s = [0.05030686, 0.04178697, -0.0211011];
        input.initial.debris_position_m = [5.0, 40.0, -12.0];
        input.initial.debris_velocity_m_s = [-0.0106071, -0.01310423, 0.002394045];
        input.initial.angular_velocity_rad_s = [1e-4, 0.0, 2e-4];
        input.environment.gravity_gradient = has_gradient;
        let scene = resolved(&input);
        for (method, control) in near_rounding(ForceModel::of(&scene)) {
            let run = propagate_one(method, control, &grid, &scene);
            for (point, position, velocity) in truth {
                let apart =
                    |debris, own| -> [f64; 3] { difference(run.table.at(debris, point), run.table.at(own, point)) };
                let off = norm(difference(apart(StateField::DebrisPosition, StateField::ComPosition), position));
                let speed = norm(difference(apart(StateField::DebrisVelocity, StateField::ComVelocity), velocity));
                // both positions in the table are rounded to half of 9e-10 m, in each of three components
                assert!(off < 3e-9 && speed < 3e-12, "{} at {point}: {off:e} m, {speed:e} m/s", method.name());
            }
        }
    }
}

/// Law: thrust moves the spacecraft by r'' = -mu r/|r|^3 + F/m, here by the classical Runge-Kutta method.
#[test]
fn thrust_on_an_orbit() {
    let mut input = SceneInput { environment: EnvironmentInput::DEFAULT, ..body([90.0, 100.0, 40.0], ellipse()) };
    input.thrusters = vec![ThrusterInput::named("p1", [0.0; 3], [1.0, 2.0, 2.0])];
    input.initial.position_m = [300.0, -20.0, 10.0];
    let input = input.with_actuation(ActuationInput::idle(200.0, 1000.0).with_thrust(&[6.0]));
    let scene = resolved(&input);
    let orbit = scene.orbit.unwrap();
    let start = [sum(orbit.position, [300.0, -20.0, 10.0]), orbit.velocity];
    let [y, unmoved] = [6.0, 0.0].map(|force| {
        let arc = |state, (steps, force): (usize, f64)| {
            runge_kutta(state, (steps, 0.5), |_, [r, v]| {
                let pull = scaled(-MU / norm(r).powi(3), r);
                [v, sum(pull, scaled(force / 1000.0 / 3.0, [1.0, 2.0, 2.0]))]
            })
        };
        [(400, 0.0), (1600, force), (4000, 0.0)].into_iter().fold(start, arc)
    });
    assert!(norm(difference(y[0], unmoved[0])) > 1e4);
    let grid = Grid::uniform(3_000.0, 31);
    for (method, control) in near_rounding(ForceModel::of(&scene)) {
        let run = propagate_one(method, control, &grid, &scene);
        let off = norm(difference(run.table.at(StateField::ComPosition, 30), y[0]));
        let speed = norm(difference(run.table.at(StateField::ComVelocity, 30), y[1]));
        assert!(off < 1e-5 && speed < 1e-8, "{}: {off:e} m, {speed:e} m/s", method.name());
    }
    let reference = solved(&scene, &grid, everything(Method::Auto));
    assert!(norm(difference(reference.high.at(StateField::ComPosition, 30), y[0])) < 1e-5);
}

#[test]
fn the_balances_hold_beside_an_orbit() {
    let mut input = leaving(body([90.0, 100.0, 40.0], ellipse()));
    input.initial.angular_velocity_rad_s = [0.01, -0.02, 0.03];
    let scene = resolved(&input);
    let grid = Grid::uniform(6_000.0, 61);
    for (method, control) in
        near_rounding(ForceModel::of(&scene)).into_iter().filter(|(method, _)| !method.has_fixed_step())
    {
        let run = propagate_one(method, control, &grid, &scene);
        let table = &run.table;
        let debris = scene.mass.debris.unwrap();
        let kinetic = |point: usize| {
            let (v, omega): ([f64; 3], [f64; 3]) =
                (table.at(StateField::ComVelocity, point), table.at(StateField::Rate, point));
            let of_debris: [f64; 3] = table.at(StateField::DebrisVelocity, point);
            let own = scene.mass.total * dot(v, v) + dot(omega, product(scene.mass.inertia, omega));
            0.5 * (own + debris.mass * dot(of_debris, of_debris))
        };
        let momentum = |point: usize| {
            let c_es = dcm_from_quaternion(table.at(StateField::Attitude, point));
            let h = product(scene.mass.inertia, table.at(StateField::Rate, point));
            difference(product(c_es, h), table.at(StateField::AngularImpulse, point))
        };
        for point in 1..grid.points() {
            let gained = kinetic(point) - kinetic(0);
            let [work, _] = table.at::<2>(StateField::Work, point);
            let off = (gained - work).abs() / kinetic(0);
            assert!(off < 1e-14 && work.abs() > 1e-6 * kinetic(0), "{} at {point}: {off:e}", method.name());
            let off = norm(difference(momentum(point), momentum(0)));
            assert!(off < 1e-11, "{} at {point}: {off:e} N m s", method.name());
        }
    }
}
