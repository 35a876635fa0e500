//! Non-inertial terms -M-dot nu - Omega M nu + a_non (39) and actuators B u (26), (72)-(74), body by body.
//!
//! The three non-inertial terms stay separate, as Berdoz's; their sum for the fuselage is -omega x J omega and C omega
//! x (c x omega).

use super::kinematics::WheelMotion;
use super::parameters::{Parameters, WheelParameters};
use super::state::{State, rotated, rotated_back};
use crate::math::prelude::*;
use crate::scene::Actuation;
use crate::scene::thruster::report_offset;

/// Force in F_e and torque in the body's frame about the body's point (p, g1, g2, g_d).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force in F_e, N.
    pub force: [f64; 3],
    /// Torque in the body's frame, N m.
    pub torque: [f64; 3],
}

/// Applied forces of an arc: B u (26) and body torque, in the frames of the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive<const W: usize> {
    /// Force of the thrusters in F_s, N.
    pub force_s: [f64; 3],
    /// Torque of the thrusters plus body torque about p, in F_s, N m.
    pub torque_p_s: [f64; 3],
    /// Torque of the thrusters plus body torque about c, in F_s, N m.
    pub torque_c_s: [f64; 3],
    /// Motor torques on the wheels, N m.
    pub motors: [f64; W],
}

impl<const W: usize> Drive<W> {
    /// B_s u (72), with misaligned thrusters.
    pub fn of(parameters: &Parameters<W>, actuation: &Actuation) -> Self {
        let (mut force_s, mut torque_p_s) = ([0.0; 3], [0.0; 3]);
        if let Some(offset) = report_offset(&parameters.thrusters) {
            // written out, so that equal thrusts add up to exactly zero
            let [p1, p2, p3] = [actuation.thrust[0], actuation.thrust[1], actuation.thrust[2]];
            force_s[2] = p1 - p2 - p3;
            torque_p_s[0] = offset * (p2 - p3);
        } else {
            for (thruster, thrust) in parameters.thrusters.iter().zip(actuation.thrust) {
                let force = scaled(thrust, thruster.direction);
                force_s = sum(force_s, force);
                torque_p_s = sum(torque_p_s, cross(thruster.position, force));
            }
        }
        if actuation.body_torque != [0.0; 3] {
            torque_p_s = sum(torque_p_s, actuation.body_torque);
        }
        Drive {
            force_s,
            torque_p_s,
            torque_c_s: difference(torque_p_s, cross(parameters.center, force_s)),
            motors: std::array::from_fn(|w| actuation.motor_torque[w]),
        }
    }
}

/// -M-dot nu - Omega M nu + a_non of the fuselage.
///
/// With w = C_es^T v_p, M-dot nu = [-C omega x (c x omega); -c x (omega x w)], Omega M nu = [0; omega x (c x w + J
/// omega)], a_non = [0; w x (c x omega)].
#[inline(always)]
pub fn fuselage_inertial<const W: usize>(parameters: &Parameters<W>, state: &State<W>) -> Wrench {
    let (omega, c) = (state.omega_s, parameters.fuselage_first);
    let w = rotated_back(state.fuselage.dcm, state.v_p);
    let c_omega = cross(c, omega);
    let m_dot_nu = scaled(-1.0, cross(c, cross(omega, w)));
    let omega_m_nu = cross(omega, sum(cross(c, w), product(parameters.fuselage_inertia, omega)));
    let a_non = cross(w, c_omega);
    Wrench {
        force: rotated(state.fuselage.dcm, cross(omega, c_omega)),
        torque: difference(difference(a_non, m_dot_nu), omega_m_nu),
    }
}

/// B_s u (72): thrusters and reaction of the motors.
#[inline(always)]
pub fn fuselage_applied<const W: usize>(parameters: &Parameters<W>, state: &State<W>, drive: &Drive<W>) -> Wrench {
    let mut torque = drive.torque_p_s;
    for (wheel, motor) in parameters.wheels.iter().zip(drive.motors) {
        torque = difference(torque, scaled(motor, wheel.axis));
    }
    Wrench { force: rotated(state.fuselage.dcm, drive.force_s), torque }
}

/// -M Pi-dot nu-hat - Omega M nu and motor torque (73), (74) of a wheel; M-dot and a_non vanish about its centre.
#[inline(always)]
pub fn wheel_wrench(wheel: &WheelParameters, motion: &WheelMotion, motor: f64) -> Wrench {
    let gyroscopic = cross(motion.omega, product(wheel.inertia, motion.omega));
    let transport = product(wheel.inertia, motion.angular_acceleration);
    Wrench {
        force: scaled(-wheel.mass, motion.acceleration),
        torque: difference(scaled(motor, wheel.axis), sum(transport, gyroscopic)),
    }
}

/// Motor torque of a wheel of constant speed, N m: a^T J C_ws omega_s-dot minus the `inertial` part of the wheel's row
/// of (39). Its actions on wheel and fuselage cancel in Pi^T B u.
#[inline(always)]
pub fn holding_torque(wheel: &WheelParameters, motion: &WheelMotion, omega_s_dot: [f64; 3], inertial: f64) -> f64 {
    dot(product(wheel.inertia, wheel.axis), rotated(motion.c_ws, omega_s_dot)) - inertial
}

/// Power of the thrusters, F . v, and of the motors, tau . Omega; W.
#[inline(always)]
pub fn power<const W: usize>(state: &State<W>, drive: &Drive<W>, motors: [f64; W]) -> [f64; 2] {
    let w = rotated_back(state.fuselage.dcm, state.v_p);
    let mut motor_power = 0.0;
    for w in (0..W).rev() {
        let rate = state.wheel_rates[w];
        motor_power = if w + 1 == W { motors[w] * rate } else { motors[w].mul_add(rate, motor_power) };
    }
    [dot(drive.force_s, w) + dot(drive.torque_p_s, state.omega_s), motor_power]
}
