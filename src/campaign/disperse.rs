//! The keys of a `[[disperse]]` table.
//!
//! How a distribution is written is in its own file ([`crate::sampling::distribution`]).

use super::numbers::DISTANCES;
use super::parameter::parameter;
use super::section::Section;
use super::units;
use crate::sampling::{Dispersion, WrittenDistribution};

/// Reads one table; `None` where something is wrong, which is then noted.
pub fn read(table: &mut Section<'_, '_>) -> Option<Dispersion> {
    if table.is_name_of("distribution", &WrittenDistribution::naming_parameters()) {
        return of_named_parameters(table);
    }
    let target = parameter(table, "parameter");
    // where the name is wrong, that is told; nobody can say which units were meant
    table.describes(target.map_or(units::UNKNOWN, |(parameter, _)| parameter.unit()));
    let distribution = WrittenDistribution::read(table);
    if let (Some((parameter, _)), Some(unit)) = (target, DISTANCES.iter().find_map(|key| table.unit_written(key)))
        && unit != parameter.unit()
    {
        table.document.units.push((parameter.name(), unit));
    }
    // without a distribution nobody can say which other keys belong here
    if distribution.is_some() || table.is_name_of("distribution", WrittenDistribution::NAMES) {
        table.finish();
    }
    let ((parameter, component), distribution) = target.zip(distribution)?;
    Some(Dispersion { parameter, component, distribution })
}

/// One table with a distribution that names its parameters itself.
fn of_named_parameters(table: &mut Section<'_, '_>) -> Option<Dispersion> {
    table.describes(units::UNKNOWN);
    let distribution = WrittenDistribution::read(table);
    table.finish();
    let distribution = distribution?;
    let (parameter, component) = distribution.columns().first()?.target?;
    Some(Dispersion { parameter, component: Some(component), distribution })
}
