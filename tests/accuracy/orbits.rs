//! The gravity gradient on two-body orbits, by every method that integrates it.

use super::jeod::jeod_runs;
use crate::support::{orbits::leaving, prelude::*};
use spindrift::{
    dynamics::{
        effects::{ChangingEffects, within_arcs::Motion},
        gravity::Gravity,
        orbit::KeplerOrbit,
        orbit_state::OrbitState,
    },
    scene::Arc,
};

fn methods() -> Vec<(Method, Control)> {
    near_rounding(ForceModel::NONE.with(Effect::GravityGradient).with(Effect::Gravity))
}

/// At the node of a circle of rate `n` in the e1-e2 plane: o3 = -e1 (nadir), o2 = -e3, o1 = e2.
fn aligned(input: &mut SceneInput, n: f64) {
    input.initial.attitude = [0.5, -0.5, -0.5, 0.5];
    input.initial.angular_velocity_rad_s = [0.0, -n, 0.0];
}

/// Law: small librations in pitch near o1, o2, o3 have the frequency n sqrt(3 (J1 - J3)/J2) (P. Hughes, 1986, 9.2).
#[test]
fn librations_in_pitch() {
    const AMPLITUDE: f64 = 1e-6;
    let (radius, moments): (f64, [f64; 3]) = (7e6, [90.0, 100.0, 40.0]);
    let n = (MU / radius).sqrt() / radius;
    let frequency = n * (3.0 * (moments[0] - moments[2]) / moments[1]).sqrt();
    let mut input = body(moments, circle(radius, 0.0));
    aligned(&mut input, n);
    let speed = AMPLITUDE * frequency;
    input.initial.angular_velocity_rad_s[1] += speed;
    let scene = resolved(&input);
    let grid = Grid::uniform(12_000.0, 201);
    for (method, control) in methods() {
        let run = propagate_one(method, control, &grid, &scene);
        let mut worst = 0.0_f64;
        for (point, time) in grid.times().iter().enumerate() {
            let expected = -n + speed * libm::cos(frequency * time);
            let rate = run.table.at::<3>(StateField::Rate, point);
            worst = worst.max(norm(difference(rate, [0.0, expected, 0.0])) / speed);
        }
        // rates of 1e-3 rad/s have 16 digits, those of the libration ten; terms of the third order are 1e-12
        assert!(worst < 2e-8, "{}: {worst:e}", method.name());
    }
}

/// Largest change of the constant of a circular orbit, over n^2 J.
fn change_of_the_constant(scene: &Scene, run: &Run, n: f64) -> f64 {
    let inertia = scene.mass.inertia;
    let form = |v: [f64; 3]| dot(v, product(inertia, v));
    let constant = |point: usize| {
        let (r, v) = (run.table.at(StateField::ComPosition, point), run.table.at(StateField::ComVelocity, point));
        let normal = cross(r, v);
        let c_es = dcm_from_quaternion(run.table.at(StateField::Attitude, point));
        let unit = |v: [f64; 3]| transposed_product(c_es, scaled(1.0 / norm(v), v));
        let (o3, o2) = (unit(scaled(-1.0, r)), unit(scaled(-1.0, normal)));
        let relative = difference(run.table.at(StateField::Rate, point), scaled(-n, o2));
        0.5 * form(relative) + n * n * (1.5 * form(o3) - 0.5 * form(o2))
    };
    let first = constant(0);
    let size = n * n * inertia[2][2].max(inertia[1][1]);
    (1..run.table.points()).map(|point| (constant(point) - first).abs() / size).fold(0.0, f64::max)
}

fn the_constant_is_constant(orbits: f64, methods: &[(Method, Control)], bound: impl Fn(Method) -> f64) {
    let radius = 7e6_f64;
    let n = (MU / radius).sqrt() / radius;
    let mut librating = body([90.0, 100.0, 40.0], circle(radius, 0.0));
    aligned(&mut librating, n);
    librating.initial.angular_velocity_rad_s = [0.3 * n, -1.2 * n, 0.1 * n];
    let mut tumbling = body([90.0, 100.0, 40.0], circle(radius, 0.9));
    tumbling.initial.angular_velocity_rad_s = [2.0 * n, 1.0 * n, -3.0 * n];
    let grid = Grid::uniform(orbits * core::f64::consts::TAU / n, 1001);
    for input in [librating, tumbling] {
        let scene = resolved(&input);
        for (method, control) in methods {
            let run = propagate_one(*method, *control, &grid, &scene);
            let worst = change_of_the_constant(&scene, &run, n);
            assert!(worst < bound(*method), "{}: {worst:e}", method.name());
        }
    }
}

