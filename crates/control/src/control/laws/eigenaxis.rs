//! A slew about one axis fixed in the body and in space.

use super::integral::{self, Integral};
use super::slew::Slew;
use crate::loops::attitude_law::{AttitudeLaw, KnownBody, LawInput, LawKind, PhaseLaw, digits};
use crate::loops::declared::{declared, limit, number};
use crate::loops::vector::{norm, product, scaled, sum};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// u = -K (k (e + z) + c omega_st) + omega x H + K (omega_te' - omega x omega_te), z = Ki int e dt. From rest it turns
/// about a fixed axis, with theta'' = -c theta' - k sin(theta/2) (B. Wie, H. Weiss & A. Arapostathis, *J. Guidance*
/// 12(3), 1989).
///
/// A rate limit cuts k (e + z) to the length c max_rate, at which the body coasts (cascade saturation; Wie, *Space
/// Vehicle Dynamics and Control*, 2008, section 7.3). Under a torque limit K (...) keeps its direction, and a `Slew`
/// removes large errors, braking in time. The integral rests while a limit is active.
#[derive(Clone, Copy)]
struct Eigenaxis {
    /// k, 1/s^2.
    stiffness: f64,
    /// c, 1/s.
    damping: f64,
    /// Largest rate; may be infinite.
    largest_rate: f64,
    /// Largest torque on the body besides feedforward; may be infinite.
    largest_torque: f64,
    integral: Integral,
    /// Removes large errors under a torque limit.
    slew: Slew,
}

declared! {
    EigenaxisNumbers = PARAMETERS {
        bandwidth: f64 = LawParameter::number("bandwidth_rad_s", "rad/s",
            "Natural frequency w of small errors: k = 2 w^2", Limit::Positive);
        damping: f64 = LawParameter::number("damping", "1", "Damping ratio z of small errors: c = 2 z w",
            Limit::Positive);
        max_rate: f64 = number("max_rate_rad_s", "rad/s", "Largest rate of a slew; zero: no limit", &[0.0]);
        max_torque: f64 = number("max_torque_n_m", "N m", "Largest torque of a slew; zero: no limit", &[0.0]);
        integral_gain: f64 = integral::GAIN;
        integral_limit: f64 = integral::LIMIT;
    }
}

pub(super) fn kind() -> LawKind {
    LawKind::new("eigenaxis", &PARAMETERS, |settings| {
        let numbers = EigenaxisNumbers::of(settings.table);
        Eigenaxis {
            stiffness: 2.0 * numbers.bandwidth * numbers.bandwidth,
            damping: 2.0 * numbers.damping * numbers.bandwidth,
            largest_rate: limit(numbers.max_rate),
            largest_torque: limit(numbers.max_torque),
            integral: Integral::new(numbers.integral_gain, numbers.integral_limit),
            slew: Slew::new(settings.period, settings.delay),
        }
    })
}

