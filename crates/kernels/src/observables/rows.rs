//! Types and macros of the table of observables; the rows are in [`super::table`].

use crate::dynamics::effects::{Effect, ForceModel};
use crate::run::StateField;
use crate::scene::Actuated;

/// The kind of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// A real number; NaN if the run failed before.
    Float,
    /// A count, at most 2^53.
    Count,
}

pub(super) struct Facts {
    pub(super) debris: bool,
    pub(super) actuated: Actuated,
    pub(super) effects: ForceModel,
    pub(super) constrained: bool,
    pub(super) wheels: usize,
}

macro_rules! listed {
    ($(#[$doc:meta])* $visibility:vis enum $name:ident { $($(#[$of:meta])* $variant:ident,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(usize)]
        $visibility enum $name {
            $($(#[$of])* $variant,)*
        }

        impl $name {
            pub(super) const ALL: [$name; [$(stringify!($variant)),*].len()] = [$($name::$variant),*];
        }
    };
}

macro_rules! scenes {
    ($facts:ident: $($name:ident: $words:literal, $included:expr;)*) => {
        /// Kinds of scene with a column.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Scenes {
            $($name,)*
        }

        impl Scenes {
            pub(super) const fn words(self) -> &'static str {
                match self {
                    $(Scenes::$name => $words,)*
                }
            }

            pub(super) fn include(self, $facts: &Facts) -> bool {
                match self {
                    $(Scenes::$name => $included,)*
                }
            }
        }
    };
}

scenes! {
    facts:
    All: "", true;
    Debris: "with debris", facts.debris;
    Actuated: "with actuation", facts.actuated.any();
    Thrusters: "with thrusters that act", facts.actuated.thrusters;
    ExternalTorque: "with thrusters that act or a torque on the body", facts.actuated.external();
    Motors: "with motors that act", facts.actuated.motors && facts.wheels > 0;
    Free: "without actuation", !facts.actuated.any();
    Constrained: "null-space method", facts.constrained;
    ConstrainedBodies: "null-space method, with wheels that turn or debris",
        facts.constrained && (facts.debris || facts.wheels > 0);
    ConstrainedDebris: "null-space method, with debris", facts.constrained && facts.debris;
    IntegratedVelocity: "with thrusters that act, or null-space method",
        facts.constrained || facts.actuated.thrusters;
    Unconstrained: "not the null-space method", !facts.constrained;
    Wheels: "with wheels that turn", facts.wheels > 0;
    SeveralWheels: "with several wheels", facts.wheels > 1;
    Orbit: "on an orbit", facts.effects.contains(Effect::Gravity);
    GravityGradient: "with a gravity gradient", facts.effects.contains(Effect::GravityGradient);
    MagneticTorque: "with a magnetic dipole or torque rods", facts.effects.contains(Effect::MagneticTorque);
    Drag: "with drag", facts.effects.contains(Effect::Drag);
    SolarPressure: "with solar pressure", facts.effects.contains(Effect::SolarPressure);
}

/// A field of the state table that a value needs in some kinds of scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Need {
    pub(super) field: StateField,
    pub(super) scenes: Scenes,
    pub(super) why: &'static str,
}

/// Lists of needs, `NAME: field scenes "purpose", ...;`.
macro_rules! needs {
    ($($name:ident: $($field:ident $scenes:ident $why:literal),*;)*) => {
        $(const $name: &[Need] = &[
            $(Need { field: StateField::$field, scenes: Scenes::$scenes, why: $why }),*
        ];)*
    };
}

listed! {
    /// Computation of a series, in order of execution; see [`super::measure`].
    pub(super) enum SeriesSource {
        Energies,
        LinearMomentum,
        AngularMomentum,
        Attitude,
        DebrisMomenta,
        Residuals,
        Motion,
        Orbit,
        Surroundings,
        Law,
    }
}

macro_rules! optional {
    () => {
        None
    };
    ($value:expr) => {
        Some($value)
    };
}

