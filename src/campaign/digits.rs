//! Numbers in notes.

/// A number with four significant digits.
pub(super) fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if (1e-3..1e7).contains(&rounded.abs()) || rounded == 0.0 { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        for (value, text) in
            [(0.0, "0"), (8.753_52, "8.754"), (-3151.27, "-3151"), (572_957.8, "573000"), (1.234_56e-5, "1.235e-5")]
        {
            assert_eq!(digits(value), text);
        }
    }
}
