//! [`Target`]: the components that a distribution is for, and the checks that distributions share; [`JointTarget`], the same for
//! distributions of several numbers together.

use crate::sampling::error::{DispersionError, error};
use crate::sampling::keys::Values;
use crate::scene::Parameter;
use crate::scene::parameter::Shape;
use crate::scene::schema::Limit;

/// The nominal values of the components that a distribution is for.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Which `[[disperse]]` table, counted from zero.
    pub index: usize,
    /// One value for each component.
    pub nominals: &'a [f64],
}

pub(super) type Numbers = Result<Vec<f64>, DispersionError>;

impl Target<'_> {
    /// An error of this target.
    pub(super) fn refused<T>(
        &self,
        key: &'static str,
        value: String,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Result<T, DispersionError> {
        Err(error(self.index, key, value, allowed, remedy))
    }

    /// One value for each component.
    pub(super) fn all<T>(&self, of: impl Fn(usize) -> Result<T, DispersionError>) -> Result<Vec<T>, DispersionError> {
        (0..self.nominals.len()).map(of).collect()
    }

    /// One number for each component, or what is wrong.
    pub(super) fn each(&self, key: &'static str, values: &Values) -> Numbers {
        let width = self.nominals.len();
        let list = match values {
            Values::All(value) => vec![*value; width],
            Values::Each(list) if list.len() == width => list.clone(),
            Values::Each(list) => {
                let parts =
                    if width == 1 { "1 number".to_owned() } else { format!("1 number, or {width} in an array") };
                return self.refused(key, format!("{list:?}"), parts, "give one for each component");
            }
        };
        match list.iter().find(|x| !x.is_finite()) {
            Some(x) => self.refused(key, x.to_string(), "finite", "write a finite number"),
            None => Ok(list),
        }
    }

    /// The same, of numbers that pass a test.
    pub(super) fn passing(
        &self,
        key: &'static str,
        values: &Values,
        test: impl Fn(f64) -> bool,
        allowed: &str,
        remedy: &str,
    ) -> Numbers {
        let list = self.each(key, values)?;
        match list.iter().find(|x| !test(**x)) {
            Some(x) => self.refused(key, format!("{x:?}"), allowed, remedy),
            None => Ok(list),
        }
    }

    /// The written values, else `default` for each.
    pub(super) fn each_or(&self, key: &'static str, values: &Option<Values>, default: f64) -> Numbers {
        values.as_ref().map_or_else(|| Ok(vec![default; self.nominals.len()]), |values| self.each(key, values))
    }

    /// Scales in the parameter's unit: above zero, each.
    pub(super) fn scales(&self, key: &'static str, values: &Values) -> Numbers {
        self.passing(key, values, |x| x > 0.0, "> 0", "write it in the parameter's unit")
    }

    /// Zero or above, each.
    pub(super) fn not_negative(&self, key: &'static str, values: &Values) -> Numbers {
        self.passing(key, values, |x| x >= 0.0, ">= 0", "drop the minus sign")
    }

    /// Above zero, each.
    pub(super) fn positive(&self, key: &'static str, values: &Values) -> Numbers {
        self.passing(key, values, |x| x > 0.0, "> 0", "a logarithm needs a positive number")
    }

    /// The written values, else the nominals, all above zero.
    pub(super) fn positive_or_nominal(&self, key: &'static str, values: &Option<Values>) -> Numbers {
        if let Some(values) = values {
            return self.positive(key, values);
        }
        match self.nominals.iter().find(|x| **x <= 0.0) {
            Some(x) => {
                let allowed = "used where the nominal is > 0, since it is the median";
                self.refused(
                    key,
                    format!("nominal {x:?}"),
                    allowed,
                    "disperse a positive parameter, or use another distribution",
                )
            }
            None => Ok(self.nominals.to_vec()),
        }
    }

    /// Fractions of the nominal in the parameter's unit.
    pub(super) fn relative(&self, key: &'static str, written: &Values, fractions: Vec<f64>, absolute: &str) -> Numbers {
        if self.nominals.iter().all(|nominal| *nominal == 0.0) {
            let allowed = "relative to a nominal value other than 0";
            return self.refused(key, written.text(), allowed, format!("use {absolute} in the parameter's unit"));
        }
        Ok(fractions.iter().zip(self.nominals).map(|(x, nominal)| x * nominal.abs()).collect())
    }

    /// Widths in the parameter's unit: not negative, and relative ones relative to something.
    pub(super) fn widths(&self, key: &'static str, values: &Values, relative: Option<&str>) -> Numbers {
        let list = self.not_negative(key, values)?;
        match relative {
            Some(absolute) => self.relative(key, values, list, absolute),
            None => Ok(list),
        }
    }

    /// `min` < `max` for each component.
    pub(super) fn ends(&self, min: &Values, max: &Values) -> Result<(Vec<f64>, Vec<f64>), DispersionError> {
        let (min, max) = (self.each("min", min)?, self.each("max", max)?);
        match min.iter().zip(&max).find(|(min, max)| min >= max) {
            Some((low, high)) => {
                let remedy = if low > high { "swap min and max" } else { "make max larger, or delete this table" };
                self.refused("min", format!("{low:?}"), format!("< max ({high:?})"), remedy)
            }
            None => Ok((min, max)),
        }
    }

    /// The most likely value of each component, between its ends.
    pub(super) fn mode(&self, mode: &Option<Values>, min: &[f64], max: &[f64]) -> Numbers {
        let modes = match mode {
            Some(mode) => self.each("mode", mode)?,
            None => self.nominals.to_vec(),
        };
        for ((mode, min), max) in modes.iter().zip(min).zip(max) {
            if mode < min || mode > max {
                let allowed = format!("from min ({min:?}) to max ({max:?}); without mode the nominal is meant");
                return self.refused("mode", format!("{mode:?}"), allowed, "write mode, or move min and max");
            }
        }
        Ok(modes)
    }
}

