//! [`exponent`]: how much the effects that change within an arc amplify small errors of the rotational state along a run.
//!
//! A rotation of the body by theta changes their torque by M theta, a change of omega by D. A body that does not turn relative to what the torque
//! points to leaves an error like exp(lambda t), lambda^2 the largest eigenvalue of the symmetric part of J^(-1/2) M J^(-1/2) where that is above zero:
//! below zero it librates. A body that turns with a rate w beside it, or is held by a momentum of J w, sees M change its sign within 1/w, and what is
//! gained is mostly lost again: the growth is of the second order, lambda^3/w^2. Between both, the exponent of the growth is taken as the integral of
//! lambda^3/(lambda^2 + w^2). Nor does an orientation count that the body leaves again within half the period of an oscillation: M and w^2 are averaged over spans of
//! pi/lambda_0, with lambda_0^2 the largest magnitude of an eigenvalue at any point, before lambda is taken. (Without that a libration of thirty orbits, whose
//! errors hardly grow, had a growth of e^3.) `tests/accuracy/error_estimate.rs` measures the coverage. A torque along omega adds the largest eigenvalue of
//! J^(-1/2) D J^(-1/2) where that is above zero. What a torque points to is taken to turn with the orbit.
//!
//! Not here: the growth of errors in the free motion ([`super::conditioning`]).

use crate::dynamics::effects::within_arcs::Motion;
use crate::dynamics::effects::{ChangingEffects, ForceModel};
use crate::dynamics::orbit_path::OrbitPath;
use crate::dynamics::orbit_state::OrbitState;
use crate::math::symmetric::principal_axes;
use crate::math::vector::{cross, difference, dot, hamilton, quaternion_from_dcm, scaled, sum, transposed_product};
use crate::run::{StateField, StateTable};
use crate::scene::Scene;

/// Points of a run that are examined, at most: several in each half of a libration up to some orbits, a fair sample beyond.
const POINTS: usize = 128;

/// The rotation, rad, over which a torque is differenced: the error is its square, 1e-8, and rounding 1e-12.
const ROTATION: f64 = 1e-4;

// Inlined with all that it calls, so that fused operations are instructions: torques at 1,500 states of a run would cost as much as its steps.
/// The logarithm of the growth over the first `filled` points of `table`, at `times`, of a run of `scene`; zero where no effect changes within an arc.
#[inline(always)]
pub(super) fn exponent(scene: &Scene, table: &StateTable, times: &[f64], filled: usize) -> f64 {
    if !ForceModel::of(scene).changes_within_arcs() {
        return 0.0;
    }
    let last = filled - 1;
    let (moments, axes) = principal_axes(scene.mass.inertia);
    let q_sb = quaternion_from_dcm(axes);
    let effects = ChangingEffects::of(0.0, scene, Some(axes));
    if effects.is_empty() {
        return 0.0;
    }
    let orbit = scene.orbit.as_ref().map(OrbitPath::new);
    let size = (moments[0] + moments[1] + moments[2]) / 3.0;
    let stride = last.div_ceil(POINTS).max(1);
    let (mut driven, mut count) = (0.0, 0);
    let mut slopes = [[[0.0; 3]; 3]; POINTS + 1];
    let mut squares = [0.0; POINTS + 1];
    let mut largest = 0.0_f64;
    for point in (0..=last).step_by(stride) {
        let place = orbit.as_ref().map_or(OrbitState::unknown(0.0), |orbit| orbit.state(times[point]));
        let attitude = hamilton(table.at(StateField::Attitude, point), q_sb);
        let rate = transposed_product(axes, table.at::<3>(StateField::Rate, point));
        let motion = Motion { time: times[point], attitude, rate, place };
        let mut beside = rate;
        if orbit.is_some() {
            let turning = scaled(1.0 / dot(place.position, place.position), cross(place.position, place.velocity));
            let [w, x, y, z] = attitude;
            let [_, x, y, z] =
                hamilton(hamilton([w, -x, -y, -z], [0.0, turning[0], turning[1], turning[2]]), [w, x, y, z]);
            beside = difference(rate, [x, y, z]);
        }
        let mut held = [0.0; 3];
        for (wheel, spin) in scene.mass.wheels.iter().enumerate() {
            held = sum(held, scaled(spin.axial * table.column(StateField::WheelRates, wheel)[point], spin.axis));
        }
        let rate2 = dot(beside, beside) + dot(held, held) / (size * size);
        let faster = dot(rate, rate).sqrt().max(1.0 / times[last].max(f64::MIN_POSITIVE)) * ROTATION;
        // one loop over all changes: the effects are inlined once, and they are long
        let mut torques = [[0.0; 3]; 12];
        for (change, torque) in torques.iter_mut().enumerate() {
            let (axis, sign) = (change / 2 % 3, if change % 2 == 0 { 1.0 } else { -1.0 });
            *torque = effects.torque(&if change < 6 {
                turned(&motion, axis, sign * ROTATION)
            } else {
                hastened(&motion, axis, sign * faster)
            });
        }
        let (of_turns, of_rates) = torques.split_at(6);
        let of_turn = slope(moments, of_turns).map(|row| row.map(|x| x / ROTATION));
        largest = principal_axes(of_turn).0.into_iter().fold(largest, |most, x| most.max(x.abs()));
        (slopes[count], squares[count]) = (of_turn, rate2);
        driven += (largest_eigenvalue(slope(moments, of_rates)) / faster).max(0.0);
        count += 1;
    }
    let spans = (times[last] * largest.sqrt() / core::f64::consts::PI).round().clamp(1.0, count as f64);
    let span = (count as f64 / spans).ceil() as usize;
    let turning = slopes[..count].chunks(span).zip(squares[..count].chunks(span)).map(|(slopes, squares)| {
        let points = squares.len() as f64;
        let mean = core::array::from_fn(|i| {
            core::array::from_fn(|j| slopes.iter().map(|slope| slope[i][j]).sum::<f64>() / points)
        });
        let (unstable, rate2) = (largest_eigenvalue(mean), squares.iter().sum::<f64>() / points);
        if unstable > 0.0 { points * unstable * unstable.sqrt() / (unstable + rate2) } else { 0.0 }
    });
    (driven + turning.sum::<f64>()) / count as f64 * times[last]
}

