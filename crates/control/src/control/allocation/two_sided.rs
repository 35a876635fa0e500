//! Torques that thrusters can give in both directions.

use super::thrust::{ThrustAllocation, Wrench};
use crate::loops::vector::{difference, norm, product, scaled, sum};
use crate::math::list::List;
use crate::scene::MAX_THRUSTERS;

/// Relative tolerance for equal directions, far above rounding of positions and below any alignment.
const SAME: f64 = 1e-9;

impl ThrustAllocation {
    /// The projection onto torques (F_s) that the thrusters give in both directions; with `holds_force`, without a net
    /// force. Wheel momentum along them can be unloaded. For P1, P2, P3 it is s1 s1^T.
    pub fn two_sided_torques(&self, holds_force: bool) -> [[f64; 3]; 3] {
        // the two-sided part of a cone of wrenches is spanned by the generators whose opposites are in it
        let mut spanning = List::<Wrench, MAX_THRUSTERS>::empty([[0.0; 3]; 2]);
        let rows = self.rows(holds_force);
        for (wrench, _) in self.wrenches.iter().zip(self.most).filter(|(_, most)| *most > 0.0) {
            let opposite = wrench.map(|part| scaled(-1.0, part));
            let found = self.given(&self.nearest(rows, &opposite));
            let missing = [difference(opposite[0], found[0]), difference(opposite[1], found[1])];
            if rows.is_negligible(&missing, SAME) {
                spanning.push(*wrench);
            }
        }
        let largest = spanning.iter().map(|wrench| norm(wrench[1])).fold(0.0, f64::max);
        if holds_force {
            without_force(&mut spanning);
        }
        let mut projection = [[0.0; 3]; 3];
        for [_, torque] in &spanning {
            let new = difference(*torque, product(projection, *torque));
            let length = norm(new);
            if length > SAME * largest {
                let axis = scaled(1.0 / length, new);
                projection = std::array::from_fn(|i| sum(projection[i], scaled(axis[i], axis)));
            }
        }
        projection
    }

    /// Total thrust and magnitude of the net force for 1 N m about the unit vector `axis` (F_s), each in its worse
    /// direction, without limits; with `holds_force` at zero force.
    pub fn cost(&self, axis: [f64; 3], holds_force: bool) -> [f64; 2] {
        [1.0, -1.0].iter().fold([0.0_f64; 2], |[total, force], sign| {
            let thrust = self.nearest(self.rows(holds_force), &[[0.0; 3], scaled(*sign, axis)]);
            [total.max(thrust.iter().sum()), force.max(norm(self.given(&thrust)[0]))]
        })
    }
}

/// Reduces `vectors` to vectors that span the part of their space without a force.
fn without_force(vectors: &mut [Wrench]) {
    let largest = vectors.iter().map(|[force, _]| norm(*force)).fold(0.0, f64::max);
    for component in 0..3 {
        let size = |vector: &Wrench| vector[0][component].abs();
        let pivot = vectors.iter().copied().max_by(|a, b| size(a).total_cmp(&size(b)));
        let Some(pivot) = pivot.filter(|pivot| size(pivot) > SAME * largest) else { continue };
        for vector in vectors.iter_mut() {
            let factor = vector[0][component] / pivot[0][component];
            *vector = [0, 1].map(|part| difference(vector[part], scaled(factor, pivot[part])));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{ALL, NONE, eight, report, report_thrusters};
    use super::*;
    use crate::loops::vector::turned;
    use crate::scene::Thruster;

    /// Law: two-sided torques are about s1 for P1, P2, P3, with the force held or free; about all axes for eight
    /// thrusters; and exist for P2 and P3 alone, or for two opposite thrusters, only if the force is free. Every torque
    /// in that space is given in both directions.
    #[test]
    fn two_sided_torques_can_be_given() {
        let close = |found: [[f64; 3]; 3], expected: [f64; 3]| {
            (0..3).all(|i| (0..3).all(|j| (found[i][j] - if i == j { expected[i] } else { 0.0 }).abs() < 1e-12))
        };
        for by_wheels in [ALL, NONE] {
            for held in [true, false] {
                let all = report([0.0, 0.0, 1.5], 1.0, by_wheels);
                assert!(close(all.two_sided_torques(held), [1.0, 0.0, 0.0]));
                // P2 alone, or with P1
                let [total, force] = all.cost([1.0, 0.0, 0.0], held);
                let expected = if held { [2.5, 0.0] } else { [1.25, 1.25] };
                assert!((total - expected[0]).abs() < 1e-14 && (force - expected[1]).abs() < 1e-14, "{total} {force}");
                assert!(close(eight([0.0; 3], by_wheels).two_sided_torques(held), [1.0; 3]));
            }
        }
        let three = report_thrusters();
        let without_first = ThrustAllocation::new(&three, [0.0, 0.0, 1.5], &[0.0, 1.0, 1.0], NONE);
        assert!(close(without_first.two_sided_torques(true), [0.0; 3]), "they only brake");
        assert!(close(without_first.two_sided_torques(false), [1.0, 0.0, 0.0]));
        // two opposite thrusters off c: no torque without a force
        let position = [0.3, 0.7, 0.11];
        let beside = [1.0, -1.0].map(|to| Thruster { position, direction: scaled(to, [0.48, -0.6, 0.64]) });
        let of_pair = |held| ThrustAllocation::new(&beside, [0.0; 3], &[1.0; 2], NONE).two_sided_torques(held);
        assert!(close(of_pair(true), [0.0; 3]));
        let trace: f64 = (0..3).map(|i| of_pair(false)[i][i]).sum();
        assert!((trace - 1.0).abs() < 1e-12, "with the force free, about one axis: {trace}");
        // P1, P2, P3 in another frame
        let turn = [0.3, -0.7, 0.4];
        let in_other = |v: [f64; 3]| turned(v, turn);
        let moved = |one: &Thruster| Thruster { position: in_other(one.position), direction: in_other(one.direction) };
        let thrusters: Vec<Thruster> = three.iter().map(moved).collect();
        let oblique = ThrustAllocation::new(&thrusters, in_other([0.0, 0.0, 1.5]), &[1.0; 3], NONE);
        let axis = in_other([1.0, 0.0, 0.0]);
        for held in [true, false] {
            let projection = oblique.two_sided_torques(held);
            for (i, row) in projection.iter().enumerate() {
                assert!((0..3).all(|j| (row[j] - axis[i] * axis[j]).abs() < 1e-12), "{projection:?}");
            }
            for sign in [1.0, -1.0] {
                let torque = product(projection, [0.3 * sign, 0.1, -0.2 * sign]);
                let given = oblique.given(&oblique.allocate(held.then_some([0.0; 3]), torque));
                assert!(norm(difference(given[1], torque)) < 1e-12, "{given:?}");
                assert!(!held || norm(given[0]) < 1e-12, "{given:?}");
            }
        }
    }
}
