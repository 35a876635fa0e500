use fearless_simd::Simd;

use super::points::{Column, MeasuredRun, SeriesTable, columns, constant, constant_matrix, first_vector, four, three};
use super::table::Series;
use crate::math::prelude::*;
use crate::math::{Lanes, Real};
use crate::run::{StateField, StateTable};

/// Source of C_es: the DCM if integrated, else the quaternion in homogeneous form, so that an error of its norm shows.
#[derive(Clone, Copy)]
pub enum Attitude<'a> {
    Dcm([Column<'a>; 9]),
    Quaternion([Column<'a>; 4]),
    None,
}

impl<'a> Attitude<'a> {
    #[inline(always)]
    pub fn of(table: &'a StateTable, vectors: usize) -> Self {
        if let Some(dcm) = columns(table, StateField::Dcm, vectors) {
            Attitude::Dcm(dcm)
        } else if let Some(quaternion) = columns(table, StateField::Attitude, vectors) {
            Attitude::Quaternion(quaternion)
        } else {
            Attitude::None
        }
    }

    #[inline(always)]
    pub fn c_es<S: Simd>(self, simd: S, at: usize) -> [[Lanes<S>; 3]; 3] {
        match self {
            Attitude::Dcm(columns) => {
                let [x, y, z] = axes(simd, columns, at);
                [[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]]
            }
            Attitude::Quaternion(columns) => dcm_from_quaternion(four(simd, columns, at)),
            Attitude::None => constant_matrix(simd, [[f64::NAN; 3]; 3]),
        }
    }

    /// Largest entry of |C_es^T C_es - 1|; | |q|^4 - 1 | for a quaternion, whose C_es is |q|^2 times a rotation.
    #[inline(always)]
    fn orthonormality<S: Simd>(self, simd: S, at: usize) -> Lanes<S> {
        let one = Lanes::broadcast(simd, 1.0);
        match self {
            Attitude::Dcm(columns) => {
                let [x, y, z] = axes(simd, columns, at);
                let on = unit_error(x, one).larger(unit_error(y, one)).larger(unit_error(z, one));
                on.larger(dot(x, y).abs()).larger(dot(x, z).abs().larger(dot(y, z).abs()))
            }
            Attitude::Quaternion(columns) => {
                let [w, x, y, z] = four(simd, columns, at);
                let excess = w.mul_add(w, x.mul_add(x, y.mul_add(y, z.mul_add(z, -one))));
                (excess * (excess + Lanes::broadcast(simd, 2.0))).abs()
            }
            Attitude::None => Lanes::broadcast(simd, f64::NAN),
        }
    }
}

/// Columns of a DCM, stored one after another.
#[inline(always)]
fn axes<S: Simd>(simd: S, [a, b, c, d, e, f, g, h, i]: [Column<'_>; 9], at: usize) -> [[Lanes<S>; 3]; 3] {
    [three(simd, [a, b, c], at), three(simd, [d, e, f], at), three(simd, [g, h, i], at)]
}

#[inline(always)]
fn unit_error<R: Real>(a: [R; 3], one: R) -> R {
    (dot(a, a) - one).abs()
}

#[inline(always)]
pub fn attitude_series<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let vectors = run.vectors();
    let attitude = Attitude::of(run.table, vectors);
    if run.observed.has(Series::Orthonormality) {
        let [orthonormality] = out.write([Series::Orthonormality], vectors);
        for (at, value) in orthonormality.iter_mut().enumerate() {
            attitude.orthonormality(simd, at).store(value);
        }
    }
    if run.observed.has(Series::SpinAxisAngle) {
        spin_axis_angle(simd, attitude, out.write([Series::SpinAxisAngle], vectors));
    }
}

/// tan^2 of half the angle between s3 and its initial direction, |a - b|^2/|a + b|^2 of unit vectors: accurate near
/// zero and half a turn (W. Kahan, *How Futile are Mindless Assessments of Roundoff*, 2006, section 12).
#[inline(always)]
fn spin_axis_angle<S: Simd>(simd: S, attitude: Attitude<'_>, [out]: [&mut [[f64; WIDTH]]; 1]) {
    let mut start = constant(simd, [0.0; 3]);
    for (at, value) in out.iter_mut().enumerate() {
        let [[.., x], [.., y], [.., z]] = attitude.c_es(simd, at);
        let s3 = [x, y, z];
        if at == 0 {
            start = first_vector(simd, s3);
        }
        let (apart, together) = (difference(s3, start), sum(s3, start));
        (dot(apart, apart) / dot(together, together)).store(value);
    }
}
