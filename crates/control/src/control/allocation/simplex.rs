//! [`least`]: a small linear program with bounded variables and lexicographic costs, in fixed-size memory.
//!
//! The tableau simplex method (G. B. Dantzig, *Linear Programming and Extensions*, 1963, chapters 5 and 18 for bounds)
//! with the anticycling rule of R. G. Bland (Mathematics of Operations Research 2(2), 1977).

use crate::scene::MAX_THRUSTERS;

/// Most equations: a force and a torque.
pub(super) const ROWS: usize = 6;
/// Most variables: thrusts, a share, and deficit and excess of each equation.
pub(super) const COLUMNS: usize = MAX_THRUSTERS + 1 + 2 * ROWS;
pub(super) const LEVELS: usize = 4;

/// Rounding threshold of reduced costs and pivots, with entries and costs of order one.
const NEGLIGIBLE: f64 = 1e-10;
/// Most steps, in case rounding defeats Bland's rule; 1,000 random sets take at most 40.
const MOST_STEPS: usize = 500;

/// A variable: entries in the equations, upper bound (the lower is zero), and costs by priority.
#[derive(Clone, Copy, Debug)]
pub(super) struct Column {
    pub entries: [f64; ROWS],
    pub most: f64,
    pub costs: [f64; LEVELS],
    pub starts_at_most: bool,
}

impl Column {
    pub const BLANK: Column = Column { entries: [0.0; ROWS], most: 0.0, costs: [0.0; LEVELS], starts_at_most: false };
}

struct Tableau<'a> {
    rows: usize,
    columns: &'a [Column],
    /// Inverse of the basis times the columns, by rows.
    entries: [[f64; COLUMNS]; ROWS],
    costs: [[f64; COLUMNS]; LEVELS],
    /// Basic variable of each row, and its value.
    basis: [usize; ROWS],
    values: [f64; ROWS],
    is_basic: [bool; COLUMNS],
    is_at_most: [bool; COLUMNS],
}

/// The variables of least cost that satisfy the first `rows` equations, entries times variables = `wanted`.
///
/// The columns from `units` on form the unit matrix and then its negative, the initial basis by the sign of `wanted`.
/// Entries, costs and `wanted` are of order one. Error: a few roundings times the condition of the last basis.
pub(super) fn least(rows: usize, columns: &[Column], units: usize, wanted: [f64; ROWS]) -> [f64; COLUMNS] {
    let mut tableau = Tableau::new(rows, columns, units, wanted);
    let mut steps = 0;
    while steps < MOST_STEPS && tableau.step() {
        steps += 1;
    }
    tableau.refine(units, wanted);
    tableau.variables()
}

impl<'a> Tableau<'a> {
    fn new(rows: usize, columns: &'a [Column], units: usize, wanted: [f64; ROWS]) -> Self {
        let (zeros, nowhere) = ([0.0; COLUMNS], [false; COLUMNS]);
        let (entries, costs) = ([zeros; ROWS], [zeros; LEVELS]);
        let (is_basic, is_at_most) = (nowhere, nowhere);
        let mut new = Tableau { rows, columns, entries, costs, basis: [0; ROWS], values: wanted, is_basic, is_at_most };
        for (j, column) in columns.iter().enumerate() {
            new.is_at_most[j] = column.starts_at_most;
            for level in 0..LEVELS {
                new.costs[level][j] = column.costs[level];
            }
        }
        new.values = new.missing(wanted);
        for row in 0..rows {
            let (basic, sign) = if new.values[row] < 0.0 { (units + rows + row, -1.0) } else { (units + row, 1.0) };
            (new.basis[row], new.is_basic[basic]) = (basic, true);
            new.values[row] *= sign;
            for (j, column) in columns.iter().enumerate() {
                new.entries[row][j] = sign * column.entries[row];
                for level in 0..LEVELS {
                    new.costs[level][j] -= columns[basic].costs[level] * new.entries[row][j];
                }
            }
        }
        new
    }

    /// `wanted` less the contribution of nonbasic variables.
    fn missing(&self, mut wanted: [f64; ROWS]) -> [f64; ROWS] {
        for (j, column) in self.columns.iter().enumerate().filter(|(j, _)| self.is_at_most[*j] && !self.is_basic[*j]) {
            debug_assert!(column.most.is_finite(), "variable {j} is at its limit");
            for (wanted, entry) in wanted.iter_mut().zip(column.entries).take(self.rows) {
                *wanted -= entry * column.most;
            }
        }
        wanted
    }

