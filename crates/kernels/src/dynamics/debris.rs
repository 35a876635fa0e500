//! The debris D: a free rigid body in uniform translation, or near an orbit ([`super::relative_orbit`]). The attitude
//! of an isotropic body (cube) has a closed form; a box is integrated as a gyrostat without wheels.

use fearless_simd::Simd;

use super::gyrostat::Gyrostat;
use super::gyrostat::completion::{body_attitude, body_rate};
use super::relative_orbit::RelativeOrbit;
use crate::math::double_double::{DoubleDouble, two_product};
use crate::math::prelude::*;
use crate::math::sine::sin_cos_turns;
use crate::math::{Lanes, Real};
use crate::run::{Grid, LocalErrors, StateField, StateTable, Trajectory};
use crate::scene::mass::Body;
use crate::scene::{Offset, Scene};

/// True if all principal moments are equal, so that the body turns uniformly.
pub fn is_isotropic(body: &Body) -> bool {
    let j = body.inertia;
    let diagonal = j[0][0] == j[1][1] && j[1][1] == j[2][2];
    diagonal && j[0][1] == 0.0 && j[0][2] == 0.0 && j[1][2] == 0.0
}

/// Errors of [`complete_isotropic`]:
pub const ISOTROPIC_ERRORS: LocalErrors =
    LocalErrors { rounding: 0.5 * f64::EPSILON, attitude: 2.0 * f64::EPSILON, ..LocalErrors::NONE };

/// Initialises `run` with the free rotation of the debris; false if the scene has none.
pub fn set_rotation<R: Real>(run: &mut Gyrostat<R>, scene: &Scene) -> bool {
    let Some(body) = &scene.mass.debris else { return false };
    let zero = run.mass.zero();
    run.set_body(zero, body.inertia);
    run.wheels.clear();
    run.mass = zero.splat(body.mass);
    let omega_b = run.into_b(constant(zero, scene.initial.omega_de_d));
    let q_ed = constant_quaternion(zero, scene.initial.q_ed);
    let q_eb = if run.c_sb.is_some() { hamilton(q_ed, run.q_sb) } else { q_ed };
    run.start_from(omega_b, q_eb);
    true
}

/// Fills position and velocity in uniform translation.
#[inline(always)]
pub fn complete_translation<S: Simd>(simd: S, scene: &Scene, grid: &Grid, table: &mut StateTable) {
    let initial = &scene.initial;
    for i in 0..3 {
        let (start, velocity) = (initial.r_gdo_e[i], initial.v_gdo_e[i]);
        if table.has(StateField::DebrisPosition) {
            let (start, slope) = (Lanes::broadcast(simd, start), Lanes::broadcast(simd, velocity));
            let column = table.column_mut(StateField::DebrisPosition, i);
            for (times, out) in grid.padded_times().chunks_exact(WIDTH).zip(column.chunks_exact_mut(WIDTH)) {
                slope.mul_add(Lanes::from_slice(simd, times), start).store(out);
            }
        }
        if table.has(StateField::DebrisVelocity) {
            table.column_mut(StateField::DebrisVelocity, i).fill(velocity);
        }
    }
}

/// Fills position and velocity of debris of `mass` kg on the path `relative`, and adds gravity's work on it.
pub fn complete_orbit(relative: &mut RelativeOrbit, mass: f64, grid: &Grid, table: &mut StateTable) {
    let (has_position, has_velocity) = (table.has(StateField::DebrisPosition), table.has(StateField::DebrisVelocity));
    let has_work = table.has(StateField::Work);
    if !(has_position || has_velocity || has_work) {
        return;
    }
    let gravity = relative.gravity();
    let mut at = |time: f64| {
        let (place, Offset { position, velocity }) = relative.at(time);
        place.displaced([position, velocity])
    };
    let start = at(0.0);
    for (point, time) in grid.padded_times().iter().enumerate() {
        let place = at(*time);
        if has_work {
            table.column_mut(StateField::Work, 0)[point] += gravity.work_on(mass, &start, &place);
        }
        for i in 0..3 {
            if has_position {
                table.column_mut(StateField::DebrisPosition, i)[point] = place.position[i];
            }
            if has_velocity {
                table.column_mut(StateField::DebrisVelocity, i)[point] = place.velocity[i];
            }
        }
    }
}

/// Fills attitude and rate of isotropic debris: q_ed(t) = q_ed(0) (x) exp(omega t/2) with constant omega in F_d. The
/// angle is reduced to a fraction of a turn as a sum of two numbers: no digits are lost after 1e10 rad.
#[inline(always)]
pub fn complete_isotropic<S: Simd>(simd: S, scene: &Scene, grid: &Grid, table: &mut StateTable) {
    let omega = scene.initial.omega_de_d;
    for (i, component) in omega.into_iter().enumerate() {
        if table.has(StateField::DebrisRate) {
            table.column_mut(StateField::DebrisRate, i).fill(component);
        }
    }
    if !table.has(StateField::DebrisAttitude) {
        return;
    }
    let square = two_product(omega[0], omega[0]) + two_product(omega[1], omega[1]) + two_product(omega[2], omega[2]);
    let rate = square.sqrt();
    // half the angle in turns per second: |omega|/(4 pi)
    let half_turns = rate / FOUR_PI;
    let axis = if rate.high == 0.0 { [0.0; 3] } else { omega.map(|x| (DoubleDouble::exact(x) / rate).high) };
    let (high, low) = (Lanes::broadcast(simd, half_turns.high), Lanes::broadcast(simd, half_turns.low));
    let start = constant_quaternion(high, scene.initial.q_ed);
    for first in (0..table.stride()).step_by(WIDTH) {
        let time = Lanes::from_slice(simd, &grid.padded_times()[first..]);
        let turns = time * high;
        let rest = low.mul_add(time, time.mul_add(high, -turns));
        let (sin, cos) = sin_cos_turns((turns - turns.round()) + rest);
        let [x, y, z] = scaled(sin, constant(high, axis));
        for (i, component) in hamilton(start, [cos, x, y, z]).into_iter().enumerate() {
            component.store(&mut table.column_mut(StateField::DebrisAttitude, i)[first..]);
        }
    }
}

const FOUR_PI: DoubleDouble = DoubleDouble { high: 12.566_370_614_359_172, low: 4.898_587_196_589_413e-16 };

/// Fills attitude and rate of a box from the components integrated from [`set_rotation`].
#[inline(always)]
pub fn complete_rotation<S: Simd>(simd: S, run: &Gyrostat<f64>, trajectory: &Trajectory, table: &mut StateTable) {
    for first in (0..table.stride()).step_by(WIDTH) {
        if table.has(StateField::DebrisRate) {
            for (i, component) in body_rate(simd, run, trajectory, first).into_iter().enumerate() {
                component.store(&mut table.column_mut(StateField::DebrisRate, i)[first..]);
            }
        }
        if table.has(StateField::DebrisAttitude) {
            for (i, component) in body_attitude(simd, run, trajectory, first).into_iter().enumerate() {
                component.store(&mut table.column_mut(StateField::DebrisAttitude, i)[first..]);
            }
        }
    }
}
