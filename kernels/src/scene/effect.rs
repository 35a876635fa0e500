//! Whether a parameter exists in a scene: whether the scene has the key, and a change of it has an effect. What belongs to actuators needs
//! commands; what keys of the body replace needs none of these.

use super::input::SceneInput;
use super::parameter::{Parameter, Shape};
use super::schedule::{switches_off, switches_on};
use super::schema::{Limit, MassErrors, PartShape, WheelInput, WheelMode};
use super::table::Table;

impl Parameter {
    /// Whether `scene` has the component and a change of it has an effect.
    pub fn exists(self, scene: &SceneInput, component: usize) -> bool {
        let has = self.key.read(scene, self.instance()).is_some();
        has && self.key.acts(scene, self.instance(), component)
            && !self.is_idle_part(scene)
            && !self.is_idle_wheel(scene)
            && self.switches(scene).is_none_or(|arcs| !arcs.is_empty())
    }

    /// The commands of the schedule whose start it moves, where it is a delay of starts, or whose end, where it is one of ends; `None` where it is
    /// neither.
    pub fn switches(self, scene: &SceneInput) -> Option<Vec<usize>> {
        let is_switched = match self.facts().key {
            "switch_on_delay_s" => switches_on,
            "switch_off_delay_s" => switches_off,
            _ => return None,
        };
        let is_own = |arc: &usize| self.key.table != Table::ArcErrors || *arc == self.instance();
        Some((0..scene.actuation.len()).filter(is_own).filter(|arc| is_switched(scene, *arc)).collect())
    }

    /// Whether the length of the vector has no effect: of an attitude, an axis of a wheel, a direction of a thruster.
    pub fn has_free_length(self) -> bool {
        self.shape() == Shape::Quaternion || self.facts().limit == Limit::Direction
    }

    /// What to write so that the parameter exists in `scene`, where [`Parameter::exists`] says that it does not.
    pub fn remedy(self, scene: &SceneInput) -> &'static str {
        match self.key.table {
            Table::Part | Table::PartErrors => {
                "describe the part by that key; where keys of [body] override it, disperse those, or delete them"
            }
            Table::Wheel if self.is_idle_wheel(scene) => {
                "let the wheel turn (mode), or set body.includes_wheels = false: a locked wheel that the body includes changes nothing"
            }
            _ => self.facts().remedy,
        }
    }

    /// Whether it is of a part, and has no effect: keys of the body as a whole override all that it gives, or the part looks the same from
    /// everywhere, or is a point.
    fn is_idle_part(self, scene: &SceneInput) -> bool {
        if !matches!(self.key.table, Table::Part | Table::PartErrors) {
            return false;
        }
        let Some(part) = scene.parts.get(self.instance()) else { return false };
        let MassErrors { stretch_log, shear, center_offset_m, .. } = part.errors;
        let is_point = part.shape == PartShape::PointMass;
        let is_round = is_point || (part.shape == PartShape::Sphere && [stretch_log, shear] == [[0.0; 3]; 2]);
        // what keys of the body replace; of several parts, masses move the common centre too, and positions change the inertia
        let (body, is_single) = (&scene.body, scene.parts.len() == 1);
        let (center, inertia) = (body.center_of_mass_m.is_some(), body.has_inertia());
        let mass = if is_single { body.mass_kg.is_some() } else { body.replaces_parts() };
        match self.facts().key {
            "density_kg_m3" | "mass_kg" | "mass_scale" => mass,
            "position_m" | "center_offset_m" => center && (is_single || inertia),
            "inertia_scale" | "stretch_log" | "shear" => inertia || is_point,
            "attitude" => (inertia || is_round) && (center || center_offset_m == [0.0; 3]),
            // sizes: with a mass of its own the part has an inertia from them, and nothing else
            _ => inertia && (mass || part.mass_kg.is_some()),
        }
    }

    /// Whether it is of a wheel that does not turn and is a part of what the keys of the body describe: taken out and put in again, it has no
    /// effect.
    fn is_idle_wheel(self, scene: &SceneInput) -> bool {
        let is_locked = |wheel: &WheelInput| wheel.mode == WheelMode::Locked;
        self.key.table == Table::Wheel
            && scene.body.includes_wheels
            && scene.wheels.get(self.instance()).is_some_and(is_locked)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ActuationInput, BodyInput};

    /// Law: what the schedule never commands has no effect, and cannot be dispersed.
    #[test]
    fn actuators_that_are_never_commanded_have_no_effect() {
        let arc = ActuationInput::idle(0.0, 1.0).with_thrust(&[1.0]).with_torque(&[0.0, 1.0]);
        let scene = SceneInput::report().with_actuation(arc);
        let acts = |name| {
            let (parameter, component) = Parameter::find(&scene, name).expect("in the schema");
            parameter.exists(&scene, component.unwrap_or(0))
        };
        for name in ["thrusters.p1.thrust_scale", "thrusters.p1.tilt_rad", "wheels.w2.torque_bias_n_m"] {
            assert!(acts(name), "{name}");
        }
        for name in [
            "thrusters.p2.thrust_scale",
            "thrusters.p2.tilt_rad",
            "thrusters.p3.tilt_rad",
            "thrusters.p3.position_m",
            "wheels.w1.torque_scale",
        ] {
            assert!(!acts(name), "{name}");
        }
    }

    /// Law: what keys of the body include of a wheel that does not turn has no effect, and the remedy says so.
    #[test]
    fn a_locked_wheel_that_is_included_has_no_effect() {
        let mut scene =
            SceneInput { body: BodyInput { includes_wheels: true, ..BodyInput::DEFAULT }, ..SceneInput::report() };
        let radius = Parameter::find(&scene, "wheels.w1.radius_m").expect("in the table").0;
        assert!(radius.exists(&scene, 0) && !radius.remedy(&scene).contains("includes_wheels"));
        scene.wheels[0].mode = WheelMode::Locked;
        assert!(!radius.exists(&scene, 0) && radius.remedy(&scene).contains("includes_wheels"));
        scene.body.includes_wheels = false;
        assert!(radius.exists(&scene, 0));
    }
}
