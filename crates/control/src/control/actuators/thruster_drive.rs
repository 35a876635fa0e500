//! The response of a thruster to a wanted mean thrust over a control period.

use crate::scene::ThrusterModel;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThrustMode {
    /// Any thrust up to the largest.
    Throttled,
    /// On or off, for a share of the period that gives the mean. A remainder too short for a pulse carries over to the
    /// next period (Basilisk's `thrFiringRemainder`).
    Remainder,
    /// On or off. Below the shortest pulse, the share of its length turns the thruster on from `on` upwards, off from
    /// `off` downwards, and leaves it unchanged in between (a Schmitt trigger; Basilisk's `thrFiringSchmitt`).
    Hysteresis {
        /// Share of the shortest pulse that starts one.
        on: f64,
        /// Share that stops it, below `on`.
        off: f64,
    },
}

/// Memory of a thruster between periods.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PulseState {
    /// Pulse length carried over.
    pub remainder: f64,
    /// True if it fired in the last period.
    pub was_on: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Thrust from the start of the period on.
    pub thrust: f64,
    /// Duration, at most the period.
    pub on_time: f64,
}

impl ThrustMode {
    /// Response over `period` seconds to the wanted mean thrust `wanted`; negative counts as zero.
    pub fn over(self, valve: &ThrusterModel, wanted: f64, period: f64, state: &mut PulseState) -> Pulse {
        let (wanted, most, least_on) = (wanted.max(0.0), valve.max_thrust, valve.min_on_time);
        let length = wanted / most * period;
        let on_time = match self {
            ThrustMode::Throttled => {
                let thrust = wanted.min(most);
                return Pulse { thrust, on_time: if thrust > 0.0 { period } else { 0.0 } };
            }
            ThrustMode::Remainder => {
                let length = length + std::mem::take(&mut state.remainder);
                if length < least_on {
                    state.remainder = length;
                    0.0
                } else {
                    length
                }
            }
            ThrustMode::Hysteresis { on, off } => {
                let share = length / least_on;
                if length >= least_on {
                    length
                } else if share >= on || (share > off && state.was_on) {
                    least_on
                } else {
                    0.0
                }
            }
        };
        state.was_on = on_time > 0.0;
        Pulse { thrust: if state.was_on { most } else { 0.0 }, on_time: on_time.min(period) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The thruster of Basilisk's tests: 0.5 N, pulses of at least 0.2 s, a period of 0.5 s.
    const PERIOD: f64 = 0.5;
    const THRUSTER: ThrusterModel = ThrusterModel { thrust_scale: 1.0, max_thrust: 0.5, min_on_time: 0.2 };

    /// Checks the pulse lengths of eight thrusters over the periods.
    fn assert_pulses<const P: usize>(mode: ThrustMode, wanted: [[f64; 8]; P], expected: [[f64; 8]; P]) {
        let mut states = [PulseState::default(); 8];
        for (wanted, expected) in wanted.iter().zip(expected) {
            for (one, state) in states.iter_mut().enumerate() {
                let pulse = mode.over(&THRUSTER, wanted[one], PERIOD, state);
                // Basilisk writes 1.1 periods for a pulse that does not end within its period
                let expected = expected[one].min(PERIOD);
                assert!((pulse.on_time - expected).abs() < 1e-12, "{one}: {pulse:?} for {expected}");
                assert_eq!(pulse.thrust, if pulse.on_time > 0.0 { 0.5 } else { 0.0 });
            }
        }
    }

    /// Basilisk babdff7, src/fswAlgorithms/effectorInterfaces/thrFiringRemainder/_UnitTest/test_thrFiringRemainder.py,
    /// to its tolerance, without the two rows before the module knows its period. Off-pulsing is a thrust below the
    /// largest.
    #[test]
    fn pulses_with_remainder_are_those_of_basilisk() {
        let wanted = [0.5, 0.05, 0.1, 0.15, 0.19, 0.0, 0.2, 0.49];
        let odd = [0.55, 0.0, 0.0, 0.0, 0.0, 0.0, 0.2, 0.49];
        let second = [0.55, 0.0, 0.2, 0.3, 0.38, 0.0, 0.2, 0.49];
        let fourth = [0.55, 0.2, 0.2, 0.3, 0.38, 0.0, 0.2, 0.49];
        assert_pulses(ThrustMode::Remainder, [wanted; 5], [odd, second, odd, fourth, odd]);
        let less = [-0.5, 0.0, -0.1, -0.2, -0.3, -0.34, -0.39, -0.44].map(|less| 0.5 + less);
        let odd = [0.0, 0.55, 0.4, 0.3, 0.2, 0.0, 0.0, 0.0];
        let second = [0.0, 0.55, 0.4, 0.3, 0.2, 0.32, 0.22, 0.0];
        let fourth = [0.0, 0.55, 0.4, 0.3, 0.2, 0.32, 0.22, 0.24];
        assert_pulses(ThrustMode::Remainder, [less; 5], [odd, second, odd, fourth, odd]);
    }

    /// Basilisk babdff7, src/fswAlgorithms/effectorInterfaces/thrFiringSchmitt/_UnitTest/test_thrFiringSchmitt.py, to
    /// its tolerance.
    #[test]
    fn pulses_with_hysteresis_are_those_of_basilisk() {
        let mode = ThrustMode::Hysteresis { on: 0.75, off: 0.25 };
        let last = |last: f64| [0.5, 0.05, 0.09, 0.11, 0.16, 0.18, 0.2, last];
        let on = |last: f64| [0.55, 0.0, 0.0, 0.0, 0.2, 0.2, 0.2, last];
        let wanted = [last(0.49), last(0.11), last(0.11), last(0.01), last(0.11)];
        assert_pulses(mode, wanted, [on(0.49), on(0.2), on(0.2), on(0.0), on(0.0)]);
        let fifth = |less: f64| [0.0, -0.1, -0.2, -0.3, less, -0.351, -0.451, -0.5].map(|less| 0.5 + less);
        let on = |fifth: f64| [0.55, 0.4, 0.3, 0.2, fifth, 0.0, 0.0, 0.0];
        let wanted = [fifth(-0.349), fifth(-0.351), fifth(-0.351), fifth(-0.5), fifth(-0.351)];
        assert_pulses(mode, wanted, [on(0.2), on(0.2), on(0.2), on(0.0), on(0.0)]);
    }
}
