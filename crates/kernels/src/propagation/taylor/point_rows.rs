//! [`PointRows`]: the last observation points of each lane, written to its trajectory eight at a time. Written
//! directly, the columns exceed the first-level cache, which cost a tenth of the time of a run under thrust.

use crate::math::prelude::*;
use crate::run::Trajectory;

#[derive(Clone, Debug)]
pub struct PointRows {
    /// Eight points of all components per lane; the position of a point is its number modulo eight.
    values: Vec<f64>,
    /// Pending points of each lane: the first, and one after the last.
    first: [usize; WIDEST],
    next: [usize; WIDEST],
}

impl PointRows {
    pub fn new(lanes: usize, components: usize) -> Self {
        PointRows { values: vec![0.0; lanes * WIDTH * components], first: [0; WIDEST], next: [0; WIDEST] }
    }

    /// Adds the next point of `lane` from `rows`, which hold all lanes of each component.
    #[inline(always)]
    pub fn push<const N: usize>(
        &mut self,
        lane: usize,
        point: usize,
        rows: &[[f64; WIDEST]; N],
        trajectory: &mut Trajectory,
    ) {
        if self.first[lane] == self.next[lane] {
            self.first[lane] = point;
        }
        self.next[lane] = point + 1;
        let start = (lane * WIDTH + point % WIDTH) * N;
        for (value, row) in self.values[start..start + N].iter_mut().zip(rows) {
            *value = row[lane];
        }
        if (point + 1).is_multiple_of(WIDTH) {
            self.flush::<N>(lane, trajectory);
        }
    }

    #[inline(never)]
    pub fn flush<const N: usize>(&mut self, lane: usize, trajectory: &mut Trajectory) {
        let points = self.first[lane]..self.next[lane];
        self.first[lane] = self.next[lane];
        let rows = self.values.as_chunks::<N>().0.as_chunks::<WIDTH>().0;
        let Some(rows) = rows.get(lane) else { return };
        for component in 0..N {
            let column = &mut trajectory.column_mut(component)[points.clone()];
            if let Some(eight) = column.as_mut_array::<WIDTH>() {
                // all of them: the block begins at a multiple of eight
                *eight = core::array::from_fn(|place| rows[place][component]);
            } else {
                for (value, row) in column.iter_mut().zip(&rows[points.start % WIDTH..]) {
                    *value = row[component];
                }
            }
        }
    }
}
