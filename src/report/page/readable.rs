//! Numbers as a person reads them: powers of ten with superscripts, thousands apart, SI prefixes.

use crate::findings::number::outward;
use crate::report::axis::superscript;

/// A number with three or four digits, below ten million with those before its point: 0.01234, 1.235 x 10^-13 with superscripts, 4,096, 6,971,002.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if value.is_nan() {
        "-".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "infinite".to_owned() } else { "-infinite".to_owned() }
    } else if size == 0.0 {
        "0".to_owned()
    } else if size == libm::floor(size) && size < 1e7 {
        let text = grouped(size as u64);
        if value < 0.0 { format!("-{text}") } else { text }
    } else if (1e-3..1e7).contains(&size) {
        let before = libm::floor(libm::log10(size)) as i32;
        let text = format!("{value:.*}", (3 - before).max(0) as usize);
        if !text.contains('.') {
            return number(libm::round(value));
        }
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let text = format!("{value:.2e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        format!("{digits}\u{202f}\u{d7}\u{202f}10{}", superscript(power.parse().unwrap_or(0)))
    }
}

/// An interval in brackets after its estimate, rounded outward to three digits: " [0.901, 0.994]"; nothing where neither end is known.
pub fn in_brackets(interval: [f64; 2]) -> String {
    if !interval.iter().any(|end| end.is_finite()) {
        return String::new();
    }
    let shown = |end: f64| if end.is_finite() { number(end) } else { "not bounded".to_owned() };
    let [low, high] = outward(interval, 3).map(shown);
    format!(" [{low}, {high}]")
}

/// A number with its unit.
pub fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        _ if unit.is_empty() || value.is_nan() => number(value),
        "%" => format!("{}%", number(value)),
        _ => format!("{}\u{a0}{}", number(value), raised(unit)),
    }
}

/// A unit whose powers are raised.
fn raised(unit: &str) -> String {
    unit.replace("^2", "\u{b2}").replace("^3", "\u{b3}")
}

/// A whole number with its thousands apart.
pub fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_in_brackets() {
        assert_eq!(in_brackets([0.901_2, 0.993_6]), " [0.901, 0.994]");
        assert_eq!(in_brackets([f64::NAN, 1.234e-13]), " [not bounded, 1.24\u{202f}\u{d7}\u{202f}10⁻¹³]");
        assert_eq!(in_brackets([f64::NAN; 2]), "");
    }

    #[test]
    fn numbers_are_readable() {
        for (value, text) in [
            (0.0, "0"),
            (4096.0, "4,096"),
            (-1_000_000.0, "-1,000,000"),
            (0.012_345, "0.01235"),
            (1.5, "1.5"),
            (70.123_4, "70.12"),
            (3_097.4, "3,097"),
            (6_971_002.3, "6,971,002"),
            (9_999_999.7, "1\u{202f}\u{d7}\u{202f}10⁷"),
            (1.234e-13, "1.23\u{202f}\u{d7}\u{202f}10⁻¹³"),
            (2e9, "2\u{202f}\u{d7}\u{202f}10⁹"),
            (f64::NAN, "-"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!((with_unit(3.5, "J"), with_unit(f64::NAN, "J")), ("3.5\u{a0}J".to_owned(), "-".to_owned()));
        assert_eq!([1, 999, 1000, 1_234_567].map(grouped), ["1", "999", "1,000", "1,234,567"]);
    }
}
