//! [`Parameter`]: a dispersable numeric key of scene or initial state: a row of [`super::schema`] and an instance of
//! its table. Commands of `[[actuation]]` are distorted by the keys of `[actuators]` and the errors of an arc instead.

use super::input::SceneInput;
use super::name::Name;
use super::schema::Facts;
pub use super::schema::Shape;
use super::table::{Key, Table};
use super::unit_quaternion::{is_unit, unit_quaternion};

/// A numeric key of scene or initial state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Parameter {
    /// Its row in the schema.
    key: Key,
    /// Instance of the row's table.
    instance: u32,
    /// Name of that instance.
    owner: Name,
}

/// Indices of the components of a symmetric tensor, and of their mirror images, among nine numbers by rows.
const SYMMETRIC: [(usize, usize); 6] = [(0, 0), (1, 3), (2, 6), (4, 4), (5, 7), (8, 8)];

impl Parameter {
    /// All parameters of scenes with the tables of `scene`, in order of the schema.
    pub fn all(scene: &SceneInput) -> impl Iterator<Item = Parameter> {
        let of = |table: Table, (instance, owner): (usize, Name)| {
            table.keys_in(scene, instance).map(move |key| Parameter { key, instance: instance as u32, owner })
        };
        let tables = Table::ALL.iter().copied().chain(Table::DECLARED);
        let dispersable = tables.filter(|table| table.is_dispersable());
        dispersable.flat_map(move |table| {
            table.owners(scene).into_iter().enumerate().flat_map(move |instance| of(table, instance))
        })
    }

    /// The parameter `name` of `scene`, and its component if the name ends in one (`.y` or `.1`).
    pub fn find(scene: &SceneInput, name: &str) -> Option<(Parameter, Option<usize>)> {
        let whole = |name: &str| Self::all(scene).find(|parameter| parameter.name() == name);
        if let Some(parameter) = whole(name) {
            return Some((parameter, None));
        }
        let (stem, suffix) = name.rsplit_once('.')?;
        let parameter = whole(stem)?;
        let component = parameter.components().iter().position(|component| *component == suffix)?;
        (parameter.width() > 1).then_some((parameter, Some(component)))
    }

    /// Facts of its key.
    pub fn facts(self) -> &'static Facts {
        self.key.facts()
    }

    fn instance(self) -> usize {
        self.instance as usize
    }

    /// The dotted name, as in a campaign file.
    pub fn name(self) -> String {
        self.key.name(self.owner)
    }

    /// Unit as in text; `1` for a pure number.
    pub fn unit(self) -> &'static str {
        self.facts().unit
    }

    /// The names of the components; one empty name for a scalar.
    pub fn components(self) -> &'static [&'static str] {
        self.facts().components
    }

    /// Number of components.
    pub fn width(self) -> usize {
        self.components().len()
    }

    /// Relation of the components.
    pub fn shape(self) -> Shape {
        self.facts().shape
    }

    /// Dotted name of a component; the parameter's name for a scalar.
    pub fn component_name(self, component: usize) -> String {
        match self.components()[component] {
            "" => self.name(),
            suffix => format!("{}.{suffix}", self.name()),
        }
    }

    /// Column name of a component: underscores for dots, unit last.
    pub fn column_name(self, component: usize) -> String {
        let unit = match self.unit() {
            "1" => String::new(),
            unit => format!("_{}", unit.replace([' ', '/'], "_").replace('^', "").to_lowercase()),
        };
        let name = self.name();
        let stem = name.strip_suffix(unit.as_str()).unwrap_or(&name).replace('.', "_");
        match self.components()[component] {
            "" => format!("{stem}{unit}"),
            suffix => format!("{stem}_{suffix}{unit}"),
        }
    }

    /// True if `scene` has the key.
    pub fn exists(self, scene: &SceneInput) -> bool {
        self.key.read(scene, self.instance()).is_some()
    }

    /// Adds the key, with NaN as numbers, if its table exists.
    pub fn open(self, scene: &mut SceneInput) {
        if !self.exists(scene) {
            self.key.open(scene, self.instance());
        }
    }

    /// A component, SI, if the scene has the key.
    #[inline]
    pub fn value(self, scene: &SceneInput, component: usize) -> Option<f64> {
        let numbers = self.key.read(scene, self.instance())?;
        Some(match self.shape() {
            Shape::Symmetric => numbers[SYMMETRIC[component].0],
            _ => numbers[component],
        })
    }

    /// Sets a component and its mirror image in a symmetric tensor, if the scene has the key.
    #[inline]
    pub fn set(self, scene: &mut SceneInput, component: usize, value: f64) {
        let Some(numbers) = self.key.write(scene, self.instance()) else { return };
        match self.shape() {
            Shape::Symmetric => {
                let (upper, mirror) = SYMMETRIC[component];
                numbers[upper] = value;
                numbers[mirror] = value;
            }
            _ => numbers[component] = value,
        }
    }

    /// True for the attitude of a body at time zero.
    fn is_attitude(self) -> bool {
        self.key.table == Table::Initial && self.shape() == Shape::Quaternion
    }

    /// Converts a written attitude to the one used by [`super::Scene::resolve`], by [`unit_quaternion`].
    #[inline]
    pub fn normalise_written(self, scene: &mut SceneInput) {
        if self.is_attitude()
            && let Some(Ok(numbers)) = self.key.write(scene, self.instance()).map(<&mut [f64; 4]>::try_from)
        {
            *numbers = unit_quaternion(*numbers);
        }
    }

    /// True if the numbers are a unit quaternion, to rounding; false for other parameters.
    #[inline]
    pub fn is_unit(self, scene: &SceneInput) -> bool {
        let is_quaternion = self.shape() == Shape::Quaternion;
        is_quaternion && self.key.read(scene, self.instance()).is_some_and(is_unit)
    }

    /// Makes the value valid after its components were changed: a quaternion is divided by its norm (unless zero or not
    /// finite, which the scene refuses), an attitude twice, so that [`unit_quaternion`] keeps the recorded numbers.
    /// Principal axes are used as recorded.
    #[inline]
    pub fn normalise(self, scene: &mut SceneInput) {
        if self.shape() != Shape::Quaternion {
            return;
        }
        let Some(numbers) = self.key.write(scene, self.instance()) else { return };
        for _ in 0..if self.is_attitude() { 2 } else { 1 } {
            let norm = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm > 0.0 && norm.is_finite() {
                numbers.iter_mut().for_each(|x| *x /= norm);
            }
        }
    }
}

