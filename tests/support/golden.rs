//! Golden data: scenes with states to 25 digits, from a 40-digit Taylor solution of the gyrostat equations.

use super::prelude::*;
use spindrift::scene::InitialInput;

pub struct Golden {
    pub scene: SceneInput,
    /// Ascending in time, the first at zero.
    pub truth: Vec<ReferenceSolution>,
}

/// The true state at one time; SI, frames as in [`InitialInput`].
#[derive(Clone, Debug)]
pub struct ReferenceSolution {
    pub time: f64,
    pub r_po_e: [f64; 3],
    pub v_po_e: [f64; 3],
    /// The sign is free.
    pub q_es: [f64; 4],
    pub omega_se_s: [f64; 3],
    /// Unwrapped.
    pub wheel_angles: [f64; 2],
    pub wheel_rates: [f64; 2],
    /// Kinetic energies of fuselage, W1, W2 and debris in F_e, J.
    pub energies: [f64; 4],
    /// Angular momentum of the spacecraft about c in F_e.
    pub momentum_c_e: [f64; 3],
    pub r_gdo_e: [f64; 3],
    pub v_gdo_e: [f64; 3],
    /// The sign is free.
    pub q_ed: [f64; 4],
    pub omega_de_d: [f64; 3],
}

impl Golden {
    pub fn load(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{name}.json"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let file: Value = serde_json::from_str(&text).unwrap();
        let truth = file["truth"].as_array().unwrap().iter().map(row).collect();
        Golden { scene: scene(&file["scene"]), truth }
    }

    pub fn times(&self) -> Vec<f64> {
        self.truth.iter().map(|row| row.time).collect()
    }
}

fn number(value: &Value) -> f64 {
    match value {
        Value::String(digits) => digits.parse().unwrap(),
        other => other.as_f64().unwrap_or_else(|| panic!("not a number: {other}")),
    }
}

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list = value.as_array().unwrap_or_else(|| panic!("not a list: {value}"));
    assert_eq!(list.len(), N, "length of {value}");
    std::array::from_fn(|i| number(&list[i]))
}

fn scene(scene: &Value) -> SceneInput {
    let (debris, initial) = (&scene["debris"], &scene["initial"]);
    let mut input = SceneInput::report();
    let fuselage = &mut input.parts[0];
    let length_m = number(&scene["fuselage"]["length"]);
    fuselage.wall_thickness_m = Some(number(&scene["fuselage"]["wall_thickness"]));
    fuselage.outer_radius_m = Some(number(&scene["fuselage"]["outer_radius"]));
    fuselage.length_m = Some(length_m);
    fuselage.density_kg_m3 = Some(number(&scene["fuselage"]["density"]));
    fuselage.position_m = [0.0, 0.0, 0.5 * length_m];
    let offset_m = number(&scene["fuselage"]["thruster_offset"]);
    input.thrusters = vec![
        ThrusterInput::named("p1", [0.0; 3], [0.0, 0.0, 1.0]),
        ThrusterInput::named("p2", [0.0, -offset_m, length_m], [0.0, 0.0, -1.0]),
        ThrusterInput::named("p3", [0.0, offset_m, length_m], [0.0, 0.0, -1.0]),
    ];
    let (rates, angles) = (numbers::<2>(&initial["wheel_rates"]), numbers::<2>(&initial["wheel_angles"]));
    let written = [&scene["wheel1"], &scene["wheel2"]];
    for (wheel, written) in written.iter().enumerate() {
        assert!(!written.is_null(), "the golden scenes have both wheels; this one has no wheel {}", wheel + 1);
    }
    for (i, (wheel, written)) in input.wheels.iter_mut().zip(written).enumerate() {
        wheel.radius_m = Some(number(&written["radius"]));
        wheel.length_m = Some(number(&written["length"]));
        wheel.density_kg_m3 = Some(number(&written["density"]));
        wheel.position_m = [0.0, 0.0, number(&written["station"])];
        wheel.rate_rad_s = rates[i];
        wheel.angle_rad = angles[i];
    }
    let mut start_s = 0.0;
    let actuation = scene["segments"].as_array().unwrap().iter().map(|segment| {
        let interval = ActuationInput::idle(start_s, number(&segment["until"]))
            .with_thrust(&numbers::<3>(&segment["thrust"]))
            .with_torque(&numbers::<2>(&segment["torque"]));
        start_s = interval.end_s;
        interval
    });
    input.actuation = actuation.collect();
    input.debris = (!debris.is_null())
        .then(|| DebrisInput::Cube { side_m: number(&debris["side"]), density_kg_m3: number(&debris["density"]) });
    input.initial = InitialInput {
        position_m: numbers(&initial["position"]),
        velocity_m_s: numbers(&initial["velocity"]),
        attitude: numbers(&initial["attitude"]),
        angular_velocity_rad_s: numbers(&initial["angular_velocity"]),
        debris_position_m: numbers(&initial["debris_position"]),
        debris_velocity_m_s: numbers(&initial["debris_velocity"]),
        debris_attitude: numbers(&initial["debris_attitude"]),
        debris_relative_angular_velocity_rad_s: numbers(&initial["debris_relative_angular_velocity"]),
        ..InitialInput::DEFAULT
    };
    input
}

fn row(row: &Value) -> ReferenceSolution {
    ReferenceSolution {
        time: number(&row["t"]),
        r_po_e: numbers(&row["r_p"]),
        v_po_e: numbers(&row["v_p"]),
        q_es: numbers(&row["q"]),
        omega_se_s: numbers(&row["omega"]),
        wheel_angles: numbers(&row["wheel_angles"]),
        wheel_rates: numbers(&row["wheel_rates"]),
        energies: ["T_fuselage", "T_wheel1", "T_wheel2", "T_debris"].map(|key| number(&row[key])),
        momentum_c_e: numbers(&row["L_c"]),
        r_gdo_e: numbers(&row["r_gd"]),
        v_gdo_e: numbers(&row["v_gd"]),
        q_ed: numbers(&row["q_debris"]),
        omega_de_d: numbers(&row["omega_debris"]),
    }
}
