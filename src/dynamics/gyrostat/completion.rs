//! From the components that a method integrated to the physical states: eight observation points at a time.

use fearless_simd::Simd;

use super::{
    ANGLE, ANGULAR_IMPULSE, ATTITUDE, Gyrostat, IMPULSE, IMPULSE_INTEGRAL, MOTOR_WORK, OMEGA, THRUST_WORK, WITH_ANGLES,
    WITH_ATTITUDE, WITH_MOTORS, WITH_THRUST,
};
use crate::dynamics::table::{Block, Grid, StateTable, Trajectory};
use crate::math::lanes::WIDTH;
use crate::math::vector::{dot, hamilton, product};
use crate::math::{Lanes, Real};

/// The smallest number of integrated components from which the spacecraft's blocks of `table` follow.
///
/// `thrust` and `motors` say what the scene's schedule holds.
pub fn components(has: impl Fn(Block) -> bool, thrust: bool, motors: bool) -> usize {
    let forced = has(Block::ComPosition)
        || has(Block::ComVelocity)
        || has(Block::Impulse)
        || has(Block::AngularImpulse)
        || has(Block::Work);
    if thrust && forced {
        WITH_THRUST
    } else if motors && has(Block::Work) {
        WITH_MOTORS
    } else if has(Block::WheelAngles) {
        WITH_ANGLES
    } else if has(Block::Attitude) {
        WITH_ATTITUDE
    } else {
        super::RATES_ONLY
    }
}

/// Fills the spacecraft's blocks of `table` from the first `N` integrated components; blocks that need components beyond
/// them are those of a run without thrust or motors.
#[inline(always)]
pub fn complete<S: Simd, const N: usize>(
    simd: S,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    grid: &Grid,
    table: &mut StateTable,
) {
    let times = grid.padded_times();
    for first in (0..table.stride()).step_by(WIDTH) {
        let chunk = Chunk { simd, first };
        let states = rotation::<S, N>(simd, run, trajectory, first);
        chunk.write3(table, Block::Rate, states.rate);
        if let Some(attitude) = states.attitude
            && table.has(Block::Attitude)
        {
            for (i, component) in attitude.into_iter().enumerate() {
                component.store(&mut table.column_mut(Block::Attitude, i)[first..]);
            }
        }
        let omega_b = chunk.read3(trajectory, OMEGA);
        complete_wheels::<S, N>(chunk, run, trajectory, &times[first..first + WIDTH], omega_b, table);
        complete_translation::<S, N>(chunk, run, trajectory, &times[first..first + WIDTH], table);
    }
}

/// Rate and attitude of a body in its own frame at eight points.
pub struct Rotation<S: Simd> {
    /// Angular velocity in the body's frame, rad/s.
    pub rate: [Lanes<S>; 3],
    /// Attitude quaternion, body -> F_e, if it was integrated.
    pub attitude: Option<[Lanes<S>; 4]>,
}

/// The rotation at the eight points from `first` on, turned from the principal frame B into the body's own.
#[inline(always)]
pub fn rotation<S: Simd, const N: usize>(
    simd: S,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    first: usize,
) -> Rotation<S> {
    let chunk = Chunk { simd, first };
    let omega_b = chunk.read3(trajectory, OMEGA);
    let rate = match run.c_sb {
        Some(c_sb) => product(c_sb.map(|row| row.map(|x| chunk.splat(x))), omega_b),
        None => omega_b,
    };
    let attitude = (N >= WITH_ATTITUDE).then(|| {
        let q_eb = [0, 1, 2, 3].map(|i| chunk.read(trajectory, ATTITUDE + i));
        if run.c_sb.is_some() {
            let [w, x, y, z] = run.q_sb;
            hamilton(q_eb, [w, -x, -y, -z].map(|c| chunk.splat(c)))
        } else {
            q_eb
        }
    });
    Rotation { rate, attitude }
}

