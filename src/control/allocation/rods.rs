//! [`RodAllocation`]: dipoles of torque rods for a wanted dipole, within their limits.

use super::wheel_torque::WheelTorque;
use crate::control::vector::{scaled, sum};
use crate::math::list::List;
use crate::scene::{MAX_TORQUE_RODS, Scene};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodCommand {
    /// Dipoles along the rods' axes, within their limits, A m^2.
    pub dipoles: [f64; MAX_TORQUE_RODS],
    pub is_limited: bool,
}

pub const NO_DIPOLES: RodCommand = RodCommand { dipoles: [0.0; MAX_TORQUE_RODS], is_limited: false };

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodAllocation {
    /// Least-norm allocation of unit dipoles: a rod is a wheel whose torque on the body is minus its dipole.
    least_norm: WheelTorque,
    /// Index among all rods, axis in F_s, and limit, A m^2.
    rods: List<(usize, [f64; 3], f64), MAX_TORQUE_RODS>,
}

impl RodAllocation {
    pub fn of_loop(scene: &Scene, used: &[usize]) -> Self {
        let mut rods = List::empty((0, [0.0; 3], 0.0));
        for place in used {
            let rod = &scene.torque_rods[*place];
            rods.push((*place, rod.axis, rod.limit));
        }
        let axes: Vec<[f64; 3]> = used.iter().map(|place| scene.torque_rods[*place].axis).collect();
        RodAllocation { least_norm: WheelTorque::new(&axes), rods }
    }

    /// Least-norm dipoles for the part of `wanted` (F_s, A m^2) within the rods' span, scaled down together to the
    /// limits so that the direction stays.
    pub fn limited(&self, wanted: [f64; 3]) -> RodCommand {
        let found = self.least_norm.motors(scaled(-1.0, wanted));
        let ratios = self.rods.iter().zip(found).map(|((_, _, limit), dipole)| dipole.abs() / limit);
        let most = ratios.fold(0.0, f64::max);
        let factor = if most > 1.0 { 1.0 / most } else { 1.0 };
        let mut dipoles = [0.0; MAX_TORQUE_RODS];
        for ((place, _, limit), dipole) in self.rods.iter().zip(found) {
            dipoles[*place] = (factor * dipole).clamp(-limit, *limit);
        }
        RodCommand { dipoles, is_limited: most > 1.0 }
    }

    /// Total dipole in F_s of the rods' dipoles `dipoles`, A m^2.
    pub fn dipole(&self, dipoles: &[f64; MAX_TORQUE_RODS]) -> [f64; 3] {
        self.rods.iter().fold([0.0; 3], |total, (place, axis, _)| sum(total, scaled(dipoles[*place], *axis)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::vector::{cross, difference, norm};
    use crate::scene::{SceneInput, TorqueRod};

    fn allocation(rods: &[([f64; 3], f64)], used: &[usize]) -> RodAllocation {
        let mut scene = Scene::resolve(&SceneInput::report()).expect("a scene");
        scene.torque_rods =
            rods.iter().map(|(axis, limit)| TorqueRod { axis: *axis, limit: *limit, scale: 1.0 }).collect();
        RodAllocation::of_loop(&scene, used)
    }

    const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// Law: within limits three or four rods give the wanted dipole, beyond them one along it with a rod at its limit;
    /// undriven rods give none; two rods give the part in their plane.
    #[test]
    fn rods_have_the_wanted_dipole_or_its_direction() {
        let oblique = [0.577_350_269_189_625_8; 3];
        let wanted = [3.0, -2.0, 1.0];
        for rods in [
            vec![(AXES[0], 5.0), (AXES[1], 5.0), (AXES[2], 5.0)],
            vec![(AXES[0], 5.0), (AXES[1], 5.0), (AXES[2], 5.0), (oblique, 5.0)],
        ] {
            let used: Vec<usize> = (0..rods.len()).collect();
            let allocation = allocation(&rods, &used);
            let command = allocation.limited(wanted);
            assert!(!command.is_limited && norm(difference(allocation.dipole(&command.dipoles), wanted)) < 1e-14);
            let command = allocation.limited(scaled(10.0, wanted));
            let found = allocation.dipole(&command.dipoles);
            assert!(command.is_limited && norm(cross(found, wanted)) < 1e-13 && norm(found) > 5.0);
            let most = command.dipoles.iter().fold(0.0, |most: f64, dipole| most.max(dipole.abs()));
            assert!((most - 5.0).abs() < 1e-14);
        }
        let two = allocation(&[(AXES[0], 5.0), (AXES[1], 5.0), (AXES[2], 5.0)], &[0, 2]);
        let command = two.limited(wanted);
        assert!(norm(difference(two.dipole(&command.dipoles), [3.0, 0.0, 1.0])) < 1e-14 && command.dipoles[1] == 0.0);
    }
}
