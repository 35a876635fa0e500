//! Random scenes that are a function of a number: the same on every machine, in every version of any crate.

use spindrift::scene::{
    ActuationInput, ActuatorsInput, DebrisInput, FuselageInput, InitialInput, MassErrors, Scene, SceneInput,
    WheelInput, WheelMode,
};

/// What a random scene has beyond a bare fuselage.
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

/// The scene number `seed` of a kind: rates up to 10 rad/s, wheels up to 100 rad/s; forced ones over `horizon` seconds.
pub fn random(kind: Kind, seed: u64, horizon: f64) -> SceneInput {
    let mut u = Uniform::new(seed);
    let wall_thickness_m = u.between(0.01, 0.1);
    let length_m = u.between(1.0, 5.0);
    let outer_radius_m = u.between(0.4, 2.0);
    let mut fuselage = FuselageInput {
        wall_thickness_m,
        outer_radius_m,
        length_m,
        density_kg_m3: u.between(500.0, 5000.0),
        thruster_offset_m: u.between(0.0, outer_radius_m),
        mass_kg: None,
        center_of_mass_m: None,
        inertia_kg_m2: None,
        principal: None,
        errors: MassErrors::NONE,
    };
    let wheels = kind.wheels.map(|present| {
        let wheel = WheelInput {
            radius_m: u.between(0.05, 0.3),
            length_m: u.between(0.02, 0.2),
            station_m: u.between(0.0, length_m),
            density_kg_m3: u.between(500.0, 8000.0),
            offset_m: [0.0; 2],
            tilt_rad: [0.0; 2],
            mode: WheelMode::Free,
        };
        present.then_some(wheel)
    });
    // moments between 1 and 2 and products below 1/4 keep the triangle inequality: |product| sum < smallest slack
    let (size, moments, products) = (u.between(500.0, 3000.0), u.vector::<3>(0.5), u.vector::<3>(0.12));
    let offset: [f64; 3] = u.vector(0.2);
    if kind.products {
        let [a, b, c] = products.map(|x| size * x);
        let [x, y, z] = moments.map(|x| size * (1.3 + 0.5 * x));
        fuselage.inertia_kg_m2 = Some([[x, a, b], [a, y, c], [b, c, z]]);
        fuselage.mass_kg = Some(u.between(500.0, 3000.0));
    }
    if kind.offset {
        fuselage.center_of_mass_m = Some([offset[0], offset[1], 0.5 * length_m + offset[2]]);
    }
    let sides: [f64; 3] = std::array::from_fn(|_| u.between(0.05, 0.8));
    let debris = match kind.debris {
        1 => Some(DebrisInput::Cube { side_m: sides[0], density_kg_m3: 2000.0 }),
        2 => Some(DebrisInput::Box { size_m: sides, density_kg_m3: 2000.0 }),
        _ => None,
    };
    let initial = InitialInput {
        position_m: u.vector(10.0),
        velocity_m_s: u.vector(10.0),
        attitude: u.unit_quaternion(),
        angular_velocity_rad_s: u.vector(10.0),
        wheel_angles_rad: u.vector(3.0),
        wheel_rates_rad_s: u.vector(100.0),
        debris_position_m: u.vector(10.0),
        debris_velocity_m_s: u.vector(10.0),
        debris_attitude: u.unit_quaternion(),
        debris_relative_angular_velocity_rad_s: u.vector(5.0),
    };
    let mut actuation = Vec::new();
    if kind.forced {
        let mut interval = |start_s: f64, end_s: f64| {
            let thrust_n = std::array::from_fn(|_| u.between(0.0, 100.0));
            let torque: [f64; 2] = u.vector(3.0);
            let torque_n_m = std::array::from_fn(|i| if kind.wheels[i] { torque[i] } else { 0.0 });
            actuation.push(ActuationInput { start_s, end_s, thrust_n, torque_n_m });
        };
        interval(0.125 * horizon, 0.3 * horizon);
        interval(0.3 * horizon, 0.75 * horizon);
    }
    SceneInput {
        fuselage,
        wheels,
        debris,
        initial,
        actuation,
        actuators: ActuatorsInput::IDEAL,
        ..SceneInput::default()
    }
}

/// `input` with motors that hold the speed of the wheels named by `held`, which then have no torque in the schedule.
pub fn speed_held(mut input: SceneInput, held: [bool; 2]) -> SceneInput {
    for w in (0..2).filter(|w| held[*w]) {
        if let Some(wheel) = &mut input.wheels[w] {
            wheel.mode = WheelMode::SpeedHeld;
        }
        for interval in &mut input.actuation {
            interval.torque_n_m[w] = 0.0;
        }
    }
    input
}

/// `input` with wheels that stand off the axis s3 by up to 0.2 m, and axes and thrusters that are tilted by up to 0.3 rad each way.
pub fn misaligned(mut input: SceneInput, seed: u64) -> SceneInput {
    let mut u = Uniform::new(!seed);
    for wheel in input.wheels.iter_mut().flatten() {
        wheel.offset_m = u.vector(0.2);
        wheel.tilt_rad = u.vector(0.3);
    }
    input.actuators.thruster1_tilt_rad = u.vector(0.3);
    input.actuators.thruster2_tilt_rad = u.vector(0.3);
    input.actuators.thruster3_tilt_rad = u.vector(0.3);
    input
}

/// `count` scenes of all kinds, all forced or none; with debris, as a campaign has it for all of its samples or for none.
pub fn mixed(count: u64, forced: bool, horizon: f64) -> Vec<Scene> {
    let kind = |k: u64| Kind {
        wheels: [k % 4 != 1, k % 4 != 2],
        debris: if k.is_multiple_of(3) { 2 } else { 1 },
        products: k % 2 == 1,
        offset: k % 5 > 1,
        forced,
    };
    let scene = |k: u64| Scene::resolve(&random(kind(k), 1000 + k, horizon)).expect("random scenes are physical");
    (0..count).map(scene).collect()
}
