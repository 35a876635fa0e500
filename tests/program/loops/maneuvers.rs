//! Maneuvers of control loops: impulses on their way, and transfers that follow one another.

use crate::prelude::*;

/// `net_launch.toml` at rest, with perfect knowledge and throttled thrusters whose commands act after `delay` seconds.
fn maneuver(delay: f64, duration: f64, velocity: [f64; 3], phases: &str) -> FlownLoop {
    let head = &NET_LAUNCH[..NET_LAUNCH.find("[[guidance]]").unwrap()];
    let text = changed(
        &without_filters(head, "perfect"),
        &[
            ("duration_s = 2400.0", &format!("duration_s = {duration:?}")[..]),
            ("velocity_m_s = [0.05, 0.02, 0.0]", &format!("velocity_m_s = {velocity:?}")),
            ("debris_velocity_m_s = [0.04, 0.03, 0.0]", "debris_velocity_m_s = [0, 0, 0]"),
            ("[\"0.4 deg/s\", \"-0.6 deg/s\", \"0.8 deg/s\"]", "[0, 0, 0]"),
            ("delay_s = 0.1", &format!("delay_s = {delay:?}")),
            ("modulation = \"pulse_width\"", "modulation = \"throttled\""),
        ],
    );
    FlownLoop::new(&(text + phases), 0)
}

#[test]
fn an_impulse_on_its_way_is_not_commanded_again() {
    const STOP: &str = "[[guidance]]\nphase = \"brake\"\nlaw = \"quaternion_feedback\"\nbandwidth_rad_s = 0.06\n\
                        damping = 0.9\ntarget = \"attitude\"\nattitude = [1, 0, 0, 0]\nthrust = \"stop\"\n";
    const SPEED: f64 = 0.05;
    for delay in [0.1, 0.5, 0.85, 1.3] {
        let flown = maneuver(delay, 30.2, [0.0, 0.0, -SPEED], STOP);
        let along: Vec<f64> = flown
            .ticks
            .iter()
            .map(|state| dot(difference(state.v_co_e, state.debris().v_gdo_e), state.s3_e()))
            .collect();
        assert!((along[0] + SPEED).abs() < 1e-12, "{along:?}");
        let (most, last) = (along.iter().copied().fold(f64::NEG_INFINITY, f64::max), along[along.len() - 1]);
        assert!(most < 1e-4 * SPEED && last.abs() < 1e-4 * SPEED, "{delay}: {most:e} {last:e}");
    }
}

#[test]
fn each_transfer_arrives_after_its_own_time() {
    const AIM: &str = "law = \"eigenaxis\"\nbandwidth_rad_s = 0.06\ndamping = 0.9\nmax_rate_rad_s = \"1 \
        deg/s\"\ntarget = \"transfer\"\n";
    const TIMES: [f64; 2] = [300.0, 150.0];
    let burn = |name: &str, time: f64| {
        format!(
            "[[guidance]]\nphase = \"{name}\"\n{AIM}thrust = \"transfer\"\ntransfer_time_s = {time:?}\nuntil = \
            \"velocity_to_go_along_m_s < 1e-5\"\n"
        )
    };
    let aim = format!(
        "[[guidance]]\nphase = \"aim\"\n{AIM}transfer_time_s = 300.0\nuntil = \"pointing_error_rad < 0.02 and \
        body_rate_rad_s < 0.002\"\n"
    );
    let rest =
        "[[guidance]]\nphase = \"coast\"\nuntil = \"time_to_station_s < 0.75\"\n[[guidance]]\nphase = \"wait\"\n";
    let flown = maneuver(0.1, 600.0, [0.0; 3], &(aim + &burn("one", TIMES[0]) + &burn("two", TIMES[1]) + rest));
    let phases = flown.told("phase");
    let begin = |phase: f64| {
        let tick = phases.iter().position(|one| *one == phase).unwrap_or_else(|| panic!("phase {phase} is flown"));
        (tick, flown.ticks[tick].time)
    };
    let [(_, one), (_, two), (arrived, end)] = [1.0, 2.0, 4.0].map(begin);
    assert!(two - one > 5.0 && two - one < 60.0, "the second burn is on the way: {one} {two}");
    assert!((end - two - TIMES[1]).abs() < 1.0, "{two} to {end}");
    let state = &flown.ticks[arrived];
    let to_debris = difference(state.debris().r_gdo_e, state.r_co_e);
    let off = norm(difference(to_debris, [10.0, 0.0, 0.0]));
    assert!(off < 0.5, "{off} m");
}
