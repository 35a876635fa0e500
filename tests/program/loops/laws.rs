//! The formulas of the attitude laws, in a loop.

use crate::prelude::*;
use std::fmt::Write as _;

use spindrift::control::laws::KINDS;

use crate::loops::flown_loop::angle_between;

const AGREED: f64 = 1e-14;

const PERIOD: f64 = 0.5;

const INERTIA: [[f64; 3]; 3] = [[30.0, 1.5, -2.0], [1.5, 36.0, 0.7], [-2.0, 0.7, 24.0]];
const AXIAL: [f64; 3] = [0.4, 0.3, 0.5];

const NUMBERS: [(&str, f64); 7] = [
    ("gain_n_m_s", 5.0),
    ("bandwidth_rad_s", 0.3),
    ("damping", 0.8),
    ("stiffness_n_m", 4.0),
    ("damping_n_m_s", 12.0),
    ("integral_1_n_m_s", 0.02),
    ("integral_limit_n_m_s", 1.5),
];

fn number(key: &str) -> f64 {
    NUMBERS.iter().find(|(name, _)| *name == key).expect(key).1
}

fn file(law: &str, keys: &str, target: &str) -> String {
    let mut text = format!(
        "[campaign]\nname = \"law\"\nsamples = 16\nseed = 3\nduration_s = 6.1\n[observe]\npoints = 3\n[body]\nmass_kg \
        = 100\n\
         center_of_mass_m = [0, 0, 0]\ninertia_kg_m2 = {INERTIA:?}\nincludes_wheels = true\n"
    );
    for (i, axial) in AXIAL.iter().enumerate() {
        let axis: [i32; 3] = from_fn(|j| i32::from(i == j));
        let _ = write!(
            text,
            "[[wheels]]\nname = \"w{i}\"\naxis = {axis:?}\nmass_kg = 5\naxial_inertia_kg_m2 = \
            {axial}\ntransverse_inertia_kg_m2 = 0.3\n\
             rate_rad_s = {}\n",
            20 * (i + 1)
        );
    }
    text += "[debris]\nside_m = 0.2\ndensity_kg_m3 = 2700.0\n[initial]\ndebris_position_m = [30, -20, \
        10]\ndebris_velocity_m_s = [1, 3, -2]\n\
             [control]\nperiod_s = 0.5\nwheels = [\"w0\", \"w1\", \"w2\"]\n";
    for (phase, until) in [("first", "until = \"time_in_phase_s > 2.9\"\n"), ("second", "")] {
        let _ = write!(text, "[[guidance]]\nphase = \"{phase}\"\nlaw = \"{law}\"\n{keys}{target}{until}");
    }
    text += "[[disperse]]\nparameter = \"initial.attitude\"\ndistribution = \"attitude_error\"\nstd_rad = 1.0\n\
             [[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\nstd = 0.2\n";
    text
}

struct Seen {
    /// Attitude relative to the target, of the shorter rotation.
    q_ts: [f64; 4],
    omega: [f64; 3],
    omega_te_s: [f64; 3],
    momentum: [f64; 3],
    rotating: [[f64; 3]; 3],
}

fn terms(name: &str, seen: &Seen, integral: &mut [f64; 3], is_first: bool) -> Vec<[f64; 3]> {
    let [w, x, y, z] = seen.q_ts;
    let relative = difference(seen.omega, seen.omega_te_s);
    let rotating = |v| product(seen.rotating, v);
    let gyroscopic = cross(seen.omega, seen.momentum);
    let carried = scaled(-1.0, rotating(cross(seen.omega, seen.omega_te_s)));
    match name {
        "rate_damping" => vec![scaled(-number("gain_n_m_s"), seen.omega)],
        // u = omega x H - 2 w^2 K q_v - 2 z w K omega_st - K (omega x omega_te)
        "quaternion_feedback" | "eigenaxis" => {
            let (bandwidth, damping) = (number("bandwidth_rad_s"), number("damping"));
            let error = scaled(-2.0 * bandwidth * bandwidth, rotating([x, y, z]));
            vec![error, scaled(-2.0 * damping * bandwidth, rotating(relative)), gyroscopic, carried]
        }
        // u = -K s - P omega_st - P Ki z + (omega_te + Ki z) x H - J (omega x omega_te), z = K int s dt + J omega_st
        "mrp_feedback" => {
            let (damping, gain, limit) =
                (number("damping_n_m_s"), number("integral_1_n_m_s"), number("integral_limit_n_m_s"));
            let stiff = scaled(number("stiffness_n_m") / (1.0 + w), [x, y, z]);
            if !is_first {
                *integral = sum(*integral, scaled(PERIOD, stiff)).map(|one| one.clamp(-limit, limit));
            }
            let state = scaled(gain, sum(*integral, rotating(relative)));
            let coupled = cross(sum(seen.omega_te_s, state), seen.momentum);
            vec![scaled(-1.0, stiff), scaled(-damping, relative), scaled(-damping, state), coupled, carried]
        }
        other => panic!("{other} has no formula: add it above"),
    }
}

