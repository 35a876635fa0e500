//! [`Series`]: the quantities that are followed from point to point, and what each needs of the state table.
//!
//! Columns of a row are statistics of these; `simulate` writes those that have a [`SeriesColumn`] as they are. One code for both.

use super::request::Request;
use crate::run::StateField;

/// A quantity at every observation point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(usize)]
pub enum Series {
    /// Kinetic energy of the fuselage in F_e (36), J.
    EnergyFuselage,
    /// Kinetic energy of W1 in F_e (36), J.
    EnergyWheel1,
    /// Kinetic energy of W2 in F_e (36), J.
    EnergyWheel2,
    /// Kinetic energy of the debris in F_e (36), J.
    EnergyDebris,
    /// Total kinetic energy in F_e, debris included where there is one, J.
    EnergyTotal,
    /// Total kinetic energy less the work of the actuators, less its value at point 0, J.
    EnergyError,
    /// Kinetic energy of the fuselage about c, J.
    ComFuselage,
    /// Kinetic energy of W1 about c, J.
    ComWheel1,
    /// Kinetic energy of W2 about c, J.
    ComWheel2,
    /// Kinetic energy of the spacecraft about c, J.
    ComTotal,
    /// The same less its value at point 0, J; an error only where no actuator works.
    ComError,
    /// |m v_c - impulse - value at point 0|, N s.
    LinearMomentumError,
    /// |m v_c|^2, N^2 s^2.
    LinearMomentumSquare,
    /// |L - angular impulse - value at point 0|, N m s.
    AngularMomentumError,
    /// |L|^2, N^2 m^2 s^2.
    AngularMomentumSquare,
    /// |m_d v_d - value at point 0|, N s.
    DebrisLinearError,
    /// |m_d v_d|^2, N^2 s^2.
    DebrisLinearSquare,
    /// |C_ed J_d omega_d - value at point 0|, N m s.
    DebrisAngularError,
    /// |C_ed J_d omega_d|^2, N^2 m^2 s^2.
    DebrisAngularSquare,
    /// Largest entry of |C_es^T C_es - 1|.
    AttitudeError,
    /// Residual of the kinematic constraints.
    ResidualKinematic,
    /// Residual of the collocation constraints.
    ResidualCollocation,
    /// Residual of the attitude constraints.
    ResidualAttitude,
}

/// A series as a column of a time series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeriesColumn {
    /// The series.
    pub series: Series,
    /// Name of the column, unit last.
    pub name: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// One sentence.
    pub meaning: &'static str,
}

/// The series that a time series has as columns, in their order.
pub const PUBLISHED: &[SeriesColumn] = &{
    const fn column(series: Series, name: &'static str, unit: &'static str, meaning: &'static str) -> SeriesColumn {
        SeriesColumn { series, name, unit, meaning }
    }
    use Series::*;
    [
        column(EnergyFuselage, "energy_fuselage_j", "J", "Kinetic energy of the fuselage in F_e."),
        column(EnergyWheel1, "energy_wheel1_j", "J", "Kinetic energy of wheel 1 in F_e."),
        column(EnergyWheel2, "energy_wheel2_j", "J", "Kinetic energy of wheel 2 in F_e."),
        column(EnergyDebris, "energy_debris_j", "J", "Kinetic energy of the debris in F_e."),
        column(EnergyTotal, "energy_total_j", "J", "Total kinetic energy in F_e, debris included."),
        column(
            ComFuselage,
            "energy_com_fuselage_j",
            "J",
            "Kinetic energy of the fuselage about the spacecraft's centre of mass.",
        ),
        column(
            ComWheel1,
            "energy_com_wheel1_j",
            "J",
            "Kinetic energy of wheel 1 about the spacecraft's centre of mass.",
        ),
        column(
            ComWheel2,
            "energy_com_wheel2_j",
            "J",
            "Kinetic energy of wheel 2 about the spacecraft's centre of mass.",
        ),
        column(ComTotal, "energy_com_total_j", "J", "Kinetic energy of the spacecraft about its centre of mass."),
        column(
            EnergyError,
            "energy_error",
            "",
            "Total kinetic energy less the actuators' work, less its first value, over the largest total.",
        ),
        column(
            ComError,
            "energy_com_error",
            "",
            "Kinetic energy about the centre of mass less its first value, over the largest (no actuators).",
        ),
        column(
            LinearMomentumError,
            "linear_momentum_error",
            "",
            "Change of the spacecraft's linear momentum less impulse, over the largest.",
        ),
        column(
            AngularMomentumError,
            "angular_momentum_error",
            "",
            "Change of the spacecraft's angular momentum about its centre of mass in F_e less angular impulse, over the largest.",
        ),
        column(
            DebrisLinearError,
            "debris_linear_momentum_error",
            "",
            "Change of the debris's linear momentum, over the largest.",
        ),
        column(
            DebrisAngularError,
            "debris_angular_momentum_error",
            "",
            "Change of the debris's angular momentum about its centre in F_e, over the largest.",
        ),
        column(AttitudeError, "dcm_orthonormality", "", "Largest entry of |C_es^T C_es - 1|."),
        column(
            ResidualKinematic,
            "residual_kinematic_m_s",
            "m/s",
            "Residual of the kinematic constraints (angular components in rad/s).",
        ),
        column(
            ResidualCollocation,
            "residual_collocation_m",
            "m",
            "Residual of the collocation constraints (tilts of wheel axes as sines).",
        ),
        column(ResidualAttitude, "residual_attitude", "", "Residual of the attitude constraints."),
    ]
};

