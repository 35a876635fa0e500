//! [`observed_state`]: the state of a gyrostat as observed by an actuation law.

use super::wheel::WheelMotion;
use super::{ANGLE, ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, OMEGA, WITH_THRUST};
use crate::dynamics::actuation::{BodyState, WheelState};
use crate::math::prelude::*;
use crate::scene::MAX_WHEELS;

/// The state of `run` at `time`, the end of its last arc (or zero), from the integrated components in SI.
#[inline(always)]
pub fn observed_state<R: Real>(
    run: &Gyrostat<R>,
    time: f64,
    components: &[R; WITH_THRUST],
    motions: &[WheelMotion<R>; MAX_WHEELS],
) -> (BodyState, WheelState) {
    let (omega_b, turned_b, q_eb) = (three(components, OMEGA), three(components, ANGLE), four(components, ATTITUDE));
    let (omega_s, q_es) = match run.c_sb {
        Some(c_sb) => (product(c_sb, omega_b), hamilton(q_eb, conjugate(run.q_sb))),
        None => (omega_b, q_eb),
    };
    let now = run.mass.splat(time);
    let inverse_mass = run.mass.splat(1.0) / run.mass;
    let (r_co_e, v_co_e) = match &run.orbit {
        Some(orbit) => {
            let mut place = run.place(orbit, time);
            if run.offset.is_some() {
                place = place.displaced(
                    [IMPULSE_INTEGRAL, IMPULSE]
                        .map(|first| lane_of(&scaled(inverse_mass, three(components, first)), 0)),
                );
            }
            (place.position, place.velocity)
        }
        None => {
            let line = sum(run.r_co_e, scaled(now, run.v_co_e));
            let position = sum(line, scaled(inverse_mass, three(components, IMPULSE_INTEGRAL)));
            (lane_of(&position, 0), lane_of(&sum(run.v_co_e, scaled(inverse_mass, three(components, IMPULSE))), 0))
        }
    };
    let body = BodyState { omega_se_s: lane_of(&omega_s, 0), q_es: lane_of(&q_es, 0), r_co_e, v_co_e };
    let mut wheels = WheelState::AT_REST;
    for (i, wheel) in run.wheels.iter().enumerate() {
        let motion = &motions[i];
        wheels.rates[i] = wheel.rate(motion.momentum, omega_b).lane(0);
        wheels.momenta[i] = wheel.absolute_momentum(motion.momentum, omega_b).lane(0);
        wheels.angles[i] = wheel.angle(now, motion.turn, turned_b).lane(0);
    }
    (body, wheels)
}
