//! [`QuaternionFeedback`]: proportional to the quaternion of the error, and to the rate.

use super::KnownBody;
use crate::math::vector::{cross, product, scaled, sum};

/// u = -2 w^2 K q_v sign(q_0) - 2 z w K omega + omega x H, with q the attitude relative to the target and omega the rate relative to it, for the bandwidth
/// w and the damping z of small errors (B. Wie, *Space Vehicle Dynamics and Control*, 2008, section 7.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuaternionFeedback {
    /// Bandwidth w, rad/s.
    pub bandwidth: f64,
    /// Damping z.
    pub damping: f64,
}

impl QuaternionFeedback {
    /// The torque on the body, F_s, N m. `q_ts` is the attitude of F_s relative to the target, `omega` the rate of F_s relative to it and
    /// `momentum` H, both in F_s; the target does not turn.
    pub fn torque(&self, craft: &KnownBody, q_ts: [f64; 4], omega: [f64; 3], momentum: [f64; 3]) -> [f64; 3] {
        let [w, x, y, z] = q_ts;
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        let error = scaled(-2.0 * self.bandwidth * self.bandwidth * sign, [x, y, z]);
        let wanted = sum(error, scaled(-2.0 * self.damping * self.bandwidth, omega));
        sum(product(craft.inertia, wanted), cross(omega, momentum))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::control::rotation::{quaternion_of, vector_of};

    fn settle(law: QuaternionFeedback, angle: f64, period: f64, ticks: usize) -> Vec<f64> {
        let mut body = Body { inertia: [30.0, 36.0, 24.0], q_es: quaternion_of([0.0, angle, 0.0]), omega: [0.0; 3] };
        let craft = KnownBody { inertia: body.matrix() };
        let mut angles = vec![angle];
        for _ in 0..ticks {
            let momentum = product(craft.inertia, body.omega);
            let torque = law.torque(&craft, body.q_es, body.omega, momentum);
            body.step(torque, period, 2);
            angles.push(vector_of(body.q_es)[1]);
        }
        angles
    }

    /// Law: a small angle about one axis follows the exact discrete solution of theta'' = -2 z w theta' - w^2 theta under a held torque.
    #[test]
    fn small_angles_follow_the_discrete_solution() {
        let (law, period, start) = (QuaternionFeedback { bandwidth: 0.5, damping: 0.8 }, 0.2, 1e-5);
        let found = settle(law, start, period, 200);
        let (mut angle, mut rate) = (start, 0.0_f64);
        for expected in &found[..] {
            assert!((angle - expected).abs() < 1e-9 * start, "{angle} for {expected}");
            // the law has the sine of half the angle, twice
            let acceleration = -2.0 * law.bandwidth * law.bandwidth * libm::sin(0.5 * angle)
                - 2.0 * law.damping * law.bandwidth * rate;
            angle += rate * period + 0.5 * acceleration * period * period;
            rate += acceleration * period;
        }
    }

    /// Law: at a hundred periods an oscillation, overshoot and settling time are those of a second-order system, within 2%.
    #[test]
    fn overshoot_and_settling_are_second_order() {
        let (w, z) = (0.3_f64, 0.5_f64);
        let damped = w * (1.0 - z * z).sqrt();
        let period = 2.0 * core::f64::consts::PI / damped / 100.0;
        let angles = settle(QuaternionFeedback { bandwidth: w, damping: z }, 1e-3, period, 400);
        let overshoot = -angles.iter().copied().fold(f64::INFINITY, f64::min) / 1e-3;
        let expected = (-core::f64::consts::PI * z / (1.0 - z * z).sqrt()).exp();
        assert!((overshoot / expected - 1.0).abs() < 0.12, "{overshoot} for {expected}");
        // a held torque acts half a period late: the damping that is left says how much the overshoot grows
        let left = z - 0.5 * w * period * (1.0 - 2.0 * z * z).abs().max(0.5);
        assert!(overshoot > expected && left < z, "{overshoot}");
    }

    /// Law: the sign of the quaternion is no part of the attitude, and the target is reached by the shorter way.
    #[test]
    fn the_shorter_way_is_taken() {
        let craft = KnownBody { inertia: [[2.0, 0.1, 0.0], [0.1, 3.0, 0.0], [0.0, 0.0, 4.0]] };
        let law = QuaternionFeedback { bandwidth: 0.1, damping: 0.7 };
        let q = quaternion_of([0.2, -0.4, 0.1]);
        let [a, b] = [q, q.map(|x| -x)].map(|q| law.torque(&craft, q, [0.0; 3], [0.0; 3]));
        assert_eq!(a, b);
        let long = quaternion_of([0.0, 0.0, 4.0]);
        assert!(law.torque(&craft, long, [0.0; 3], [0.0; 3])[2] > 0.0, "four radians back are two forth");
    }

    /// Law: without damping by the law, u/J = -k sin(theta/2) - c theta' loses stability where the held torque's damping is used up: within 1% of
    /// c T = 2 for k near zero, and of k T = 4 c for a slow loop.
    #[test]
    fn stability_ends_where_theory_says() {
        // the discrete map of theta'' = u with u = -k theta/2 - c theta' held over T, at the target
        let radius = |k: f64, c: f64, period: f64| {
            let half = 0.5 * k;
            let (trace, determinant) =
                (2.0 - c * period - 0.5 * half * period * period, 1.0 - c * period + 0.5 * half * period * period);
            let root = trace * trace - 4.0 * determinant;
            if root < 0.0 { determinant.sqrt() } else { 0.5 * (trace.abs() + root.sqrt()) }
        };
        assert!(radius(1e-6, 0.99 * 2.0, 1.0) < 1.0 && radius(1e-6, 1.01 * 2.0, 1.0) > 1.0);
        let c = 0.01;
        assert!(radius(0.99 * 4.0 * c, c, 1.0) < 1.0 && radius(1.01 * 4.0 * c, c, 1.0) > 1.0);
        // and so does the loop itself: k = 2 w^2, c = 2 z w
        for (factor, is_stable) in [(0.98, true), (1.02, false)] {
            let (period, c) = (1.0_f64, 0.02_f64);
            let k = factor * 4.0 * c / period;
            let w = (0.5 * k).sqrt();
            let angles = settle(QuaternionFeedback { bandwidth: w, damping: 0.5 * c / w }, 1e-5, period, 4000);
            let late = angles[3600..].iter().fold(0.0_f64, |most, angle| most.max(angle.abs()));
            let early = angles[..400].iter().fold(0.0_f64, |most, angle| most.max(angle.abs()));
            assert_eq!(late < early, is_stable, "{factor}: {early} then {late}");
        }
    }
}
