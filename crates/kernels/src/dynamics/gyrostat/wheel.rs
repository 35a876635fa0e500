//! [`GyrostatWheel`]: a wheel's constants, and its rate, momentum and angle in closed form.

use crate::math::prelude::*;

/// A wheel of a run, in the frame B of [`super::Gyrostat`].
#[derive(Clone, Copy, Debug)]
pub struct GyrostatWheel<R> {
    /// Unit spin axis a_i in B.
    pub axis_b: [R; 3],
    /// Axial inertia J_i, kg m^2.
    pub axial: R,
    /// 1/J_i, 1/(kg m^2).
    pub inverse_axial: R,
    /// Constant rate relative to the body, rad/s; `None` for a free wheel.
    pub held: Option<R>,
    /// Angle at time zero, rad.
    pub angle: R,
    /// Momentum without K omega at time zero, N m s: h_i of a free wheel, J_i Omega_i of a held one.
    pub momentum: R,
}

/// Momentum and turn of a wheel at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelMotion<R> {
    /// Momentum as in [`GyrostatWheel::momentum`], N m s.
    pub momentum: R,
    /// Integral of h_i/J_i since time zero, rad (free wheels).
    pub turn: R,
}

impl<R: Real> WheelMotion<R> {
    /// The motion after `since` seconds at the motor torque `torque` (N m); h_i is linear in time.
    #[inline(always)]
    pub fn after(&self, wheel: &GyrostatWheel<R>, torque: R, since: R) -> Self {
        WheelMotion { momentum: self.momentum_after(torque, since), turn: self.turn_after(wheel, torque, since) }
    }

    #[inline(always)]
    pub fn momentum_after(&self, torque: R, since: R) -> R {
        torque.mul_add(since, self.momentum)
    }

    #[inline(always)]
    pub fn turn_after(&self, wheel: &GyrostatWheel<R>, torque: R, since: R) -> R {
        let mean = (torque.splat(0.5) * torque).mul_add(since, self.momentum);
        (mean * wheel.inverse_axial).mul_add(since, self.turn)
    }

    #[inline(always)]
    pub fn in_lanes<L: Real>(&self, zero: L) -> WheelMotion<L> {
        WheelMotion { momentum: zero.splat(self.momentum.lane(0)), turn: zero.splat(self.turn.lane(0)) }
    }
}

impl<R: Real> GyrostatWheel<R> {
    #[inline(always)]
    pub fn start(&self) -> WheelMotion<R> {
        WheelMotion { momentum: self.momentum, turn: self.momentum.zero() }
    }

    /// Rate relative to the body, rad/s, at the body rate `omega_b`: h_i/J_i - a_i . omega, or the constant rate.
    #[inline(always)]
    pub fn rate(&self, momentum: R, omega_b: [R; 3]) -> R {
        match self.held {
            Some(rate) => rate,
            None => momentum * self.inverse_axial - dot(self.axis_b, omega_b),
        }
    }

    /// Angular momentum about the axis relative to F_e, J_i (Omega_i + a_i . omega), N m s.
    #[inline(always)]
    pub fn absolute_momentum(&self, momentum: R, omega_b: [R; 3]) -> R {
        match self.held {
            Some(_) => momentum + self.axial * dot(self.axis_b, omega_b),
            None => momentum,
        }
    }

    /// Angle relative to the body at `time` (s), rad, not wrapped, from the integrals of h_i/J_i and omega since time
    /// zero.
    #[inline(always)]
    pub fn angle(&self, time: R, turn: R, turned_b: [R; 3]) -> R {
        match self.held {
            Some(rate) => rate.mul_add(time, self.angle),
            None => self.angle + (turn - dot(self.axis_b, turned_b)),
        }
    }

    #[inline(always)]
    #[expect(clippy::manual_map, reason = "a closure given to `map` is compiled outside the kernel's instruction set")]
    pub fn in_lanes<L: Real>(&self, zero: L) -> GyrostatWheel<L> {
        let splat = |value: R| zero.splat(value.lane(0));
        GyrostatWheel {
            axis_b: constant(zero, [self.axis_b[0].lane(0), self.axis_b[1].lane(0), self.axis_b[2].lane(0)]),
            axial: splat(self.axial),
            inverse_axial: splat(self.inverse_axial),
            held: match self.held {
                Some(rate) => Some(splat(rate)),
                None => None,
            },
            angle: splat(self.angle),
            momentum: splat(self.momentum),
        }
    }
}
