//! Kinetic energies of each body and in total, in F_e and about the spacecraft's centre of mass c.
//!
//! With d_b = r_b - c in F_s and u = C_es^T v_c, body b moves with v_b = u + omega x d_b, and (36) splits into T_b =
//! T_b^c + m_b (u . (omega x d_b) + u . u / 2) with T_b^c a quadratic form of omega. A wheel adds J_i Omega_i (omega .
//! a_i + Omega_i / 2). Over the spacecraft the mixed terms cancel: T = T^c + m v_c . v_c / 2.

use fearless_simd::Simd;

use super::attitude::Attitude;
use super::points::{
    Column, MeasuredRun, SeriesTable, columns, constant, count_of_wheels, each, first, needed, of_wheels, only, three,
};
use super::table::Series;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::{StateField, StateTable};
use crate::scene::MAX_WHEELS;
use crate::scene::mass::{MassProperties, Wheel};

/// Coefficients of xx, yy, zz, xy, xz, yz.
type Form = [f64; 6];

/// T^c = omega . K omega / 2 of a body with its centre at `offset` from c.
#[inline(always)]
fn form(mass: f64, offset: [f64; 3], inertia: [[f64; 3]; 3]) -> Form {
    let [x, y, z] = offset;
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = inertia;
    [
        0.5 * (xx + mass * (y * y + z * z)),
        0.5 * (yy + mass * (x * x + z * z)),
        0.5 * (zz + mass * (x * x + y * y)),
        0.5 * (xy + yx) - mass * x * y,
        0.5 * (xz + zx) - mass * x * z,
        0.5 * (yz + zy) - mass * y * z,
    ]
}

#[inline(always)]
fn products<R: Real>([x, y, z]: [R; 3]) -> [R; 6] {
    [x * x, y * y, z * z, x * y, x * z, y * z]
}

#[inline(always)]
fn quadratic<R: Real>(form: [R; 6], p: [R; 6]) -> R {
    let squares = form[0].mul_add(p[0], form[1].mul_add(p[1], form[2] * p[2]));
    let mixed = form[3].mul_add(p[3], form[4].mul_add(p[4], form[5] * p[5]));
    squares + mixed
}

/// J_t (1 - a a^T) + J_a a a^T.
#[inline(always)]
fn wheel_inertia(wheel: &Wheel) -> [[f64; 3]; 3] {
    let [x, y, z] = wheel.axis;
    let (t, d) = (wheel.transverse, wheel.axial - wheel.transverse);
    [
        [t + d * x * x, d * x * y, d * x * z],
        [d * x * y, t + d * y * y, d * y * z],
        [d * x * z, d * y * z, t + d * z * z],
    ]
}

#[inline(always)]
fn constant_form<S: Simd>(simd: S, a: Form) -> [Lanes<S>; 6] {
    let [x, y, z] = constant(simd, [a[0], a[1], a[2]]);
    let [u, v, w] = constant(simd, [a[3], a[4], a[5]]);
    [x, y, z, u, v, w]
}

#[derive(Clone, Copy)]
struct BodyConstants<S: Simd> {
    /// Energy about c, with locked wheels, as a form of omega.
    form: [Lanes<S>; 6],
    /// m_b d_b, since m_b u . (omega x d_b) = m_b d_b . (u x omega).
    arm: [Lanes<S>; 3],
    /// m_b / 2.
    half_mass: Lanes<S>,
}

impl<S: Simd> BodyConstants<S> {
    // no closures on lanes here and below: if not inlined, they lose the instruction set
    #[inline(always)]
    fn of(simd: S, mass: f64, offset: [f64; 3], inertia: [[f64; 3]; 3]) -> Self {
        BodyConstants {
            form: constant_form(simd, form(mass, offset, inertia)),
            arm: constant(simd, scaled(mass, offset)),
            half_mass: Lanes::broadcast(simd, 0.5 * mass),
        }
    }

    /// Energy in F_e from the energy about c: `square` = u . u, `turned` = u x omega.
    #[inline(always)]
    fn moving(&self, about: Lanes<S>, square: Lanes<S>, turned: [Lanes<S>; 3]) -> Lanes<S> {
        self.half_mass.mul_add(square, dot(self.arm, turned) + about)
    }
}

#[derive(Clone, Copy)]
struct WheelConstants<S: Simd> {
    body: BodyConstants<S>,
    axis: [Lanes<S>; 3],
    /// J_i.
    axial: Lanes<S>,
}

