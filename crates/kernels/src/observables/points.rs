use core::ops::Range;

use fearless_simd::Simd;

use super::acting::Acting;
use super::nominal_attitude::NominalAttitude;
use super::request::SeriesSet;
use super::rows::SeriesSource;
use super::table::Series;
use crate::dynamics::magnetic_field::MagneticField;
use crate::math::lanes::WIDTH;
use crate::math::{Lanes, Real};
use crate::run::{StateField, StateTable};
use crate::scene::mass::Body;
use crate::scene::{MAX_WHEELS, Scene};

/// A component of a field, in vectors of eight points; columns of one length need no bounds checks in loops.
pub type Column<'a> = &'a [[f64; WIDTH]];

/// Input of the measurement of a run.
pub struct MeasuredRun<'a> {
    /// Series to compute.
    pub observed: SeriesSet,
    pub sources: &'a [SeriesSource],
    /// Debris, if observed.
    pub debris: Option<&'a Body>,
    pub nominal: Option<&'a NominalAttitude>,
    /// Axis of nutation in F_s, if not s3.
    pub nutation_axis: Option<[f64; 3]>,
    /// Magnetic field and dipoles.
    pub magnetism: Option<Magnetism<'a>>,
    pub scene: &'a Scene,
    pub times: &'a [f64],
    /// Records of the control law, by series ([`super::law_columns::LawSeries`]) and point; may be empty.
    pub of_law: &'a [f64],
    pub table: &'a StateTable,
    pub points: usize,
}

#[derive(Clone, Copy)]
pub struct Magnetism<'a> {
    pub field: MagneticField<f64>,
    /// Residual dipole in F_s, A m^2.
    pub dipole: [f64; 3],
    /// Source of the dipoles of torque rods.
    pub acting: Acting<'a>,
}

impl MeasuredRun<'_> {
    #[inline(always)]
    pub fn vectors(&self) -> usize {
        self.points.div_ceil(WIDTH)
    }
}

/// Values of every series, padded by one vector, so that every point has a neighbour.
#[derive(Clone, Debug)]
pub struct SeriesTable {
    columns: [Vec<[f64; WIDTH]>; Series::COUNT],
}

impl SeriesTable {
    /// `points` points per series, NaN at first.
    pub fn new(points: usize) -> Self {
        let vectors = points.div_ceil(WIDTH) + 1;
        SeriesTable { columns: std::array::from_fn(|_| vec![[f64::NAN; WIDTH]; vectors]) }
    }

    #[inline(always)]
    pub fn column(&self, series: Series) -> &[f64] {
        self.columns[series.index()].as_flattened()
    }

    #[inline(always)]
    pub fn write<const N: usize>(&mut self, series: [Series; N], vectors: usize) -> [&mut [[f64; WIDTH]]; N] {
        let columns = self.columns.get_disjoint_mut(series.map(Series::index));
        columns.expect("no series is written twice at once").map(|column| &mut column[..vectors])
    }

    /// Columns of disjoint blocks ([`Series::block`]), writable.
    #[inline(always)]
    pub fn blocks<const N: usize>(&mut self, blocks: [Range<usize>; N]) -> [&mut [Vec<[f64; WIDTH]>]; N] {
        self.columns.get_disjoint_mut(blocks).expect("no series is written twice at once")
    }

    /// Repeats point `points - 1` in the padding.
    #[inline(always)]
    pub fn pad(&mut self, observed: SeriesSet, points: usize) {
        for (series, column) in Series::all().zip(&mut self.columns) {
            if observed.has(series) {
                let (whole, rest) = (points / WIDTH, points % WIDTH);
                let last = column[(points - 1) / WIDTH][(points - 1) % WIDTH];
                for (lane, value) in column[whole].iter_mut().enumerate() {
                    *value = if lane < rest { *value } else { last };
                }
                column[whole + 1..].fill([last; WIDTH]);
            }
        }
    }
}

#[inline(always)]
pub fn only(block: &mut [Vec<[f64; WIDTH]>], vectors: usize) -> &mut [[f64; WIDTH]] {
    &mut block[0][..vectors]
}

#[inline(always)]
pub fn each<const W: usize>(block: &mut [Vec<[f64; WIDTH]>], vectors: usize) -> [&mut [[f64; WIDTH]]; W] {
    let columns: &mut [Vec<[f64; WIDTH]>; W] = block.try_into().expect("a block of so many series");
    columns.each_mut().map(|column| &mut column[..vectors])
}

/// Loop count over wheels: `W` if known at compile time.
#[inline(always)]
pub fn count_of_wheels<const W: usize>(wheels: usize) -> usize {
    if W < MAX_WHEELS { W } else { wheels }
}

#[inline(always)]
pub fn three<S: Simd>(simd: S, [x, y, z]: [Column<'_>; 3], at: usize) -> [Lanes<S>; 3] {
    [Lanes::load(simd, &x[at]), Lanes::load(simd, &y[at]), Lanes::load(simd, &z[at])]
}

#[inline(always)]
pub fn four<S: Simd>(simd: S, [w, x, y, z]: [Column<'_>; 4], at: usize) -> [Lanes<S>; 4] {
    let [x, y, z] = three(simd, [x, y, z], at);
    [Lanes::load(simd, &w[at]), x, y, z]
}

#[inline(always)]
pub fn constant<S: Simd>(simd: S, a: [f64; 3]) -> [Lanes<S>; 3] {
    [Lanes::broadcast(simd, a[0]), Lanes::broadcast(simd, a[1]), Lanes::broadcast(simd, a[2])]
}

#[inline(always)]
pub fn constant_matrix<S: Simd>(simd: S, m: [[f64; 3]; 3]) -> [[Lanes<S>; 3]; 3] {
    [constant(simd, m[0]), constant(simd, m[1]), constant(simd, m[2])]
}

/// Lane 0 in all lanes: the value at point 0 in the first vector of a column.
#[inline(always)]
pub fn first<S: Simd>(simd: S, a: Lanes<S>) -> Lanes<S> {
    Lanes::broadcast(simd, a.lane(0))
}

#[inline(always)]
pub fn first_vector<S: Simd>(simd: S, a: [Lanes<S>; 3]) -> [Lanes<S>; 3] {
    [first(simd, a[0]), first(simd, a[1]), first(simd, a[2])]
}

/// The first `vectors` vectors of the components of a field; `None` if the table lacks it.
#[inline(always)]
pub fn columns<const N: usize>(table: &StateTable, field: StateField, vectors: usize) -> Option<[Column<'_>; N]> {
    if !table.has(field) {
        return None;
    }
    let mut columns: [Column<'_>; N] = [&[]; N];
    for (component, column) in columns.iter_mut().enumerate() {
        *column = &table.column(field, component).as_chunks().0[..vectors];
    }
    Some(columns)
}

/// Columns of a field, one per wheel, from component `first` on; empty beyond the existing wheels.
#[inline(always)]
pub fn of_wheels<const W: usize>(
    table: &StateTable,
    field: StateField,
    first: usize,
    vectors: usize,
) -> [Column<'_>; W] {
    let mut columns: [Column<'_>; W] = [&[]; W];
    for (wheel, column) in columns.iter_mut().enumerate().take(count_of_wheels::<W>(table.wheels())) {
        *column = &table.column(field, first + wheel).as_chunks().0[..vectors];
    }
    columns
}

#[inline(always)]
pub fn needed<const N: usize>(table: &StateTable, field: StateField, vectors: usize) -> [Column<'_>; N] {
    columns(table, field, vectors).expect("the state table has the fields that the request needs")
}