/// Law: every law of the program commands the torque of docs/control-formulas.md from the estimates of the tick.
#[test]
fn every_law_is_its_formula() {
    let rotating: [[f64; 3]; 3] = from_fn(|i| from_fn(|j| INERTIA[i][j] - if i == j { AXIAL[i] } else { 0.0 }));
    let mut clamped = 0;
    for kind in &*KINDS {
        let keys: String = NUMBERS
            .iter()
            .filter(|(key, _)| kind.parameters.iter().any(|parameter| parameter.facts.key == *key))
            .fold(String::new(), |text, (key, number)| text + &format!("{key} = {number}\n"));
        for target in ["target = \"attitude\"\nattitude = [0.6, 0, -0.8, 0]\n", "target = \"line_to_debris\"\n"] {
            for sample in 1..=6 {
                let flown = FlownLoop::new(&file(kind.name, &keys, target), sample);
                let attitudes = flown.told_vector::<4>("estimated_q_es_#");
                let rates = flown.told_vector::<3>("estimated_omega_se_s_#_rad_s");
                let lines = flown.told_vector::<3>("estimated_to_debris_e_#_m");
                let velocities = flown.told_vector::<3>("estimated_relative_velocity_e_#_m_s");
                let of_wheels =
                    |name: &str| [0, 1, 2].map(|wheel| flown.told(&name.replace('#', &format!("w{wheel}"))));
                let (speeds, commands) = (of_wheels("estimated_rate_#_rad_s"), of_wheels("commanded_torque_#_n_m"));
                let phases = flown.told("phase");
                let mut integral = [0.0; 3];
                for tick in 0..phases.len() {
                    let is_first = tick == 0 || phases[tick] != phases[tick - 1];
                    if is_first {
                        integral = [0.0; 3];
                    }
                    let (q_es, omega) = (attitudes[tick], rates[tick]);
                    let c_es = dcm_from_quaternion(q_es);
                    let (q_ts, omega_te_s) = if target.contains("line") {
                        let (line, velocity) = (lines[tick], velocities[tick]);
                        let in_body = transposed_product(c_es, line);
                        let angle = angle_between([0.0, 0.0, 1.0], in_body);
                        let across = cross(in_body, [0.0, 0.0, 1.0]);
                        let half = scaled((0.5 * angle).sin() / norm(across), across);
                        let turn = scaled(1.0 / dot(line, line), cross(line, scaled(-1.0, velocity)));
                        ([(0.5 * angle).cos(), half[0], half[1], half[2]], transposed_product(c_es, turn))
                    } else {
                        let q = hamilton(conjugate([0.6, 0.0, -0.8, 0.0]), q_es);
                        (if q[0] < 0.0 { q.map(|x| -x) } else { q }, [0.0; 3])
                    };
                    assert!(norm(rotation_vector(q_ts)) > 1e-3);
                    let of_wheels: [f64; 3] = from_fn(|wheel| AXIAL[wheel] * speeds[wheel][tick]);
                    let momentum = sum(product(INERTIA, omega), of_wheels);
                    let seen = Seen { q_ts, omega, omega_te_s, momentum, rotating };
                    let terms = terms(kind.name, &seen, &mut integral, is_first);
                    let expected = terms.iter().fold([0.0; 3], |total, term| sum(total, *term));
                    let size: f64 = terms.iter().map(|term| norm(*term)).sum();
                    let found = [0, 1, 2].map(|wheel| -commands[wheel][tick]);
                    let off = norm(difference(found, expected)) / size;
                    assert!(off < AGREED, "{} {target}, {sample}, {tick}: {found:?} for {expected:?}", kind.name);
                    clamped += usize::from(integral.iter().any(|one| one.abs() == number("integral_limit_n_m_s")));
                }
                assert_eq!(*phases.last().unwrap(), 1.0, "both phases are flown");
            }
        }
    }
    assert!(clamped > 10, "{clamped}");
}
