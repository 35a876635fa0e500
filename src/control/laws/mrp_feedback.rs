//! [`MrpFeedback`]: proportional to the modified Rodrigues parameters of the error, to the rate, and to an integral.

use super::KnownBody;
use crate::math::vector::{cross, difference, norm, product, scaled, sum};

/// u = -K s - P d_omega - P Ki z + (omega_r + Ki z) x H - J (omega x omega_r - omega_r'), with z = K int s dt + J (d_omega - d_omega(0)) and H with the
/// wheels (H. Schaub & J. L. Junkins, *Analytical Mechanics of Space Systems*, 2018, section 8.4; the form of Basilisk's module `mrpFeedback`).
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
    /// The integral of K s, N m s.
    summed: [f64; 3],
}

/// What the attitude is to follow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MrpReference {
    /// Rate of the reference relative to F_e, in F_s, rad/s.
    pub omega_re_s: [f64; 3],
    /// Its inertial derivative, in F_s, rad/s^2.
    pub acceleration_s: [f64; 3],
}

impl MrpFeedback {
    /// Without an integral.
    pub fn new(stiffness: f64, damping: f64) -> Self {
        MrpFeedback { stiffness, damping, integral: 0.0, integral_limit: f64::INFINITY, summed: [0.0; 3] }
    }

    /// The same with an integral of gain `integral`, whose components stay within `limit`.
    #[must_use]
    pub fn with_integral(self, integral: f64, limit: f64) -> Self {
        MrpFeedback { integral, integral_limit: limit, ..self }
    }

    /// The torque on the body, F_s, N m, at a tick `period` seconds after the last one (zero at the first). `mrp` is the attitude relative to the
    /// reference, `omega` the rate of F_s relative to F_e and `momentum` H, both in F_s.
    pub fn torque(
        &mut self,
        craft: &KnownBody,
        (mrp, omega, reference): ([f64; 3], [f64; 3], &MrpReference),
        momentum: [f64; 3],
        period: f64,
    ) -> [f64; 3] {
        let relative = difference(omega, reference.omega_re_s);
        let mut torque = sum(scaled(self.stiffness, mrp), scaled(self.damping, relative));
        let mut rate = reference.omega_re_s;
        if self.integral > 0.0 {
            let added = sum(self.summed, scaled(self.stiffness * period, mrp));
            self.summed = added.map(|x| x.clamp(-self.integral_limit, self.integral_limit));
            let z = sum(self.summed, product(craft.inertia, relative));
            torque = sum(torque, scaled(self.damping * self.integral, z));
            rate = sum(rate, scaled(self.integral, z));
        }
        let carried = difference(cross(omega, reference.omega_re_s), reference.acceleration_s);
        let feedforward = difference(product(craft.inertia, carried), cross(rate, momentum));
        scaled(-1.0, sum(torque, feedforward))
    }

    /// The Lyapunov function omega' K omega/2 + 2 K ln(1 + s's) of a reference at rest, whose derivative is -P |omega|^2 (Schaub & Junkins, eq. 8.53).
    pub fn lyapunov(&self, craft: &KnownBody, mrp: [f64; 3], omega: [f64; 3]) -> f64 {
        let kinetic: f64 = product(craft.inertia, omega).iter().zip(omega).map(|(h, w)| 0.5 * h * w).sum();
        kinetic + 2.0 * self.stiffness * libm::log1p(norm(mrp) * norm(mrp))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::control::rotation::{mrp_of, quaternion_of};
    use crate::math::vector::dot;

    /// Law: V falls at -P |omega|^2 to first order in the period, also where the MRP switch to the shadow set, at which V does not jump.
    #[test]
    fn the_lyapunov_function_falls() {
        let mut law = MrpFeedback::new(3.5, 30.0);
        // turning away through half a turn: the MRP switch on the way
        let mut body =
            Body { inertia: [900.0, 800.0, 600.0], q_es: quaternion_of([0.0, 3.0, 0.4]), omega: [0.01, 0.09, -0.02] };
        let craft = KnownBody { inertia: body.matrix() };
        let (mut switches, mut worst) = (0, [0.0_f64; 2]);
        for (which, period) in [(0, 0.1), (1, 0.05)] {
            let mut one = body;
            let mut before = mrp_of(one.q_es);
            for _ in 0..(40.0 / period) as usize {
                let v = law.lyapunov(&craft, mrp_of(one.q_es), one.omega);
                let momentum = product(craft.inertia, one.omega);
                let torque = law.torque(&craft, (mrp_of(one.q_es), one.omega, &MrpReference::default()), momentum, 0.0);
                let expected = -30.0 * dot(one.omega, one.omega);
                one.step(torque, period, 4);
                let slope = (law.lyapunov(&craft, mrp_of(one.q_es), one.omega) - v) / period;
                worst[which] = worst[which].max((slope - expected).abs());
                switches += usize::from(dot(before, mrp_of(one.q_es)) < 0.0);
                before = mrp_of(one.q_es);
            }
            if which == 1 {
                body = one;
            }
        }
        assert!(switches >= 1, "the MRP switch");
        assert!((worst[0] / worst[1]).log2() > 0.8, "first order: {worst:?}");
        assert!(body.omega.iter().all(|rate| rate.abs() < 0.1));
    }
}
