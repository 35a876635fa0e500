//! [`KnownColumns`]: the columns that requirements, expressions and lists in a campaign file can name.

use super::meaning::meant;
use super::units;
use crate::observables::band_series::band_series;
use crate::observables::window::Window;
use crate::observables::{Group, Request, table};
use crate::run::Quantity;

#[derive(Clone, Debug)]
pub struct KnownColumns {
    request: Request,
    /// Observables of the rows, then derived ones.
    observables: Vec<Quantity>,
    /// Quantities with bands.
    bands: Vec<Quantity>,
}

impl KnownColumns {
    pub fn new(request: Request) -> Self {
        let observables = request.columns().into_iter().map(|column| column.quantity).collect();
        let bands = band_series(&request).into_iter().map(|band| band.quantity).collect();
        KnownColumns { request, observables, bands }
    }

    pub fn add(&mut self, quantity: Quantity) {
        self.observables.push(quantity);
    }

    pub fn observable(&self, name: &str) -> Option<&Quantity> {
        self.observables.iter().find(|quantity| quantity.name() == name)
    }

    pub fn band(&self, name: &str) -> Option<&Quantity> {
        self.bands.iter().find(|quantity| quantity.name() == name)
    }

    /// The quantity with bands whose largest, smallest, mean or last value the observable `name` is.
    pub fn over_time(&self, name: &str) -> Option<String> {
        let word = ["_max_", "_min_", "_mean_", "_final_"].into_iter().find(|word| name.contains(word))?;
        Some(name.replacen(word, "_", 1)).filter(|name| self.band(name).is_some())
    }

    /// The extreme over `times` of the quantity with bands called `name`, and its column.
    pub fn window(&self, name: &str, is_highest: bool, times: [Option<f64>; 2]) -> Option<(Window, String)> {
        let band = band_series(&self.request).into_iter().find(|band| band.quantity.name() == name)?;
        let window = band.window(&self.request, is_highest, times);
        Some((window, window.quantity(&band.quantity).name().to_owned()))
    }

    /// Allowed names and remedy for a `name` without bands.
    pub fn band_refusal(&self, name: &str) -> (String, String) {
        let is_of_other_groups = band_series(&self.everything()).iter().any(|band| band.quantity.name() == name);
        let remedy = if is_of_other_groups {
            "it is in a group that is not observed: add its group to observe.groups (`spindrift columns` lists them)"
                .to_owned()
        } else {
            let names = || self.bands.iter().map(Quantity::name);
            let all = || format!("name one of {}", names().collect::<Vec<_>>().join(", "));
            meant(name, names()).map_or_else(all, |meant| meant.remedy())
        };
        ("a quantity over time with bands: a column of bands.parquet".to_owned(), remedy)
    }

    /// Allowed names and remedy for a `name` that is not an observable.
    pub fn refusal(&self, name: &str) -> (String, String) {
        let columns = self.everything().columns();
        let remedy = if let Some(column) = columns.iter().find(|column| column.quantity.name() == name) {
            format!("it is in the group {0}: add {0:?} to observe.groups", column.group.name())
        } else if table::all().any(|column| column.quantity.name() == name) {
            "this scene or method does not have it: name another".to_owned()
        } else {
            let meant = meant(name, self.observables.iter().map(Quantity::name));
            meant.map_or_else(|| "docs/columns.md lists them".to_owned(), |meant| meant.remedy())
        };
        let allowed = "an observable of this campaign: a column of its rows, or a [[observable]] of this file";
        (allowed.to_owned(), remedy)
    }

    fn everything(&self) -> Request {
        Request { groups: Group::ALL.into_iter().collect(), ..self.request }
    }
}

/// The unit of `quantity` in keys; `1` for a pure number or a unit that texts cannot have.
pub fn unit_of(quantity: &Quantity) -> &'static str {
    units::known(quantity.unit()).unwrap_or("1")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: limits can be written in every column's unit.
    #[test]
    fn units_of_columns_are_known() {
        for column in table::all() {
            let unit = column.quantity.unit();
            assert!(unit.is_empty() || unit_of(&column.quantity) == unit, "{}: {unit}", column.quantity.name());
        }
    }
}
