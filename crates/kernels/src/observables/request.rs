//! [`Request`]: columns, series and state fields observed in one kind of scene.

use core::ops::Range;

use super::group::{Group, Groups};
use super::law_columns::LawColumns;
use super::reduction::{Passes, Reduction, Stored};
use super::rows::{Facts, SeriesSource};
use super::table::{self, Column, ColumnId, Series};
use super::window::Windows;
use crate::dynamics::effects::ForceModel;
use crate::math::list::List;
use crate::math::symmetric::principal_axes;
use crate::run::{StateField, StateFields};
use crate::scene::{Actuated, MAX_WHEELS, Name};

/// Observed groups and kind of scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// Requested groups.
    pub groups: Groups,
    /// True with a debris body.
    pub debris: bool,
    /// Actuators used at some time.
    pub actuated: Actuated,
    /// Effects that act.
    pub effects: ForceModel,
    /// True for the null-space method, which integrates constraints and the DCM.
    pub constrained: bool,
    /// Names of the turning wheels.
    pub wheels: List<Name, MAX_WHEELS>,
    /// Axis of nutation.
    pub nutation_axis: NutationAxis,
    /// Reports of the control law; their columns precede windows.
    pub of_law: LawColumns,
    /// Extremes over intervals of time.
    pub windows: Windows,
}

/// Axis whose angle from the angular momentum is the nutation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NutationAxis {
    /// s3.
    #[default]
    SpinAxis,
    /// The run's own principal axis nearest to s3, with locked wheels.
    Principal,
    /// A unit vector in F_s.
    Along([f64; 3]),
}

impl NutationAxis {
    /// Axis in F_s for this inertia; `None` for s3.
    pub fn of(self, inertia: [[f64; 3]; 3]) -> Option<[f64; 3]> {
        match self {
            NutationAxis::SpinAxis => None,
            NutationAxis::Along(axis) => Some(axis),
            NutationAxis::Principal => Some(nearest_principal_axis(inertia)),
        }
    }
}

/// Principal axis of `inertia` nearest to s3, pointing along it.
pub fn nearest_principal_axis(inertia: [[f64; 3]; 3]) -> [f64; 3] {
    let (_, columns) = principal_axes(inertia);
    let axis = |k: usize| columns.map(|row| row[k]);
    let nearest = (0..3).max_by(|a, b| axis(*a)[2].abs().total_cmp(&axis(*b)[2].abs())).unwrap_or(2);
    let axis = axis(nearest);
    if axis[2] < 0.0 { axis.map(|x| -x) } else { axis }
}

/// Names of wheels.
pub type WheelNames = List<Name, MAX_WHEELS>;

