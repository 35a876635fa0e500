//! The `[bands]` table: at how many points quantiles over time are counted, and of how many runs.

use super::document::Document;

/// Points of bands where the file does not say and the grid has more than [`ALL`].
const POINTS: u64 = 33;
/// Up to as many points of the grid all have bands: of twice as many points counting them takes a tenth of the time of
/// a run.
const ALL: u64 = 65;
/// Points of bands of a control loop on a grid of more than [`MOST_POINTS`]: its phases are short, and its runs cost
/// more than counting them.
const OF_LOOPS: u64 = 201;
/// Most points: counts at a point take some 4 kB for each series in each thread, and a spacecraft with eight wheels has
/// 34 series.
pub const MOST_POINTS: u64 = 257;
/// Dispersed runs that are counted where the file does not say: the first ones, a whole net of Sobol points. The share
/// of all runs below a quantile of so many, of fraction p, has the standard error sqrt(p (1 - p)/131,072): 0.14% of the
/// runs for the median, 0.06% for the 5% and the 95% quantile. In normal numbers that is 0.0035 and 0.006 standard
/// deviations; half a bucket ([`crate::statistics::deviation::RELATIVE_ERROR`]) of a 95% quantile is 0.026.
pub const RUNS: u64 = 1 << 17;
/// Fewest: a 1% quantile of them has ten runs beyond it.
pub const FEWEST_RUNS: u64 = 1000;
const KEY: &str = "bands.points";

/// The number of points of a campaign whose grid has `grid` points; what is wrong with it is noted.
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