/// The vector or attitude that a distribution of several numbers is for.
#[derive(Clone, Copy, Debug)]
pub struct JointTarget<'a> {
    /// Which `[[disperse]]` table, counted from zero.
    pub index: usize,
    /// The parameter.
    pub parameter: Parameter,
    /// The component that was named, which is wrong.
    pub component: Option<usize>,
    /// The nominal values of all components.
    pub nominals: &'a [f64],
}

impl JointTarget<'_> {
    /// An error of this target.
    pub(super) fn refused<T>(
        &self,
        key: &'static str,
        value: impl Into<String>,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Result<T, DispersionError> {
        Err(error(self.index, key, value, allowed, remedy))
    }

    /// An error of this target: a key that must be there is missing.
    pub(super) fn lacks<T>(
        &self,
        key: &'static str,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Result<T, DispersionError> {
        Err(DispersionError { value: None, ..error(self.index, key, "", allowed, remedy) })
    }

    /// The nominal attitude, where the target is one as a whole.
    pub(super) fn attitude(&self, distribution: &str) -> Result<[f64; 4], DispersionError> {
        match <[f64; 4]>::try_from(self.nominals) {
            Ok(nominal) if self.component.is_none() && self.parameter.shape() == Shape::Quaternion => Ok(nominal),
            _ => self.misplaced("an attitude (w, x, y, z)", distribution, "initial.attitude"),
        }
    }

    /// The nominal vector, where the target is one as a whole.
    pub(super) fn vector(&self, distribution: &str) -> Result<[f64; 3], DispersionError> {
        let parameter = self.parameter;
        let is_vector = parameter.shape() == Shape::Plain && parameter.components() == ["x", "y", "z"];
        // pure numbers that are no direction are factors and shears
        let is_vector = is_vector && (parameter.unit() != "1" || self.is_direction());
        match <[f64; 3]>::try_from(self.nominals) {
            Ok(nominal) if self.component.is_none() && is_vector => Ok(nominal),
            // of a component of a vector, the vector is meant
            _ if is_vector => self.misplaced("a vector (x, y, z)", distribution, &parameter.name()),
            _ => self.misplaced("a vector (x, y, z)", distribution, "initial.angular_velocity_rad_s"),
        }
    }

    /// Whether the length of the vector has no effect: an axis of a wheel, a direction of a thruster.
    pub(super) fn is_direction(&self) -> bool {
        self.parameter.facts().limit == Limit::Direction
    }

    fn misplaced<T>(&self, what: &str, distribution: &str, example: &str) -> Result<T, DispersionError> {
        let name = self.component.map_or(self.parameter.name().to_owned(), |c| self.parameter.component_name(c));
        let allowed = format!("{what} as a whole with distribution {distribution:?}");
        let remedy = format!("write {example:?}, or choose another distribution");
        self.refused("parameter", format!("{name:?}"), allowed, remedy)
    }

    /// An axis of any length but zero; one whose square would overflow or vanish is divided by its largest component.
    pub(super) fn axis(&self, axis: [f64; 3]) -> Result<[f64; 3], DispersionError> {
        let largest = axis.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
        if largest == 0.0 {
            return self.refused("axis", format!("{axis:?}"), "a vector other than zero", "write it like [0, 0, 1]");
        }
        let is_squared = (1e-150..1e150).contains(&largest);
        Ok(if is_squared { axis } else { axis.map(|x| x / largest) })
    }
}