/// List of wheel names.
///
/// # Panics
/// If a name is invalid, or there are more than [`MAX_WHEELS`].
pub fn wheel_names(names: &[&str]) -> WheelNames {
    let mut list = List::empty(Name::NONE);
    names.iter().for_each(|name| list.push(Name::of(name)));
    list
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SeriesSet(u128);

impl SeriesSet {
    pub(super) const fn with(self, series: Series) -> Self {
        SeriesSet(self.0 | 1 << series.index())
    }

    pub(super) const fn has(self, series: Series) -> bool {
        self.0 & (1 << series.index()) != 0
    }

    pub(super) fn has_any_of(self, source: SeriesSource) -> bool {
        Series::all().any(|series| self.has(series) && series.row().source == source)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SeriesTask {
    pub(super) series: Series,
    pub(super) passes: Passes,
    pub(super) stored: Stored,
    /// Divisor of its errors or fraction, of an earlier task.
    pub(super) scale: Option<(Series, Reduction)>,
}

impl Request {
    fn facts(&self) -> Facts {
        let Request { debris, actuated, effects, constrained, .. } = *self;
        Facts { debris, actuated, effects, constrained, wheels: self.wheels.len() }
    }

    /// Columns of a row, in order: those of the groups that exist in this scene.
    pub fn columns(&self) -> Vec<Column> {
        let shown = |(column, wheel): (&Column, Option<usize>)| match wheel {
            Some(index) => column.of_wheel(index, self.wheels[index]),
            None => column.clone(),
        };
        let windows = self.windows.iter().enumerate().map(|(index, window)| window.column(&self.wheels, index));
        self.rows().into_iter().map(shown).chain(self.of_law.columns()).chain(windows).collect()
    }

    /// Positions of the control law's reports in a row.
    pub fn places_of_law(&self) -> Range<usize> {
        let start = self.rows().len();
        start..start + self.of_law.list.len() - self.of_law.of_events
    }

    /// Positions of the times of events and failures in a row.
    pub fn places_of_events(&self) -> Range<usize> {
        let start = self.places_of_law().end;
        start..start + self.of_law.of_events
    }

    /// Position of a column in a row, if any.
    pub fn position(&self, id: ColumnId) -> Option<usize> {
        self.ids().position(|other| other == id)
    }

    /// The [`Request::columns`] of the table, each with its wheel.
    fn rows(&self) -> Vec<(&'static Column, Option<usize>)> {
        let facts = self.facts();
        let is_requested = |column: &&Column| self.groups.contains(column.group) && column.scenes.include(&facts);
        let mut rows = Vec::new();
        for family in table::families() {
            let requested: Vec<&Column> = family.iter().filter(is_requested).collect();
            if requested.iter().any(|column| column.is_of_wheel()) {
                for index in 0..self.wheels.len() {
                    rows.extend(requested.iter().map(|column| (*column, Some(index))));
                }
            } else {
                rows.extend(requested.into_iter().map(|column| (column, None)));
            }
        }
        rows
    }

    pub(super) fn ids(&self) -> impl Iterator<Item = ColumnId> {
        let rows = self.rows().into_iter().map(|(column, wheel)| match wheel {
            Some(index) => ColumnId { value: column.value.of_wheel(index), ..column.id() },
            None => column.id(),
        });
        rows.chain(self.of_law.ids()).chain(self.windows.iter().enumerate().map(|(index, window)| window.id(index)))
    }

    /// Columns of a time series, in order.
    pub fn series(&self) -> Vec<Series> {
        let observed = self.observed();
        Series::all().filter(|series| observed.has(*series) && series.quantity(&self.wheels).is_some()).collect()
    }

    /// Fields of the state table that the columns need.
    pub fn fields(&self) -> StateFields {
        self.needs().into_iter().fold(StateFields::NONE, |fields, (_, field, _)| fields.with(field))
    }

    /// Groups and purposes for which each field is needed, in the order of the table.
    pub fn reasons(&self) -> Vec<(StateField, String)> {
        let needs = self.needs();
        let reason = |field: StateField| {
            let parts: Vec<String> = needs
                .iter()
                .filter(|(_, needed, _)| *needed == field)
                .map(|(group, _, why)| format!("{} ({why})", group.name()))
                .collect();
            (!parts.is_empty()).then(|| (field, parts.join(", ")))
        };
        StateField::ALL.into_iter().filter_map(reason).collect()
    }

    /// Series behind the columns, with their scales, and those recorded by the control law.
    pub(super) fn observed(&self) -> SeriesSet {
        let of_columns = self.inputs().map(|(series, _)| series);
        of_columns.chain(self.of_law.over_time.series()).fold(SeriesSet::default(), SeriesSet::with)
    }

    /// Passes over the observed series; scales come first.
    pub(super) fn tasks(&self) -> Vec<SeriesTask> {
        let (observed, values) = (self.observed(), self.ids().map(|id| id.value).collect::<Vec<_>>());
        let passes = |series: Series| {
            let of_series = values.iter().flat_map(|value| value.inputs()).filter(|(other, _)| *other == series);
            of_series.fold(Passes::default(), |passes, (_, reduction)| passes.with(reduction))
        };
        let observed = Series::all().filter(|series| observed.has(*series));
        let scale = |series: Series| values.iter().filter(|value| value.of(series)).find_map(|value| value.scale());
        let task = |series: Series| SeriesTask {
            series,
            passes: passes(series),
            stored: series.row().stored,
            scale: scale(series),
        };
        let mut tasks: Vec<SeriesTask> = observed.map(task).collect();
        tasks.sort_by_key(|task| task.scale.is_some());
        tasks
    }

    fn inputs(&self) -> impl Iterator<Item = (Series, Reduction)> {
        self.ids().flat_map(|id| id.value.inputs().collect::<Vec<_>>())
    }

    fn needs(&self) -> Vec<(Group, StateField, &'static str)> {
        let (facts, mut needs) = (self.facts(), Vec::new());
        for ColumnId { group, value } in self.ids() {
            for need in value.needs().filter(|need| need.scenes.include(&facts)) {
                let entry = (group, need.field, need.why);
                if !needs.contains(&entry) {
                    needs.push(entry);
                }
            }
        }
        needs
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::observables::window::NO_WINDOWS;

    /// Without actuation, effects, columns of a law and windows.
    pub(in crate::observables) fn request(
        groups: &[Group],
        debris: bool,
        constrained: bool,
        wheels: &[&str],
    ) -> Request {
        Request {
            groups: groups.iter().copied().collect(),
            debris,
            actuated: Actuated::NONE,
            effects: ForceModel::NONE,
            constrained,
            wheels: wheel_names(wheels),
            nutation_axis: NutationAxis::SpinAxis,
            of_law: LawColumns::NONE,
            windows: NO_WINDOWS,
        }
    }
    /// Law: a row has the columns of the bodies, constraints and actuators of its scene.
    #[test]
    fn columns_are_those_of_the_scene() {
        let none = Actuated::NONE;
        let thrusters = Actuated { thrusters: true, ..none };
        let others = Actuated { motors: true, body_torque: true, ..none };
        let motors = Actuated { motors: true, ..none };
        let (own, of_debris) = ("linear_momentum_error_max", "debris_linear_momentum_error_max");
        let [kinematic, collocation] = ["residual_kinematic_max_m_s", "residual_collocation_max_m"];
        let residual = "residual_attitude_max";
        let [by_thrust, by_motors] = ["work_thrusters_final_j", "work_motors_final_j"];
        let wheels = &["w1", "w2"][..];
        type Names<'a> = &'a [&'a str];
        let cases: [(Actuated, bool, bool, Names<'_>, Names<'_>); 8] = [
            (none, true, false, wheels, &[]),
            (others, true, false, wheels, &[by_thrust, by_motors]),
            (motors, false, false, wheels, &[by_motors]),
            (thrusters, true, false, wheels, &[by_thrust, own]),
            (none, false, true, &[], &[own, residual]),
            (none, false, true, &["w1"], &[own, kinematic, collocation, residual]),
            (none, true, true, &[], &[own, of_debris, kinematic, collocation, residual]),
            (thrusters, true, true, wheels, &[by_thrust, own, of_debris, kinematic, collocation, residual]),
        ];
        for (actuated, debris, constrained, wheels, expected) in cases {
            let request = Request { actuated, ..request(&Group::DEFAULT, debris, constrained, wheels) };
            let columns = request.columns();
            let names: Vec<&str> = columns.iter().map(|column| column.quantity.name()).collect();
            for name in [by_thrust, by_motors, own, of_debris, kinematic, collocation, residual] {
                assert_eq!(names.contains(&name), expected.contains(&name), "{name} of {request:?}");
            }
            let has = |field| request.fields().contains(field);
            assert_eq!(has(StateField::Work), actuated.any());
            assert_eq!(has(StateField::Impulse), actuated.thrusters);
            assert_eq!(has(StateField::AngularImpulse), actuated.external());
        }
    }
}
