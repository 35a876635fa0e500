//! States to series: energies and momenta at every observation point, eight points at a time.
//!
//! With d_b = r_b - c in F_s and u = C_es^T v_c, body b moves with v_b = u + omega x d_b, so that (36) splits into the energy
//! about c, a quadratic form of omega with constant coefficients, and what the motion of c adds:
//! T_b = T_b^c + m_b (u . (omega x d_b) + u . u / 2). A wheel adds J_i Omega_i (omega . a_i + Omega_i / 2).
//! Over the spacecraft the mixed terms cancel: T = T^c + m v_c . v_c / 2, which needs no attitude.
//!
//! Not here: what becomes of the series (`reduce`, `spectrum`).

use fearless_simd::Simd;

use super::request::Wanted;
use super::series::Series;
use crate::dynamics::table::{Block, StateTable};
use crate::math::lanes::WIDTH;
use crate::math::vector::{
    cross, dcm_from_quaternion, difference, dot, norm, product, scaled, sum, transposed_product,
};
use crate::math::{Lanes, Real};
use crate::scene::mass::{Body, MassProperties, Wheel};

/// The values of every series, one after another, each with one vector of padding more than a column of the state table (so
/// that the neighbour of every point can be read).
#[derive(Clone, Debug)]
pub(super) struct SeriesTable {
    pitch: usize,
    values: Vec<f64>,
}

impl SeriesTable {
    /// Series of `points` points; all zero.
    pub(super) fn new(points: usize) -> Self {
        let pitch = points.next_multiple_of(WIDTH) + WIDTH;
        SeriesTable { pitch, values: vec![0.0; Series::COUNT * pitch] }
    }

    /// The values of a series, with padding.
    #[inline(always)]
    pub(super) fn column(&self, series: Series) -> &[f64] {
        &self.values[series as usize * self.pitch..][..self.pitch]
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, series: Series, at: usize, values: Lanes<S>) {
        values.store(&mut self.values[series as usize * self.pitch + at..]);
    }

    /// Repeats point `points - 1` in all that follow it.
    #[inline(always)]
    fn pad(&mut self, wanted: Wanted, points: usize) {
        for (series, column) in self.values.chunks_exact_mut(self.pitch).enumerate() {
            if wanted.has_index(series) {
                let last = column[points - 1];
                column[points..].fill(last);
            }
        }
    }
}

/// The quadratic form of a symmetric matrix: coefficients of xx, yy, zz, xy, xz, yz.
type Form = [f64; 6];

/// 2 T^c = omega . K omega of a body of mass `mass` at `offset` from c with inertia `inertia`, halved, as a form.
fn form(mass: f64, offset: [f64; 3], inertia: [[f64; 3]; 3]) -> Form {
    let [x, y, z] = offset;
    let moment = [mass * (y * y + z * z), mass * (x * x + z * z), mass * (x * x + y * y)];
    let both = |i: usize, j: usize| 0.5 * (inertia[i][j] + inertia[j][i]);
    [
        0.5 * (inertia[0][0] + moment[0]),
        0.5 * (inertia[1][1] + moment[1]),
        0.5 * (inertia[2][2] + moment[2]),
        both(0, 1) - mass * x * y,
        both(0, 2) - mass * x * z,
        both(1, 2) - mass * y * z,
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
fn wheel_inertia(axis: [f64; 3], axial: f64, transverse: f64) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (axial - transverse) * axis[i] * axis[j] + if i == j { transverse } else { 0.0 })
    })
}

/// Three components of a block at eight points.
#[inline(always)]
fn three<S: Simd>(simd: S, columns: &[&[f64]], at: usize) -> [Lanes<S>; 3] {
    [
        Lanes::from_slice(simd, &columns[0][at..]),
        Lanes::from_slice(simd, &columns[1][at..]),
        Lanes::from_slice(simd, &columns[2][at..]),
    ]
}