/// Wheel rates Omega_i = h_i/J_i - a_i . omega and, where asked for, the angles.
#[inline(always)]
fn complete_wheels<S: Simd, const N: usize>(
    chunk: Chunk<S>,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    times: &[f64],
    omega_b: [Lanes<S>; 3],
    table: &mut StateTable,
) {
    let angles = N >= WITH_ANGLES && table.has(Block::WheelAngles);
    if !table.has(Block::WheelRates) && !angles {
        return;
    }
    for wheel in 0..2 {
        let axis = run.axes_b[wheel].map(|x| chunk.splat(x));
        let inverse = run.inverse_axial(wheel);
        if inverse == 0.0 {
            // a wheel that is not there does not turn
            for block in [Block::WheelRates, Block::WheelAngles] {
                if table.has(block) {
                    chunk.zero().store(&mut table.column_mut(block, wheel)[chunk.first..]);
                }
            }
            continue;
        }
        if table.has(Block::WheelRates) {
            let momentum = chunk.along(run, times, |stretch, time| run.wheel_momentum_at(stretch, wheel, time));
            let rate = momentum * chunk.splat(inverse) - dot(axis, omega_b);
            rate.store(&mut table.column_mut(Block::WheelRates, wheel)[chunk.first..]);
        }
        if angles {
            let turn = chunk.along(run, times, |stretch, time| run.wheel_turn_at(stretch, wheel, time));
            let angle = chunk.splat(run.wheel_angles[wheel]) + (turn - dot(axis, chunk.read3(trajectory, ANGLE)));
            angle.store(&mut table.column_mut(Block::WheelAngles, wheel)[chunk.first..]);
        }
    }
}

/// Position and velocity of c, impulses and works.
#[inline(always)]
fn complete_translation<S: Simd, const N: usize>(
    chunk: Chunk<S>,
    run: &Gyrostat<f64>,
    trajectory: &Trajectory,
    times: &[f64],
    table: &mut StateTable,
) {
    let zero = chunk.zero();
    let thrust = N >= WITH_THRUST;
    let inverse_mass = chunk.splat(1.0 / run.mass);
    let read_if = |asked: bool, component: usize| if asked { chunk.read3(trajectory, component) } else { [zero; 3] };
    if table.has(Block::ComPosition) {
        let time = Lanes::from_slice(chunk.simd, times);
        let pushed = read_if(thrust, IMPULSE_INTEGRAL);
        let line = |i: usize| chunk.splat(run.v_co_e[i]).mul_add(time, chunk.splat(run.r_co_e[i]));
        chunk.write3(table, Block::ComPosition, [0, 1, 2].map(|i| pushed[i].mul_add(inverse_mass, line(i))));
    }
    let impulse = read_if(thrust, IMPULSE);
    if table.has(Block::ComVelocity) {
        let velocity = [0, 1, 2].map(|i| impulse[i].mul_add(inverse_mass, chunk.splat(run.v_co_e[i])));
        chunk.write3(table, Block::ComVelocity, velocity);
    }
    if table.has(Block::Impulse) {
        chunk.write3(table, Block::Impulse, impulse);
    }
    if table.has(Block::AngularImpulse) {
        chunk.write3(table, Block::AngularImpulse, read_if(thrust, ANGULAR_IMPULSE));
    }
    if table.has(Block::Work) {
        let read = |asked: bool, component: usize| if asked { chunk.read(trajectory, component) } else { zero };
        read(thrust, THRUST_WORK).store(&mut table.column_mut(Block::Work, 0)[chunk.first..]);
        read(N >= WITH_MOTORS, MOTOR_WORK).store(&mut table.column_mut(Block::Work, 1)[chunk.first..]);
    }
}

/// Eight points of a table, from point `first` on.
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
        [0, 1, 2].map(|i| self.read(trajectory, component + i))
    }

    #[inline(always)]
    fn write3(self, table: &mut StateTable, block: Block, values: [Lanes<S>; 3]) {
        if table.has(block) {
            for (i, value) in values.into_iter().enumerate() {
                value.store(&mut table.column_mut(block, i)[self.first..]);
            }
        }
    }

    /// A quantity that is known in closed form on each stretch, at the eight times.
    #[inline(always)]
    fn along(
        self,
        run: &Gyrostat<f64>,
        times: &[f64],
        quantity: impl Fn(&super::Stretch<f64>, f64) -> f64,
    ) -> Lanes<S> {
        let mut values = [0.0; WIDTH];
        for (value, time) in values.iter_mut().zip(times) {
            *value = quantity(run.stretch_at(*time), *time);
        }
        Lanes::load(self.simd, &values)
    }
}
