//! [`Magnitude`]: the one number by which a person judges a vector or an attitude: the length of a rate or of an alignment error, the angle
//! of an attitude from the nominal one.

use super::input::SceneInput;
use super::parameter::{Parameter, Shape};
use super::unit_quaternion::unit_quaternion;
use crate::math::vector::{conjugate, hamilton, norm};

/// A number that follows from all components of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Magnitude {
    /// The parameter.
    pub parameter: Parameter,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The Euclidean norm.
    Norm,
    /// The angle of the rotation from the nominal attitude, 0 to pi.
    Angle,
}

impl Magnitude {
    /// That of `parameter`; `None` of one that is not an angular velocity, an alignment error, or an attitude.
    pub fn of(parameter: Parameter) -> Option<Self> {
        let facts = parameter.facts();
        let kind = match (facts.shape, facts.unit) {
            (Shape::Quaternion, _) => Kind::Angle,
            (Shape::Plain, "rad/s" | "rad") if parameter.width() > 1 => Kind::Norm,
            _ => return None,
        };
        Some(Magnitude { parameter, kind })
    }

    /// What it is called in tables.
    pub fn name(self) -> String {
        let name = self.parameter.name();
        match self.kind {
            Kind::Norm => format!("|{name}|"),
            Kind::Angle => format!("{name}: angle from nominal (rad)"),
        }
    }

    /// Its value in `scene`, SI, where `nominal` is the nominal scene; NaN where a scene has no such key. The angle is
    /// 2 atan2(|v|, |w|) of q_0* (x) q = (w, v), which loses no digits of a small one.
    pub fn value(self, scene: &SceneInput, nominal: &SceneInput) -> f64 {
        let read = |scene: &SceneInput, component| self.parameter.value(scene, component).unwrap_or(f64::NAN);
        match self.kind {
            Kind::Norm => {
                let values = || (0..self.parameter.width()).map(|component| read(scene, component));
                let norm = |scale: f64| scale * values().map(|x| (x / scale) * (x / scale)).sum::<f64>().sqrt();
                let plain = norm(1.0);
                let largest = values().map(f64::abs).fold(0.0, f64::max);
                // squares may overflow where the length does not
                if plain == f64::INFINITY && largest.is_finite() { norm(largest) } else { plain }
            }
            Kind::Angle => {
                let attitude =
                    |scene: &SceneInput| unit_quaternion(std::array::from_fn(|component| read(scene, component)));
                let [w, x, y, z] = hamilton(conjugate(attitude(nominal)), attitude(scene));
                2.0 * libm::atan2(norm([x, y, z]), w.abs())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn magnitude(scene: &SceneInput, name: &str) -> Option<Magnitude> {
        Magnitude::of(Parameter::find(scene, name).expect("a parameter").0)
    }

    /// Law: rates and alignment errors have their length, attitudes the angle between them, whatever the sign of the quaternion.
    #[test]
    fn magnitudes_are_lengths_and_angles() {
        let nominal = SceneInput::report().with("initial.attitude", &[0.6, 0.0, 0.8, 0.0]);
        let rate = magnitude(&nominal, "initial.angular_velocity_rad_s").expect("a rate");
        let scene = nominal.clone().with("initial.angular_velocity_rad_s", &[2.0, -3.0, 6.0]);
        assert_eq!((rate.value(&scene, &nominal), rate.value(&nominal, &nominal)), (7.0, 0.0));
        let large = nominal.clone().with("initial.angular_velocity_rad_s", &[3e200, 0.0, -4e200]);
        assert!((rate.value(&large, &nominal) / 5e200 - 1.0).abs() < 1e-15);
        let tilt = magnitude(&nominal, "wheels.w1.tilt_rad").expect("an alignment error");
        assert_eq!(tilt.value(&nominal.clone().with("wheels.w1.tilt_rad", &[0.3, 0.4]), &nominal), 0.5);
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
