//! `bands.parquet`: quantiles of quantities over time, a row per series and point.

use super::store::Result;
use crate::campaign::Plan;
use crate::ensemble::Bands;
use crate::statistics::deviation::RELATIVE_ERROR;
use crate::storage::columnar::{EncodingError, Packing, encoded};
use crate::storage::identity::provenance;
use crate::table::Table;

/// Column name and fraction of the runs.
pub const QUANTILES: [(&str, f64); 7] =
    [("p01", 0.01), ("p05", 0.05), ("p25", 0.25), ("p50", 0.5), ("p75", 0.75), ("p95", 0.95), ("p99", 0.99)];

/// Series, point, and the quantiles there.
type Place = (usize, usize, [Option<f64>; QUANTILES.len()]);

pub fn file(plan: &Plan, bands: &Bands) -> Result<Vec<u8>, EncodingError> {
    let (series, points) = (bands.layout().series.len(), bands.times().len());
    let quantiles = |series, point| bands.quantiles(series, point, QUANTILES.map(|(_, p)| p));
    let place = |series| (0..points).map(move |point| (series, point, quantiles(series, point)));
    let places: Vec<Place> = (0..series).flat_map(place).collect();
    let unit = "in the unit of the series";
    let mut table = Table::of(&places);
    table
        .word("series", "Name of the quantity, as in the time series of `simulate`.", |p| bands.quantity(p.0).name())
        .word("unit", "Its unit; empty for a pure number.", |p| bands.quantity(p.0).unit())
        .word("meaning", "What it is.", |p| bands.quantity(p.0).meaning())
        .real("time_s", "Time since the start.", |p| Some(bands.times()[p.1]))
        .unit("s")
        .count("count", "Runs that have a value: dispersed and ok.", |p| bands.count(p.0, p.1))
        .count("counted", "Runs that the quantiles are of: these, or the first of them (bands.runs).", |p| {
            bands.counted(p.0, p.1)
        })
        .real("nominal", &format!("Value of the nominal run, {unit}; null if it has none."), |p| {
            bands.nominal(p.0, p.1)
        })
        .real("min", &format!("Smallest value of the runs, {unit}."), |p| bands.extremes(p.0, p.1).map(|[min, _]| min))
        .real("max", &format!("Largest value of the runs, {unit}."), |p| bands.extremes(p.0, p.1).map(|[_, max]| max));
    for (index, (name, fraction)) in QUANTILES.into_iter().enumerate() {
        let percent = (100.0 * fraction).round();
        let meaning = format!(
            "{percent}% quantile over the runs, {unit}: within {RELATIVE_ERROR} of its deviation from the nominal run."
        );
        table.real(name, &meaning, |p| p.2[index]);
    }
    let table = table
        .note("spindrift.bands.relative_error", RELATIVE_ERROR.to_string())
        .note(
            "spindrift.bands.relative_error_of",
            "deviation of a quantile (type 7) from the nominal run; min, max and count are exact",
        )
        .note("spindrift.bands.runs", bands.runs().to_string())
        .note("spindrift.bands.counted", bands.counted_runs().to_string())
        .note(
            "spindrift.bands.standard_error",
            "sqrt(p (1 - p) / counted) of the share p of the runs below a quantile, where fewer runs are counted than \
             there are",
        )
        .finish();
    encoded(&table, provenance(plan), Packing::Zstd)
}
