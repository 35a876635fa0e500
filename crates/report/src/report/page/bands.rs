//! [`time_bands`]: the bands of a campaign for figures over time.

use crate::ensemble::Bands;
use crate::report::over_time::curves::{FEWEST, TimeBands};

const BANDS: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// Quantiles of each series at each time with enough runs.
pub fn time_bands(bands: &Bands) -> Vec<TimeBands> {
    let points = bands.times().len();
    let count = |series: usize, point: usize| bands.count(series, point);
    let all = 0..bands.layout().series.len();
    // the motion has values in all phases, other series may not
    let in_flight = |point: usize| all.clone().map(|series| count(series, point)).max().unwrap_or(0);
    let in_flight: Vec<u64> = (0..points).map(in_flight).collect();
    let values = |series: usize, point: usize| {
        let is_shown = bands.counted(series, point) >= FEWEST;
        bands.quantiles(series, point, BANDS).map(|value| value.filter(|_| is_shown).unwrap_or(f64::NAN))
    };
    let of_points = |series: usize| (0..points).map(|point| values(series, point)).collect::<Vec<_>>();
    let turned = |of_points: Vec<[f64; BANDS.len()]>| {
        std::array::from_fn(|which| of_points.iter().map(|quantiles| quantiles[which]).collect())
    };
    let of_series = |series: usize| TimeBands {
        name: bands.quantity(series).name().to_owned(),
        times: bands.times().to_vec(),
        quantiles: turned(of_points(series)),
        runs: bands.runs(),
        counted: bands.counted_runs(),
        in_flight: in_flight.clone(),
    };
    let series = all.clone().map(of_series);
    series.filter(|series| series.quantiles[2].iter().any(|value| value.is_finite())).collect()
}