impl Series {
    /// Number of series.
    pub(super) const COUNT: usize = Series::ResidualAttitude as usize + 1;

    /// The series whose largest value is the scale of this one, with the rule how to get the scale from that value.
    pub(super) const fn scale(self) -> Option<Series> {
        match self {
            Series::EnergyError => Some(Series::EnergyTotal),
            Series::ComError => Some(Series::ComTotal),
            Series::LinearMomentumError => Some(Series::LinearMomentumSquare),
            Series::AngularMomentumError => Some(Series::AngularMomentumSquare),
            Series::DebrisLinearError => Some(Series::DebrisLinearSquare),
            Series::DebrisAngularError => Some(Series::DebrisAngularSquare),
            _ => None,
        }
    }

    /// The blocks that the series is made of, each with what it is needed for.
    pub(super) fn needs(self, request: &Request) -> Vec<(StateField, &'static str)> {
        const SPIN: [(StateField, &str); 2] =
            [(StateField::Rate, "rotation of the fuselage"), (StateField::WheelRates, "rotation of the wheels")];
        let attitude = |why| (if request.constrained { StateField::Dcm } else { StateField::Attitude }, why);
        let mut needs = Vec::new();
        match self {
            Series::EnergyFuselage | Series::EnergyWheel1 | Series::EnergyWheel2 => {
                needs.extend(SPIN);
                needs.push((StateField::ComVelocity, "energies in F_e"));
                needs.push(attitude("velocities of bodies off the centre of mass"));
                if request.constrained {
                    needs.push((StateField::KineticEnergies, "energies as the redundant states have them"));
                }
            }
            Series::EnergyDebris => {
                needs.push((StateField::DebrisVelocity, "energy of the debris"));
                needs.push((StateField::DebrisRate, "energy of the debris"));
            }
            Series::EnergyTotal | Series::EnergyError => {
                needs.extend(SPIN);
                needs.push((StateField::ComVelocity, "total energy in F_e"));
                if request.constrained {
                    needs.push((StateField::KineticEnergies, "energies as the redundant states have them"));
                }
                if request.debris {
                    needs.extend(Series::EnergyDebris.needs(request));
                }
                if request.actuated && matches!(self, Series::EnergyError) {
                    needs.push((StateField::Work, "work of the actuators"));
                }
            }
            Series::ComFuselage | Series::ComWheel1 | Series::ComWheel2 | Series::ComTotal | Series::ComError => {
                needs.extend(SPIN);
            }
            Series::LinearMomentumError | Series::LinearMomentumSquare => {
                needs.push((StateField::ComVelocity, "linear momentum"));
                if request.actuated {
                    needs.push((StateField::Impulse, "impulse of the thrusters"));
                }
            }
            Series::AngularMomentumError | Series::AngularMomentumSquare => {
                needs.extend(SPIN);
                needs.push(attitude("angular momentum in F_e"));
                if request.actuated {
                    needs.push((StateField::AngularImpulse, "angular impulse of the thrusters"));
                }
            }
            Series::DebrisLinearError | Series::DebrisLinearSquare => {
                needs.push((StateField::DebrisVelocity, "linear momentum of the debris"));
            }
            Series::DebrisAngularError | Series::DebrisAngularSquare => {
                needs.push((StateField::DebrisRate, "angular momentum of the debris"));
                needs.push((StateField::DebrisAttitude, "angular momentum of the debris in F_e"));
            }
            Series::AttitudeError => needs.push(attitude("departure from a rotation")),
            Series::ResidualKinematic | Series::ResidualCollocation | Series::ResidualAttitude => {
                needs.push((StateField::Residuals, "residuals of the constraints"));
            }
        }
        needs
    }
}
