//! The columns of a plan's rows: observables ([`request`]) and draws ([`parameter_quantity`]).

use super::event::Event;
use super::event_columns;
use super::extreme::Extreme;
use crate::dynamics::effects::ForceModel;
use crate::loops::ControlLaw;
use crate::observables::request::NutationAxis;
use crate::observables::window::NO_WINDOWS;
use crate::observables::{Group, LawColumns, Request};
use crate::propagation::Method;
use crate::run::Quantity;
use crate::scene::{Actuated, Parameter, SceneInput};

/// The observables of a plan. `acting`: the nominal scene with the commands that act in a run, besides those of `law`.
pub fn request(
    groups: &[Group],
    acting: &SceneInput,
    method: Method,
    law: Option<&ControlLaw>,
    (events, extremes): (&[Event], &[Extreme]),
) -> Request {
    let of_extremes = extremes.iter().map(Extreme::column).collect();
    let watched =
        [event_columns::of_failures(acting), event_columns::of_events(events, law.is_some()), of_extremes].concat();
    let commanded = law.map_or(Actuated::NONE, |law| law.commands);
    Request {
        groups: groups.iter().copied().collect(),
        debris: acting.debris.is_some(),
        actuated: Actuated::of(acting).and(commanded),
        effects: ForceModel::of_input(acting),
        constrained: method == Method::NullSpace,
        wheels: acting.turning_wheels(),
        nutation_axis: NutationAxis::SpinAxis,
        of_law: law.map_or(LawColumns::NONE, |law| law.columns).with_events(watched),
        windows: NO_WINDOWS,
    }
}

pub fn parameter_quantity(parameter: Parameter, component: usize) -> Quantity {
    let unit = match parameter.unit() {
        "1" => String::new(),
        unit => unit.to_owned(),
    };
    let meaning = format!("{} as applied.", parameter.component_name(component));
    Quantity::named(parameter.column_name(component), unit, meaning)
}
