//! Keys of the numbers in `[control]` and in phases of `[[guidance]]`.

use super::laws::momentum_unloading::UNLOADING;
use crate::loops::declared::{declared, number};
use crate::loops::launch_numbers::TRANSFER;
use crate::loops::phase::Maneuver;
use crate::loops::target::Target;
use crate::scene::LawParameter;
use crate::scene::schema::{Facts, Limit, Shape};

declared! {
    LoopNumbers = LOOP {
        delay: f64 = number("delay_s", "s", "Time from a tick to the effect of its commands", &[0.0]);
        settling_band: f64 = number("settling_band_rad", "rad",
            "Pointing error within which the attitude counts as settled", &[0.017_453_292_519_943_295]);
        stability_from: f64 = number("stability_from_s", "s",
            "Start of the window over which stability is measured; 0: when the mission has settled", &[0.0]);
        stability_window: f64 = number("stability_window_s", "s", "Length of that window; 0: to the end of the run",
            &[0.0]);
        saturation_timeout: f64 = number("saturation_timeout_s", "s",
            "How long a wheel's speed limit may cut off its motor before the mission fails; 0: forever", &[0.0]);
    }
}

declared! {
    ThrusterNumbers = THRUSTERS {
        isp: f64 = number("isp_s", "s", "Specific impulse, from which the propellant follows; 0: not known", &[0.0]);
    }
}

declared! {
    PhaseNumbers = PHASE {
        timeout: f64 = number("timeout_s", "s", "Time in the phase after which the mission fails; 0: never", &[0.0]);
    }
}

declared! {
    ConditionNumbers = CONDITION {
        hold: f64 = number("hold_s", "s", "How long the condition of the phase must be met", &[0.0]);
    }
}

const WANTED_ATTITUDE: LawParameter = LawParameter {
    facts: Facts {
        key: "attitude",
        unit: "1",
        meaning: "Target attitude quaternion, scalar first: F_s -> F_e, or F_s -> F_o for an orbital attitude",
        components: &["w", "x", "y", "z"],
        shape: Shape::Quaternion,
        required: Some("[1, 0, 0, 0]"),
        needs_debris: false,
        limit: Limit::UnitQuaternion,
    },
    default: None,
};

declared! {
    AttitudeNumbers = ATTITUDE {
        attitude: [f64; 4] = WANTED_ATTITUDE;
    }
}

/// The lists of keys of a phase with this target and maneuver.
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
    if matches!(target, Target::Attitude(_) | Target::Orbital(_)) {
        lists.push(&ATTITUDE);
    }
    lists
}
