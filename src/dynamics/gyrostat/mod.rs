//! The gyrostat: the spacecraft with its wheels reduced to what moves on its own.
//!
//! For balanced axisymmetric wheels with fixed centres the inertia in F_s is constant, and the spacecraft is a
//! Zhukovskii-Volterra gyrostat (N. E. Zhukovskii, 1885; V. Volterra, Acta Math. 22, 1899; J. Wittenburg, *Dynamics of
//! Multibody Systems*, 2008, section 4.6). About the centre of mass c, with J* = J - J_1 a1 a1^T - J_2 a2 a2^T:
//!
//! ```text
//! H = J* omega + h_1 a1 + h_2 a2,    J* omega' = H x omega + tau_ext - tau_1 a1 - tau_2 a2,    h_i' = tau_i
//! ```
//!
//! A wheel whose motor holds its speed takes the part of a free one with other constants: its axial inertia stays in the
//! inertia that resists a change of omega, and beside it stands its momentum relative to the fuselage, J_i Omega_i, which is
//! constant. With K = J* + sum over held wheels of J_i a_i a_i^T (all held: K = J) the same equations hold:
//!
//! ```text
//! H = K omega + sum over free wheels h_i a_i + sum over held wheels J_i Omega_i a_i
//! ```
//!
//! Its motor's torque is J_i omega' . a_i, and the work of that, Omega_i J_i (omega - omega(0)) . a_i, is known without a quadrature.
//!
//! Everything here is written in the *principal frame* B of K (where J* is diagonal already, B is F_s), so that products of
//! inertia cost nothing: omega_i' is one product of two rates plus linear terms. Between switches the torques and thrusts
//! are constant, h_i is linear in time and is not integrated.
//!
//! - [`Gyrostat`]: one run's constants, initial state and stretches.
//! - [`equations`]: the right-hand side, for Runge-Kutta methods in lanes.
//! - [`completion`]: integrated components -> the physical [`crate::run::StateTable`].
//!
//! Not here: Taylor recurrences of the same equations (`integrators::taylor`), the debris (`super::debris`).

pub mod completion;
pub mod equations;

use crate::math::Real;
use crate::math::symmetric::principal_axes;
use crate::math::vector::{constant, cross, dot, hamilton, quaternion_from_dcm, scaled, sum, transposed_product};
use crate::scene::{Scene, WheelMode};

/// Index of the first component of the angular velocity in B, rad/s (3).
pub const OMEGA: usize = 0;
/// Index of the first component of the attitude quaternion q_eb (4).
pub const ATTITUDE: usize = 3;
/// Index of the first component of the integral of omega in B over time, rad (3).
pub const ANGLE: usize = 7;
/// Index of the work of the wheel motors, J (1).
pub const MOTOR_WORK: usize = 10;
/// Index of the first component of the thrusters' impulse in F_e, N s (3).
pub const IMPULSE: usize = 11;
/// Index of the first component of the time integral of that impulse, N s^2 (3).
pub const IMPULSE_INTEGRAL: usize = 14;
/// Index of the first component of the thrusters' angular impulse about c in F_e, N m s (3).
pub const ANGULAR_IMPULSE: usize = 17;
/// Index of the work of the thrusters, J (1).
pub const THRUST_WORK: usize = 20;

/// Number of integrated components where only the rates are wanted.
pub const RATES_ONLY: usize = 3;
/// With the attitude.
pub const WITH_ATTITUDE: usize = 7;
/// With the integral of omega (wheel angles).
pub const WITH_ANGLES: usize = 10;
/// With the work of the wheel motors.
pub const WITH_MOTORS: usize = 11;
/// With everything that thrust asks for.
pub const WITH_THRUST: usize = 21;

/// A stretch of a run over which forces and torques are constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch<R> {
    /// Start, s.
    pub start: f64,
    /// End, s.
    pub end: f64,
    /// Whether any thrust or motor acts.
    pub actuated: bool,
    /// Force of the thrusters, B, N.
    pub force_b: [R; 3],
    /// Torque of the thrusters about c, B, N m.
    pub torque_b: [R; 3],
    /// Motor torques tau_1, tau_2 on the wheels, N m.
    pub motor: [R; 2],
    /// Momenta of the wheels beside K omega at the start, N m s: h_i of a free wheel, J_i Omega_i of one whose speed is held.
    pub wheel_momentum: [R; 2],
    /// Integrals of h_i/J_i over time from zero to the start, rad (of free wheels).
    pub wheel_turn: [R; 2],
}

