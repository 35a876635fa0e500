//! [`BandSeries`]: quantities over time whose quantiles over a campaign form bands. Only |omega| needs a computation
//! beyond the observed columns.

use super::group::Group;
use super::law_columns::LawSeries;
use super::reduction::{Reduction, Stored};
use super::request::Request;
use super::table::{CHANGES, Column, Series};
use super::window::Window;
use crate::run::{Quantity, StateField, StateTable};

/// Kept form of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The quantity itself.
    Value,
    /// Tangent of half the angle, from 0 to pi: saves an arc tangent at every point.
    HalfTangent,
}

/// Stands for the tangent of a right angle.
const VERTICAL: f64 = 1e100;

impl Form {
    /// Deviation of `kept` from `nominal`, in the same form; for half tangents by the addition theorem.
    #[inline(always)]
    pub fn deviation(self, kept: f64, nominal: f64) -> f64 {
        match self {
            Form::Value => kept - nominal,
            Form::HalfTangent => (kept - nominal) / (1.0 + kept * nominal),
        }
    }

    /// Quantity of a kept number, or deviation of a kept deviation.
    pub fn shown(self, kept: f64) -> f64 {
        match self {
            Form::Value => kept,
            Form::HalfTangent => 2.0 * libm::atan(kept),
        }
    }
}

/// A quantity over time with bands.
#[derive(Clone, Debug, PartialEq)]
pub struct BandSeries {
    pub(super) series: Series,
    stored: Stored,
    /// Divisor of the values.
    pub(super) scale: Option<(Series, Reduction)>,
    /// True for the change of the series since the start.
    pub(super) is_change: bool,
    /// True if no column needs the series, so that it is computed at the points of the bands only.
    pub(super) is_own: bool,
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Form of the kept values.
    pub form: Form,
}

/// The series that has bands even if no column needs it:
const OWN: Series = Series::RateSquare;

/// Quantities with bands in runs of `request`.
pub fn band_series(request: &Request) -> Vec<BandSeries> {
    macro_rules! bands {
        ($($series:ident)+) => {
            [$(of_series(request, Series::$series, false)),+].into_iter()
        };
    }
    let changes = CHANGES.iter().map(|(series, ..)| of_series(request, *series, true));
    let values = bands!(EnergyError LinearMomentumError AngularMomentumError EnergyBody EnergyWheel);
    let others = bands!(
        SpinAxisAngle FromNominal Nutation DebrisDirection RateSquare WheelSpeed PointingError AttitudeEstimateError
        RateEstimateError PositionEstimateError VelocityEstimateError DebrisDistance DebrisSpeed Impulse MotorTorque
        OrbitDistance NadirAngle FieldStrength AirDensity SunHidden
    );
    values.chain(changes).chain(others).flatten().collect()
}

/// Quantities for events in runs of `request`: all observed ones except relative errors, whose scale depends on the
/// observation points.
pub fn event_series(request: &Request) -> Vec<BandSeries> {
    let of_values = Series::all().filter(|series| series.wheel().is_none_or(|wheel| wheel == 0));
    let of_changes = CHANGES.iter().map(|(series, ..)| (*series, true));
    let all = of_values.map(|series| (series, false)).chain(of_changes);
    all.flat_map(|(series, is_change)| of_series(request, series, is_change))
        .filter(|band| band.scale.is_none())
        .collect()
}

impl BandSeries {
    /// True if a control loop sets the quantity at its ticks and holds it in between.
    pub fn changes_at_ticks(&self) -> bool {
        LawSeries::place(self.series).is_some() && self.series.wheel().is_none()
    }

    /// True if the quantity compares the run with the nominal one.
    pub fn is_from_nominal(&self) -> bool {
        self.series == Series::FromNominal
    }

    /// Largest or smallest value over a closed interval of time, s.
    pub fn window(&self, request: &Request, is_highest: bool, [from_s, to_s]: [Option<f64>; 2]) -> Window {
        let shows = |column: &Column| column.value.of(self.series);
        let otherwise = if LawSeries::place(self.series).is_some() { Group::Control } else { Group::Motion };
        let group = request.columns().into_iter().find(shows).map_or(otherwise, |column| column.group);
        Window { series: self.series, group, is_change: self.is_change, is_highest, from_s, to_s }
    }
}

/// Bands of `series`, or of its change since the start, for each wheel, if observed.
fn of_series(request: &Request, series: Series, is_change: bool) -> Vec<BandSeries> {
    let places = if series.wheel().is_some() { request.wheels.len() } else { 1 };
    let observed = request.series();
    let of_place = |place: usize| {
        let series = series.of_wheel(place);
        let is_own = series == OWN && !observed.contains(&series) && request.fields().contains(StateField::Rate);
        let quantity = series.over_time(is_change, &request.wheels);
        let quantity = quantity.filter(|_| is_own || observed.contains(&series))?;
        let (stored, scale) = (series.row().stored, series.row().scale);
        let form = match stored {
            Stored::HalfTangentSquare => Form::HalfTangent,
            Stored::Quantity | Stored::Square => Form::Value,
        };
        Some(BandSeries { series, stored, scale, is_change, is_own, quantity, form })
    };
    (0..places).filter_map(of_place).collect()
}

/// Kept numbers of |omega|, rad/s, from the states.
#[inline(always)]
pub(super) fn keep_own(table: &StateTable, points: &[usize], out: &mut [f64]) {
    let [x, y, z] = [0, 1, 2].map(|component| table.column(StateField::Rate, component));
    for (out, point) in out.iter_mut().zip(points) {
        let [x, y, z] = [x[*point], y[*point], z[*point]];
        *out = x * x + y * y + z * z;
    }
    out.iter_mut().for_each(|out| *out = out.sqrt());
}

/// Kept numbers of a stored `column`; relative errors are divided by `scale`.
#[inline(always)]
pub(super) fn keep(band: &BandSeries, column: &[f64], scale: f64, points: &[usize], out: &mut [f64]) {
    for (out, point) in out.iter_mut().zip(points) {
        *out = column[*point];
    }
    match band.stored {
        Stored::Quantity if band.is_change => {
            let start = column.first().copied().unwrap_or(f64::NAN);
            out.iter_mut().for_each(|out| *out -= start);
        }
        Stored::Quantity if scale == 1.0 => {}
        Stored::Quantity => out.iter_mut().for_each(|out| *out /= scale),
        Stored::Square => out.iter_mut().for_each(|out| *out = out.sqrt()),
        Stored::HalfTangentSquare => {
            for out in out {
                let tangent = out.sqrt();
                // keeps NaN, unlike f64::min
                *out = if tangent > VERTICAL { VERTICAL } else { tangent };
            }
        }
    }
}
