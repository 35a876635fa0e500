//! A constant torque on the body, such as of a leak: fixed in F_s, whatever the state is.

use crate::scene::{Actuation, Scene};

/// The torque of `environment.body_torque_n_m`, in F_s, N m, for the whole run.
pub fn actuation(scene: &Scene) -> Actuation {
    let body_torque = scene.environment.body_torque_n_m.unwrap_or_default();
    Actuation { body_torque, ..Actuation::none(f64::INFINITY) }
}
