//! Families of scenes whose error estimates once missed the error, and their neighbours.
//!
//! Law: that of [`super::error_estimate`], of each family too. `null_space`, whose steps follow the wheels, is left
//! out.

use super::error_estimate::{Family, Found, Measured, breaches, of_families};
use crate::prelude::*;
use spindrift::scene::BodyInput;

type Regime = (&'static str, f64, usize, fn(u64, &mut Uniform) -> SceneInput);

const REGIMES: [Regime; 13] = [
    ("heavy wheel", 2.0, 101, |_, u| {
        let moments = shape(u, [1.0, 5.0]);
        let spin = fastest(u, moments, 200.0);
        with_wheels(free(moments, rates(u, [-6.0, 0.0])), u, &[spin])
    }),
    ("heavy wheel, rarely", 10.0, 21, |_, u| {
        let moments = shape(u, [1.0, 5.0]);
        let spin = fastest(u, moments, 200.0);
        with_wheels(free(moments, rates(u, [-6.0, 0.0])), u, &[spin])
    }),
    ("many fast wheels", 5.0, 101, |k, u| {
        let moments = shape(u, [1.0, 5.0]);
        let spins: Vec<f64> = (0..3 + k % 6).map(|_| fastest(u, moments, 50.0)).collect();
        with_wheels(free(moments, rates(u, [-4.0, 0.5])), u, &spins)
    }),
    ("on the separatrix", 60.0, 101, |_, u| {
        let moments = shape(u, [1.0, 5.0]);
        free(moments, on_the_separatrix(u, moments, [-14.0, -1.0]))
    }),
    ("separatrix, rarely", 60.0, 25, |_, u| {
        let moments = shape(u, [1.0, 5.0]);
        free(moments, on_the_separatrix(u, moments, [-8.0, -1.0]))
    }),
    ("separatrix, long", 200.0, 201, |_, u| {
        let moments = shape(u, [1.0, 5.0]);
        free(moments, on_the_separatrix(u, moments, [-8.0, -1.0]))
    }),
    ("nearly symmetric", 60.0, 101, |_, u| {
        let [x, _, z] = shape(u, [1.0, 5.0]);
        let y = x * (1.0 + libm::pow(10.0, u.between(-14.0, -1.0)));
        free([x, y, z.min(1.95 * x)], rates(u, [-0.5, 0.5]))
    }),
    ("flat or rod", 60.0, 101, |k, u| {
        let thin = libm::pow(10.0, u.between(-6.0, -1.0));
        let other = u.between(0.2, 1.0);
        let second = if k.is_multiple_of(2) { [1.0, other, thin] } else { [1.0, thin, thin * other] };
        free(moments_of(second), rates(u, [-1.0, 0.5]))
    }),
    ("long", 400.0, 201, |_, u| {
        let moments = shape(u, [1.0, 5.0]);
        free(moments, rates(u, [-1.0, 0.0]))
    }),
    ("eccentric, flat", 60_000.0, 301, |_, u| {
        let thin = u.between(0.02, 0.3);
        eccentric(u, [1.0, 1.0, thin], [0.0, 5.0])
    }),
    ("eccentric, any", 60_000.0, 301, |_, u| {
        let second = [u.between(0.1, 1.0), u.between(0.1, 1.0), u.between(0.1, 1.0)];
        eccentric(u, second, [0.0, 50.0])
    }),
    ("eccentric, dipole", 60_000.0, 301, |k, u| {
        let mut input = eccentric(u, [1.0, 0.7, 0.4], [0.0, 20.0]);
        input.environment = EnvironmentInput {
            magnetic_field: Some(if k.is_multiple_of(2) { FieldModel::Igrf } else { FieldModel::Dipole }),
            magnetic_dipole_a_m2: Some(u.vector(0.2)),
            ..EnvironmentInput::DEFAULT
        };
        input
    }),
    ("eccentric, in air", 60_000.0, 301, |_, u| {
        let mut input = eccentric(u, [1.0, 0.7, 0.4], [0.0, 20.0]);
        input.environment.drag = true;
        input.plates = (0..6)
            .map(|k| PlateInput {
                name: Name::of(&format!("p{k}")),
                area_m2: u.between(0.5, 3.0),
                normal: u.vector::<3>(1.0),
                center_m: u.vector::<3>(1.5),
                ..PlateInput::DEFAULT
            })
            .collect();
        input
    }),
];

const SEED: u64 = 100;

const COVERAGE: f64 = 0.95;

fn family((name, duration, points, make): Regime, count: u64, seed: u64) -> Family {
    let mut u = Uniform::new(seed);
    let mut scene = |k: u64| {
        let input = make(k, &mut u);
        resolved(&input)
    };
    Family::new(name, Grid::uniform(duration, points), (0..count).map(&mut scene).collect())
}

fn moments_of([x, y, z]: [f64; 3]) -> [f64; 3] {
    [y + z, x + z, x + y].map(|moment| 5.0 * moment)
}

fn shape(u: &mut Uniform, [low, high]: [f64; 2]) -> [f64; 3] {
    moments_of([u.between(low, high), u.between(low, high), u.between(low, high)])
}

fn rates(u: &mut Uniform, [low, high]: [f64; 2]) -> [f64; 3] {
    let size = libm::pow(10.0, u.between(low, high));
    u.vector::<3>(1.0).map(|x| size * x)
}

fn fastest(u: &mut Uniform, moments: [f64; 3], most: f64) -> f64 {
    let turning = libm::pow(most, u.between(0.0, 1.0));
    turning * moments.into_iter().fold(f64::INFINITY, f64::min)
}

fn free(moments: [f64; 3], rate: [f64; 3]) -> SceneInput {
    let [x, y, z] = moments;
    let mut input = SceneInput {
        body: BodyInput {
            mass_kg: Some(100.0),
            center_of_mass_m: Some([0.0; 3]),
            inertia_kg_m2: Some([[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]]),
            ..BodyInput::DEFAULT
        },
        ..SceneInput::blank()
    };
    input.initial.angular_velocity_rad_s = rate;
    input
}

fn with_wheels(mut input: SceneInput, u: &mut Uniform, momenta: &[f64]) -> SceneInput {
    const AXIAL: f64 = 0.05;
    for (k, momentum) in momenta.iter().enumerate() {
        let mut axis = u.vector::<3>(1.0);
        if u.bits().is_multiple_of(3) {
            axis = from_fn(|i| if i == k % 3 { 1.0 } else { 0.0 });
        }
        let name = format!("w{}", k + 1);
        let wheel = WheelInput {
            mass_kg: Some(1.0),
            axial_inertia_kg_m2: Some(AXIAL),
            transverse_inertia_kg_m2: Some(0.6 * AXIAL),
            radius_m: None,
            length_m: None,
            density_kg_m3: None,
            rate_rad_s: momentum / AXIAL,
            ..WheelInput::named(&name, axis, [0.0; 3])
        };
        input = input.with_wheel(wheel);
    }
    input
}

fn on_the_separatrix(u: &mut Uniform, moments: [f64; 3], [low, high]: [f64; 2]) -> [f64; 3] {
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| moments[*a].total_cmp(&moments[*b]));
    let [least, middle, most] = order.map(|axis| moments[axis]);
    // 2 T J_2 = |L|^2: J_1 (J_2 - J_1) w_1^2 = J_3 (J_3 - J_2) w_3^2
    let ratio = (least * (middle - least) / (most * (most - middle))).sqrt();
    let (across, size) = (u.between(-1.5, 1.5), u.between(0.5, 3.0));
    let off = libm::pow(10.0, u.between(low, high));
    let mut rate = [0.0; 3];
    rate[order[0]] = size * libm::sin(across);
    rate[order[1]] = size * libm::cos(across);
    rate[order[2]] = size * libm::sin(across) * ratio * (1.0 + off * u.between(-1.0, 1.0));
    rate
}

