//! [`GeometricLaw`]: laws of a vector's direction and of an attitude as written, and their way to a [`Joint`].

use super::distribution::Distribution;
use super::geometric::{AboutAxis, AttitudeError, DirectionLaw, DirectionSpread};
use super::joint::Joint;
use super::law::{Dispersion, DispersionError, Law, Values, error};
use super::scalar::distributions;
use crate::math::vector::norm;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};

/// A law of all components of a vector, or of an attitude, together.
#[derive(Clone, Debug, PartialEq)]
pub enum GeometricLaw {
    /// Direction and magnitude of a vector apart.
    Direction {
        /// How the direction lies about the axis.
        spread: DirectionSpread,
        /// The axis, of any length; where it is not written, the nominal vector.
        axis: Option<[f64; 3]>,
        /// The law of the magnitude; where it is not written, the nominal's.
        magnitude: Option<Box<Law>>,
    },
    /// A normal rotation vector from the nominal attitude, in the frame of the body.
    AttitudeError(AttitudeSpread),
    /// A rotation from the nominal attitude about an axis of the body.
    AboutAxis {
        /// The axis, of any length.
        axis: [f64; 3],
        /// The law of the angle, rad; its nominal is 0.
        angle: Box<Law>,
    },
}

/// The covariance of a rotation vector.
#[derive(Clone, Debug, PartialEq)]
pub enum AttitudeSpread {
    /// Independent components with these standard deviations, rad (`std_rad`).
    Std(Values),
    /// A covariance matrix, rad^2, by rows (`covariance_rad2`).
    Covariance([[f64; 3]; 3]),
}

impl GeometricLaw {
    /// The name in campaign files.
    pub fn name(&self) -> &'static str {
        match self {
            GeometricLaw::Direction { spread: DirectionSpread::Sphere, .. } => "uniform_direction",
            GeometricLaw::Direction { spread: DirectionSpread::Cone { .. }, .. } => "cone",
            GeometricLaw::Direction { spread: DirectionSpread::Fisher { .. }, .. } => "von_mises_fisher",
            GeometricLaw::AttitudeError(_) => "attitude_error",
            GeometricLaw::AboutAxis { .. } => "about_axis",
        }
    }

    /// The map to be drawn, for dispersion `index` of a file about the `nominal` scene.
    ///
    /// # Errors
    /// What is wrong with target or numbers.
    pub(super) fn joint(
        &self,
        index: usize,
        dispersion: &Dispersion,
        nominal: &SceneInput,
    ) -> Result<Joint, DispersionError> {
        self.check_target(index, dispersion)?;
        let parameter = dispersion.parameter;
        let value = |component: usize| parameter.value(nominal, component).unwrap_or(f64::NAN);
        let refused = |key, value: String, allowed: &str, remedy: &str| Err(error(index, key, value, allowed, remedy));
        match self {
            GeometricLaw::Direction { spread, axis, magnitude } => {
                let nominal = [value(0), value(1), value(2)];
                let length = norm(nominal);
                if let DirectionSpread::Cone { half_angle_rad } = spread
                    && !(f64::MIN_POSITIVE..=core::f64::consts::PI).contains(half_angle_rad)
                {
                    let allowed = "above 0 and at most pi";
                    return refused(
                        "half_angle_rad",
                        format!("{half_angle_rad:?}"),
                        allowed,
                        "write an angle in radians",
                    );
                }
                if let DirectionSpread::Fisher { concentration } = spread
                    && !(f64::MIN_POSITIVE..=f64::MAX).contains(concentration)
                {
                    let remedy = "1/sigma^2 of a narrow law: 100 spreads about 0.1 rad each way";
                    return refused("concentration", format!("{concentration:?}"), "above 0", remedy);
                }
                let axis = match axis {
                    Some(axis) if norm(*axis) != 0.0 => *axis,
                    None if length > 0.0 => nominal,
                    None if *spread == DirectionSpread::Sphere => [0.0, 0.0, 1.0],
                    Some(axis) => {
                        return refused(
                            "axis",
                            format!("{axis:?}"),
                            "a vector other than zero",
                            "write it like [0, 0, 1]",
                        );
                    }
                    None => {
                        let allowed = "given where the nominal vector is zero and has no direction";
                        return refused("axis", "nothing".to_owned(), allowed, "add axis = [0, 0, 1]");
                    }
                };
                if magnitude.is_none() && length == 0.0 {
                    let allowed = "given where the nominal vector is zero: every direction of it would be zero";
                    let remedy = "add magnitude = { distribution = \"uniform\", min = 0, max = 1 }";
                    return refused("magnitude", "nothing".to_owned(), allowed, remedy);
                }
                let magnitude = match magnitude {
                    Some(law) => nested(index, "magnitude", law, length)?,
                    None => Distribution::Fixed(length),
                };
                Ok(Joint::Direction(DirectionLaw::new(axis, *spread, magnitude)))
            }
            GeometricLaw::AttitudeError(spread) => {
                let (key, shown, covariance) = match spread {
                    AttitudeSpread::Std(values) => ("std_rad", format!("{values:?}"), variances(index, values)?),
                    AttitudeSpread::Covariance(covariance) => {
                        ("covariance_rad2", format!("{covariance:?}"), *covariance)
                    }
                };
                let nominal = [value(0), value(1), value(2), value(3)];
                match AttitudeError::new(nominal, covariance) {
                    Some(law) => Ok(Joint::AttitudeError(law)),
                    None => refused(
                        key,
                        shown,
                        "symmetric and positive semidefinite",
                        "variances on the diagonal; |c_ij| at most the root of c_ii c_jj",
                    ),
                }
            }
            GeometricLaw::AboutAxis { axis, angle } => {
                if norm(*axis) == 0.0 {
                    return refused("axis", format!("{axis:?}"), "a vector other than zero", "write it like [0, 0, 1]");
                }
                let nominal = [value(0), value(1), value(2), value(3)];
                Ok(Joint::AboutAxis(AboutAxis::new(nominal, *axis, nested(index, "angle_rad", angle, 0.0)?)))
            }
        }
    }

    /// That the law is written for a vector, or for an attitude, as a whole.
    fn check_target(&self, index: usize, dispersion: &Dispersion) -> Result<(), DispersionError> {
        let parameter = dispersion.parameter;
        let is_direction = matches!(self, GeometricLaw::Direction { .. });
        let fits = if is_direction { is_vector(parameter) } else { parameter.shape() == Shape::Quaternion };
        if fits && dispersion.component.is_none() {
            return Ok(());
        }
        let name = dispersion.component.map_or(parameter.name().to_owned(), |c| parameter.component_name(c));
        let (what, example) = if is_direction {
            ("a vector (x, y, z)", "initial.angular_velocity_rad_s")
        } else {
            ("an attitude (w, x, y, z)", "initial.attitude")
        };
        let allowed = format!("{what} as a whole with distribution {:?}", self.name());
        Err(error(
            index,
            "parameter",
            format!("{name:?}"),
            allowed,
            format!("write {example:?}, or choose another law"),
        ))
    }
}

