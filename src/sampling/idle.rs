//! Refuses a distribution that gives the nominal value in every draw, and so changes nothing: by itself, or at the only level that its design
//! has of it.

use super::columns::Column;
use super::design::Design;
use super::distribution::{Joint, Map, Quantile};
use super::error::{DispersionError, Table, error, error_of};
use super::transform::{Assigned, Transform};
use crate::scene::parameter::Shape;
use crate::scene::{Parameter, SceneInput};

/// The smallest and the largest u that a design gives, and two between.
const U: [f64; 4] = [0.5 * f64::EPSILON, 0.3, 0.8, 1.0 - 0.5 * f64::EPSILON];

/// Checks that a draw of the `index`-th distribution of the file, called `name`, may differ from the scene `nominal`; `maps` are its parts with
/// the components that each writes.
pub(super) fn check(
    index: usize,
    name: &str,
    maps: &[(Vec<(Parameter, usize)>, Transform)],
    nominal: &SceneInput,
) -> Result<(), DispersionError> {
    let nominals = |components: &[(Parameter, usize)]| -> Vec<f64> {
        components.iter().filter_map(|(parameter, component)| parameter.value(nominal, *component)).collect()
    };
    if maps.is_empty() || !maps.iter().all(|(components, map)| is_idle(map, &nominals(components))) {
        return Ok(());
    }
    let values: Vec<f64> = maps.iter().flat_map(|(components, _)| nominals(components)).collect();
    let value = if let [value] = values[..] { format!("{value:?}") } else { format!("{values:?}") };
    let allowed = format!("such that draws differ from the nominal value: every draw is {value}");
    let remedy = "make it wider (its width is zero, or below the rounding of the nominal value), or delete this table";
    Err(error(index, "distribution", format!("{name:?}"), allowed, remedy))
}

/// Checks that what is drawn of an attitude or a direction is not its length alone, which has no effect: a single component of a vector whose
/// others are zero. `assigned` and the columns `others` (of files and expressions) are what `columns` are drawn from.
pub(super) fn check_lengths(
    assigned: &[Assigned],
    others: &[usize],
    columns: &[Column],
    nominal: &SceneInput,
) -> Result<(), DispersionError> {
    let varied: Vec<&Assigned> = assigned.iter().filter(|one| !is_constant(one, columns)).collect();
    for one in &varied {
        let (Transform::Scalar(distribution), [column]) = (&one.map, &one.columns[..]) else { continue };
        let Column { parameter, component, nominal: value } = columns[*column];
        let is_own = |other: &usize| *other != *column && columns[*other].parameter == parameter;
        let has_others = varied.iter().flat_map(|other| &other.columns).chain(others).any(is_own);
        let is_zero = |other: usize| other == component || parameter.value(nominal, other) == Some(0.0);
        let is_along = parameter.has_free_length() && !has_others && (0..parameter.width()).all(is_zero);
        let ends = [U[0], U[3]].map(|u| distribution.quantile(u));
        let keeps_sign = parameter.shape() == Shape::Quaternion || ends.iter().all(|end| end * value > 0.0);
        if is_along && keeps_sign {
            let name = format!("{:?}", parameter.component_name(component));
            let allowed =
                "a key with an effect: the other components are 0, and the length of this vector is divided out";
            let remedy = "disperse another component too, or the vector as a whole, or delete this table";
            return Err(error(one.table, "parameter", name, allowed.to_owned(), remedy));
        }
    }
    Ok(())
}

/// Checks that no `[[disperse]]` table has a single level in `design`, and there the nominal values; `assigned` are what they assign to `columns`,
/// `dimensions` the names of the random dimensions.
pub(super) fn check_levels(
    design: &Design,
    dimensions: &[String],
    assigned: &[Assigned],
    columns: &[Column],
) -> Result<(), DispersionError> {
    let is_idle = |assigned: &Assigned| {
        let taken = assigned.first..assigned.first + assigned.map.dimensions();
        let levels: Option<Vec<f64>> = taken.map(|dimension| design.only_number(dimension)).collect();
        let Some(levels) = levels.filter(|levels| !levels.is_empty()) else { return false };
        let mut values = vec![0.0; assigned.columns.len()];
        match &assigned.map {
            Transform::Scalar(distribution) => values[0] = distribution.quantile(levels[0]),
            Transform::Joint(joint) => joint.values(&levels, &mut values),
        }
        // a median of distribution functions may be off by their rounding
        let is_nominal = |(column, value): (&usize, f64)| {
            let nominal = columns[*column].nominal;
            (value - nominal).abs() <= 4.0 * f64::EPSILON * nominal.abs()
        };
        assigned.columns.iter().zip(values).all(is_nominal)
    };
    let of_table = |table: usize| assigned.iter().filter(move |other| other.table == table);
    let Some(idle) = assigned.iter().find(|one| of_table(one.table).all(is_idle)) else { return Ok(()) };
    let name = &dimensions[idle.first];
    let allowed = format!("a design that changes {name}: there is one level of it, which is its nominal value");
    let remedy = format!("ask for two levels or more of {name}, or delete its [[disperse]] table");
    Err(error_of(Table::Design, "kind", format!("{:?}", design.name()), allowed, remedy))
}

/// Whether every draw of `one` is the nominal values of the `columns` that it writes.
pub(super) fn is_constant(one: &Assigned, columns: &[Column]) -> bool {
    let nominals: Vec<f64> = one.columns.iter().map(|column| columns[*column].nominal).collect();
    is_idle(&one.map, &nominals)
}

/// Whether every draw of `map` is the `nominals`, the values of its components.
fn is_idle(map: &Transform, nominals: &[f64]) -> bool {
    match map {
        // a quantile function rises from one end to the other
        Transform::Scalar(distribution) => U.iter().all(|u| nominals == [distribution.quantile(*u)]),
        Transform::Joint(Joint::Bootstrap(rows)) => rows.all_are(nominals),
        Transform::Joint(joint) => {
            let dimensions = joint.dimensions() as u32;
            let mut values = vec![0.0; joint.components()];
            (0..U.len().pow(dimensions)).all(|corner| {
                let u: Vec<f64> = (0..dimensions).map(|axis| U[corner / U.len().pow(axis) % U.len()]).collect();
                joint.values(&u, &mut values);
                values == nominals
            })
        }
    }
}
