//! Ends of phases and failures of missions, recomputed from estimates and measurements.

use crate::prelude::*;

use crate::loops::actuators::{driven_wheels, limited_slew};
use crate::loops::flown_loop::SAME_TIME;

fn changes(flown: &FlownLoop) -> Vec<(f64, usize)> {
    let phases = flown.told("phase");
    let began = |tick: &usize| *tick == 0 || phases[*tick] != phases[tick - 1];
    (0..phases.len()).filter(began).map(|tick| (flown.ticks[tick].time, phases[tick] as usize)).collect()
}

#[test]
fn a_hold_starts_with_its_phase() {
    let (holds, period) = ([4.0, 6.0], 0.25);
    let start = SLEW_CLOSED.find("[[guidance]]").unwrap();
    let end = SLEW_CLOSED.find("[[disperse]]").unwrap();
    let phase = |name: &str, hold: &str| {
        format!("[[guidance]]\nphase = \"{name}\"\nlaw = \"rate_damping\"\ngain_n_m_s = 1.5\n{hold}\n")
    };
    let condition = |hold: f64| format!("until = \"body_rate_rad_s < 0.004\"\nhold_s = {hold:?}");
    let phases = phase("first", &condition(holds[0])) + &phase("second", &condition(holds[1])) + &phase("last", "");
    let text = format!("{}{phases}{}", &SLEW_CLOSED[..start], &SLEW_CLOSED[end..]);
    let text = changed(
        &without_filters(&text, "perfect"),
        &[
            ("duration_s = \"3 min\"", "duration_s = 60.1"),
            ("angular_velocity_rad_s = [0, 0, 0]", "angular_velocity_rad_s = [0.02, 0, 0]"),
        ],
    );
    let flown = FlownLoop::new(&text, 0);
    let met: Vec<bool> = flown.ticks.iter().map(|state| norm(state.omega_se_s) < 0.004).collect();
    let (mut begin, mut asked) = (0, 0);
    let mut expected = vec![(0.0, 0)];
    for (place, hold) in holds.iter().enumerate() {
        let count = (hold / period) as usize;
        let ends = |tick: &usize| *tick >= asked + count && met[tick - count..=*tick].iter().all(|met| *met);
        begin = (begin..met.len()).find(ends).unwrap();
        asked = begin + 1;
        expected.push((flown.ticks[begin].time, place + 1));
    }
    assert_eq!(changes(&flown), expected);
    assert!(!met[0] && expected[1].0 > 6.0, "{expected:?}");
}

/// Law: a mission fails at the first tick whose last measurement was *taken* longer ago than the limit.
#[test]
fn the_age_of_the_camera_contains_its_latency() {
    for latency in ["0.5", "2.0"] {
        let text = changed(
            NET_LAUNCH,
            &[
                ("period_s = 1.0\nlatency_s = 0.5", &format!("period_s = 1.0\nlatency_s = {latency}")[..]),
                ("max_range_m = 100.0", "max_range_m = 37.3"),
                ("velocity_m_s = [0.05, 0.02, 0.0]", "velocity_m_s = [-0.1, 0.0, 0.1]"),
                ("lost_target_timeout_s = 60.0", "lost_target_timeout_s = 12.0"),
            ],
        );
        let flown = FlownLoop::new(&text, 0);
        let seen = flown.told("measured_q_sd_w");
        let last = seen.iter().rposition(|value| !value.is_nan()).unwrap();
        let taken = flown.ticks[last].time - latency.parse::<f64>().unwrap();
        let expected = flown.ticks.iter().map(|state| state.time).find(|time| time - taken > 12.0);
        assert!(last > 3, "{last}");
        assert_eq!(flown.end, expected, "latency {latency}");
    }
}

/// Law: a wheel at its limit fails the mission after `saturation_timeout_s` without a gap.
#[test]
fn a_wheel_fails_after_its_timeout() {
    for timeout in [1.0, 5.0, 10.0] {
        let text = changed(
            &limited_slew(),
            &[("estimator = \"mekf\"\n", &format!("estimator = \"mekf\"\nsaturation_timeout_s = {timeout:?}\n")[..])],
        );
        let flown = FlownLoop::new(&text, 3);
        let mut since = f64::NAN;
        let mut fails = None;
        for ((arc, _), wheels) in flown.arcs.iter().zip(driven_wheels(&flown)) {
            let is_limited = wheels.iter().any(|driven| driven.is_speed_limited);
            since = match (is_limited, since.is_nan()) {
                (false, _) => f64::NAN,
                (true, true) => arc.start,
                (true, false) => since,
            };
            let tick = flown.ticks.iter().map(|state| state.time).find(|time| (time - arc.end()).abs() < SAME_TIME);
            fails = fails.or_else(|| tick.filter(|time| time - since > timeout));
        }
        assert!(fails.is_some());
        assert_eq!(flown.end, fails, "timeout {timeout}");
    }
}
