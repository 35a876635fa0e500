//! A comparison of two results as a table of observables.

use crate::analysis::comparison::{ColumnComparison, Comparison};
use crate::analysis::outcomes::unique;
use crate::table::Table;

pub fn table(comparison: &Comparison) -> Table<'_> {
    let rows = &comparison.columns;
    let mut table = Table::of(rows);
    table
        .observable(|row| &row.quantity)
        .count("is_required", "1 if a requirement of either plan names it.", |row| u64::from(row.is_required))
        .count("is_shifted", "1 if chance does not explain the difference.", |row| {
            u64::from(comparison.is_shifted(row))
        })
        .count(
            "is_moved",
            "1 if it is not shifted, and chance does not explain how the values of the pairs differ.",
            |row| u64::from(comparison.is_moved(row)),
        )
        .count(
            "is_absent",
            "1 if chance does not explain the difference between the shares of runs without a value.",
            |row| u64::from(comparison.is_changed(&row.absence)),
        )
        .real("absent_first", "Share of the ok runs of the first result that have no value.", |row| {
            Some(row.absence.shares()[0])
        })
        .real("absent_second", "The same of the second result.", |row| Some(row.absence.shares()[1]))
        .real("adjusted_p_value_absent", "P-value of these shares being the same, adjusted (Holm).", |row| {
            Some(row.absence.adjusted_p_value)
        })
        .real(
            "adjusted_p_value",
            "What decides whether it is shifted, adjusted for the number of observables (Holm).",
            |row| row.adjusted_p_value,
        )
        .real(
            "p_value",
            "Of pairs the p-value of the test of distributions, of independent samples twice the smaller one of both \
             tests.",
            |row| row.p_value,
        )
        .real("p_value_mean", "P-value of the test of means.", |row| Some(row.mean?.p_value))
        .real("p_value_distribution", "P-value of the test of distributions.", |row| row.distribution_p_value)
        .real("p_value_moved", "P-value of the signed ranks of the pairs' differences.", |row| row.moved_p_value)
        .real("p_value_spread", "P-value of one result spreading more than the other in the pairs.", |row| {
            row.spread_p_value
        })
        .real("adjusted_p_value_moved", "Twice the smaller one of these two, adjusted (Holm).", |row| {
            row.adjusted_moved_p_value
        })
        .real("mean_shift", "Shift of the mean, second minus first; of pairs, where there are any.", |row| {
            Some(row.mean?.shift.value)
        })
        .real("mean_shift_lower", "Lower end of its interval.", |row| Some(row.mean?.shift.lower))
        .real("mean_shift_upper", "Upper end of its interval.", |row| Some(row.mean?.shift.upper))
        .count("differing_pairs", "Pairs whose values differ.", |row| row.differing_pairs)
        .text("largest_shift_of", "The statistic with the largest shift.", |row| Some(&*row.largest()?.statistic))
        .real("largest_shift", "Its shift, in units of scale.", |row| Some(row.largest()?.relative))
        .real(
            "scale",
            "Standard deviation in the first result; where that is 0 the magnitude of its mean, or 1.",
            |row| Some(row.scale),
        );
    for statistic in unique(rows.iter().flat_map(|row| &row.shifts).map(|shift| shift.statistic.as_str())) {
        let name = statistic.replace([' ', '.'], "_");
        let of = |row: &ColumnComparison| row.shifts.iter().find(|shift| shift.statistic == statistic).cloned();
        table
            .real(&format!("{name}_first"), &format!("{statistic} in the first result."), |row| Some(of(row)?.first))
            .real(&format!("{name}_second"), &format!("{statistic} in the second result."), |row| {
                Some(of(row)?.second)
            });
    }
    table.finish()
}
