//! [`Magnitude`]: the single number that describes a vector or an attitude: the length of a rate or an alignment error,
//! the angle of an attitude from the nominal one.

use crate::math::vector::{conjugate, hamilton, norm};
use crate::scene::parameter::{Parameter, Shape};
use crate::scene::{SceneInput, unit_quaternion::unit_quaternion};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Magnitude {
    pub parameter: Parameter,
}

impl Magnitude {
    /// `None` for a parameter that is not an angular velocity, an alignment error, or an attitude.
    pub fn of(parameter: Parameter) -> Option<Self> {
        let is_vector = ["rad/s", "rad"].contains(&parameter.unit()) && parameter.width() > 1;
        (is_vector || parameter.shape() == Shape::Quaternion).then_some(Magnitude { parameter })
    }

    pub fn name(self) -> String {
        let name = self.parameter.name();
        match self.parameter.shape() {
            Shape::Quaternion => format!("{name}, angle from nominal"),
            _ => format!("|{name}|"),
        }
    }

    /// Its SI unit.
    pub fn unit(self) -> &'static str {
        if self.parameter.shape() == Shape::Quaternion { "rad" } else { self.parameter.unit() }
    }

    /// Its value in `scene`, SI; NaN if the scene lacks the parameter. The angle is 2 atan2(|v|, |w|) of q_0* (x) q =
    /// (w, v), accurate for small angles.
    pub fn value(self, scene: &SceneInput, nominal: &SceneInput) -> f64 {
        let read = |scene: &SceneInput, component| self.parameter.value(scene, component).unwrap_or(f64::NAN);
        if self.parameter.shape() == Shape::Quaternion {
            let attitude = |scene| unit_quaternion(std::array::from_fn(|component| read(scene, component)));
            let [w, x, y, z] = hamilton(conjugate(attitude(nominal)), attitude(scene));
            2.0 * libm::atan2(norm([x, y, z]), w.abs())
        } else {
            (0..self.parameter.width()).map(|component| read(scene, component)).fold(0.0, libm::hypot)
        }
    }
}
