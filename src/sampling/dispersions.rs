//! [`Dispersions`]: every dispersion of a campaign, checked against the nominal scene and ready to be drawn by a
//! [`super::Sampler`].

use super::distribution::Distribution;
use super::joint::Joint;
use super::law::{Dispersion, DispersionError, Law, error};
use super::sampler::Sampler;
use super::scalar::distributions;
use crate::scene::parameter::Kind;
use crate::scene::{Parameter, SceneInput};

/// One number of the scene that a draw writes.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The parameter.
    pub parameter: Parameter,
    /// Its component.
    pub component: usize,
    /// The nominal value.
    pub nominal: f64,
}

/// A law at its place: which numbers u it takes, and which columns it writes.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// Its first dimension; it takes as many as its law needs, one after the other.
    pub first: usize,
    /// The columns that it writes, in the order of the law's values.
    pub columns: Vec<usize>,
    /// The law.
    pub map: Map,
}

/// From numbers u in (0, 1) to values.
#[derive(Clone, Debug, PartialEq)]
pub enum Map {
    /// One u, one value.
    Scalar(Distribution),
    /// Several together.
    Joint(Joint),
}

impl Map {
    /// Number of u that it takes.
    pub fn dimensions(&self) -> usize {
        match self {
            Map::Scalar(Distribution::Fixed(_)) => 0,
            Map::Scalar(_) => 1,
            Map::Joint(joint) => joint.dimensions(),
        }
    }
}

/// Every dispersion of a campaign, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispersions {
    pub(super) seed: u64,
    pub(super) columns: Vec<Column>,
    pub(super) laws: Vec<Placed>,
    /// The name of each dimension.
    pub(super) dimensions: Vec<String>,
}

impl Dispersions {
    /// Checks `list` against the `nominal` scene; all errors at once.
    pub fn new(seed: u64, nominal: &SceneInput, list: &[Dispersion]) -> Result<Self, Vec<DispersionError>> {
        let mut these = Dispersions { seed, columns: Vec::new(), laws: Vec::new(), dimensions: Vec::new() };
        let errors: Vec<DispersionError> =
            list.iter().enumerate().filter_map(|(index, d)| these.add(index, d, nominal).err()).collect();
        if errors.is_empty() { Ok(these) } else { Err(errors) }
    }

    /// The numbers that a draw writes, in the order of the file.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The law that writes a column, if one does: a component of a quaternion may only change with its siblings.
    pub fn law_of(&self, column: usize) -> Option<&Map> {
        self.laws.iter().find(|law| law.columns.contains(&column)).map(|law| &law.map)
    }

    /// The names of the random dimensions, in the order of the file.
    pub fn dimensions(&self) -> &[String] {
        &self.dimensions
    }

    /// A sampler for one worker. Allocates; drawing does not.
    pub fn sampler(&self) -> Sampler<'_> {
        Sampler::new(self)
    }

    fn add(&mut self, index: usize, dispersion: &Dispersion, nominal: &SceneInput) -> Result<(), DispersionError> {
        let parameter = dispersion.parameter;
        let components: Vec<usize> = match dispersion.component {
            Some(component) => vec![component],
            None => (0..parameter.width()).collect(),
        };
        self.check_components(index, parameter, &components, nominal)?;
        let nominals: Vec<f64> = components.iter().filter_map(|c| parameter.value(nominal, *c)).collect();
        let maps: Vec<(Vec<usize>, Map)> = match distributions(index, &dispersion.law, &nominals)? {
            Some(laws) => components.iter().zip(laws).map(|(c, law)| (vec![*c], Map::Scalar(law))).collect(),
            None => vec![(components, Map::Joint(joint(index, dispersion)?))],
        };
        // a quaternion is normalised as a whole: all of it is recorded, in one place
        if parameter.kind() == Kind::Quaternion {
            (0..parameter.width()).for_each(|component| {
                self.column(parameter, component, nominal);
            });
        }
        for (components, map) in maps {
            let first = self.dimensions.len();
            match &map {
                Map::Scalar(Distribution::Fixed(_)) => {}
                Map::Scalar(_) => self.dimensions.push(parameter.component_name(components[0])),
                Map::Joint(joint) => {
                    let name = |k: usize| format!("{}/{}", parameter.name(), k + 1);
                    self.dimensions.extend((0..joint.dimensions()).map(name));
                }
            }
            let columns = components.iter().map(|component| self.column(parameter, *component, nominal)).collect();
            self.laws.push(Placed { first, columns, map });
        }
        Ok(())
    }

    /// That the components exist and no law writes them yet.
    fn check_components(
        &self,
        index: usize,
        parameter: Parameter,
        components: &[usize],
        nominal: &SceneInput,
    ) -> Result<(), DispersionError> {
        let refused = |component: usize, allowed: &str, remedy: &str| {
            Err(error(index, "parameter", format!("{:?}", parameter.component_name(component)), allowed, remedy))
        };
        if let Some(missing) = components.iter().find(|component| !parameter.exists(nominal, **component)) {
            return refused(*missing, "a key that the scene has", parameter.remedy());
        }
        let taken = |component: &&usize| {
            let same = |column: &usize| {
                let column = &self.columns[*column];
                (column.parameter, column.component) == (parameter, **component)
            };
            self.laws.iter().any(|law| law.columns.iter().any(same))
        };
        match components.iter().find(taken) {
            Some(twice) => refused(
                *twice,
                "dispersed once",
                "delete one of the two [[disperse]] tables, or address different components",
            ),
            None => Ok(()),
        }
    }

    /// The place of a component among the columns, where it is added if it is not there.
    fn column(&mut self, parameter: Parameter, component: usize, nominal: &SceneInput) -> usize {
        let there = |column: &Column| (column.parameter, column.component) == (parameter, component);
        self.columns.iter().position(there).unwrap_or_else(|| {
            let nominal = parameter.value(nominal, component).unwrap_or(f64::NAN);
            self.columns.push(Column { parameter, component, nominal });
            self.columns.len() - 1
        })
    }
}

/// The law of all components together.
fn joint(index: usize, dispersion: &Dispersion) -> Result<Joint, DispersionError> {
    let parameter = dispersion.parameter;
    match dispersion.law {
        Law::UniformAttitude if parameter.kind() == Kind::Quaternion && dispersion.component.is_none() => {
            Ok(Joint::UniformAttitude)
        }
        _ => {
            let name = dispersion.component.map_or(parameter.name().to_owned(), |c| parameter.component_name(c));
            let allowed = "an attitude as a whole with distribution \"uniform_attitude\"";
            let remedy = "write \"initial.attitude\" or \"initial.debris_attitude\"";
            Err(error(index, "parameter", format!("{name:?}"), allowed, remedy))
        }
    }
}
