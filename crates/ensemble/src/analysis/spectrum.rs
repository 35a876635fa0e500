//! Amplitude spectrum of a uniform series, for a picture; `exchange_frequency_hz` comes from [`crate::observables`], on
//! the campaign's grid.

use core::f64::consts::{PI, TAU};

/// Maximum number of frequencies.
const MOST: usize = 400;

/// Frequencies (Hz) and amplitudes of `values` at uniform `times`, s, without the mean; rounding errors are zero.
/// `None` for fewer than eight points.
///
/// Hann window w_k = (1 - cos(2 pi k / n))/2 with mean 1/2: a sine of amplitude a at a bin has the amplitude a (F. J.
/// Harris, *Proc. IEEE* 66 (1978) 51).
pub fn amplitudes(times: &[f64], values: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let n = values.len().min(times.len()).checked_sub(1).filter(|n| *n >= 8)?;
    let duration = times[n] - times[0];
    let count = n as f64;
    let windows: Vec<f64> = (0..n).map(|k| 0.5 - 0.5 * libm::cos(TAU * k as f64 / count)).collect();
    let weight: f64 = windows.iter().sum();
    let mean = values.iter().zip(&windows).map(|(value, window)| value * window).sum::<f64>() / weight;
    let shaped: Vec<f64> = values.iter().zip(&windows).map(|(value, window)| (value - mean) * window).collect();
    // rounding error of a constant: n roundings of half an epsilon
    let noise = count * f64::EPSILON * values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let amplitude = |bin: usize| {
        let (mut re, mut im) = (0.0, 0.0);
        for (k, value) in shaped.iter().enumerate() {
            // exact phase modulo a turn
            let phase = 2.0 * PI * ((bin * k) % n) as f64 / count;
            re += value * libm::cos(phase);
            im += value * libm::sin(phase);
        }
        let found = 2.0 / weight * libm::sqrt(re * re + im * im);
        if found > noise { found } else { 0.0 }
    };
    let bins = 1..=(n / 2).min(MOST);
    Some((bins.clone().map(|bin| bin as f64 / duration).collect(), bins.map(amplitude).collect()))
}

/// The frequency of the largest amplitude, by a parabola through it and its neighbours; `None` if all are zero or it is
/// at an end.
pub fn dominant(frequencies: &[f64], amplitudes: &[f64]) -> Option<f64> {
    let peak = (0..amplitudes.len()).max_by(|a, b| amplitudes[*a].total_cmp(&amplitudes[*b]))?;
    if amplitudes[peak] <= 0.0 || !amplitudes[peak].is_finite() {
        return None;
    }
    let (Some(before), Some(after)) = (peak.checked_sub(1), amplitudes.get(peak + 1)) else {
        return None;
    };
    let (a, b, c) = (amplitudes[before], amplitudes[peak], *after);
    let curvature = a - 2.0 * b + c;
    let shift = if curvature < 0.0 { (0.5 * (a - c) / curvature).clamp(-0.5, 0.5) } else { 0.0 };
    Some(frequencies[peak] + shift * (frequencies[1] - frequencies[0]))
}
