//! The `[bands]` table: number of points and runs of quantiles over time.

use super::document::Document;

/// Default points on a grid of more than [`ALL`].
const POINTS: u64 = 33;
/// Bands at all points of a grid of up to this many; with twice as many, counting takes a tenth of a run's time.
const ALL: u64 = 65;
/// Default points of a control loop on a grid of more than [`MOST_POINTS`]: its phases are short, and its runs cost
/// more than counting.
const OF_LOOPS: u64 = 201;
/// Counts at a point take some 4 kB per series and thread; a spacecraft with eight wheels has 34 series.
pub const MOST_POINTS: u64 = 257;
/// Default number of leading dispersed runs, a whole net of Sobol points. The share of all runs below their quantile of
/// fraction p has the standard error sqrt(p (1 - p)/131,072): 0.14% for the median, 0.06% for 5% and 95%, or 0.0035 and
/// 0.006 standard deviations of a normal number; half a bucket ([`crate::statistics::deviation::RELATIVE_ERROR`]) of a
/// 95% quantile is 0.026.
pub const RUNS: u64 = 1 << 17;
/// Leaves ten runs beyond a 1% quantile.
pub const FEWEST_RUNS: u64 = 1000;
const KEY: &str = "bands.points";

/// The number of points on a grid of `grid` points; problems are noted.
pub fn resolve(written: Option<u64>, grid: u64, document: &mut Document<'_>) -> u64 {
    let has_loop = document.law.as_ref().is_some_and(|law| law.spec().is_some());
    let (all, points) = if has_loop { (MOST_POINTS, OF_LOOPS) } else { (ALL, POINTS) };
    let Some(points) = written else { return if grid <= all { grid } else { points } };
    if points == 1 || points > grid {
        let allowed = format!("0 (no bands), or 2 to {}: the grid has {grid} points", grid.min(MOST_POINTS));
        document.add(KEY, Some(points.to_string()), allowed, "write fewer points, or more in observe.points");
    }
    points
}
