//! [`DispersionError`]: why dispersions cannot be drawn.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Table {
    /// Counted from zero, as below.
    Disperse(usize),
    Correlate(usize),
    Derive(usize),
    Design,
    Campaign,
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Table::Disperse(index) => write!(f, "disperse[{index}]"),
            Table::Correlate(index) => write!(f, "correlate[{index}]"),
            Table::Derive(index) => write!(f, "derive[{index}]"),
            Table::Design => f.write_str("design"),
            Table::Campaign => f.write_str("campaign"),
        }
    }
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{table}.{key}{}: must be {allowed}; {remedy}", .value.as_ref().map_or(" is missing".to_owned(),
    |value| format!(" = {value}")))]
pub struct DispersionError {
    pub table: Table,
    pub key: &'static str,
    /// `None` for a missing key.
    pub value: Option<String>,
    /// Follows `must be`.
    pub allowed: String,
    pub remedy: String,
}

pub type Result<T, E = DispersionError> = std::result::Result<T, E>;

pub const HAS_KEY: &str = "a key that the scene has";
pub const GIVE_KEY: &str =
    "give it a nominal value in its table (of debris: add a [debris] table), or disperse another key";

pub fn error(
    dispersion: usize,
    key: &'static str,
    value: impl Into<String>,
    allowed: impl Into<String>,
    remedy: impl Into<String>,
) -> DispersionError {
    error_of(Table::Disperse(dispersion), key, value, allowed, remedy)
}

pub fn error_of(
    table: Table,
    key: &'static str,
    value: impl Into<String>,
    allowed: impl Into<String>,
    remedy: impl Into<String>,
) -> DispersionError {
    DispersionError { table, key, value: Some(value.into()), allowed: allowed.into(), remedy: remedy.into() }
}
