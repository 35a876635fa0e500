//! [`WheelTorque`]: least-norm motor torques for a wanted torque on the body.

use super::ROUNDING;
use crate::loops::vector::{dot, norm, product, scaled, sum};
use crate::math::list::List;
use crate::math::symmetric::principal_axes;
use crate::scene::{MAX_WHEELS, Scene};

/// Share of the largest sum of squared axis components below which a direction is not reached: above rounding, 1e-16,
/// and below the square of any real alignment, 1e-12.
const NOT_REACHED: f64 = 1e-13;

/// The wheels' axes, prepared for a run.
///
/// A motor torque tau on a wheel acts as -tau on the body: u = -A tau with the axes as columns of A. tau = -A^T (A
/// A^T)^+ u is the least-norm solution for the part of u within the axes' span (R. Penrose, Proc. Cambridge Phil. Soc.
/// 51, 1955).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelTorque {
    /// Motor torques, by wheel, for unit torques on the body along F_s.
    gains: List<[f64; 3], MAX_WHEELS>,
    /// Projection onto the span of the axes, F_s: the torques that the wheels can give.
    pub reachable: [[f64; 3]; 3],
    /// Orthonormal directions without torque, F_s.
    across: List<[f64; 3], 3>,
}

impl WheelTorque {
    /// Wheels with the unit axes `axes` in F_s.
    ///
    /// # Panics
    /// With more than [`MAX_WHEELS`] wheels.
    pub fn new(axes: &[[f64; 3]]) -> Self {
        let gram = std::array::from_fn(|i| std::array::from_fn(|j| axes.iter().map(|axis| axis[i] * axis[j]).sum()));
        let (moments, c_sb) = principal_axes::<f64>(gram);
        let least = NOT_REACHED * moments.iter().copied().fold(0.0, f64::max);
        let (mut inverse, mut reachable) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        let mut across = List::empty([0.0; 3]);
        for (column, moment) in moments.iter().enumerate() {
            let direction = c_sb.map(|row| row[column]);
            if *moment <= least {
                across.push(direction);
                continue;
            }
            for i in 0..3 {
                inverse[i] = sum(inverse[i], scaled(direction[i] / moment, direction));
                reachable[i] = sum(reachable[i], scaled(direction[i], direction));
            }
        }
        let mut gains = List::empty([0.0; 3]);
        axes.iter().for_each(|axis| gains.push(scaled(-1.0, product(inverse, *axis))));
        WheelTorque { gains, reachable, across }
    }

    /// The wheels `used` among the turning wheels of `scene`.
    pub fn of_loop(scene: &Scene, used: &[usize]) -> Self {
        Self::new(&used.iter().map(|place| scene.mass.wheels[*place].axis).collect::<Vec<_>>())
    }

    /// The part of `torque_s` (F_s) that no wheel can give; components that are rounding are zero.
    pub fn out_of_reach(&self, torque_s: [f64; 3]) -> [f64; 3] {
        let least = ROUNDING * norm(torque_s);
        let components = self.across.iter().map(|axis| (dot(*axis, torque_s), axis));
        components
            .filter(|(along, _)| along.abs() > least)
            .fold([0.0; 3], |all, (along, axis)| sum(all, scaled(along, *axis)))
    }

    /// Motor torques, in the order of the axes, for the reachable part of the torque `torque_s` on the body (F_s).
    pub fn motors(&self, torque_s: [f64; 3]) -> [f64; MAX_WHEELS] {
        let mut found = [0.0; MAX_WHEELS];
        found.iter_mut().zip(&self.gains).for_each(|(motor, gain)| *motor = dot(*gain, torque_s));
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loops::vector::{cross, difference, norm};

    fn on_body(axes: &[[f64; 3]], motors: [f64; MAX_WHEELS]) -> [f64; 3] {
        axes.iter().zip(motors).fold([0.0; 3], |total, (axis, motor)| sum(total, scaled(-motor, *axis)))
    }

    const WANTED: [f64; 3] = [1.0, -0.5, 0.7];

    /// Law: two wheels give the torque's part in their plane with the least norm, one wheel the part along it, and
    /// parallel wheels share.
    #[test]
    fn the_part_within_reach_is_given() {
        let a = scaled(1.0 / norm([1.0, 2.0, 2.0]), [1.0, 2.0, 2.0]);
        let b = scaled(1.0 / norm([2.0, -1.0, 0.5]), [2.0, -1.0, 0.5]);
        for axes in [&[a, b][..], &[a][..], &[a, a, scaled(-1.0, a)][..], &[a, b, scaled(-1.0, b)][..]] {
            let wheels = WheelTorque::new(axes);
            let motors = wheels.motors(WANTED);
            let given = on_body(axes, motors);
            let off = norm(difference(given, product(wheels.reachable, WANTED)));
            assert!(off < 1e-15, "{off:e}");
            // no wheel could give the rest
            let most = axes.iter().map(|axis| dot(difference(WANTED, given), *axis).abs()).fold(0.0, f64::max);
            assert!(most < 4e-16, "{most:e}");
        }
        let shared = WheelTorque::new(&[a, a, scaled(-1.0, a)]).motors(WANTED);
        assert!((shared[0] - shared[1]).abs() < 1e-16 && (shared[0] + shared[2]).abs() < 1e-16);
        // the trace of a projection is the number of axes
        let plane = WheelTorque::new(&[a, b]);
        let normal = cross(a, b);
        assert!(((0..3).map(|i| plane.reachable[i][i]).sum::<f64>() - 2.0).abs() < 1e-15);
        assert!(norm(product(plane.reachable, normal)) < 1e-15);
        assert_eq!(WheelTorque::new(&[]).motors(WANTED), [0.0; MAX_WHEELS]);
    }
}
