//! [`RodAllocation`]: dipoles of torque rods for a wanted dipole, within their limits.

use super::wheel_torque::WheelTorque;
use crate::loops::vector::{scaled, sum};
use crate::scene::{MAX_TORQUE_RODS, Scene, TorqueRod};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodCommand {
    /// Dipoles along the rods' axes, within their limits, A m^2.
    pub dipoles: [f64; MAX_TORQUE_RODS],
    pub is_limited: bool,
}

pub const NO_DIPOLES: RodCommand = RodCommand { dipoles: [0.0; MAX_TORQUE_RODS], is_limited: false };

pub struct RodAllocation {
    /// Least-norm allocation of unit dipoles: a rod is a wheel whose torque on the body is minus its dipole.
    least_norm: WheelTorque,
    /// With their indices among all rods.
    rods: Vec<(usize, TorqueRod)>,
}

impl RodAllocation {
    pub fn of_loop(scene: &Scene, used: &[usize]) -> Self {
        let rods: Vec<_> = used.iter().map(|place| (*place, scene.torque_rods[*place])).collect();
        let axes: Vec<[f64; 3]> = rods.iter().map(|(_, rod)| rod.axis).collect();
        RodAllocation { least_norm: WheelTorque::new(&axes), rods }
    }

    /// Least-norm dipoles for the part of `wanted` (F_s, A m^2) within the rods' span, scaled down together to the
    /// limits so that the direction stays.
    pub fn limited(&self, wanted: [f64; 3]) -> RodCommand {
        let found = self.least_norm.motors(scaled(-1.0, wanted));
        let ratios = self.rods.iter().zip(found).map(|((_, rod), dipole)| dipole.abs() / rod.limit);
        let most = ratios.fold(0.0, f64::max);
        let factor = if most > 1.0 { 1.0 / most } else { 1.0 };
        let mut dipoles = [0.0; MAX_TORQUE_RODS];
        for ((place, rod), dipole) in self.rods.iter().zip(found) {
            dipoles[*place] = (factor * dipole).clamp(-rod.limit, rod.limit);
        }
        RodCommand { dipoles, is_limited: most > 1.0 }
    }

    /// Total dipole in F_s of the rods' dipoles `dipoles`, A m^2.
    pub fn dipole(&self, dipoles: &[f64; MAX_TORQUE_RODS]) -> [f64; 3] {
        self.rods.iter().fold([0.0; 3], |total, (place, rod)| sum(total, scaled(dipoles[*place], rod.axis)))
    }
}
