//! Series from states, by source, before their reduction in [`super::reduce`].

use fearless_simd::Simd;

use super::attitude::attitude_series;
use super::energies::energies;
use super::law_columns::LawSeries;
use super::momenta::{angular_momentum, debris_momenta, linear_momentum};
use super::motion::motion;
use super::orbit::orbit;
use super::points::{Column, MeasuredRun, SeriesTable, needed};
use super::rows::SeriesSource;
use super::surroundings::surroundings;
use super::table::Series;
use crate::run::StateField;

#[inline(always)]
pub fn measure<S: Simd>(simd: S, run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    for source in run.sources {
        match source {
            SeriesSource::Energies => energies(simd, run, out),
            SeriesSource::LinearMomentum => linear_momentum(simd, run, out),
            SeriesSource::AngularMomentum => angular_momentum(simd, run, out),
            SeriesSource::Attitude => attitude_series(simd, run, out),
            SeriesSource::DebrisMomenta => debris_momenta(simd, run, out),
            SeriesSource::Residuals => residuals(run, out),
            SeriesSource::Motion => motion(simd, run, out),
            SeriesSource::Orbit => orbit(simd, run, out),
            SeriesSource::Surroundings => surroundings(simd, run, out),
            SeriesSource::Law => recorded(run, out),
        }
    }
    out.pad(run.observed, run.points);
}

/// Records of the control law, else NaN.
fn recorded(run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let of_each = run.of_law.len() / LawSeries::COUNT;
    for series in Series::all().filter(|series| run.observed.has(*series)) {
        let Some(place) = LawSeries::place(series) else { continue };
        let [column] = out.write([series], run.vectors());
        let recorded = run.of_law[place * of_each..][..of_each].iter().copied().chain(std::iter::repeat(f64::NAN));
        column.as_flattened_mut().iter_mut().zip(recorded).for_each(|(value, recorded)| *value = recorded);
    }
}

fn residuals(run: &MeasuredRun<'_>, out: &mut SeriesTable) {
    let vectors = run.vectors();
    let residuals: [Column<'_>; 3] = needed(run.table, StateField::Residuals, vectors);
    let series = [Series::ResidualKinematic, Series::ResidualCollocation, Series::ResidualAttitude];
    for (column, residual) in out.write(series, vectors).into_iter().zip(residuals) {
        column.copy_from_slice(residual);
    }
}