#[test]
fn the_constant_of_the_circular_orbit() {
    the_constant_is_constant(20.0, &methods(), |_| 1e-12);
}

#[test]
#[ignore = "minutes: cargo test --release --test accuracy -- --ignored a_thousand_orbits"]
fn the_constant_over_a_thousand_orbits() {
    let fast: Vec<_> = methods().into_iter().filter(|(method, _)| !method.has_fixed_step()).collect();
    let bound = |method| if matches!(method, Method::Auto | Method::Taylor) { 1e-12 } else { 1e-9 };
    the_constant_is_constant(1000.0, &fast, bound);
}

fn with_and_without(effect: Effect) -> [Scene; 2] {
    let mut input = jeod_runs()[0].input(true);
    input.orbit.as_mut().unwrap().epoch = Epoch::parse("2026-06-01T00:00:00Z");
    let plate = |name, normal, center_m| PlateInput {
        name: Name::of(name),
        area_m2: 8.0,
        normal,
        center_m,
        specular: 0.3,
        diffuse: 0.2,
        ..PlateInput::DEFAULT
    };
    input.plates = vec![
        plate("a", [1.0, 0.2, 0.1], [0.5, 3.0, 1.0]),
        plate("b", [-0.3, -1.0, 0.1], [-0.5, 0.0, 2.0]),
        plate("c", [0.3, 0.5, -1.0], [2.5, 1.0, -2.0]),
    ];
    let mut without = input.clone();
    match effect {
        Effect::ConstantTorque => {
            (input.orbit, input.environment.gravity_gradient) = (None, false);
            without = input.clone();
            input.environment.body_torque_n_m = Some([1e-3, -2e-3, 3e-3]);
        }
        Effect::GravityGradient => without.environment.gravity_gradient = false,
        Effect::MagneticTorque => {
            for (input, dipole) in [(&mut input, Some([50.0, -30.0, 80.0])), (&mut without, None)] {
                input.orbit =
                    input.orbit.map(|orbit| OrbitInput { epoch: Epoch::parse("2026-11-24T00:00:00Z"), ..orbit });
                input.environment = EnvironmentInput {
                    magnetic_field: Some(FieldModel::Igrf),
                    magnetic_dipole_a_m2: dipole,
                    ..EnvironmentInput::DEFAULT
                };
            }
        }
        Effect::Drag => input.environment.drag = true,
        Effect::SolarPressure => input.environment.solar_pressure = true,
        Effect::Tide => {
            input = leaving(input);
            without = SceneInput { orbit: None, ..input.clone() };
            without.environment.gravity_gradient = false;
        }
        Effect::Gravity => {
            input.environment.gravity_gradient = false;
            without = SceneInput { orbit: None, ..input.clone() };
        }
    }
    let mut scenes = [input, without].map(|input| resolved(&input));
    if effect == Effect::MagneticTorque {
        let until = [700.0, 1_600.0, 2_400.0];
        let dipoles = [[40.0, -20.0, 60.0], [0.0; 3], [-90.0, 10.0, 30.0]];
        scenes[0].torque_rods = vec![TorqueRod { axis: [1.0, 0.0, 0.0], limit: 110.0, scale: 1.0 }];
        scenes[0].schedule = arcs_of_rods(&until, &dipoles);
    }
    scenes
}

fn arcs_of_rods(until: &[f64], dipoles: &[[f64; 3]]) -> Vec<Arc> {
    let starts = [0.0].into_iter().chain(until.iter().copied());
    let arcs = starts.zip(until.iter().zip(dipoles));
    arcs.map(|(start, (until, dipole))| Arc {
        start,
        applied: Actuation { dipole: *dipole, ..Actuation::none(*until) },
    })
    .collect()
}

