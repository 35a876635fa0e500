//! Physical states from integrated components, eight observation points at a time.

use fearless_simd::Simd;

use super::{
    ANGLE, ANGULAR_IMPULSE, ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, OMEGA, THRUST_WORK, WITH_ANGLES,
    WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST,
};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::lanes::WIDTH;
use crate::math::vector::{
    conjugate, constant, constant_matrix, constant_quaternion, difference, dot, hamilton, product, scaled, sum,
};
use crate::math::{Lanes, Real};
use crate::run::{Grid, StateField, StateTable, Trajectory};

/// The smallest number of integrated components from which the spacecraft's requested fields follow; `thrust` (or body
/// torque) and `motors` may act.
pub fn components(has: impl Fn(StateField) -> bool, thrust: bool, motors: bool) -> usize {
    let forced = has(StateField::ComPosition)
        || has(StateField::ComVelocity)
        || has(StateField::Impulse)
        || has(StateField::AngularImpulse)
        || has(StateField::Work);
    if thrust && forced {
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

/// Fills the spacecraft's fields of `table` from the integrated components. Fields beyond the components of
/// `trajectory` are those of a run without thrust or motors.
///
/// The number of components is a run-time value: one copy for all kernels, at no measurable cost.
#[inline(always)]
pub fn complete<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, grid: &Grid, table: &mut StateTable) {
    complete_rotation(simd, run, trajectory, table);
    let times = grid.padded_times();
    let wheels = table.has(StateField::WheelRates)
        || trajectory.components() >= WITH_ANGLES && table.has(StateField::WheelAngles);
    let translation = [
        StateField::ComPosition,
        StateField::ComVelocity,
        StateField::Impulse,
        StateField::AngularImpulse,
        StateField::Work,
    ];
    let translation = translation.into_iter().any(|field| table.has(field));
    if wheels {
        table.clear_wheels(run.wheels.len());
        for first in (0..table.stride()).step_by(WIDTH) {
            complete_wheels(Chunk { simd, first }, run, trajectory, &times[first..first + WIDTH], table);
        }
    }
    match (translation, trajectory.components() >= WITH_THRUST) {
        (false, _) => {}
        (true, false) => complete_translations::<S, false>(simd, run, trajectory, times, table),
        (true, true) => complete_translations::<S, true>(simd, run, trajectory, times, table),
    }
}

/// Rates and attitudes; copied if B is F_s.
#[inline(always)]
fn complete_rotation<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, table: &mut StateTable) {
    let attitude = trajectory.components() >= WITH_ATTITUDE && table.has(StateField::Attitude);
    if run.c_sb.is_none() {
        for i in 0..3 {
            if table.has(StateField::Rate) {
                table.column_mut(StateField::Rate, i).copy_from_slice(trajectory.column(OMEGA + i));
            }
        }
        for i in 0..4 {
            if attitude {
                table.column_mut(StateField::Attitude, i).copy_from_slice(trajectory.column(ATTITUDE + i));
            }
        }
        return;
    }
    for first in (0..table.stride()).step_by(WIDTH) {
        Chunk { simd, first }.write3(table, StateField::Rate, body_rate(simd, run, trajectory, first));
        if attitude {
            for (i, component) in body_attitude(simd, run, trajectory, first).into_iter().enumerate() {
                component.store(&mut table.column_mut(StateField::Attitude, i)[first..]);
            }
        }
    }
}

/// Angular velocity in the body frame at the eight points from `first` on, rad/s, from the principal frame B.
#[inline(always)]
pub fn body_rate<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, first: usize) -> [Lanes<S>; 3] {
    let chunk = Chunk { simd, first };
    let omega_b = chunk.read3(trajectory, OMEGA);
    match run.c_sb {
        Some(c_sb) => product(constant_matrix(chunk.zero(), c_sb), omega_b),
        None => omega_b,
    }
}

/// Attitude quaternion, body -> F_e, at the eight points from `first` on; needs the attitude among the components.
#[inline(always)]
pub fn body_attitude<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, first: usize) -> [Lanes<S>; 4] {
    let chunk = Chunk { simd, first };
    let [x, y, z] = chunk.read3(trajectory, ATTITUDE + 1);
    let q_eb = [chunk.read(trajectory, ATTITUDE), x, y, z];
    match run.c_sb {
        Some(_) => hamilton(q_eb, conjugate(constant_quaternion(chunk.zero(), run.q_sb))),
        None => q_eb,
    }
}

