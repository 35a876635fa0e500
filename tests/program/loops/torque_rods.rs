//! Torque rods in a loop: dipoles of the laws within their limits, and the motion under m x B.

use crate::prelude::*;

use super::flown_loop::{FlownLoop, State};

const MOMENTS: [f64; 3] = [0.12, 0.14, 0.09];
const WHEEL: f64 = 1e-4;

struct Craft {
    duration: f64,
    period: f64,
    limit: f64,
    errors: &'static str,
    wheels: [f64; 3],
    initial: &'static str,
    phase: String,
}

impl Craft {
    fn tumbling(duration: f64, period: f64, limit: f64, gain: f64) -> Self {
        Craft {
            duration,
            period,
            limit,
            errors: "",
            wheels: [0.0; 3],
            initial: "angular_velocity_rad_s = [\"3 deg/s\", \"-2 deg/s\", \"2 deg/s\"]",
            phase: format!("rods = \"b_dot\"\nb_dot_gain_a_m2_s_t = {gain:?}"),
        }
    }

    fn flown(&self, sample: u64) -> FlownLoop {
        let Craft { duration, period, limit, errors, initial, phase, .. } = self;
        let names = ["x", "y", "z"];
        let axes = ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"];
        let (mut parts, mut driven) = (String::new(), String::new());
        for (i, (name, axis)) in names.iter().zip(axes).enumerate() {
            let scale = if i == 1 { 0.5 } else { 1.0 };
            parts += &format!(
                "[[torque_rods]]\nname = \"m{name}\"\naxis = {axis}\nmax_dipole_a_m2 = {limit:?}\ndipole_scale = \
                {scale:?}\n"
            );
            if self.wheels != [0.0; 3] {
                parts += &format!(
                    "[[wheels]]\nname = \"w{name}\"\naxis = {axis}\nposition_m = [0, 0, 0]\nmass_kg = \
                    0.1\naxial_inertia_kg_m2 = {WHEEL:?}\n\
                     transverse_inertia_kg_m2 = 6e-5\nrate_rad_s = {:?}\n",
                    self.wheels[i]
                );
                driven = "wheels = [\"wx\", \"wy\", \"wz\"]\n".into();
            }
        }
        let text = format!(
            "[campaign]\nname = \"rods\"\nsamples = 4\nseed = 1\nduration_s = {duration:?}\n[observe]\npoints = 11\n\
             groups = [\"final_state\", \"motion\", \"numerics\", \"energy_conservation\", \"momentum_conservation\", \
             \"orbit\"]\n\
             [body]\nmass_kg = 12.0\nincludes_wheels = true\nprincipal_moments_kg_m2 = {MOMENTS:?}\n{parts}\
             [initial]\n{initial}\n[orbit]\nepoch = \"2026-11-24T00:00:00Z\"\nsemi_major_axis_m = \
             6.928e6\ninclination_rad = 1.7\n\
             [environment]\nmagnetic_field = \"dipole\"\n\
             [control]\nperiod_s = {period:?}\ntorque_rods = [\"mz\", \"mx\", \"my\"]\n{driven}\
             [[sensors]]\nname = \"field\"\nkind = \"magnetometer\"\n{errors}\n[[guidance]]\nphase = \
             \"hold\"\n{phase}\n\
             [[disperse]]\nparameter = \"body.inertia_scale\"\ndistribution = \"offset\"\noffset = 0.0\n"
        );
        FlownLoop::new(&text, sample)
    }
}

fn field_e(flown: &FlownLoop, state: &State) -> [f64; 3] {
    MagneticField::of(&flown.run.scene).unwrap().at(state.time, state.r_co_e)
}

fn dipole(flown: &FlownLoop, state: &State) -> [f64; 3] {
    let arc = flown.arcs.iter().find(|(arc, _)| (arc.start - state.time).abs() < 1e-6);
    arc.unwrap().0.applied.dipole
}

fn momenta(state: &State) -> [[f64; 3]; 2] {
    let wheels = from_fn(|i| WHEEL * state.wheel_rates.get(i).copied().unwrap_or_default());
    [state.to_e(from_fn(|i| MOMENTS[i] * state.omega_se_s[i])), state.to_e(wheels)]
}

