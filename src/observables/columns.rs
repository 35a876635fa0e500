//! The one table of what a row holds. Names, order, row slots, the README's table and the Parquet schema all derive from it.
//!
//! An error column belongs to a signed series e(t) (energy) or to the norm e(t) of an error vector (momenta), measured from
//! observation point 0:
//! - `max`: largest |e| on the grid; `final`: e at the last point; `rms`: root of the mean of e^2 over the points;
//! - `rate`: slope of the least-squares line through e(t), per second (for vectors the slope of the norm).
//!
//! Energy errors are relative to the largest total energy on the grid, momentum errors to the largest |p| or |L| on the grid.
//! Where that is exactly zero the error stays absolute (the scale is one); the scales are columns themselves.

use super::group::Group;
use super::series::Series;

/// A column of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    /// Name in Parquet files, unit last.
    pub name: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// One sentence.
    pub meaning: &'static str,
    /// The group that it is asked for with.
    pub group: Group,
    /// Whether the value is a number or a count.
    pub kind: Kind,
    /// To which scenes it applies.
    pub(super) when: When,
    /// Where the value comes from.
    pub(super) value: Value,
}

impl Column {
    /// The scenes that have the column, in words; empty where all have it.
    pub const fn scenes(&self) -> &'static str {
        match self.when {
            When::Always => "",
            When::Debris => "with debris",
            When::Actuated => "with actuation",
            When::Free => "without actuation",
            When::Constrained => "reference kernel",
        }
    }
}

/// The kind of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A real number; not a number where the run did not get far enough to have it.
    Float,
    /// A count, an integer of at most 2^53.
    Count,
}

/// To which scenes a column applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum When {
    /// To all.
    Always,
    /// Where there is a debris body.
    Debris,
    /// Where actuators work.
    Actuated,
    /// Where no actuator works.
    Free,
    /// Where the kernel has constraints.
    Constrained,
}

/// Where the value of a column comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Value {
    /// A statistic of a series.
    Of(Series, Statistic),
    /// A number of its own.
    DirectValue(DirectValue),
}

/// A number made of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Statistic {
    Initial,
    Final,
    Min,
    Max,
    Mean,
    PeakToPeak,
    Fraction,
    Net,
    Gross,
    Power,
    Rms,
    Rate,
}

/// A number that is no statistic of one series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum DirectValue {
    WorkThrusters,
    WorkMotors,
    CorrelationWheel1,
    CorrelationWheel2,
    ExchangeFrequency,
    TimeReached,
    TimeFinal,
    AttitudeW,
    AttitudeX,
    AttitudeY,
    AttitudeZ,
    RateX,
    RateY,
    RateZ,
    WheelRate1,
    WheelRate2,
    Steps,
    Rejected,
    Evaluations,
    StateError,
    Amplification,
    IllConditioned,
}

impl Value {
    const STATISTICS: usize = Statistic::Rate as usize + 1;

    /// Number of slots.
    pub(super) const SLOTS: usize = Series::COUNT * Self::STATISTICS + DirectValue::IllConditioned as usize + 1;

    /// Where the value stands among all numbers that an observer can compute.
    pub(super) const fn slot(self) -> usize {
        match self {
            Value::Of(series, statistic) => series as usize * Self::STATISTICS + statistic as usize,
            Value::DirectValue(own) => Series::COUNT * Self::STATISTICS + own as usize,
        }
    }

    /// Whether the value is known although the run did not reach its end.
    pub(super) const fn survives(self) -> bool {
        match self {
            Value::DirectValue(own) => {
                DirectValue::TimeReached as usize <= own as usize && own as usize <= DirectValue::Evaluations as usize
            }
            Value::Of(..) => false,
        }
    }
}

macro_rules! column {
    ($group:ident, $when:ident, $kind:ident, $value:expr, $name:expr, $unit:expr, $meaning:expr) => {
        Column {
            name: $name,
            unit: $unit,
            meaning: $meaning,
            group: Group::$group,
            kind: Kind::$kind,
            when: When::$when,
            value: $value,
        }
    };
}

/// One number that is no statistic.
macro_rules! own {
    ($group:ident, $when:ident, $kind:ident, $own:ident, $name:literal, $unit:literal, $meaning:literal) => {
        column!($group, $when, $kind, Value::DirectValue(DirectValue::$own), $name, $unit, $meaning)
    };
}

/// One statistic of a series.
macro_rules! of {
    ($group:ident, $when:ident, $series:ident, $statistic:ident, $name:expr, $unit:expr, $meaning:expr) => {
        column!($group, $when, Float, Value::Of(Series::$series, Statistic::$statistic), $name, $unit, $meaning)
    };
}