    /// The direction of variable `j` that lowers the cost, if any: up from zero or down from its upper bound.
    fn direction(&self, j: usize) -> Option<f64> {
        if self.is_basic[j] || self.columns[j].most == 0.0 {
            return None;
        }
        let cost = self.costs.iter().map(|level| level[j]).find(|cost| cost.abs() > NEGLIGIBLE)?;
        let direction = if self.is_at_most[j] { -1.0 } else { 1.0 };
        (direction * cost < 0.0).then_some(direction)
    }

    /// One step; false at the optimum.
    fn step(&mut self) -> bool {
        let entering = (0..self.columns.len()).find_map(|j| self.direction(j).map(|direction| (j, direction)));
        let Some((entering, direction)) = entering else { return false };
        // up to its own other bound or that of a basic variable
        let mut furthest = self.columns[entering].most;
        let mut leaving: Option<(usize, bool)> = None;
        for row in 0..self.rows {
            let falls = direction * self.entries[row][entering];
            if falls.abs() <= NEGLIGIBLE {
                continue;
            }
            let basic = self.basis[row];
            let bound = if falls > 0.0 { 0.0 } else { self.columns[basic].most };
            let distance = ((self.values[row] - bound) / falls).max(0.0);
            let is_first = |other: usize| basic < self.basis[other];
            let is_tie = distance == furthest && leaving.is_some_and(|(other, _)| is_first(other));
            if distance < furthest || is_tie {
                (furthest, leaving) = (distance, Some((row, falls < 0.0)));
            }
        }
        if furthest == f64::INFINITY {
            // costs are nonnegative: only rounding leads here
            return false;
        }
        for row in 0..self.rows {
            self.values[row] -= direction * furthest * self.entries[row][entering];
        }
        match leaving {
            None => self.is_at_most[entering] = !self.is_at_most[entering],
            Some((row, at_most)) => {
                let start = if self.is_at_most[entering] { self.columns[entering].most } else { 0.0 };
                let left = self.basis[row];
                (self.is_basic[left], self.is_at_most[left]) = (false, at_most);
                (self.is_basic[entering], self.is_at_most[entering]) = (true, false);
                (self.basis[row], self.values[row]) = (entering, start + direction * furthest);
                self.pivot(row, entering);
            }
        }
        true
    }

    fn pivot(&mut self, row: usize, column: usize) {
        let pivot = self.entries[row][column];
        let of_pivot = self.entries[row].map(|entry| entry / pivot);
        self.entries[row] = of_pivot;
        let (before, after) = self.entries.split_at_mut(row);
        let others = before.iter_mut().chain(after.iter_mut().skip(1));
        for other in others.chain(&mut self.costs) {
            let factor = other[column];
            if factor != 0.0 {
                for (entry, of_pivot) in other.iter_mut().zip(of_pivot) {
                    *entry -= factor * of_pivot;
                }
                other[column] = 0.0;
            }
        }
    }

    /// Recomputes the basic variables from the equations; gains up to two digits in 1,000 random sets.
    fn refine(&mut self, units: usize, wanted: [f64; ROWS]) {
        let mut missing = self.missing(wanted);
        for (basic, value) in self.basis.iter().zip(self.values).take(self.rows) {
            for (missing, entry) in missing.iter_mut().zip(self.columns[*basic].entries).take(self.rows) {
                *missing -= entry * value;
            }
        }
        // the unit matrix has become the inverse of the basis
        for row in 0..self.rows {
            let inverse = &self.entries[row][units..units + self.rows];
            self.values[row] += inverse.iter().zip(missing).map(|(entry, missing)| entry * missing).sum::<f64>();
        }
    }

    fn variables(&self) -> [f64; COLUMNS] {
        let mut found = [0.0; COLUMNS];
        for (j, column) in self.columns.iter().enumerate() {
            if self.is_at_most[j] {
                found[j] = column.most;
            }
        }
        for row in 0..self.rows {
            let basic = self.basis[row];
            found[basic] = self.values[row].clamp(0.0, self.columns[basic].most);
        }
        found
    }
}
