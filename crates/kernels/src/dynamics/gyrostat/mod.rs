//! The gyrostat: the spacecraft with its wheels, reduced to its independent motions.
//!
//! With balanced axisymmetric wheels on fixed centres the inertia in F_s is constant: a Zhukovskii-Volterra gyrostat
//! (N. E. Zhukovskii, 1885; V. Volterra, Acta Math. 22, 1899; J. Wittenburg, *Dynamics of Multibody Systems*, 2008,
//! section 4.6). About the centre of mass c, with J* = J - sum J_i a_i a_i^T over all wheels:
//!
//! ```text
//! H = J* omega + sum h_i a_i,    J* omega' = H x omega + tau_ext - sum tau_i a_i,    h_i' = tau_i
//! ```
//!
//! A wheel of constant speed adds its axial inertia to the body's: with K = J* + sum over held wheels of J_i a_i a_i^T
//! the equations hold for
//!
//! ```text
//! H = K omega + sum over free wheels h_i a_i + sum over held wheels J_i Omega_i a_i
//! ```
//!
//! The motor of a held wheel exerts J_i omega' . a_i; its work is Omega_i J_i (omega - omega(0)) . a_i.
//!
//! Everything is in the *principal frame* B of K (F_s if J* is diagonal), where omega_i' is one product of two rates
//! plus linear terms. Torques and thrusts are constant between switches; h_i is linear in time and not integrated.

pub(crate) mod completion;
pub mod equations;
pub mod observed;
mod time_scale;
pub(crate) mod wheel;

use crate::dynamics::applied::scheduled_arc;
use crate::dynamics::arc_record::ArcRecord;
use crate::dynamics::effects::{ChangingEffects, ForceModel, largest_changing_rate};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::dynamics::surroundings::{OfArcs, Segment, Surroundings};
use crate::math::prelude::*;
use crate::math::symmetric::principal_axes;
use crate::scene::{Actuation, Arc, MAX_WHEELS, Offsets, Scene, WheelMode};
use wheel::{GyrostatWheel, WheelMotion};

/// Index of the angular velocity in B, rad/s (3 components).
pub const OMEGA: usize = 0;
/// Index of the attitude quaternion q_eb (4).
pub const ATTITUDE: usize = 3;
/// Index of the integral of omega in B over time, rad (3).
pub const ANGLE: usize = 7;
/// Index of the work of the wheel motors, J (1).
pub const MOTOR_WORK: usize = 10;
/// Index of the thrusters' impulse in F_e, N s (3).
pub const IMPULSE: usize = 11;
/// Index of the time integral of that impulse, N s^2 (3).
pub const IMPULSE_INTEGRAL: usize = 14;
/// Index of the thrusters' angular impulse about c in F_e, N m s (3).
pub const ANGULAR_IMPULSE: usize = 17;
/// Index of the work of the thrusters, J (1).
pub const THRUST_WORK: usize = 20;

/// Number of components for the rates alone.
pub const RATES_ONLY: usize = 3;
/// With the attitude.
pub const WITH_ATTITUDE: usize = 7;
/// With the integral of omega (wheel angles).
pub const WITH_ANGLES: usize = 10;
/// With the work of the wheel motors.
pub const WITH_MOTORS: usize = 11;
/// With all integrals of thrust.
pub const WITH_THRUST: usize = 21;

/// An arc of a run: actuation in B, and the wheels at its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyrostatArc<R> {
    /// Start, end and actuation.
    pub arc: Arc,
    /// Force of the thrusters, B, N.
    pub force_b: [R; 3],
    /// Torque of the thrusters about c plus the body torque, B, N m.
    pub torque_b: [R; 3],
    /// The wheels at the start; zero beyond their number.
    pub wheels: [WheelMotion<R>; MAX_WHEELS],
    /// Momentum of the wheels without K omega, at the start, B, N m s.
    pub momentum_b: [R; 3],
    /// Sum of the motor torques on the wheels, B, N m.
    pub motor_torque_b: [R; 3],
}