/// Max, final, rms and secular rate of an error.
macro_rules! errors {
    ($group:ident, $when:ident, $series:ident, $name:literal, $what:literal) => {
        errors!($group, $when, $series, $name, ["", ""], ["1/s", "_per_s"], $what)
    };
    ($group:ident, $when:ident, $series:ident, $name:literal, [$unit:literal, $suffix:literal], [$per_s:literal, $per_s_suffix:literal], $what:literal) => {
        &[
            of!(
                $group,
                $when,
                $series,
                Max,
                concat!($name, "_max", $suffix),
                $unit,
                concat!("Largest size of ", $what)
            ),
            of!(
                $group,
                $when,
                $series,
                Final,
                concat!($name, "_final", $suffix),
                $unit,
                concat!("Last value of ", $what)
            ),
            of!(
                $group,
                $when,
                $series,
                Rms,
                concat!($name, "_rms", $suffix),
                $unit,
                concat!("Root mean square over the points of ", $what)
            ),
            of!(
                $group,
                $when,
                $series,
                Rate,
                concat!($name, "_rate", $per_s_suffix),
                $per_s,
                concat!("Least-squares slope in time of ", $what)
            ),
        ]
    };
}

/// Initial and largest value of a conserved quantity: the latter is the scale of its error.
macro_rules! scales {
    ($group:ident, $when:ident, $series:ident, $name:literal, [$unit:literal, $suffix:literal], $what:literal) => {
        &[
            of!(
                $group,
                $when,
                $series,
                Initial,
                concat!($name, "_initial", $suffix),
                $unit,
                concat!($what, " at time zero.")
            ),
            of!(
                $group,
                $when,
                $series,
                Max,
                concat!($name, "_max", $suffix),
                $unit,
                concat!("Largest ", $what, " on the grid, the scale of its error.")
            ),
        ]
    };
}

/// Initial, final, min, max, mean and peak-to-peak of an energy.
macro_rules! energies {
    ($group:ident, $when:ident, $series:ident, $name:literal, $what:literal) => {
        &[
            of!($group, $when, $series, Initial, concat!($name, "_initial_j"), "J", concat!($what, " at time zero.")),
            of!($group, $when, $series, Final, concat!($name, "_final_j"), "J", concat!($what, " at the last point.")),
            of!(
                $group,
                $when,
                $series,
                Min,
                concat!($name, "_min_j"),
                "J",
                concat!("Smallest ", $what, " on the grid.")
            ),
            of!(
                $group,
                $when,
                $series,
                Max,
                concat!($name, "_max_j"),
                "J",
                concat!("Largest ", $what, " on the grid.")
            ),
            of!(
                $group,
                $when,
                $series,
                Mean,
                concat!($name, "_mean_j"),
                "J",
                concat!("Mean over the points of ", $what, ".")
            ),
            of!(
                $group,
                $when,
                $series,
                PeakToPeak,
                concat!($name, "_peak_to_peak_j"),
                "J",
                concat!("Largest less smallest ", $what, " on the grid.")
            ),
        ]
    };
}

/// Swing, transfer and power of an energy about the centre of mass.
macro_rules! exchange {
    ($series:ident, $body:literal, $what:literal) => {
        &[
            of!(
                Exchange,
                Always,
                $series,
                PeakToPeak,
                concat!("exchange_", $body, "_peak_to_peak_j"),
                "J",
                concat!("Largest less smallest kinetic energy of ", $what, " about the centre of mass.")
            ),
            of!(
                Exchange,
                Always,
                $series,
                Fraction,
                concat!("exchange_", $body, "_fraction"),
                "",
                concat!(
                    "The same for ",
                    $what,
                    " over the largest total about the centre of mass (0 where that is 0)."
                )
            ),
            of!(
                Exchange,
                Always,
                $series,
                Net,
                concat!("exchange_", $body, "_net_j"),
                "J",
                concat!("Last less first kinetic energy of ", $what, " about the centre of mass.")
            ),
            of!(
                Exchange,
                Always,
                $series,
                Gross,
                concat!("exchange_", $body, "_gross_j"),
                "J",
                concat!("Sum of |dT| between neighbouring points of ", $what, " about the centre of mass.")
            ),
            of!(
                Exchange,
                Always,
                $series,
                Power,
                concat!("exchange_", $body, "_power_max_w"),
                "W",
                concat!("Largest |dT/dt| between neighbouring points of ", $what, " about the centre of mass.")
            ),
        ]
    };
}