impl SceneInput {
    /// Sets a parameter, whole or one component, by its name.
    ///
    /// # Panics
    /// If there is no such parameter or key, or the number of values is wrong.
    pub fn with(mut self, name: &str, values: &[f64]) -> Self {
        let (parameter, component) =
            Parameter::find(&self, name).unwrap_or_else(|| panic!("{name} is a parameter of the schema"));
        let first = component.unwrap_or(0);
        let count = if component.is_some() { 1 } else { parameter.width() };
        assert_eq!(values.len(), count, "the number of values of {name}");
        parameter.open(&mut self);
        for (offset, value) in values.iter().enumerate() {
            parameter.set(&mut self, first + offset, *value);
            assert_eq!(parameter.value(&self, first + offset), Some(*value), "the scene has {name}");
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ActuationInput, DebrisInput, OrbitInput, TorqueRodInput};

    /// A scene with all tables, and all keys that exclude no other.
    fn full() -> SceneInput {
        let rod = TorqueRodInput { name: Name::of("m1"), ..TorqueRodInput::DEFAULT };
        let scene = SceneInput { torque_rods: vec![rod], orbit: Some(OrbitInput::DEFAULT), ..SceneInput::report() };
        let mut scene = scene.with_debris(DebrisInput::BLANK).with_actuation(ActuationInput::idle(0.0, 1.0));
        for parameter in Parameter::all(&scene.clone()) {
            parameter.open(&mut scene);
        }
        scene
    }

    #[test]
    fn every_component_is_its_own_number_and_found_by_name() {
        let mut other_moments = full();
        other_moments.body.principal = None;
        let variants = [full(), full().with_debris(DebrisInput::BLANK), other_moments];
        let mut columns = std::collections::BTreeSet::new();
        for parameter in Parameter::all(&full()) {
            let mut opened = variants.iter().cloned().map(|mut scene| {
                parameter.open(&mut scene);
                scene
            });
            let nominal = opened.find(|scene| parameter.exists(scene));
            let nominal = &nominal.unwrap_or_else(|| panic!("{} exists nowhere", parameter.name()));
            let bits = |other: Parameter, scene: &SceneInput, index| other.value(scene, index).map(f64::to_bits);
            assert_eq!(Parameter::find(&full(), &parameter.name()), Some((parameter, None)));
            for component in 0..parameter.width() {
                let mut scene = nominal.clone();
                parameter.set(&mut scene, component, 42.5);
                for other in Parameter::all(&full()) {
                    for index in 0..other.width() {
                        let expected = if (other, index) == (parameter, component) {
                            Some(42.5_f64.to_bits())
                        } else {
                            bits(other, nominal, index)
                        };
                        assert_eq!(bits(other, &scene, index), expected, "{} {component}", parameter.name());
                    }
                }
                assert!(columns.insert(parameter.column_name(component)));
                if parameter.width() > 1 {
                    let found = Some((parameter, Some(component)));
                    assert_eq!(Parameter::find(&full(), &parameter.component_name(component)), found);
                    assert_eq!(Parameter::find(&full(), &format!("{}[{component}]", parameter.name())), None);
                }
            }
            let unit = parameter.unit().replace([' ', '/'], "_").replace('^', "").to_lowercase();
            assert!(unit == "1" || parameter.name().ends_with(&format!("_{unit}")), "{} in {unit}", parameter.name());
        }
    }
}