/// The table of series: `source { name [places] stored form / scale [needs] [column of a time series] meaning; }`; for
/// wheels a place per possible wheel, and `{wheel}` in name and meaning.
macro_rules! series {
    ($($source:ident {
        $($name:ident [$count:expr] $stored:ident $(/ $scale:ident)? [$($need:ident),*]
        [$($column:literal $unit:literal)?] $meaning:literal;)*
    })*) => {
        #[derive(Clone, Copy)]
        enum SeriesKind { $($($name,)*)* }

        const PLACES: &[usize] = &[$($($count),*),*];

        #[expect(non_upper_case_globals, reason = "names of series are written like variants")]
        impl Series {
            $($(#[doc = $meaning] pub const $name: Series = Series::first(SeriesKind::$name as usize);)*)*
        }

        static SERIES: [SeriesRow; PLACES.len()] = [
            $($(SeriesRow {
                source: SeriesSource::$source,
                stored: Stored::$stored,
                scale: optional!($((Series::$scale, MAX))?),
                needs: &[$($need),*],
                shown: optional!($(Quantity::new($column, $unit, $meaning))?),
            }),*),*
        ];
    };
}

/// The table of direct values: `group [needs, inputs, known after a failure] { name scenes kind "column" "unit"
/// meaning; }`.
macro_rules! direct_values {
    ($($group:ident [$needs:expr, $inputs:expr, $after_failure:literal] {
        $($name:ident $scenes:ident $kind:ident $column:literal $unit:literal $meaning:literal;)*
    })*) => {
        /// A number that is not reduced from a single series.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(usize)]
        pub enum DirectValue {
            $($(#[doc = $meaning] $name,)*)*
        }

        impl DirectValue {
            #[cfg(test)]
            pub(super) const COUNT: usize = [$($(stringify!($name)),*),*].len();

            pub(super) const fn row(self) -> DirectRow {
                match self {
                    $($(DirectValue::$name)|* => {
                        DirectRow { needs: $needs, inputs: $inputs, after_failure: $after_failure }
                    })*
                }
            }

            const fn column(self) -> Column {
                match self {
                    $($(DirectValue::$name => column!(
                        $group, $scenes, $kind, Value::Direct(DirectValue::$name, 0), [$column], $unit, [$meaning]
                    ),)*)*
                }
            }
        }
    };
}

macro_rules! direct {
    ($($name:ident),*) => { &[$(DirectValue::$name.column()),*] };
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

macro_rules! reduction {
    (Fraction) => {
        Reduction::Fraction
    };
    (Order $statistic:ident) => {
        Reduction::Order(OrderStatistic::$statistic)
    };
    (Value $statistic:ident) => {
        Reduction::Value(ValueStatistic::$statistic)
    };
    (Error $statistic:ident) => {
        Reduction::Error(ErrorStatistic::$statistic)
    };
    (Change $statistic:ident) => {
        Reduction::Change(ChangeStatistic::$statistic)
    };
}

/// Columns of reduced series: `group scenes: series [reduction] "column" "unit" meaning;`; column and meaning may be in
/// parts, in brackets.
macro_rules! columns {
    ($group:ident $scenes:ident:
    $($series:ident [$($reduction:ident)+] $name:literal $unit:literal $meaning:literal;)*) => {
        columns!($group $scenes: $($series [$($reduction)+] [$name] $unit [$meaning];)*)
    };
    ($group:ident $scenes:ident:
    $($series:ident [$($reduction:ident)+] [$($name:literal)+] $unit:literal [$($meaning:literal)+];)*) => {
        &[$(column!(
            $group, $scenes, Float, Value::Of(Series::$series, reduction!($($reduction)+)), [$($name),+], $unit,
            [$($meaning),+]
        )),*]
    };
}

macro_rules! errors {
    ($group:ident, $scenes:ident, $series:ident, $name:literal, $what:literal) => {
        errors!($group, $scenes, $series, $name, ["", ""], ["1/s", "_per_s"], $what)
    };
    ($group:ident, $scenes:ident, $series:ident, $name:literal, [$unit:literal, $suffix:literal],
    [$rate:literal, $rate_suffix:literal], $what:literal) => {
        columns! { $group $scenes:
            $series [Error Max] [$name "_max" $suffix] $unit ["Maximum magnitude of " $what];
            $series [Error Final] [$name "_final" $suffix] $unit ["Final value of " $what];
            $series [Error Rms] [$name "_rms" $suffix] $unit ["Root mean square over the points of " $what];
            $series [Error Slope] [$name "_rate" $rate_suffix] $rate ["Least-squares slope over time of " $what];
        }
    };
}

macro_rules! scales {
    ($group:ident, $scenes:ident, $series:ident, $name:literal, [$unit:literal, $suffix:literal], $what:literal) => {
        columns! { $group $scenes:
            $series [Order Initial] [$name "_initial" $suffix] $unit ["Initial " $what "."];
            $series [Order Max] [$name "_max" $suffix] $unit ["Maximum " $what " on the grid."];
        }
    };
}

macro_rules! energies {
    ($group:ident, $scenes:ident, $series:ident, $name:literal, $what:literal) => {
        columns! { $group $scenes:
            $series [Value Initial] [$name "_initial_j"] "J" ["Initial " $what "."];
            $series [Value Final] [$name "_final_j"] "J" ["Final " $what "."];
            $series [Value Min] [$name "_min_j"] "J" ["Minimum " $what " on the grid."];
            $series [Value Max] [$name "_max_j"] "J" ["Maximum " $what " on the grid."];
            $series [Value Mean] [$name "_mean_j"] "J" ["Mean over the points of the " $what "."];
            $series [Value PeakToPeak] [$name "_peak_to_peak_j"] "J" ["Maximum minus minimum " $what " on the grid."];
        }
    };
}

#[rustfmt::skip]
macro_rules! exchange {
    ($series:ident, $scenes:ident, $body:literal, $what:literal) => {
        columns! { Exchange $scenes:
            $series [Value PeakToPeak] ["exchange_" $body "_peak_to_peak_j"] "J"
                ["Maximum minus minimum of the kinetic energy of " $what " about the centre of mass."];
            $series [Fraction] ["exchange_" $body "_fraction"] ""
                ["Maximum minus minimum of the kinetic energy of " $what ", relative to the largest total energy about \
                    the centre of mass (0 if that is 0)."];
            $series [Value Net] ["exchange_" $body "_net_j"] "J"
                ["Final minus initial kinetic energy of " $what " about the centre of mass."];
            $series [Change Gross] ["exchange_" $body "_gross_j"] "J"
                ["Sum of |dT| from point to point, where T is the kinetic energy of " $what
                " about the centre of mass."];
            $series [Change Power] ["exchange_" $body "_power_max_w"] "W"
                ["Maximum of |dT/dt| from point to point, where T is the kinetic energy of " $what
                " about the centre of mass."];
        }
    };
}