/// The table, family by family.
#[rustfmt::skip]
const FAMILIES: &[&[Column]] = &[
    errors!(EnergyConservation, Always, EnergyError, "energy_error", "the error of total kinetic energy less the actuators' work, over the largest total energy."),
    scales!(EnergyConservation, Always, EnergyTotal, "energy_total", ["J", "_j"], "total kinetic energy in F_e, debris included,"),
    &[
        own!(EnergyConservation, Actuated, Float, WorkThrusters, "work_thrusters_final_j", "J", "Work done by the thrusters until the last point."),
        own!(EnergyConservation, Actuated, Float, WorkMotors, "work_motors_final_j", "J", "Work done by the wheel motors until the last point."),
    ],
    errors!(MomentumConservation, Always, LinearMomentumError, "linear_momentum_error", "the error vector of the spacecraft's linear momentum less impulse, over the largest |p|."),
    scales!(MomentumConservation, Always, LinearMomentumSquare, "linear_momentum", ["N s", "_n_s"], "|p| of the spacecraft"),
    errors!(MomentumConservation, Always, AngularMomentumError, "angular_momentum_error", "the error vector of the spacecraft's angular momentum about its centre of mass in F_e less angular impulse, over the largest |L|."),
    scales!(MomentumConservation, Always, AngularMomentumSquare, "angular_momentum", ["N m s", "_n_m_s"], "|L| of the spacecraft about its centre of mass"),
    errors!(MomentumConservation, Debris, DebrisLinearError, "debris_linear_momentum_error", "the error vector of the debris's linear momentum, over the largest |p|."),
    scales!(MomentumConservation, Debris, DebrisLinearSquare, "debris_linear_momentum", ["N s", "_n_s"], "|p| of the debris"),
    errors!(MomentumConservation, Debris, DebrisAngularError, "debris_angular_momentum_error", "the error vector of the debris's angular momentum about its centre in F_e, over the largest |L|."),
    scales!(MomentumConservation, Debris, DebrisAngularSquare, "debris_angular_momentum", ["N m s", "_n_m_s"], "|L| of the debris about its centre"),
    errors!(Attitude, Always, AttitudeError, "dcm_orthonormality", "the largest entry of |C_es^T C_es - 1|."),
    errors!(Constraints, Constrained, ResidualKinematic, "residual_kinematic", ["m/s", "_m_s"], ["m/s^2", "_m_s2"], "the residual of the kinematic constraints (angular components in rad/s)."),
    errors!(Constraints, Constrained, ResidualCollocation, "residual_collocation", ["m", "_m"], ["m/s", "_m_s"], "the residual of the collocation constraints (tilts of wheel axes as sines)."),
    errors!(Constraints, Constrained, ResidualAttitude, "residual_attitude", "the residual of the attitude constraints."),
    energies!(Energies, Always, EnergyFuselage, "energy_fuselage", "kinetic energy of the fuselage in F_e"),
    energies!(Energies, Always, EnergyWheel1, "energy_wheel1", "kinetic energy of wheel 1 in F_e"),
    energies!(Energies, Always, EnergyWheel2, "energy_wheel2", "kinetic energy of wheel 2 in F_e"),
    energies!(Energies, Debris, EnergyDebris, "energy_debris", "kinetic energy of the debris in F_e"),
    energies!(EnergiesCom, Always, ComFuselage, "energy_com_fuselage", "kinetic energy of the fuselage about the spacecraft's centre of mass"),
    energies!(EnergiesCom, Always, ComWheel1, "energy_com_wheel1", "kinetic energy of wheel 1 about the spacecraft's centre of mass"),
    energies!(EnergiesCom, Always, ComWheel2, "energy_com_wheel2", "kinetic energy of wheel 2 about the spacecraft's centre of mass"),
    scales!(EnergiesCom, Always, ComTotal, "energy_com_total", ["J", "_j"], "kinetic energy of the spacecraft about its centre of mass"),
    errors!(EnergiesCom, Free, ComError, "energy_com_error", "the change of kinetic energy about the centre of mass, over the largest (only where no actuator works)."),
    exchange!(ComFuselage, "fuselage", "the fuselage"),
    exchange!(ComWheel1, "wheel1", "wheel 1"),
    exchange!(ComWheel2, "wheel2", "wheel 2"),
    &[
        own!(Exchange, Always, Float, CorrelationWheel1, "exchange_wheel1_correlation", "", "Correlation over the points of the energies of fuselage and wheel 1 about the centre of mass (0 where one of them is constant)."),
        own!(Exchange, Always, Float, CorrelationWheel2, "exchange_wheel2_correlation", "", "Correlation over the points of the energies of fuselage and wheel 2 about the centre of mass (0 where one of them is constant)."),
        own!(Exchange, Always, Float, ExchangeFrequency, "exchange_frequency_hz", "Hz", "Dominant frequency of the fuselage's energy about the centre of mass (0 where it is constant; none on uneven grids)."),
        own!(FinalState, Always, Float, TimeReached, "time_reached_s", "s", "Time that the integration reached."),
        own!(FinalState, Always, Float, TimeFinal, "time_final_s", "s", "Time of the last finite state at an observation point, which the other columns of this group hold."),
        own!(FinalState, Always, Float, AttitudeW, "q_es_w_final", "", "Attitude quaternion, scalar part, at the final time."),
        own!(FinalState, Always, Float, AttitudeX, "q_es_x_final", "", "Attitude quaternion, first vector part, at the final time."),
        own!(FinalState, Always, Float, AttitudeY, "q_es_y_final", "", "Attitude quaternion, second vector part, at the final time."),
        own!(FinalState, Always, Float, AttitudeZ, "q_es_z_final", "", "Attitude quaternion, third vector part, at the final time."),
        own!(FinalState, Always, Float, RateX, "omega_se_s_x_final_rad_s", "rad/s", "Angular velocity of the fuselage about s1 at the final time."),
        own!(FinalState, Always, Float, RateY, "omega_se_s_y_final_rad_s", "rad/s", "Angular velocity of the fuselage about s2 at the final time."),
        own!(FinalState, Always, Float, RateZ, "omega_se_s_z_final_rad_s", "rad/s", "Angular velocity of the fuselage about s3 at the final time."),
        own!(FinalState, Always, Float, WheelRate1, "alpha_dot_final_rad_s", "rad/s", "Rate of wheel 1 relative to the fuselage at the final time."),
        own!(FinalState, Always, Float, WheelRate2, "beta_dot_final_rad_s", "rad/s", "Rate of wheel 2 relative to the fuselage at the final time."),
        own!(StepStatistics, Always, Count, Steps, "steps", "", "Accepted steps."),
        own!(StepStatistics, Always, Count, Rejected, "steps_rejected", "", "Rejected steps."),
        own!(StepStatistics, Always, Count, Evaluations, "evaluations", "", "Evaluations of the right-hand side (for Taylor methods: jets)."),
        own!(Numerics, Always, Float, StateError, "state_error_estimate", "", "Estimated largest error of the fuselage's rotation on the grid: of omega over the largest |omega|, or of the attitude in rad, whichever is larger."),
        own!(Numerics, Always, Float, Amplification, "error_amplification", "", "Estimated factor by which the motion amplifies relative errors of the rotational state that are made evenly along the run."),
        own!(Numerics, Always, Count, IllConditioned, "ill_conditioned", "", "1 where the rounding of the input alone may move the state by more than 1e-3 (error_amplification times 2^-52), else 0."),
    ],
];

