//! Air and light that move the spacecraft (`environment.coupled`).

use crate::support::{
    exact::distance,
    orbits::{coupled, runge_kutta},
    prelude::*,
};
use spindrift::{
    dynamics::environment::{EARTH_RATE, sun::sun},
    scene::Orbit,
};

const DURATION: f64 = 6_000.0;
const AREA: f64 = 2.0;
const MASS: f64 = 50.0;
const DRAG: f64 = 2.4;
const SPECULAR: f64 = 0.3;
const DIFFUSE: f64 = 0.2;
const PRESSURE: f64 = 4.56e-6;
const DENSITY: f64 = 1e-10;
const HEIGHT: f64 = 6e5;
const SCALE: f64 = 6e4;

fn epoch() -> Epoch {
    Epoch::parse("2026-06-01T00:00:00Z").unwrap()
}

fn one_plate(orbit: OrbitInput, normal: [f64; 3]) -> SceneInput {
    let mut input = body([6.0, 5.0, 4.0], OrbitInput { epoch: Some(epoch()), ..orbit });
    (input.body.mass_kg, input.body.center_of_mass_m) = (Some(MASS), Some([0.0, 0.0, 0.02]));
    input.plates = vec![PlateInput {
        name: Name::of("sail"),
        area_m2: AREA,
        normal,
        center_m: [0.0, 0.0, 0.02],
        drag_coefficient: DRAG,
        specular: SPECULAR,
        diffuse: DIFFUSE,
        ..PlateInput::DEFAULT
    }];
    input
}

fn in_air() -> SceneInput {
    let mut input = one_plate(OrbitInput { eccentricity: Some(0.01), ..circle(7e6, 0.9) }, [0.6, -0.64, 0.48]);
    input.environment = EnvironmentInput {
        drag: true,
        coupled: true,
        base_density_kg_m3: Some(DENSITY),
        base_height_m: Some(HEIGHT),
        scale_height_m: Some(SCALE),
        ..EnvironmentInput::DEFAULT
    };
    input
}

fn in_light() -> SceneInput {
    let [x, y, z] = sun(epoch().days_since_j2000()).direction;
    let orbit = OrbitInput { ascending_node_rad: Some(x.atan2(-y)), ..circle(1e7, z.acos()) };
    let aslant = sum([x, y, z], [-0.5 * y, 0.5 * x, 0.0]);
    let mut input = one_plate(orbit, scaled(1.0 / norm(aslant), aslant));
    let environment = EnvironmentInput { solar_pressure: true, coupled: true, ..EnvironmentInput::DEFAULT };
    input.environment = EnvironmentInput { solar_pressure_n_m2: PRESSURE, ..environment };
    input
}

fn force(input: &SceneInput, time: f64, [r, v]: [[f64; 3]; 2]) -> [f64; 3] {
    let n = input.plates[0].normal;
    if input.environment.drag {
        let flow = difference(v, cross([0.0, 0.0, EARTH_RATE], r));
        let density = DENSITY * (-(norm(r) - 6_378_137.0 - HEIGHT) / SCALE).exp();
        return scaled(-0.5 * density * DRAG * AREA * dot(n, flow).max(0.0), flow);
    }
    let sun = sun(epoch().days_since_j2000() + time / 86_400.0);
    let cosine = dot(n, sun.direction).max(0.0);
    let push = sum(scaled(1.0 - SPECULAR, sun.direction), scaled(2.0 * (SPECULAR * cosine + DIFFUSE / 3.0), n));
    scaled(-PRESSURE / (sun.distance * sun.distance) * AREA * cosine, push)
}

fn integrated(input: &SceneInput, pushed: bool) -> [[f64; 3]; 2] {
    let orbit = Orbit::of(input.orbit.as_ref().unwrap());
    runge_kutta([orbit.position, orbit.velocity], (120_000, DURATION / 120_000.0), |time, state| {
        let [r, v] = state;
        let own = if pushed { scaled(1.0 / MASS, force(input, time, state)) } else { [0.0; 3] };
        [v, sum(own, scaled(-MU / norm(r).powi(3), r))]
    })
}

#[test]
fn the_centre_of_mass_moves_as_the_forces_say() {
    for (name, mut input, least) in [("air", in_air(), 100.0), ("light", in_light(), 1.0)] {
        let [r, v] = integrated(&input, true);
        let [unmoved, _] = integrated(&input, false);
        assert!(norm(difference(r, unmoved)) > least, "{name}: moves by {}", norm(difference(r, unmoved)));
        let grid = Grid::uniform(DURATION, 11);
        let scene = resolved(&input);
        for (method, control) in near_rounding(ForceModel::of(&scene)) {
            let table = propagate_one(method, control, &grid, &scene).table;
            let off = norm(difference(table.at(StateField::ComPosition, 10), r));
            let speed = norm(difference(table.at(StateField::ComVelocity, 10), v));
            assert!(off < 1e-5 && speed < 1e-8, "{name}, {}: {off:e} m, {speed:e} m/s", method.name());
            assert!(norm(table.at::<3>(StateField::Rate, 10)) < 1e-15, "nothing turns it");
        }
        input.environment.coupled = false;
        let scene = resolved(&input);
        for (method, control) in near_rounding(ForceModel::of(&scene)) {
            let table = propagate_one(method, control, &grid, &scene).table;
            let off = norm(difference(table.at(StateField::ComPosition, 10), unmoved));
            assert!(off < 1e-5, "{name}, {}: {off:e} m", method.name());
        }
    }
}

#[test]
fn every_method_finds_the_reference_solution() {
    let grid = Grid::uniform(DURATION, 31);
    for scene in coupled(2, 91) {
        let reference = solved(&scene, &grid, everything(Method::Auto));
        for (method, control) in near_rounding(ForceModel::of(&scene)) {
            let run = propagate_one(method, control, &grid, &scene);
            let place = reference.distance::<3>(&run.table, StateField::ComPosition, 30, 1.0);
            let error = distance(&run.table, &grid, &reference);
            assert!(place < 1e-6, "{}: {place:e} m", method.name());
            assert!(error[0] < 1e-10 && error[1] < 1e-10, "{}: {error:?}", method.name());
        }
    }
}

#[test]
fn the_work_is_the_change_of_the_kinetic_energy() {
    let grid = Grid::uniform(20_000.0, 101);
    for scene in &coupled(3, 17) {
        for (method, _) in near_rounding(ForceModel::of(scene)) {
            let table = propagate_one(method, adaptive(1e-12), &grid, scene).table;
            let energy = |point: usize| {
                let (v, rate) = (table.at::<3>(StateField::ComVelocity, point), table.at(StateField::Rate, point));
                0.5 * scene.mass.total * dot(v, v) + 0.5 * dot(rate, product(scene.mass.inertia, rate))
            };
            let worst = (1..grid.points()).fold(0.0_f64, |worst, point| {
                let [work, _] = table.at::<2>(StateField::Work, point);
                worst.max((energy(point) - energy(0) - work).abs() / energy(0))
            });
            assert!(worst < 1e-14, "{}: {worst:e}", method.name());
        }
    }
}
