//! Numbers in text.

/// A number in four significant digits, at most eleven characters; whole numbers below 1e5 in full.
pub fn short(value: f64) -> String {
    significant(value, 4)
}

/// A number in three significant digits, for lines that are read at a glance; whole numbers below 1e5 in full.
pub fn brief(value: f64) -> String {
    significant(value, 3)
}

/// A number in so many significant digits; with a power of ten below 1e-3 and from the power on that has two digits more; smaller whole numbers in full.
pub fn significant(value: f64, digits: usize) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    let in_powers = format!("{value:.*e}", digits - 1);
    if !(1e-3..f64::max(1e5, libm::exp10((digits + 1) as f64))).contains(&size) {
        in_powers
    } else if size == libm::floor(size) {
        format!("{value:.0}")
    } else {
        // of the rounded number: 99.999 is 100.0, not 100.00
        let before = in_powers.rsplit('e').next().and_then(|power| power.parse::<i32>().ok()).unwrap_or(0);
        format!("{value:.*}", (digits as i32 - 1 - before).max(0) as usize)
    }
}

/// The ends of an interval, rounded away from its middle to so many significant digits: what is shown contains what was found. Whole numbers below 1e5 in
/// full; ends that are not finite stay.
pub fn outward([low, high]: [f64; 2], digits: i32) -> [f64; 2] {
    let rounded = |value: f64, up: bool| {
        if value == 0.0 || !value.is_finite() {
            return value;
        }
        let size = value.abs();
        let power = libm::floor(libm::log10(size)) as i32 - digits + 1;
        let power = if (1.0..1e5).contains(&size) { power.min(0) } else { power };
        let [times, over] = [-power, power].map(|power| libm::exp10(f64::from(power.max(0))));
        let steps = value * times / over;
        let whole = libm::round(steps);
        // not by its own rounding
        let steps = match (steps - whole).abs() < 1e-13 * steps.abs() {
            true => whole,
            false if up => libm::ceil(steps),
            false => libm::floor(steps),
        };
        steps / times * over
    };
    [rounded(low, false), rounded(high, true)]
}

/// The same without zeros at the end of its decimals.
pub fn trimmed(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (number, power) = text.split_at(text.find('e').unwrap_or(text.len()));
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.').to_owned() + power,
        false => text,
    }
}

/// A count with what is counted: "1 run", "3 runs". `thing` is regular.
pub fn counted<C: core::fmt::Display + PartialEq + From<u8>>(count: C, thing: &str) -> String {
    format!("{count} {thing}{}", if count == C::from(1) { "" } else { "s" })
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
        for (value, text) in [
            (0.0, "0"),
            (1_982.771_592_697, "1982.77"),
            (-0.012_345_678, "-0.0123457"),
            (1_234_567.8, "1234568"),
            (0.5, "0.5"),
            (3.0, "3"),
            (1.234_567_8e-9, "1.23457e-9"),
            (1e30, "1e30"),
            (-1.5e-4, "-1.5e-4"),
        ] {
            assert_eq!(trimmed(value, 6), text);
        }
        assert_eq!([0.909_3, 1094.4, 2174.2, 99_999.9].map(brief), ["0.909", "1094", "2174", "100000"]);
        for value in [f64::MIN, f64::MIN_POSITIVE, f64::NAN, f64::INFINITY] {
            assert!(short(value).len() <= 11, "{value:e}: {}", short(value));
        }
    }

    /// Law: what is shown of an interval contains it, and is at most a step of its last digit larger; what fits the digits stays.
    #[test]
    fn rounded_intervals_contain_theirs() {
        for (interval, digits, known) in [
            ([0.123_45, 0.123_45], 3, [0.123, 0.124]),
            ([-0.123_45, 0.5], 3, [-0.124, 0.5]),
            ([98.4, 98.4], 3, [98.4, 98.4]),
            ([12_345.2, 99_999.1], 3, [12_345.0, 100_000.0]),
            ([1.234_5e-13, 1.234_5e13], 3, [1.23e-13, 1.24e13]),
            ([0.0, f64::INFINITY], 3, [0.0, f64::INFINITY]),
        ] {
            let found = outward(interval, digits);
            let near = |found: f64, known: f64| found == known || (found / known - 1.0).abs() < 1e-12;
            assert!(near(found[0], known[0]) && near(found[1], known[1]), "{interval:?}: {found:?}");
            assert!(outward(found, digits) == found, "{found:?} is not rounded again");
        }
        assert!(outward([f64::NAN, 1.0], 3)[0].is_nan());
    }

    /// Law: one is one thing, and everything else, nothing too, are several.
    #[test]
    fn one_is_singular() {
        assert_eq!([0_usize, 1, 2, 11].map(|count| counted(count, "run")), ["0 runs", "1 run", "2 runs", "11 runs"]);
    }

    #[test]
    fn sizes_have_units() {
        assert_eq!([0, 999, 1000, 3_200_000].map(bytes), ["0 B", "999 B", "1.0 kB", "3.2 MB"]);
    }
}
