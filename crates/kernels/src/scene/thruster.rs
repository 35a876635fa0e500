//! [`Thruster`]: position and direction of a thruster; force and torque of several (Berdoz's (72)).

use super::schema::MAX_THRUSTERS;
use crate::math::prelude::*;

/// A thruster, fixed in the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thruster {
    /// Point of application from p in F_s, m.
    pub position: [f64; 3],
    /// Direction of its force on the spacecraft, a unit vector in F_s, with its alignment error.
    pub direction: [f64; 3],
}

/// The directions of Berdoz's thrusters P1, P2, P3 in F_s (72).
pub const REPORT_DIRECTIONS: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0]];

/// Distance rho_p of P2 and P3 from s3, m, if `thrusters` are Berdoz's without alignment errors: P1 along s3 at p, P2
/// and P3 along -s3 at (0, -rho_p, l) and (0, +rho_p, l). Equal thrusts P2 and P3 then give exactly zero torque (72).
pub fn report_offset(thrusters: &[Thruster]) -> Option<f64> {
    let [p1, p2, p3] = thrusters else { return None };
    let ([_, offset, station], [_, opposite, other]) = (p3.position, p2.position);
    let is_report = [p1.direction, p2.direction, p3.direction] == REPORT_DIRECTIONS
        && p1.position == [0.0; 3]
        && opposite == -offset
        && station == other
        && [p2.position[0], p3.position[0]] == [0.0; 2];
    is_report.then_some(offset)
}

/// Force of `thrusters` at the thrusts `thrust` (N, in order), F_s, N.
pub fn force_s(thrusters: &[Thruster], thrust: [f64; MAX_THRUSTERS]) -> [f64; 3] {
    if thrusters.is_empty() {
        return [0.0; 3];
    }
    if report_offset(thrusters).is_some() {
        return [0.0, 0.0, thrust[0] - thrust[1] - thrust[2]];
    }
    total(thrusters.iter().zip(thrust).map(|(thruster, thrust)| scaled(thrust, thruster.direction)))
}

/// Torque of `thrusters` about the point `center` (from p in F_s, m), F_s, N m.
pub fn torque_s(thrusters: &[Thruster], thrust: [f64; MAX_THRUSTERS], center: [f64; 3]) -> [f64; 3] {
    if thrusters.is_empty() {
        return [0.0; 3];
    }
    if let Some(offset) = report_offset(thrusters) {
        let force = thrust[0] - thrust[1] - thrust[2];
        // about p, minus center x F
        return [offset * (thrust[1] - thrust[2]) - center[1] * force, center[0] * force, 0.0];
    }
    let torque = |(thruster, thrust): (&Thruster, f64)| {
        cross(difference(thruster.position, center), scaled(thrust, thruster.direction))
    };
    total(thrusters.iter().zip(thrust).map(torque))
}

/// Sum of vectors, the last two first.
fn total(vectors: impl DoubleEndedIterator<Item = [f64; 3]>) -> [f64; 3] {
    vectors.rev().reduce(|after, vector| sum(vector, after)).unwrap_or([0.0; 3])
}