impl<R: Real> Stretch<R> {
    /// A stretch without thrust or motor, and wheels without momentum.
    pub fn free(zero: R, start: f64, end: f64) -> Self {
        Stretch {
            start,
            end,
            actuated: false,
            force_b: [zero; 3],
            torque_b: [zero; 3],
            motor: [zero; 2],
            wheel_momentum: [zero; 2],
            wheel_turn: [zero; 2],
        }
    }
}

/// One run of the gyrostat: constants in the principal frame B of K, the initial state and the stretches.
#[derive(Clone, Debug)]
pub struct Gyrostat<R> {
    /// Maps B components to F_s components, by rows; `None` where B is F_s.
    pub c_sb: Option<[[R; 3]; 3]>,
    /// The quaternion of `c_sb`.
    pub q_sb: [R; 4],
    /// Principal moments of K, kg m^2.
    pub moments: [R; 3],
    /// Wheel axes a1, a2 in B.
    pub axes_b: [[R; 3]; 2],
    /// Axial inertias J_1, J_2 of the wheels, kg m^2; zero for a wheel that is not there.
    pub axial: [R; 2],
    /// Rates relative to the fuselage of the wheels whose speed is held, rad/s; `None` of a free one.
    pub held: [Option<R>; 2],
    /// Mass of the spacecraft, kg.
    pub mass: R,
    /// Angular velocity at time zero, B, rad/s.
    pub omega_b: [R; 3],
    /// Attitude at time zero, B -> F_e.
    pub q_eb: [R; 4],
    /// Position of c at time zero, m.
    pub r_co_e: [R; 3],
    /// Velocity of c at time zero, m/s.
    pub v_co_e: [R; 3],
    /// Wheel angles at time zero, rad.
    pub wheel_angles: [R; 2],
    /// The stretches, which cover the horizon from zero without a gap.
    pub stretches: Vec<Stretch<R>>,
}

impl<R: Real> Gyrostat<R> {
    /// The gyrostat of `scene` over `duration` seconds; `zero` says in which arithmetic.
    pub fn new(zero: R, scene: &Scene, duration: f64) -> Self {
        let mut gyrostat = Self::blank(zero);
        gyrostat.reset(zero, scene, duration);
        gyrostat
    }

    /// Nothing yet: a buffer for [`Gyrostat::reset`].
    pub fn blank(zero: R) -> Self {
        let z3 = [zero; 3];
        Gyrostat {
            c_sb: None,
            q_sb: [zero; 4],
            moments: z3,
            axes_b: [z3; 2],
            axial: [zero; 2],
            held: [None; 2],
            mass: zero,
            omega_b: z3,
            q_eb: [zero; 4],
            r_co_e: z3,
            v_co_e: z3,
            wheel_angles: [zero; 2],
            stretches: Vec::new(),
        }
    }

    /// The same as [`Gyrostat::new`], in place: reuses the buffer of the stretches.
    pub fn reset(&mut self, zero: R, scene: &Scene, duration: f64) {
        let exact3 = |v: [f64; 3]| v.map(|x| zero.splat(x));
        let mass = &scene.mass;
        let initial = &scene.initial;
        self.set_body(zero, mass.inertia_rotating());
        for (i, wheel) in mass.wheels.iter().enumerate() {
            self.axes_b[i] = self.into_b(exact3(wheel.axis));
            self.axial[i] = zero.splat(wheel.axial);
            self.held[i] = match wheel.mode {
                WheelMode::Free => None,
                WheelMode::SpeedHeld => Some(zero.splat(initial.wheel_rates[i])),
            };
            self.wheel_angles[i] = zero.splat(initial.wheel_angles[i]);
        }
        self.mass = zero.splat(mass.total);
        let omega_s = exact3(initial.omega_se_s);
        self.omega_b = self.into_b(omega_s);
        let q_es = initial.q_es.map(|x| zero.splat(x));
        self.q_eb = if self.c_sb.is_some() { hamilton(q_es, self.q_sb) } else { q_es };
        let c_es = crate::math::vector::dcm_from_quaternion(q_es);
        let center = exact3(mass.center);
        self.r_co_e = sum(exact3(initial.r_po_e), crate::math::vector::product(c_es, center));
        self.v_co_e = sum(exact3(initial.v_po_e), crate::math::vector::product(c_es, cross(omega_s, center)));
        self.lay_stretches(zero, scene, duration);
    }

