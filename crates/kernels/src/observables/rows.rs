//! Types and macros of the table of observables; the rows are in [`super::table`].

use crate::run::StateField;

/// The kind of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A real number; NaN if the run failed before.
    Float,
    /// A count, at most 2^53.
    Count,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scenes {
    /// Every scene.
    All,
    /// With a debris body.
    Debris,
    /// With thrusters, motors or torques on the body.
    Actuated,
    /// With thrusters in the schedule.
    Thrusters,
    /// With thrusters or torques on the body.
    ExternalTorque,
    /// With motors in the schedule, or motors that hold the speed of their wheels.
    Motors,
    /// Without thrusters, motors and torques on the body.
    Free,
    /// Integrated with constraints: the null-space method.
    Constrained,
    /// Integrated with constraints between several bodies: wheels that turn, or debris.
    ConstrainedBodies,
    /// With a debris body, integrated with constraints.
    ConstrainedDebris,
    /// With thrusters in the schedule, or integrated with constraints: otherwise the velocity of c is constant.
    IntegratedVelocity,
    /// Integrated without constraints.
    Unconstrained,
    /// With wheels that turn.
    Wheels,
    /// With several of them.
    SeveralWheels,
    /// On an orbit.
    Orbit,
    /// With a gravity gradient.
    GravityGradient,
    /// With a magnetic dipole or torque rods.
    MagneticTorque,
    /// With drag.
    Drag,
    /// With the pressure of sunlight.
    SolarPressure,
}

/// A field of the state table behind a value: kind of scene and purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Need {
    pub(super) field: StateField,
    pub(super) scenes: Scenes,
    pub(super) why: &'static str,
}

/// Computation of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum SeriesSource {
    /// [`super::energies`].
    Energies,
    /// [`super::momenta`].
    LinearMomentum,
    /// [`super::momenta`].
    AngularMomentum,
    /// [`super::momenta`].
    DebrisMomenta,
    /// [`super::attitude`].
    Attitude,
    /// Copied from the state table.
    Residuals,
    /// [`super::motion`].
    Motion,
    /// [`super::orbit`].
    Orbit,
    /// [`super::surroundings`].
    Surroundings,
    /// Records of the control law at the points ([`super::law_columns::LawSeries`]).
    Law,
}

impl SeriesSource {
    /// Every source, in order of computation.
    pub(super) const ALL: [SeriesSource; 10] = [
        SeriesSource::Energies,
        SeriesSource::LinearMomentum,
        SeriesSource::AngularMomentum,
        SeriesSource::Attitude,
        SeriesSource::DebrisMomenta,
        SeriesSource::Residuals,
        SeriesSource::Motion,
        SeriesSource::Orbit,
        SeriesSource::Surroundings,
        SeriesSource::Law,
    ];
}

pub(super) const fn need(field: StateField, scenes: Scenes, why: &'static str) -> Need {
    Need { field, scenes, why }
}

