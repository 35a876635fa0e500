//! [`Dispersions`]: every dispersion of a campaign, checked against the nominal scene and ready to be drawn by a
//! [`super::Sampler`].

use super::copula::Copula;
use super::dependence::{Correlation, Derivation, Derived};
use super::design::levels::Levels;
use super::design::{Design, Points, saltelli};
use super::distribution::Distribution;
use super::joint::Joint;
use super::law::{DataColumn, Dispersion, DispersionError, Law, Table, error, error_of};
use super::sampler::Sampler;
use super::scalar::distributions;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};
use std::sync::Arc;

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
    pub map: Transform,
}

/// From numbers u in (0, 1) to values.
#[derive(Clone, Debug, PartialEq)]
pub enum Transform {
    /// One u, one value.
    Scalar(Distribution),
    /// Several together.
    Joint(Joint),
}

impl Transform {
    /// Number of u that it takes.
    pub fn dimensions(&self) -> usize {
        match self {
            Transform::Scalar(Distribution::Fixed(_)) => 0,
            Transform::Scalar(_) => 1,
            Transform::Joint(joint) => joint.dimensions(),
        }
    }
}

/// What is to be drawn, as written.
#[derive(Clone, Copy, Debug)]
pub struct Draws<'a> {
    /// Seed of all draws.
    pub seed: u64,
    /// Number of samples, sample 0 included; `None` where the file does not say.
    pub samples: Option<u64>,
    /// How samples are laid out.
    pub design: &'a Design,
    /// The laws.
    pub disperse: &'a [Dispersion],
    /// Dependence between them.
    pub correlate: &'a [Correlation],
    /// Parameters that follow from others.
    pub derive: &'a [Derivation],
}

/// Every dispersion of a campaign, ready to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispersions {
    seed: u64,
    samples: u64,
    design: Design,
    pub(super) columns: Vec<Column>,
    pub(super) laws: Vec<Placed>,
    /// The name of each dimension.
    pub(super) dimensions: Vec<String>,
    /// Columns whose values stand in a file, and these values.
    pub(super) tabled: Vec<(usize, Arc<[f64]>)>,
    pub(super) copulas: Vec<Copula>,
    pub(super) derived: Vec<Derived>,
}