struct Constants<S: Simd, const W: usize> {
    body: BodyConstants<S>,
    wheels: [WheelConstants<S>; W],
    /// m / 2.
    half_total: Lanes<S>,
    half: Lanes<S>,
}

impl<S: Simd, const W: usize> Constants<S, W> {
    #[inline(always)]
    fn of(simd: S, mass: &MassProperties) -> Self {
        let s = &mass.body;
        let body = BodyConstants::of(simd, s.mass, difference(s.center, mass.center), s.inertia);
        let zero = Lanes::broadcast(simd, 0.0);
        let mut wheels = [WheelConstants { body, axis: [zero; 3], axial: zero }; W];
        for (constants, wheel) in wheels.iter_mut().zip(&mass.wheels) {
            let offset = difference(wheel.center, mass.center);
            constants.body = BodyConstants::of(simd, wheel.mass, offset, wheel_inertia(wheel));
            constants.axis = constant(simd, wheel.axis);
            constants.axial = Lanes::broadcast(simd, wheel.axial);
        }
        Constants {
            body,
            wheels,
            half_total: Lanes::broadcast(simd, 0.5 * mass.total),
            half: Lanes::broadcast(simd, 0.5),
        }
    }

    /// J_i Omega_i (omega . a_i + Omega_i / 2).
    #[inline(always)]
    fn spin(&self, wheel: &WheelConstants<S>, omega: [Lanes<S>; 3], rate: Lanes<S>) -> Lanes<S> {
        wheel.axial * rate * self.half.mul_add(rate, dot(wheel.axis, omega))
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, column: Column<'_>, at: usize) -> Lanes<S> {
    Lanes::load(simd, &column[at])
}

struct Redundant<'a, const W: usize> {
    body: Column<'a>,
    wheels: [Column<'a>; W],
}

impl<'a, const W: usize> Redundant<'a, W> {
    #[inline(always)]
    fn of(table: &'a StateTable, vectors: usize) -> Option<Self> {
        if !table.has(StateField::KineticEnergies) {
            return None;
        }
        let body = &table.column(StateField::KineticEnergies, 0).as_chunks().0[..vectors];
        Some(Redundant { body, wheels: of_wheels(table, StateField::KineticEnergies, 1, vectors) })
    }

    #[inline(always)]
    fn spacecraft<S: Simd>(&self, simd: S, wheels: usize, at: usize) -> Lanes<S> {
        let body = load(simd, self.body, at);
        if wheels == 0 {
            return body;
        }
        let mut together = load(simd, self.wheels[0], at);
        for wheel in 1..wheels {
            together += load(simd, self.wheels[wheel], at);
        }
        body + together
    }
}

/// Energies of a run and their balance, unrolled for common numbers of wheels.
#[inline(always)]
pub fn energies<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    match run.scene.mass.wheels.len() {
        0 => of_bodies::<S, 0>(simd, run, out),
        1 => of_bodies::<S, 1>(simd, run, out),
        2 => of_bodies::<S, 2>(simd, run, out),
        3 => of_bodies::<S, 3>(simd, run, out),
        4 => of_bodies::<S, 4>(simd, run, out),
        _ => of_bodies::<S, MAX_WHEELS>(simd, run, out),
    }
}

