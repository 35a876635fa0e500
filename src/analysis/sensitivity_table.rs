//! `sensitivity.parquet`: what each input means for each observable, one row for each pair.

use crate::storage::columnar::EncodingError;

use crate::analysis::sensitivity::InputSensitivity;
use crate::campaign::Plan;
use crate::statistics::correlation::Estimate;
use crate::storage::described_table::{self, DescribedColumn};

/// A measure of sensitivity: name of its column, meaning, value.
type Measure = (&'static str, &'static str, fn(&InputSensitivity) -> Option<Estimate>);

/// A number of an estimate: suffix of its column, what it is, value.
type EstimatePart = (&'static str, &'static str, fn(Estimate) -> f64);

/// The estimate itself, and the ends of its interval.
const PARTS: [EstimatePart; 3] = [
    ("", "", |estimate| estimate.value),
    ("_lower", ": lower end of its interval", |estimate| estimate.lower),
    ("_upper", ": upper end of its interval", |estimate| estimate.upper),
];

/// The measures.
const MEASURES: [Measure; 8] = [
    (
        "influence",
        "How strongly the input acts, as a share of the variance: the total index, or the larger one of first-order index and squared rank correlation",
        InputSensitivity::influence,
    ),
    ("pearson", "Pearson's correlation coefficient", |one| one.pearson),
    ("spearman", "Spearman's rank correlation coefficient", |one| one.spearman),
    ("partial_rank", "Partial rank correlation coefficient, the other inputs held fixed", |one| one.partial_rank),
    ("regression", "Standardised regression coefficient", |one| one.regression),
    (
        "r_squared",
        "Share of the variance that the regression on all inputs explains, corrected for their number",
        |one| one.r_squared,
    ),
    ("first_order", "First-order sensitivity index, the share of the variance of this input alone", |one| {
        one.first_order
    }),
    ("total", "Total sensitivity index, with the interactions of this input", |one| one.total),
];

fn table(list: &[InputSensitivity]) -> Vec<DescribedColumn> {
    let text = |name: &str, meaning: &str, of: &dyn Fn(&InputSensitivity) -> Option<String>| {
        DescribedColumn::texts(name, meaning, list.iter().map(of))
    };
    let mut table = vec![
        text("observable", "Name of the observable.", &|one| Some(one.observable.clone())),
        text("input", "Column of the input; of a saltelli design what one distribution disperses.", &|one| {
            Some(one.input.clone())
        }),
        DescribedColumn::counts("rows", "Number of rows: the first that are ok.", list.iter().map(|one| one.rows)),
    ];
    for (name, meaning, of) in MEASURES {
        for (suffix, what, part) in PARTS {
            let values = list.iter().map(|one| of(one).map(part));
            table.push(DescribedColumn::numbers(&format!("{name}{suffix}"), &format!("{meaning}{what}."), values));
        }
    }
    table.extend([
        text("correlated_with", "The input that this one is most correlated with, where that is notable.", &|one| {
            one.correlated_with.as_ref().map(|(name, _)| name.clone())
        }),
        DescribedColumn::numbers(
            "largest_correlation",
            "Rank correlation of the two.",
            list.iter().map(|one| one.correlated_with.as_ref().map(|(_, r)| *r)),
        ),
        text("note", "What to know about these numbers.", &|one| one.note.clone()),
    ]);
    table
}

/// `list` of `plan` as a file.
///
/// # Errors
/// Where encoding fails.
pub fn encoded(plan: &Plan, list: &[InputSensitivity]) -> Result<Vec<u8>, EncodingError> {
    described_table::encoded(plan, &table(list))
}
