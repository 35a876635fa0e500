//! [`Group`]: columns that a campaign requests by name (`[observe] groups = [...]`).

/// The list of groups, `Group: "name";` each: those of a campaign without a choice, those only by name, those not by
/// name.
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
            /// All groups that a campaign can name, in order of the columns.
            pub const ALL: [Group; [$($default,)* $($named),*].len()] = [$(Group::$Default,)* $(Group::$Named),*];

            /// Groups of a campaign without a choice. [`Group::Motion`] and [`Group::Orbit`] cost about as much as a
            /// run; [`Group::MassProperties`] follow from the dispersed values.
            pub const DEFAULT: [Group; [$($default),*].len()] = [$(Group::$Default),*];

            /// The name in campaign files.
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
        /// Error of total kinetic energy minus the work of the actuators.
        EnergyConservation: "energy_conservation";
        /// Errors of linear momentum minus impulse and of angular momentum about the centre of mass minus angular
        /// impulse.
        MomentumConservation: "momentum_conservation";
        /// Orthonormality of the attitude, and the angle of s3 from its initial direction.
        Attitude: "attitude";
        /// Residuals of the constraints, for kernels with constraints.
        Constraints: "constraints";
        /// Kinetic energy of each body in F_e.
        Energies: "energies";
        /// Kinetic energy of each body about the spacecraft's centre of mass, independent of the frame.
        EnergiesCom: "energies_com";
        /// Exchange of kinetic energy between body and wheels, about the spacecraft's centre of mass.
        Exchange: "exchange";
        /// The last state.
        FinalState: "final_state";
        /// Steps and evaluations.
        StepStatistics: "effort";
        /// Estimated error of the rotational state, and amplification of errors.
        Numerics: "numerics";
    }
    by_name {
        /// Angular rate, nutation, attitude relative to the nominal run, wheel speeds and momenta, direction of the
        /// debris.
        Motion: "motion";
        /// Mass, centre of mass and principal moments of inertia of the spacecraft, as dispersed.
        MassProperties: "mass_properties";
        /// Distance from the central body, angle of s3 from nadir, torque of the gravity gradient.
        Orbit: "orbit";
    }
    others {
        /// Columns reported by the campaign's control law, if any.
        Control: "control";
        /// Times of events and failures, if the file has such tables.
        Events: "events";
    }
}

impl Group {
    /// The group called `name`.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|group| group.name() == name)
    }
}

/// A set of groups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Groups(u16);

impl Groups {
    /// No group.
    pub const NONE: Groups = Groups(0);

    /// Every group.
    pub const ALL: Groups = Groups((1 << Group::ALL.len()) - 1);

    /// This set and `group`.
    #[must_use]
    pub const fn with(self, group: Group) -> Self {
        Groups(self.0 | 1 << group as u16)
    }

    /// True if the set contains `group`.
    pub const fn contains(self, group: Group) -> bool {
        self.0 & (1 << group as u16) != 0
    }
}

impl FromIterator<Group> for Groups {
    fn from_iter<I: IntoIterator<Item = Group>>(groups: I) -> Self {
        groups.into_iter().fold(Groups::NONE, Groups::with)
    }
}
