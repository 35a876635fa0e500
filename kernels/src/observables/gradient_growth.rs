//! [`growth`]: how much the gravity gradient amplifies small errors of the attitude along a run.
//!
//! A rotation by theta of a body whose vertical is u changes the torque k u x J u, k = 3 mu/|r|^3, by
//! k ((u x theta) x J u + u x J (u x theta)) = M theta. A body that does not turn relative to the vertical leaves such an error like exp(lambda t),
//! lambda^2 the largest eigenvalue of J^(-1/2) M J^(-1/2) (its symmetric part) where that is above zero: below zero it librates. A body that turns
//! with a rate w beside the vertical, or is held by a momentum of J w, sees M change its sign within 1/w: what is left is lambda^2/w. Between both,
//! the exponent of the growth is the integral of lambda^2/sqrt(lambda^2 + w^2).
//!
//! Not here: the growth of errors in the free motion ([`super::conditioning`]).

use crate::dynamics::orbit::KeplerOrbit;
use crate::math::symmetric::principal_axes;
use crate::math::vector::{cross, dcm_from_quaternion, difference, dot, scaled, sum, transposed_product};
use crate::run::{StateField, StateTable};
use crate::scene::Scene;

/// Points of a run that are examined, at most: several in each half of a libration up to some orbits, a fair sample beyond.
const POINTS: usize = 128;

/// The logarithm of the growth over the first `filled` points of `table`, at `times`, of a run of `scene`; zero without a gravity gradient.
pub(super) fn exponent(scene: &Scene, table: &StateTable, times: &[f64], filled: usize) -> f64 {
    let Some(orbit) = scene.orbit.as_ref().filter(|_| scene.environment.gravity_gradient) else { return 0.0 };
    let last = filled - 1;
    let (moments, axes) = principal_axes(scene.mass.inertia);
    let kepler = KeplerOrbit::new(orbit);
    let stride = last.div_ceil(POINTS).max(1);
    let (mut all, mut count) = (0.0, 0.0);
    for point in (0..=last).step_by(stride) {
        let place = kepler.state(times[point]);
        let c_es = dcm_from_quaternion(table.at(StateField::Attitude, point));
        let into_axes = |v: [f64; 3]| transposed_product(axes, transposed_product(c_es, v));
        let up = into_axes(scaled(1.0 / place.distance, place.position));
        let strength = 3.0 * orbit.mu / (place.distance * place.distance * place.distance);
        let unstable = strength * largest_stiffness(moments, up).max(0.0);
        let square = place.distance * place.distance;
        let turning = into_axes(scaled(1.0 / square, cross(place.position, place.velocity)));
        let omega = transposed_product(axes, table.at::<3>(StateField::Rate, point));
        let beside = difference(omega, turning);
        let mut held = [0.0; 3];
        for (wheel, spin) in scene.mass.wheels.iter().enumerate() {
            held = sum(held, scaled(spin.axial * table.column(StateField::WheelRates, wheel)[point], spin.axis));
        }
        let size = (moments[0] + moments[1] + moments[2]) / 3.0;
        let rate2 = dot(beside, beside) + dot(held, held) / (size * size);
        if unstable > 0.0 {
            all += unstable / (unstable + rate2).sqrt();
        }
        count += 1.0;
    }
    all / count * times[last]
}

/// The largest eigenvalue of J^(-1/2) M J^(-1/2) without k, of a body of the principal moments `moments` whose vertical is `up`; the unit is that
/// of a ratio of moments.
fn largest_stiffness(moments: [f64; 3], up: [f64; 3]) -> f64 {
    let weighed = [moments[0] * up[0], moments[1] * up[1], moments[2] * up[2]];
    // column by column: M of the unit vectors
    let columns: [[f64; 3]; 3] = core::array::from_fn(|j| {
        let mut unit = [0.0; 3];
        unit[j] = 1.0;
        let moved = cross(up, unit);
        let change = [moments[0] * moved[0], moments[1] * moved[1], moments[2] * moved[2]];
        sum(cross(moved, weighed), cross(up, change))
    });
    let symmetric: [[f64; 3]; 3] = core::array::from_fn(|i| {
        core::array::from_fn(|j| 0.5 * (columns[j][i] + columns[i][j]) / (moments[i] * moments[j]).sqrt())
    });
    let (values, _) = principal_axes(symmetric);
    values[0].max(values[1]).max(values[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: along the vertical the axis of the smallest moment is stable in pitch and roll, and that of the largest is not: there the growth is sqrt(3) of
    /// the mean motion times the square root of a difference of moments over a moment.
    #[test]
    fn a_body_on_its_long_axis_is_stable() {
        let moments = [90.0, 100.0, 40.0];
        assert!(largest_stiffness(moments, [0.0, 0.0, 1.0]) <= 1e-15);
        let found = largest_stiffness(moments, [0.0, 1.0, 0.0]);
        let expected: f64 = (100.0 - 40.0) / 90.0;
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
}
