//! S and Gamma (9), (51)-(54), (68); the blocks of Pi and Pi-dot (58) other than zero and one.

use super::parameters::WheelParameters;
use super::state::{Columns, State, rotated, rotated_back};
use crate::math::prelude::*;

/// S omega (68): C-dot = C omega^x by columns, column j being C (omega x e_j).
#[inline(always)]
pub fn dcm_rate(c: Columns, omega: [f64; 3]) -> Columns {
    let turned = |x: f64, a: [f64; 3], y: f64, b: [f64; 3]| {
        [x.mul_add(a[0], -(y * b[0])), x.mul_add(a[1], -(y * b[1])), x.mul_add(a[2], -(y * b[2]))]
    };
    [
        turned(omega[2], c[1], omega[1], c[2]),
        turned(omega[0], c[2], omega[2], c[0]),
        turned(omega[1], c[0], omega[0], c[1]),
    ]
}

/// Columns of C r^x: C (r x e_j).
#[inline(always)]
pub fn lever(c: Columns, r: [f64; 3]) -> Columns {
    dcm_rate(c, r)
}

/// A wheel's rows of Pi (58) and of Pi-dot nu-hat.
#[derive(Clone, Copy, Debug)]
pub struct WheelMotion {
    /// Pi, velocity over omega_s: -C_es z^x, by columns, m.
    pub lever: Columns,
    /// Pi, angular velocity over omega_s: C_ws = C_ew^T C_es, by columns.
    pub c_ws: Columns,
    /// Velocity of the wheel's centre in F_e, m/s: v_p + C_es (omega_s x z).
    pub velocity: [f64; 3],
    /// Angular velocity of the wheel in its own frame, rad/s: C_ws omega_s + a Omega.
    pub omega: [f64; 3],
    /// Pi-dot nu-hat, velocity rows: C_es omega_s x (omega_s x z), m/s^2.
    pub acceleration: [f64; 3],
    /// Pi-dot nu-hat, angular rows: C_ws-dot omega_s = -Omega a x (C_ws omega_s), rad/s^2.
    pub angular_acceleration: [f64; 3],
}

impl WheelMotion {
    pub const AT_REST: WheelMotion = WheelMotion {
        lever: [[0.0; 3]; 3],
        c_ws: [[0.0; 3]; 3],
        velocity: [0.0; 3],
        omega: [0.0; 3],
        acceleration: [0.0; 3],
        angular_acceleration: [0.0; 3],
    };

    #[inline(always)]
    pub fn of<const W: usize>(wheel: &WheelParameters, state: &State<W>, index: usize) -> Self {
        let (c_es, c_ew) = (state.fuselage.dcm, state.wheels[index].dcm);
        let (omega_s, rate) = (state.omega_s, state.wheel_rates[index]);
        let minus_lever = lever(c_es, wheel.center);
        let c_ws = [rotated_back(c_ew, c_es[0]), rotated_back(c_ew, c_es[1]), rotated_back(c_ew, c_es[2])];
        let carried = rotated(c_ws, omega_s);
        WheelMotion {
            lever: [scaled(-1.0, minus_lever[0]), scaled(-1.0, minus_lever[1]), scaled(-1.0, minus_lever[2])],
            c_ws,
            velocity: difference(state.v_p, rotated(minus_lever, omega_s)),
            omega: [
                rate.mul_add(wheel.axis[0], carried[0]),
                rate.mul_add(wheel.axis[1], carried[1]),
                rate.mul_add(wheel.axis[2], carried[2]),
            ],
            acceleration: rotated(c_es, cross(omega_s, cross(omega_s, wheel.center))),
            angular_acceleration: scaled(-rate, cross(wheel.axis, carried)),
        }
    }

    /// Pi^T of a force (in F_e) and torque (wheel frame) on the wheel: rows of omega_s and of the wheel's rate; the
    /// rows of v_p are the force itself.
    #[inline(always)]
    pub fn reduced(&self, force: [f64; 3], torque: [f64; 3], axis: [f64; 3]) -> ([f64; 3], f64) {
        (sum(rotated_back(self.lever, force), rotated_back(self.c_ws, torque)), dot(axis, torque))
    }
}

/// Calls `body` for each of `W` wheels; Berdoz's two are written out, as the compiler does not unroll so large a body.
#[inline(always)]
pub fn for_each_wheel<const W: usize>(mut body: impl FnMut(usize)) {
    if W == 2 {
        body(0);
        body(1);
    } else {
        for w in 0..W {
            body(w);
        }
    }
}