#[inline(always)]
fn of_bodies<S: Simd, const W: usize>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let MeasuredRun { observed, debris, table, .. } = *run;
    let mass = &run.scene.mass;
    let vectors = run.vectors();
    let attitude = Attitude::of(table, vectors);
    let constants = Constants::<S, W>::of(simd, mass);
    let omega_columns: [_; 3] = needed(table, StateField::Rate, vectors);
    let wheels = count_of_wheels::<W>(mass.wheels.len());
    let rate_columns: [_; W] = of_wheels(table, StateField::WheelRates, 0, vectors);
    let total = observed.has(Series::EnergyTotal);
    let inertial = [Series::EnergyBody, Series::EnergyWheel, Series::EnergyDebris];
    let inertial = inertial.into_iter().any(|series| observed.has(series));
    let velocity = if total || inertial { needed(table, StateField::ComVelocity, vectors) } else { [&[][..]; 3] };
    let work: Option<[_; 2]> =
        if observed.has(Series::EnergyError) { columns(table, StateField::Work, vectors) } else { None };
    // redundant states conserve their own energy (36), which departs from that of the rates with the constraints
    let redundant = Redundant::<W>::of(table, vectors);
    // the debris has its centre of mass at c
    let debris = match debris {
        Some(body) if total || observed.has(Series::EnergyDebris) => {
            let velocity: [_; 3] = needed(table, StateField::DebrisVelocity, vectors);
            let omega: [_; 3] = needed(table, StateField::DebrisRate, vectors);
            let form = constant_form(simd, form(0.0, [0.0; 3], body.inertia));
            Some((velocity, omega, form, Lanes::broadcast(simd, 0.5 * body.mass)))
        }
        _ => None,
    };
    macro_rules! blocks {
        (one $($one:ident: $series:ident),+; each $($each:ident: $of_wheels:ident),+) => {
            let [$($one,)+ $($each),+] =
                out.blocks(const { [$(Series::$series.block(1),)+ $(Series::$of_wheels.block(W)),+] });
            $(let $one = only($one, vectors);)+
            $(let $each: [_; W] = each($each, vectors);)+
        };
    }
    blocks! {
        one com_body: ComBody, com_wheels: ComWheels, com_total: ComTotal, com_error: ComError,
            energy_body: EnergyBody, energy_debris: EnergyDebris, energy_total: EnergyTotal,
            energy_error: EnergyError, energy_terms: EnergyTerms;
        each com_wheel: ComWheel, energy_wheel: EnergyWheel
    }
    let mut com_first = Lanes::broadcast(simd, 0.0);
    let mut balance_first = com_first;
    for at in 0..vectors {
        let omega = three(simd, omega_columns, at);
        let p = products(omega);
        let body = quadratic(constants.body.form, p);
        let mut about = [body; W];
        let mut com = body;
        if wheels > 0 {
            for wheel in 0..wheels {
                let own = &constants.wheels[wheel];
                let rate = Lanes::load(simd, &rate_columns[wheel][at]);
                about[wheel] = quadratic(own.body.form, p) + constants.spin(own, omega, rate);
                about[wheel].store(&mut com_wheel[wheel][at]);
            }
            let mut together = about[0];
            for other in &about[1..wheels] {
                together += *other;
            }
            together.store(&mut com_wheels[at]);
            com = body + together;
        }
        if at == 0 {
            com_first = first(simd, com);
        }
        body.store(&mut com_body[at]);
        com.store(&mut com_total[at]);
        (com - com_first).store(&mut com_error[at]);
        if !(total || inertial) {
            continue;
        }

        let v_c = three(simd, velocity, at);
        if inertial && let Some(redundant) = &redundant {
            load(simd, redundant.body, at).store(&mut energy_body[at]);
            for wheel in 0..wheels {
                load(simd, redundant.wheels[wheel], at).store(&mut energy_wheel[wheel][at]);
            }
        } else if inertial {
            let u = transposed_product(attitude.c_es(simd, at), v_c);
            let square = dot(u, u);
            let turned = cross(u, omega);
            constants.body.moving(body, square, turned).store(&mut energy_body[at]);
            for wheel in 0..wheels {
                let energy = constants.wheels[wheel].body.moving(about[wheel], square, turned);
                energy.store(&mut energy_wheel[wheel][at]);
            }
        }
        let mut energy = match &redundant {
            Some(redundant) => redundant.spacecraft(simd, wheels, at),
            None => constants.half_total.mul_add(dot(v_c, v_c), com),
        };
        if let Some((velocity, omega, form, half_mass)) = debris {
            let v = three(simd, velocity, at);
            let omega = three(simd, omega, at);
            let debris = half_mass.mul_add(dot(v, v), quadratic(form, products(omega)));
            debris.store(&mut energy_debris[at]);
            energy += debris;
        }
        let (mut balance, mut terms) = (energy, energy);
        if let Some([thrusters, motors]) = work {
            let (thrusters, motors) = (Lanes::load(simd, &thrusters[at]), Lanes::load(simd, &motors[at]));
            balance -= thrusters + motors;
            terms += thrusters.abs() + motors.abs();
        }
        terms.store(&mut energy_terms[at]);
        if at == 0 {
            balance_first = first(simd, balance);
        }
        energy.store(&mut energy_total[at]);
        (balance - balance_first).store(&mut energy_error[at]);
    }
}
