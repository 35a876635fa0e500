//! Flight software does not know the numbers that a run has drawn.

use crate::prelude::*;

/// `net_launch.toml` without phases and draws, with one phase that turns to an attitude and stops the motion
/// `along_s3`, m/s.
fn braking(estimator: &str, along_s3: f64) -> String {
    let start = NET_LAUNCH.find("[[guidance]]").unwrap();
    let text = match estimator {
        "mekf" => NET_LAUNCH[..start].to_owned(),
        other => without_filters(&NET_LAUNCH[..start], other),
    };
    let text = changed(
        &text,
        &[
            ("duration_s = 2400.0", "duration_s = 30.2"),
            ("velocity_m_s = [0.05, 0.02, 0.0]", &format!("velocity_m_s = [0.05, 0.02, {along_s3:?}]")[..]),
            ("modulation = \"pulse_width\"", "modulation = \"throttled\""),
        ],
    );
    text + "[[guidance]]\nphase = \"brake\"\nlaw = \"quaternion_feedback\"\nbandwidth_rad_s = 0.06\ndamping = \
        0.9\ntarget = \"attitude\"\n\
            attitude = [0.9, 0.1, 0.3, 0.3]\nthrust = \"stop\"\nunloading_time_s = 60.0\n"
}

fn offset(parameter: &str, offset: f64) -> String {
    format!("\n[[disperse]]\nparameter = \"{parameter}\"\ndistribution = \"offset\"\noffset = {offset:?}\n")
}

fn first_commands(text: &str) -> (Vec<f64>, bool) {
    let flown = FlownLoop::new(text, 1);
    let names = [
        "commanded_torque_w1_n_m",
        "commanded_torque_w2_n_m",
        "commanded_thrust_p1_n",
        "commanded_thrust_p2_n",
        "commanded_thrust_p3_n",
    ];
    let nominal = resolved(&flown.plan.nominal);
    let (drawn, nominal) = (&flown.run.scene, &nominal);
    let is_drawn =
        drawn.mass != nominal.mass || drawn.thrusters != nominal.thrusters || drawn.actuators != nominal.actuators;
    (names.iter().map(|name| flown.told(name)[0]).collect(), is_drawn)
}

/// Law: where the state is known, the first command depends on no drawn number of spacecraft, wheels, thrusters or
/// debris.
#[test]
fn commands_do_not_depend_on_what_is_drawn() {
    // at rest, so that the velocity of the centre of mass is that of p
    let text = changed(
        &braking("perfect", -0.002),
        &[(
            "angular_velocity_rad_s = [\"0.4 deg/s\", \"-0.6 deg/s\", \"0.8 deg/s\"]",
            "angular_velocity_rad_s = [0, 0, 0]",
        )],
    );
    let turning = changed(&braking("perfect", -0.002), &[("thrust = \"stop\"\n", "")]);
    const ROUNDING: f64 = 1e-12;
    let mut drawn = 0;
    for text in [text, turning] {
        let (expected, _) = first_commands(&text);
        let acting = expected.iter().filter(|command| **command != 0.0).count();
        assert!(acting > 2 && expected.iter().all(|command| command.is_finite()), "{expected:?}");
        assert!(expected[2..].iter().zip([20.0, 10.0, 10.0]).all(|(thrust, most)| *thrust < most), "{expected:?}");
        let plan = plan(&text);
        let parameters = Parameter::all(&plan.nominal).filter(|parameter| parameter.exists(&plan.nominal));
        let of_state =
            |name: &str| name.starts_with("initial.") || name.ends_with("rate_rad_s") || name.ends_with("angle_rad");
        let of_software =
            |name: &str| ["control.", "sensors.", "guidance."].iter().any(|start| name.starts_with(start));
        for parameter in parameters {
            let name = parameter.name();
            if of_state(&name) || of_software(&name) {
                continue;
            }
            let dispersed = text.clone() + &offset(&name, 1e-3);
            if parsed(&dispersed).is_err() {
                continue;
            }
            let (found, is_drawn) = first_commands(&dispersed);
            let off = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < ROUNDING, "{name} is drawn: {found:?} for {expected:?}");
            drawn += usize::from(is_drawn);
        }
        let (moved, _) = first_commands(&(text.clone() + &offset("initial.velocity_m_s.z", 0.01)));
        assert!(moved != expected || !text.contains("thrust = \"stop\""), "the state is known");
    }
    assert!(drawn > 60, "{drawn} numbers change the scene");
}

