//! [`StateField`]: physical quantities of a state, and sets of them.

/// A field of the state: components that are present or absent together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(usize)]
pub enum StateField {
    /// omega^se in F_s, rad/s (3).
    Rate,
    /// Attitude quaternion q_es (4).
    Attitude,
    /// Wheel rates relative to the body, rad/s (one per wheel).
    WheelRates,
    /// Wheel angles relative to the body, rad, unbounded (one per wheel).
    WheelAngles,
    /// Position of the centre of mass c of the spacecraft in F_e, m (3).
    ComPosition,
    /// Velocity of c in F_e, m/s (3).
    ComVelocity,
    /// Work since time zero, J (2): of thrusters and torques on the body (on an orbit of gravity on all bodies too),
    /// and of the wheel motors (relative to the body, tau_i Omega_i).
    Work,
    /// Impulse of the thrusters since time zero in F_e, N s (3).
    Impulse,
    /// Angular impulse of thrusters and torques on the body about c since time zero in F_e, N m s (3).
    AngularImpulse,
    /// Position of the centre of the debris in F_e, m (3).
    DebrisPosition,
    /// Velocity of the centre of the debris in F_e, m/s (3).
    DebrisVelocity,
    /// Attitude quaternion q_ed of the debris (4).
    DebrisAttitude,
    /// omega^de of the debris in F_d, rad/s (3).
    DebrisRate,
    /// C_es by columns, from methods that integrate the DCM (9).
    Dcm,
    /// Residuals of the constraints: kinematic, collocation, attitude (3).
    Residuals,
    /// Kinetic energies of body, each wheel and debris in F_e, from methods with redundant states, J (2 and one per
    /// wheel).
    KineticEnergies,
}

impl StateField {
    /// All fields in the order of the table.
    pub const ALL: [StateField; 16] = [
        StateField::Rate,
        StateField::Attitude,
        StateField::WheelRates,
        StateField::WheelAngles,
        StateField::ComPosition,
        StateField::ComVelocity,
        StateField::Work,
        StateField::Impulse,
        StateField::AngularImpulse,
        StateField::DebrisPosition,
        StateField::DebrisVelocity,
        StateField::DebrisAttitude,
        StateField::DebrisRate,
        StateField::Dcm,
        StateField::Residuals,
        StateField::KineticEnergies,
    ];

    /// Number of components of a spacecraft with `wheels` wheels.
    pub const fn width(self, wheels: usize) -> usize {
        match self {
            StateField::Rate
            | StateField::ComPosition
            | StateField::ComVelocity
            | StateField::Impulse
            | StateField::AngularImpulse
            | StateField::DebrisPosition
            | StateField::DebrisVelocity
            | StateField::DebrisRate
            | StateField::Residuals => 3,
            StateField::Attitude | StateField::DebrisAttitude => 4,
            StateField::KineticEnergies => 2 + wheels,
            StateField::WheelRates | StateField::WheelAngles => wheels,
            StateField::Work => 2,
            StateField::Dcm => 9,
        }
    }
}

/// A set of fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct StateFields(u32);

impl StateFields {
    /// The empty set.
    pub const NONE: StateFields = StateFields(0);

    /// This set and `field`.
    #[must_use]
    pub const fn with(self, field: StateField) -> Self {
        StateFields(self.0 | 1 << field as usize)
    }

    /// The union of two sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        StateFields(self.0 | other.0)
    }

    /// True if the set contains `field`.
    pub const fn contains(self, field: StateField) -> bool {
        self.0 & (1 << field as usize) != 0
    }
}
