//! [`PropagationSettings`]: what is decided once per plan: method, tolerance, grid, and which fields the tables have.

use super::method::Method;
use crate::dynamics::actuation::Laws;
use crate::dynamics::effects::ForceModel;
use crate::dynamics::gyrostat::completion::components;
use crate::dynamics::gyrostat::{WITH_ANGLES, WITH_THRUST};
use crate::ode::Control;
use crate::run::{Grid, StateField, StateFields};
use crate::scene::{Actuated, Scene};

/// What a campaign's runs have in common: how they are integrated and what is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct PropagationSettings {
    /// Kernel and method.
    pub method: Method,
    /// Tolerances and limits.
    pub control: Control,
    /// Observation times.
    pub grid: Grid,
    /// The fields of the tables.
    pub fields: StateFields,
    /// Number of wheels of the spacecraft.
    pub wheels: usize,
    /// The effects that act.
    pub forces: ForceModel,
    /// Whether thrust or body torque may act.
    pub thrust: bool,
    /// Whether motor torque may act.
    pub motors: bool,
    /// Whether runs may have laws of their own ([`super::Engine::propagate_under`]): then all components are
    /// integrated.
    pub feedback: bool,
}

impl PropagationSettings {
    /// Settings for scenes with the schedule of `nominal` (the magnitudes may differ from run to run).
    pub fn new(method: Method, control: Control, grid: Grid, fields: StateFields, nominal: &Scene) -> Self {
        let forces = ForceModel::of(nominal);
        PropagationSettings {
            method: method.chosen(forces),
            control,
            grid,
            fields,
            wheels: nominal.mass.wheels.len(),
            forces,
            thrust: nominal.commands_thrust || nominal.environment.acts(),
            motors: nominal.commands_torque,
            feedback: false,
        }
    }

    /// The same settings for runs that have laws of their own, which command `commands` in addition to the schedules. A
    /// law sees the whole state; integrals of thrust are made only where thrust or a torque on the body may act.
    #[must_use]
    pub fn with_feedback(self, commands: Actuated) -> Self {
        let thrust = self.thrust || commands.external();
        PropagationSettings { thrust, motors: self.motors || commands.motors, feedback: true, ..self }
    }

    /// Checks that runs of these settings can be flown under `laws`.
    ///
    /// # Panics
    /// Where they cannot.
    pub(super) fn check_laws(&self, laws: &Laws<'_>) {
        assert!(self.feedback || matches!(laws, Laws::OpenLoop), "laws need PropagationSettings::with_feedback");
    }

    /// Whether an effect changes within an arc, so that the kernel has it.
    pub fn changes_within_arcs(&self) -> bool {
        self.forces.changes_within_arcs()
    }

    /// Number of components that the gyrostat kernel integrates.
    pub fn components(&self) -> usize {
        let needed = components(|field| self.fields.contains(field), self.thrust, self.motors);
        match (self.feedback, self.thrust) {
            (false, _) => needed,
            (true, true) => WITH_THRUST,
            // attitude, and the angles of the wheels
            (true, false) => needed.max(WITH_ANGLES),
        }
    }
}

/// Whether the fields need the rotation of the debris.
pub fn observes_debris_rotation(fields: StateFields) -> bool {
    fields.contains(StateField::DebrisRate) || fields.contains(StateField::DebrisAttitude)
}