/// Wheel rates and, if requested, angles.
#[inline(always)]
fn complete_wheels<S: Simd>(
    chunk: Chunk<S>,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    times: &[f64],
    table: &mut StateTable,
) {
    let omega_b = chunk.read3(trajectory, OMEGA);
    let angles = trajectory.components() >= WITH_ANGLES && table.has(StateField::WheelAngles);
    for (index, wheel) in run.wheels.iter().enumerate() {
        let lanes = wheel.in_lanes(chunk.zero());
        if table.has(StateField::WheelRates) {
            let momentum = chunk.along(
                run,
                times,
                #[inline(always)]
                |arc, since| {
                    let torque = chunk.splat(arc.arc.applied.motor_torque[index]);
                    arc.wheels[index].in_lanes(since).momentum_after(torque, since)
                },
            );
            let rate = lanes.rate(momentum, omega_b);
            rate.store(&mut table.column_mut(StateField::WheelRates, index)[chunk.first..]);
        }
        if angles {
            let turn = chunk.along(
                run,
                times,
                #[inline(always)]
                |arc, since| {
                    let torque = chunk.splat(arc.arc.applied.motor_torque[index]);
                    arc.wheels[index].in_lanes(since).turn_after(&lanes, torque, since)
                },
            );
            let time = Lanes::from_slice(chunk.simd, times);
            let angle = lanes.angle(time, turn, chunk.read3(trajectory, ANGLE));
            angle.store(&mut table.column_mut(StateField::WheelAngles, index)[chunk.first..]);
        }
    }
}

/// Position, velocity, impulses and work at all points, with or without `THRUST`.
#[inline(always)]
fn complete_translations<S: Simd, const THRUST: bool>(
    simd: S,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    times: &[f64],
    table: &mut StateTable,
) {
    for first in (0..table.stride()).step_by(WIDTH) {
        let chunk = Chunk { simd, first };
        complete_translation::<S, THRUST>(chunk, run, trajectory, &times[first..first + WIDTH], table);
        complete_work::<S, THRUST>(chunk, run, trajectory, &times[first..first + WIDTH], table);
    }
}

/// Work of thrusters, body torques, gravity and wheel motors, including motors that hold a speed.
#[inline(always)]
fn complete_work<S: Simd, const THRUST: bool>(
    chunk: Chunk<S>,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    times: &[f64],
    table: &mut StateTable,
) {
    if !table.has(StateField::Work) {
        return;
    }
    let mut thrusters = chunk.read_if(THRUST, trajectory, THRUST_WORK);
    if let Some(orbit) = &run.orbit {
        let mut place = orbit.states(Lanes::from_slice(chunk.simd, times));
        let gravity = orbit.gravity();
        let work = if run.offset.is_none() && gravity.oblateness.is_none() {
            orbit.at_start().in_lanes(chunk.zero()).work(place.distance)
        } else {
            if run.offset.is_some() {
                place = place.displaced(chunk.offset(run, trajectory));
            }
            let start = OrbitState::at_rest(constant(chunk.zero(), run.r_co_e));
            gravity.in_lanes(chunk.zero()).work(&start, &place)
        };
        thrusters += chunk.splat(run.mass) * work;
    }
    let mut motors = chunk.read_if(trajectory.components() >= WITH_MOTORS, trajectory, MOTOR_WORK);
    if let Some(held) = run.held_momentum_b() {
        let change = difference(chunk.read3(trajectory, OMEGA), constant(chunk.zero(), run.omega_b));
        motors += dot(constant(chunk.zero(), held), change);
    }
    thrusters.store(&mut table.column_mut(StateField::Work, 0)[chunk.first..]);
    motors.store(&mut table.column_mut(StateField::Work, 1)[chunk.first..]);
}

#[inline(always)]
fn complete_translation<S: Simd, const THRUST: bool>(
    chunk: Chunk<S>,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    times: &[f64],
    table: &mut StateTable,
) {
    if let Some(orbit) = &run.orbit {
        complete_orbit(chunk, run, orbit, trajectory, times, table);
    } else {
        complete_line::<S, THRUST>(chunk, run, trajectory, times, table);
    }
    if table.has(StateField::AngularImpulse) {
        chunk.write3(table, StateField::AngularImpulse, chunk.read3_if(THRUST, trajectory, ANGULAR_IMPULSE));
    }
}

