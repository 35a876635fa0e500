//! Quantities of events and extremes: one over time, or an expression of several.

use super::meaning::meant;
use super::section::Section;
use crate::observables::band_series::{BandSeries, event_series};
use crate::observables::{Group, Groups, Request};
use crate::sampling::expression::Expression;
use crate::sampling::keys::{Kind, Row};

pub(super) const QUANTITY: Row =
    Row::new("quantity", Kind::Expression, "An observed quantity over time, or an expression of several")
        .required_as("a quantity over time, or an expression of some", "\"angular_rate_rad_s\"");

/// The expression `text` and its variables among `series`; `None` only for what reading a plan refuses.
pub fn parsed(text: &str, series: &[BandSeries]) -> Option<(Expression, Vec<BandSeries>)> {
    let expression = Expression::parse(text).ok()?;
    let of = |name: &String| series.iter().find(|band| band.quantity.name() == name).cloned();
    let variables = expression.variables().iter().map(of).collect::<Option<_>>()?;
    Some((expression, variables))
}

/// The quantities in `text`; `None` after a problem.
pub(super) fn variables(
    table: &mut Section<'_, '_>,
    text: &str,
    (series, observed): (&[BandSeries], &Request),
) -> Option<Vec<BandSeries>> {
    let parsed = Expression::parse(text).ok()?;
    if parsed.variables().is_empty() {
        return table.refused("quantity", "made of quantities over time", "name one, such as \"angular_rate_rad_s\"");
    }
    let mut found = Vec::new();
    for name in parsed.variables() {
        let Some(band) = series.iter().find(|band| band.quantity.name() == name) else {
            let (allowed, remedy) = refusal(name, series, observed);
            table.refuse_value("quantity", format!("{name:?}"), allowed, remedy);
            return None;
        };
        found.push(band.clone());
    }
    Some(found)
}

fn refusal(name: &str, series: &[BandSeries], observed: &Request) -> (String, String) {
    let names = || series.iter().map(|band| band.quantity.name());
    let allowed = "made of quantities over time that are observed".to_owned();
    let mut of = *observed;
    let group = Group::ALL.into_iter().find(|group| {
        of.groups = Groups::NONE.with(*group);
        event_series(&of).iter().any(|band| band.quantity.name() == name)
    });
    let remedy = match (group, meant(name, names())) {
        (Some(group), _) => {
            format!("it is in a group that is not observed: add {:?} to observe.groups", group.name())
        }
        (None, Some(meant)) => meant.remedy(),
        (None, None) => format!("name some of {}", names().collect::<Vec<_>>().join(", ")),
    };
    (allowed, remedy)
}
