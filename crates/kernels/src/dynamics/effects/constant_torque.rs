//! A torque that is constant in F_s for the whole run, such as that of a leak.

use crate::scene::{Actuation, Scene};

/// The torque `environment.body_torque_n_m`, F_s, N m.
pub fn actuation(scene: &Scene) -> Actuation {
    let body_torque = scene.environment.body_torque_n_m.unwrap_or_default();
    Actuation { body_torque, ..Actuation::none(f64::INFINITY) }
}
