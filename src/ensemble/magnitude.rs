//! [`Magnitude`]: the single number that describes a vector or an attitude: the length of a rate or an alignment error,
//! the angle of an attitude from the nominal one.

use crate::math::vector::{conjugate, hamilton, norm};
use crate::scene::parameter::{Parameter, Shape};
use crate::scene::{SceneInput, unit_quaternion::unit_quaternion};

/// The magnitude of a parameter.
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

    /// Its name in tables.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: the magnitude is the length of a rate or an alignment error, the angle between attitudes, whatever the sign
    /// of the quaternion.
    #[test]
    fn magnitudes_are_lengths_and_angles() {
        let magnitude = |scene: &SceneInput, name: &str| Magnitude::of(Parameter::find(scene, name).expect(name).0);
        let nominal = SceneInput::report().with("initial.attitude", &[0.6, 0.0, 0.8, 0.0]);
        let rate = magnitude(&nominal, "initial.angular_velocity_rad_s").expect("a rate");
        for scale in [1.0, 1e200] {
            let scene = nominal.clone().with("initial.angular_velocity_rad_s", &[2.0, -3.0, 6.0].map(|x| x * scale));
            assert!((rate.value(&scene, &nominal) / (7.0 * scale) - 1.0).abs() < 1e-15);
        }
        let attitude = magnitude(&nominal, "initial.attitude").expect("an attitude");
        for angle in [1e-9, 0.5, 3.0] {
            let (sine, cosine) = libm::sincos(0.5 * angle);
            let turned = hamilton([0.6, 0.0, 0.8, 0.0], [cosine, 0.0, sine, 0.0]);
            for sign in [1.0, -1.0] {
                let scene = nominal.clone().with("initial.attitude", &turned.map(|x| sign * x));
                // some roundings of numbers of size one; measured: 2.3e-16
                assert!((attitude.value(&scene, &nominal) - angle).abs() < 1e-15, "{angle}");
            }
        }
        for without in ["initial.position_m", "wheels.w1.rate_rad_s", "body.parts.fuselage.length_m"] {
            assert_eq!(magnitude(&nominal, without), None, "{without}");
        }
    }
}
