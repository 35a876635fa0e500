//! Whether the method integrates all forces of the scene.

use super::document::Document;
use crate::dynamics::effects::{Effect, ForceModel};
use crate::propagation::Method;
use crate::scene::{Scene, SceneInput};

/// The methods that integrate the effects of `model`, to follow "must be"; `None` if `method` does.
pub fn allowed_methods(method: Method, model: ForceModel) -> Option<String> {
    if method.integrates(model) {
        return None;
    }
    let is_left_out = |effect: &Effect| !method.integrates(ForceModel::NONE.with(*effect));
    let mut left_out: Vec<&str> = model.effects().filter(is_left_out).map(Effect::key).collect();
    left_out.dedup();
    let able = Method::ALL.into_iter().filter(|method| method.integrates(model));
    let able: Vec<&str> = able.map(Method::name).collect();
    Some(format!("a method that integrates {}: one of {}", left_out.join(" and "), able.join(", ")))
}

/// Refuses a method that omits an effect, and a transfer longer than the orbit allows.
pub(super) fn check(input: &SceneInput, scene: &Scene, method: Method, document: &mut Document<'_>) {
    let model = ForceModel::of(scene);
    if let Some(allowed) = allowed_methods(method, model) {
        let remedy = "write another method, or leave it out: auto integrates every effect";
        document.add("integrator.method", Some(format!("{:?}", method.name())), allowed, remedy);
    }
    let Some(orbit) = &scene.orbit else { return };
    let axis = orbit.shape().semi_major_axis;
    let half = core::f64::consts::PI * (axis / orbit.mu).sqrt() * axis;
    for phase in &input.control.guidance {
        if let Some(time) = phase.named("transfer_time_s").map(|numbers| numbers[0]).filter(|time| *time >= half) {
            let allowed = format!("below half a period of the orbit, {half:.0} s: later no single impulse leads there");
            let key = format!("guidance.{}.transfer_time_s", phase.name);
            document.add(&key, Some(format!("{time:?}")), allowed, "write a shorter time");
        }
    }
}
