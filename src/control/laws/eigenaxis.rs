//! [`Eigenaxis`]: a slew about one axis fixed in the body and in space.

use super::{AttitudeLaw, KnownBody, LawInput, LawKind, limit, number};
use crate::control::vector::{norm, product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = omega x H - k K q_v - c K omega from rest turns about a fixed axis, with theta'' = -c theta' - k sin(theta/2) (B. Wie, H. Weiss & A. Arapostathis,
/// *J. Guidance* 12(3), 1989). With a limit of the rate the error is cut so that the body coasts at that rate (cascade saturation; Wie, *Space Vehicle
/// Dynamics and Control*, 2008, section 7.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigenaxis {
    /// k, 1/s^2.
    pub stiffness: f64,
    /// c, 1/s.
    pub damping: f64,
    /// Largest rate, rad/s; infinite without a limit.
    pub largest_rate: f64,
    /// Largest torque on the body beside what its own momentum and a target that turns take, N m; infinite without a limit. Beyond it the torque keeps its
    /// direction.
    pub largest_torque: f64,
}

/// Its keys in campaign files.
pub static PARAMETERS: [LawParameter; 4] = [
    LawParameter::number("bandwidth_rad_s", "rad/s", "Natural frequency w of small errors: k = 2 w^2", Limit::Positive),
    LawParameter::number("damping", "1", "Damping ratio z of small errors: c = 2 z w", Limit::Positive),
    LawParameter::number("max_rate_rad_s", "rad/s", "Largest rate of a slew; zero: no limit", Limit::NotNegative)
        .or(&[0.0]),
    LawParameter::number("max_torque_n_m", "N m", "Largest torque of a slew; zero: no limit", Limit::NotNegative)
        .or(&[0.0]),
];

/// Its place in the list of laws.
pub const KIND: LawKind = LawKind {
    name: "eigenaxis",
    parameters: &PARAMETERS,
    make: |table| {
        let (bandwidth, damping) = (number(table, "bandwidth_rad_s"), number(table, "damping"));
        AttitudeLaw::Eigenaxis(Eigenaxis {
            stiffness: 2.0 * bandwidth * bandwidth,
            damping: 2.0 * damping * bandwidth,
            largest_rate: limit(table, "max_rate_rad_s"),
            largest_torque: limit(table, "max_torque_n_m"),
        })
    },
};

impl Eigenaxis {
    /// The torque on the body, F_s, N m.
    pub fn torque(&self, craft: &KnownBody, input: &LawInput) -> [f64; 3] {
        let error = scaled(self.stiffness, input.error_vector());
        // where damping balances the error, the rate is error/c
        let size = norm(error);
        let most = self.damping * self.largest_rate;
        let error = if size > most { scaled(most / size, error) } else { error };
        let wanted = product(craft.inertia, scaled(-1.0, sum(error, scaled(self.damping, input.omega_st_s()))));
        let size = norm(wanted);
        let limited = if size > self.largest_torque { scaled(self.largest_torque / size, wanted) } else { wanted };
        sum(limited, input.feedforward(craft))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::control::rotation::{quaternion_of, vector_of};
    use crate::control::vector::cross;

    const AXIS: [f64; 3] = [0.48, -0.6, 0.64];
    const START: f64 = 2.4;
    const LAW: Eigenaxis =
        Eigenaxis { stiffness: 0.02, damping: 0.15, largest_rate: f64::INFINITY, largest_torque: f64::INFINITY };

    /// The angle after `time` seconds of a slew from rest, the largest part of the rotation off the axis, and the largest rate.
    fn slew(law: Eigenaxis, period: f64, time: f64) -> [f64; 3] {
        let mut body = Body { inertia: [30.0, 45.0, 20.0], q_es: quaternion_of(scaled(START, AXIS)), omega: [0.0; 3] };
        let craft = KnownBody { inertia: body.matrix() };
        let (mut off, mut fastest) = (0.0_f64, 0.0_f64);
        let ticks = (time / period).round() as usize;
        for _ in 0..ticks {
            let torque = law.torque(&craft, &body.input());
            body.step(torque, period, 4);
            off = off.max(norm(cross(vector_of(body.q_es), AXIS)));
            fastest = fastest.max(norm(body.omega));
        }
        [norm(vector_of(body.q_es)), off, fastest]
    }

    /// Law: the slew is about one axis and follows theta'' = -c theta' - k sin(theta/2), with errors of first order in the period.
    #[test]
    fn the_axis_stays_and_the_angle_follows_its_equation() {
        let time = 20.0;
        let (mut angle, mut rate) = (START, 0.0_f64);
        let h = 1e-4;
        for _ in 0..(time / h) as usize {
            let slope = |angle: f64, rate: f64| -LAW.damping * rate - LAW.stiffness * libm::sin(0.5 * angle);
            let middle = (angle + 0.5 * h * rate, rate + 0.5 * h * slope(angle, rate));
            (angle, rate) = (angle + h * middle.1, rate + h * slope(middle.0, middle.1));
        }
        let [coarse, fine] = [0.4, 0.2].map(|period| slew(LAW, period, time));
        let errors = [coarse, fine].map(|found| (found[0] - angle).abs());
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 1.0).abs() < 0.03, "order {order}: {errors:?}");
        assert!(
            (coarse[1] / fine[1] - 2.0).abs() < 0.05 && fine[1] < 0.005,
            "off the axis {} and {}",
            coarse[1],
            fine[1]
        );
    }

    /// Law: the rate stays within its limit, and the slew ends at the target with limits of rate and torque.
    #[test]
    fn limits_are_kept() {
        let law = Eigenaxis { largest_rate: 0.05, largest_torque: 0.5, ..LAW };
        let [angle, off, fastest] = slew(law, 0.1, 150.0);
        assert!(fastest < 0.0505 && fastest > 0.045, "{fastest}");
        assert!(angle < 1e-3 && off < 0.1, "{angle} {off}");
    }
}