    /// Takes the principal axes of the inertia `j`, kg m^2 by rows, as the frame B.
    pub fn set_body(&mut self, zero: R, j: [[f64; 3]; 3]) {
        let exact3 = |v: [f64; 3]| v.map(|x| zero.splat(x));
        if j[0][1] == 0.0 && j[0][2] == 0.0 && j[1][2] == 0.0 {
            self.c_sb = None;
            self.q_sb = [zero.splat(1.0), zero, zero, zero];
            self.moments = exact3([j[0][0], j[1][1], j[2][2]]);
        } else {
            let (moments, c_sb) = principal_axes(j.map(exact3));
            self.c_sb = Some(c_sb);
            self.q_sb = quaternion_from_dcm(c_sb);
            self.moments = moments;
        }
    }

    /// Vector components in F_s -> B.
    #[inline(always)]
    pub fn into_b(&self, v_s: [R; 3]) -> [R; 3] {
        match self.c_sb {
            Some(c_sb) => transposed_product(c_sb, v_s),
            None => v_s,
        }
    }

    /// The scene's stretches with their forces in B, and the wheels' momenta and turns carried from one to the next.
    fn lay_stretches(&mut self, zero: R, scene: &Scene, duration: f64) {
        self.stretches.clear();
        let mut momentum: [R; 2] = std::array::from_fn(|i| {
            let rate = match self.held[i] {
                Some(rate) => rate,
                None => dot(self.axes_b[i], self.omega_b) + zero.splat(scene.initial.wheel_rates[i]),
            };
            self.axial[i] * rate
        });
        let mut turn = [zero; 2];
        for arc in scene.arcs(duration) {
            let applied = &arc.applied;
            let stretch = Stretch {
                start: arc.start,
                end: arc.end(),
                actuated: applied.acts(),
                force_b: self.into_b(constant(zero, scene.thruster_force_s(applied.thrust))),
                torque_b: self.into_b(constant(zero, scene.thruster_torque_s(applied.thrust))),
                motor: applied.motor_torque.map(|x| zero.splat(x)),
                wheel_momentum: momentum,
                wheel_turn: turn,
            };
            momentum = std::array::from_fn(|i| self.wheel_momentum_at(&stretch, i, stretch.end));
            turn = std::array::from_fn(|i| self.wheel_turn_at(&stretch, i, stretch.end));
            self.stretches.push(stretch);
        }
    }

    /// The stretch that `time` lies in; the one that ends there, at a switch.
    #[inline]
    pub fn stretch_at(&self, time: f64) -> &Stretch<R> {
        let after = self.stretches.partition_point(|stretch| stretch.end < time);
        &self.stretches[after.min(self.stretches.len() - 1)]
    }

    /// Momentum of a wheel beside K omega at `time` within `stretch`, N m s.
    #[inline(always)]
    pub fn wheel_momentum_at(&self, stretch: &Stretch<R>, wheel: usize, time: f64) -> R {
        let since = self.mass.splat(time) - self.mass.splat(stretch.start);
        stretch.motor[wheel].mul_add(since, stretch.wheel_momentum[wheel])
    }

    /// Integral of h_i/J_i from time zero to `time` within `stretch`, rad: the wheel's angle is this less a_i . (integral of omega).
    #[inline(always)]
    pub fn wheel_turn_at(&self, stretch: &Stretch<R>, wheel: usize, time: f64) -> R {
        let since = self.mass.splat(time) - self.mass.splat(stretch.start);
        let half = self.mass.splat(0.5);
        let mean = (half * stretch.motor[wheel]).mul_add(since, stretch.wheel_momentum[wheel]);
        (mean * self.inverse_axial(wheel)).mul_add(since, stretch.wheel_turn[wheel])
    }

    /// 1/J_i, or zero for a wheel that is not there.
    #[inline(always)]
    pub fn inverse_axial(&self, wheel: usize) -> R {
        let axial = self.axial[wheel];
        if self.is_missing(wheel) { axial.zero() } else { axial.splat(1.0) / axial }
    }

