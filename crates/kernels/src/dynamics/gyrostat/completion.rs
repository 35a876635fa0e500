//! Physical states from integrated components, eight observation points at a time.

use fearless_simd::Simd;

use super::{
    ANGLE, ANGULAR_IMPULSE, ATTITUDE, Gyrostat, GyrostatArc, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, OMEGA, THRUST_WORK,
    WITH_ANGLES, WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST,
};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::{Grid, StateField, StateTable, Trajectory};

const TRANSLATION: [StateField; 5] = [
    StateField::ComPosition,
    StateField::ComVelocity,
    StateField::Impulse,
    StateField::AngularImpulse,
    StateField::Work,
];

/// The smallest number of integrated components from which the fields follow, if `thrust` (or body torque) and `motors`
/// may act.
pub fn components(has: impl Fn(StateField) -> bool, thrust: bool, motors: bool) -> usize {
    if thrust && TRANSLATION.into_iter().any(&has) {
        WITH_THRUST
    } else if motors && has(StateField::Work) {
        WITH_MOTORS
    } else if has(StateField::WheelAngles) {
        WITH_ANGLES
    } else if has(StateField::Attitude) {
        WITH_ATTITUDE
    } else {
        super::RATES_ONLY
    }
}

/// Fills the spacecraft's fields of `table` from the integrated components; missing ones are those of a run without
/// thrust or motors.
#[inline(always)]
pub fn complete<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, grid: &Grid, table: &mut StateTable) {
    complete_rotation(simd, run, trajectory, table);
    let has_wheels = table.has(StateField::WheelRates)
        || trajectory.components() >= WITH_ANGLES && table.has(StateField::WheelAngles);
    if has_wheels {
        table.clear_wheels(run.wheels.len());
    }
    let has_translation = TRANSLATION.into_iter().any(|field| table.has(field));
    if !has_wheels && !has_translation {
        return;
    }
    for first in (0..table.stride()).step_by(WIDTH) {
        let times = &grid.padded_times()[first..first + WIDTH];
        let chunk = Chunk { simd, run, trajectory, first, times };
        if has_wheels {
            chunk.complete_wheels(table);
        }
        if has_translation {
            chunk.complete_translation(table);
            chunk.complete_work(table);
        }
    }
}

/// Rates and attitudes; copied if B is F_s.
#[inline(always)]
fn complete_rotation<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, table: &mut StateTable) {
    let has_attitude = trajectory.components() >= WITH_ATTITUDE && table.has(StateField::Attitude);
    if run.c_sb.is_none() {
        let attitude = if has_attitude { 4 } else { 0 };
        for (field, from, count) in [(StateField::Rate, OMEGA, 3), (StateField::Attitude, ATTITUDE, attitude)] {
            for i in 0..if table.has(field) { count } else { 0 } {
                table.column_mut(field, i).copy_from_slice(trajectory.column(from + i));
            }
        }
        return;
    }
    for first in (0..table.stride()).step_by(WIDTH) {
        let chunk = Chunk { simd, run, trajectory, first, times: &[] };
        chunk.write(table, StateField::Rate, body_rate(simd, run, trajectory, first));
        if has_attitude {
            chunk.write(table, StateField::Attitude, body_attitude(simd, run, trajectory, first));
        }
    }
}

/// Angular velocity in the body frame at the eight points from `first` on, rad/s.
#[inline(always)]
pub fn body_rate<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, first: usize) -> [Lanes<S>; 3] {
    let chunk = Chunk { simd, run, trajectory, first, times: &[] };
    let omega_b = chunk.read3(OMEGA);
    match run.c_sb {
        Some(c_sb) => product(constant_matrix(chunk.zero(), c_sb), omega_b),
        None => omega_b,
    }
}

/// Attitude quaternion, body -> F_e, at the eight points from `first` on.
#[inline(always)]
pub fn body_attitude<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, first: usize) -> [Lanes<S>; 4] {
    let chunk = Chunk { simd, run, trajectory, first, times: &[] };
    let [x, y, z] = chunk.read3(ATTITUDE + 1);
    let q_eb = [chunk.read(ATTITUDE), x, y, z];
    match run.c_sb {
        Some(_) => hamilton(q_eb, conjugate(constant_quaternion(chunk.zero(), run.q_sb))),
        None => q_eb,
    }
}

