//! [`QuaternionFeedback`]: proportional to the quaternion of the error, and to the rate.

use super::integral::{self, Integral};
use super::interface::{KnownBody, LawInput, LawSettings};
use crate::control::declared::{declared, limit};
use crate::control::vector::{product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -2 w^2 K (e + z_i) - 2 z w K omega_st + omega x H + K (omega_te' - omega x omega_te), with e = q_v sign(q_0) of
/// the attitude q relative to the target, omega_st the rate relative to it, z_i = Ki int e dt, for the bandwidth w and
/// the damping z of small errors. K is J less the axial inertias of free wheels, H the momentum with the wheels (B.
/// Wie, *Space Vehicle Dynamics and Control*, 2008, section 7.3; the last term follows a target that turns).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuaternionFeedback {
    /// Bandwidth w, rad/s.
    pub bandwidth: f64,
    /// Damping z.
    pub damping: f64,
    /// The integral of the error.
    pub integral: Integral,
}

declared! {
    /// Its numbers in campaign files.
    QuaternionNumbers = PARAMETERS {
        bandwidth: f64 = LawParameter::number("bandwidth_rad_s", "rad/s", "Natural frequency of small errors",
            Limit::Positive);
        damping: f64 = LawParameter::number("damping", "1", "Damping ratio of small errors", Limit::NotNegative);
        integral_gain: f64 = integral::GAIN;
        integral_limit: f64 = integral::LIMIT;
    }
}

/// What campaign files call it.
pub const NAME: &str = "quaternion_feedback";

impl QuaternionFeedback {
    /// The law of a phase.
    pub fn of(settings: &LawSettings<'_>) -> Self {
        let QuaternionNumbers { bandwidth, damping, integral_gain, integral_limit } =
            QuaternionNumbers::of(settings.table);
        let integral = Integral::new(integral_gain, limit(integral_limit));
        QuaternionFeedback { bandwidth, damping, integral }
    }

    /// Without an integral.
    pub fn new(bandwidth: f64, damping: f64) -> Self {
        QuaternionFeedback { bandwidth, damping, integral: Integral::NONE }
    }

    /// The torque on the body, F_s, N m, at a tick `period` seconds after the last one (zero at the first).
    pub fn torque(&mut self, craft: &KnownBody, input: &LawInput, period: f64) -> [f64; 3] {
        let error = self.integral.with(input.error_vector(), period);
        let error = scaled(-2.0 * self.bandwidth * self.bandwidth, error);
        let wanted = sum(error, scaled(-2.0 * self.damping * self.bandwidth, input.omega_st_s()));
        sum(product(craft.inertia, wanted), input.feedforward(craft))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::control::rotation::{quaternion_of, vector_of};

    fn settle(mut law: QuaternionFeedback, angle: f64, period: f64, ticks: usize) -> Vec<f64> {
        let mut body = Body { inertia: [30.0, 36.0, 24.0], q_es: quaternion_of([0.0, angle, 0.0]), omega: [0.0; 3] };
        let craft = KnownBody { inertia: body.matrix() };
        let mut angles = vec![angle];
        for _ in 0..ticks {
            let torque = law.torque(&craft, &body.input(), 0.0);
            body.step(torque, period, 2);
            angles.push(vector_of(body.q_es)[1]);
        }
        angles
    }

    /// Law: a small angle about one axis follows the exact discrete solution of theta'' = -2 z w theta' - w^2 theta
    /// under a held torque.
    #[test]
    fn small_angles_follow_the_discrete_solution() {
        let (law, period, start) = (QuaternionFeedback::new(0.5, 0.8), 0.2, 1e-5);
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

    /// Law: at a hundred periods an oscillation, overshoot and settling time are those of a second-order system, within
    /// 2% of the step and of the time. With the frequency and the damping of the discrete poles, which are those of the
    /// held torque, they are its exactly: a torque that is held acts half a period late, and takes 0.01 of the damping
    /// ratio.
    #[test]
    fn overshoot_and_settling_are_second_order() {
        let response = |decay: f64, damped: f64, time: f64| {
            let angle = damped * time;
            libm::exp(-decay * time) * (libm::cos(angle) + decay / damped * libm::sin(angle))
        };
        let overshoot = |decay: f64, damped: f64| libm::exp(-core::f64::consts::PI * decay / damped);
        for (z, start) in [(0.4, 1e-3), (0.5, 1e-3), (0.7, 1e-3)] {
            let w = 0.3_f64;
            let (decay, damped) = (z * w, w * (1.0 - z * z).sqrt());
            let period = 2.0 * core::f64::consts::PI / damped / 100.0;
            let law = QuaternionFeedback::new(w, z);
            let angles: Vec<f64> = settle(law, start, period, 400).iter().map(|angle| angle / start).collect();
            let settled = |angle: &dyn Fn(usize) -> f64| (0..400).rev().find(|tick| angle(*tick).abs() > 0.02);
            // the poles r e^{+-i phi} of the map of angle and rate over a period
            let (k, c) = (w * w * period * period, 2.0 * z * w * period);
            let (modulus, cosine) = ((1.0 - c + 0.5 * k).sqrt(), 1.0 - 0.5 * c - 0.25 * k);
            let poles = (-libm::log(modulus) / period, libm::acos(cosine / modulus) / period);
            assert!((poles.0 / poles.1.hypot(poles.0) - z).abs() < 0.0125, "damping of the poles");
            let found = -angles.iter().copied().fold(f64::INFINITY, f64::min);
            let last = settled(&|tick| angles[tick]).expect("it starts at one");
            // sampled: between two ticks the lowest angle is lower by a few 1e-4 of it
            assert!((found / overshoot(poles.0, poles.1) - 1.0).abs() < 1e-3, "{z}: {found}");
            let exact = settled(&|tick| response(poles.0, poles.1, tick as f64 * period)).expect("it starts at one");
            assert!(exact.abs_diff(last) <= 1, "{z}: {last} for {exact}");
            assert!((found - overshoot(decay, damped)).abs() < 0.02, "{z}: {found}");
            // at 0.7 the overshoot of 4.6% is all that leaves the band of 2%: its end moves more than the poles do
            if z < 0.7 {
                let expected =
                    settled(&|tick| response(decay, damped, tick as f64 * period)).expect("it starts at one");
                assert!((last as f64 / expected as f64 - 1.0).abs() < 0.02, "{z}: {last} for {expected}");
            }
        }
    }

    /// Law: the sign of the quaternion is no part of the attitude, and the target is reached by the shorter way.
    #[test]
    fn the_shorter_way_is_taken() {
        let craft = KnownBody { inertia: [[2.0, 0.1, 0.0], [0.1, 3.0, 0.0], [0.0, 0.0, 4.0]] };
        let mut law = QuaternionFeedback::new(0.1, 0.7);
        let q = quaternion_of([0.2, -0.4, 0.1]);
        let mut at_rest = |q_ts: [f64; 4]| law.torque(&craft, &LawInput { q_ts, ..LawInput::AT_TARGET }, 0.0);
        let [a, b] = [at_rest(q), at_rest(q.map(|x| -x))];
        assert_eq!(a, b);
        assert!(at_rest(quaternion_of([0.0, 0.0, 4.0]))[2] > 0.0, "four radians back are two forth");
    }

    /// Whether the loop with u/J = -k sin(theta/2) - c theta' grows from a small angle and rate, the torque acting at
    /// once or a period late.
    fn grows(k: f64, c: f64, period: f64, is_late: bool) -> bool {
        let bandwidth = (0.5 * k).sqrt();
        let mut law = QuaternionFeedback::new(bandwidth, 0.5 * c / bandwidth);
        let (start, inertia) = (1e-5, [30.0, 36.0, 24.0]);
        let q_es = quaternion_of([0.0, start, 0.0]);
        let mut body = Body { inertia, q_es, omega: [0.0, start / period, 0.0] };
        let craft = KnownBody { inertia: body.matrix() };
        let (mut before, mut early, mut late) = ([0.0; 3], 0.0_f64, 0.0_f64);
        for tick in 0..4000 {
            let torque = law.torque(&craft, &body.input(), 0.0);
            body.step(if is_late { before } else { torque }, period, 1);
            before = torque;
            let size = vector_of(body.q_es)[1].abs() + period * body.omega[1].abs();
            match tick {
                _ if size > 0.1 => return true,
                ..400 => early = early.max(size),
                3600.. => late = late.max(size),
                _ => {}
            }
        }
        late > early
    }

    /// Law: stability is lost at c T = 2 without stiffness, at k T = 4 c with little damping; and where the torque is a
    /// period late at c T = 1, and where the root locus z (z - 1)^2 + c T (z - 1) + k T^2 (z + 1)/4 = 0 leaves the unit
    /// circle: k T^2/4 = (sqrt(9 - 8 c T) - 3 + 2 c T)/2. Within 1%.
    #[test]
    fn stability_ends_where_theory_says() {
        let late = |d: f64| 2.0 * ((9.0 - 8.0 * d).sqrt() - 3.0 + 2.0 * d);
        for period in [0.25, 1.0] {
            for (factor, expected) in [(0.99, false), (1.01, true)] {
                for (is_late, most) in [(false, 2.0), (true, 1.0)] {
                    let (k, c) = (1e-6 / (period * period), factor * most / period);
                    assert_eq!(grows(k, c, period, is_late), expected, "{is_late} {factor} of c T = {most}");
                }
                let d = 0.02;
                for (is_late, d, most) in [(false, d, 4.0 * d), (true, d, late(d)), (true, 0.5, late(0.5))] {
                    let (k, c) = (factor * most / (period * period), d / period);
                    assert_eq!(grows(k, c, period, is_late), expected, "{is_late} {factor} of k T^2 = {most}");
                }
            }
        }
    }
}