/// `motion` with the body turned by `angle` about its axis `axis`.
#[inline(always)]
fn turned(motion: &Motion<f64>, axis: usize, angle: f64) -> Motion<f64> {
    let (sine, cosine) = libm::sincos(0.5 * angle);
    let mut turn = [cosine, 0.0, 0.0, 0.0];
    turn[1 + axis] = sine;
    Motion { attitude: hamilton(motion.attitude, turn), ..*motion }
}

/// `motion` with a rate about `axis` larger by `rate`.
#[inline(always)]
fn hastened(motion: &Motion<f64>, axis: usize, rate: f64) -> Motion<f64> {
    let mut hastened = *motion;
    hastened.rate[axis] += rate;
    hastened
}

/// The symmetric part of J^(-1/2) S J^(-1/2), of a body of the principal moments `moments`; column j of S is half the difference of the torques at a change of
/// `1` and of `-1` along axis j, which follow one another in `torques`.
#[inline(always)]
fn slope(moments: [f64; 3], torques: &[[f64; 3]]) -> [[f64; 3]; 3] {
    let columns: [[f64; 3]; 3] =
        core::array::from_fn(|axis| scaled(0.5, difference(torques[2 * axis], torques[2 * axis + 1])));
    core::array::from_fn(|i| {
        core::array::from_fn(|j| 0.5 * (columns[j][i] + columns[i][j]) / (moments[i] * moments[j]).sqrt())
    })
}

/// The largest eigenvalue of a symmetric matrix.
#[inline(always)]
fn largest_eigenvalue(symmetric: [[f64; 3]; 3]) -> f64 {
    let (values, _) = principal_axes(symmetric);
    values[0].max(values[1]).max(values[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::effects::gravity_gradient::GravityGradient;

    /// Axes and signs of the changes, in order.
    const CHANGES: [(usize, f64); 6] = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)];

    /// Law: along the vertical the axis of the smallest moment is stable in pitch and roll, and that of the largest is not: there the growth is sqrt(3) of
    /// the mean motion times the square root of a difference of moments over a moment.
    #[test]
    fn a_body_on_its_long_axis_is_stable() {
        let moments = [90.0, 100.0, 40.0];
        let inertia = [[90.0, 0.0, 0.0], [0.0, 100.0, 0.0], [0.0, 0.0, 40.0]];
        // 3 mu/r^3 is one
        let gradient = GravityGradient { strength: 1.0, inertia };
        let slope = |position: [f64; 3]| {
            let place = OrbitState { position, velocity: [0.0; 3], distance: 1.0 };
            let motion = Motion { time: 0.0, attitude: [1.0, 0.0, 0.0, 0.0], rate: [0.0; 3], place };
            let torque = |(axis, sign)| gradient.torque(&turned(&motion, axis, sign * ROTATION));
            largest_eigenvalue(super::slope(moments, &CHANGES.map(torque))) / ROTATION
        };
        assert!(slope([0.0, 0.0, 1.0]) <= 1e-10);
        let (found, expected) = (slope([0.0, 1.0, 0.0]), (100.0 - 40.0) / 90.0);
        assert!((found - expected).abs() < 2e-8, "{found} {expected}");
    }

    /// Law: a torque along omega lets an error of omega grow, one against it does not.
    #[test]
    fn a_torque_along_omega_drives() {
        let slope = |coefficient: f64| {
            let torque = |(axis, sign)| core::array::from_fn(|i| if i == axis { coefficient * sign } else { 0.0 });
            largest_eigenvalue(super::slope([2.0, 4.0, 5.0], &CHANGES.map(torque)))
        };
        assert!((slope(3.0) - 1.5).abs() < 1e-14 && slope(-3.0) < 0.0);
    }
}
