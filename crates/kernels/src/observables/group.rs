//! [`Group`]: columns that a campaign requests by name (`[observe] groups`).

use crate::math::enumeration::bit_set;

/// The groups, each `Group: "name";`: defaults of a campaign, others by name, those of other tables.
macro_rules! groups {
    (
        default { $($(#[$default_doc:meta])* $Default:ident: $default:literal;)* }
        by_name { $($(#[$named_doc:meta])* $Named:ident: $named:literal;)* }
        others { $($(#[$other_doc:meta])* $Other:ident: $other:literal;)* }
    ) => {
        /// A group of columns.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Group {
            $($(#[$default_doc])* $Default,)*
            $($(#[$named_doc])* $Named,)*
            $($(#[$other_doc])* $Other,)*
        }

        impl Group {
            /// All groups that campaigns can name, in order of the columns.
            pub const ALL: [Group; [$($default,)* $($named),*].len()] = [$(Group::$Default,)* $(Group::$Named),*];

            /// Groups of a campaign that chooses none: [`Group::Motion`] and [`Group::Orbit`] cost about as much as a
            /// run.
            pub const DEFAULT: [Group; [$($default),*].len()] = [$(Group::$Default),*];

            /// Name in campaign files.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Group::$Default => $default,)*
                    $(Group::$Named => $named,)*
                    $(Group::$Other => $other,)*
                }
            }
        }
    };
}

groups! {
    default {
        /// Error of total kinetic energy minus work.
        EnergyConservation: "energy_conservation";
        /// Errors of linear momentum minus impulse, and of angular momentum minus angular impulse.
        MomentumConservation: "momentum_conservation";
        /// Orthonormality of the attitude, and angle of s3 from its initial direction.
        Attitude: "attitude";
        /// Residuals of the constraints.
        Constraints: "constraints";
        /// Kinetic energy of each body in F_e.
        Energies: "energies";
        /// Kinetic energy of each body about the spacecraft's centre of mass.
        EnergiesCom: "energies_com";
        /// Exchange of kinetic energy between body and wheels about the spacecraft's centre of mass.
        Exchange: "exchange";
        /// Last state.
        FinalState: "final_state";
        /// Steps and evaluations.
        StepStatistics: "effort";
        /// Estimated error of the rotational state, and amplification of errors.
        Numerics: "numerics";
    }
    by_name {
        /// Angular rate, nutation, attitude relative to the nominal run, wheels, direction of the debris.
        Motion: "motion";
        /// Mass, centre of mass and principal moments of inertia of the spacecraft.
        MassProperties: "mass_properties";
        /// Distance from the central body, pointing relative to nadir, torques of the environment.
        Orbit: "orbit";
    }
    others {
        /// Columns of the campaign's control law.
        Control: "control";
        /// Times of events and failures.
        Events: "events";
    }
}

impl Group {
    /// The group called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|group| group.name() == name)
    }
}

bit_set! {
    /// A set of groups.
    Groups of Group
}

impl Groups {
    /// Every group.
    pub const ALL: Groups = Groups((1 << Group::ALL.len()) - 1);
}

impl FromIterator<Group> for Groups {
    fn from_iter<I: IntoIterator<Item = Group>>(groups: I) -> Self {
        groups.into_iter().fold(Groups::NONE, Groups::with)
    }
}
