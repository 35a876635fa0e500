//! What acts on the spacecraft and how it is integrated: whether both fit.

use super::document::Document;
use crate::dynamics::effects::{Effect, ForceModel};
use crate::propagation::Method;
use crate::scene::Scene;

/// What a method must be that integrates the effects of `model`, to follow "must be"; `None` where `method` does.
pub fn allowed_methods(method: Method, model: ForceModel) -> Option<String> {
    if method.integrates(model) {
        return None;
    }
    let is_left_out = |effect: &Effect| !method.integrates(ForceModel::NONE.with(*effect));
    let left_out: Vec<&str> = model.effects().filter(is_left_out).map(Effect::key).collect();
    let able = Method::ALL.into_iter().filter(|method| method.integrates(model));
    let able: Vec<&str> = able.map(Method::name).collect();
    Some(format!("a method that integrates {}: one of {}", left_out.join(" and "), able.join(", ")))
}

/// Refuses a method that leaves out an effect on `scene`, a thrust that would change its orbit, and a filter that would not know it.
pub(super) fn check(scene: &Scene, method: Method, document: &mut Document<'_>) {
    let model = ForceModel::of(scene);
    if let Some(allowed) = allowed_methods(method, model) {
        let remedy = "write another method, or leave it out: auto integrates every effect";
        document.add("integrator.method", Some(format!("{:?}", method.name())), allowed, remedy);
    }
    let commands = document.law.as_ref().is_some_and(|law| law.commands().thrusters);
    if model.contains(Effect::Gravity) && (scene.commands_thrust || commands) {
        let allowed = "left out where thrusters act: the orbit is that of two bodies, which a thrust would change";
        document.add("orbit", Some("given".to_owned()), allowed, "delete [orbit], or command no thrust");
    }
    let spec = document.law.as_ref().and_then(|law| law.spec());
    if model.contains(Effect::Gravity) && spec.is_some_and(|spec| spec.has_filter() && spec.has_radar()) {
        let allowed =
            "\"perfect\" or \"raw\" with a ground_radar on an [orbit]: the translation filter does not know gravity";
        document.add("control.estimator", Some("\"mekf\"".to_owned()), allowed, "delete the radar, or [orbit]");
    }
}
