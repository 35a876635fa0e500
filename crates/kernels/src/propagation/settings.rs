//! [`PropagationSettings`]: method, tolerance, grid and table fields of a plan.

use super::method::Method;
use crate::dynamics::actuation::Laws;
use crate::dynamics::effects::{Effect, ForceModel};
use crate::dynamics::gyrostat::completion::components;
use crate::dynamics::gyrostat::{WITH_ANGLES, WITH_THRUST};
use crate::math::vector::norm;
use crate::ode::{Control, Integrator};
use crate::run::{Grid, StateField, StateFields};
use crate::scene::{Actuated, Scene};

/// Largest turn in an arc, over the fifth root of the tolerance, that a step of order five crosses (measured for loops
/// in orbit at 1e-9 to 1e-14).
const TURN_OF_ORDER_FIVE: f64 = 10.0;

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

    /// Settings for runs whose arcs are at most `period` seconds, if `nominal` turns as fast as any: `written`, if it
    /// is [`Method::Auto`], becomes a method of order five where one of its steps crosses an arc under changing
    /// effects.
    #[must_use]
    pub fn in_periods(self, written: Method, period: f64, nominal: &Scene) -> Self {
        let turn = norm(nominal.initial.omega_se_s) * period;
        let most = TURN_OF_ORDER_FIVE * libm::pow(self.control.tolerance.relative, 0.2);
        let is_short = written == Method::Auto && self.changes_within_arcs() && turn < most;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ode::Tolerance;
    use crate::scene::{EnvironmentInput, OrbitInput, SceneInput};

    /// Law: under `auto`, short arcs with changing torques are integrated at order five; long ones, those without such
    /// torques and those of a chosen method are not.
    #[test]
    fn short_arcs_take_steps_of_order_five() {
        let method = |written: Method, period: f64, gravity_gradient: bool| {
            let environment = EnvironmentInput { gravity_gradient, ..EnvironmentInput::DEFAULT };
            let orbit = Some(OrbitInput { semi_major_axis_m: Some(7e6), ..OrbitInput::DEFAULT });
            let mut scene =
                Scene::resolve(&SceneInput { environment, orbit, ..SceneInput::default() }).expect("a legal scene");
            scene.initial.omega_se_s = [0.01, 0.0, 0.0];
            let tolerance = Tolerance { relative: 1e-10, absolute: 1e-10 };
            let control = Control { tolerance, step: None, max_steps: 100 };
            let settings = PropagationSettings::new(written, control, Grid::uniform(1.0, 2), StateFields::NONE, &scene);
            settings.with_feedback(Actuated::ALL).in_periods(written, period, &scene).method
        };
        let of_five = Method::Gyrostat(Integrator::DormandPrince);
        assert_eq!(method(Method::Auto, 1.0, true), of_five);
        assert_eq!(method(Method::Auto, 20.0, true), Method::Auto);
        assert_eq!(method(Method::Auto, 1.0, false), Method::Auto);
        assert_eq!(method(Method::Taylor, 1.0, true), Method::Taylor);
    }
}
