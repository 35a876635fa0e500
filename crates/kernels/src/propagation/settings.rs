//! [`PropagationSettings`]: method, tolerance, grid and table fields of a plan.

use super::method::Method;
use crate::dynamics::actuation::Laws;
use crate::dynamics::effects::{Effect, ForceModel};
use crate::dynamics::gyrostat::completion::components;
use crate::dynamics::gyrostat::{WITH_ANGLES, WITH_THRUST};
use crate::ode::{Control, Integrator};
use crate::run::{Grid, StateField, StateFields};
use crate::scene::{Actuated, Scene};

/// Integration settings common to a campaign's runs.
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
    /// The acting effects.
    pub forces: ForceModel,
    /// True if thrust or body torque may act.
    pub thrust: bool,
    /// True if motor torque may act.
    pub motors: bool,
    /// True if runs may have laws of their own ([`super::Engine::propagate_under`]).
    pub feedback: bool,
}

impl PropagationSettings {
    /// Settings for scenes like `nominal`, of any magnitudes.
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

    /// Settings for runs under laws that command `commands` beside the schedules; a law observes the whole state.
    #[must_use]
    pub fn with_feedback(self, commands: Actuated) -> Self {
        let thrust = self.thrust || commands.external();
        // an arc is one short step, for which the field's Taylor series costs more than its evaluations
        let is_slow = self.method == Method::Auto && self.forces.contains(Effect::MagneticTorque);
        let method = if is_slow { Method::Gyrostat(Integrator::Dop853) } else { self.method };
        PropagationSettings { method, thrust, motors: self.motors || commands.motors, feedback: true, ..self }
    }

    /// Settings for runs that turn by at most `turn` rad in an arc: `written`, if it is [`Method::Auto`], becomes a
    /// method of order five under changing effects if the fifth power of `turn` is below the tolerance: one of its
    /// steps crosses the arc, with a fraction of the tolerance as error.
    #[must_use]
    pub fn turning_by(self, written: Method, turn: f64) -> Self {
        let is_short = written == Method::Auto
            && self.changes_within_arcs()
            && turn < libm::pow(self.control.tolerance.relative, 0.2);
        let method = if is_short { Method::Gyrostat(Integrator::DormandPrince) } else { self.method };
        PropagationSettings { method, ..self }
    }

    /// # Panics
    /// If runs of these settings cannot be flown under `laws`.
    pub(super) fn check_laws(&self, laws: &Laws<'_>) {
        assert!(self.feedback || matches!(laws, Laws::OpenLoop), "laws need PropagationSettings::with_feedback");
    }

    /// [`ForceModel::changes_within_arcs`].
    pub fn changes_within_arcs(&self) -> bool {
        self.forces.changes_within_arcs()
    }

    /// Number of components integrated by the gyrostat kernel.
    pub fn components(&self) -> usize {
        let needed = components(|field| self.fields.contains(field), self.thrust, self.motors);
        match (self.feedback, self.thrust) {
            (false, _) => needed,
            (true, true) => WITH_THRUST,
            // attitude and wheel angles
            (true, false) => needed.max(WITH_ANGLES),
        }
    }
}

/// True if the fields need the rotation of the debris.
pub fn observes_debris_rotation(fields: StateFields) -> bool {
    fields.contains(StateField::DebrisRate) || fields.contains(StateField::DebrisAttitude)
}
