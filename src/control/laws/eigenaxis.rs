//! [`Eigenaxis`]: a slew about one axis fixed in the body and in space.

use super::integral::{self, Integral};
use super::interface::{KnownBody, LawInput, LawSettings};
use super::slew::Slew;
use crate::control::declared::{declared, limit};
use crate::control::vector::{norm, product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -K (k (e + z) + c omega_st) + omega x H + K (omega_te' - omega x omega_te), with e = q_v sign(q_0) of the
/// attitude q relative to the target, omega_st the rate relative to it, z = Ki int e dt, K = J less the axial inertias
/// of free wheels, H the momentum with the wheels. From rest it turns about a fixed axis, with theta'' = -c theta' - k
/// sin(theta/2) (B. Wie, H. Weiss & A. Arapostathis, *J. Guidance* 12(3), 1989).
///
/// With a limit of the rate, k (e + z) is cut to the length c max_rate, where the body coasts at that rate (cascade
/// saturation; Wie, *Space Vehicle Dynamics and Control*, 2008, section 7.3). With a limit of the torque, K (...) keeps
/// its direction, and large errors are removed by a `Slew`, which brakes in time. The integral rests while something is
/// cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigenaxis {
    /// k, 1/s^2.
    pub stiffness: f64,
    /// c, 1/s.
    pub damping: f64,
    /// Largest rate, rad/s; infinite without a limit.
    pub largest_rate: f64,
    /// Largest torque on the body beside what its own momentum and a target that turns take, N m; infinite without a
    /// limit. Beyond it the torque keeps its direction.
    pub largest_torque: f64,
    /// The integral of the error.
    pub integral: Integral,
    /// How large errors are removed under a limit of the torque.
    slew: Slew,
}

declared! {
    /// Its numbers in campaign files.
    EigenaxisNumbers = PARAMETERS {
        bandwidth: f64 = LawParameter::number("bandwidth_rad_s", "rad/s",
            "Natural frequency w of small errors: k = 2 w^2", Limit::Positive);
        damping: f64 = LawParameter::number("damping", "1", "Damping ratio z of small errors: c = 2 z w",
            Limit::Positive);
        max_rate: f64 = LawParameter::number("max_rate_rad_s", "rad/s", "Largest rate of a slew; zero: no limit",
            Limit::NotNegative)
            .or(&[0.0]);
        max_torque: f64 = LawParameter::number("max_torque_n_m", "N m", "Largest torque of a slew; zero: no limit",
            Limit::NotNegative)
            .or(&[0.0]);
        integral_gain: f64 = integral::GAIN;
        integral_limit: f64 = integral::LIMIT;
    }
}

/// What campaign files call it.
pub const NAME: &str = "eigenaxis";

impl Eigenaxis {
    /// The law of a phase.
    pub fn of(settings: &LawSettings<'_>) -> Self {
        let numbers = EigenaxisNumbers::of(settings.table);
        let (bandwidth, damping) = (numbers.bandwidth, numbers.damping);
        Eigenaxis {
            largest_rate: limit(numbers.max_rate),
            largest_torque: limit(numbers.max_torque),
            integral: Integral::new(numbers.integral_gain, limit(numbers.integral_limit)),
            slew: Slew::new(settings.period, settings.delay),
            ..Eigenaxis::new(2.0 * bandwidth * bandwidth, 2.0 * damping * bandwidth)
        }
    }

    /// Without limits and integral.
    pub fn new(stiffness: f64, damping: f64) -> Self {
        let (largest_rate, largest_torque) = (f64::INFINITY, f64::INFINITY);
        let slew = Slew::new(1.0, 0.0);
        Eigenaxis { stiffness, damping, largest_rate, largest_torque, integral: Integral::NONE, slew }
    }

    /// The torque on the body, F_s, N m, at a tick `period` seconds after the last one (zero at the first).
    pub fn torque(&mut self, craft: &KnownBody, input: &LawInput, period: f64) -> [f64; 3] {
        if self.largest_torque == f64::INFINITY {
            return sum(product(craft.inertia, self.small(input, period)), input.feedforward(craft));
        }
        let bounds = [self.largest_rate, self.largest_torque];
        let acceleration = match self.slew.acceleration(craft, input, bounds, self.uncut(input)) {
            Some(acceleration) => acceleration,
            None => self.small(input, period),
        };
        let wanted = product(craft.inertia, acceleration);
        let size = norm(wanted);
        let share = if size > self.largest_torque { self.largest_torque / size } else { 1.0 };
        self.slew.command(scaled(share, acceleration));
        sum(scaled(share, wanted), input.feedforward(craft))
    }

    /// The acceleration for small errors, rad/s^2, without limits and integral.
    fn uncut(&self, input: &LawInput) -> [f64; 3] {
        let error = scaled(self.stiffness, input.error_vector());
        scaled(-1.0, sum(error, scaled(self.damping, input.omega_st_s())))
    }

    /// The same within the limit of the rate, with the integral, which goes on where nothing is cut.
    fn small(&mut self, input: &LawInput, period: f64) -> [f64; 3] {
        // where damping balances the error, the rate is error/c
        let most = self.damping * self.largest_rate;
        let is_cut = |error: [f64; 3]| self.stiffness * norm(error) > most;
        let before = self.integral.with(input.error_vector(), 0.0);
        let since = if is_cut(before) { 0.0 } else { period };
        let error = scaled(self.stiffness, self.integral.with(input.error_vector(), since));
        let size = norm(error);
        let error = if size > most { scaled(most / size, error) } else { error };
        scaled(-1.0, sum(error, scaled(self.damping, input.omega_st_s())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::control::rotation::{quaternion_of, vector_of};
    use crate::control::vector::{cross, dot};
    use core::f64::consts::FRAC_PI_2;

    const AXIS: [f64; 3] = [0.48, -0.6, 0.64];
    const START: f64 = 2.4;
    const INERTIA: [f64; 3] = [30.0, 45.0, 20.0];

    /// What became of a slew from rest.
    struct Slewed {
        /// The angle at the end, rad.
        angle: f64,
        /// The largest part of the rotation off the axis, rad.
        off: f64,
        /// The largest rate, rad/s.
        fastest: f64,
        /// The largest angle beyond the target, rad.
        overshoot: f64,
        /// When the angle was last beyond 0.1 deg, s.
        settled: f64,
    }

    /// A slew of `start` rad about `axis` with the torque acting `delay` s after its tick, cut to `actuator` N m.
    fn slew(mut law: Eigenaxis, [start, time]: [f64; 2], [period, delay]: [f64; 2], actuator: f64) -> Slewed {
        let mut body = Body { inertia: INERTIA, q_es: quaternion_of(scaled(start, AXIS)), omega: [0.0; 3] };
        let craft = KnownBody { inertia: body.matrix() };
        let mut found = Slewed { angle: start, off: 0.0, fastest: 0.0, overshoot: 0.0, settled: 0.0 };
        let whole = (delay / period).floor() as usize;
        let part = delay - whole as f64 * period;
        let mut commands = vec![[0.0; 3]; whole + 1];
        for tick in 0..(time / period).round() as usize {
            let torque = law.torque(&craft, &body.input(), if tick == 0 { 0.0 } else { period });
            commands.push(scaled((actuator / norm(torque)).min(1.0), torque));
            for (torque, length) in [(commands[tick], part), (commands[tick + 1], period - part)] {
                if length > 0.0 {
                    body.step(torque, length, 4);
                }
            }
            let v = vector_of(body.q_es);
            found.angle = norm(v);
            found.off = found.off.max(norm(cross(v, AXIS)));
            found.fastest = found.fastest.max(norm(body.omega));
            found.overshoot = found.overshoot.max(-dot(v, AXIS));
            if found.angle > 0.1_f64.to_radians() {
                found.settled = (tick + 1) as f64 * period;
            }
        }
        found
    }

    const FREE: f64 = f64::INFINITY;

    /// Law: the slew is about one axis and follows theta'' = -c theta' - k sin(theta/2), with errors of first order in
    /// the period.
    #[test]
    fn the_axis_stays_and_the_angle_follows_its_equation() {
        let (law, time) = (Eigenaxis::new(0.02, 0.15), 20.0);
        let (mut angle, mut rate) = (START, 0.0_f64);
        let h = 1e-4;
        for _ in 0..(time / h) as usize {
            let slope = |angle: f64, rate: f64| -law.damping * rate - law.stiffness * libm::sin(0.5 * angle);
            let middle = (angle + 0.5 * h * rate, rate + 0.5 * h * slope(angle, rate));
            (angle, rate) = (angle + h * middle.1, rate + h * slope(middle.0, middle.1));
        }
        let [coarse, fine] = [0.4, 0.2].map(|period| slew(law, [START, time], [period, 0.0], FREE));
        let errors = [&coarse, &fine].map(|found| (found.angle - angle).abs());
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 1.0).abs() < 0.03, "order {order}: {errors:?}");
        assert!((coarse.off / fine.off - 2.0).abs() < 0.05 && fine.off < 0.005, "{} and {}", coarse.off, fine.off);
    }

    fn limited(bandwidth: f64, [rate, torque]: [f64; 2], [period, delay]: [f64; 2]) -> Eigenaxis {
        let law = Eigenaxis::new(2.0 * bandwidth * bandwidth, 1.8 * bandwidth);
        Eigenaxis { largest_rate: rate, largest_torque: torque, slew: Slew::new(period, delay), ..law }
    }

    /// Law: a slew from rest under limits of torque and rate takes the time of the textbook, 2 sqrt(theta/a) or
    /// theta/v + v/a with a = torque/|K axis| (Wie, section 7.3), within 3%, two periods and the delay, until it stays
    /// within 0.1 deg, with an overshoot of less than 0.05 deg, for every bandwidth that the period allows, any period
    /// and delay, short and long. The rate stays within its limit, and the axis is left only by the torque omega x H
    /// that is held over a period. Two periods: switches wait for a tick, and the last two remove what is left.
    /// Measured for 2.9 rad with a period and a delay of 0.5 s: 1.007 of it, 0.024 rad off the axis.
    #[test]
    fn slews_take_the_time_of_the_textbook() {
        let torque = 0.25;
        let along = norm([INERTIA[0] * AXIS[0], INERTIA[1] * AXIS[1], INERTIA[2] * AXIS[2]]);
        let most = torque / along;
        for times in [[0.1, 0.0], [0.1, 0.25], [0.25, 0.05], [0.5, 0.5]] {
            for bandwidth in [0.02, 0.05, 0.3, 1.0, 2.0] {
                if bandwidth * (times[0] + times[1]) > 0.6 {
                    continue;
                }
                for start in [0.3, FRAC_PI_2, 2.9] {
                    for rate in [FREE, 0.03] {
                        let peak = (most * start).sqrt();
                        let book = if peak < rate { 2.0 * (start / most).sqrt() } else { start / rate + rate / most };
                        let law = limited(bandwidth, [rate, torque], times);
                        let found = slew(law, [start, 1.5 * book], times, FREE);
                        let case = format!("{times:?} {bandwidth} {start} {rate}: {} of {book}", found.settled);
                        let late = times[0] * 2.0 + times[1];
                        assert!(found.settled < 1.03 * book + late && found.settled > 0.9 * book, "{case}");
                        assert!(found.overshoot < 0.05_f64.to_radians(), "{case}: {}", found.overshoot.to_degrees());
                        assert!(
                            found.fastest < 1.005 * rate && found.off < 0.05,
                            "{case}: {} {}",
                            found.fastest,
                            found.off
                        );
                    }
                }
            }
        }
    }

    /// Law: the law for small errors alone, whose torque an actuator cuts, does not brake in time at a high bandwidth,
    /// and is slow at a low one.
    #[test]
    fn without_a_slew_it_does_not_brake_in_time() {
        let along = norm([INERTIA[0] * AXIS[0], INERTIA[1] * AXIS[1], INERTIA[2] * AXIS[2]]);
        let book = 2.0 * (FRAC_PI_2 * along / 0.25_f64).sqrt();
        let [fast, slow] = [2.0, 0.02].map(|bandwidth| {
            let law = Eigenaxis::new(2.0 * bandwidth * bandwidth, 1.8 * bandwidth);
            slew(law, [FRAC_PI_2, 2.0 * book], [0.1, 0.0], 0.25)
        });
        assert!(fast.overshoot > 0.5 && slow.settled > 1.9 * book, "{} {}", fast.overshoot, slow.settled);
    }

    /// Law: without a limit of the torque the rate stays within its limit, and the slew ends at the target.
    #[test]
    fn the_limit_of_the_rate_is_kept() {
        let law = Eigenaxis { largest_rate: 0.05, ..Eigenaxis::new(0.02, 0.15) };
        let found = slew(law, [START, 150.0], [0.1, 0.0], FREE);
        assert!(found.fastest < 0.0505 && found.fastest > 0.045, "{}", found.fastest);
        assert!(found.angle < 1e-3 && found.off < 0.1, "{} {}", found.angle, found.off);
    }
}