fn mean_of_interval(commands: &[f64], delay: f64, period: f64) -> Vec<f64> {
    let whole = (delay / period).floor();
    let late = delay / period - whole;
    let at = |tick: usize, back: usize| tick.checked_sub(back).map_or(0.0, |place| commands[place]);
    let back = whole as usize;
    (0..commands.len()).map(|tick| (1.0 - late) * at(tick, back) + late * at(tick, back + 1)).collect()
}

#[test]
fn filters_predict_with_commands_and_nominal_numbers() {
    const ROUNDING: f64 = 2e-13;
    for delay in [0.0, 0.1, 0.5, 0.7] {
        let mut text = changed(&braking("mekf", -0.2), &[("delay_s = 0.1", &format!("delay_s = {delay:?}")[..])]);
        for (from, to) in [
            ("latency_s = 0.5\nnoise_rad", "period_s = 2000.0\nlatency_s = 0.5\nnoise_rad"),
            ("period_s = 2.0\nlatency_s = 1.0", "period_s = 2000.0\nlatency_s = 1.0"),
            ("period_s = 1.0\nlatency_s = 0.5\nattitude", "period_s = 2000.0\nlatency_s = 0.5\nattitude"),
            ("kind = \"tachometers\"\n", "kind = \"tachometers\"\nperiod_s = 2000.0\n"),
        ] {
            text = changed(&text, &[(from, to)]);
        }
        for (parameter, by) in [
            ("body.parts.fuselage.mass_scale", 0.2),
            ("thrusters.p1.thrust_scale", -0.3),
            ("thrusters.p1.tilt_rad.1", 0.2),
            ("wheels.w1.torque_scale", 0.3),
        ] {
            text += &offset(parameter, by);
        }
        let flown = FlownLoop::new(&text, 1);
        let nominal = resolved(&flown.plan.nominal);
        assert!(flown.run.scene.mass.total > 1.1 * nominal.mass.total);
        let period = flown.spec().period;
        let thrusts = ["p1", "p2", "p3"]
            .map(|name| mean_of_interval(&flown.told(&format!("commanded_thrust_{name}_n")), delay, period));
        let torques = [("w1", 0), ("w2", 1)].map(|(name, place)| {
            let limit = nominal.actuators.wheels[place].torque_limit;
            let commands = flown.told(&format!("commanded_torque_{name}_n_m"));
            let within: Vec<f64> = commands.iter().map(|torque| torque.clamp(-limit, limit)).collect();
            mean_of_interval(&within, delay, period)
        });
        let speeds = ["w1", "w2"].map(|name| flown.told(&format!("estimated_rate_{name}_rad_s")));
        let (attitudes, rates) =
            (flown.told_vector::<4>("estimated_q_es_#"), flown.told_vector::<3>("estimated_omega_se_s_#_rad_s"));
        let lines = flown.told_vector::<3>("estimated_to_debris_e_#_m");
        let velocities = flown.told_vector::<3>("estimated_relative_velocity_e_#_m_s");
        let mut pushed: f64 = 0.0;
        for tick in 4..attitudes.len() - 1 {
            let thrusters = nominal.thrusters.iter().zip(&thrusts);
            let force = thrusters
                .fold([0.0; 3], |total, (thruster, thrust)| sum(total, scaled(thrust[tick], thruster.direction)));
            let push = scaled(1.0 / nominal.mass.total, force);
            let [before, after] = [tick, tick + 1].map(|tick| product(dcm_from_quaternion(attitudes[tick]), push));
            let acceleration = scaled(0.5, sum(before, after));
            pushed = pushed.max(norm(acceleration));
            let velocity = sum(velocities[tick], scaled(period, acceleration));
            let off = norm(difference(velocities[tick + 1], velocity));
            assert!(off < ROUNDING, "delay {delay}, tick {tick}: the velocity is off by {off:e} m/s");
            let moved = sum(scaled(period, velocities[tick]), scaled(0.5 * period * period, acceleration));
            let off = norm(difference(lines[tick + 1], difference(lines[tick], moved)));
            assert!(off < ROUNDING, "delay {delay}, tick {tick}: the position is off by {off:e} m");
            for (place, wheel) in nominal.mass.wheels.iter().enumerate() {
                let turned = dot(wheel.axis, difference(rates[tick + 1], rates[tick]));
                let expected = speeds[place][tick] + period * torques[place][tick] / wheel.axial - turned;
                let off = speeds[place][tick + 1] - expected;
                assert!(off.abs() < ROUNDING, "delay {delay}, tick {tick}, wheel {place}: {off:e} rad/s");
            }
        }
        assert!(pushed > 1e-3, "{pushed} m/s^2");
    }
}
