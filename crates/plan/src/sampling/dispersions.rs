//! [`Dispersions`]: a campaign's dispersions, checked against the nominal scene.

use super::columns::{Column, Columns, Component};
use super::copula::Copula;
use super::correlation::{Correlation, Replaced, components_of, copulas};
use super::derivation::{Derivation, Derived, derived};
use super::design::{Design, Dimensions, MAX_SAMPLES, PointSource, Size};
use super::distribution::target::Target;
use super::distribution::{Distribution, Joint, NumberWords, WrittenDistribution};
use super::error::{DispersionError, GIVE_KEY, HAS_KEY, Result, Table, error, error_of};
use super::keys::DataColumn;
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub struct Dispersion {
    /// Index of its table in the file.
    pub table: usize,
    /// The first of several.
    pub parameter: Parameter,
    /// One component; `None` for all.
    pub component: Option<usize>,
    pub distribution: WrittenDistribution,
}

impl Dispersion {
    pub fn components(&self) -> Vec<Component> {
        match self.distribution.written.columns() {
            [] => components_of(&(self.parameter, self.component)),
            columns => columns.iter().filter_map(|column| column.target).collect(),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Draws<'a> {
    pub seed: u64,
    /// As in the file, sample 0 included.
    pub samples: Option<u64>,
    pub design: &'a Design,
    pub disperse: &'a [Dispersion],
    pub correlate: &'a [Correlation],
    pub derive: &'a [Derivation],
}

#[derive(Clone, Debug, PartialEq)]
pub struct Dispersions {
    seed: u64,
    samples: u64,
    design: Design,
    pub(super) columns: Columns,
    pub(super) assigned: Vec<Assigned>,
    pub(super) dimensions: Vec<String>,
    pub(super) tabled: Vec<(usize, Arc<[f64]>)>,
    pub(super) copulas: Vec<Copula>,
    replaced: Vec<Replaced>,
    pub(super) derived: Vec<Derived>,
}

impl Dispersions {
    /// Checks `draws` against the `nominal` scene.
    ///
    /// # Errors
    /// All problems.
    pub fn new(draws: Draws<'_>, nominal: &SceneInput) -> Result<Self, Vec<DispersionError>> {
        let mut these = Dispersions {
            seed: draws.seed,
            samples: 1,
            design: draws.design.clone(),
            columns: Columns::default(),
            assigned: Vec::new(),
            dimensions: Vec::new(),
            tabled: Vec::new(),
            copulas: Vec::new(),
            replaced: Vec::new(),
            derived: Vec::new(),
        };
        let mut errors: Vec<DispersionError> = Vec::new();
        for dispersion in draws.disperse {
            errors.extend(these.add(dispersion, nominal).err());
        }
        for column in draws.design.written().columns() {
            errors.extend(these.add_tabled(column, nominal).err());
        }
        if errors.is_empty() {
            let scalar = |component| match these.distribution_at(component) {
                Some(Assigned { first, map: Transform::Scalar(distribution), .. })
                    if distribution.dimensions() == 1 =>
                {
                    Some((*first, distribution))
                }
                _ => None,
            };
            let (list, replaced, wrong) = copulas(draws.correlate, scalar);
            (these.copulas, these.replaced) = (list, replaced);
            errors.extend(wrong);
            let assigned = &these.assigned;
            let is_drawn = |columns: &Columns, component| assigned_to(assigned, columns, component).is_some();
            let (list, wrong) = derived(draws.derive, &mut these.columns, is_drawn, nominal);
            these.derived = list;
            errors.extend(wrong);
            match fitting_samples(draws.design, draws.samples, &these) {
                Ok(samples) => these.samples = samples,
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() { Ok(these) } else { Err(errors) }
    }

    pub fn columns(&self) -> &[Column] {
        self.columns.list()
    }

    /// Number of samples in the file or of the design, sample 0 included.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    pub fn design(&self) -> &Design {
        &self.design
    }

    /// A component of a quaternion may only follow the others.
    pub fn distribution_of(&self, column: usize) -> Option<&Transform> {
        self.assigned_to(column).map(|assigned| &assigned.map)
    }

    pub fn assigned_to(&self, column: usize) -> Option<&Assigned> {
        self.assigned.iter().find(|assigned| assigned.columns.contains(&column))
    }

    pub fn assigned(&self) -> &[Assigned] {
        &self.assigned
    }

    pub fn scalar_of(&self, column: usize) -> Option<&Distribution> {
        match self.distribution_of(column) {
            Some(Transform::Scalar(distribution)) if distribution.dimensions() == 1 => Some(distribution),
            _ => None,
        }
    }

    pub fn expression_of(&self, column: usize) -> Option<&str> {
        self.derived.iter().find(|derived| derived.column == column).map(|derived| derived.text.as_str())
    }

    pub fn replaced_correlations(&self) -> &[Replaced] {
        &self.replaced
    }

    pub fn is_tabled(&self, column: usize) -> bool {
        self.tabled.iter().any(|(tabled, _)| *tabled == column)
    }

    pub fn dimensions(&self) -> &[String] {
        &self.dimensions
    }

    /// The distribution of each dimension, by consecutive indices.
    pub fn factors(&self) -> Vec<usize> {
        let random = self.assigned.iter().map(|assigned| assigned.map.dimensions()).filter(|count| *count > 0);
        random.enumerate().flat_map(|(factor, count)| vec![factor; count]).collect()
    }

    pub fn points(&self) -> Box<dyn PointSource> {
        let factors = self.factors();
        let (seed, samples, names) = (self.seed, self.samples, self.dimensions.as_slice());
        self.design.points(Dimensions { seed, samples, names, factors: &factors })
    }

    fn distribution_at(&self, component: Component) -> Option<&Assigned> {
        assigned_to(&self.assigned, &self.columns, component)
    }

    fn add_tabled(&mut self, data: &DataColumn, nominal: &SceneInput) -> Result<()> {
        let refused = |allowed: &str, remedy: &str| {
            Err(error_of(Table::Design, "parameters", format!("{:?}", data.target_name()), allowed, remedy))
        };
        let Some((parameter, component)) = data.target else {
            return refused("the name of one number of scene or initial state", "write it as initial.position_m.x");
        };
        if !parameter.exists(nominal) {
            return refused(HAS_KEY, GIVE_KEY);
        }
        let is_taken = |column: usize| self.tabled.iter().any(|(tabled, _)| *tabled == column);
        if self.distribution_at((parameter, component)).is_some() {
            return refused("given a value once", "delete its [[disperse]] table, or take it out of parameters");
        }
        if self.columns.find((parameter, component)).is_some_and(is_taken) {
            return refused("given a value once", "name it once; the file may have it under two names");
        }
        let column = self.add_column((parameter, component), nominal);
        self.tabled.push((column, data.values.clone()));
        Ok(())
    }

    fn add(&mut self, dispersion: &Dispersion, nominal: &SceneInput) -> Result<()> {
        let Dispersion { table, parameter, component, distribution } = dispersion;
        let components = dispersion.components();
        self.check_components(dispersion, &components, nominal)?;
        let nominals: Vec<f64> = components.iter().filter_map(|(p, c)| p.value(nominal, *c)).collect();
        let WrittenDistribution { kind, written } = distribution;
        let target = Target {
            index: *table,
            parameter: *parameter,
            component: *component,
            nominals: &nominals,
            rows: kind.keys(),
            written,
        };
        let maps: Vec<(Vec<Component>, Transform)> = match kind.distributions(&target)? {
            Some(list) => components.iter().zip(list).map(|(c, one)| (vec![*c], Transform::Scalar(one))).collect(),
            None => kind.joint(&target)?.map(|joint| (components, Transform::Joint(joint))).into_iter().collect(),
        };
        for (components, map) in maps {
            let first = self.dimensions.len();
            match &map {
                Transform::Scalar(distribution) if distribution.dimensions() == 0 => {}
                Transform::Scalar(_) => self.dimensions.push(components[0].0.component_name(components[0].1)),
                Transform::Joint(joint) => {
                    let drawn = component.map_or_else(|| parameter.name(), |c| parameter.component_name(c));
                    let name = |k: usize| format!("{drawn}/{}", joint.dimension_name(k));
                    self.dimensions.extend((0..joint.dimensions()).map(name));
                }
            }
            let columns = components.iter().map(|component| self.add_column(*component, nominal)).collect();
            self.assigned.push(Assigned { first, columns, map });
        }
        Ok(())
    }

    /// Quaternions are normalised, and recorded, as a whole.
    fn add_column(&mut self, (parameter, component): Component, nominal: &SceneInput) -> usize {
        if parameter.shape() == Shape::Quaternion {
            (0..parameter.width()).for_each(|component| {
                self.columns.add(parameter, component, nominal);
            });
        }
        self.columns.add(parameter, component, nominal)
    }

    fn check_components(&self, dispersion: &Dispersion, components: &[Component], nominal: &SceneInput) -> Result<()> {
        let key = if dispersion.distribution.written.columns().is_empty() { "parameter" } else { "parameters" };
        let refused = |(parameter, component): Component, allowed: &str, remedy: &str| {
            Err(error(dispersion.table, key, format!("{:?}", parameter.component_name(component)), allowed, remedy))
        };
        if let Some(missing) = components.iter().find(|(parameter, _)| !parameter.exists(nominal)) {
            return refused(*missing, HAS_KEY, GIVE_KEY);
        }
        let mut listed = components.iter().enumerate();
        if let Some((_, twice)) = listed.find(|(place, component)| components[..*place].contains(component)) {
            return refused(*twice, "named once", "take it out of the list, where it is twice");
        }
        match components.iter().find(|component| self.distribution_at(**component).is_some()) {
            Some(twice) => refused(
                *twice,
                "dispersed once",
                "delete one of the two [[disperse]] tables, or address different components",
            ),
            None => Ok(()),
        }
    }
}

fn assigned_to<'a>(assigned: &'a [Assigned], columns: &Columns, component: Component) -> Option<&'a Assigned> {
    let column = columns.find(component)?;
    assigned.iter().find(|assigned| assigned.columns.contains(&column))
}

fn fitting_samples(design: &Design, samples: Option<u64>, drawn: &Dispersions) -> Result<u64> {
    let (name, count) = (design.name(), drawn.dimensions.len());
    let refused =
        |table, key, value: String, allowed: String, remedy: &str| Err(error_of(table, key, value, allowed, remedy));
    let facts = design.facts();
    if count > facts.max_dimensions {
        let allowed = format!("a design for {count} random dimensions; this one has {}", facts.max_dimensions);
        let remedy = "disperse fewer numbers, or use random or latin_hypercube";
        return refused(Table::Design, "kind", format!("{name:?}"), allowed, remedy);
    }
    if let (Some([allowed, remedy]), false) = (facts.excludes_correlation, drawn.copulas.is_empty()) {
        return refused(Table::Design, "kind", format!("{name:?}"), allowed.to_owned(), remedy);
    }
    let factors = drawn.factors();
    let dimensions =
        Dimensions { seed: drawn.seed, samples: samples.unwrap_or(1), names: &drawn.dimensions, factors: &factors };
    design.check(dimensions, samples)?;
    match (samples, design.size(count)) {
        (None, Size::Points(points)) if points < MAX_SAMPLES => Ok(points + 1),
        (None, Size::Points(_) | Size::TooMany) => {
            let allowed = format!("a design of at most {MAX_SAMPLES} samples");
            refused(Table::Design, "kind", format!("{name:?}"), allowed, "write fewer levels")
        }
        // its reader refuses a file that needs a number
        (None, Size::Any) => Ok(1),
        (Some(samples), Size::Points(points)) if samples - 1 > points => {
            let allowed =
                format!("at most {}: the nominal scene and the {points} points of design {name:?}", points + 1);
            refused(Table::Campaign, "samples", samples.to_string(), allowed, "leave samples out for all of them")
        }
        (Some(samples), _) => Ok(samples),
    }
}

/// A distribution with its dimensions and columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Assigned {
    pub first: usize,
    /// In the order of the distribution's values.
    pub columns: Vec<usize>,
    pub map: Transform,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Transform {
    Scalar(Distribution),
    Joint(Joint),
}

impl Transform {
    pub fn dimensions(&self) -> usize {
        match self {
            Transform::Scalar(distribution) => distribution.dimensions(),
            Transform::Joint(joint) => joint.dimensions(),
        }
    }

    pub fn text(&self, words: NumberWords<'_>) -> String {
        match self {
            Transform::Scalar(distribution) => distribution.text(words),
            Transform::Joint(joint) => joint.text(words),
        }
    }
}
