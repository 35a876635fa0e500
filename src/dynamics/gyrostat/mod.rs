//! The gyrostat: the spacecraft with its wheels, reduced to its independent motions.
//!
//! For balanced axisymmetric wheels with fixed centres the inertia in F_s is constant, and the spacecraft is a
//! Zhukovskii-Volterra gyrostat (N. E. Zhukovskii, 1885; V. Volterra, Acta Math. 22, 1899; J. Wittenburg, *Dynamics of
//! Multibody Systems*, 2008, section 4.6). About the centre of mass c, with J* = J - J_1 a1 a1^T - J_2 a2 a2^T:
//!
//! ```text
//! H = J* omega + h_1 a1 + h_2 a2,    J* omega' = H x omega + tau_ext - tau_1 a1 - tau_2 a2,    h_i' = tau_i
//! ```
//!
//! A wheel whose motor holds its speed has other constants: its axial inertia stays in the inertia that resists a change of
//! omega, and its momentum relative to the fuselage, J_i Omega_i, is constant. With K = J* + sum over held wheels of J_i a_i a_i^T (all held: K = J) the same equations hold:
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
//! - [`Gyrostat`]: one run's constants, initial state and arcs.
//! - [`equations`]: the right-hand side, for Runge-Kutta methods in lanes.
//! - [`completion`]: integrated components -> the physical [`crate::run::StateTable`].
//!
//! Not here: Taylor recurrences of the same equations (`propagation::taylor`), the debris (`super::debris`).

pub mod completion;
pub mod equations;

use crate::dynamics::actuation::{BodyState, WheelState};
use crate::dynamics::applied::scheduled_arc;
use crate::math::Real;
use crate::math::symmetric::principal_axes;
use crate::math::vector::{
    conjugate, constant, cross, dot, hamilton, product, quaternion_from_dcm, scaled, sum, transposed_product,
};
use crate::scene::{Actuation, Arc, Scene, WheelMode};

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

/// Number of integrated components where only the rates are needed.
pub const RATES_ONLY: usize = 3;
/// With the attitude.
pub const WITH_ATTITUDE: usize = 7;
/// With the integral of omega (wheel angles).
pub const WITH_ANGLES: usize = 10;
/// With the work of the wheel motors.
pub const WITH_MOTORS: usize = 11;
/// With all integrals of thrust.
pub const WITH_THRUST: usize = 21;

/// An arc of a run: what is applied, in B, and the wheels at its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyrostatArc<R> {
    /// Start, end and applied values.
    pub arc: Arc,
    /// Force of the thrusters, B, N.
    pub force_b: [R; 3],
    /// Torque of the thrusters about c plus the body torque, B, N m.
    pub torque_b: [R; 3],
    /// Momenta of the wheels beside K omega at the start, N m s: h_i of a free wheel, J_i Omega_i of one whose speed is held.
    pub wheel_momentum: [R; 2],
    /// Integrals of h_i/J_i over time from zero to the start, rad (of free wheels).
    pub wheel_turn: [R; 2],
}

impl<R: Real> GyrostatArc<R> {
    /// Motor torques tau_1, tau_2 on the wheels, N m.
    #[inline(always)]
    pub fn motor_torque(&self) -> [R; 2] {
        let zero = self.wheel_momentum[0];
        let [first, second] = self.arc.applied.motor_torque;
        [zero.splat(first), zero.splat(second)]
    }
}

/// One run of the gyrostat: constants in the principal frame B of K, the initial state and the arcs flown so far.
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
    /// Momenta of the wheels at time zero, N m s, as [`GyrostatArc::wheel_momentum`].
    pub initial_momentum: [R; 2],
    /// The arcs flown so far, which cover the time from zero to the end of the last without a gap.
    pub arcs: Vec<GyrostatArc<R>>,
    /// All arcs of the schedule, where it was laid out for the time scale: they need not be computed again.
    scheduled: Vec<GyrostatArc<R>>,
    /// Largest rate of the run's motion so far known, rad/s, from which [`Gyrostat::time_unit`] follows.
    rate: f64,
}

