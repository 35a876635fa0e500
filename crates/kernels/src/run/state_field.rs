//! [`StateField`]: physical quantities of a state, and sets of them.

use crate::math::enumeration::bit_set;

/// The fields, `Field: number of components;`, of a spacecraft with `wheels` wheels.
macro_rules! state_fields {
    (of $wheels:ident: $($(#[$doc:meta])* $Field:ident: $width:expr;)*) => {
        /// A field of the state: components that are present or absent together.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(usize)]
        pub enum StateField { $($(#[$doc])* $Field,)* }

        impl StateField {
            /// All fields in the order of the table.
            pub const ALL: [StateField; [$(stringify!($Field)),*].len()] = [$(StateField::$Field),*];

            /// Number of components of a spacecraft with `wheels` wheels.
            pub const fn width(self, $wheels: usize) -> usize {
                match self { $(StateField::$Field => $width,)* }
            }
        }
    };
}

state_fields! {
    of wheels:
    /// omega^se in F_s, rad/s.
    Rate: 3;
    /// Attitude quaternion q_es.
    Attitude: 4;
    /// Wheel rates relative to the body, rad/s.
    WheelRates: wheels;
    /// Wheel angles relative to the body, rad, unbounded.
    WheelAngles: wheels;
    /// Position of the centre of mass c of the spacecraft in F_e, m.
    ComPosition: 3;
    /// Velocity of c in F_e, m/s.
    ComVelocity: 3;
    /// Work since time zero, J: of thrusters and torques on the body (on an orbit of gravity on all bodies too), and of
    /// the wheel motors (relative to the body, tau_i Omega_i).
    Work: 2;
    /// Impulse of the thrusters since time zero in F_e, N s.
    Impulse: 3;
    /// Angular impulse of thrusters and torques on the body about c since time zero in F_e, N m s.
    AngularImpulse: 3;
    /// Position of the centre of the debris in F_e, m.
    DebrisPosition: 3;
    /// Velocity of the centre of the debris in F_e, m/s.
    DebrisVelocity: 3;
    /// Attitude quaternion q_ed of the debris.
    DebrisAttitude: 4;
    /// omega^de of the debris in F_d, rad/s.
    DebrisRate: 3;
    /// C_es by columns, from methods that integrate the DCM.
    Dcm: 9;
    /// Residuals of the constraints: kinematic, collocation, attitude.
    Residuals: 3;
    /// Kinetic energies of body, each wheel and debris in F_e, from methods with redundant states, J.
    KineticEnergies: 2 + wheels;
}

bit_set! {
    /// A set of fields.
    StateFields of StateField
}

impl StateFields {
    /// The union of two sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        StateFields(self.0 | other.0)
    }
}
