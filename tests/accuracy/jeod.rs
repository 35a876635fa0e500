//! NASA's JEOD: free rotation, pulses of torque and force on the space station, and the gravity gradient on a circle
//! and an ellipse, over eight hours of a two-body orbit.

use crate::prelude::*;

pub struct JeodRun {
    name: String,
    craft: Craft,
    /// At time zero, m and m/s.
    start: [[f64; 3]; 2],
    /// F_s -> F_e at time zero: JEOD's left quaternion, with minus its vector.
    attitude: [f64; 4],
    /// At time zero and after 28,800 s, F_s, rad/s.
    rates: [[f64; 3]; 2],
    position: [f64; 3],
    /// `T_parent_this` after 28,800 s, by rows.
    dcm: [[f64; 3]; 3],
    /// Largest distance of JEOD from the reference solution: m, rad/s, and in its matrix.
    own: [f64; 3],
}

#[derive(Clone, Copy, PartialEq)]
enum Craft {
    Cylinder,
    Sphere,
    /// The space station under 10 N m about s1 from 1000 s to 2000 s, with this force along s1, N.
    Station(f64),
}

/// With zero rate (8A, 9A, 9C) and that of the orbit (8B, 9B, 9D); then on a circle (10A) and an ellipse (10C, and 10D
/// with a rate in pitch).
pub fn jeod_runs() -> Vec<JeodRun> {
    let file: Value = serde_json::from_str(include_str!("../golden/jeod.json")).unwrap();
    let craft = |run: &Value| match (run["craft"].as_str(), run["force_n"].as_f64()) {
        (_, Some(force)) => Craft::Station(force),
        (Some("sphere"), _) => Craft::Sphere,
        _ => Craft::Cylinder,
    };
    let of = |run: &Value| JeodRun {
        name: run["name"].as_str().unwrap().to_owned(),
        craft: craft(run),
        start: [numbers(&run["position_m"][0]), numbers(&run["velocity_m_s"])],
        attitude: numbers(&run["attitude"]),
        rates: [0, 1].map(|time| numbers(&run["rates_rad_s"][time])),
        position: numbers(&run["position_m"][1]),
        dcm: [0, 1, 2].map(|row| numbers(&run["dcm"][row])),
        own: numbers(&run["own"]),
    };
    file["runs"].as_array().unwrap().iter().map(of).collect()
}

fn numbers<const N: usize>(list: &Value) -> [f64; N] {
    from_fn(|place| list[place].as_f64().unwrap())
}

impl JeodRun {
    pub fn input(&self, acts: bool) -> SceneInput {
        let [position, velocity] = self.start;
        let orbit = OrbitInput {
            mu_m3_s2: 3.986004415e14,
            position_m: Some(position),
            velocity_m_s: Some(velocity),
            ..OrbitInput::DEFAULT
        };
        let moments = if self.craft == Craft::Sphere { [0.4; 3] } else { [500.0, 12250.0, 12250.0] };
        let mut input = body(moments, orbit);
        input.environment.gravity_gradient = acts && self.craft == Craft::Cylinder;
        input.initial.angular_velocity_rad_s = self.rates[0];
        input.initial.attitude = self.attitude;
        match self.craft {
            Craft::Cylinder => input,
            Craft::Sphere => {
                input.body.mass_kg = Some(1.0);
                input
            }
            Craft::Station(force) => station(input, acts, force),
        }
    }
}

fn station(mut input: SceneInput, acts: bool, force: f64) -> SceneInput {
    let center = [-3.0, -1.5, 4.0];
    input.body.mass_kg = Some(4e5);
    input.body.center_of_mass_m = Some(center);
    input.body.inertia_kg_m2 = Some([[1.02e8, -6.96e6, -5.48e6], [-6.96e6, 0.91e8, 5.9e5], [-5.48e6, 5.9e5, 1.64e8]]);
    let thruster = |name: &str, arm: [f64; 3], direction| ThrusterInput {
        name: Name::of(name),
        ..ThrusterInput::named("p", sum(center, arm), direction)
    };
    input.thrusters = vec![
        thruster("up", [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        thruster("down", [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]),
        thruster("ahead", [0.0; 3], [1.0, 0.0, 0.0]),
    ];
    if acts {
        input.with_actuation(ActuationInput::idle(1000.0, 2000.0).with_thrust(&[5.0, 5.0, force]))
    } else {
        input
    }
}

/// Truth: NASA JEOD after eight hours.
#[test]
fn nasa_jeod_runs() {
    let grid = Grid::uniform(28_800.0, 481);
    let runs = jeod_runs();
    assert_eq!(runs.len(), 9);
    for jeod in &runs {
        let scene = resolved(&jeod.input(true));
        let exact = solved(&scene, &grid, everything(Method::Auto)).high;
        let from = |table: &StateTable, position: [f64; 3], rate: [f64; 3], dcm: [[f64; 3]; 3]| {
            let c_es = dcm_from_quaternion(table.at(StateField::Attitude, 480));
            let entries = (0..9).map(|k| (c_es[k % 3][k / 3] - dcm[k / 3][k % 3]).abs());
            [
                norm(difference(table.at(StateField::ComPosition, 480), position)),
                norm(difference(table.at(StateField::Rate, 480), rate)),
                entries.fold(0.0, f64::max),
            ]
        };
        let c_es = dcm_from_quaternion(exact.at(StateField::Attitude, 480));
        let transposed = from_fn(|i| from_fn(|j| c_es[j][i]));
        for (method, control) in near_rounding(ForceModel::of(&scene)) {
            let run = propagate_one(method, control, &grid, &scene);
            let off = from(&run.table, jeod.position, jeod.rates[1], jeod.dcm);
            let ours =
                from(&run.table, exact.at(StateField::ComPosition, 480), exact.at(StateField::Rate, 480), transposed);
            for (off, bound) in off.into_iter().zip(jeod.own) {
                assert!(off < bound, "{} {}", jeod.name, method.name());
            }
            assert!(ours[0] < 1e-6 && ours[1] < 1e-15 && ours[2] < 2e-13, "{} {}", jeod.name, method.name());
        }
        if jeod.craft != Craft::Sphere {
            let scene = resolved(&jeod.input(false));
            let run = propagate_one(Method::Auto, adaptive(1e-16), &grid, &scene);
            assert!(norm(difference(run.table.at(StateField::Rate, 480), jeod.rates[1])) > 1e-5, "{}", jeod.name);
        }
    }
}