/// One run of the gyrostat: constants in the principal frame B of K, initial state, arcs so far.
#[derive(Clone, Debug)]
pub struct Gyrostat<R> {
    /// DCM from B to F_s, by rows; `None` if B is F_s.
    pub c_sb: Option<[[R; 3]; 3]>,
    /// The quaternion of `c_sb`.
    pub q_sb: [R; 4],
    /// Principal moments of K, kg m^2.
    pub moments: [R; 3],
    /// The wheels.
    pub wheels: Vec<GyrostatWheel<R>>,
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
    /// Path of the point on the orbit, if any.
    pub orbit: Option<OrbitPath>,
    /// Position (m) and velocity (m/s) of c at time zero relative to a point on the orbit, F_e, if c may leave it; the
    /// impulse components are then those of the relative motion, m d' and m d.
    pub offset: Option<[[R; 3]; 2]>,
    /// The effects that change within an arc, in B.
    pub effects: ChangingEffects<R>,
    /// Surroundings by series, once a short arc has asked for them.
    around: Option<OfArcs>,
    /// The arcs so far, without gaps from time zero; under a law only those with observation points, and the last.
    pub arcs: Vec<GyrostatArc<R>>,
    /// All arcs flown under a law.
    pub flown: ArcRecord,
    /// Under a law, the observation points before the last arc.
    passed: usize,
    /// All arcs of the schedule, laid out for the time scale.
    scheduled: Vec<GyrostatArc<R>>,
    /// Largest rate of the motion so far, rad/s, for [`Gyrostat::time_unit`].
    rate: f64,
}

impl<R: Real> Gyrostat<R> {
    /// The gyrostat of `scene` with its whole schedule up to `duration` seconds, in the arithmetic of `zero`.
    pub fn new(zero: R, scene: &Scene, duration: f64) -> Self {
        let mut gyrostat = Self::blank(zero);
        gyrostat.reset(zero, scene);
        gyrostat.begin_schedule(scene, duration);
        gyrostat
    }

    /// A buffer for [`Gyrostat::reset`].
    pub fn blank(zero: R) -> Self {
        let z3 = [zero; 3];
        Gyrostat {
            c_sb: None,
            q_sb: [zero; 4],
            moments: z3,
            wheels: Vec::new(),
            mass: zero,
            omega_b: z3,
            q_eb: [zero; 4],
            r_co_e: z3,
            v_co_e: z3,
            orbit: None,
            offset: None,
            effects: ChangingEffects::none(),
            around: None,
            arcs: Vec::new(),
            flown: ArcRecord::default(),
            passed: 0,
            scheduled: Vec::new(),
            rate: 0.0,
        }
    }

    /// Resets to `scene` at time zero, before its first arc, in the same memory.
    pub fn reset(&mut self, zero: R, scene: &Scene) {
        let exact3 = |v: [f64; 3]| constant(zero, v);
        let Scene { mass, initial, .. } = scene;
        self.set_body(zero, mass.inertia_rotating());
        self.mass = zero.splat(mass.total);
        let omega_s = exact3(initial.omega_se_s);
        let q_es = initial.q_es.map(|x| zero.splat(x));
        let q_eb = if self.c_sb.is_some() { hamilton(q_es, self.q_sb) } else { q_es };
        self.start_from(self.into_b(omega_s), q_eb);
        let c_es = dcm_from_quaternion(q_es);
        let center = exact3(mass.center);
        self.r_co_e = sum(exact3(initial.r_po_e), product(c_es, center));
        self.v_co_e = sum(exact3(initial.v_po_e), product(c_es, cross(omega_s, center)));
        match (&mut self.orbit, &scene.orbit) {
            (Some(path), Some(orbit)) => path.reset(orbit),
            (path, orbit) => *path = orbit.as_ref().map(OrbitPath::new),
        }
        self.around = None;
        let changes = ForceModel::of(scene).changes_within_arcs();
        if changes || !self.effects.is_empty() {
            // some kilobytes, not copied for runs without effects
            self.effects = ChangingEffects::of(zero, scene, self.c_sb);
        }
        if changes {
            self.rate = self.rate.max(largest_changing_rate(scene));
        }
        if let Some(orbit) = &scene.orbit {
            (self.r_co_e, self.v_co_e) = (exact3(orbit.position), exact3(orbit.velocity));
        }
        let offset = |offsets: &Offsets| [offsets.spacecraft.position, offsets.spacecraft.velocity].map(exact3);
        self.offset = scene.offsets.as_ref().map(offset);
        if let (Some(offset), Some(orbit)) = (&self.offset, &self.orbit) {
            (self.r_co_e, self.v_co_e) = (sum(self.r_co_e, offset[0]), sum(self.v_co_e, offset[1]));
            self.rate = self.rate.max(orbit.at_start().rate());
        }
        self.set_wheels(zero, scene);
    }

