//! Torques that thrusters can give in both directions.

use super::thrust::{ThrustAllocation, halves};
use crate::control::vector::{difference, norm, product, scaled, sum};
use crate::math::list::List;
use crate::scene::MAX_THRUSTERS;

/// Directions that differ by less, relative to their length, are one: far above the rounding of positions, far below any alignment.
const SAME: f64 = 1e-9;

impl ThrustAllocation {
    /// The projection onto the torques (F_s) that the thrusters give in both directions in the controlled components, without a force in those: along
    /// which they can take momentum out of wheels. Of P1, P2, P3 it is s1 s1^T.
    pub fn two_sided_torques(&self) -> [[f64; 3]; 3] {
        // what a cone of wrenches has in both directions is spanned by those of its generators whose opposite is in it
        let mut spanning = List::<[f64; 6], MAX_THRUSTERS>::empty([0.0; 6]);
        for (wrench, most) in self.wrenches.iter().zip(self.most) {
            let mut controlled = [0.0; 6];
            self.rows.iter().for_each(|row| controlled[*row] = wrench[*row]);
            let opposite = controlled.map(|entry| -entry);
            let found = self.given(&self.nearest(&opposite));
            let is_reached = self
                .rows
                .iter()
                .zip(self.scales)
                .all(|(row, scale)| (found[*row] - opposite[*row]).abs() <= SAME * scale);
            if is_reached && most > 0.0 {
                spanning.push(controlled);
            }
        }
        let largest = spanning.iter().map(|vector| norm(halves(vector).1)).fold(0.0, f64::max);
        without_force(&mut spanning);
        let mut projection = [[0.0; 3]; 3];
        for vector in &spanning {
            let torque = halves(vector).1;
            let along = product(projection, torque);
            let new = difference(torque, along);
            let length = norm(new);
            if length > SAME * largest {
                let axis = scaled(1.0 / length, new);
                projection = std::array::from_fn(|i| sum(projection[i], scaled(axis[i], axis)));
            }
        }
        projection
    }
}

/// Eliminates the forces of `vectors`: of the space that they span, vectors that span the part without a force.
fn without_force(vectors: &mut [[f64; 6]]) {
    let largest = vectors.iter().map(|vector| norm(halves(vector).0)).fold(0.0, f64::max);
    for component in 0..3 {
        let pivot = vectors.iter().copied().max_by(|a, b| a[component].abs().total_cmp(&b[component].abs()));
        let Some(pivot) = pivot.filter(|pivot| pivot[component].abs() > SAME * largest) else { continue };
        for vector in vectors.iter_mut() {
            let factor = vector[component] / pivot[component];
            *vector = std::array::from_fn(|i| vector[i] - factor * pivot[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::thrust::tests::{REPORT_AXES, TORQUE, eight, report};
    use super::*;
    use crate::control::rotation::turned;
    use crate::scene::Thruster;
    use crate::scene::thruster::REPORT_DIRECTIONS;

    /// Law: torque in both directions without a force: about s1 of P1, P2, P3, about all axes of eight thrusters, about none of P2 and P3 alone. Of
    /// torques in that space nothing is missing, in either direction.
    #[test]
    fn two_sided_torques_can_be_given() {
        let close = |found: [[f64; 3]; 3], expected: [f64; 3]| {
            (0..3).all(|i| (0..3).all(|j| (found[i][j] - if i == j { expected[i] } else { 0.0 }).abs() < 1e-12))
        };
        for axes in [REPORT_AXES, [true; 6]] {
            let found = report([0.0, 0.0, 1.5], 1.0, axes).two_sided_torques();
            assert!(close(found, [1.0, 0.0, 0.0]), "{found:?}");
        }
        // with the force free, P2 and P3 alone turn in both directions; with the force controlled they only brake
        let about_s1 = [false, false, false, true, false, false];
        assert!(close(report([0.0; 3], 1.0, about_s1).two_sided_torques(), [1.0, 0.0, 0.0]));
        let mut without_first = report([0.0; 3], 1.0, REPORT_AXES);
        (without_first.most[0], without_first.lever) = (0.0, None);
        assert!(close(without_first.two_sided_torques(), [0.0; 3]));
        assert!(close(eight([0.0; 3], TORQUE).two_sided_torques(), [1.0; 3]));
        // two opposite thrusters beside c: no torque without a force
        let position = [0.3, 0.7, 0.11];
        let beside = [1.0, -1.0].map(|to| Thruster { position, direction: scaled(to, [0.48, -0.6, 0.64]) });
        let of_pair = |axes| ThrustAllocation::new(&beside, [0.0; 3], &[1.0; 2], axes).two_sided_torques();
        assert!(close(of_pair([true; 6]), [0.0; 3]));
        let trace: f64 = (0..3).map(|i| of_pair(TORQUE)[i][i]).sum();
        assert!((trace - 1.0).abs() < 1e-12, "with the force free, about one axis: {trace}");
        // P1, P2, P3 in another frame
        let turn = [0.3, -0.7, 0.4];
        let in_other = |v: [f64; 3]| turned(v, turn);
        let thrusters: Vec<Thruster> = std::iter::zip([[0.0; 3], [0.0, -0.8, 3.0], [0.0, 0.8, 3.0]], REPORT_DIRECTIONS)
            .map(|(position, direction)| Thruster { position: in_other(position), direction: in_other(direction) })
            .collect();
        let oblique = ThrustAllocation::new(&thrusters, in_other([0.0, 0.0, 1.5]), &[1.0; 3], [true; 6]);
        let (projection, axis) = (oblique.two_sided_torques(), in_other([1.0, 0.0, 0.0]));
        for (i, row) in projection.iter().enumerate() {
            assert!((0..3).all(|j| (row[j] - axis[i] * axis[j]).abs() < 1e-12), "{projection:?}");
        }
        for sign in [1.0, -1.0] {
            let torque = product(projection, [0.3 * sign, 0.1, -0.2 * sign]);
            let found = oblique.allocate([0.0; 3], torque);
            assert!(found.missing.iter().all(|missing| missing.abs() < 1e-12), "{found:?}");
        }
    }
}
