//! `statistics.parquet`: what the runs say, one row for each observable.

use crate::storage::columnar::EncodingError;

use crate::analysis::order_statistics::QuantileStatistic;
use crate::analysis::statistics::{ColumnStatistics, Statistics};
use crate::campaign::Plan;
use crate::run::Status;
use crate::statistics::quantile::percent;
use crate::storage::described_table::{self, DescribedColumn};

/// Name of the columns of the `p`-quantile: `p99_9`.
pub fn quantile_name(p: f64) -> String {
    format!("p{}", percent(p).replace('.', "_"))
}

/// The columns of the table.
fn table(statistics: &Statistics) -> Vec<DescribedColumn> {
    let columns = &statistics.columns;
    let text = |name: &str, meaning: &str, of: &dyn Fn(&ColumnStatistics) -> Option<String>| {
        DescribedColumn::texts(name, meaning, columns.iter().map(of))
    };
    let count = |name: &str, meaning: &str, of: &dyn Fn(&ColumnStatistics) -> u64| {
        DescribedColumn::counts(name, meaning, columns.iter().map(of))
    };
    let real = |name: &str, meaning: &str, of: &dyn Fn(&ColumnStatistics) -> Option<f64>| {
        DescribedColumn::numbers(name, meaning, columns.iter().map(of))
    };
    let mut table = vec![
        text("observable", "Name of the observable.", &|column| Some(column.quantity.name().to_owned())),
        text("unit", "Its unit; empty for a pure number.", &|column| Some(column.quantity.unit().to_owned())),
        text("meaning", "What it is.", &|column| Some(column.quantity.meaning().to_owned())),
        count("count", "Runs that are ok and have a value: those that the numbers are of.", &|column| {
            column.moments.count()
        }),
        count("without_value", "Runs that are ok and have no value.", &|column| column.without_value),
    ];
    for (status, number) in Status::ALL.into_iter().zip(statistics.statuses) {
        let meaning = format!("Samples that statistics are about and that ended with {}.", status.name());
        table.push(count(&format!("count_{}", status.name()), &meaning, &|_| number));
    }
    table.extend([
        text("failed_runs", "How runs that are not ok are treated.", &|_| Some(statistics.treatment())),
        text("intervals", "What the intervals are, or why there are none.", &|_| {
            Some(statistics.population.intervals())
        }),
        real("confidence", "Confidence of the intervals.", &|_| Some(statistics.confidence)),
        real("quantile_error", "Bound of the error of quantiles, relative to their magnitude, or to their distance from the median of the first runs where these are close together.", &|_| {
            Some(statistics.quantile_error)
        }),
        real("mean", "Mean.", &|column| column.moments.mean()),
        real("mean_standard_error", "Standard error of the mean.", &|column| column.mean_error),
        real("mean_lower", "Lower end of the interval of the mean.", &|column| column.mean_interval[0]),
        real("mean_upper", "Upper end of the interval of the mean.", &|column| column.mean_interval[1]),
        real("standard_deviation", "Standard deviation, with n - 1.", &|column| column.moments.standard_deviation()),
        real(
            "standard_deviation_standard_error",
            "Standard error of the standard deviation, for many independent runs.",
            &|column| column.mean_error.and(column.moments.standard_deviation_error()),
        ),
        real("standard_deviation_lower", "Lower end of the interval of the standard deviation.", &|column| {
            column.deviation_interval[0]
        }),
        real("standard_deviation_upper", "Upper end of the interval of the standard deviation.", &|column| {
            column.deviation_interval[1]
        }),
        text("mean_note", "What keeps the runs from telling mean and standard deviation.", &|column| {
            column.note.clone()
        }),
        real("skewness", "Skewness m_3/m_2^(3/2).", &|column| column.moments.skewness()),
        real("min", "Minimum.", &|column| column.moments.min()),
        real("max", "Maximum.", &|column| column.moments.max()),
    ]);
    let ps: Vec<f64> = columns.first().map_or(Vec::new(), |column| column.quantiles.iter().map(|one| one.p).collect());
    for (index, p) in ps.into_iter().enumerate() {
        let (name, percent) = (quantile_name(p), percent(p));
        let of = |get: &dyn Fn(&QuantileStatistic) -> Option<f64>, name: String, meaning: String| {
            real(&name, &meaning, &|column| column.quantiles.get(index).and_then(get))
        };
        table.extend([
            of(&|one| one.value, name.clone(), format!("{percent}% quantile (type 7).")),
            of(
                &|one| one.interval[0],
                format!("{name}_lower"),
                format!("Lower end of the interval of the {percent}% quantile."),
            ),
            of(
                &|one| one.interval[1],
                format!("{name}_upper"),
                format!("Upper end of the interval of the {percent}% quantile."),
            ),
            text(
                &format!("{name}_note"),
                &format!("What it takes to bound the {percent}% quantile, where there are too few runs."),
                &|column| column.quantiles.get(index).and_then(|one| one.note.clone()),
            ),
        ]);
    }
    table
}

/// `statistics` of `plan` as a file.
///
/// # Errors
/// Where encoding fails.
pub fn encoded(plan: &Plan, statistics: &Statistics) -> Result<Vec<u8>, EncodingError> {
    described_table::encoded(plan, &table(statistics))
}