/// Law: a method that integrates an effect finds the reference solution under it, and others refuse it.
#[test]
fn every_method_has_every_effect_or_says_so() {
    let grid = Grid::uniform(3_000.0, 31);
    let mut found = 0;
    for effect in Effect::ALL {
        let [scene, without] = with_and_without(effect);
        let model = ForceModel::of(&scene);
        assert!(model.contains(effect) && !ForceModel::of(&without).contains(effect));
        let fields = everything(Method::Auto);
        let [reference, other] = [&scene, &without].map(|scene| solved(scene, &grid, fields));
        let turned = RotationError::largest(rotation_errors(&other, &grid, &reference.high));
        let last = grid.points() - 1;
        let place = |solution: &ReferenceSolution| solution.high.at::<3>(StateField::ComPosition, last);
        let moved = norm(difference(place(&reference), place(&other)));
        assert!(turned.attitude.max(turned.omega) > 1e-3 || moved > 1e3, "{}: {turned:?}, {moved}", effect.key());
        for method in Method::ALL {
            let alone = ForceModel::NONE.with(effect);
            let settings = PropagationSettings::new(method, adaptive(1e-12), grid.clone(), fields, &scene);
            if !method.integrates(model) {
                assert!(model.effects().any(|effect| !method.integrates(ForceModel::NONE.with(effect))));
                assert!(std::panic::catch_unwind(|| settings.engine(Isa::best())).is_err(), "{}", method.name());
                continue;
            }
            assert!(method.integrates(alone), "{} of {}", method.name(), effect.key());
            found += 1;
            let control = if method.has_fixed_step() { fixed(1.0) } else { adaptive(1e-12) };
            let run = propagate_one(method, control, &grid, &scene);
            let error = RotationError::largest(rotation_errors(&reference, &grid, &run.table));
            assert!(error.omega < 1e-9 && error.attitude < 1e-9, "{} {}: {error:?}", method.name(), effect.key());
            if scene.mass.debris.is_some() {
                let off = reference.distance::<3>(&run.table, StateField::DebrisPosition, last, 1.0);
                assert!(off < 1e-7, "{} {}: {off:e} m", method.name(), effect.key());
            }
            let off = reference.distance::<3>(&run.table, StateField::ComPosition, last, 1.0);
            assert!(off < 1e-6, "{} {}: {off:e} m", method.name(), effect.key());
            let integrals =
                [(StateField::Work, 2, 1e-4), (StateField::AngularImpulse, 3, 1e-12), (StateField::Impulse, 3, 1e-7)];
            for (field, width, rounding) in integrals {
                for component in 0..width {
                    let expected = reference.high.column(field, component);
                    let size = expected[..=last].iter().fold(0.0, |size: f64, x| size.max(x.abs()));
                    let off = (run.table.column(field, component)[last] - expected[last]).abs();
                    let rounding = if effect == Effect::ConstantTorque { 1e-12 } else { rounding };
                    assert!(off < 1e-8 * size + rounding, "{} {} {field:?}: {off:e}", method.name(), effect.key());
                }
            }
        }
    }
    assert!(found >= 24, "{found} pairs");
}

#[test]
fn an_orbit_without_gradient_costs_nothing() {
    for method in Method::ALL.into_iter().filter(|method| method.integrates(ForceModel::NONE.with(Effect::Gravity))) {
        let control = if method.has_fixed_step() { fixed(10.0) } else { adaptive(1e-12) };
        let mut input = jeod_runs()[0].input(true);
        input.environment.gravity_gradient = false;
        let flat = SceneInput { orbit: None, ..input.clone() };
        let runs = [input, flat].map(|input| {
            let scene = resolved(&input);
            let settings =
                PropagationSettings::new(method, control, Grid::uniform(20_000.0, 101), everything(method), &scene);
            propagate_on(Isa::best(), &settings, &[scene]).remove(0)
        });
        let rotation = [StateField::Rate, StateField::Attitude, StateField::AngularImpulse];
        let bits = runs.each_ref().map(|run| run.bits_of(crate::support::runs::blocks(rotation)));
        assert!(bits[0] == bits[1], "{}", method.name());
        let places = runs.map(|run| run.table.at::<3>(StateField::ComPosition, 100));
        assert!(norm(difference(places[0], places[1])) > 1e6);
    }
}

