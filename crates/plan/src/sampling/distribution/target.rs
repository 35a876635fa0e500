//! [`Target`]: what a distribution applies to, with common checks.

use crate::sampling::error::{DispersionError, Result, error};
use crate::sampling::keys::{Presence, Row, Values, Written};
use crate::scene::Parameter;
use crate::scene::parameter::Shape;
use crate::scene::schema::Limit;

/// The parameter of a `[[disperse]]` table, and the written keys of its distribution.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Index of the `[[disperse]]` table.
    pub index: usize,
    pub parameter: Parameter,
    /// The only component; wrong for a joint distribution.
    pub component: Option<usize>,
    /// One value for each component.
    pub nominals: &'a [f64],
    pub rows: &'static [Row],
    pub written: &'a Written,
}

pub(super) const MIN: Row = Row::amounts("min", "Lower end");
pub(super) const MAX: Row = Row::amounts("max", "Upper end");
pub(super) const LOGARITHM: &str = "a logarithm needs a positive number";

pub(super) type Numbers = Result<Vec<f64>>;

impl Target<'_> {
    pub(super) fn refused<T>(
        &self,
        key: &'static str,
        value: impl Into<String>,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Result<T> {
        Err(error(self.index, key, value, allowed, remedy))
    }

    pub(super) fn all<T>(&self, of: impl Fn(usize) -> Result<T>) -> Result<Vec<T>> {
        (0..self.nominals.len()).map(of).collect()
    }

    /// The numbers of `key` or their default, one for each component, within the row's limit.
    pub(super) fn each(&self, key: &'static str) -> Numbers {
        let row = self.rows.iter().find(|row| row.key == key);
        let list = match (self.written.values(key), row.map(|row| row.presence)) {
            (Some(values), _) => self.spread_out(key, values)?,
            (None, Some(Presence::Or(default))) => vec![default; self.nominals.len()],
            (None, Some(Presence::OrNominal)) => return Ok(self.nominals.to_vec()),
            (None, _) => return self.refused(key, String::new(), "given", "write it"),
        };
        match row.and_then(|row| row.limit).and_then(|limit| Some((limit, list.iter().find(|x| !limit.holds(**x))?))) {
            Some((limit, x)) => self.refused(key, format!("{x:?}"), limit.allowed, limit.remedy),
            None => Ok(list),
        }
    }

    /// The distributions of all components, each from its numbers of `keys`.
    pub(super) fn of_numbers<T, const N: usize>(
        &self,
        keys: [&'static str; N],
        of: impl Fn([f64; N]) -> T,
    ) -> Result<Vec<T>> {
        let lists = keys.into_iter().map(|key| self.each(key)).collect::<Result<Vec<_>, _>>()?;
        Ok((0..self.nominals.len()).map(|component| of(std::array::from_fn(|key| lists[key][component]))).collect())
    }

    /// One finite number for each component.
    fn spread_out(&self, key: &'static str, values: &Values) -> Numbers {
        let width = self.nominals.len();
        let list = match values {
            Values::One(value) => vec![*value; width],
            Values::Each(list) if list.len() == width => list.clone(),
            other => {
                let parts =
                    if width == 1 { "1 number".to_owned() } else { format!("1 number, or {width} in an array") };
                return self.refused(key, format!("{other:?}"), parts, "give one for each component");
            }
        };
        match list.iter().find(|x| !x.is_finite()) {
            Some(x) => self.refused(key, x.to_string(), "finite", "write a finite number"),
            None => Ok(list),
        }
    }

    /// Positive medians: the numbers of `key` if it gives medians, else the nominal values.
    pub(super) fn positive_or_nominal(&self, key: &'static str) -> Numbers {
        let is_median = |row: &Row| row.key == key && row.presence == Presence::OrNominal;
        if self.written.has(key) && self.rows.iter().any(is_median) {
            return self.each(key);
        }
        match self.nominals.iter().find(|x| **x <= 0.0) {
            Some(x) => {
                let allowed = "used where the nominal is > 0, since it is the median";
                let remedy = "disperse a positive parameter, or use another distribution";
                self.refused(key, format!("nominal {x:?}"), allowed, remedy)
            }
            None => Ok(self.nominals.to_vec()),
        }
    }

    /// The numbers of `absolute`, or `relative` times the nominal values.
    pub(super) fn amounts(&self, absolute: &'static str, relative: &'static str) -> Numbers {
        if self.written.has(absolute) {
            return self.each(absolute);
        }
        let fractions = self.each(relative)?;
        if self.nominals.iter().all(|nominal| *nominal == 0.0) {
            let written = self.written.values(relative).map_or(String::new(), |values| format!("{values:?}"));
            let allowed = "relative to a nominal value other than 0";
            return self.refused(relative, written, allowed, format!("use {absolute} in the parameter's unit"));
        }
        Ok(fractions.iter().zip(self.nominals).map(|(x, nominal)| x * nominal.abs()).collect())
    }

    /// `min` < `max`, component by component.
    pub(super) fn ends(&self) -> Result<(Vec<f64>, Vec<f64>)> {
        let (min, max) = (self.each("min")?, self.each("max")?);
        match min.iter().zip(&max).find(|(min, max)| min >= max) {
            Some((low, high)) => {
                let remedy = if low > high { "swap min and max" } else { "make max larger, or delete this table" };
                self.refused("min", format!("{low:?}"), format!("< max ({high:?})"), remedy)
            }
            None => Ok((min, max)),
        }
    }

    /// `min` < `max`, and `mode` within them.
    pub(super) fn check_mode(&self) -> Result<()> {
        let (min, max) = self.ends()?;
        let modes = self.each("mode")?;
        match modes.iter().zip(min.iter().zip(&max)).find(|(mode, (min, max))| mode < min || mode > max) {
            Some((mode, (min, max))) => {
                let allowed = format!("from min ({min:?}) to max ({max:?}); without mode the nominal is meant");
                self.refused("mode", format!("{mode:?}"), allowed, "write mode, or move min and max")
            }
            None => Ok(()),
        }
    }

    pub(super) fn lacks<T>(
        &self,
        key: &'static str,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Result<T> {
        Err(DispersionError { value: None, ..error(self.index, key, "", allowed, remedy) })
    }

    pub(super) fn attitude(&self, distribution: &str) -> Result<[f64; 4]> {
        match <[f64; 4]>::try_from(self.nominals) {
            Ok(nominal) if self.component.is_none() && self.parameter.shape() == Shape::Quaternion => Ok(nominal),
            _ => self.misplaced("an attitude (w, x, y, z)", distribution, "initial.attitude"),
        }
    }

    pub(super) fn vector(&self, distribution: &str) -> Result<[f64; 3]> {
        let parameter = self.parameter;
        let is_vector = parameter.shape() == Shape::Plain && parameter.components() == ["x", "y", "z"];
        // pure numbers are factors and shears, except for directions
        let is_vector = is_vector && (parameter.unit() != "1" || self.is_direction());
        match <[f64; 3]>::try_from(self.nominals) {
            Ok(nominal) if self.component.is_none() && is_vector => Ok(nominal),
            // a component stands for its vector
            _ if is_vector => self.misplaced("a vector (x, y, z)", distribution, &parameter.name()),
            _ => self.misplaced("a vector (x, y, z)", distribution, "initial.angular_velocity_rad_s"),
        }
    }

    /// True if only the direction counts: of a wheel's axis, a thruster's direction.
    pub(super) fn is_direction(&self) -> bool {
        self.parameter.facts().limit == Limit::Direction
    }

    fn misplaced<T>(&self, what: &str, distribution: &str, example: &str) -> Result<T> {
        let name = self.component.map_or(self.parameter.name().to_owned(), |c| self.parameter.component_name(c));
        let allowed = format!("{what} as a whole with distribution {distribution:?}");
        let remedy = format!("write {example:?}, or choose another distribution");
        self.refused("parameter", format!("{name:?}"), allowed, remedy)
    }

    /// `axis`, refused if zero; scaled by its largest component if its square would overflow or vanish.
    pub(super) fn axis(&self, axis: [f64; 3]) -> Result<[f64; 3]> {
        let largest = axis.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
        if largest == 0.0 {
            return self.refused("axis", format!("{axis:?}"), "a vector other than zero", "write it like [0, 0, 1]");
        }
        let is_squared = (1e-150..1e150).contains(&largest);
        Ok(if is_squared { axis } else { axis.map(|x| x / largest) })
    }
}
