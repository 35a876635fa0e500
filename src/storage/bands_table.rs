//! `bands.parquet`: quantiles over a campaign of quantities over time, one row for each series and point.

use parquet::errors::ParquetError;

use crate::campaign::Plan;
use crate::ensemble::Bands;
use crate::run::Quantity;
use crate::statistics::deviation::RELATIVE_ERROR;
use crate::storage::columnar::{Cells, Content, Heading, Layout, Packing};
use crate::storage::identity::provenance;

/// The quantiles: name of the column, and fraction of the runs.
pub const QUANTILES: [(&str, f64); 7] =
    [("p01", 0.01), ("p05", 0.05), ("p25", 0.25), ("p50", 0.5), ("p75", 0.75), ("p95", 0.95), ("p99", 0.99)];

pub fn headings() -> Vec<Heading> {
    let word = |name, meaning| Heading::new(Quantity::new(name, "", meaning), Content::Word);
    let unit = "in the unit of the series";
    let real = |name: &'static str, meaning: String| {
        Heading::new(Quantity::named(name.to_owned(), String::new(), meaning), Content::Real).nullable()
    };
    let percent = |fraction: f64| (100.0 * fraction).round();
    let quantile = |(name, fraction): (&'static str, f64)| {
        let meaning = format!(
            "{}% quantile over the runs, {unit}: within {RELATIVE_ERROR} of its deviation from the nominal run.",
            percent(fraction)
        );
        real(name, meaning)
    };
    let fixed = [
        word("series", "Name of the quantity, as in the time series of `simulate`."),
        word("unit", "Its unit; empty for a pure number."),
        word("meaning", "What it is."),
        Heading::new(Quantity::new("time_s", "s", "Time since the start."), Content::Real),
        Heading::new(Quantity::new("count", "", "Runs that have a value: dispersed and ok."), Content::Count),
        Heading::new(
            Quantity::new("counted", "", "Runs that the quantiles are of: these, or the first of them (bands.runs)."),
            Content::Count,
        ),
    ];
    let values = [
        real("nominal", format!("Value of the nominal run, {unit}; null if it has none.")),
        real("min", format!("Smallest value of the runs, {unit}.")),
        real("max", format!("Largest value of the runs, {unit}.")),
    ];
    fixed.into_iter().chain(values).chain(QUANTILES.map(quantile)).collect()
}

/// Numbers, and which of them there are.
fn optional(values: impl Iterator<Item = Option<f64>>) -> (Vec<f64>, Vec<bool>) {
    values.map(|value| (value.unwrap_or(f64::NAN), value.is_some())).unzip()
}

/// `bands` of `plan` as a Parquet file.
///
/// # Errors
/// Where encoding fails.
pub fn encoded(plan: &Plan, bands: &Bands) -> Result<Vec<u8>, ParquetError> {
    let mut origin = provenance(plan);
    origin.insert("spindrift.bands.relative_error".to_owned(), RELATIVE_ERROR.to_string());
    origin.insert(
        "spindrift.bands.relative_error_of".to_owned(),
        "deviation of a quantile (type 7) from the nominal run; min, max and count are exact".to_owned(),
    );
    origin.insert("spindrift.bands.runs".to_owned(), bands.runs().to_string());
    origin.insert("spindrift.bands.counted".to_owned(), bands.counted_runs().to_string());
    origin.insert(
        "spindrift.bands.standard_error".to_owned(),
        "sqrt(p (1 - p) / counted) of the share p of the runs below a quantile, where fewer runs are counted than there are".to_owned(),
    );
    let layout = Layout::new(&headings(), origin, Packing::Zstd)?;
    let (series, points) = (bands.layout().series.len(), bands.times().len());
    let places: Vec<(usize, usize)> =
        (0..series).flat_map(|series| (0..points).map(move |point| (series, point))).collect();
    let texts = [Quantity::name, Quantity::unit, Quantity::meaning]
        .map(|text| Cells::Text(places.iter().map(|(series, _)| Some(text(bands.quantity(*series)))).collect()));
    let times: Vec<f64> = places.iter().map(|(_, point)| bands.times()[*point]).collect();
    let counts = [Bands::count, Bands::counted]
        .map(|count| Cells::Count(places.iter().map(|(series, point)| count(bands, *series, *point)).collect(), None));
    let at = |value: &dyn Fn(usize, usize) -> Option<f64>| {
        optional(places.iter().map(|(series, point)| value(*series, *point)))
    };
    let mut columns = vec![
        at(&|series, point| bands.nominal(series, point)),
        at(&|series, point| bands.extremes(series, point).map(|[min, _]| min)),
        at(&|series, point| bands.extremes(series, point).map(|[_, max]| max)),
    ];
    let quantiles: Vec<[Option<f64>; QUANTILES.len()]> =
        places.iter().map(|(series, point)| bands.quantiles(*series, *point, QUANTILES.map(|(_, p)| p))).collect();
    columns.extend((0..QUANTILES.len()).map(|which| optional(quantiles.iter().map(|of_place| of_place[which]))));
    let cells = texts.into_iter().chain([Cells::Real(&times, None)]).chain(counts);
    let cells = cells.chain(columns.iter().map(|(values, there)| Cells::Real(values, Some(there))));
    let mut bytes = Vec::new();
    layout.write(&mut bytes, &[], cells)?;
    Ok(bytes)
}
