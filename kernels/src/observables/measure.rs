//! States to series: the computation of each source, where one of its series is observed.
//!
//! Not here: the computations ([`super::energies`], [`super::momenta`], [`super::attitude`], [`super::motion`]), and the reduction of series to
//! numbers ([`super::reduce`]).

use fearless_simd::Simd;

use super::attitude::attitude_series;
use super::energies::energies;
use super::momenta::{angular_momentum, debris_momenta, linear_momentum};
use super::motion::motion;
use super::points::{Column, MeasuredRun, SeriesTable, needed};
use super::rows::SeriesSource;
use super::table::Series;
use crate::run::StateField;

/// Writes the observed series of a run.
#[inline(always)]
pub(super) fn measure<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    for source in run.sources {
        match source {
            SeriesSource::Energies => energies(simd, run, out),
            SeriesSource::LinearMomentum => linear_momentum(simd, run, out),
            SeriesSource::AngularMomentum => angular_momentum(simd, run, out),
            SeriesSource::Attitude => attitude_series(simd, run, out),
            SeriesSource::DebrisMomenta => debris_momenta(simd, run, out),
            SeriesSource::Residuals => residuals(run, out),
            SeriesSource::Motion => motion(simd, run, out),
        }
    }
    out.pad(run.observed, run.points);
}

/// The residuals of the constraints, as the kernel has them.
fn residuals(run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let vectors = run.vectors();
    let residuals: [Column<'_>; 3] = needed(run.table, StateField::Residuals, vectors);
    let series = [Series::ResidualKinematic, Series::ResidualCollocation, Series::ResidualAttitude];
    for (column, residual) in out.write(series, vectors).into_iter().zip(residuals) {
        column.copy_from_slice(residual);
    }
}