#[inline(always)]
fn four<S: Simd>(simd: S, columns: &[&[f64]], at: usize) -> [Lanes<S>; 4] {
    let [x, y, z] = three(simd, &columns[1..], at);
    [Lanes::from_slice(simd, &columns[0][at..]), x, y, z]
}

/// A constant vector in all lanes.
#[inline(always)]
fn constant<S: Simd>(simd: S, a: [f64; 3]) -> [Lanes<S>; 3] {
    [Lanes::broadcast(simd, a[0]), Lanes::broadcast(simd, a[1]), Lanes::broadcast(simd, a[2])]
}

#[inline(always)]
fn constant_form<S: Simd>(simd: S, a: Form) -> [Lanes<S>; 6] {
    let [x, y, z] = constant(simd, [a[0], a[1], a[2]]);
    let [u, v, w] = constant(simd, [a[3], a[4], a[5]]);
    [x, y, z, u, v, w]
}

/// A constant matrix in all lanes, by rows.
#[inline(always)]
fn constant_matrix<S: Simd>(simd: S, m: [[f64; 3]; 3]) -> [[Lanes<S>; 3]; 3] {
    [constant(simd, m[0]), constant(simd, m[1]), constant(simd, m[2])]
}

/// Lane 0 in all lanes: the value at point 0, if the vector is the first of its column.
#[inline(always)]
fn first<S: Simd>(simd: S, a: Lanes<S>) -> Lanes<S> {
    Lanes::broadcast(simd, a.lane(0))
}

#[inline(always)]
fn first_vector<S: Simd>(simd: S, a: [Lanes<S>; 3]) -> [Lanes<S>; 3] {
    [first(simd, a[0]), first(simd, a[1]), first(simd, a[2])]
}

/// The columns of a block, or nothing where the table does not hold it.
#[inline(always)]
fn columns<const N: usize>(table: &StateTable, block: Block) -> Option<[&[f64]; N]> {
    table.has(block).then(|| {
        let mut columns: [&[f64]; N] = [&[]; N];
        for (component, column) in columns.iter_mut().enumerate() {
            *column = table.column(block, component);
        }
        columns
    })
}

/// The columns of a block that the request has promised to be there.
#[inline(always)]
fn needed<const N: usize>(table: &StateTable, block: Block) -> [&[f64]; N] {
    columns(table, block).expect("the observer checks that the table holds what its request needs")
}

/// Writes the wanted series of a run of `points` >= 1 filled points; `debris` where the request counts it in.
#[inline(always)]
pub(super) fn measure<S: Simd>(
    simd: S,
    wanted: Wanted,
    debris: Option<&Body>,
    mass: &MassProperties,
    table: &StateTable,
    points: usize,
    out: &mut SeriesTable,
) {
    let attitude = Attitude::of(table);
    let com = wanted.has(Series::ComFuselage) || wanted.has(Series::ComTotal);
    let inertial = wanted.has(Series::EnergyFuselage);
    let total = wanted.has(Series::EnergyTotal);
    if com || inertial || total {
        energies(simd, wanted, debris, mass, table, attitude, points, out);
    }
    if wanted.has(Series::LinearMomentumError) {
        linear_momentum(simd, mass, table, points, out);
    }
    if wanted.has(Series::AngularMomentumError) || wanted.has(Series::AttitudeError) {
        angular_momentum(simd, wanted, mass, table, attitude, points, out);
    }
    if let Some(body) = debris.filter(|_| wanted.has(Series::DebrisLinearError)) {
        debris_momenta(simd, body, table, points, out);
    }
    if wanted.has(Series::ResidualKinematic) {
        let residuals: [_; 3] = needed(table, Block::Residuals);
        for at in (0..points).step_by(WIDTH) {
            let [kinematic, collocation, attitude] = three(simd, &residuals, at);
            out.store(Series::ResidualKinematic, at, kinematic);
            out.store(Series::ResidualCollocation, at, collocation);
            out.store(Series::ResidualAttitude, at, attitude);
        }
    }
    out.pad(wanted, points);
}

