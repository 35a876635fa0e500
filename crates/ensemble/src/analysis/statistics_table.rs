//! `statistics.parquet`: one row per observable.

use crate::analysis::order_statistics::QuantileStatistic;
use crate::analysis::statistic::{STATISTICS, Statistic, Uncertainty};
use crate::analysis::statistics::{ColumnStatistics, Statistics};
use crate::run::Status;
use crate::statistics::quantile::percent;
use crate::table::Table;

/// The column of the `p`-quantile: `p99_9`.
pub fn quantile_name(p: f64) -> String {
    format!("p{}", percent(p).replace('.', "_"))
}

pub fn table(statistics: &Statistics) -> Table<'_> {
    let columns = &statistics.columns;
    let mut table = Table::of(columns);
    table
        .observable(|column| &column.quantity)
        .count("count", "Runs that are ok and have a value: those that the numbers are of.", |column| {
            column.moments.count()
        })
        .count("without_value", "Runs that are ok and have no value.", |column| column.without_value);
    for (status, number) in Status::ALL.into_iter().zip(statistics.statuses) {
        let meaning = format!("Samples that statistics are about and that ended with {}.", status.name());
        table.count(&format!("count_{}", status.name()), &meaning, |_| number);
    }
    table
        .text("failed_runs", "How runs that are not ok are treated.", |_| Some(statistics.treatment()))
        .text("intervals", "What the intervals are, or why there are none.", |_| {
            Some(statistics.population.intervals())
        })
        .real("confidence", "Confidence of the intervals.", |_| Some(statistics.confidence))
        .real(
            "quantile_error",
            "Bound of the error of quantiles, relative to their magnitude, or to their distance from the median of the \
             first runs where these are close together.",
            |_| Some(statistics.quantile_error),
        );
    for Statistic { name, words, meaning, value, uncertainty, .. } in &STATISTICS {
        if let Some(Uncertainty { error, error_meaning, interval }) = uncertainty {
            let end = |which: &str| format!("{which} end of the interval of the {words}.");
            table
                .real(name, meaning, value)
                .real(&format!("{name}_standard_error"), error_meaning, error)
                .real(&format!("{name}_lower"), &end("Lower"), |column| interval(column)[0])
                .real(&format!("{name}_upper"), &end("Upper"), |column| interval(column)[1]);
        }
    }
    table.text("mean_note", "What keeps the runs from telling mean and standard deviation.", |column| {
        column.note.as_deref()
    });
    for Statistic { name, meaning, value, .. } in STATISTICS.iter().filter(|one| one.uncertainty.is_none()) {
        table.real(name, meaning, value);
    }
    let ps: Vec<f64> = columns.first().map_or(Vec::new(), |column| column.quantiles.iter().map(|one| one.p).collect());
    for (index, p) in ps.into_iter().enumerate() {
        let (name, percent) = (quantile_name(p), percent(p));
        let of = |column: &ColumnStatistics, get: fn(&QuantileStatistic) -> Option<f64>| {
            column.quantiles.get(index).and_then(get)
        };
        let end = |which: &str| format!("{which} end of the interval of the {percent}% quantile.");
        table
            .real(&name, &format!("{percent}% quantile (type 7)."), |column| of(column, |one| one.value))
            .real(&format!("{name}_lower"), &end("Lower"), |column| of(column, |one| one.interval[0]))
            .real(&format!("{name}_upper"), &end("Upper"), |column| of(column, |one| one.interval[1]))
            .text(
                &format!("{name}_note"),
                &format!("What keeps the runs from bounding the {percent}% quantile."),
                |column| column.quantiles.get(index).and_then(|one| one.note.as_deref()),
            );
    }
    table.finish()
}
