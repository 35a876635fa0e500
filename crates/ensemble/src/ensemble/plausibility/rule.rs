//! [`Rule`]: a size, its limit and the note.

use std::collections::BTreeSet;

use super::looked::{Looked, digits};
use super::measures::Note;
use crate::scene::Parameter;

pub enum Look {
    /// Nominal values of the keys `table.key`, or with `table.*` of all in the rule's unit, and the distance of one
    /// draw in a hundred from them.
    Keys(&'static [&'static str]),
    Sizes(fn(&Looked<'_>, f64, &mut Note<'_>)),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    From(f64),
    Below(f64),
}

pub struct Rule {
    /// For the documents.
    pub subject: &'static str,
    pub look: Look,
    pub limit: Limit,
    /// The SI unit, `1` for a pure number; the usual unit and its size in SI.
    pub unit: &'static str,
    pub known: (&'static str, f64),
    pub source: &'static str,
    pub usual: &'static str,
    pub remedy: &'static str,
}

impl Rule {
    /// Notes on broken limits, without parameters judged already.
    pub fn notes(&self, looked: &Looked<'_>, judged: &mut BTreeSet<String>) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        match self.look {
            Look::Sizes(sizes) => {
                let (Limit::From(limit) | Limit::Below(limit)) = self.limit;
                sizes(looked, limit, &mut |size, what| found.extend(self.is_broken_by(size).then_some(what)));
            }
            Look::Keys(keys) => {
                let own = looked.parameters().filter(|parameter| self.has(keys, *parameter));
                let new = own.filter(|parameter| judged.insert(parameter.name()));
                found.extend(new.filter_map(|parameter| self.of_parameter(looked, parameter)));
            }
        }
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
            // a spread has no lower limit
            let spread = looked.spread(parameter).filter(|_| matches!(self.limit, Limit::From(_)));
            (spread.filter(|size| self.is_broken_by(*size))?, ", as dispersed, is off by so much in 1 draw of 100")
        };
        let (unit, factor) = self.known;
        let known = if unit.is_empty() { String::new() } else { format!(" is {} {unit}", digits(size * factor)) };
        Some(format!("{}{how}: {} {}{known}", parameter.name(), digits(size), self.unit))
    }
}