/// Every column, in the order of a row.
pub fn all() -> impl Iterator<Item = &'static Column> {
    FAMILIES.iter().copied().flatten()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn names_and_slots_are_unique() {
        let mut names = HashSet::new();
        let mut sources = HashSet::new();
        for column in all() {
            assert!(names.insert(column.name), "{} stands twice", column.name);
            assert!(column.value.slot() < Value::SLOTS);
            // peak-to-peak about the centre of mass belongs to the energies and to the exchange alike
            sources.insert((column.value.slot(), column.group as usize));
        }
        assert_eq!(names.len(), sources.len(), "two columns of a group show the same number");
    }

    #[test]
    fn the_name_of_a_column_ends_with_its_unit() {
        for column in all() {
            let suffix = match column.unit {
                "" => continue,
                "1/s" => "_per_s".to_owned(),
                unit => format!("_{}", unit.to_lowercase().replace([' ', '/'], "_").replace('^', "")),
            };
            assert!(column.name.ends_with(&suffix), "{} [{}]", column.name, column.unit);
        }
    }

    #[test]
    fn every_column_is_explained_by_a_sentence() {
        for column in all() {
            let meaning = column.meaning;
            assert!(
                meaning.len() > 10 && meaning.ends_with('.') && !meaning.ends_with(".."),
                "{}: {meaning}",
                column.name
            );
        }
    }

    #[test]
    fn columns_stand_together_by_group() {
        let order: Vec<usize> = all().map(|column| column.group as usize).collect();
        assert!(order.is_sorted());
        for group in Group::ALL {
            assert!(all().any(|column| column.group == group));
        }
    }
}