/// Eight observation points of a run from `first` on, and their times, s.
#[derive(Clone, Copy)]
struct Chunk<'a, S: Simd> {
    simd: S,
    run: &'a Gyrostat<f64>,
    trajectory: &'a Trajectory,
    first: usize,
    times: &'a [f64],
}

impl<S: Simd> Chunk<'_, S> {
    #[inline(always)]
    fn complete_wheels(self, table: &mut StateTable) {
        let omega_b = self.read3(OMEGA);
        let has_angles = self.has(WITH_ANGLES) && table.has(StateField::WheelAngles);
        for (index, wheel) in self.run.wheels.iter().enumerate() {
            let lanes = wheel.in_lanes(self.zero());
            if table.has(StateField::WheelRates) {
                let momentum = self.along(
                    #[inline(always)]
                    |arc, since| {
                        let torque = self.splat(arc.arc.applied.motor_torque[index]);
                        arc.wheels[index].in_lanes(since).momentum_after(torque, since)
                    },
                );
                let rate = lanes.rate(momentum, omega_b);
                rate.store(&mut table.column_mut(StateField::WheelRates, index)[self.first..]);
            }
            if has_angles {
                let turn = self.along(
                    #[inline(always)]
                    |arc, since| {
                        let torque = self.splat(arc.arc.applied.motor_torque[index]);
                        arc.wheels[index].in_lanes(since).turn_after(&lanes, torque, since)
                    },
                );
                let angle = lanes.angle(self.time(), turn, self.read3(ANGLE));
                angle.store(&mut table.column_mut(StateField::WheelAngles, index)[self.first..]);
            }
        }
    }

    /// Work of thrusters, body torques, gravity and wheel motors.
    #[inline(always)]
    fn complete_work(self, table: &mut StateTable) {
        if !table.has(StateField::Work) {
            return;
        }
        let run = self.run;
        let mut thrusters = self.read_from(WITH_THRUST, THRUST_WORK);
        if let Some(orbit) = &run.orbit {
            let mut place = orbit.states_at([self.time(), self.zero()]);
            let gravity = orbit.gravity();
            let work = if run.offset.is_none() && gravity.oblateness.is_none() {
                orbit.at_start().in_lanes(self.zero()).work(place.distance)
            } else {
                if run.offset.is_some() {
                    place = place.displaced(self.offset());
                }
                let start = OrbitState::at_rest(constant(self.zero(), run.r_co_e));
                gravity.in_lanes(self.zero()).work(&start, &place)
            };
            thrusters += self.splat(run.mass) * work;
        }
        let mut motors = self.read_from(WITH_MOTORS, MOTOR_WORK);
        if let Some(held) = run.held_momentum_b() {
            let change = difference(self.read3(OMEGA), constant(self.zero(), run.omega_b));
            motors += dot(constant(self.zero(), held), change);
        }
        self.write(table, StateField::Work, [thrusters, motors]);
    }

    #[inline(always)]
    fn complete_translation(self, table: &mut StateTable) {
        match &self.run.orbit {
            Some(orbit) => self.complete_orbit(orbit, table),
            None => self.complete_line(table),
        }
        self.write(table, StateField::AngularImpulse, self.read3_of_thrust(ANGULAR_IMPULSE));
    }

    #[inline(always)]
    fn complete_orbit(self, orbit: &OrbitPath, table: &mut StateTable) {
        let fields = [StateField::ComPosition, StateField::ComVelocity, StateField::Impulse];
        if !fields.into_iter().any(|field| table.has(field)) {
            return;
        }
        let run = self.run;
        let mut place = orbit.states_at([self.time(), self.zero()]);
        let mut gained = difference(place.velocity, constant(self.zero(), run.v_co_e));
        if let Some([_, velocity]) = &run.offset {
            let offset = self.offset();
            let of_orbit = difference(place.velocity, constant(self.zero(), orbit.at_start().start()[1]));
            gained = sum(of_orbit, difference(offset[1], constant(self.zero(), *velocity)));
            place = place.displaced(offset);
        }
        self.write(table, StateField::ComPosition, place.position);
        self.write(table, StateField::ComVelocity, place.velocity);
        self.write(table, StateField::Impulse, scaled(self.splat(run.mass), gained));
    }

    #[inline(always)]
    fn complete_line(self, table: &mut StateTable) {
        let run = self.run;
        let inverse_mass = self.splat(1.0 / run.mass);
        if table.has(StateField::ComPosition) {
            let pushed = self.read3_of_thrust(IMPULSE_INTEGRAL);
            let mut position = [self.zero(); 3];
            for i in 0..3 {
                let line = self.splat(run.v_co_e[i]).mul_add(self.time(), self.splat(run.r_co_e[i]));
                position[i] = pushed[i].mul_add(inverse_mass, line);
            }
            self.write(table, StateField::ComPosition, position);
        }
        let impulse = self.read3_of_thrust(IMPULSE);
        let velocity = sum(constant(self.zero(), run.v_co_e), scaled(inverse_mass, impulse));
        self.write(table, StateField::ComVelocity, velocity);
        self.write(table, StateField::Impulse, impulse);
    }

    #[inline(always)]
    fn splat(self, value: f64) -> Lanes<S> {
        Lanes::broadcast(self.simd, value)
    }

    #[inline(always)]
    fn zero(self) -> Lanes<S> {
        self.splat(0.0)
    }

    #[inline(always)]
    fn time(self) -> Lanes<S> {
        Lanes::from_slice(self.simd, self.times)
    }

    #[inline(always)]
    fn has(self, components: usize) -> bool {
        self.trajectory.components() >= components
    }

    #[inline(always)]
    fn read(self, component: usize) -> Lanes<S> {
        Lanes::from_slice(self.simd, &self.trajectory.column(component)[self.first..])
    }

    #[inline(always)]
    fn read3(self, component: usize) -> [Lanes<S>; 3] {
        [self.read(component), self.read(component + 1), self.read(component + 2)]
    }

    /// A component of runs with at least `components`, else zero.
    #[inline(always)]
    fn read_from(self, components: usize, component: usize) -> Lanes<S> {
        if self.has(components) { self.read(component) } else { self.zero() }
    }

    #[inline(always)]
    fn read3_of_thrust(self, component: usize) -> [Lanes<S>; 3] {
        if self.has(WITH_THRUST) { self.read3(component) } else { [self.zero(); 3] }
    }

    /// Position (m) and velocity (m/s) of c relative to the point on its orbit.
    #[inline(always)]
    fn offset(self) -> [[Lanes<S>; 3]; 2] {
        let inverse_mass = self.splat(1.0 / self.run.mass);
        [IMPULSE_INTEGRAL, IMPULSE].map(|first| scaled(inverse_mass, self.read3(first)))
    }

    #[inline(always)]
    fn write<const K: usize>(self, table: &mut StateTable, field: StateField, values: [Lanes<S>; K]) {
        if table.has(field) {
            for (i, value) in values.into_iter().enumerate() {
                value.store(&mut table.column_mut(field, i)[self.first..]);
            }
        }
    }

    /// A quantity with a closed form on each arc, as a function of the time since the start of the arc.
    #[inline(always)]
    fn along(self, quantity: impl Fn(&GyrostatArc<f64>, Lanes<S>) -> Lanes<S>) -> Lanes<S> {
        let (run, times, time) = (self.run, self.times, self.time());
        let (first, last) = (run.arc_at(times[0]), run.arc_at(times[WIDTH - 1]));
        let all = quantity(first, time - self.splat(first.arc.start));
        if first.arc.start == last.arc.start {
            return all;
        }
        // a switch among the eight
        let mut values = all.to_array();
        for (k, value) in values.iter_mut().enumerate() {
            let arc = run.arc_at(times[k]);
            *value = quantity(arc, time - self.splat(arc.arc.start)).lane(k);
        }
        Lanes::load(self.simd, &values)
    }
}
