//! `[control]`, `[[sensors]]`, `[[guidance]]`: the parameters of a control law, as the law and its parts declare them,
//! with names such as `control.gain_n_m`.

use std::sync::Mutex;

use super::limit::Limit;
use super::numbers::interned;
use super::row::{Facts, Shape};
use crate::scene::error::Problems;
use crate::scene::name::Name;

/// A parameter that a control law declares.
#[derive(Clone, Debug)]
pub struct LawParameter {
    /// Facts about its key in `[control]`.
    pub facts: Facts,
    /// The components by default; `None` if a campaign file must give them.
    pub default: Option<&'static [f64]>,
}

impl LawParameter {
    /// A number that a campaign file must give; `unit` as at the end of the key.
    pub const fn number(key: &'static str, unit: &'static str, meaning: &'static str, limit: Limit) -> Self {
        let facts = Facts {
            key,
            unit,
            meaning,
            components: &[""],
            shape: Shape::Plain,
            required: Some("1.0"),
            needs_debris: false,
            limit,
        };
        LawParameter { facts, default: None }
    }

    /// A required parameter of several components with these names.
    #[must_use]
    pub const fn with_components(mut self, components: &'static [&'static str]) -> Self {
        self.facts.components = components;
        self.facts.required = Some("[0.0, 0.0, 0.0]");
        self
    }

    /// A parameter with a default, one number for each component.
    #[must_use]
    pub const fn or(mut self, default: &'static [f64]) -> Self {
        self.facts.required = None;
        self.default = Some(default);
        self
    }
}

/// The parameters of all `parts`, kept for good.
pub fn kept(parts: &[&[LawParameter]]) -> &'static [LawParameter] {
    static KEPT: Mutex<Vec<&'static [LawParameter]>> = Mutex::new(Vec::new());
    let facts = |parameter: &LawParameter| (parameter.facts.key, parameter.facts.meaning, parameter.default);
    interned(&KEPT, parts.concat(), |a, b| a.iter().map(facts).eq(b.iter().map(facts)))
}

/// The parameters of the control law of a scene; none without a law.
#[derive(Clone, Copy, Debug, Default)]
pub struct LawParameters(pub &'static [LawParameter]);

impl PartialEq for LawParameters {
    fn eq(&self, other: &Self) -> bool {
        let keys = |list: &Self| list.0.iter().map(|parameter| parameter.facts.key).collect::<Vec<_>>();
        keys(self) == keys(other)
    }
}

/// Parameters that a part of a control law declares, and their values.
#[derive(Clone, Debug, PartialEq)]
pub struct DeclaredTable {
    /// The name among others of its kind; [`Name::NONE`] for a single table.
    pub name: Name,
    /// The declarations.
    pub declared: LawParameters,
    /// The numbers of all parameters in order.
    pub values: Vec<f64>,
}

impl DeclaredTable {
    /// Nothing is declared.
    pub const NONE: DeclaredTable =
        DeclaredTable { name: Name::NONE, declared: LawParameters(&[]), values: Vec::new() };

    /// The parameters `declared` at their defaults; NaN without one.
    pub fn of(name: Name, declared: &'static [LawParameter]) -> Self {
        let default = |parameter: &LawParameter| match parameter.default {
            Some(default) => default.to_vec(),
            None => vec![f64::NAN; parameter.facts.components.len()],
        };
        DeclaredTable { name, declared: LawParameters(declared), values: declared.iter().flat_map(default).collect() }
    }

    /// Range of the numbers of parameter `index`.
    fn place(&self, index: usize) -> std::ops::Range<usize> {
        let width = |parameter: &LawParameter| parameter.facts.components.len();
        let start = self.declared.0[..index].iter().map(width).sum();
        start..start + width(&self.declared.0[index])
    }

    /// The numbers of parameter `index`.
    pub fn numbers(&self, index: usize) -> Option<&[f64]> {
        self.values.get(self.place(index))
    }

    /// [`DeclaredTable::numbers`], mutable.
    pub fn numbers_mut(&mut self, index: usize) -> Option<&mut [f64]> {
        let place = self.place(index);
        self.values.get_mut(place)
    }

    /// The numbers of the parameter `key`; `None` if it is not declared.
    pub fn named(&self, key: &str) -> Option<&[f64]> {
        self.numbers(self.declared.0.iter().position(|parameter| parameter.facts.key == key)?)
    }

    /// Notes violated limits; `header` is the table's.
    fn check(&self, header: &str, problems: &mut Problems) {
        for (index, parameter) in self.declared.0.iter().enumerate() {
            if let Some(numbers) = self.numbers(index) {
                let facts = &parameter.facts;
                let name = || match self.name {
                    Name::NONE => format!("{header}.{}", facts.key).into(),
                    name => format!("{header}.{name}.{}", facts.key).into(),
                };
                facts.limit.check(name, numbers, problems);
            }
        }
    }
}

/// The parameters of a control law, of its sensors and of the phases of its guidance, with their values.
#[derive(Clone, Debug, PartialEq)]
pub struct ControlInput {
    /// `[control]`.
    pub law: DeclaredTable,
    /// `[[sensors]]`.
    pub sensors: Vec<DeclaredTable>,
    /// `[[guidance]]`.
    pub guidance: Vec<DeclaredTable>,
}

impl Default for ControlInput {
    fn default() -> Self {
        Self::NONE
    }
}

impl ControlInput {
    /// No law.
    pub const NONE: ControlInput = ControlInput { law: DeclaredTable::NONE, sensors: Vec::new(), guidance: Vec::new() };

    /// The parameters `declared` of `[control]`, as [`DeclaredTable::of`].
    pub fn of(declared: &'static [LawParameter]) -> Self {
        ControlInput { law: DeclaredTable::of(Name::NONE, declared), ..Self::NONE }
    }

    /// True for the loop of a campaign file, with phases and models of its motors.
    pub fn has_loop(&self) -> bool {
        !self.guidance.is_empty()
    }

    /// All tables with their headers.
    pub fn tables(&self) -> impl Iterator<Item = (&'static str, &DeclaredTable)> {
        let sensors = self.sensors.iter().map(|table| ("sensors", table));
        let guidance = self.guidance.iter().map(|table| ("guidance", table));
        std::iter::once(("control", &self.law)).chain(sensors).chain(guidance)
    }

    /// [`DeclaredTable::named`] of `[control]`.
    pub fn named(&self, key: &str) -> Option<&[f64]> {
        self.law.named(key)
    }

    /// Takes the values of the same tables of `other`, without allocation.
    pub fn take_values(&mut self, other: &ControlInput) {
        self.law.values.clone_from(&other.law.values);
        let own = self.sensors.iter_mut().chain(&mut self.guidance);
        for (table, of_other) in own.zip(other.sensors.iter().chain(&other.guidance)) {
            table.values.clone_from(&of_other.values);
        }
    }

    /// Notes violated limits.
    pub(in crate::scene) fn check(&self, problems: &mut Problems) {
        self.tables().for_each(|(header, table)| table.check(header, problems));
    }
}
