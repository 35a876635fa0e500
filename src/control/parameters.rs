//! The numbers that `[control]` and the phases of `[[guidance]]` have: keys with unit, limit, default and meaning.

use super::guidance::phase::Maneuver;
use super::guidance::target::Target;
use crate::scene::LawParameter;
use crate::scene::schema::{Facts, Limit, Needs, Presence, Shape};

const fn number(key: &'static str, unit: &'static str, meaning: &'static str, default: &'static [f64]) -> LawParameter {
    LawParameter::number(key, unit, meaning, Limit::NotNegative).or(default)
}

/// Of every loop.
pub static LOOP: [LawParameter; 5] = [
    number("delay_s", "s", "Time from a tick to the effect of its commands", &[0.0]),
    number(
        "settling_band_rad",
        "rad",
        "Pointing error within which the attitude counts as settled",
        &[0.017_453_292_519_943_295],
    ),
    number(
        "stability_from_s",
        "s",
        "Start of the window over which the attitude is to be stable; 0: when the mission has settled",
        &[0.0],
    ),
    number("stability_window_s", "s", "Length of that window; 0: to the end of the run", &[0.0]),
    number(
        "saturation_timeout_s",
        "s",
        "How long the limit of a wheel's speed may cut its motor before the mission fails; 0: for ever",
        &[0.0],
    ),
];

/// Of a loop with thrusters.
pub static THRUSTERS: [LawParameter; 1] =
    [number("isp_s", "s", "Specific impulse, from which the propellant follows; 0: not known", &[0.0])];

/// Of a loop near debris.
pub static DEBRIS: [LawParameter; 7] = [
    LawParameter::number(
        "launch_distance_m",
        "m",
        "Distance behind the debris at which the net is launched",
        Limit::Positive,
    )
    .or(&[10.0]),
    number("least_debris_speed_m_s", "m/s", "Speed of the debris below which its velocity is no axis", &[1e-3]),
    LawParameter::number(
        "approach_axis",
        "1",
        "Launch axis below that speed, a direction in F_e along which s3 points; zero: the mission fails",
        Limit::Finite,
    )
    .with_components(&["x", "y", "z"])
    .or(&[0.0; 3]),
    number("keep_out_m", "m", "Distance from the debris below which the mission fails", &[0.0]),
    number(
        "lost_target_timeout_s",
        "s",
        "How long the debris may be unmeasured before the mission fails; 0: for ever",
        &[0.0],
    ),
    number(
        "plume_range_m",
        "m",
        "Distance to the debris within which the plume of a thruster counts as hitting it",
        &[0.0],
    ),
    number("plume_half_angle_rad", "rad", "Half angle of the cone of a plume", &[0.0]),
];

/// Of every phase.
pub static PHASE: [LawParameter; 1] =
    [number("timeout_s", "s", "Time in the phase after which the mission fails; 0: never", &[0.0])];

/// Of a phase with a condition.
pub static CONDITION: [LawParameter; 1] =
    [number("hold_s", "s", "How long the condition of the phase must be met", &[0.0])];

/// Of a phase in a loop with thrusters.
pub static UNLOADING: [LawParameter; 2] = [
    number(
        "unloading_time_s",
        "s",
        "Time constant with which thrusters take momentum out of the wheels; 0: not at all",
        &[0.0],
    ),
    number("unloading_dead_band_n_m_s", "N m s", "Momentum that may stay in the wheels", &[0.0]),
];

/// Of a phase with a transfer.
pub static TRANSFER: [LawParameter; 1] =
    [LawParameter::number("transfer_time_s", "s", "Time of the transfer to the station", Limit::Positive)];

/// Of a phase with an attitude.
pub static ATTITUDE: [LawParameter; 1] = [LawParameter {
    facts: Facts {
        key: "attitude",
        unit: "1",
        meaning: "Attitude quaternion that is wanted, F_s -> F_e, scalar first",
        components: &["w", "x", "y", "z"],
        shape: Shape::Quaternion,
        presence: Presence::Required("[1, 0, 0, 0]"),
        needs: Needs::Nothing,
        limit: Limit::UnitQuaternion,
    },
    default: None,
}];

/// The lists of a phase with the target `target` and the maneuver `thrust`, with a condition or without, in a loop with thrusters or without.
pub fn of_phase(
    target: Target,
    thrust: Maneuver,
    [has_condition, has_thrusters]: [bool; 2],
) -> Vec<&'static [LawParameter]> {
    let mut lists: Vec<&'static [LawParameter]> = vec![&PHASE];
    if has_condition {
        lists.push(&CONDITION);
    }
    if has_thrusters {
        lists.push(&UNLOADING);
    }
    if thrust == Maneuver::Transfer || target == Target::Transfer {
        lists.push(&TRANSFER);
    }
    if matches!(target, Target::Attitude(_)) {
        lists.push(&ATTITUDE);
    }
    lists
}