#[test]
fn each_key_of_an_orbit_has_a_truth() {
    let elements = |axis: f64, e: f64, i: f64, node: f64, periapsis: f64, anomaly: f64| OrbitInput {
        semi_major_axis_m: Some(axis),
        eccentricity: Some(e),
        inclination_rad: Some(i),
        ascending_node_rad: Some(node),
        argument_of_periapsis_rad: Some(periapsis),
        true_anomaly_rad: Some(anomaly),
        ..OrbitInput::DEFAULT
    };
    let place = |input: OrbitInput| {
        let scene = resolved(&body([90.0, 100.0, 40.0], input));
        let orbit = scene.orbit.unwrap();
        (orbit.position, orbit.velocity)
    };
    let (axis, e, i, node, periapsis, anomaly) = (9e6, 0.2, 0.9, 2.0, -0.7, 1.1);
    let (r, v) = place(elements(axis, e, i, node, periapsis, anomaly));
    let h = cross(r, v);
    let towards = difference(scaled(1.0 / MU, cross(v, h)), scaled(1.0 / norm(r), r));
    let ascending = cross([0.0, 0.0, 1.0], h);
    let between = |a: [f64; 3], b: [f64; 3]| libm::atan2(dot(h, cross(a, b)) / norm(h), dot(a, b));
    let circular = |mu: f64| {
        let (r, v) = place(OrbitInput { mu_m3_s2: mu, ..elements(axis, 0.0, 0.0, 0.0, 0.0, 0.0) });
        norm(v) * norm(v) * norm(r)
    };
    let (given_r, given_v) = ([7e6, 1e5, 2e5], [10.0, 7.4e3, -3e2]);
    let vectors = place(OrbitInput { position_m: Some(given_r), velocity_m_s: Some(given_v), ..OrbitInput::DEFAULT });
    let lowest = axis * (1.0 - e);
    let above = |radius: f64| {
        let orbit = OrbitInput { body_radius_m: radius, ..elements(axis, e, i, node, periapsis, anomaly) };
        Scene::resolve(&body([90.0, 100.0, 40.0], orbit)).is_ok()
    };
    let pulled = |j2: f64| {
        let scene = Scene::resolve(&body([90.0, 100.0, 40.0], OrbitInput { j2: Some(j2), ..circle(7e6, 0.3) }));
        let gravity = Gravity::of(&scene.unwrap().orbit.unwrap());
        norm(gravity.acceleration([6_378_137.0, 0.0, 0.0], 6_378_137.0)) * 6_378_137.0 * 6_378_137.0 / MU
    };
    let truths: [(&str, f64, f64); 11] = [
        ("mu_m3_s2", circular(2e14) / 2e14, 1.0),
        ("body_radius_m", f64::from(u8::from(above(0.999 * lowest) && !above(1.001 * lowest))), 1.0),
        ("j2", pulled(2e-3), 1.003),
        ("position_m", norm(difference(vectors.0, given_r)), 0.0),
        ("velocity_m_s", norm(difference(vectors.1, given_v)), 0.0),
        ("semi_major_axis_m", 1.0 / (2.0 / norm(r) - dot(v, v) / MU) / axis, 1.0),
        ("eccentricity", norm(towards), e),
        ("inclination_rad", libm::acos(h[2] / norm(h)), i),
        ("ascending_node_rad", libm::atan2(ascending[1], ascending[0]), node),
        ("argument_of_periapsis_rad", between(ascending, towards), periapsis),
        ("true_anomaly_rad", between(towards, r), anomaly),
    ];
    let keys: Vec<&str> = OrbitInput::ROWS.iter().map(|row| row.facts.key).collect();
    assert_eq!(truths.map(|(key, ..)| key).to_vec(), keys, "each key of [orbit], in the order of the schema");
    for (key, found, expected) in truths {
        assert!((found - expected).abs() < 4e-15 * expected.abs().max(1.0), "{key}: {found} for {expected}");
    }
}

