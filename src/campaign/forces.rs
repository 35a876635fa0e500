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
    let mut left_out: Vec<&str> = model.effects().filter(is_left_out).map(Effect::key).collect();
    left_out.dedup();
    let able = Method::ALL.into_iter().filter(|method| method.integrates(model));
    let able: Vec<&str> = able.map(Method::name).collect();
    Some(format!("a method that integrates {}: one of {}", left_out.join(" and "), able.join(", ")))
}

/// Refuses a method that leaves out an effect on `scene`.
pub(super) fn check(scene: &Scene, method: Method, document: &mut Document<'_>) {
    let model = ForceModel::of(scene);
    if let Some(allowed) = allowed_methods(method, model) {
        let remedy = "write another method, or leave it out: auto integrates every effect";
        document.add("integrator.method", Some(format!("{:?}", method.name())), allowed, remedy);
    }
}
