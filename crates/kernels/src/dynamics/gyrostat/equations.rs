//! Right-hand side of the gyrostat in lanes, for Runge-Kutta methods.

use super::{ANGLE, ANGULAR_IMPULSE, ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, OMEGA, THRUST_WORK};
use crate::dynamics::effects::within_arcs::Beside;
use crate::math::prelude::*;

/// Constants of the equations, one run per lane.
#[derive(Clone, Copy, Debug)]
pub struct Constants<R> {
    /// (J_2 - J_3)/J_1 and cyclic.
    pub ratio: [R; 3],
    /// 1/J_i, 1/(kg m^2).
    pub inverse: [R; 3],
    /// Wheels' momentum vector at the start of the arc, B, N m s.
    pub momentum: [R; 3],
    /// Rate of `momentum`: the sum of tau_i a_i, B, N m.
    pub momentum_rate: [R; 3],
    /// Torque of the thrusters about c plus body torque, B, N m.
    pub torque: [R; 3],
    /// Force of the thrusters, B, N.
    pub force: [R; 3],
    /// Velocity of c at time zero, F_e, m/s; zero if the impulse components are those of a motion relative to an orbit.
    pub velocity: [R; 3],
    /// m, kg.
    pub mass: R,
    /// 1/m, 1/kg.
    pub inverse_mass: R,
    /// Sum of tau_i h_i/J_i at the start of the arc, W.
    pub motor_power: R,
    /// Rate of `motor_power`: the sum of tau_i^2/J_i, W/s.
    pub motor_power_rate: R,
    /// Start of the arc, s.
    pub start: R,
}

impl<R: Real> Constants<R> {
    /// All zero, in the arithmetic of `zero`.
    pub fn zero(zero: R) -> Self {
        let z = [zero; 3];
        Constants {
            ratio: z,
            inverse: z,
            momentum: z,
            momentum_rate: z,
            torque: z,
            force: z,
            velocity: z,
            mass: zero,
            inverse_mass: zero,
            motor_power: zero,
            motor_power_rate: zero,
            start: zero,
        }
    }

