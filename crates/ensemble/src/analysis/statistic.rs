//! [`STATISTICS`]: the statistics of every observable, besides quantiles, for files, summary, page and comparison.

use crate::analysis::statistics::ColumnStatistics;

pub struct Statistic {
    /// Column in files and key in the summary.
    pub name: &'static str,
    pub words: &'static str,
    /// Column head on the page.
    pub head: Option<&'static str>,
    pub meaning: &'static str,
    pub value: fn(&ColumnStatistics) -> Option<f64>,
    pub uncertainty: Option<Uncertainty>,
    pub is_compared: bool,
}

pub struct Uncertainty {
    pub error: fn(&ColumnStatistics) -> Option<f64>,
    pub error_meaning: &'static str,
    pub interval: fn(&ColumnStatistics) -> [Option<f64>; 2],
}

pub const STATISTICS: [Statistic; 5] = [
    Statistic {
        name: "mean",
        words: "mean",
        head: Some("mean"),
        meaning: "Mean.",
        value: |column| column.moments.mean(),
        uncertainty: Some(Uncertainty {
            error: |column| column.mean_error,
            error_meaning: "Standard error of the mean.",
            interval: |column| column.mean_interval,
        }),
        is_compared: true,
    },
    Statistic {
        name: "standard_deviation",
        words: "standard deviation",
        head: Some("std. dev."),
        meaning: "Standard deviation, with n - 1.",
        value: |column| column.moments.standard_deviation(),
        uncertainty: Some(Uncertainty {
            error: |column| column.mean_error.and(column.moments.standard_deviation_error()),
            error_meaning: "Standard error of the standard deviation, for many independent runs.",
            interval: |column| column.deviation_interval,
        }),
        is_compared: true,
    },
    Statistic {
        name: "skewness",
        words: "skewness",
        head: None,
        meaning: "Skewness m_3/m_2^(3/2).",
        value: |column| column.moments.skewness(),
        uncertainty: None,
        is_compared: false,
    },
    Statistic {
        name: "min",
        words: "minimum",
        head: Some("min"),
        meaning: "Minimum.",
        value: |column| column.moments.min(),
        uncertainty: None,
        is_compared: false,
    },
    Statistic {
        name: "max",
        words: "maximum",
        head: Some("max"),
        meaning: "Maximum.",
        value: |column| column.moments.max(),
        uncertainty: None,
        is_compared: false,
    },
];