    /// Impulse components at time zero, m d' (N s) and m d (kg m), if c may leave the orbit.
    pub fn start_of_offset(&self) -> Option<[R; 6]> {
        self.offset.map(|[position, velocity]| {
            let [a, b, c] = scaled(self.mass, velocity);
            let [x, y, z] = scaled(self.mass, position);
            [a, b, c, x, y, z]
        })
    }

    fn set_wheels(&mut self, zero: R, scene: &Scene) {
        self.wheels.clear();
        for (i, wheel) in scene.mass.wheels.iter().enumerate() {
            let (angle, rate) = (zero.splat(scene.initial.wheel_angles[i]), zero.splat(scene.initial.wheel_rates[i]));
            let axis_b = self.into_b(wheel.axis.map(|x| zero.splat(x)));
            let axial = zero.splat(wheel.axial);
            let inverse_axial = zero.splat(1.0) / axial;
            let (held, momentum) = match wheel.mode {
                WheelMode::Free => (None, axial * (dot(axis_b, self.omega_b) + rate)),
                // a locked wheel is part of the body, and not in the list
                WheelMode::SpeedHeld | WheelMode::Locked => (Some(rate), axial * rate),
            };
            self.wheels.push(GyrostatWheel { axis_b, axial, inverse_axial, held, angle, momentum });
        }
    }

    /// Sets omega (B) and attitude at time zero, before the first arc.
    pub fn start_from(&mut self, omega_b: [R; 3], q_eb: [R; 4]) {
        self.omega_b = omega_b;
        self.q_eb = q_eb;
        self.rate = time_scale::largest(omega_b);
        self.arcs.clear();
        self.flown.clear();
        self.passed = 0;
        self.scheduled.clear();
    }

