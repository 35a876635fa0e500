//! Comparisons of unit tests.

/// `found` is `expected` to less than the relative `error`.
#[track_caller]
pub fn near(found: f64, expected: f64, error: f64) {
    assert!((found / expected - 1.0).abs() < error, "{found}, expected {expected}");
}

/// `found` is `expected` to less than the absolute `error`.
#[track_caller]
pub fn close(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() < error, "{found}, expected {expected}");
}