impl Eigenaxis {
    /// The acceleration within the rate limit; the integral rests while it is active.
    fn small(&mut self, input: &LawInput, period: f64) -> [f64; 3] {
        // damping balances the error at the rate error/c
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

impl PhaseLaw for Eigenaxis {
    fn torque(&mut self, craft: &KnownBody, input: &LawInput<'_>, period: f64) -> [f64; 3] {
        if self.largest_torque == f64::INFINITY {
            return sum(product(craft.inertia, self.small(input, period)), input.feedforward(craft));
        }
        let bounds = [self.largest_rate, self.largest_torque];
        // for small errors, without limits and integral
        let error = scaled(self.stiffness, input.error_vector());
        let uncut = scaled(-1.0, sum(error, scaled(self.damping, input.omega_st_s())));
        let slew = self.slew.acceleration(craft, input, bounds, uncut);
        let acceleration = slew.unwrap_or_else(|| self.small(input, period));
        let wanted = product(craft.inertia, acceleration);
        let size = norm(wanted);
        let share = if size > self.largest_torque { self.largest_torque / size } else { 1.0 };
        self.slew.command(scaled(share, acceleration));
        sum(scaled(share, wanted), input.feedforward(craft))
    }

    fn weaker(&self, share: f64) -> Option<(AttitudeLaw, String)> {
        // under a torque limit a slew brakes on a curve without a gain at its end
        let (stiffness, damping) = (share * share * self.stiffness, share * self.damping);
        let gains = format!("bandwidth_rad_s = {}", digits((0.5 * stiffness).sqrt()));
        let law = AttitudeLaw::new(Eigenaxis { stiffness, damping, ..*self });
        (self.largest_torque == f64::INFINITY).then_some((law, gains))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::laws::plant::Body;
    use crate::loops::vector::{dot, quaternion_of, vector_of};
    use core::f64::consts::FRAC_PI_2;

    /// Law: a slew from rest under torque and rate limits takes the textbook's time, 2 sqrt(theta/a) or theta/v + v/a
    /// with a = torque/|K axis| (Wie, section 7.3), within 3%, two periods and the delay, until it stays within 0.1
    /// deg, and overshoots by less than 0.05 deg, for every bandwidth that period and delay allow. Two periods:
    /// switches wait for a tick, and the last two remove the rest.
    #[test]
    fn slews_take_the_time_of_the_textbook() {
        let (axis, inertia, torque) = ([0.48, -0.6, 0.64], [30.0, 45.0, 20.0], 0.25);
        let most = torque / norm([0, 1, 2].map(|i| inertia[i] * axis[i]));
        for [period, delay] in [[0.1, 0.0], [0.1, 0.25], [0.25, 0.05], [0.5, 0.5]] {
            for bandwidth in [0.02_f64, 0.05, 0.3, 1.0, 2.0].into_iter().filter(|w| w * (period + delay) <= 0.6) {
                for (start, rate) in [0.3, FRAC_PI_2, 2.9].into_iter().flat_map(|a| [(a, f64::INFINITY), (a, 0.03)]) {
                    let peak = (most * start).sqrt();
                    let book = if peak < rate { 2.0 * (start / most).sqrt() } else { start / rate + rate / most };
                    let mut law = Eigenaxis {
                        largest_rate: rate,
                        largest_torque: torque,
                        slew: Slew::new(period, delay),
                        stiffness: 2.0 * bandwidth * bandwidth,
                        damping: 1.8 * bandwidth,
                        integral: Integral::new(0.0, 0.0),
                    };
                    let mut body = Body::new(inertia, quaternion_of(scaled(start, axis)), [0.0; 3]);
                    let (mut settled, mut overshoot, mut fastest) = (0.0, 0.0_f64, 0.0_f64);
                    let part = delay % period;
                    let mut commands = vec![[0.0; 3]; (delay / period) as usize + 1];
                    for tick in 0..(1.5 * book / period) as usize {
                        commands.push(law.torque(&body.1, &body.input(), if tick == 0 { 0.0 } else { period }));
                        for (torque, length) in [(commands[tick], part), (commands[tick + 1], period - part)] {
                            body.step(torque, length);
                        }
                        let error = vector_of(body.0.q);
                        overshoot = overshoot.max(-dot(error, axis));
                        fastest = fastest.max(norm(body.0.omega));
                        if norm(error) > 0.1_f64.to_radians() {
                            settled = (tick + 1) as f64 * period;
                        }
                    }
                    let case = format!("{period} {delay} {bandwidth} {start} {rate}: {settled} of {book}");
                    assert!(settled < 1.03 * book + 2.0 * period + delay && settled > 0.9 * book, "{case}");
                    assert!(
                        overshoot < 0.05_f64.to_radians() && fastest < 1.005 * rate,
                        "{case} {overshoot} {fastest}"
                    );
                }
            }
        }
    }
}