    /// Sets the frame B to the principal axes of the inertia `j`, kg m^2, by rows.
    pub fn set_body(&mut self, zero: R, j: [[f64; 3]; 3]) {
        let exact3 = |v: [f64; 3]| constant(zero, v);
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

    /// Converts vector components from F_s to B.
    #[inline(always)]
    pub fn into_b(&self, v_s: [R; 3]) -> [R; 3] {
        match self.c_sb {
            Some(c_sb) => transposed_product(c_sb, v_s),
            None => v_s,
        }
    }

    /// Dipole of the torque rods in `arc`, B, A m^2.
    #[inline(always)]
    pub fn rods_b(&self, arc: &Arc) -> [R; 3] {
        self.into_b(constant(self.mass, arc.applied.dipole))
    }

    #[inline(always)]
    fn switch_rods(&mut self, arc: &Arc) {
        let (c_sb, dipole) = (self.c_sb, constant(self.mass, arc.applied.dipole));
        self.effects.begin_arc(|| c_sb.map_or(dipole, |c_sb| transposed_product(c_sb, dipole)));
    }

    /// Starts the next arc of a run of `scene`.
    pub fn begin_arc(&mut self, scene: &Scene, arc: Arc) {
        self.switch_rods(&arc);
        let wheels = self.wheels_at(arc.start);
        let arc = self.arc_from(scene, arc, wheels);
        self.arcs.push(arc);
    }

    /// Starts the next arc under a law, observed at `times`, with the wheels at its start.
    #[inline(always)]
    pub fn begin_flown_arc(&mut self, scene: &Scene, arc: Arc, wheels: [WheelMotion<R>; MAX_WHEELS], times: &[f64]) {
        self.flown.push(&arc);
        self.switch_rods(&arc);
        let next = self.arc_from(scene, arc, wheels);
        let before = self.passed;
        if let Some(last) = self.arcs.last_mut() {
            while times.get(self.passed).is_some_and(|time| *time <= arc.start) {
                self.passed += 1;
            }
            if self.passed == before {
                // no observation point in it: no longer needed
                *last = next;
                return;
            }
        }
        self.arcs.push(next);
    }

    #[inline(always)]
    fn arc_from(&self, scene: &Scene, arc: Arc, wheels: [WheelMotion<R>; MAX_WHEELS]) -> GyrostatArc<R> {
        let zero = self.mass.zero();
        let applied = &arc.applied;
        let mut torque_s = scene.thruster_torque_s(applied.thrust);
        if applied.body_torque != [0.0; 3] {
            // conditional, since a sum with zero could turn -0 into 0
            torque_s = sum(torque_s, applied.body_torque);
        }
        GyrostatArc {
            force_b: self.into_b(constant(zero, scene.thruster_force_s(applied.thrust))),
            torque_b: self.into_b(constant(zero, torque_s)),
            arc,
            momentum_b: self.along_axes_b(|index| wheels[index].momentum),
            motor_torque_b: self.along_axes_b(|index| zero.splat(applied.motor_torque[index])),
            wheels,
        }
    }

    /// Starts an arc without actuation until `end`.
    pub fn begin_free_arc(&mut self, end: f64) {
        let zero = [self.mass.zero(); 3];
        let start = self.arcs.last().map_or(0.0, |last| last.arc.end());
        let arc = Arc { start, applied: Actuation::none(end) };
        let wheels = self.wheels_at(start);
        let momentum_b = self.along_axes_b(|index| wheels[index].momentum);
        self.arcs.push(GyrostatArc { arc, force_b: zero, torque_b: zero, wheels, momentum_b, motor_torque_b: zero });
    }

    /// Starts all scheduled arcs of `scene` up to `duration` seconds.
    pub fn begin_schedule(&mut self, scene: &Scene, duration: f64) {
        let mut time = 0.0;
        while time < duration {
            let arc = scheduled_arc(scene, time, duration);
            time = arc.end();
            self.begin_arc(scene, arc);
            self.note_rate();
        }
    }

    /// The wheels at `time` in the last arc (zero before the first).
    #[inline(always)]
    pub fn wheels_at(&self, time: f64) -> [WheelMotion<R>; MAX_WHEELS] {
        let zero = self.mass.zero();
        let mut motions = [WheelMotion { momentum: zero, turn: zero }; MAX_WHEELS];
        let last = self.arcs.last();
        for (index, wheel) in self.wheels.iter().enumerate() {
            motions[index] = match last {
                Some(last) => self.wheel_at(last, index, time),
                None => wheel.start(),
            };
        }
        motions
    }

    /// The arc of `time`; at a switch, the one that ends.
    #[inline]
    pub fn arc_at(&self, time: f64) -> &GyrostatArc<R> {
        &self.arcs[self.arc_index_at(time)]
    }

    /// The index of [`Gyrostat::arc_at`].
    #[inline]
    pub fn arc_index_at(&self, time: f64) -> usize {
        self.arcs.partition_point(|arc| arc.arc.end() < time).min(self.arcs.len() - 1)
    }

    /// Wheel `index` at `time` within `arc`.
    #[inline(always)]
    pub fn wheel_at(&self, arc: &GyrostatArc<R>, index: usize, time: f64) -> WheelMotion<R> {
        let since = self.mass.splat(time) - self.mass.splat(arc.arc.start);
        let torque = self.mass.splat(arc.arc.applied.motor_torque[index]);
        arc.wheels[index].after(&self.wheels[index], torque, since)
    }

    /// The sum of J_i Omega_i a_i over wheels of constant speed, B, N m s, if any.
    pub fn held_momentum_b(&self) -> Option<[R; 3]> {
        let of = |wheel: &GyrostatWheel<R>| wheel.held.map(|rate| scaled(wheel.axial * rate, wheel.axis_b));
        self.wheels.iter().filter_map(of).reduce(sum)
    }

    /// The sum of tau_i h_i/J_i at the start of `arc`, W, and its rate, W/s.
    #[inline(always)]
    pub fn motor_power(&self, arc: &GyrostatArc<R>) -> [R; 2] {
        let zero = self.mass.zero();
        let mut total = [zero; 2];
        for (index, wheel) in self.wheels.iter().enumerate() {
            let torque = zero.splat(arc.arc.applied.motor_torque[index]);
            let per_momentum = torque * wheel.inverse_axial;
            let own = [per_momentum * arc.wheels[index].momentum, per_momentum * torque];
            // a sum with zero would turn -0 into 0
            total = if index == 0 { own } else { [total[0] + own[0], total[1] + own[1]] };
        }
        total
    }

    /// sum m_i a_i over the wheels, B, for a number m_i per wheel.
    #[inline(always)]
    fn along_axes_b(&self, number: impl Fn(usize) -> R) -> [R; 3] {
        let mut total = [self.mass.zero(); 3];
        for (index, wheel) in self.wheels.iter().enumerate() {
            let own = scaled(number(index), wheel.axis_b);
            // a sum with zero would turn -0 into 0
            total = if index == 0 { own } else { sum(total, own) };
        }
        total
    }

    /// Sets the time scale of a run by the schedule of `scene`.
    pub fn expect_schedule(&mut self, scene: &Scene, duration: f64) {
        if scene.schedule.is_empty() && !scene.environment.acts() {
            // one arc without torque: its rate needs no layout
            let momentum_b = self.along_axes_b(|index| self.wheels[index].momentum);
            self.rate = self.rate.max(time_scale::rate_of_momentum(self.moments, momentum_b));
            return;
        }
        self.begin_schedule(scene, duration);
        core::mem::swap(&mut self.arcs, &mut self.scheduled);
    }

    /// Starts the scheduled arc of `scene` at `time`.
    pub fn begin_scheduled_arc(&mut self, scene: &Scene, time: f64, duration: f64) {
        match self.scheduled.get(self.arcs.len()) {
            Some(next) => {
                let next = *next;
                self.switch_rods(&next.arc);
                self.arcs.push(next);
            }
            None => self.begin_arc(scene, scheduled_arc(scene, time, duration)),
        }
    }

    /// Includes the orbit in the time scale.
    pub fn note_orbit(&mut self) {
        if let Some(orbit) = &self.orbit {
            self.rate = self.rate.max(orbit.at_start().rate());
        }
    }

    /// Includes the last arc in the time scale, for a run under a law.
    #[inline(always)]
    pub fn note_rate(&mut self) {
        if let Some(last) = self.arcs.last() {
            let rate = time_scale::rate_of_momentum(self.moments, last.momentum_b);
            let torque = time_scale::rate_of_torques(self.moments, [last.torque_b, last.motor_torque_b]);
            self.rate = self.rate.max(rate.max(torque));
        }
    }

    /// The state on its orbit `path` at `time`, the end of the last arc (or zero), s.
    #[inline(always)]
    pub fn place(&self, path: &OrbitPath, time: f64) -> OrbitState<f64> {
        match &self.around {
            Some(around) if around.segment.covers(time) => around.segment.place(time),
            _ => path.state(time),
        }
    }

    /// Power of two near the time scale of the run, s.
    pub fn time_unit(&self) -> f64 {
        time_scale::time_unit(self.rate)
    }
}

impl Gyrostat<f64> {
    /// The segment of its surroundings that covers the last arc, if it is on an orbit and one does.
    pub fn covering(&mut self) -> Option<&Segment<f64>> {
        let (path, last, effects) = (self.orbit.as_ref()?, self.arcs.last()?, &self.effects);
        let around = self.around.get_or_insert_with(|| {
            let field = effects.magnetic_torque.as_ref().map(|torque| torque.field);
            let epoch = effects.solar_pressure.as_ref().map(|pressure| pressure.light.epoch);
            OfArcs::new(Surroundings::new(path, field, epoch))
        });
        around.covering(&last.arc)
    }
}
