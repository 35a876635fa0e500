//! Angles between vectors are atan2(|a x b|, a . b), accurate to rounding (W. Kahan 2006, see `attitude`). The angle
//! between attitudes is stored as tan^2 of its half, |v|^2/s^2 of the quaternion conj(q_nominal) q = (s, v).

use fearless_simd::Simd;

use super::attitude::Attitude;
use super::points::{
    Column, MeasuredRun, SeriesTable, constant, constant_matrix, first, four, needed, of_wheels, only, three,
};
use super::table::Series;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::StateField;
use crate::scene::MAX_WHEELS;

#[inline(always)]
pub fn motion<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let observed = run.observed;
    if observed.has(Series::RateSquare) {
        rate(simd, run, out);
    }
    if [Series::Nutation, Series::WheelSpeed, Series::WheelMomentum].into_iter().any(|series| observed.has(series)) {
        momentum(simd, run, out);
    }
    if observed.has(Series::FromNominal) {
        from_nominal(simd, run, out);
    }
    if observed.has(Series::FromInitial) {
        from_initial(simd, run, out);
    }
    if observed.has(Series::DebrisDirection) {
        debris_direction(simd, run, out);
    }
}

/// |omega|^2.
#[inline(always)]
fn rate<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let omega: [Column<'_>; 3] = needed(run.table, StateField::Rate, run.vectors());
    let [square] = out.write([Series::RateSquare], run.vectors());
    for (at, value) in square.iter_mut().enumerate() {
        let omega = three(simd, omega, at);
        dot(omega, omega).store(value);
    }
}

/// Angle of s3, or another axis, from the angular momentum; squares of wheel rates and of momenta J_i (Omega_i + a_i .
/// omega).
#[inline(always)]
fn momentum<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let (mass, table, vectors) = (&run.scene.mass, run.table, run.vectors());
    let omega: [_; 3] = needed(table, StateField::Rate, vectors);
    let rates: [_; MAX_WHEELS] = of_wheels(table, StateField::WheelRates, 0, vectors);
    let inertia = constant_matrix(simd, mass.inertia);
    let zero = Lanes::broadcast(simd, 0.0);
    let (mut axials, mut axes) = ([zero; MAX_WHEELS], [[zero; 3]; MAX_WHEELS]);
    for (index, wheel) in mass.wheels.iter().enumerate() {
        axials[index] = Lanes::broadcast(simd, wheel.axial);
        axes[index] = constant(simd, wheel.axis);
    }
    let blocks = const {
        [Series::Nutation.block(1), Series::WheelSpeed.block(MAX_WHEELS), Series::WheelMomentum.block(MAX_WHEELS)]
    };
    let [nutation, speeds, momenta] = out.blocks(blocks);
    let nutation = only(nutation, vectors);
    let axis = run.nutation_axis.map(|axis| constant(simd, axis));
    for at in 0..vectors {
        let omega = three(simd, omega, at);
        let mut total = product(inertia, omega);
        for wheel in 0..mass.wheels.len() {
            let rate = Lanes::load(simd, &rates[wheel][at]);
            let own = axials[wheel] * (rate + dot(axes[wheel], omega));
            total = sum(total, scaled(axials[wheel] * rate, axes[wheel]));
            (rate * rate).store(&mut speeds[wheel][at]);
            (own * own).store(&mut momenta[wheel][at]);
        }
        match axis {
            None => {
                let [x, y, z] = total;
                angle(x.mul_add(x, y * y).sqrt(), z, &mut nutation[at]);
            }
            Some(axis) => angle(norm(cross(axis, total)), dot(axis, total), &mut nutation[at]),
        }
    }
}

/// tan^2 of half the angle from the nominal attitude; NaN without one.
#[inline(always)]
fn from_nominal<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let vectors = run.vectors();
    let [square] = out.write([Series::FromNominal], vectors);
    let Some(nominal) = run.nominal else {
        square.fill([f64::NAN; WIDTH]);
        return;
    };
    let nominal = nominal.columns(vectors);
    let attitude: [_; 4] = needed(run.table, StateField::Attitude, vectors);
    for (at, value) in square.iter_mut().enumerate() {
        half_tangent_square(four(simd, nominal, at), four(simd, attitude, at)).store(value);
    }
}

/// tan^2 of half the angle from the first attitude of the run.
#[inline(always)]
fn from_initial<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let attitude: [_; 4] = needed(run.table, StateField::Attitude, run.vectors());
    let initial = four(simd, attitude, 0).map(|component| first(simd, component));
    let [square] = out.write([Series::FromInitial], run.vectors());
    for (at, value) in square.iter_mut().enumerate() {
        half_tangent_square(initial, four(simd, attitude, at)).store(value);
    }
}

/// tan^2 of half the angle between two attitudes, quaternions of any length.
#[inline(always)]
fn half_tangent_square<R: Real>(a: [R; 4], b: [R; 4]) -> R {
    let [s, x, y, z] = hamilton(conjugate(a), b);
    dot([x, y, z], [x, y, z]) / (s * s)
}

#[inline(always)]
fn debris_direction<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let (table, vectors) = (run.table, run.vectors());
    let attitude = Attitude::of(table, vectors);
    let own: [_; 3] = needed(table, StateField::ComPosition, vectors);
    let debris: [_; 3] = needed(table, StateField::DebrisPosition, vectors);
    let [direction] = out.write([Series::DebrisDirection], vectors);
    for (at, value) in direction.iter_mut().enumerate() {
        let [[.., x], [.., y], [.., z]] = attitude.c_es(simd, at);
        let s3 = [x, y, z];
        let line = difference(three(simd, debris, at), three(simd, own, at));
        angle(norm(cross(s3, line)), dot(s3, line), value);
    }
}

#[inline(always)]
pub fn angle<S: Simd>(y: Lanes<S>, x: Lanes<S>, out: &mut [f64; WIDTH]) {
    for ((out, y), x) in out.iter_mut().zip(y.to_array()).zip(x.to_array()) {
        *out = libm::atan2(y, x);
    }
}