/// Whether the components of a parameter are those of a vector in space.
fn is_vector(parameter: Parameter) -> bool {
    parameter.shape() == Shape::Plain && parameter.components() == ["x", "y", "z"] && parameter.unit() != "1"
}

/// A diagonal covariance.
fn variances(index: usize, values: &Values) -> Result<[[f64; 3]; 3], DispersionError> {
    let list = match values {
        Values::All(value) => [*value; 3],
        Values::Each(list) => match <[f64; 3]>::try_from(list.as_slice()) {
            Ok(list) => list,
            Err(_) => {
                let remedy = "give one for each axis of the body";
                return Err(error(index, "std_rad", format!("{list:?}"), "1 number, or 3 in an array", remedy));
            }
        },
    };
    if let Some(x) = list.iter().find(|x| !(0.0..=f64::MAX).contains(*x)) {
        return Err(error(index, "std_rad", format!("{x:?}"), ">= 0", "drop the minus sign"));
    }
    let [a, b, c] = list.map(|x| x * x);
    Ok([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]])
}

/// The law of one number that stands within another law, under `key`.
fn nested(index: usize, key: &'static str, law: &Law, nominal: f64) -> Result<Distribution, DispersionError> {
    let laws = distributions(index, law, &[nominal]).map_err(|inner| {
        error(index, key, format!("{{ {} = {} }}", inner.key, inner.value), inner.allowed, inner.remedy)
    })?;
    match laws.and_then(|laws| laws.into_iter().next()) {
        Some(law) => Ok(law),
        None => Err(error(index, key, format!("{law:?}"), "a law of one number", "choose \"normal\" or \"uniform\"")),
    }
}
