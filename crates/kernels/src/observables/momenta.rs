//! Linear and angular momenta of spacecraft and debris, and their departures from the first value.
//!
//! p = m v_c minus the thrusters' impulse; L = C_es (J omega + sum J_i Omega_i a_i) about c, with locked wheels in J,
//! minus the angular impulse of thrusters and body torques; for the debris m_d v_d and C_ed J_d omega_d. Errors are
//! relative to the magnitudes of these terms, which may cancel: |J omega| + sum |J_i Omega_i| + |impulse| and, if the
//! velocity of p is integrated, m (|v_c| + |omega| |c - p|) + |impulse|.

use fearless_simd::Simd;

use super::attitude::Attitude;
use super::points::{
    Column, MeasuredRun, SeriesTable, columns, constant, constant_matrix, count_of_wheels, first_vector, four, needed,
    of_wheels, three,
};
use super::table::Series;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::StateField;
use crate::scene::MAX_WHEELS;

/// Series of a momentum: |balance - its first value| and |momentum|^2.
struct Sink<'a, S: Simd> {
    error: &'a mut [[f64; WIDTH]],
    square: &'a mut [[f64; WIDTH]],
    start: [Lanes<S>; 3],
}

impl<'a, S: Simd> Sink<'a, S> {
    #[inline(always)]
    fn new(simd: S, [error, square]: [&'a mut [[f64; WIDTH]]; 2]) -> Self {
        Sink { error, square, start: constant(simd, [0.0; 3]) }
    }

    /// Writes vector `at`; `balance` is the momentum minus the impulse.
    #[inline(always)]
    fn put(&mut self, simd: S, at: usize, momentum: [Lanes<S>; 3], balance: [Lanes<S>; 3]) {
        if at == 0 {
            self.start = first_vector(simd, balance);
        }
        norm(difference(balance, self.start)).store(&mut self.error[at]);
        dot(momentum, momentum).store(&mut self.square[at]);
    }
}

#[inline(always)]
fn balanced<S: Simd>(
    simd: S,
    at: usize,
    momentum: [Lanes<S>; 3],
    impulse: Option<[Column<'_>; 3]>,
    terms: Lanes<S>,
) -> ([Lanes<S>; 3], Lanes<S>) {
    match impulse {
        Some(impulse) => {
            let impulse = three(simd, impulse, at);
            (difference(momentum, impulse), terms + norm(impulse))
        }
        None => (momentum, terms),
    }
}

#[inline(always)]
pub fn linear_momentum<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let (mass, table, vectors) = (&run.scene.mass, run.table, run.vectors());
    let velocity: [_; 3] = needed(table, StateField::ComVelocity, vectors);
    let impulse: Option<[_; 3]> = columns(table, StateField::Impulse, vectors);
    let total = Lanes::broadcast(simd, mass.total);
    // constraints come with the DCM and the velocity of p instead of c
    let spin: Option<[_; 3]> =
        if table.has(StateField::Dcm) { columns(table, StateField::Rate, vectors) } else { None };
    let arm = Lanes::broadcast(simd, mass.total * dot(mass.center, mass.center).sqrt());
    let written = [Series::LinearMomentumError, Series::LinearMomentumSquare, Series::LinearMomentumTerms];
    let [error, square, all_terms] = out.write(written, vectors);
    let mut sink = Sink::new(simd, [error, square]);
    for at in 0..vectors {
        let momentum = scaled(total, three(simd, velocity, at));
        let mut terms = norm(momentum);
        if let Some(spin) = spin {
            terms = arm.mul_add(norm(three(simd, spin, at)), terms);
        }
        let (balance, terms) = balanced(simd, at, momentum, impulse, terms);
        sink.put(simd, at, momentum, balance);
        terms.store(&mut all_terms[at]);
    }
}

#[inline(always)]
pub fn angular_momentum<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    match run.scene.mass.wheels.len() {
        0 => with_wheels::<S, 0>(simd, run, out),
        1 => with_wheels::<S, 1>(simd, run, out),
        2 => with_wheels::<S, 2>(simd, run, out),
        3 => with_wheels::<S, 3>(simd, run, out),
        4 => with_wheels::<S, 4>(simd, run, out),
        _ => with_wheels::<S, MAX_WHEELS>(simd, run, out),
    }
}

#[inline(always)]
fn with_wheels<S: Simd, const W: usize>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let (mass, table, vectors) = (&run.scene.mass, run.table, run.vectors());
    let attitude = Attitude::of(table, vectors);
    let omega: [_; 3] = needed(table, StateField::Rate, vectors);
    let rates: [_; W] = of_wheels(table, StateField::WheelRates, 0, vectors);
    let impulse: Option<[_; 3]> = columns(table, StateField::AngularImpulse, vectors);
    let inertia = constant_matrix(simd, mass.inertia);
    let (mut axes, mut axials) = ([constant(simd, [0.0; 3]); W], [Lanes::broadcast(simd, 0.0); W]);
    for (index, wheel) in mass.wheels.iter().enumerate() {
        axes[index] = constant(simd, scaled(wheel.axial, wheel.axis));
        axials[index] = Lanes::broadcast(simd, wheel.axial);
    }
    let wheels = count_of_wheels::<W>(mass.wheels.len());
    let written = [Series::AngularMomentumError, Series::AngularMomentumSquare, Series::AngularMomentumTerms];
    let [error, square, all_terms] = out.write(written, vectors);
    let mut sink = Sink::new(simd, [error, square]);
    for at in 0..vectors {
        let mut h_s = product(inertia, three(simd, omega, at));
        let mut terms = norm(h_s);
        if wheels > 0 {
            let rate = Lanes::load(simd, &rates[0][at]);
            let mut of_wheels = scaled(rate, axes[0]);
            terms = rate.abs().mul_add(axials[0], terms);
            for wheel in 1..wheels {
                let rate = Lanes::load(simd, &rates[wheel][at]);
                of_wheels = sum(of_wheels, scaled(rate, axes[wheel]));
                terms = rate.abs().mul_add(axials[wheel], terms);
            }
            h_s = sum(h_s, of_wheels);
        }
        let momentum = product(attitude.c_es(simd, at), h_s);
        let (balance, terms) = balanced(simd, at, momentum, impulse, terms);
        sink.put(simd, at, momentum, balance);
        terms.store(&mut all_terms[at]);
    }
}

#[inline(always)]
pub fn debris_momenta<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let (table, vectors) = (run.table, run.vectors());
    let Some(body) = run.debris else { return };
    let velocity: [_; 3] = needed(table, StateField::DebrisVelocity, vectors);
    let omega: [_; 3] = needed(table, StateField::DebrisRate, vectors);
    let attitude: [_; 4] = needed(table, StateField::DebrisAttitude, vectors);
    let inertia = constant_matrix(simd, body.inertia);
    let total = Lanes::broadcast(simd, body.mass);
    let [a, b, c, d] = out.write(
        [
            Series::DebrisLinearError,
            Series::DebrisLinearSquare,
            Series::DebrisAngularError,
            Series::DebrisAngularSquare,
        ],
        vectors,
    );
    let (mut linear_sink, mut angular_sink) = (Sink::new(simd, [a, b]), Sink::new(simd, [c, d]));
    for at in 0..vectors {
        let linear = scaled(total, three(simd, velocity, at));
        linear_sink.put(simd, at, linear, linear);
        let c_ed = dcm_from_quaternion(four(simd, attitude, at));
        let angular = product(c_ed, product(inertia, three(simd, omega, at)));
        angular_sink.put(simd, at, angular, angular);
    }
}