/// Law: B-dot commands -k times the rate of the measured field, scaled as a whole at a limit.
#[test]
fn b_dot_is_its_formula() {
    const LIMIT: f64 = 0.3;
    const PERIOD: f64 = 2.0;
    const GAIN: f64 = 4e5;
    let craft = Craft {
        errors: "bias_t = [1e-7, -2e-7, 3e-7]\nnoise_t = [5e-8, 5e-8, 5e-8]",
        ..Craft::tumbling(1500.0, PERIOD, LIMIT, GAIN)
    };
    for sample in [0, 1] {
        let flown = craft.flown(sample);
        let told = flown.told_vector::<3>("measured_field_s_#_t");
        let commands = flown.told_vector::<3>("commanded_dipole_m#_a_m2");
        let (mut limited, mut free, mut largest) = (0, 0, 0.0_f64);
        for (tick, state) in flown.ticks.iter().enumerate() {
            let wanted =
                if tick == 0 { [0.0; 3] } else { scaled(-GAIN / PERIOD, difference(told[tick], told[tick - 1])) };
            let most = wanted.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let expected = scaled(if most > LIMIT { LIMIT / most } else { 1.0 }, wanted);
            *(if most > LIMIT { &mut limited } else { &mut free }) += 1;
            assert!(norm(difference(commands[tick], expected)) < 1e-12, "{tick}: {:?} {expected:?}", commands[tick]);
            let [x, y, z] = commands[tick];
            assert!(norm(difference(dipole(&flown, state), [x, 0.5 * y, z])) < 1e-12, "{tick}");
            largest = largest.max(norm([x, 0.5 * y, z]));
        }
        assert!(limited > 20 && free > 20, "{limited} {free}");
        let rate = |tick: usize| norm(flown.ticks[tick].omega_se_s);
        assert!(rate(flown.ticks.len() - 1) < 0.6 * rate(0), "{} of {}", rate(flown.ticks.len() - 1), rate(0));
        let column = |name: &str| value(&flown.run, name);
        assert!((column("rod_dipole_max_a_m2") / largest - 1.0).abs() < 1e-12);
        let torque = |pair: &[State]| norm(cross(pair[1].to_e(dipole(&flown, &pair[0])), field_e(&flown, &pair[1])));
        let torques = flown.ticks.windows(2).map(torque);
        let excess = column("magnetic_torque_max_n_m") / torques.fold(0.0, f64::max) - 1.0;
        assert!(excess > -1e-12 && excess < 0.1, "{excess:e}");
        assert!((column("rod_saturated_time_s") - PERIOD * f64::from(limited)).abs() < 1e-6);
    }
}

/// Law (P. J. Camillo & F. L. Markley, 1980): unloading rods change the momentum by H' = -(H - B (B . H)/|B|^2)/T.
#[test]
fn wheels_are_unloaded_as_theory_says() {
    const TIME: f64 = 400.0;
    let keep = "law = \"quaternion_feedback\"\nbandwidth_rad_s = 0.1\ndamping = 0.9\ntarget = \"attitude\"\nattitude = \
        [1, 0, 0, 0]";
    let craft = |rods: &str| Craft {
        duration: 1200.0,
        period: 1.0,
        limit: 50.0,
        errors: "",
        wheels: [60.0, -40.0, 50.0],
        initial: "angular_velocity_rad_s = [0, 0, 0]",
        phase: format!("{keep}\nrods = {rods}"),
    };
    let of = |flown: &FlownLoop, tick: usize| {
        let [body, wheels] = momenta(&flown.ticks[tick]);
        sum(body, wheels)
    };
    let flown = craft(&format!("\"unloading\"\nrod_unloading_time_s = {TIME:?}")).flown(0);
    let mut h = of(&flown, 0);
    let start = norm(h);
    let rate = |state: &State, h: [f64; 3]| {
        let b = field_e(&flown, state);
        let m = state.to_s(scaled(1.0 / (TIME * dot(b, b)), cross(h, b)));
        cross(state.to_e([m[0], 0.5 * m[1], m[2]]), b)
    };
    let (mut worst, mut turned) = (0.0_f64, 0.0_f64);
    for (tick, pair) in flown.ticks.windows(2).enumerate() {
        let first = rate(&pair[0], h);
        let second = rate(&pair[1], sum(h, first));
        h = sum(h, scaled(0.5, sum(first, second)));
        worst = worst.max(norm(difference(of(&flown, tick + 1), h)));
        let [_, x, y, z] = pair[1].q_es;
        turned = turned.max(2.0 * norm([x, y, z]));
    }
    assert!(norm(h) < 0.6 * start && worst < 0.005 * start, "{start:e} to {:e}: {worst:e}", norm(h));
    assert!(turned < 0.01, "{turned}");
    let idle = craft("\"b_dot\"\nb_dot_gain_a_m2_s_t = 1e-9").flown(0);
    let change = norm(difference(of(&idle, idle.ticks.len() - 1), of(&idle, 0)));
    assert!(change < 1e-6 * start, "{change:e}");
}
