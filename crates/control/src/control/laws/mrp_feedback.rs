//! Feedback of modified Rodrigues parameters, rate and an integral.

use crate::loops::attitude_law::{AttitudeLaw, KnownBody, LawInput, LawKind, PhaseLaw, digits};
use crate::loops::declared::{declared, limit, number};
use crate::loops::vector::{cross, difference, mrp_of, product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -k s - P omega_st - P Ki z + (omega_te + Ki z) x H + K (omega_te' - omega x omega_te), with s the parameters of
/// q and z = k int s dt + K omega_st (H. Schaub & J. L. Junkins, *Analytical Mechanics of Space Systems*, 2018, section
/// 8.4, as in Basilisk's `mrpFeedback`: without an integral, the third term vanishes for a target at rest). With
/// `gyroscopic`, omega x H replaces (omega_te + Ki z) x H and balances the body's gyroscopic torque.
#[derive(Clone, Copy)]
struct MrpFeedback {
    /// K, P and Ki, and the limit of the integral.
    numbers: MrpNumbers,
    /// True if omega x H is included.
    gyroscopic: bool,
    /// Integral of K s, N m s.
    summed: [f64; 3],
}

declared! {
    MrpNumbers = PARAMETERS {
        stiffness: f64 = LawParameter::number("stiffness_n_m", "N m", "Torque opposing an MRP of one: K",
            Limit::Positive);
        damping: f64 = LawParameter::number("damping_n_m_s", "N m s", "Torque opposing a rate of 1 rad/s: P",
            Limit::NotNegative);
        integral: f64 = number("integral_1_n_m_s", "1/(N m s)", "Gain of the integral: Ki", &[0.0]);
        integral_limit: f64 = number("integral_limit_n_m_s", "N m s",
            "Largest magnitude of each component of the integral of K s; zero: no limit", &[0.0]);
    }
}

pub(super) fn kind() -> LawKind {
    LawKind::new("mrp_feedback", &PARAMETERS, |settings| {
        let (numbers, gyroscopic) = (MrpNumbers::of(settings.table), settings.gyroscopic);
        MrpFeedback { numbers, gyroscopic, summed: [0.0; 3] }
    })
}

impl PhaseLaw for MrpFeedback {
    fn torque(&mut self, craft: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        let MrpNumbers { stiffness, damping, integral, integral_limit } = self.numbers;
        let (mrp, relative) = (mrp_of(input.q_ts), input.omega_st_s());
        let mut torque = sum(scaled(stiffness, mrp), scaled(damping, relative));
        let mut rate = input.omega_te_s;
        if integral > 0.0 {
            let (added, most) = (sum(self.summed, scaled(stiffness * period, mrp)), limit(integral_limit));
            self.summed = added.map(|x| x.clamp(-most, most));
            let z = sum(self.summed, product(craft.inertia, relative));
            torque = sum(torque, scaled(damping * integral, z));
            rate = sum(rate, scaled(integral, z));
        }
        if self.gyroscopic {
            rate = input.omega_se_s;
        }
        let carried = difference(cross(input.omega_se_s, input.omega_te_s), input.acceleration_te_s);
        let feedforward = difference(product(craft.inertia, carried), cross(rate, input.momentum_s));
        scaled(-1.0, sum(torque, feedforward))
    }

    fn weaker(&self, share: f64) -> Option<(AttitudeLaw, String)> {
        let (stiffness, damping) = (share * self.numbers.stiffness, share * self.numbers.damping);
        let gains = format!("stiffness_n_m = {}, damping_n_m_s = {}", digits(stiffness), digits(damping));
        let numbers = MrpNumbers { stiffness, damping, ..self.numbers };
        Some((AttitudeLaw::new(MrpFeedback { numbers, ..*self }), gains))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loops::vector::{dot, norm};

    /// Basilisk babdff7, src/fswAlgorithms/attControl/mrpFeedback/_UnitTest/test_mrpFeedback.py: torques of the module
    /// (bsk 2.12.1) at its first three calls, control law 0, less its known torque of 1 N m along each axis, to the
    /// test's tolerance.
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
        // a limit of zero is none, hence one below any sum here
        for (integral, integral_limit, momentum, expected) in [
            (0.01, 1e-300, with_wheels, [at_first; 3]),
            (0.01, 20.0, with_wheels, [at_first, at_first, later]),
            (0.01, 20.0, [0.0; 3], without),
            (0.0, 1.0, with_wheels, [proportional; 3]),
            (0.0, 1.0, [0.0; 3], [alone; 3]),
        ] {
            let numbers = MrpNumbers { stiffness: 0.15, damping: 150.0, integral, integral_limit };
            let mut law = MrpFeedback { numbers, gyroscopic: false, summed: [0.0; 3] };
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
                assert!(difference < 1e-8, "{integral} {integral_limit} {period}: {found:?} for {expected:?}");
            }
        }
    }
}
