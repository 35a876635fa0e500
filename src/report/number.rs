//! Numbers in text.

/// A number in at most eleven characters: four significant digits, whole numbers below 1e5 in full.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.3e}")
    } else if size == libm::floor(size) {
        format!("{value:.0}")
    } else {
        // of the rounded number: 99.999 is 100.0, not 100.00
        let rounded = format!("{size:.3e}").parse().unwrap_or(size);
        let before = libm::floor(libm::log10(rounded)) as i32;
        format!("{value:.*}", (3 - before).max(1) as usize)
    }
}

/// A size of files in decimal units.
pub fn bytes(size: u64) -> String {
    const UNITS: [&str; 5] = ["B", "kB", "MB", "GB", "TB"];
    let mut value = size as f64;
    let mut unit = 0;
    while value >= 1000.0 && unit + 1 < UNITS.len() {
        value /= 1000.0;
        unit += 1;
    }
    if unit == 0 { format!("{size} B") } else { format!("{value:.1} {}", UNITS[unit]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a number fits its column, whatever its magnitude.
    #[test]
    fn short_numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (1.234_567e-15, "1.235e-15"),
            (12.345_67, "12.35"),
            (4096.0, "4096"),
            (99.999, "100.0"),
            (0.999_99, "1.000"),
            (-1.5e300, "-1.500e300"),
        ] {
            assert_eq!(short(value), text);
        }
        for value in [f64::MIN, f64::MIN_POSITIVE, f64::NAN, f64::INFINITY] {
            assert!(short(value).len() <= 11, "{value:e}: {}", short(value));
        }
    }

    #[test]
    fn sizes_have_units() {
        assert_eq!([0, 999, 1000, 3_200_000].map(bytes), ["0 B", "999 B", "1.0 kB", "3.2 MB"]);
    }
}