    /// Rate of a wheel relative to the fuselage at `time` within `stretch`, rad/s, where the body turns with `omega_b`:
    /// h_i/J_i - a_i . omega, or what it is held at.
    pub fn wheel_rate_at(&self, stretch: &Stretch<R>, wheel: usize, time: f64, omega_b: [R; 3]) -> R {
        match self.held[wheel] {
            Some(rate) => rate,
            None if self.is_missing(wheel) => self.mass.zero(),
            None => {
                let absolute = self.wheel_momentum_at(stretch, wheel, time) * self.inverse_axial(wheel);
                absolute - dot(self.axes_b[wheel], omega_b)
            }
        }
    }

    /// Angle of a wheel at `time` within `stretch`, rad, where the integral of omega since time zero is `turned_b`.
    pub fn wheel_angle_at(&self, stretch: &Stretch<R>, wheel: usize, time: f64, turned_b: [R; 3]) -> R {
        match self.held[wheel] {
            Some(rate) => rate.mul_add(rate.splat(time), self.wheel_angles[wheel]),
            None if self.is_missing(wheel) => self.mass.zero(),
            None => {
                let absolute = self.wheel_turn_at(stretch, wheel, time);
                self.wheel_angles[wheel] + (absolute - dot(self.axes_b[wheel], turned_b))
            }
        }
    }

    /// Whether the spacecraft lacks a wheel.
    #[inline(always)]
    pub fn is_missing(&self, wheel: usize) -> bool {
        self.axial[wheel].lane(0) == 0.0
    }

    /// The sum of J_i Omega_i a_i over the wheels whose speed is held, B, N m s, where there are any. Since time zero their motors have
    /// done the work of this vector . (omega - omega(0)).
    pub fn held_momentum_b(&self) -> Option<[R; 3]> {
        let of = |wheel: usize| self.held[wheel].map(|rate| scaled(self.axial[wheel] * rate, self.axes_b[wheel]));
        match (of(0), of(1)) {
            (Some(first), Some(second)) => Some(sum(first, second)),
            (first, second) => first.or(second),
        }
    }

    /// Sum of tau_i h_i/J_i at the start of `stretch`, W, and its rate, W/s.
    pub fn motor_power(&self, stretch: &Stretch<R>) -> [R; 2] {
        let per_wheel = |i: usize| {
            let scaled = stretch.motor[i] * self.inverse_axial(i);
            [scaled * stretch.wheel_momentum[i], scaled * stretch.motor[i]]
        };
        let (first, second) = (per_wheel(0), per_wheel(1));
        [first[0] + second[0], first[1] + second[1]]
    }

    /// The wheels' momenta as one vector in B, N m s.
    #[inline(always)]
    pub fn wheel_momentum_b(&self, momentum: [R; 2]) -> [R; 3] {
        sum(scaled(momentum[0], self.axes_b[0]), scaled(momentum[1], self.axes_b[1]))
    }
}

impl Gyrostat<f64> {
    /// A power of two near the time scale of the run, s: from its rates, its wheels and what acts on it.
    pub fn time_unit(&self) -> f64 {
        let smallest = self.moments[0].min(self.moments[1]).min(self.moments[2]);
        let mut rate = largest(self.omega_b);
        for stretch in &self.stretches {
            rate = rate.max(largest(self.wheel_momentum_b(stretch.wheel_momentum)) / smallest);
            let torque = largest(stretch.torque_b).max(largest(self.wheel_momentum_b(stretch.motor)));
            rate = rate.max((torque / smallest).sqrt());
        }
        if rate.is_nan() || rate <= SLOWEST {
            return 1.0 / SLOWEST;
        }
        // the exponent alone: 2^-floor(log2 rate)
        let exponent = (rate.to_bits() >> 52) & 0x7ff;
        f64::from_bits((2046 - exponent) << 52)
    }
}

/// Below this rate, rad/s, nothing is resolved more finely: 2^-200.
const SLOWEST: f64 = 6.223_015_277_861_142e-61;

/// The largest component.
fn largest(v: [f64; 3]) -> f64 {
    v[0].abs().max(v[1].abs()).max(v[2].abs())
}