    /// Copies the constants of a run into lane `lane`; its unit of time `unit`, s, is a power of two.
    #[inline(always)]
    pub fn set_run(&mut self, lane: usize, run: &Gyrostat<f64>, unit: f64) {
        let j = run.moments;
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            self.ratio[i].set_lane(lane, (j[a] - j[b]) / j[i]);
            self.inverse[i].set_lane(lane, 1.0 / j[i]);
            let velocity = if run.offset.is_some() { 0.0 } else { run.v_co_e[i] * unit };
            self.velocity[i].set_lane(lane, velocity);
        }
        self.mass.set_lane(lane, run.mass);
        self.inverse_mass.set_lane(lane, 1.0 / run.mass);
    }

    /// Copies the constants of arc `arc` of the run into lane `lane`; times and rates in units of `unit` seconds.
    #[inline(always)]
    pub fn set_arc(&mut self, lane: usize, run: &Gyrostat<f64>, arc: usize, unit: f64) {
        let arc = &run.arcs[arc];
        let (momentum, rate) = (arc.momentum_b, arc.motor_torque_b);
        for i in 0..3 {
            self.momentum[i].set_lane(lane, momentum[i] * unit);
            self.momentum_rate[i].set_lane(lane, rate[i] * unit * unit);
            self.torque[i].set_lane(lane, arc.torque_b[i] * unit * unit);
            self.force[i].set_lane(lane, arc.force_b[i] * unit * unit);
        }
        let [power, power_rate] = run.motor_power(arc);
        let unit3 = unit * unit * unit;
        self.motor_power.set_lane(lane, power * unit3);
        self.motor_power_rate.set_lane(lane, power_rate * unit3 * unit);
        self.start.set_lane(lane, arc.arc.start / unit);
    }

    /// The constants of arc `arc`, as by [`Constants::set_run`] and [`Constants::set_arc`].
    #[inline(always)]
    pub fn of(run: &Gyrostat<R>, arc: usize, unit: f64) -> Self {
        let arc = &run.arcs[arc];
        let (one, unit) = (run.mass.splat(1.0), run.mass.splat(unit));
        let unit2 = unit * unit;
        let [power, power_rate] = run.motor_power(arc);
        let mut constants = Constants::zero(run.mass.zero());
        let j = run.moments;
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            constants.ratio[i] = (j[a] - j[b]) / j[i];
            constants.inverse[i] = one / j[i];
        }
        if run.offset.is_none() {
            constants.velocity = scaled(unit, run.v_co_e);
        }
        constants.mass = run.mass;
        constants.inverse_mass = one / run.mass;
        constants.momentum = scaled(unit, arc.momentum_b);
        constants.momentum_rate = scaled(unit2, arc.motor_torque_b);
        constants.torque = scaled(unit2, arc.torque_b);
        constants.force = scaled(unit2, arc.force_b);
        constants.motor_power = power * unit2 * unit;
        constants.motor_power_rate = power_rate * unit2 * unit2;
        constants.start = one.splat(arc.arc.start) / unit;
        constants
    }

    /// Part of omega' in B from constant torques.
    #[inline(always)]
    pub fn torque_acceleration(&self) -> [R; 3] {
        let [x, y, z] = difference(self.torque, self.momentum_rate);
        [self.inverse[0] * x, self.inverse[1] * y, self.inverse[2] * z]
    }

    /// omega' in B under the external torque `torque`: J* omega' = H x omega + tau_ext - sum tau_i a_i, H = J* omega +
    /// h.
    #[inline(always)]
    pub fn angular_acceleration(&self, time: R, omega: [R; 3], torque: [R; 3]) -> [R; 3] {
        let since = time - self.start;
        let h = sum(self.momentum, scaled(since, self.momentum_rate));
        let linear = cross(h, omega);
        let mut acceleration = [since; 3];
        for i in 0..3 {
            let known = (torque[i] - self.momentum_rate[i]) + linear[i];
            let product = omega[(i + 1) % 3] * omega[(i + 2) % 3];
            acceleration[i] = self.ratio[i].mul_add(product, self.inverse[i] * known);
        }
        acceleration
    }

    /// Derivative of the first `N` components. The torque of `beside` includes the arc's.
    #[inline(always)]
    pub fn derivative<const N: usize>(&self, time: R, y: &[R; N], beside: &Beside<R>) -> [R; N] {
        let torque = beside.torque;
        let zero = time.zero();
        let mut rate = [zero; N];
        let omega = three(y, OMEGA);
        rate[OMEGA..OMEGA + 3].copy_from_slice(&self.angular_acceleration(time, omega, torque));
        if N >= super::WITH_ATTITUDE {
            let q = four(y, ATTITUDE);
            rate[ATTITUDE..ATTITUDE + 4].copy_from_slice(&quaternion_rate(q, omega));
            if N >= super::WITH_ANGLES {
                rate[ANGLE..ANGLE + 3].copy_from_slice(&omega);
            }
            if N >= super::WITH_MOTORS {
                // tau_i Omega_i = tau_i h_i/J_i - tau_i a_i . omega
                let since = time - self.start;
                let driven = self.motor_power_rate.mul_add(since, self.motor_power);
                rate[MOTOR_WORK] = driven - dot(self.momentum_rate, omega);
            }
            if N >= super::WITH_THRUST {
                let c_eb = dcm_from_quaternion(q);
                let force = product(c_eb, beside.force.map_or(self.force, |own| sum(self.force, own)));
                let impulse = three(y, IMPULSE);
                let own = scaled(self.inverse_mass, impulse);
                let (velocity, all) = match &beside.carrier {
                    None => (sum(self.velocity, own), force),
                    Some(carrier) => (sum(carrier.velocity, own), sum(force, scaled(self.mass, carrier.tide))),
                };
                rate[IMPULSE..IMPULSE + 3].copy_from_slice(&all);
                rate[IMPULSE_INTEGRAL..IMPULSE_INTEGRAL + 3].copy_from_slice(&impulse);
                rate[ANGULAR_IMPULSE..ANGULAR_IMPULSE + 3].copy_from_slice(&product(c_eb, torque));
                rate[THRUST_WORK] = dot(force, velocity) + dot(torque, omega);
            }
        }
        rate
    }
}

/// q' = (1/2) q (x) omega.
#[inline(always)]
pub fn quaternion_rate<R: Real>(q: [R; 4], omega: [R; 3]) -> [R; 4] {
    let half = q[0].splat(0.5);
    let [x, y, z] = scaled(half, omega);
    [
        -q[1].mul_add(x, q[2].mul_add(y, q[3] * z)),
        q[0].mul_add(x, q[2].mul_add(z, -(q[3] * y))),
        q[0].mul_add(y, q[3].mul_add(x, -(q[1] * z))),
        q[0].mul_add(z, q[1].mul_add(y, -(q[2] * x))),
    ]
}