/// The table of series: `name [places]: source, stored form, scale, needs, column of a time series, meaning`. A series
/// of wheels has a place per possible wheel, and `{wheel}` in its name and meaning.
macro_rules! series {
    ($($name:ident [$count:expr]: $source:ident, $stored:ident, $scale:expr, [$($need:ident),*], $shown:expr,
    $meaning:literal;)*) => {
        #[derive(Clone, Copy)]
        enum SeriesKind { $($name,)* }

        const PLACES: &[usize] = &[$($count),*];

        #[expect(non_upper_case_globals, reason = "names of series, as those of variants")]
        impl Series {
            $(#[doc = $meaning] pub const $name: Series = Series::first(SeriesKind::$name as usize);)*
        }

        static SERIES: [SeriesRow; PLACES.len()] = [
            $(SeriesRow {
                source: SeriesSource::$source,
                stored: Stored::$stored,
                scale: $scale,
                needs: &[$($need),*],
                shown: match $shown {
                    Some((name, unit)) => Some(Quantity::new(name, unit, $meaning)),
                    None => None,
                },
            }),*
        ];
    };
}

/// The table of direct values: `name: needs, inputs, known after a failure, meaning`.
macro_rules! direct_values {
    ($($name:ident: $needs:expr, $inputs:expr, $after_failure:ident, $meaning:literal;)*) => {
        /// A number that is not reduced from a single series.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(usize)]
        pub enum DirectValue {
            $(#[doc = $meaning] $name,)*
        }

        pub(super) static DIRECT_VALUES: &[DirectRow] = &[
            $(DirectRow { needs: $needs, inputs: $inputs, after_failure: $after_failure }),*
        ];
    };
}

macro_rules! column {
    ($group:ident, $scenes:ident, $kind:ident, $value:expr, [$($name:expr),*], $unit:expr, [$($meaning:expr),*]) => {
        Column {
            quantity: Quantity::new(concat!($($name),*), $unit, concat!($($meaning),*)),
            group: Group::$group,
            kind: ColumnKind::$kind,
            scenes: Scenes::$scenes,
            value: $value,
            wheel: None,
        }
    };
}

macro_rules! of {
    ($group:ident, $scenes:ident, $series:ident, $reduction:ident, [$($name:expr),*], $unit:expr,
    [$($meaning:expr),*]) => {
        column!($group, $scenes, Float, Value::Of(Series::$series, Reduction::$reduction), [$($name),*], $unit,
            [$($meaning),*])
    };
    ($group:ident, $scenes:ident, $series:ident, $reduction:ident($statistics:ident::$statistic:ident),
    [$($name:expr),*], $unit:expr, [$($meaning:expr),*]) => {
        column!($group, $scenes, Float, Value::Of(Series::$series, Reduction::$reduction($statistics::$statistic)),
            [$($name),*], $unit, [$($meaning),*])
    };
}

macro_rules! direct {
    ($group:ident, $scenes:ident, $kind:ident, $value:ident, $name:literal, $unit:literal, $meaning:literal) => {
        column!($group, $scenes, $kind, Value::Direct(DirectValue::$value, 0), [$name], $unit, [$meaning])
    };
}

/// Maximum magnitude, final value, root mean square and slope of an error.
#[rustfmt::skip]
macro_rules! errors {
    ($group:ident, $scenes:ident, $series:ident, $name:literal, $what:literal) => {
        errors!($group, $scenes, $series, $name, ["", ""], ["1/s", "_per_s"], $what)
    };
    ($group:ident, $scenes:ident, $series:ident, $name:literal, [$unit:literal, $suffix:literal], [$rate:literal,
    $rate_suffix:literal], $what:literal) => {
        &[
            of!($group, $scenes, $series, Error(ErrorStatistic::Max), [$name, "_max", $suffix], $unit,
                ["Maximum magnitude of ", $what]),
            of!($group, $scenes, $series, Error(ErrorStatistic::Final), [$name, "_final", $suffix], $unit,
                ["Final value of ", $what]),
            of!($group, $scenes, $series, Error(ErrorStatistic::Rms), [$name, "_rms", $suffix], $unit,
                ["Root mean square over the points of ", $what]),
            of!($group, $scenes, $series, Error(ErrorStatistic::Slope), [$name, "_rate", $rate_suffix], $rate,
                ["Least-squares slope over time of ", $what]),
        ]
    };
}

/// Initial and maximum value of a conserved quantity.
#[rustfmt::skip]
macro_rules! scales {
    ($group:ident, $scenes:ident, $series:ident, $name:literal, [$unit:literal, $suffix:literal], $what:literal) => {
        &[
            of!($group, $scenes, $series, Order(OrderStatistic::Initial), [$name, "_initial", $suffix], $unit,
                ["Initial ", $what, "."]),
            of!($group, $scenes, $series, Order(OrderStatistic::Max), [$name, "_max", $suffix], $unit, ["Maximum ",
                $what, " on the grid."]),
        ]
    };
}

/// Initial, final, minimum, maximum, mean and peak-to-peak of an energy.
#[rustfmt::skip]
macro_rules! energies {
    ($group:ident, $scenes:ident, $series:ident, $name:literal, $what:literal) => {
        &[
            of!($group, $scenes, $series, Value(ValueStatistic::Initial), [$name, "_initial_j"], "J", ["Initial ",
                $what, "."]),
            of!($group, $scenes, $series, Value(ValueStatistic::Final), [$name, "_final_j"], "J", ["Final ", $what,
                "."]),
            of!($group, $scenes, $series, Value(ValueStatistic::Min), [$name, "_min_j"], "J", ["Minimum ", $what,
                " on the grid."]),
            of!($group, $scenes, $series, Value(ValueStatistic::Max), [$name, "_max_j"], "J", ["Maximum ", $what,
                " on the grid."]),
            of!($group, $scenes, $series, Value(ValueStatistic::Mean), [$name, "_mean_j"], "J",
                ["Mean over the points of the ", $what, "."]),
            of!($group, $scenes, $series, Value(ValueStatistic::PeakToPeak), [$name, "_peak_to_peak_j"], "J",
                ["Maximum minus minimum ", $what, " on the grid."]),
        ]
    };
}

/// Swing, transfer and power of an energy about the centre of mass.
#[rustfmt::skip]
macro_rules! exchange {
    ($series:ident, $scenes:ident, $body:literal, $what:literal) => {
        &[
            of!(Exchange, $scenes, $series, Value(ValueStatistic::PeakToPeak), ["exchange_", $body,
                "_peak_to_peak_j"], "J", ["Maximum minus minimum of the kinetic energy of ", $what,
                    " about the centre of mass."]),
            of!(Exchange, $scenes, $series, Fraction, ["exchange_", $body, "_fraction"], "", ["Maximum minus minimum \
                of the kinetic energy of ", $what, ", relative to the largest total energy about the centre of mass (0 \
                    if that is 0)."]),
            of!(Exchange, $scenes, $series, Value(ValueStatistic::Net), ["exchange_", $body, "_net_j"], "J",
                ["Final minus initial kinetic energy of ", $what, " about the centre of mass."]),
            of!(Exchange, $scenes, $series, Change(ChangeStatistic::Gross), ["exchange_", $body, "_gross_j"], "J",
                ["Sum of |dT| from point to point, where T is the kinetic energy of ", $what,
                " about the centre of mass."]),
            of!(Exchange, $scenes, $series, Change(ChangeStatistic::Power), ["exchange_", $body, "_power_max_w"],
                "W", ["Maximum of |dT/dt| from point to point, where T is the kinetic energy of ", $what,
                    " about the centre of mass."]),
        ]
    };
}