impl Dispersions {
    /// Checks `draws` against the `nominal` scene; all errors at once.
    pub fn new(draws: Draws<'_>, nominal: &SceneInput) -> Result<Self, Vec<DispersionError>> {
        let mut these = Dispersions {
            seed: draws.seed,
            samples: 1,
            design: draws.design.clone(),
            columns: Vec::new(),
            laws: Vec::new(),
            dimensions: Vec::new(),
            tabled: Vec::new(),
            copulas: Vec::new(),
            derived: Vec::new(),
        };
        let mut errors: Vec<DispersionError> = Vec::new();
        for (index, dispersion) in draws.disperse.iter().enumerate() {
            errors.extend(these.add(index, dispersion, nominal).err());
        }
        if let Design::Table(columns) = draws.design {
            for column in columns {
                errors.extend(these.add_tabled(column, nominal).err());
            }
        }
        // the rest says nothing new where laws are missing
        if errors.is_empty() {
            for (index, correlation) in draws.correlate.iter().enumerate() {
                match correlation.copula(index, &these) {
                    Ok(copula) => these.copulas.push(copula),
                    Err(error) => errors.push(error),
                }
            }
            errors.extend(these.derive(draws.derive, nominal));
            match fitting_samples(draws.design, draws.samples, &these) {
                Ok(samples) => these.samples = samples,
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() { Ok(these) } else { Err(errors) }
    }

    /// The numbers that a draw writes, in the order of the file.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Number of samples, sample 0 included: the file's, or that of a design with a size of its own.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// How samples are laid out.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// The law that writes a column, if one does: a component of a quaternion may only change with its siblings.
    pub fn law_of(&self, column: usize) -> Option<&Transform> {
        self.laws.iter().find(|law| law.columns.contains(&column)).map(|law| &law.map)
    }

    /// The expression that a column follows, if it does.
    pub fn expression_of(&self, column: usize) -> Option<&str> {
        self.derived.iter().find(|derived| derived.column == column).map(|derived| derived.text.as_str())
    }

    /// Whether a column's values stand in a file.
    pub fn is_tabled(&self, column: usize) -> bool {
        self.tabled.iter().any(|(tabled, _)| *tabled == column)
    }

    /// The names of the random dimensions, in the order of the file.
    pub fn dimensions(&self) -> &[String] {
        &self.dimensions
    }

    /// The law of each dimension: dimensions of one law have one number, counted from zero without gaps.
    pub fn factors(&self) -> Vec<usize> {
        let random = self.laws.iter().filter(|law| law.map.dimensions() > 0);
        random.enumerate().flat_map(|(factor, law)| vec![factor; law.map.dimensions()]).collect()
    }

    /// A sampler for one worker. Allocates; drawing does not.
    pub fn sampler(&self) -> Sampler<'_> {
        Sampler::new(self)
    }

    /// The points of the design, for one worker.
    pub fn points(&self) -> Points {
        Points::new(&self.design, self.seed, self.samples, &self.dimensions, &self.factors())
    }

    /// The law of a component.
    pub(super) fn law_at(&self, component: (Parameter, usize)) -> Option<&Placed> {
        let column = self.column_of(component)?;
        self.laws.iter().find(|law| law.columns.contains(&column))
    }

    /// The place of a component among the columns.
    pub(super) fn column_of(&self, (parameter, component): (Parameter, usize)) -> Option<usize> {
        self.columns.iter().position(|c| (c.parameter, c.component) == (parameter, component))
    }

    /// A parameter that is a column of the design's file.
    fn add_tabled(&mut self, data: &DataColumn, nominal: &SceneInput) -> Result<(), DispersionError> {
        let refused = |allowed: &str, remedy: &str| {
            Err(error_of(Table::Design, "parameters", format!("{:?}", data.column), allowed, remedy))
        };
        let target = Parameter::find(&data.column).and_then(|(parameter, component)| match component {
            Some(component) => Some((parameter, component)),
            None => (parameter.width() == 1).then_some((parameter, 0)),
        });
        let Some((parameter, component)) = target else {
            return refused("the name of one number of scene or initial state", "write it as initial.position_m.x");
        };
        if !parameter.exists(nominal, component) {
            return refused("a key that the scene has", parameter.remedy());
        }
        let is_taken = |column: usize| self.tabled.iter().any(|(tabled, _)| *tabled == column);
        if self.law_at((parameter, component)).is_some() || self.column_of((parameter, component)).is_some_and(is_taken)
        {
            return refused("given a value once", "delete its [[disperse]] table, or take it out of parameters");
        }
        if parameter.shape() == Shape::Quaternion {
            (0..parameter.width()).for_each(|component| {
                self.column(parameter, component, nominal);
            });
        }
        let column = self.column(parameter, component, nominal);
        self.tabled.push((column, data.values.clone()));
        Ok(())
    }

    fn add(&mut self, index: usize, dispersion: &Dispersion, nominal: &SceneInput) -> Result<(), DispersionError> {
        let parameter = dispersion.parameter;
        let components: Vec<usize> = match dispersion.component {
            Some(component) => vec![component],
            None => (0..parameter.width()).collect(),
        };
        self.check_components(index, parameter, &components, nominal)?;
        let nominals: Vec<f64> = components.iter().filter_map(|c| parameter.value(nominal, *c)).collect();
        let maps: Vec<(Vec<usize>, Transform)> = match distributions(index, &dispersion.law, &nominals)? {
            Some(laws) => components.iter().zip(laws).map(|(c, law)| (vec![*c], Transform::Scalar(law))).collect(),
            None => vec![(components, Transform::Joint(joint(index, dispersion, nominal)?))],
        };
        // a quaternion is normalised as a whole: all of it is recorded, in one place
        if parameter.shape() == Shape::Quaternion {
            (0..parameter.width()).for_each(|component| {
                self.column(parameter, component, nominal);
            });
        }
        for (components, map) in maps {
            let first = self.dimensions.len();
            match &map {
                Transform::Scalar(Distribution::Fixed(_)) => {}
                Transform::Scalar(_) => self.dimensions.push(parameter.component_name(components[0])),
                Transform::Joint(joint) => {
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
    pub(super) fn column(&mut self, parameter: Parameter, component: usize, nominal: &SceneInput) -> usize {
        let there = |column: &Column| (column.parameter, column.component) == (parameter, component);
        self.columns.iter().position(there).unwrap_or_else(|| {
            let nominal = parameter.value(nominal, component).unwrap_or(f64::NAN);
            self.columns.push(Column { parameter, component, nominal });
            self.columns.len() - 1
        })
    }
}

/// The law of all components together.
fn joint(index: usize, dispersion: &Dispersion, nominal: &SceneInput) -> Result<Joint, DispersionError> {
    let parameter = dispersion.parameter;
    match &dispersion.law {
        Law::Geometric(law) => law.joint(index, dispersion, nominal),
        Law::UniformAttitude if parameter.shape() == Shape::Quaternion && dispersion.component.is_none() => {
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

/// The number of samples, where it fits the design.
fn fitting_samples(design: &Design, samples: Option<u64>, drawn: &Dispersions) -> Result<u64, DispersionError> {
    let (name, dimensions) = (design.name(), drawn.dimensions.len());
    let refused =
        |table, key, value: String, allowed: String, remedy: String| Err(error_of(table, key, value, allowed, remedy));
    if dimensions > design.most_dimensions() {
        let allowed = format!("a design for {dimensions} random dimensions; this one has {}", design.most_dimensions());
        let remedy = "disperse fewer numbers, or use random or latin_hypercube".to_owned();
        return refused(Table::Design, "kind", format!("{name:?}"), allowed, remedy);
    }
    if let Design::Grid(Levels::Each(list)) | Design::OneAtATime(Levels::Each(list)) = design
        && list.len() != dimensions
    {
        let allowed = format!("one number, or {dimensions} in an array, as many as random dimensions");
        let remedy = "write them in the order of the file's [[disperse]] tables".to_owned();
        return refused(Table::Design, "levels", format!("{list:?}"), allowed, remedy);
    }
    if matches!(design, Design::OneAtATime(_)) && !drawn.copulas.is_empty() {
        let allowed = "a design in which parameters may vary together, as [[correlate]] asks".to_owned();
        let remedy = "delete [[correlate]], or use another design".to_owned();
        return refused(Table::Design, "kind", format!("{name:?}"), allowed, remedy);
    }
    let has_size = matches!(design, Design::Grid(_) | Design::OneAtATime(_) | Design::Table(_));
    let Some(samples) = samples else {
        // where none is written and none follows, the file is at fault, and says so
        return match design.points(dimensions).and_then(|points| points.checked_add(1)).filter(|n| *n <= MOST_SAMPLES) {
            Some(samples) => Ok(samples),
            None if has_size => {
                let allowed = format!("a design of at most {MOST_SAMPLES} samples");
                refused(Table::Design, "levels", name.to_owned(), allowed, "write fewer levels".to_owned())
            }
            None => Ok(1),
        };
    };
    if let Some(points) = design.points(dimensions)
        && samples - 1 > points
    {
        let allowed = format!("at most {}: the nominal scene and the {points} points of design {name:?}", points + 1);
        let remedy = "leave samples out for all of them".to_owned();
        return refused(Table::Campaign, "samples", samples.to_string(), allowed, remedy);
    }
    if let Design::Saltelli = design {
        let members = saltelli::members(&drawn.factors());
        if samples > 1 && (samples - 1) % members != 0 {
            let below = 1 + (samples - 1) / members * members;
            let allowed =
                format!("1 and a multiple of {members}: the nominal scene and whole blocks of the laws and two more");
            let remedy = format!("write {below} or {}", below + members);
            return refused(Table::Campaign, "samples", samples.to_string(), allowed, remedy);
        }
    }
    Ok(samples)
}

/// Most samples of a campaign: ids stay exact in a double.
pub const MOST_SAMPLES: u64 = 1 << 53;