type Truth = (&'static str, fn(&mut EnvironmentInput), [f64; 2]);

#[test]
fn each_key_of_the_environment_has_a_truth() {
    let [mut scene, _] = with_and_without(Effect::Drag);
    scene.environment = EnvironmentInput {
        solar_pressure: true,
        base_density_kg_m3: Some(1e-11),
        base_height_m: Some(4e5),
        scale_height_m: Some(5e4),
        ..scene.environment
    };
    let orbit = scene.orbit.unwrap();
    let height = norm(orbit.position) - orbit.body_radius;
    let shallower = libm::exp(-(height - 4e5) / 5e4);
    let parameters: [Truth; 6] = [
        ("density_scale", |of| of.density_scale = 3.0, [3.0, 1.0]),
        ("base_density_kg_m3", |of| of.base_density_kg_m3 = Some(5e-11), [5.0, 1.0]),
        ("base_height_m", |of| of.base_height_m = Some(4.5e5), [core::f64::consts::E, 1.0]),
        ("scale_height_m", |of| of.scale_height_m = Some(2.5e4), [shallower, 1.0]),
        ("solar_pressure_n_m2", |of| of.solar_pressure_n_m2 *= 2.0, [1.0, 2.0]),
        ("area_scale", |of| of.area_scale = 0.25, [0.25, 0.25]),
    ];
    let torques = |environment: EnvironmentInput| {
        let mut scene = scene.clone();
        scene.plates.iter_mut().for_each(|plate| plate.area *= environment.area_scale);
        scene.environment = environment;
        let effects = ChangingEffects::of(0.0, &scene, None);
        let OrbitState { position, velocity, .. } = KeplerOrbit::new(&orbit).state(0.0);
        let place = OrbitState { position, velocity, distance: norm(position) };
        let (attitude, field, sun) = (scene.initial.q_es, effects.field(0.0, &place), effects.sun(0.0));
        let motion = Motion { time: 0.0, attitude, rate: [0.0; 3], place, field, sun };
        let drag = effects.drag.unwrap().torque(&motion);
        [drag, effects.solar_pressure.unwrap().torque(&motion)].map(norm)
    };
    let before = torques(scene.environment);
    assert!(before.iter().all(|torque| *torque > 0.0), "{before:?}");
    for (key, change, factors) in parameters {
        let mut environment = scene.environment;
        change(&mut environment);
        let after = torques(environment);
        for i in 0..2 {
            assert!((after[i] / before[i] / factors[i] - 1.0).abs() < 1e-12, "{key}: {before:?} {after:?}");
        }
    }
    let mut keys: Vec<String> = EnvironmentInput::ROWS
        .iter()
        .map(|row| row.facts.key)
        .filter(|key| parameters.iter().all(|(other, ..)| other != key))
        .chain(["gravity_gradient", "drag", "solar_pressure"])
        .map(|key| format!("environment.{key}"))
        .collect();
    let mut effects: Vec<&str> = Effect::ALL.into_iter().map(Effect::key).filter(|key| *key != "orbit").collect();
    keys.sort();
    effects.sort_unstable();
    assert_eq!(keys, effects);
}

/// Law: energy and angular momentum minus work and angular impulse are constant to rounding on eccentric orbits.
#[test]
fn the_balances_hold() {
    balances_hold(&tumbling(8, 61, [0.5, 20.0]), 1e-12);
}

#[test]
fn the_balances_hold_with_plates() {
    balances_hold(&plated(8, 61, [0.5, 20.0]), 1e-11);
}

fn balances_hold(scenes: &[Scene], bound: f64) {
    let grid = Grid::uniform(20_000.0, 101);
    let model = ForceModel::of(&scenes[0]);
    for (method, control) in methods().into_iter().filter(|(method, _)| !method.has_fixed_step()) {
        if !method.integrates(model) {
            continue;
        }
        let widest = scenes.iter().max_by_key(|scene| scene.mass.wheels.len()).unwrap();
        let settings = PropagationSettings::new(method, control, grid.clone(), everything(method), widest);
        for (scene, run) in scenes.iter().zip(propagate_on(Isa::best(), &settings, scenes)) {
            let momentum = |point: usize| {
                let table = &run.table;
                let c_es = dcm_from_quaternion(table.at(StateField::Attitude, point));
                let mut h = product(scene.mass.inertia, table.at(StateField::Rate, point));
                for (wheel, spin) in scene.mass.wheels.iter().enumerate() {
                    let rate = table.column(StateField::WheelRates, wheel)[point];
                    h = from_fn(|i| h[i] + spin.axial * rate * spin.axis[i]);
                }
                difference(product(c_es, h), table.at(StateField::AngularImpulse, point))
            };
            let first = momentum(0);
            let mut worst = 0.0_f64;
            for point in 1..grid.points() {
                let off = norm(difference(momentum(point), first));
                let size = norm(first) + norm(run.table.at::<3>(StateField::AngularImpulse, point));
                worst = worst.max(off / size);
            }
            assert!(worst < bound, "{}: {worst:e}", method.name());
        }
    }
}
