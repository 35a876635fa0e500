//! Whether the filters of a control loop know how large their errors are, in words.

use crate::analysis::statistics::{ColumnStatistics, Statistics};
use crate::findings::number::brief;

/// Normalised squares of estimation errors per degree of freedom have a median a little below 1 where the covariance of
/// a filter is right (that of chi-square with 6 degrees is 0.89). Above this one, errors are typically half as large
/// again as the filter says, or more.
const MOST: f64 = 2.0;

/// The end of the name of a column with normalised squares.
const COLUMN: &str = "_nees_final";

/// A line for each estimate whose errors are larger than the covariance of its filter says (Y. Bar-Shalom, X. R. Li &
/// T. Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 5.4); nothing where filters
/// are right, or the loop has none.
pub fn overconfident(statistics: &Statistics) -> Vec<String> {
    let of_column = |column: &ColumnStatistics| {
        column.quantity.name().strip_suffix(COLUMN)?;
        let median = column.quantiles.iter().find(|quantile| quantile.p == 0.5)?;
        sentence(column.quantity.meaning(), median.value?, median.interval[0])
    };
    statistics.columns.iter().filter_map(of_column).collect()
}

/// What a column with this `meaning` says by its `median`, whose interval begins at `lower`.
fn sentence(meaning: &str, median: f64, lower: Option<f64>) -> Option<String> {
    (median.is_finite() && lower.unwrap_or(median) > MOST).then(|| {
        format!("filter overconfident: {} typically end {} sigma off", estimate(meaning), brief(libm::sqrt(median)))
    })
}

/// Of what the column with this `meaning` has the normalised square.
fn estimate(meaning: &str) -> &str {
    let (_, rest) = meaning.split_once("estimation error of ").unwrap_or(("", meaning));
    let of = rest.split_once(" at the last tick").map_or(rest, |(of, _)| of);
    of.split_once(" (or").map_or(of, |(of, _)| of)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: errors that are typically more than 1.4 times what the covariance says are named, with their root; what
    /// these runs leave open is not.
    #[test]
    fn errors_beyond_the_covariance_are_named() {
        let meaning = "Normalised square of the estimation error of position and velocity at the last tick, over its \
            degrees of freedom.";
        let text = "filter overconfident: position and velocity typically end 3 sigma off";
        let said = |median, lower| sentence(meaning, median, lower);
        assert_eq!([said(9.0, Some(2.1)), said(9.0, None)], [Some(text.to_owned()), Some(text.to_owned())]);
        assert_eq!([said(9.0, Some(1.9)), said(1.9, None), said(f64::NAN, None)], [None, None, None]);
    }
}