/// On an orbit of 37,000 s with a perigee of 500 to 8,000 km, turning at `rates` times the mean motion.
fn eccentric(u: &mut Uniform, second: [f64; 3], rates: [f64; 2]) -> SceneInput {
    let axis = 2.4e7;
    let perigee = u.between(6.88e6, 1.4e7);
    let mut angle = || Some(u.between(-3.0, 3.0));
    let orbit = OrbitInput {
        semi_major_axis_m: Some(axis),
        eccentricity: Some(1.0 - perigee / axis),
        inclination_rad: angle(),
        ascending_node_rad: angle(),
        argument_of_periapsis_rad: angle(),
        true_anomaly_rad: angle(),
        epoch: Epoch::parse("2026-06-01T00:00:00Z"),
        ..OrbitInput::DEFAULT
    };
    let mut input = body(moments_of(second), orbit);
    let motion = (MU / axis).sqrt() / axis;
    let rate = motion * u.between(rates[0], rates[1]);
    input.initial.angular_velocity_rad_s = u.vector::<3>(1.0).map(|x| rate * x);
    input.initial.attitude = u.unit_quaternion();
    input
}

fn measured(count: u64) -> Vec<Measured> {
    let families: Vec<Family> =
        REGIMES.into_iter().zip(SEED..).map(|(regime, seed)| family(regime, count, seed)).collect();
    let methods: Vec<Method> = Method::ALL.into_iter().filter(|method| *method != Method::NullSpace).collect();
    of_families(&families, &methods, count)
}

fn found(all: &[Measured], factor: f64) -> Vec<String> {
    let mut found = breaches(all, factor);
    for (name, ..) in REGIMES {
        let runs = || all.iter().filter(|one| one.family == name).flat_map(|one| &one.runs);
        let covered = runs().filter(|run| Found { estimate: factor * run.estimate, ..**run }.is_covered()).count();
        if (covered as f64) < COVERAGE * runs().count() as f64 {
            found.push(format!("{name}: covered {covered} of {}", runs().count()));
        }
    }
    found
}

#[test]
fn estimates_cover_in_hard_families() {
    let all = measured(4);
    let breached = found(&all, 1.0);
    assert!(breached.is_empty(), "{breached:#?}");
}

#[test]
#[ignore = "minutes: cargo test --release --test accuracy -- --ignored the_estimate_covers"]
fn the_estimate_covers_in_hard_families_of_many_runs() {
    let breached = found(&measured(100), 1.0);
    assert!(breached.is_empty(), "{breached:#?}");
}
