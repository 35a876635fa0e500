//! [`Rule`]: what is looked at, from which size on it is noted, and what the note says.

use std::collections::BTreeSet;

use super::looked::{Found, Looked, digits};
use crate::scene::Parameter;

/// What a rule looks at.
pub enum Look {
    /// The numbers of these keys, `table.key`; `table.*` has all keys of the table in the unit of the rule. Nominal
    /// values are judged, and how far one draw in a hundred is from them.
    Keys(&'static [&'static str]),
    /// Sizes that follow from several numbers, where the limit is this.
    Sizes(fn(&Looked<'_>, f64) -> Vec<Found>),
}

/// From which size on there is a note.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    From(f64),
    Below(f64),
}

/// A row of the list.
pub struct Rule {
    /// What is looked at, for the documents.
    pub subject: &'static str,
    pub look: Look,
    /// In `unit`.
    pub limit: Limit,
    /// The SI unit, `1` of a pure number; the unit in which people know the number, and how many of it are one of SI.
    pub unit: &'static str,
    pub known: (&'static str, f64),
    /// Where the limit comes from.
    pub source: &'static str,
    pub usual: &'static str,
    pub remedy: &'static str,
}

impl Rule {
    /// The notes on what breaks the rule; parameters that are judged already are left out.
    pub fn notes(&self, looked: &Looked<'_>, judged: &mut BTreeSet<String>) -> Vec<String> {
        let found = match self.look {
            Look::Sizes(sizes) => {
                let (Limit::From(limit) | Limit::Below(limit)) = self.limit;
                sizes(looked, limit)
                    .into_iter()
                    .filter(|found| self.is_broken_by(found.size))
                    .map(|found| found.what)
                    .collect()
            }
            Look::Keys(keys) => {
                let own: Vec<Parameter> = looked.parameters().filter(|parameter| self.has(keys, *parameter)).collect();
                own.into_iter()
                    .filter(|parameter| judged.insert(parameter.name()))
                    .filter_map(|parameter| self.of_parameter(looked, parameter))
                    .collect::<Vec<String>>()
            }
        };
        found.into_iter().map(|what| format!("{what}; {}; {}", self.usual, self.remedy)).collect()
    }

    fn is_broken_by(&self, size: f64) -> bool {
        match self.limit {
            Limit::From(limit) => size >= limit,
            Limit::Below(limit) => size < limit,
        }
    }

    fn has(&self, keys: &[&str], parameter: Parameter) -> bool {
        let (name, facts) = (parameter.name(), parameter.facts());
        let table = name.split('.').next().unwrap_or_default();
        keys.iter().any(|pattern| {
            let (of, key) = pattern.split_once('.').unwrap_or((pattern, "*"));
            of == table && (key == facts.key || key == "*" && facts.unit == self.unit)
        })
    }

    fn of_parameter(&self, looked: &Looked<'_>, parameter: Parameter) -> Option<String> {
        let nominal = looked.nominal(parameter);
        let (size, how) = if self.is_broken_by(nominal) {
            (nominal, "")
        } else {
            // what a spread may be has no lower limit
            let spread = looked.spread(parameter).filter(|_| matches!(self.limit, Limit::From(_)));
            (spread.filter(|size| self.is_broken_by(*size))?, ", as dispersed, is off by so much in 1 draw of 100")
        };
        let (unit, factor) = self.known;
        let known = if unit.is_empty() { String::new() } else { format!(" is {} {unit}", digits(size * factor)) };
        Some(format!("{}{how}: {} {}{known}", parameter.name(), digits(size), self.unit))
    }
}
