//! [`TickTimes`]: times of ticks as decimal numbers. In binary, k T and differences of such times may be an ulp off;
//! comparisons with numbers of a file use the integer number of ticks instead.

/// Share of a period below which times are equal, for rounding of their products.
pub const SAME_TIME: f64 = 1e-9;

/// Share of a tick within which a time is that of the tick: with a rounding of 2e-16, enough for 4e9 ticks.
const NEAR_TICK: f64 = 1e-6;

/// Powers of ten at which a period is tried as a decimal number; more than nine places are rounding.
const SCALES: [f64; 10] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];

/// Times of a loop's ticks, as correctly rounded quotients of integers if its period is a decimal number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickTimes {
    period: f64,
    tick: f64,
    /// Tick k is at k `numerator`/`denominator`.
    numerator: f64,
    denominator: f64,
}

impl TickTimes {
    /// Times of a loop with `ticks` ticks per `period`, s.
    pub fn new(period: f64, ticks: u64) -> Self {
        // the nearest decimal number is the period, bit for bit
        let decimal = SCALES.map(|scale| ((period * scale).round(), scale));
        let decimal = decimal.into_iter().find(|(whole, scale)| whole / scale == period);
        let (numerator, denominator) = decimal.unwrap_or((period, 1.0));
        let ticks = ticks as f64;
        TickTimes { period, tick: period / ticks, numerator, denominator: denominator * ticks }
    }

    /// Difference below which times are equal, s.
    pub fn same(&self) -> f64 {
        SAME_TIME * self.period
    }

    /// `time`, a time or a difference of two, s; if it is that of a tick, correctly rounded.
    pub fn exact(&self, time: f64) -> f64 {
        let tick = (time / self.tick).round();
        if (time - tick * self.tick).abs() < NEAR_TICK * self.tick {
            tick * self.numerator / self.denominator
        } else {
            time
        }
    }
}