/// Position, velocity and impulse of c on an orbit or near it; the impulse includes gravity's.
#[inline(always)]
fn complete_orbit<S: Simd>(
    chunk: Chunk<S>,
    run: &Gyrostat<f64>,
    orbit: &OrbitPath,
    trajectory: &Trajectory,
    times: &[f64],
    table: &mut StateTable,
) {
    let fields = [StateField::ComPosition, StateField::ComVelocity, StateField::Impulse];
    if !fields.into_iter().any(|field| table.has(field)) {
        return;
    }
    let mut place = orbit.states(Lanes::from_slice(chunk.simd, times));
    let mut gained = difference(place.velocity, constant(chunk.zero(), run.v_co_e));
    if let Some([_, velocity]) = &run.offset {
        let offset = chunk.offset(run, trajectory);
        let of_orbit = difference(place.velocity, constant(chunk.zero(), orbit.at_start().start()[1]));
        gained = sum(of_orbit, difference(offset[1], constant(chunk.zero(), *velocity)));
        place = place.displaced(offset);
    }
    chunk.write3(table, StateField::ComPosition, place.position);
    chunk.write3(table, StateField::ComVelocity, place.velocity);
    chunk.write3(table, StateField::Impulse, scaled(chunk.splat(run.mass), gained));
}

/// Position, velocity and impulse of c on a straight line bent by thrust.
#[inline(always)]
fn complete_line<S: Simd, const THRUST: bool>(
    chunk: Chunk<S>,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    times: &[f64],
    table: &mut StateTable,
) {
    let zero = chunk.zero();
    let inverse_mass = chunk.splat(1.0 / run.mass);
    if table.has(StateField::ComPosition) {
        let time = Lanes::from_slice(chunk.simd, times);
        let pushed = chunk.read3_if(THRUST, trajectory, IMPULSE_INTEGRAL);
        let mut position = [zero; 3];
        for i in 0..3 {
            let line = chunk.splat(run.v_co_e[i]).mul_add(time, chunk.splat(run.r_co_e[i]));
            position[i] = pushed[i].mul_add(inverse_mass, line);
        }
        chunk.write3(table, StateField::ComPosition, position);
    }
    let impulse = chunk.read3_if(THRUST, trajectory, IMPULSE);
    if table.has(StateField::ComVelocity) {
        let velocity = sum(constant(zero, run.v_co_e), scaled(inverse_mass, impulse));
        chunk.write3(table, StateField::ComVelocity, velocity);
    }
    if table.has(StateField::Impulse) {
        chunk.write3(table, StateField::Impulse, impulse);
    }
}

#[derive(Clone, Copy)]
struct Chunk<S: Simd> {
    simd: S,
    first: usize,
}

impl<S: Simd> Chunk<S> {
    #[inline(always)]
    fn splat(self, value: f64) -> Lanes<S> {
        Lanes::broadcast(self.simd, value)
    }

    #[inline(always)]
    fn zero(self) -> Lanes<S> {
        self.splat(0.0)
    }

    #[inline(always)]
    fn read(self, trajectory: &Trajectory, component: usize) -> Lanes<S> {
        Lanes::from_slice(self.simd, &trajectory.column(component)[self.first..])
    }

    #[inline(always)]
    fn read3(self, trajectory: &Trajectory, component: usize) -> [Lanes<S>; 3] {
        [self.read(trajectory, component), self.read(trajectory, component + 1), self.read(trajectory, component + 2)]
    }

    #[inline(always)]
    fn read_if(self, asked: bool, trajectory: &Trajectory, component: usize) -> Lanes<S> {
        if asked { self.read(trajectory, component) } else { self.zero() }
    }

    #[inline(always)]
    fn read3_if(self, asked: bool, trajectory: &Trajectory, component: usize) -> [Lanes<S>; 3] {
        if asked { self.read3(trajectory, component) } else { [self.zero(); 3] }
    }

    /// Position (m) and velocity (m/s) of c relative to the point on its orbit.
    #[inline(always)]
    fn offset(self, run: &Gyrostat<f64>, trajectory: &Trajectory) -> [[Lanes<S>; 3]; 2] {
        let inverse_mass = self.splat(1.0 / run.mass);
        [IMPULSE_INTEGRAL, IMPULSE].map(|first| scaled(inverse_mass, self.read3(trajectory, first)))
    }

    #[inline(always)]
    fn write3(self, table: &mut StateTable, field: StateField, values: [Lanes<S>; 3]) {
        if table.has(field) {
            for (i, value) in values.into_iter().enumerate() {
                value.store(&mut table.column_mut(field, i)[self.first..]);
            }
        }
    }

    /// A quantity with a closed form on each arc, as a function of the time since the start of the arc.
    #[inline(always)]
    fn along(
        self,
        run: &Gyrostat<f64>,
        times: &[f64],
        quantity: impl Fn(&super::GyrostatArc<f64>, Lanes<S>) -> Lanes<S>,
    ) -> Lanes<S> {
        let time = Lanes::from_slice(self.simd, times);
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
