//! [`KnownColumns`]: the columns of the rows of a plan by name: what requirements, expressions and lists of columns in
//! a campaign file mean.

use super::meaning::meant;
use super::units;
use crate::observables::band_series::band_series;
use crate::observables::window::Window;
use crate::observables::{Group, Request, table};
use crate::run::Quantity;

/// What can be named in a campaign file.
#[derive(Clone, Debug)]
pub struct KnownColumns {
    request: Request,
    /// Observables, and then those that the file derives.
    observables: Vec<Quantity>,
    /// The quantities that have bands.
    bands: Vec<Quantity>,
}

impl KnownColumns {
    /// The observables of `request`.
    pub fn new(request: Request) -> Self {
        let observables = request.columns().into_iter().map(|column| column.quantity).collect();
        let bands = band_series(&request).into_iter().map(|band| band.quantity).collect();
        KnownColumns { request, observables, bands }
    }

    /// Adds an observable that the file derives.
    pub fn add(&mut self, quantity: Quantity) {
        self.observables.push(quantity);
    }

    /// The observable called `name`.
    pub fn observable(&self, name: &str) -> Option<&Quantity> {
        self.observables.iter().find(|quantity| quantity.name() == name)
    }

    /// The quantity called `name` that has bands.
    pub fn band(&self, name: &str) -> Option<&Quantity> {
        self.bands.iter().find(|quantity| quantity.name() == name)
    }

    /// The quantity over time, which has bands, whose largest, smallest, mean or last value the observable `name` is.
    pub fn over_time(&self, name: &str) -> Option<String> {
        let word = ["_max_", "_min_", "_mean_", "_final_"].into_iter().find(|word| name.contains(word))?;
        Some(name.replacen(word, "_", 1)).filter(|name| self.band(name).is_some())
    }

    /// The extreme of the quantity called `name`, which has bands, over `times`, and the name of its column.
    pub fn window(&self, name: &str, is_highest: bool, times: [Option<f64>; 2]) -> Option<(Window, String)> {
        let band = band_series(&self.request).into_iter().find(|band| band.quantity.name() == name)?;
        let window = band.window(&self.request, is_highest, times);
        Some((window, window.quantity(&band.quantity).name().to_owned()))
    }

    /// What is allowed in place of `name`, which has no bands, and what to do.
    pub fn band_refusal(&self, name: &str) -> (String, String) {
        let allowed = "a quantity over time with bands: a column of bands.parquet".to_owned();
        let everything = Request { groups: Group::ALL.into_iter().collect(), ..self.request };
        let is_of_other_groups = band_series(&everything).iter().any(|band| band.quantity.name() == name);
        let remedy = if is_of_other_groups {
            "it is in a group that is not observed: add its group to observe.groups (`spindrift columns` lists them)"
                .to_owned()
        } else {
            let list = || self.bands.iter().map(Quantity::name);
            match meant(name, list()) {
                Some(meant) => meant.remedy(),
                None => format!("name one of {}", list().collect::<Vec<_>>().join(", ")),
            }
        };
        (allowed, remedy)
    }

    /// What is allowed in place of `name`, which is no observable, and what to do.
    pub fn refusal(&self, name: &str) -> (String, String) {
        let allowed = "an observable of this campaign: a column of its rows, or a [[observable]] of this file";
        let everything = Request { groups: Group::ALL.into_iter().collect(), ..self.request };
        if let Some(column) = everything.columns().iter().find(|column| column.quantity.name() == name) {
            let remedy = format!("it is in the group {0}: add {0:?} to observe.groups", column.group.name());
            return (allowed.to_owned(), remedy);
        }
        let remedy = if table::all().any(|column| column.quantity.name() == name) {
            "this scene or method does not have it: name another".to_owned()
        } else {
            match meant(name, self.observables.iter().map(Quantity::name)) {
                Some(meant) => meant.remedy(),
                None => "docs/columns.md lists them".to_owned(),
            }
        };
        (allowed.to_owned(), remedy)
    }
}

/// The unit of `quantity` as keys have theirs; `1` for a pure number, and for a unit that texts cannot have.
pub fn unit_of(quantity: &Quantity) -> &'static str {
    units::known(quantity.unit()).unwrap_or("1")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: limits can be written in the unit of every column.
    #[test]
    fn units_of_columns_are_known() {
        for column in table::all() {
            let unit = column.quantity.unit();
            assert!(unit.is_empty() || unit_of(&column.quantity) == unit, "{}: {unit}", column.quantity.name());
        }
    }
}
