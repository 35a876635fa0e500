//! Residuals of the constraints (27)-(34): drift of the integrated coordinates.

use super::kinematics::WheelMotion;
use super::parameters::Parameters;
use super::state::{Columns, State, rotated, rotated_back};
use crate::math::prelude::*;
use crate::scene::Scene;

/// Largest residuals in `state`: [kinematic, collocation, attitude]; missing bodies do not count.
///
/// - kinematic (m/s, rad/s): Xi nu with nu = Pi nu-hat: the wheel's centre moves with the fuselage, and the wheel turns
///   about its axis only;
/// - collocation (m, sines of angles): the wheel's centre is at z_i, its axis along a_i;
/// - attitude: entries of C^T C - 1 of all DCMs.
#[inline(always)]
pub fn residuals<const W: usize>(scene: &Scene, parameters: &Parameters<W>, state: &State<W>) -> [f64; 3] {
    let (mut kinematic, mut collocation) = (0.0, 0.0);
    let c_es = state.fuselage.dcm;
    let mut attitude = orthonormality(c_es);
    for (w, wheel) in parameters.wheels.iter().enumerate() {
        if w >= scene.mass.wheels.len() {
            continue;
        }
        let motion = WheelMotion::of(wheel, state, w);
        let c_ew = state.wheels[w].dcm;
        let carried = sum(state.v_p, rotated(c_es, cross(state.omega_s, wheel.center)));
        let relative = difference(rotated_back(c_es, rotated(c_ew, motion.omega)), state.omega_s);
        let across = difference(relative, scaled(dot(relative, wheel.axis), wheel.axis));
        kinematic = largest(largest(kinematic, difference(motion.velocity, carried)), across);

        let center = sum(state.fuselage.position, rotated(c_es, wheel.center));
        let tilt = difference(rotated(c_ew, wheel.axis), rotated(c_es, wheel.axis));
        collocation = largest(largest(collocation, difference(state.wheels[w].position, center)), tilt);
        attitude = attitude.max(orthonormality(c_ew));
    }
    if scene.mass.debris.is_some() {
        attitude = attitude.max(orthonormality(state.debris.dcm));
    }
    [kinematic, collocation, attitude]
}

/// The largest entry of |C^T C - 1|.
#[inline(always)]
pub fn orthonormality(c: Columns) -> f64 {
    let unit = |i: usize| (dot(c[i], c[i]) - 1.0).abs();
    let right = |i: usize, j: usize| dot(c[i], c[j]).abs();
    unit(0).max(unit(1)).max(unit(2)).max(right(0, 1)).max(right(0, 2)).max(right(1, 2))
}

#[inline(always)]
fn largest(so_far: f64, v: [f64; 3]) -> f64 {
    v.iter().fold(so_far, |m, x| m.max(x.abs()))
}
