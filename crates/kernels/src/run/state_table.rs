//! [`StateTable`]: states of a run at its observation points, the interface of integrators and observables.

use super::state_field::{StateField, StateFields};
use super::trajectory::Trajectory;

/// Requested fields at the observation points; access to others panics. Columns are padded to a multiple of eight with
/// the last point.
#[derive(Clone, Debug)]
pub struct StateTable {
    fields: StateFields,
    wheels: usize,
    /// Column of the first component of each field, or [`ABSENT`].
    columns: [usize; StateField::ALL.len()],
    states: Trajectory,
}

const ABSENT: usize = usize::MAX;

#[cold]
#[inline(never)]
fn refuse(field: StateField, component: usize, width: usize) -> ! {
    assert!(component < width, "{field:?} has {width} components, there is no component {component}");
    panic!("the state table does not have the field {field:?}: it was not requested when the table was made")
}

impl StateTable {
    /// Zeros at `points` >= 1 observation points for a spacecraft with `wheels` wheels.
    pub fn new(fields: StateFields, wheels: usize, points: usize) -> Self {
        let mut columns = [ABSENT; StateField::ALL.len()];
        let mut count = 0;
        for field in StateField::ALL {
            if fields.contains(field) {
                columns[field as usize] = count;
                count += field.width(wheels);
            }
        }
        StateTable { fields, wheels, columns, states: Trajectory::new(count, points) }
    }

    /// The fields of the table.
    pub fn fields(&self) -> StateFields {
        self.fields
    }

    /// Number of wheels of the spacecraft.
    pub fn wheels(&self) -> usize {
        self.wheels
    }

    /// Number of components of `field`.
    #[inline]
    pub fn width(&self, field: StateField) -> usize {
        field.width(self.wheels)
    }

    /// Number of observation points.
    pub fn points(&self) -> usize {
        self.states.points()
    }

    /// Number of points with padding, a multiple of eight.
    pub fn stride(&self) -> usize {
        self.states.stride()
    }

    /// True if the table has `field`.
    pub fn has(&self, field: StateField) -> bool {
        self.fields.contains(field)
    }

    #[inline]
    fn place(&self, field: StateField, component: usize) -> usize {
        let column = self.columns[field as usize];
        if column == ABSENT || component >= self.width(field) {
            refuse(field, component, self.width(field));
        }
        column + component
    }

    /// Component `component` of `field` at all points (with padding).
    ///
    /// # Panics
    /// If the table lacks the component.
    #[inline]
    pub fn column(&self, field: StateField, component: usize) -> &[f64] {
        self.states.column(self.place(field, component))
    }

    /// [`StateTable::column`], writable.
    #[inline]
    pub fn column_mut(&mut self, field: StateField, component: usize) -> &mut [f64] {
        let place = self.place(field, component);
        self.states.column_mut(place)
    }

    /// The first `N` components of `field` at point `point`; panics as [`StateTable::column`].
    pub fn at<const N: usize>(&self, field: StateField, point: usize) -> [f64; N] {
        std::array::from_fn(|component| self.column(field, component)[point])
    }

    /// Writes the first `N` components of `field` at point `point`; panics as [`StateTable::column`].
    pub fn set<const N: usize>(&mut self, field: StateField, point: usize, values: [f64; N]) {
        for (component, value) in values.into_iter().enumerate() {
            self.column_mut(field, component)[point] = value;
        }
    }

    /// Zeroes the wheels from `first` on, which may hold numbers of an earlier run with more wheels.
    pub fn clear_wheels(&mut self, first: usize) {
        for wheel in first..self.wheels {
            for field in [StateField::WheelRates, StateField::WheelAngles] {
                if self.has(field) {
                    self.column_mut(field, wheel).fill(0.0);
                }
            }
        }
    }

    /// Fills the padding of every component with its last point.
    pub fn pad(&mut self) {
        self.states.pad();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rates_and_wheels() -> StateTable {
        StateTable::new(StateFields::NONE.with(StateField::WheelRates).with(StateField::Rate), 2, 3)
    }

    // added to the marker of an absent field, this component would wrap around to the first column
    #[test]
    #[should_panic = "does not have the field Attitude"]
    fn an_absent_field_cannot_be_read_as_another() {
        rates_and_wheels().column(StateField::Attitude, 1);
    }

    #[test]
    #[should_panic = "WheelRates has 2 components"]
    fn a_component_beyond_the_width_is_not_that_of_the_next_field() {
        rates_and_wheels().column(StateField::WheelRates, 2);
    }
}
