//! Orbits about a flattened body (`orbit.j2`).

use crate::support::{exact::distance, prelude::*};

const J2: f64 = 1.08262668e-3;
const RADIUS: f64 = 6_378_137.0;

fn flattened(orbit: OrbitInput) -> OrbitInput {
    OrbitInput { j2: Some(J2), ..orbit }
}

fn slow(orbit: OrbitInput) -> SceneInput {
    let mut input = body([90.0, 100.0, 40.0], orbit);
    input.initial.angular_velocity_rad_s = [2e-4, -1e-3, 3e-4];
    input
}

fn orbit_at(run: &Run, point: usize) -> [[f64; 3]; 2] {
    [run.table.at(StateField::ComPosition, point), run.table.at(StateField::ComVelocity, point)]
}

fn ten_orbits() -> Grid {
    let n = (MU / 7e6_f64).sqrt() / 7e6;
    Grid::uniform(10.0 * core::f64::consts::TAU / n, 201)
}

/// Law: the energy and the momentum about the Earth's axis are constant over ten orbits; the whole momentum is not.
#[test]
fn energy_and_momentum_about_the_axis_are_constant() {
    let grid = ten_orbits();
    let orbit = OrbitInput { eccentricity: Some(0.02), ..flattened(circle(7e6, 0.9)) };
    let scene = resolved(&slow(orbit));
    for (method, control) in near_rounding(ForceModel::of(&scene)) {
        let run = propagate_one(method, control, &grid, &scene);
        let energy = |point: usize| {
            let [r, v] = orbit_at(&run, point);
            let (d, sine) = (norm(r), r[2] / norm(r));
            let flat = J2 * (RADIUS / d) * (RADIUS / d) * 0.5 * (3.0 * sine * sine - 1.0);
            0.5 * dot(v, v) - MU / d * (1.0 - flat)
        };
        let momentum = |point: usize| {
            let [r, v] = orbit_at(&run, point);
            cross(r, v)
        };
        let (mut worst, mut across) = ([0.0_f64; 2], 0.0_f64);
        for point in 1..grid.points() {
            let turned = difference(momentum(point), momentum(0));
            worst[0] = worst[0].max((energy(point) / energy(0) - 1.0).abs());
            worst[1] = worst[1].max((turned[2] / momentum(0)[2]).abs());
            across = across.max(norm(turned) / norm(momentum(0)));
        }
        assert!(worst[0] < 1e-12 && worst[1] < 1e-12, "{}: {worst:?}", method.name());
        assert!(across > 0.03, "{across}");
    }
}

/// Law: the node drifts by -3/2 n J2 (R/p)^2 cos i to first order in J2 (D. Vallado, 2013, (9-37)).
#[test]
fn the_node_drifts() {
    for (inclination, eccentricity) in [(0.5, 0.0), (1.2, 0.01), (1.7, 0.1)] {
        let axis = 7.2e6_f64 / (1.0 - eccentricity);
        let orbit = OrbitInput { eccentricity: Some(eccentricity), ..flattened(circle(axis, inclination)) };
        let scene = resolved(&SceneInput { environment: Default::default(), ..slow(orbit) });
        let n = (MU / axis).sqrt() / axis;
        let days = 100.0 * core::f64::consts::TAU / n;
        let grid = Grid::uniform(days, 2001);
        let run = propagate(Method::Auto, adaptive(1e-14), &grid, &[scene]).remove(0);
        let node = |point: usize| {
            let [r, v] = orbit_at(&run, point);
            let h = cross(r, v);
            h[0].atan2(-h[1])
        };
        let (mut turned, mut before) = (0.0, node(0));
        let (mut sums, mut count) = ([0.0; 4], 0.0);
        for (point, time) in grid.times().iter().enumerate() {
            let change = node(point) - before;
            turned += change - core::f64::consts::TAU * (change / core::f64::consts::TAU).round();
            before = node(point);
            count += 1.0;
            for (sum, term) in sums.iter_mut().zip([*time, turned, time * time, time * turned]) {
                *sum += term;
            }
        }
        let slope = (count * sums[3] - sums[0] * sums[1]) / (count * sums[2] - sums[0] * sums[0]);
        let parameter = axis * (1.0 - eccentricity * eccentricity);
        let ratio = RADIUS / parameter;
        let expected = -1.5 * n * J2 * ratio * ratio * inclination.cos();
        assert!((slope / expected - 1.0).abs() < 5.0 * J2, "{inclination}: {slope:e} {expected:e}");
    }
}

/// Law: every method finds the reference solution after ten orbits, and it differs from that of a point mass.
#[test]
fn every_method_finds_the_reference_solution() {
    let grid = ten_orbits();
    let ellipse = OrbitInput { eccentricity: Some(0.1), ..circle(8e6, 0.9) };
    // a slow tumble in the gradient would multiply roundings by 1e6
    let spinning = |orbit| {
        let mut input = slow(flattened(orbit));
        input.initial.angular_velocity_rad_s[1] = -0.01;
        resolved(&input)
    };
    let mut scenes = vec![spinning(circle(7e6, 1.1)), spinning(ellipse)];
    let mut in_air = plated(1, 5, [0.5, 2.0]).remove(0);
    in_air.orbit.as_mut().unwrap().j2 = Some(J2);
    scenes.push(in_air);
    for scene in &scenes {
        let model = ForceModel::of(scene);
        let has_plates = scene.environment.drag;
        let grid = if has_plates { Grid::uniform(6_000.0, 31) } else { grid.clone() };
        let fields = everything(Method::Auto);
        let reference = solved(scene, &grid, fields);
        let mut point_mass = scene.clone();
        point_mass.orbit.as_mut().unwrap().j2 = None;
        let last = grid.points() - 1;
        let moved = difference(
            solved(&point_mass, &grid, fields).high.at(StateField::ComPosition, last),
            reference.high.at::<3>(StateField::ComPosition, last),
        );
        assert!(norm(moved) > 1e4, "{moved:?}");
        for (method, control) in near_rounding(model) {
            let run = propagate_one(method, control, &grid, scene);
            let size = norm(reference.high.at::<3>(StateField::ComPosition, last));
            let place = reference.distance::<3>(&run.table, StateField::ComPosition, last, 1.0) / size;
            let error = distance(&run.table, &grid, &reference);
            let bound = match method {
                _ if has_plates => 1e-10,
                Method::Auto | Method::Taylor => 1e-13,
                _ if method.has_fixed_step() => 1e-9,
                _ => 1e-11,
            };
            assert!(place < 1e-12, "{}: {place:e}", method.name());
            assert!(error[0] < bound && error[1] < bound, "{}: {error:?}", method.name());
            for (field, width) in [(StateField::Work, 2), (StateField::Impulse, 3)] {
                for component in 0..width {
                    let expected = reference.high.column(field, component);
                    let size = expected[..=last].iter().fold(1.0, |size: f64, x| size.max(x.abs()));
                    let off = (run.table.column(field, component)[last] - expected[last]).abs();
                    assert!(off < 1e-9 * size, "{} {field:?}: {off:e} of {size:e}", method.name());
                }
            }
        }
    }
}
