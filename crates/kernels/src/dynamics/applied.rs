//! The next arc of a run, by schedule or by law, with the effects that are constant over an arc.

use super::actuation::{ActuationLaw, BodyState, WheelState, actuation_at};
use super::effects::add_constant_effects;
use crate::scene::{Arc, Scene, WheelMode};

/// The arc of the schedule of `scene` at `time`.
#[inline]
pub fn scheduled_arc(scene: &Scene, time: f64, duration: f64) -> Arc {
    let mut arc = Arc { start: time, applied: actuation_at(&scene.schedule, time) };
    arc.applied.until = arc.applied.until.min(duration);
    add_constant_effects(scene, &mut arc.applied);
    arc
}

/// The arc of a run of `scene` from `time` on: scheduled, or by `law` in `state`.
///
/// # Panics
/// If the law's arc ends before it starts: the run would never end.
pub fn next_arc(
    scene: &Scene,
    law: Option<&mut dyn ActuationLaw>,
    time: f64,
    state: impl FnOnce() -> (BodyState, WheelState),
    duration: f64,
) -> Arc {
    let Some(law) = law else { return scheduled_arc(scene, time, duration) };
    let (body, wheels) = state();
    law_arc(scene, law, time, &body, &wheels, duration)
}

/// The arc by `law` at `time`. Motors of missing wheels and of wheels of constant speed take no command.
///
/// # Panics
/// As [`next_arc`].
#[inline]
pub fn law_arc(
    scene: &Scene,
    law: &mut dyn ActuationLaw,
    time: f64,
    body: &BodyState,
    wheels: &WheelState,
    duration: f64,
) -> Arc {
    let mut arc = Arc { start: time, applied: law.arc(time, body, wheels) };
    let applied = &mut arc.applied;
    assert!(applied.until > time, "a law's arc from {time} s ends at {} s", applied.until);
    let wheels = scene.mass.wheels.len();
    applied.motor_torque[wheels..].fill(0.0);
    for (wheel, torque) in scene.mass.wheels.iter().zip(&mut applied.motor_torque) {
        if wheel.mode != WheelMode::Free {
            *torque = 0.0;
        }
    }
    applied.until = applied.until.min(duration);
    add_constant_effects(scene, applied);
    arc
}
