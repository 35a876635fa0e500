//! [`MrpFeedback`]: proportional to the modified Rodrigues parameters of the error, to the rate, and to an integral.

use super::interface::{KnownBody, LawInput, LawSettings};
use crate::control::declared::{declared, limit};
use crate::control::rotation::mrp_of;
use crate::control::vector::{cross, difference, norm, product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -k s - P omega_st - P Ki z + (omega_te + Ki z) x H + K (omega_te' - omega x omega_te), with s the attitude
/// relative to the target, z = k int s dt + K omega_st, K = J less the axial inertias of free wheels, and H with the
/// wheels (H. Schaub & J. L. Junkins, *Analytical Mechanics of Space Systems*, 2018, section 8.4; the form of
/// Basilisk's module `mrpFeedback`: towards a target at rest without an integral nothing is left of the third term).
/// Where `gyroscopic`, omega x H stands in place of (omega_te + Ki z) x H: the body's own gyroscopic torque is
/// balanced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MrpFeedback {
    /// K, N m.
    pub stiffness: f64,
    /// P, N m s.
    pub damping: f64,
    /// Ki, 1/(N m s); zero without an integral.
    pub integral: f64,
    /// Largest magnitude of each component of the integral of K s, N m s.
    pub integral_limit: f64,
    /// Whether omega x H is in it.
    pub gyroscopic: bool,
    /// The integral of K s, N m s.
    summed: [f64; 3],
}

declared! {
    /// Its numbers in campaign files.
    MrpNumbers = PARAMETERS {
        stiffness: f64 = LawParameter::number("stiffness_n_m", "N m", "Torque opposing an MRP of one: K",
            Limit::Positive);
        damping: f64 = LawParameter::number("damping_n_m_s", "N m s", "Torque opposing a rate of 1 rad/s: P",
            Limit::NotNegative);
        integral: f64 = LawParameter::number("integral_1_n_m_s", "1/(N m s)", "Gain of the integral: Ki",
            Limit::NotNegative).or(&[0.0]);
        integral_limit: f64 = LawParameter::number(
            "integral_limit_n_m_s",
            "N m s",
            "Largest magnitude of each component of the integral of K s; zero: no limit",
            Limit::NotNegative,
        )
        .or(&[0.0]);
    }
}

/// What campaign files call it.
pub const NAME: &str = "mrp_feedback";

impl MrpFeedback {
    /// The law of a phase.
    pub fn of(settings: &LawSettings<'_>) -> Self {
        let numbers = MrpNumbers::of(settings.table);
        let law = MrpFeedback::new(numbers.stiffness, numbers.damping);
        let law = law.with_integral(numbers.integral, limit(numbers.integral_limit));
        MrpFeedback { gyroscopic: settings.gyroscopic, ..law }
    }

    /// Without an integral, and without omega x H.
    pub fn new(stiffness: f64, damping: f64) -> Self {
        let (integral, integral_limit) = (0.0, f64::INFINITY);
        MrpFeedback { stiffness, damping, integral, integral_limit, gyroscopic: false, summed: [0.0; 3] }
    }

    /// The same with an integral of gain `integral`, whose components stay within `limit`.
    #[must_use]
    pub fn with_integral(self, integral: f64, limit: f64) -> Self {
        MrpFeedback { integral, integral_limit: limit, ..self }
    }

    /// The torque on the body, F_s, N m, at a tick `period` seconds after the last one (zero at the first).
    pub fn torque(&mut self, craft: &KnownBody, input: &LawInput, period: f64) -> [f64; 3] {
        let (mrp, relative) = (mrp_of(input.q_ts), input.omega_st_s());
        let mut torque = sum(scaled(self.stiffness, mrp), scaled(self.damping, relative));
        let mut rate = input.omega_te_s;
        if self.integral > 0.0 {
            let added = sum(self.summed, scaled(self.stiffness * period, mrp));
            self.summed = added.map(|x| x.clamp(-self.integral_limit, self.integral_limit));
            let z = sum(self.summed, product(craft.inertia, relative));
            torque = sum(torque, scaled(self.damping * self.integral, z));
            rate = sum(rate, scaled(self.integral, z));
        }
        if self.gyroscopic {
            rate = input.omega_se_s;
        }
        let carried = difference(cross(input.omega_se_s, input.omega_te_s), input.acceleration_te_s);
        let feedforward = difference(product(craft.inertia, carried), cross(rate, input.momentum_s));
        scaled(-1.0, sum(torque, feedforward))
    }

    /// The Lyapunov function omega' K omega/2 + 2 K ln(1 + s's) of a target at rest, whose derivative is -P |omega|^2
    /// (Schaub & Junkins, eq. 8.53).
    pub fn lyapunov(&self, craft: &KnownBody, mrp: [f64; 3], omega: [f64; 3]) -> f64 {
        let kinetic: f64 = product(craft.inertia, omega).iter().zip(omega).map(|(h, w)| 0.5 * h * w).sum();
        kinetic + 2.0 * self.stiffness * libm::log1p(norm(mrp) * norm(mrp))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::control::rotation::quaternion_of;
    use crate::control::vector::dot;

    /// Law: V falls by P times the integral of |omega|^2, with an error of first order in the period, also where the
    /// MRP switch to the shadow set, at which V does not jump.
    #[test]
    fn the_lyapunov_function_falls() {
        let inertia = [900.0, 800.0, 600.0];
        // turning away through half a turn: the MRP switch on the way, anywhere within a period
        let start = |run: i32| {
            let q_es = quaternion_of([0.0, 3.0 - 0.001 * f64::from(run), 0.4]);
            Body { inertia, q_es, omega: [0.01, 0.09, -0.02] }
        };
        let craft = KnownBody { inertia: start(0).matrix() };
        let error = |mut body: Body, period: f64| {
            let mut law = MrpFeedback::new(3.5, 30.0);
            let at_start = law.lyapunov(&craft, mrp_of(body.q_es), body.omega);
            let (mut expected, mut worst, mut switches) = (at_start, 0.0_f64, 0);
            for _ in 0..(12.0 / period) as usize {
                let (mrp, omega) = (mrp_of(body.q_es), body.omega);
                let torque = law.torque(&craft, &body.input(), period);
                body.step(torque, period, 2);
                // the trapezoid of |omega|^2, whose error is of second order
                expected -= 15.0 * period * (dot(omega, omega) + dot(body.omega, body.omega));
                let now = law.lyapunov(&craft, mrp_of(body.q_es), body.omega);
                worst = worst.max((now - expected).abs());
                switches += usize::from(dot(mrp, mrp_of(body.q_es)) < 0.0);
            }
            assert_eq!(switches, 1, "the MRP switch");
            assert!(at_start - expected > 1.0, "{at_start} to {expected}");
            worst
        };
        let [coarse, fine] =
            [0.1, 0.025].map(|period| (0..40).map(|run| error(start(run), period)).fold(0.0, f64::max));
        let order = 0.5 * (coarse / fine).log2();
        assert!((order - 1.0).abs() < 0.03 && coarse < 0.1, "first order: {order} of {coarse} and {fine}");
    }

    /// Basilisk babdff7, src/fswAlgorithms/attControl/mrpFeedback/_UnitTest/test_mrpFeedback.py: the torques of the
    /// module (bsk 2.12.1) at its first three calls, control law 0, less its known torque of 1 N m along each axis. To
    /// the tolerance of the test.
    #[test]
    fn torques_are_those_of_basilisk() {
        let mrp = [0.3, -0.5, 0.7];
        let square = dot(mrp, mrp);
        let [x, y, z] = scaled(2.0 / (1.0 + square), mrp);
        let (omega_st, omega_te_s) = ([0.010, -0.020, 0.015], [-0.02, -0.01, 0.005]);
        let omega_se_s = sum(omega_st, omega_te_s);
        let craft = KnownBody { inertia: [[1000.0, 0.0, 0.0], [0.0, 800.0, 0.0], [0.0, 0.0, 800.0]] };
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.577350269190; 3]];
        let with_wheels = axes.iter().zip([10.0, 25.0, 50.0, 100.0]).fold([0.0; 3], |momentum, (axis, rate)| {
            sum(momentum, scaled(0.1 * (dot(omega_se_s, *axis) + rate), *axis))
        });
        let at_first = [-19.980451627443838, 24.0494926211355, -22.682200993691666];
        let later = [-20.015983854866544, 24.09802349694307, -22.765700842076527];
        let without = [[-17.115, 24.065, -24.495], [-17.115, 24.065, -24.495], [-17.14215, 24.1124, -24.5829]];
        let proportional = [-2.5840975403785, 3.1143559006308337, -2.592678360252333];
        let alone = [-2.435, 2.865, -2.495];
        for (integral, limit, momentum, expected) in [
            (0.01, 0.0, with_wheels, [at_first; 3]),
            (0.01, 20.0, with_wheels, [at_first, at_first, later]),
            (0.01, 20.0, [0.0; 3], without),
            (0.0, 0.0, with_wheels, [proportional; 3]),
            (0.0, 0.0, [0.0; 3], [alone; 3]),
        ] {
            let mut law = MrpFeedback::new(0.15, 150.0).with_integral(integral, limit);
            let input = LawInput {
                q_ts: [(1.0 - square) / (1.0 + square), x, y, z],
                omega_se_s,
                omega_te_s,
                acceleration_te_s: [0.0002, 0.0003, 0.0001],
                momentum_s: sum(product(craft.inertia, omega_se_s), momentum),
                ..LawInput::AT_TARGET
            };
            for (period, expected) in [0.0, 0.0, 0.5].into_iter().zip(expected) {
                let found = law.torque(&craft, &input, period);
                let difference = norm(difference(found, expected.map(|torque| torque + 1.0)));
                assert!(difference < 1e-8, "{integral} {limit} {period}: {found:?} for {expected:?}");
            }
        }
    }

    /// Law: the integral removes what a constant torque leaves without it, in a loop of its own.
    #[test]
    fn the_integral_removes_the_offset() {
        let left = |integral: f64| {
            let mut law = MrpFeedback::new(1.0, 10.0).with_integral(integral, f64::INFINITY);
            let mut body = Body { inertia: [30.0, 45.0, 20.0], q_es: [1.0, 0.0, 0.0, 0.0], omega: [0.0; 3] };
            let craft = KnownBody { inertia: body.matrix() };
            for tick in 0..8000 {
                let period = if tick == 0 { 0.0 } else { 0.2 };
                let torque = law.torque(&craft, &body.input(), period);
                body.step(sum(torque, [0.02, -0.01, 0.03]), 0.2, 1);
            }
            norm(mrp_of(body.q_es))
        };
        // K s balances the torque
        let offset = norm([0.02, -0.01, 0.03]);
        assert!((left(0.0) / offset - 1.0).abs() < 1e-13, "{}", left(0.0));
        assert!(left(0.005) < 3e-8, "{}", left(0.005));
    }

    /// Law: with omega x H the rate obeys K omega' = -k s - P omega of a target at rest, whatever momentum the wheels
    /// have; without it that momentum turns the body.
    #[test]
    fn the_gyroscopic_torque_is_balanced() {
        let (inertia, omega) = ([30.0, 45.0, 20.0], [0.05, -0.02, 0.03]);
        let body = Body { inertia, q_es: [1.0, 0.0, 0.0, 0.0], omega };
        let craft = KnownBody { inertia: body.matrix() };
        let wheels = [3.0, -2.0, 5.0];
        let momentum_s = sum(product(craft.inertia, omega), wheels);
        let input = LawInput { momentum_s, ..body.input() };
        for (gyroscopic, is_balanced) in [(true, true), (false, false)] {
            let mut law = MrpFeedback { gyroscopic, ..MrpFeedback::new(1.0, 10.0) };
            // K omega' = H x omega + u
            let torque = sum(cross(momentum_s, omega), law.torque(&craft, &input, 0.0));
            let off = norm(sum(torque, scaled(10.0, omega)));
            assert_eq!(off < 1e-15, is_balanced, "{off:e}");
        }
    }
}
