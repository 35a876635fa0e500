//! Spacecraft on orbits under the gravity gradient.

use super::prelude::*;
use spindrift::scene::{Arc, BodyInput, Offset, Offsets};

/// Gravitational parameter of the Earth, m^3/s^2.
pub const MU: f64 = 3.986004418e14;

pub fn near_rounding(model: ForceModel) -> Vec<(Method, Control)> {
    let control = |method: Method| match method {
        Method::Auto | Method::Taylor | Method::NullSpace => adaptive(1e-16),
        DOP853 => adaptive(1e-14),
        DORMAND_PRINCE => adaptive(1e-15),
        GAUSS_LEGENDRE => fixed(10.0),
        RUNGE_KUTTA => fixed(0.5),
    };
    let able = Method::ALL.into_iter().filter(|method| method.integrates(model));
    able.map(|method| (method, control(method))).collect()
}

pub fn body(moments: [f64; 3], orbit: OrbitInput) -> SceneInput {
    let [x, y, z] = moments;
    let inertia = [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
    SceneInput {
        body: BodyInput {
            mass_kg: Some(1000.0),
            center_of_mass_m: Some([0.0; 3]),
            inertia_kg_m2: Some(inertia),
            ..BodyInput::DEFAULT
        },
        orbit: Some(orbit),
        environment: EnvironmentInput { gravity_gradient: true, ..EnvironmentInput::DEFAULT },
        ..SceneInput::blank()
    }
}

pub fn circle(radius: f64, inclination: f64) -> OrbitInput {
    OrbitInput { semi_major_axis_m: Some(radius), inclination_rad: Some(inclination), ..OrbitInput::DEFAULT }
}

pub fn plated(count: u64, seed: u64, rates: [f64; 2]) -> Vec<Scene> {
    let mut u = Uniform::new(seed + 1);
    let plates = |mut input: SceneInput| {
        input.plates = (0..6)
            .map(|k| PlateInput {
                name: Name::of(&format!("p{k}")),
                area_m2: u.between(0.5, 3.0),
                normal: u.vector::<3>(1.0),
                center_m: u.vector::<3>(1.5),
                drag_coefficient: u.between(1.5, 2.5),
                specular: u.between(0.0, 0.5),
                diffuse: u.between(0.0, 0.5),
                ..PlateInput::DEFAULT
            })
            .collect();
        let epoch = Epoch::parse("2026-06-01T00:00:00Z");
        input.orbit.as_mut().unwrap().epoch = epoch;
        input.environment = EnvironmentInput {
            drag: true,
            solar_pressure: true,
            base_density_kg_m3: Some(1e-11),
            base_height_m: Some(5e5),
            scale_height_m: Some(3e5),
            ..input.environment
        };
        input
    };
    inputs(count, seed, rates).into_iter().map(plates).map(|input| resolved(&input)).collect()
}

/// The scenes of [`plated`] without wheels, whose air and light move them.
pub fn coupled(count: u64, seed: u64) -> Vec<Scene> {
    let mut scenes = plated(2 * count, seed, [0.5, 20.0]);
    scenes.retain(|scene| scene.mass.wheels.is_empty());
    for scene in &mut scenes {
        scene.environment.coupled = true;
        scene.offsets = Some(Offsets { spacecraft: Offset::default(), debris: Offset::default() });
    }
    scenes
}

/// [`tumbling`] with a residual dipole in the field (IGRF for even numbers, a dipole for others) in place of a gravity
/// gradient, and two torque rods commanded at random times until `duration` s.
pub fn magnetic(count: u64, seed: u64, rates: [f64; 2], duration: f64) -> Vec<Scene> {
    let mut u = Uniform::new(seed + 2);
    let magnetic = |(k, mut input): (usize, SceneInput)| {
        input.orbit.as_mut().unwrap().epoch = Epoch::parse("2026-06-01T00:00:00Z");
        input.environment = EnvironmentInput {
            magnetic_field: Some(if k.is_multiple_of(2) { FieldModel::Igrf } else { FieldModel::Dipole }),
            magnetic_dipole_a_m2: Some(u.vector(10.0)),
            ..EnvironmentInput::DEFAULT
        };
        let mut scene = resolved(&input);
        scene.torque_rods =
            [[1.0, 0.0, 0.0], [0.0, 0.6, 0.8]].map(|axis| TorqueRod { axis, limit: 15.0, scale: 1.0 }).to_vec();
        let mut start = 0.0;
        while start < duration {
            let until = start + u.between(0.05, 0.4) * duration;
            let [x, along] = u.vector(10.0);
            let dipole = [x, 0.6 * along, 0.8 * along];
            scene.schedule.push(Arc { start, applied: Actuation { dipole, ..Actuation::none(until.min(duration)) } });
            start = until;
        }
        scene
    };
    inputs(count, seed, rates).into_iter().enumerate().map(magnetic).collect()
}

/// The satellite of `drag_tumble.toml` between 400 and 500 km, where densities have kinks, with 0.01 to 2 deg/s.
pub fn in_thin_air(count: u64, seed: u64) -> Vec<Scene> {
    let mut u = Uniform::new(seed);
    let plate = |name: &str, area: f64, normal: [f64; 3], center_m: [f64; 3]| PlateInput {
        name: Name::of(name),
        area_m2: area,
        normal,
        center_m,
        specular: 0.1,
        diffuse: 0.3,
        ..PlateInput::DEFAULT
    };
    let mut scene = || {
        let mut angle = || Some(u.between(-3.0, 3.0));
        let orbit = OrbitInput {
            eccentricity: Some(0.005),
            true_anomaly_rad: angle(),
            ascending_node_rad: angle(),
            epoch: Epoch::parse("2026-11-24T00:00:00Z"),
            ..circle(6.828e6, 0.9)
        };
        let mut input = body([6.0, 5.0, 4.0], orbit);
        (input.body.mass_kg, input.body.center_of_mass_m) = (Some(60.0), Some([0.0, 0.0, 0.02]));
        input.environment.drag = true;
        input.environment.solar_pressure = true;
        input.environment.density_scale = libm::exp(u.between(-0.7, 0.7));
        input.plates = vec![
            plate("front", 0.4, [1.0, 0.0, 0.0], [0.25, 0.0, 0.0]),
            plate("rear", 0.4, [-1.0, 0.0, 0.0], [-0.25, 0.0, 0.0]),
            plate("left", 0.4, [0.0, 1.0, 0.0], [0.0, 0.25, 0.0]),
            plate("right", 0.4, [0.0, -1.0, 0.0], [0.0, -0.25, 0.0]),
            plate("top", 0.25, [0.0, 0.0, 1.0], [0.0, 0.0, 0.4]),
            plate("bottom", 0.25, [0.0, 0.0, -1.0], [0.0, 0.0, -0.4]),
            plate("cells", 0.5, [0.0, 0.0, 1.0], [0.0, 0.75, 0.0]),
            plate("back", 0.5, [0.0, 0.0, -1.0], [0.0, 0.75, 0.0]),
        ];
        input.initial.attitude = u.unit_quaternion();
        let rate = libm::pow(10.0, u.between(-2.0, 0.3)).to_radians();
        input.initial.angular_velocity_rad_s = u.vector::<3>(1.0).map(|x| rate * x);
        resolved(&input)
    };
    (0..count).map(|_| scene()).collect()
}

pub fn tumbling(count: u64, seed: u64, rates: [f64; 2]) -> Vec<Scene> {
    inputs(count, seed, rates).iter().map(resolved).collect()
}

fn inputs(count: u64, seed: u64, rates: [f64; 2]) -> Vec<SceneInput> {
    let mut u = Uniform::new(seed);
    let input = |k: u64| {
        let second = [u.between(1.0, 5.0), u.between(1.0, 5.0), u.between(1.0, 5.0)];
        let moments = [second[1] + second[2], second[0] + second[2], second[0] + second[1]].map(|x| 30.0 * x);
        let eccentricity = u.between(0.0, 0.3);
        let axis = u.between(6.9e6, 9e6) / (1.0 - eccentricity);
        let mut angle = || Some(u.between(-3.0, 3.0));
        let orbit = OrbitInput {
            semi_major_axis_m: Some(axis),
            eccentricity: Some(eccentricity),
            inclination_rad: angle(),
            ascending_node_rad: angle(),
            argument_of_periapsis_rad: angle(),
            true_anomaly_rad: angle(),
            ..OrbitInput::DEFAULT
        };
        let mut input = body(moments, orbit);
        let motion = (MU / axis).sqrt() / axis;
        let rate = motion * u.between(rates[0], rates[1]);
        input.initial.angular_velocity_rad_s = u.vector::<3>(1.0).map(|x| rate * x);
        let q = u.vector::<4>(1.0);
        let norm = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        input.initial.attitude = q.map(|x| x / norm);
        if k % 2 == 1 {
            let wheel = spindrift::scene::WheelInput {
                mass_kg: Some(3.0),
                axial_inertia_kg_m2: Some(0.02),
                transverse_inertia_kg_m2: Some(0.012),
                radius_m: None,
                length_m: None,
                density_kg_m3: None,
                ..spindrift::scene::WheelInput::named("w1", [0.6, 0.0, 0.8], [0.1, 0.2, 0.0])
            };
            input = input.with_wheel(wheel).with("wheels.w1.rate_rad_s", &[30.0]);
        }
        input
    };
    (0..count).map(input).collect()
}

/// Position and velocity after `steps` steps of `h` seconds by the classical Runge-Kutta method.
pub fn runge_kutta(
    mut state: [[f64; 3]; 2],
    (steps, h): (usize, f64),
    slope: impl Fn(f64, [[f64; 3]; 2]) -> [[f64; 3]; 2],
) -> [[f64; 3]; 2] {
    let moved = |state: [[f64; 3]; 2], h: f64, slope: [[f64; 3]; 2]| [0, 1].map(|i| sum(state[i], scaled(h, slope[i])));
    for step in 0..steps {
        let time = step as f64 * h;
        let a = slope(time, state);
        let b = slope(time + 0.5 * h, moved(state, 0.5 * h, a));
        let c = slope(time + 0.5 * h, moved(state, 0.5 * h, b));
        let d = slope(time + h, moved(state, h, c));
        for (factor, slope) in [(1.0, a), (2.0, b), (2.0, c), (1.0, d)] {
            state = moved(state, factor * h / 6.0, slope);
        }
    }
    state
}

pub fn leaving(input: SceneInput) -> SceneInput {
    let mut thruster = ThrusterInput::named("p1", [0.002, -0.001, 0.0], [0.0, 0.0, 1.0]);
    thruster.max_thrust_n = Some(50.0);
    let arc = |start, end, thrust| ActuationInput::idle(start, end).with_thrust(&[thrust]);
    let mut input = SceneInput {
        thrusters: vec![thruster],
        debris: Some(DebrisInput::Cube { side_m: 0.3, density_kg_m3: 2700.0 }),
        ..input
    };
    input.initial.position_m = [-28.0, -14.0, 18.0];
    input.initial.velocity_m_s = [0.05, 0.02, -0.03];
    input.initial.debris_position_m = [5.0, 40.0, -12.0];
    input.initial.debris_velocity_m_s = [0.01, 0.02, 0.03];
    input.with_actuation(arc(100.0, 160.0, 20.0)).with_actuation(arc(1000.0, 1030.0, 35.0))
}
