//! What acts on the spacecraft and how it is integrated: whether both fit.

use super::document::Document;
use crate::dynamics::effects::{Effect, ForceModel};
use crate::propagation::Method;
use crate::propagation::taylor::reference_solution::ReferenceSolution;
use crate::scene::{Scene, SceneInput};

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

/// The effects of `model` that the reference solution does not integrate, by their keys; `None` where it integrates all.
pub fn without_reference(model: ForceModel) -> Option<String> {
    let is_left_out = |effect: &Effect| !ReferenceSolution::integrates(ForceModel::NONE.with(*effect));
    let left_out: Vec<&str> = model.effects().filter(is_left_out).map(Effect::key).collect();
    (!left_out.is_empty()).then(|| left_out.join(" and "))
}

/// Refuses a method that leaves out an effect on `scene`, which is `input`, an audit by a reference solution that does, and a transfer that its orbit does
/// not allow.
pub(super) fn check(
    input: &SceneInput,
    scene: &Scene,
    method: Method,
    audit_fraction: f64,
    document: &mut Document<'_>,
) {
    let model = ForceModel::of(scene);
    if let Some(left_out) = without_reference(model).filter(|_| audit_fraction > 0.0) {
        let allowed = format!("0 with {left_out}: the reference solution does not integrate it");
        let remedy = "leave it out; two tolerances that agree show the error too";
        document.add("audit.fraction", Some(format!("{audit_fraction:?}")), allowed, remedy);
    }
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
