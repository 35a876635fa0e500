//! Kinetic energies, of each body and of all, in F_e and about the spacecraft's centre of mass c.
//!
//! With d_b = r_b - c in F_s and u = C_es^T v_c, body b moves with v_b = u + omega x d_b, so that (36) splits into the energy
//! about c, a quadratic form of omega with constant coefficients, and what the motion of c adds:
//! T_b = T_b^c + m_b (u . (omega x d_b) + u . u / 2). A wheel adds J_i Omega_i (omega . a_i + Omega_i / 2).
//! Over the spacecraft the mixed terms cancel: T = T^c + m v_c . v_c / 2, which needs no attitude.

use fearless_simd::Simd;

use super::attitude::Attitude;
use super::points::{Column, MeasuredRun, SeriesTable, columns, constant, first, needed, three};
use super::table::Series;
use crate::math::vector::{cross, difference, dot, scaled, transposed_product};
use crate::math::{Lanes, Real};
use crate::run::StateField;
use crate::scene::mass::{MassProperties, Wheel};

/// The quadratic form of a symmetric matrix: coefficients of xx, yy, zz, xy, xz, yz.
type Form = [f64; 6];

/// 2 T^c = omega . K omega of a body of mass `mass` at `offset` from c with inertia `inertia`, halved, as a form.
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

/// Inertia of an axisymmetric wheel about its centre in F_s: J_t (1 - a a^T) + J_a a a^T.
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

/// The constants of the energies of a run, in all lanes.
struct Constants<S: Simd> {
    /// Energy of S, W1, W2 about c, the wheels locked, as forms of omega.
    forms: [[Lanes<S>; 6]; 3],
    /// m_b d_b, since m_b u . (omega x d_b) = m_b d_b . (u x omega).
    arms: [[Lanes<S>; 3]; 3],
    /// m_b / 2.
    halves: [Lanes<S>; 3],
    /// a_i.
    axes: [[Lanes<S>; 3]; 2],
    /// J_i.
    axial: [Lanes<S>; 2],
    /// m / 2.
    half_total: Lanes<S>,
    half: Lanes<S>,
}

impl<S: Simd> Constants<S> {
    // Closures that compute with lanes are avoided here and below: one that is not inlined loses the instruction set.
    #[inline(always)]
    fn of(simd: S, mass: &MassProperties) -> Self {
        let s = &mass.fuselage;
        let (w1, w2) = (&mass.wheels[0], &mass.wheels[1]);
        let d =
            [difference(s.center, mass.center), difference(w1.center, mass.center), difference(w2.center, mass.center)];
        Constants {
            forms: [
                constant_form(simd, form(s.mass, d[0], s.inertia)),
                constant_form(simd, form(w1.mass, d[1], wheel_inertia(w1))),
                constant_form(simd, form(w2.mass, d[2], wheel_inertia(w2))),
            ],
            arms: [
                constant(simd, scaled(s.mass, d[0])),
                constant(simd, scaled(w1.mass, d[1])),
                constant(simd, scaled(w2.mass, d[2])),
            ],
            halves: constant(simd, [0.5 * s.mass, 0.5 * w1.mass, 0.5 * w2.mass]),
            axes: [constant(simd, w1.axis), constant(simd, w2.axis)],
            axial: [Lanes::broadcast(simd, w1.axial), Lanes::broadcast(simd, w2.axial)],
            half_total: Lanes::broadcast(simd, 0.5 * mass.total),
            half: Lanes::broadcast(simd, 0.5),
        }
    }

    /// What the rate of wheel `i` adds to its energy: J_i Omega_i (omega . a_i + Omega_i / 2).
    #[inline(always)]
    fn spin(&self, i: usize, omega: [Lanes<S>; 3], rate: Lanes<S>) -> Lanes<S> {
        self.axial[i] * rate * self.half.mul_add(rate, dot(self.axes[i], omega))
    }

    /// Energy of body `b` in F_e from the one about c: `square` = u . u, `turned` = u x omega.
    #[inline(always)]
    fn moving(&self, b: usize, about: Lanes<S>, square: Lanes<S>, turned: [Lanes<S>; 3]) -> Lanes<S> {
        self.halves[b].mul_add(square, dot(self.arms[b], turned) + about)
    }
}

/// Eight values of a column.
#[inline(always)]
fn load<S: Simd>(simd: S, column: Column<'_>, at: usize) -> Lanes<S> {
    Lanes::load(simd, &column[at])
}

