//! [`envelope`]: replaces curves that oscillate too fast to draw.

use super::bins;

/// Maximum number of turns of a drawn curve: some ten pixels per swing.
const MOST_TURNS: usize = 110;
const ENVELOPE: usize = 60;

pub fn turns(values: &[f64]) -> usize {
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step != 0.0);
    let signs: Vec<bool> = steps.map(|step| step > 0.0).collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// Turns count from this fraction of the range on: a step with noise is drawn as it is.
const SEEN: f64 = 0.01;

/// Relative ranges below this are rounding errors.
const ROUND_OFF: f64 = 1e-9;

/// The range of values; zero if it is rounding error, as for a constant of the motion.
pub fn swing(values: &[f64]) -> f64 {
    let (low, high) = bins::ends(values);
    if high - low > ROUND_OFF * high.abs().max(low.abs()) { high - low } else { 0.0 }
}

fn seen_turns(values: &[f64]) -> usize {
    let swing = swing(values);
    if swing == 0.0 {
        return 0;
    }
    let least = SEEN * swing;
    // the extreme since the last turn, and the direction there
    let (mut extreme, mut direction, mut count) = (values.first().copied().unwrap_or(0.0), 0.0, 0);
    for value in values {
        let step = value - extreme;
        if direction * step > 0.0 {
            extreme = *value;
        } else if step.abs() > least {
            count += usize::from(direction != 0.0);
            (extreme, direction) = (*value, step.signum());
        }
    }
    count
}

fn push(found: &mut [Vec<f64>; 3], point: [f64; 3]) {
    found.iter_mut().zip(point).for_each(|(values, value)| values.push(value));
}

/// Times, minima and maxima over short intervals of a series that is too fast to draw; else `None`.
pub fn envelope(times: &[f64], values: &[f64]) -> Option<[Vec<f64>; 3]> {
    let count = values.len().min(times.len());
    let turns = seen_turns(&values[..count]);
    if turns <= MOST_TURNS && 3 * turns <= count.max(60) {
        return None;
    }
    let width = count.div_ceil(ENVELOPE).max(4);
    let mut found = [Vec::new(), Vec::new(), Vec::new()];
    for start in (0..count.saturating_sub(1)).step_by(width) {
        // intervals share a point: no gaps
        let part = start..(start + width + 1).min(count);
        let (low, high) = bins::ends(&values[part.clone()]);
        [part.start, part.end - 1].iter().for_each(|end| push(&mut found, [times[*end], low, high]));
    }
    Some(found)
}

/// Times, minima and maxima of all `curves` (at common `times`) between neighbouring `ends`; omits empty intervals.
pub fn within(times: &[f64], curves: &[&[f64]], ends: &[f64]) -> [Vec<f64>; 3] {
    let mut found = [Vec::new(), Vec::new(), Vec::new()];
    for pair in ends.windows(2) {
        let points = times.partition_point(|time| *time < pair[0])..times.partition_point(|time| *time <= pair[1]);
        let values = curves.iter().flat_map(|curve| curve.get(points.start..points.end.min(curve.len())));
        let (low, high) = bins::ends(values.flatten().filter(|value| value.is_finite()));
        pair.iter().filter(|_| low <= high).for_each(|time| push(&mut found, [*time, low, high]));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a curve with too many turns is drawn as its envelope, which is its amplitude.
    #[test]
    fn fast_curves_have_envelopes() {
        let times: Vec<f64> = (0..=600).map(|k| 0.01 * f64::from(k)).collect();
        let wave = |hertz: f64| {
            times.iter().map(|t| (1.0 + t) * libm::sin(core::f64::consts::TAU * hertz * t)).collect::<Vec<_>>()
        };
        assert_eq!((turns(&wave(1.0)), envelope(&times, &wave(1.0))), (12, None));
        let [x, low, high] = envelope(&times, &wave(80.0 / 6.0)).expect("too fast");
        assert!(x.is_sorted() && x[0] == 0.0 && *x.last().unwrap() == 6.0);
        for k in 0..x.len() {
            assert!(
                (high[k] - (1.0 + x[k])).abs() < 0.6 && (low[k] + 1.0 + x[k]).abs() < 0.6,
                "{}: {} {}",
                x[k],
                low[k],
                high[k]
            );
        }
        let aliased: Vec<f64> = (0..101).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert!(envelope(&times[..101], &aliased).is_some());
        // a step with noise of a thousandth is a curve, of a tenth an area
        let step = |noise: f64| {
            aliased.iter().enumerate().map(|(k, sign)| f64::from(k > 50) + noise * sign).collect::<Vec<_>>()
        };
        assert!(envelope(&times[..101], &step(1e-3)).is_none() && envelope(&times[..101], &step(0.1)).is_some());
        assert_eq!(seen_turns(&wave(1.0)), 12);
        let zigzag = |turns: usize| (0..601).map(|k| (k.min(turns + 1) % 2) as f64).collect::<Vec<_>>();
        assert!(envelope(&times, &zigzag(110)).is_none() && envelope(&times, &zigzag(111)).is_some());
        let constant: Vec<f64> = aliased.iter().map(|sign| 1.75e9 + 1e-3 * sign).collect();
        assert!(envelope(&times[..101], &constant).is_none() && swing(&constant) == 0.0 && swing(&aliased) == 2.0);
    }
}