/// Where C_es comes from: the DCM where the kernel integrates it, else the quaternion in its homogeneous form, so that an
/// error of the norm shows in whatever is turned by it.
#[derive(Clone, Copy)]
enum Attitude<'a> {
    Dcm([&'a [f64]; 9]),
    Quaternion([&'a [f64]; 4]),
    None,
}

impl<'a> Attitude<'a> {
    #[inline(always)]
    fn of(table: &'a StateTable) -> Self {
        if let Some(dcm) = columns(table, Block::Dcm) {
            Attitude::Dcm(dcm)
        } else if let Some(quaternion) = columns(table, Block::Attitude) {
            Attitude::Quaternion(quaternion)
        } else {
            Attitude::None
        }
    }

    /// C_es by rows.
    #[inline(always)]
    fn c_es<S: Simd>(self, simd: S, at: usize) -> [[Lanes<S>; 3]; 3] {
        match self {
            Attitude::Dcm(columns) => {
                let x = three(simd, &columns[0..], at);
                let y = three(simd, &columns[3..], at);
                let z = three(simd, &columns[6..], at);
                [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]]
            }
            Attitude::Quaternion(columns) => dcm_from_quaternion(four(simd, &columns, at)),
            Attitude::None => constant_matrix(simd, [[f64::NAN; 3]; 3]),
        }
    }

    /// Largest entry of |C_es^T C_es - 1|; of a quaternion | |q|^4 - 1 |, since its C_es is |q|^2 times a rotation.
    #[inline(always)]
    fn error<S: Simd>(self, simd: S, at: usize) -> Lanes<S> {
        let one = Lanes::broadcast(simd, 1.0);
        match self {
            Attitude::Dcm(columns) => {
                let axes =
                    [three(simd, &columns[0..], at), three(simd, &columns[3..], at), three(simd, &columns[6..], at)];
                let off = |i: usize, j: usize| dot(axes[i], axes[j]).abs();
                let on = |i: usize| (dot(axes[i], axes[i]) - one).abs();
                on(0).larger(on(1)).larger(on(2).larger(off(0, 1))).larger(off(0, 2).larger(off(1, 2)))
            }
            Attitude::Quaternion(columns) => {
                let [w, x, y, z] = four(simd, &columns, at);
                let excess = w.mul_add(w, x.mul_add(x, y.mul_add(y, z.mul_add(z, -one))));
                (excess * (excess + Lanes::broadcast(simd, 2.0))).abs()
            }
            Attitude::None => Lanes::broadcast(simd, f64::NAN),
        }
    }
}

#[inline(always)]
fn energies<S: Simd>(
    simd: S,
    wanted: Wanted,
    debris: Option<&Body>,
    mass: &MassProperties,
    table: &StateTable,
    attitude: Attitude<'_>,
    points: usize,
    out: &mut SeriesTable,
) {
    let all = |value: f64| Lanes::broadcast(simd, value);
    let [w1, w2] = mass.wheels;
    let offset = |center: [f64; 3]| difference(center, mass.center);
    let offsets = [offset(mass.fuselage.center), offset(w1.center), offset(w2.center)];
    let wheel = |w: &Wheel, offset| form(w.mass, offset, wheel_inertia(w.axis, w.axial, w.transverse));
    let forms = [
        constant_form(simd, form(mass.fuselage.mass, offsets[0], mass.fuselage.inertia)),
        constant_form(simd, wheel(&w1, offsets[1])),
        constant_form(simd, wheel(&w2, offsets[2])),
    ];
    let axes = [constant(simd, w1.axis), constant(simd, w2.axis)];
    let axial = [all(w1.axial), all(w2.axial)];
    let half = all(0.5);
    // d_b m_b, since u . (omega x d) m = d m . (u x omega)
    let weighted = |mass, offset| constant(simd, scaled(mass, offset));
    let arms = [weighted(mass.fuselage.mass, offsets[0]), weighted(w1.mass, offsets[1]), weighted(w2.mass, offsets[2])];
    let halves = [all(0.5 * mass.fuselage.mass), all(0.5 * w1.mass), all(0.5 * w2.mass)];
    let half_total = all(0.5 * mass.total);

    let omega_columns: [_; 3] = needed(table, Block::Rate);
    let rate_columns: [_; 2] = needed(table, Block::WheelRates);
    let total = wanted.has(Series::EnergyTotal);
    let inertial = wanted.has(Series::EnergyFuselage);
    let velocity = if total || inertial { needed(table, Block::ComVelocity) } else { [&[][..]; 3] };
    let work: Option<[_; 2]> = if wanted.has(Series::EnergyError) { columns(table, Block::Work) } else { None };
    // the debris enters as a body of its own, with c at its centre
    let debris = debris.filter(|_| total || wanted.has(Series::EnergyDebris)).map(|body| {
        let velocity: [_; 3] = needed(table, Block::DebrisVelocity);
        let omega: [_; 3] = needed(table, Block::DebrisRate);
        (velocity, omega, constant_form(simd, form(0.0, [0.0; 3], body.inertia)), all(0.5 * body.mass))
    });

    let mut com_first = all(0.0);
    let mut balance_first = all(0.0);
    for at in (0..points).step_by(WIDTH) {
        let omega = three(simd, &omega_columns, at);
        let p = products(omega);
        let spin = |i: usize| {
            let rate = Lanes::from_slice(simd, &rate_columns[i][at..]);
            axial[i] * rate * half.mul_add(rate, dot(axes[i], omega))
        };
        let about = [quadratic(forms[0], p), quadratic(forms[1], p) + spin(0), quadratic(forms[2], p) + spin(1)];
        let com = about[0] + (about[1] + about[2]);
        if at == 0 {
            com_first = first(simd, com);
        }
        out.store(Series::ComFuselage, at, about[0]);
        out.store(Series::ComWheel1, at, about[1]);
        out.store(Series::ComWheel2, at, about[2]);
        out.store(Series::ComTotal, at, com);
        out.store(Series::ComError, at, com - com_first);
        if !(total || inertial) {
            continue;
        }

        let v_c = three(simd, &velocity, at);
        if inertial {
            let u = transposed_product(attitude.c_es(simd, at), v_c);
            let square = dot(u, u);
            let turned = cross(u, omega);
            let moving = |b: usize| halves[b].mul_add(square, dot(arms[b], turned) + about[b]);
            out.store(Series::EnergyFuselage, at, moving(0));
            out.store(Series::EnergyWheel1, at, moving(1));
            out.store(Series::EnergyWheel2, at, moving(2));
        }
        let mut energy = half_total.mul_add(dot(v_c, v_c), com);
        if let Some((velocity, omega, form, half_mass)) = &debris {
            let v = three(simd, velocity, at);
            let omega = three(simd, omega, at);
            let debris = half_mass.mul_add(dot(v, v), quadratic(*form, products(omega)));
            out.store(Series::EnergyDebris, at, debris);
            energy += debris;
        }
        let mut balance = energy;
        if let Some([thrusters, motors]) = &work {
            balance -= Lanes::from_slice(simd, &thrusters[at..]) + Lanes::from_slice(simd, &motors[at..]);
        }
        if at == 0 {
            balance_first = first(simd, balance);
        }
        out.store(Series::EnergyTotal, at, energy);
        out.store(Series::EnergyError, at, balance - balance_first);
    }
}

/// Stores |balance - its first value| and |momentum|^2.
#[inline(always)]
fn store_momentum<S: Simd>(
    out: &mut SeriesTable,
    (error, square): (Series, Series),
    at: usize,
    momentum: [Lanes<S>; 3],
    balance: [Lanes<S>; 3],
    start: &mut [Lanes<S>; 3],
) {
    if at == 0 {
        *start = first_vector(balance[0].simd(), balance);
    }
    out.store(error, at, norm(difference(balance, *start)));
    out.store(square, at, dot(momentum, momentum));
}

#[inline(always)]
fn linear_momentum<S: Simd>(simd: S, mass: &MassProperties, table: &StateTable, points: usize, out: &mut SeriesTable) {
    let velocity: [_; 3] = needed(table, Block::ComVelocity);
    let impulse: Option<[_; 3]> = columns(table, Block::Impulse);
    let total = Lanes::broadcast(simd, mass.total);
    let mut start = constant(simd, [0.0; 3]);
    for at in (0..points).step_by(WIDTH) {
        let momentum = scaled(total, three(simd, &velocity, at));
        let balance = match &impulse {
            Some(impulse) => difference(momentum, three(simd, impulse, at)),
            None => momentum,
        };
        let series = (Series::LinearMomentumError, Series::LinearMomentumSquare);
        store_momentum(out, series, at, momentum, balance, &mut start);
    }
}

/// L = C_es (J omega + sum J_i Omega_i a_i), J with wheels locked; and the error of C_es, which is at hand here.
#[inline(always)]
fn angular_momentum<S: Simd>(
    simd: S,
    wanted: Wanted,
    mass: &MassProperties,
    table: &StateTable,
    attitude: Attitude<'_>,
    points: usize,
    out: &mut SeriesTable,
) {
    if wanted.has(Series::AttitudeError) {
        for at in (0..points).step_by(WIDTH) {
            out.store(Series::AttitudeError, at, attitude.error(simd, at));
        }
    }
    if !wanted.has(Series::AngularMomentumError) {
        return;
    }
    let omega: [_; 3] = needed(table, Block::Rate);
    let rates: [_; 2] = needed(table, Block::WheelRates);
    let impulse: Option<[_; 3]> = columns(table, Block::AngularImpulse);
    let inertia = constant_matrix(simd, mass.inertia);
    let axes = [0, 1].map(|i| constant(simd, scaled(mass.wheels[i].axial, mass.wheels[i].axis)));
    let mut start = constant(simd, [0.0; 3]);
    for at in (0..points).step_by(WIDTH) {
        let wheels = sum(
            scaled(Lanes::from_slice(simd, &rates[0][at..]), axes[0]),
            scaled(Lanes::from_slice(simd, &rates[1][at..]), axes[1]),
        );
        let h_s = sum(product(inertia, three(simd, &omega, at)), wheels);
        let momentum = product(attitude.c_es(simd, at), h_s);
        let balance = match &impulse {
            Some(impulse) => difference(momentum, three(simd, impulse, at)),
            None => momentum,
        };
        let series = (Series::AngularMomentumError, Series::AngularMomentumSquare);
        store_momentum(out, series, at, momentum, balance, &mut start);
    }
}

#[inline(always)]
fn debris_momenta<S: Simd>(simd: S, body: &Body, table: &StateTable, points: usize, out: &mut SeriesTable) {
    let velocity: [_; 3] = needed(table, Block::DebrisVelocity);
    let omega: [_; 3] = needed(table, Block::DebrisRate);
    let attitude: [_; 4] = needed(table, Block::DebrisAttitude);
    let inertia = constant_matrix(simd, body.inertia);
    let total = Lanes::broadcast(simd, body.mass);
    let mut start = [constant(simd, [0.0; 3]); 2];
    for at in (0..points).step_by(WIDTH) {
        let linear = scaled(total, three(simd, &velocity, at));
        let series = (Series::DebrisLinearError, Series::DebrisLinearSquare);
        store_momentum(out, series, at, linear, linear, &mut start[0]);
        let c_ed = dcm_from_quaternion(four(simd, &attitude, at));
        let angular = product(c_ed, product(inertia, three(simd, &omega, at)));
        let series = (Series::DebrisAngularError, Series::DebrisAngularSquare);
        store_momentum(out, series, at, angular, angular, &mut start[1]);
    }
}