#[inline(always)]
pub(super) fn energies<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let MeasuredRun { observed, mass, debris, table, .. } = *run;
    let vectors = run.vectors();
    let attitude = Attitude::of(table, vectors);
    let constants = Constants::of(simd, mass);
    let omega_columns: [_; 3] = needed(table, StateField::Rate, vectors);
    let rate_columns: [_; 2] = needed(table, StateField::WheelRates, vectors);
    let total = observed.has(Series::EnergyTotal);
    let inertial = [Series::EnergyFuselage, Series::EnergyWheel1, Series::EnergyWheel2, Series::EnergyDebris];
    let inertial = inertial.into_iter().any(|series| observed.has(series));
    let velocity = if total || inertial { needed(table, StateField::ComVelocity, vectors) } else { [&[][..]; 3] };
    let work: Option<[_; 2]> =
        if observed.has(Series::EnergyError) { columns(table, StateField::Work, vectors) } else { None };
    // a kernel with redundant states conserves the energy of these states (36); where the wheels have drifted off their
    // constraints, the energy computed from the rates alone differs
    let redundant: Option<[_; 4]> = columns(table, StateField::KineticEnergies, vectors);
    // the debris is a body whose centre of mass is c
    let debris = match debris {
        Some(body) if total || observed.has(Series::EnergyDebris) => {
            let velocity: [_; 3] = needed(table, StateField::DebrisVelocity, vectors);
            let omega: [_; 3] = needed(table, StateField::DebrisRate, vectors);
            let form = constant_form(simd, form(0.0, [0.0; 3], body.inertia));
            Some((velocity, omega, form, Lanes::broadcast(simd, 0.5 * body.mass)))
        }
        _ => None,
    };
    use Series::*;
    let [
        com_fuselage,
        com_wheel1,
        com_wheel2,
        com_total,
        com_error,
        fuselage,
        wheel1,
        wheel2,
        debris_energy,
        total_energy,
        energy_error,
    ] = out.write(
        [
            ComFuselage,
            ComWheel1,
            ComWheel2,
            ComTotal,
            ComError,
            EnergyFuselage,
            EnergyWheel1,
            EnergyWheel2,
            EnergyDebris,
            EnergyTotal,
            EnergyError,
        ],
        vectors,
    );
    let mut com_first = Lanes::broadcast(simd, 0.0);
    let mut balance_first = com_first;
    for at in 0..vectors {
        let omega = three(simd, omega_columns, at);
        let p = products(omega);
        let rates = [Lanes::load(simd, &rate_columns[0][at]), Lanes::load(simd, &rate_columns[1][at])];
        let about = [
            quadratic(constants.forms[0], p),
            quadratic(constants.forms[1], p) + constants.spin(0, omega, rates[0]),
            quadratic(constants.forms[2], p) + constants.spin(1, omega, rates[1]),
        ];
        let com = about[0] + (about[1] + about[2]);
        if at == 0 {
            com_first = first(simd, com);
        }
        about[0].store(&mut com_fuselage[at]);
        about[1].store(&mut com_wheel1[at]);
        about[2].store(&mut com_wheel2[at]);
        com.store(&mut com_total[at]);
        (com - com_first).store(&mut com_error[at]);
        if !(total || inertial) {
            continue;
        }

        let v_c = three(simd, velocity, at);
        if inertial && let Some([s, w1, w2, _]) = redundant {
            load(simd, s, at).store(&mut fuselage[at]);
            load(simd, w1, at).store(&mut wheel1[at]);
            load(simd, w2, at).store(&mut wheel2[at]);
        } else if inertial {
            let u = transposed_product(attitude.c_es(simd, at), v_c);
            let square = dot(u, u);
            let turned = cross(u, omega);
            constants.moving(0, about[0], square, turned).store(&mut fuselage[at]);
            constants.moving(1, about[1], square, turned).store(&mut wheel1[at]);
            constants.moving(2, about[2], square, turned).store(&mut wheel2[at]);
        }
        let mut energy = match redundant {
            Some([s, w1, w2, _]) => load(simd, s, at) + (load(simd, w1, at) + load(simd, w2, at)),
            None => constants.half_total.mul_add(dot(v_c, v_c), com),
        };
        if let Some((velocity, omega, form, half_mass)) = debris {
            let v = three(simd, velocity, at);
            let omega = three(simd, omega, at);
            let debris = half_mass.mul_add(dot(v, v), quadratic(form, products(omega)));
            debris.store(&mut debris_energy[at]);
            energy += debris;
        }
        let mut balance = energy;
        if let Some([thrusters, motors]) = work {
            balance -= Lanes::load(simd, &thrusters[at]) + Lanes::load(simd, &motors[at]);
        }
        if at == 0 {
            balance_first = first(simd, balance);
        }
        energy.store(&mut total_energy[at]);
        (balance - balance_first).store(&mut energy_error[at]);
    }
}
