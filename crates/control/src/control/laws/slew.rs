//! [`Slew`]: bang-bang or bang-coast-bang removal of a large error under a torque limit.
//!
//! With the rotation angle theta to the target about e, and a = torque limit/|K e|, the rate along e follows
//! min(max_rate, sqrt(2 b theta)), from which the body stops on target at the deceleration b (B. Wie, *Space Vehicle
//! Dynamics and Control*, 2008, section 7.3, has the same limit for small angles). The curve is met at the end of each
//! period, so that following it takes no gain or bandwidth.

use crate::loops::attitude_law::{KnownBody, LawInput};
use crate::loops::vector::{dot, norm, product, scaled, sum, vector_of};

/// b/a, the share of the available deceleration used for braking. The rest covers an inertia wrong by up to 5% and
/// costs 1.3% of the time of a slew without coasting, sqrt((1 + 1/0.95)/2).
const BRAKING: f64 = 0.95;
/// Ticks near the target before the law for small errors takes over: four on the curve, and two that remove the rest.
const NEAR_TICKS: u8 = 6;
/// Small-error torque relative to the limit at which a slew restarts; noise on target stays below it for a suitable
/// bandwidth.
const ANEW: f64 = 2.0;
/// Commands under way that are remembered; earlier ones count as none.
const MOST_COMMANDS: usize = 16;

#[derive(Clone, Copy, PartialEq)]
enum Stage {
    /// Before the first tick of the phase.
    Begins,
    Slews,
    /// Another law removes the small error.
    Rests,
}

#[derive(Clone, Copy)]
pub struct Slew {
    period: f64,
    /// Delay from a tick to the effect of its command.
    delay: f64,
    stage: Stage,
    /// Ticks near the target.
    near: u8,
    /// True if the angle shrank at the last tick, and if it has stopped shrinking in this slew.
    was_closing: bool,
    has_stopped: bool,
    /// Accelerations of the last ticks, latest first, F_s.
    commands: [[f64; 3]; MOST_COMMANDS],
}

impl Slew {
    pub fn new(period: f64, delay: f64) -> Self {
        let commands = [[0.0; 3]; MOST_COMMANDS];
        let stage = Stage::Begins;
        Slew { period, delay, stage, near: 0, was_closing: false, has_stopped: false, commands }
    }

    /// Rotation vector to the target and rate relative to it, F_s, predicted to the time at which this tick's command
    /// acts.
    fn predicted(&self, input: &LawInput) -> [[f64; 3]; 2] {
        let (mut angle, mut rate) = (vector_of(input.q_ts), input.omega_st_s());
        let remembered = MOST_COMMANDS as f64 * self.period;
        angle = sum(angle, scaled((self.delay - remembered).max(0.0), rate));
        for (later, command) in self.commands.iter().enumerate().rev() {
            let length = (self.delay - later as f64 * self.period).clamp(0.0, self.period);
            angle = sum(angle, sum(scaled(length, rate), scaled(0.5 * length * length, *command)));
            rate = sum(rate, scaled(length, *command));
        }
        [angle, rate]
    }

    /// The acceleration at a tick, F_s, before the torque limit; `None` for a small error. `small` is the acceleration
    /// of the law for small errors.
    pub fn acceleration(
        &mut self,
        craft: &KnownBody,
        input: &LawInput,
        [largest_rate, largest_torque]: [f64; 2],
        small: [f64; 3],
    ) -> Option<[f64; 3]> {
        let period = self.period;
        let [rotation, rate] = self.predicted(input);
        let angle = norm(rotation);
        let axis = if angle > 0.0 { scaled(1.0 / angle, rotation) } else { [0.0; 3] };
        let most = largest_torque / norm(product(craft.inertia, axis));
        let closing = -dot(axis, rate);
        // removes angle and rate in two periods
        let ending = angle / (period * period) - 1.5 * closing / period;
        if self.stage == Stage::Rests && norm(product(craft.inertia, small)) > ANEW * largest_torque {
            *self = Slew { stage: Stage::Begins, commands: self.commands, ..Slew::new(period, self.delay) };
        }
        match self.stage {
            Stage::Rests => return None,
            Stage::Begins if ending.abs() <= most => self.stage = Stage::Rests,
            Stage::Begins | Stage::Slews => {
                self.stage = Stage::Slews;
                self.has_stopped |= self.was_closing && closing <= 0.0;
                self.was_closing = closing > 0.0;
                self.near = if self.has_stopped || ending.abs() < most { self.near + 1 } else { 0 };
                if self.near > NEAR_TICKS {
                    self.stage = Stage::Rests;
                }
            }
        }
        if self.stage == Stage::Rests {
            return None;
        }
        // meets the curve at the end of the period: v^2 = 2 b (angle - (closing + v) T/2)
        let braking = BRAKING * most;
        let half = 0.5 * braking * period;
        let ahead = (angle - 0.5 * closing * period).max(0.0);
        let on_curve = (half * half + 2.0 * braking * ahead).sqrt() - half;
        let along = ((on_curve.min(largest_rate) - closing) / period).min(ending);
        let across = sum(rate, scaled(closing, axis));
        Some(sum(scaled(-along, axis), scaled(-1.0 / period, across)))
    }

    /// Remembers the acceleration commanded at a tick, F_s.
    pub fn command(&mut self, acceleration: [f64; 3]) {
        self.commands.rotate_right(1);
        self.commands[0] = acceleration;
    }
}
