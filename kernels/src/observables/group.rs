//! [`Group`]: columns that a campaign requests by name (`[observe] groups = [...]`).

/// A group of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// Error of total kinetic energy minus the work of the actuators.
    EnergyConservation,
    /// Errors of linear momentum minus impulse and of angular momentum about the centre of mass minus angular impulse.
    MomentumConservation,
    /// Orthonormality of the attitude, and the angle of s3 from its initial direction.
    Attitude,
    /// Residuals of the constraints, for kernels with constraints.
    Constraints,
    /// Kinetic energy of each body in F_e.
    Energies,
    /// Kinetic energy of each body about the spacecraft's centre of mass, independent of the frame.
    EnergiesCom,
    /// Exchange of kinetic energy between body and wheels, about the spacecraft's centre of mass.
    Exchange,
    /// The last state.
    FinalState,
    /// Steps and evaluations.
    StepStatistics,
    /// Estimated error of the rotational state, and amplification of errors.
    Numerics,
    /// Angular rate, nutation, attitude relative to the nominal run, wheel speeds and momenta, direction of the debris.
    /// Only by name.
    Motion,
    /// Mass, centre of mass and principal moments of inertia of the spacecraft, as dispersed. Only by name.
    MassProperties,
    /// Distance from the central body, angle of s3 from nadir, torque of the gravity gradient. Only by name.
    Orbit,
    /// Columns reported by the campaign's control law, if any; not by name.
    Control,
    /// Times of events and failures, if the file has such tables; not by name.
    Events,
}

impl Group {
    /// All groups that a campaign can name, in order of the columns.
    pub const ALL: [Group; 13] = [
        Group::EnergyConservation,
        Group::MomentumConservation,
        Group::Attitude,
        Group::Constraints,
        Group::Energies,
        Group::EnergiesCom,
        Group::Exchange,
        Group::FinalState,
        Group::StepStatistics,
        Group::Numerics,
        Group::Motion,
        Group::MassProperties,
        Group::Orbit,
    ];

    /// Groups of a campaign without a choice: all but [`Group::Motion`] and [`Group::Orbit`], whose angles cost about
    /// as much as a run, and [`Group::MassProperties`], which follow from the dispersed values.
    pub const DEFAULT: [Group; 10] = {
        let [a, b, c, d, e, f, g, h, i, j, Group::Motion, Group::MassProperties, Group::Orbit] = Group::ALL else {
            panic!("the groups that a campaign must name are the last ones")
        };
        [a, b, c, d, e, f, g, h, i, j]
    };

    /// The name in campaign files.
    pub const fn name(self) -> &'static str {
        match self {
            Group::EnergyConservation => "energy_conservation",
            Group::MomentumConservation => "momentum_conservation",
            Group::Attitude => "attitude",
            Group::Constraints => "constraints",
            Group::Energies => "energies",
            Group::EnergiesCom => "energies_com",
            Group::Exchange => "exchange",
            Group::FinalState => "final_state",
            Group::StepStatistics => "effort",
            Group::Numerics => "numerics",
            Group::Motion => "motion",
            Group::MassProperties => "mass_properties",
            Group::Orbit => "orbit",
            Group::Control => "control",
            Group::Events => "events",
        }
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_groups_map_one_to_one() {
        for group in Group::ALL {
            assert_eq!(Group::from_name(group.name()), Some(group));
        }
        assert_eq!(Group::from_name("energy"), None);
    }

    #[test]
    fn a_set_contains_what_was_added_and_nothing_else() {
        let some: Groups = [Group::Exchange, Group::StepStatistics].into_iter().collect();
        for group in Group::ALL {
            assert_eq!(some.contains(group), matches!(group, Group::Exchange | Group::StepStatistics));
            assert!(Groups::ALL.contains(group));
            assert!(!Groups::NONE.contains(group));
        }
    }
}
