//! The keys of a `[[disperse]]` table.
//!
//! How a distribution is written is in its own file ([`crate::sampling::distribution`]).

use super::parameter::parameter;
use super::section::Section;
use super::units;
use crate::sampling::{Dispersion, DistributionKind};

/// Reads one table; `None` where something is wrong, which is then noted.
pub fn read(table: &mut Section<'_, '_>) -> Option<Dispersion> {
    let kind = table.plain_text("distribution").and_then(DistributionKind::from_name);
    if kind.is_some_and(DistributionKind::names_parameters) {
        table.describes(None, units::UNKNOWN);
        let distribution = table.distribution()?;
        let (parameter, component) = distribution.written.columns().first()?.target?;
        return Some(Dispersion { parameter, component: Some(component), distribution });
    }
    let target = parameter(table, "parameter");
    // where the name is wrong, that is told; nobody can say which units were meant
    match target {
        Some((parameter, _)) => table.describes(parameter.name(), parameter.unit()),
        None => table.describes(None, units::UNKNOWN),
    }
    let distribution = table.distribution();
    let ((parameter, component), distribution) = target.zip(distribution)?;
    Some(Dispersion { parameter, component, distribution })
}
