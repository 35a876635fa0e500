//! Random scenes that are a function of a number: the same on every machine, in every version of any crate.

use super::prelude::*;
use spindrift::scene::{InitialInput, PartShape};

#[derive(Clone, Copy, Debug)]
pub struct Kind {
    pub wheels: [bool; 2],
    /// 0: none, 1: cube, 2: box.
    pub debris: u8,
    /// An inertia tensor of its own, with products of inertia.
    pub products: bool,
    /// A centre of mass off the axis.
    pub offset: bool,
    /// Thrusts and motor torques in two intervals, then nothing.
    pub forced: bool,
}

/// Uniform numbers: SplitMix64 (Steele, Lea & Flood 2014).
pub struct Uniform(u64);

impl Uniform {
    pub fn new(seed: u64) -> Self {
        Uniform(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    pub fn uniform(&mut self) -> f64 {
        ((self.bits() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    pub fn vector<const N: usize>(&mut self, size: f64) -> [f64; N] {
        std::array::from_fn(|_| self.between(-size, size))
    }

    pub fn unit_quaternion(&mut self) -> [f64; 4] {
        loop {
            let q: [f64; 4] = self.vector(1.0);
            let norm = |q: [f64; 4]| q.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.1..1.0).contains(&norm(q)) {
                let unit = q.map(|x| x / norm(q));
                // twice, as when a scene divided what it was given: the golden bits are of these numbers
                return unit.map(|x| x / norm(unit));
            }
        }
    }
}

pub fn resolved(input: &SceneInput) -> Scene {
    Scene::resolve(input).unwrap_or_else(|errors| panic!("{}", errors[0]))
}

pub const WHEELS: [&str; 2] = ["w1", "w2"];

pub fn place_of(input: &SceneInput, wheel: usize) -> Option<usize> {
    input.wheels.iter().position(|other| other.name.as_str() == WHEELS[wheel])
}

pub fn set_wheel_rates(input: &mut SceneInput, rates: [f64; 2]) {
    for (wheel, rate) in rates.into_iter().enumerate() {
        if let Some(place) = place_of(input, wheel) {
            input.wheels[place].rate_rad_s = rate;
        }
    }
}

pub fn keep_wheels(input: &mut SceneInput, present: [bool; 2]) {
    input.wheels.retain(|wheel| WHEELS.iter().zip(present).any(|(name, kept)| kept && wheel.name.as_str() == *name));
}

pub fn of_most_wheels(scenes: &[Scene]) -> &Scene {
    scenes.iter().max_by_key(|scene| scene.mass.wheels.len()).unwrap()
}

pub fn random(kind: Kind, seed: u64, horizon: f64) -> SceneInput {
    let mut u = Uniform::new(seed);
    let mut input = SceneInput::report();
    let wall_thickness_m = u.between(0.01, 0.1);
    let length_m = u.between(1.0, 5.0);
    let outer_radius_m = u.between(0.4, 2.0);
    let fuselage = &mut input.parts[0];
    assert_eq!(fuselage.shape, PartShape::HollowCylinder);
    fuselage.wall_thickness_m = Some(wall_thickness_m);
    fuselage.outer_radius_m = Some(outer_radius_m);
    fuselage.length_m = Some(length_m);
    fuselage.density_kg_m3 = Some(u.between(500.0, 5000.0));
    fuselage.position_m = [0.0, 0.0, 0.5 * length_m];
    let thruster_offset_m = u.between(0.0, outer_radius_m);
    input.thrusters = vec![
        ThrusterInput::named("p1", [0.0; 3], [0.0, 0.0, 1.0]),
        ThrusterInput::named("p2", [0.0, -thruster_offset_m, length_m], [0.0, 0.0, -1.0]),
        ThrusterInput::named("p3", [0.0, thruster_offset_m, length_m], [0.0, 0.0, -1.0]),
    ];
    // a wheel that is left out has its numbers drawn too
    for wheel in &mut input.wheels {
        wheel.radius_m = Some(u.between(0.05, 0.3));
        wheel.length_m = Some(u.between(0.02, 0.2));
        wheel.position_m = [0.0, 0.0, u.between(0.0, length_m)];
        wheel.density_kg_m3 = Some(u.between(500.0, 8000.0));
    }
    // moments between 1 and 2 and products below 1/4 keep the triangle inequality: |product| sum < smallest slack
    let (size, moments, products) = (u.between(500.0, 3000.0), u.vector::<3>(0.5), u.vector::<3>(0.12));
    let offset: [f64; 3] = u.vector(0.2);
    if kind.products {
        let [a, b, c] = products.map(|x| size * x);
        let [x, y, z] = moments.map(|x| size * (1.3 + 0.5 * x));
        input.body.inertia_kg_m2 = Some([[x, a, b], [a, y, c], [b, c, z]]);
        input.body.mass_kg = Some(u.between(500.0, 3000.0));
    }
    if kind.offset {
        input.body.center_of_mass_m = Some([offset[0], offset[1], 0.5 * length_m + offset[2]]);
    }
    let sides: [f64; 3] = std::array::from_fn(|_| u.between(0.05, 0.8));
    input.debris = match kind.debris {
        1 => Some(DebrisInput::Cube { side_m: sides[0], density_kg_m3: 2000.0 }),
        2 => Some(DebrisInput::Box { size_m: sides, density_kg_m3: 2000.0 }),
        _ => None,
    };
    let (position_m, velocity_m_s) = (u.vector(10.0), u.vector(10.0));
    let (attitude, angular_velocity_rad_s) = (u.unit_quaternion(), u.vector(10.0));
    input.wheels.iter_mut().for_each(|wheel| wheel.angle_rad = u.between(-3.0, 3.0));
    input.wheels.iter_mut().for_each(|wheel| wheel.rate_rad_s = u.between(-100.0, 100.0));
    input.initial = InitialInput {
        position_m,
        velocity_m_s,
        attitude,
        angular_velocity_rad_s,
        debris_position_m: u.vector(10.0),
        debris_velocity_m_s: u.vector(10.0),
        debris_attitude: u.unit_quaternion(),
        debris_relative_angular_velocity_rad_s: u.vector(5.0),
        ..InitialInput::DEFAULT
    };
    if kind.forced {
        let mut interval = |start_s: f64, end_s: f64| {
            let thrust_n: [f64; 3] = std::array::from_fn(|_| u.between(0.0, 100.0));
            let torque: [f64; 2] = u.vector(3.0);
            let present = (0..2).filter(|wheel| kind.wheels[*wheel]);
            let torque_n_m: Vec<f64> = present.map(|wheel| torque[wheel]).collect();
            ActuationInput::idle(start_s, end_s).with_thrust(&thrust_n).with_torque(&torque_n_m)
        };
        input.actuation = vec![interval(0.125 * horizon, 0.3 * horizon), interval(0.3 * horizon, 0.75 * horizon)];
    }
    keep_wheels(&mut input, kind.wheels);
    input
}

pub fn speed_held(mut input: SceneInput, held: [bool; 2]) -> SceneInput {
    for place in (0..2).filter(|w| held[*w]).filter_map(|w| place_of(&input, w)).collect::<Vec<_>>() {
        input.wheels[place].mode = WheelMode::SpeedHeld;
        for interval in &mut input.actuation {
            interval.torque_n_m[place] = 0.0;
        }
    }
    input
}

/// With wheels off the axis s3 by up to 0.2 m, and axes and thrusters tilted by up to 0.3 rad each way.
pub fn misaligned(mut input: SceneInput, seed: u64) -> SceneInput {
    let mut u = Uniform::new(!seed);
    for wheel in &mut input.wheels {
        let [x, y] = u.vector(0.2);
        wheel.position_m = [x, y, wheel.position_m[2]];
        wheel.tilt_rad = u.vector(0.3);
    }
    for thruster in &mut input.thrusters {
        thruster.tilt_rad = u.vector(0.3);
    }
    input
}

pub fn mixed_kind(k: u64, forced: bool) -> Kind {
    Kind {
        wheels: [k % 4 != 1, k % 4 != 2],
        debris: if k.is_multiple_of(3) { 2 } else { 1 },
        products: k % 2 == 1,
        offset: k % 5 > 1,
        forced,
    }
}

pub fn mixed(count: u64, forced: bool, horizon: f64) -> Vec<Scene> {
    let input = |k: u64| random(mixed_kind(k, forced), 1000 + k, horizon);
    (0..count).map(|k| resolved(&input(k))).collect()
}

/// Numbers of wheels of [`many_wheels`].
pub const COUNTS: [usize; 6] = [0, 1, 2, 3, 4, 8];

/// `count` wheels at any place, free, speed-held or locked, and up to sixteen thrusters.
pub fn many_wheels(count: usize, k: u64, forced: bool, horizon: f64) -> SceneInput {
    let bare = Kind { wheels: [false; 2], debris: 0, products: k % 2 == 1, offset: k % 3 == 1, forced: false };
    let mut input = random(bare, 9000 + k, horizon);
    let mut u = Uniform::new(!(9000 + k));
    for number in 0..count {
        let axis = if u.bits().is_multiple_of(4) { [0.0, 0.0, -2.0] } else { u.vector(1.0) };
        let mut wheel = WheelInput::named(&format!("w{number}"), axis, u.vector(1.5));
        wheel.radius_m = Some(u.between(0.05, 0.3));
        wheel.length_m = Some(u.between(0.02, 0.2));
        wheel.density_kg_m3 = Some(u.between(500.0, 8000.0));
        wheel.tilt_rad = u.vector(0.1);
        let (rate, angle) = (u.between(-100.0, 100.0), u.between(-3.0, 3.0));
        wheel.mode = match u.bits() % 5 {
            0 => WheelMode::Locked,
            1 => WheelMode::SpeedHeld,
            _ => WheelMode::Free,
        };
        if wheel.mode != WheelMode::Locked {
            (wheel.rate_rad_s, wheel.angle_rad) = (rate, angle);
        }
        input.wheels.push(wheel);
    }
    input.thrusters = (0..u.bits() % 17)
        .map(|number| {
            let mut thruster = ThrusterInput::named(&format!("p{number}"), u.vector(2.0), u.vector(1.0));
            thruster.tilt_rad = u.vector(0.1);
            thruster
        })
        .collect();
    if forced {
        let mut interval = |start_s: f64, end_s: f64| {
            let thrust_n: Vec<f64> = input.thrusters.iter().map(|_| u.between(0.0, 100.0)).collect();
            let torque = |wheel: &WheelInput| {
                let torque = u.between(-3.0, 3.0);
                if wheel.mode == WheelMode::Free { torque } else { 0.0 }
            };
            let torque_n_m: Vec<f64> = input.wheels.iter().map(torque).collect();
            ActuationInput::idle(start_s, end_s).with_thrust(&thrust_n).with_torque(&torque_n_m)
        };
        input.actuation = vec![interval(0.125 * horizon, 0.3 * horizon), interval(0.3 * horizon, 0.75 * horizon)];
    }
    input
}