impl<R: Real> Gyrostat<R> {
    /// The gyrostat of `scene` with all arcs of its schedule up to `duration` seconds; `zero` says in which arithmetic.
    pub fn new(zero: R, scene: &Scene, duration: f64) -> Self {
        let mut gyrostat = Self::blank(zero);
        gyrostat.reset(zero, scene);
        gyrostat.begin_schedule(scene, duration);
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
            initial_momentum: [zero; 2],
            arcs: Vec::new(),
            scheduled: Vec::new(),
            rate: 0.0,
        }
    }

    /// The gyrostat of `scene` at time zero, before its first arc; the memory of the arcs is reused.
    pub fn reset(&mut self, zero: R, scene: &Scene) {
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
        let q_es = initial.q_es.map(|x| zero.splat(x));
        let q_eb = if self.c_sb.is_some() { hamilton(q_es, self.q_sb) } else { q_es };
        self.start_from(self.into_b(omega_s), q_eb);
        let c_es = crate::math::vector::dcm_from_quaternion(q_es);
        let center = exact3(mass.center);
        self.r_co_e = sum(exact3(initial.r_po_e), crate::math::vector::product(c_es, center));
        self.v_co_e = sum(exact3(initial.v_po_e), crate::math::vector::product(c_es, cross(omega_s, center)));
        for (wheel, rate) in initial.wheel_rates.into_iter().enumerate() {
            self.initial_momentum[wheel] = self.axial[wheel]
                * match self.held[wheel] {
                    Some(rate) => rate,
                    None => dot(self.axes_b[wheel], self.omega_b) + zero.splat(rate),
                };
        }
    }

    /// Sets angular velocity in B and attitude at time zero, before the first arc.
    pub fn start_from(&mut self, omega_b: [R; 3], q_eb: [R; 4]) {
        self.omega_b = omega_b;
        self.q_eb = q_eb;
        self.rate = largest(first_lane(omega_b));
        self.arcs.clear();
        self.scheduled.clear();
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

    /// Starts the next arc of a run of `scene`.
    pub fn begin_arc(&mut self, scene: &Scene, arc: Arc) {
        let zero = self.mass.zero();
        let applied = &arc.applied;
        let mut torque_s = scene.thruster_torque_s(applied.thrust);
        if applied.body_torque != [0.0; 3] {
            // apart from the common case, in which a sum with zero could still turn -0 into 0
            torque_s = sum(torque_s, applied.body_torque);
        }
        let (wheel_momentum, wheel_turn) = self.wheels_at(arc.start);
        self.arcs.push(GyrostatArc {
            force_b: self.into_b(constant(zero, scene.thruster_force_s(applied.thrust))),
            torque_b: self.into_b(constant(zero, torque_s)),
            arc,
            wheel_momentum,
            wheel_turn,
        });
    }

    /// Starts an arc without any actuation until `end`, for a body without actuators.
    pub fn begin_free_arc(&mut self, end: f64) {
        let zero = [self.mass.zero(); 3];
        let start = self.arcs.last().map_or(0.0, |last| last.arc.end());
        let (wheel_momentum, wheel_turn) = self.wheels_at(start);
        let arc = Arc { start, applied: Actuation::none(end) };
        self.arcs.push(GyrostatArc { arc, force_b: zero, torque_b: zero, wheel_momentum, wheel_turn });
    }

    /// Starts all arcs of the schedule of `scene` up to `duration` seconds.
    pub fn begin_schedule(&mut self, scene: &Scene, duration: f64) {
        let mut time = 0.0;
        while time < duration {
            let arc = scheduled_arc(scene, time, duration);
            time = arc.end();
            self.begin_arc(scene, arc);
            self.note_rate();
        }
    }

    /// Momenta of the wheels beside K omega, N m s, and integrals of h_i/J_i since time zero, rad, at `time` in the last arc (or zero
    /// before the first).
    fn wheels_at(&self, time: f64) -> ([R; 2], [R; 2]) {
        let Some(last) = self.arcs.last() else { return (self.initial_momentum, [self.mass.zero(); 2]) };
        let at = |wheel| (self.wheel_momentum_at(last, wheel, time), self.wheel_turn_at(last, wheel, time));
        let (first, second) = (at(0), at(1));
        ([first.0, second.0], [first.1, second.1])
    }

    /// The state that an actuation law sees at `time`, the end of the last arc (or zero before the first), from the integrated
    /// components there, SI, in the order of the indices of this module.
    pub fn observed_state(&self, time: f64, components: &[R; WITH_THRUST]) -> (BodyState, WheelState) {
        let three = |first: usize| [components[first], components[first + 1], components[first + 2]];
        let omega_b = three(OMEGA);
        let [x, y, z] = three(ATTITUDE + 1);
        let q_eb = [components[ATTITUDE], x, y, z];
        let (omega_s, q_es) = match self.c_sb {
            Some(c_sb) => (product(c_sb, omega_b), hamilton(q_eb, conjugate(self.q_sb))),
            None => (omega_b, q_eb),
        };
        let since_start = self.mass.splat(time);
        let inverse_mass = self.mass.splat(1.0) / self.mass;
        let line = sum(self.r_co_e, scaled(since_start, self.v_co_e));
        let body = BodyState {
            omega_se_s: first_lane(omega_s),
            q_es: first_lane(q_es),
            r_co_e: first_lane(sum(line, scaled(inverse_mass, three(IMPULSE_INTEGRAL)))),
            v_co_e: first_lane(sum(self.v_co_e, scaled(inverse_mass, three(IMPULSE)))),
        };
        let (momentum, turn) = self.wheels_at(time);
        let mut wheels = WheelState { rates: [0.0; 2], momenta: [0.0; 2], angles: [0.0; 2] };
        for i in 0..2 {
            let body_rate = dot(self.axes_b[i], omega_b);
            let (rate, absolute) = match self.held[i] {
                Some(rate) => (rate, momentum[i] + self.axial[i] * body_rate),
                None if self.is_missing(i) => (body_rate.zero(), body_rate.zero()),
                None => (momentum[i] * self.inverse_axial(i) - body_rate, momentum[i]),
            };
            wheels.rates[i] = rate.lane(0);
            wheels.momenta[i] = absolute.lane(0);
            wheels.angles[i] = self.wheel_angle(i, time, turn[i], three(ANGLE)).lane(0);
        }
        (body, wheels)
    }

    /// The arc that `time` lies in; the one that ends there, at a switch.
    #[inline]
    pub fn arc_at(&self, time: f64) -> &GyrostatArc<R> {
        &self.arcs[self.arc_index_at(time)]
    }

    /// The index of the arc that `time` lies in; of the one that ends there, at a switch.
    #[inline]
    pub fn arc_index_at(&self, time: f64) -> usize {
        self.arcs.partition_point(|arc| arc.arc.end() < time).min(self.arcs.len() - 1)
    }

    /// Momentum of a wheel beside K omega at `time` within `arc`, N m s.
    #[inline(always)]
    pub fn wheel_momentum_at(&self, arc: &GyrostatArc<R>, wheel: usize, time: f64) -> R {
        let since = self.mass.splat(time) - self.mass.splat(arc.arc.start);
        arc.motor_torque()[wheel].mul_add(since, arc.wheel_momentum[wheel])
    }

    /// Integral of h_i/J_i from time zero to `time` within `arc`, rad: the wheel's angle is this minus a_i . (integral of omega).
    #[inline(always)]
    pub fn wheel_turn_at(&self, arc: &GyrostatArc<R>, wheel: usize, time: f64) -> R {
        let since = self.mass.splat(time) - self.mass.splat(arc.arc.start);
        let half = self.mass.splat(0.5);
        let mean = (half * arc.motor_torque()[wheel]).mul_add(since, arc.wheel_momentum[wheel]);
        (mean * self.inverse_axial(wheel)).mul_add(since, arc.wheel_turn[wheel])
    }

    /// 1/J_i, or zero for a wheel that is not there.
    #[inline(always)]
    pub fn inverse_axial(&self, wheel: usize) -> R {
        let axial = self.axial[wheel];
        if self.is_missing(wheel) { axial.zero() } else { axial.splat(1.0) / axial }
    }

    /// Rate of a wheel relative to the fuselage at `time` within `arc`, rad/s, where the body turns with `omega_b`:
    /// h_i/J_i - a_i . omega, or what it is held at.
    pub fn wheel_rate_at(&self, arc: &GyrostatArc<R>, wheel: usize, time: f64, omega_b: [R; 3]) -> R {
        match self.held[wheel] {
            Some(rate) => rate,
            None if self.is_missing(wheel) => self.mass.zero(),
            None => {
                let absolute = self.wheel_momentum_at(arc, wheel, time) * self.inverse_axial(wheel);
                absolute - dot(self.axes_b[wheel], omega_b)
            }
        }
    }

    /// Angle of a wheel at `time` within `arc`, rad, where the integral of omega since time zero is `turned_b`.
    pub fn wheel_angle_at(&self, arc: &GyrostatArc<R>, wheel: usize, time: f64, turned_b: [R; 3]) -> R {
        self.wheel_angle(wheel, time, self.wheel_turn_at(arc, wheel, time), turned_b)
    }

    /// Angle of a wheel, rad, given the integral of h_i/J_i since time zero.
    fn wheel_angle(&self, wheel: usize, time: f64, absolute: R, turned_b: [R; 3]) -> R {
        match self.held[wheel] {
            Some(rate) => rate.mul_add(rate.splat(time), self.wheel_angles[wheel]),
            None if self.is_missing(wheel) => self.mass.zero(),
            None => self.wheel_angles[wheel] + (absolute - dot(self.axes_b[wheel], turned_b)),
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

    /// Sum of tau_i h_i/J_i at the start of `arc`, W, and its rate, W/s.
    pub fn motor_power(&self, arc: &GyrostatArc<R>) -> [R; 2] {
        let motor = arc.motor_torque();
        let per_wheel = |i: usize| {
            let scaled = motor[i] * self.inverse_axial(i);
            [scaled * arc.wheel_momentum[i], scaled * motor[i]]
        };
        let (first, second) = (per_wheel(0), per_wheel(1));
        [first[0] + second[0], first[1] + second[1]]
    }

    /// The wheels' momenta as one vector in B, N m s.
    #[inline(always)]
    pub fn wheel_momentum_b(&self, momentum: [R; 2]) -> [R; 3] {
        sum(scaled(momentum[0], self.axes_b[0]), scaled(momentum[1], self.axes_b[1]))
    }

    /// Prepares the time scale of a run that will fly the schedule of `scene`, which is known before it starts.
    pub fn expect_schedule(&mut self, scene: &Scene, duration: f64) {
        if scene.schedule.is_empty() && !scene.environment.acts() {
            // one arc without torque: no need to lay it out for its rate
            self.rate = self.rate.max(self.wheel_rate_of(self.initial_momentum));
            return;
        }
        self.begin_schedule(scene, duration);
        core::mem::swap(&mut self.arcs, &mut self.scheduled);
    }

    /// Starts the next arc of the schedule of `scene`, at `time`.
    pub fn begin_scheduled_arc(&mut self, scene: &Scene, time: f64, duration: f64) {
        match self.scheduled.get(self.arcs.len()) {
            Some(arc) => self.arcs.push(*arc),
            None => self.begin_arc(scene, scheduled_arc(scene, time, duration)),
        }
    }

    /// Takes the last arc into account in the time scale, for a run whose arcs are not known before it starts.
    pub fn note_rate(&mut self) {
        if let Some(last) = self.arcs.last() {
            self.rate = self.rate.max(self.rate_of(last));
        }
    }

    /// The rate that an arc adds to the motion, rad/s: of the wheels' momenta, and of the torques after one radian.
    fn rate_of(&self, arc: &GyrostatArc<R>) -> f64 {
        let motors = first_lane(self.wheel_momentum_b(arc.motor_torque()));
        let torque = largest(first_lane(arc.torque_b)).max(largest(motors));
        self.wheel_rate_of(arc.wheel_momentum).max((torque / self.smallest_moment()).sqrt())
    }

    /// The rate that wheels of momenta `momentum` add to the motion, rad/s.
    fn wheel_rate_of(&self, momentum: [R; 2]) -> f64 {
        largest(first_lane(self.wheel_momentum_b(momentum))) / self.smallest_moment()
    }

    /// The smallest principal moment of K, kg m^2.
    fn smallest_moment(&self) -> f64 {
        let moments = first_lane(self.moments);
        moments[0].min(moments[1]).min(moments[2])
    }

    /// A power of two near the time scale of the run, s: from its rates, its wheels and what acts on it.
    pub fn time_unit(&self) -> f64 {
        let rate = self.rate;
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

/// The components rounded to `f64`.
fn first_lane<R: Real, const K: usize>(v: [R; K]) -> [f64; K] {
    v.map(|component| component.lane(0))
}

/// The largest component.
fn largest(v: [f64; 3]) -> f64 {
    v[0].abs().max(v[1].abs()).max(v[2].abs())
}
