//! The one formatter of numbers. Texts are ASCII, as commands take them; pages convert minus signs and powers of ten
//! with [`typeset`].

use crate::campaign::ShownUnit;

/// Four significant digits, at most eleven characters; integers below 1e5 in full.
pub fn short(value: f64) -> String {
    significant(value, 4)
}

/// Three significant digits, for scanning; integers below 1e5 in full.
pub fn brief(value: f64) -> String {
    significant(value, 3)
}

/// `digits` significant digits; in scientific notation below 1e-3 and from 10^(`digits` + 1), at least 1e5. Smaller
/// integers in full.
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
        // of the rounded number: 99.999 becomes 100.0, not 100.00
        let before = in_powers.rsplit('e').next().and_then(|power| power.parse::<i32>().ok()).unwrap_or(0);
        format!("{value:.*}", (digits as i32 - 1 - before).max(0) as usize)
    }
}

/// The ends of an interval, rounded outward to `digits` significant digits. Integers below 1e5 are kept in full, as are
/// non-finite ends.
pub fn outward([low, high]: [f64; 2], digits: i32) -> [f64; 2] {
    let end = |value: f64, up: bool| {
        if value == 0.0 || !value.is_finite() {
            return value;
        }
        let size = value.abs();
        let place = libm::floor(libm::log10(size)) as i32 - digits + 1;
        rounded(value, if (1.0..1e5).contains(&size) { place.min(0) } else { place }, Some(up))
    };
    [end(low, false), end(high, true)]
}

/// As [`significant`], without trailing zeros.
pub fn trimmed(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (number, power) = text.split_at(text.find('e').unwrap_or(text.len()));
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.').to_owned() + power,
        false => text,
    }
}

/// As written in a file, integers without decimals.
pub fn written(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// In a readable unit: "90 s", "2 days".
pub fn time(seconds: f64) -> String {
    let shown = ShownUnit::own("s").of_time(seconds.abs(), Some(seconds));
    format!("{} {}", trimmed(shown.value(seconds), 6), shown.unit)
}

/// As [`time`], a long one that is no round number with three digits: "11.6 days".
pub fn duration(seconds: f64) -> String {
    const LONG: f64 = 1e5;
    let exact = time(seconds);
    if seconds < LONG || !exact.ends_with(" s") {
        return exact;
    }
    let shown = ShownUnit::own("s").of_time(seconds, None);
    format!("{} {}", trimmed(shown.value(seconds), 3), shown.unit)
}

/// "2 deg"; a pure number alone.
pub fn with_unit(number: impl core::fmt::Display, unit: &str) -> String {
    format!("{number} {unit}").trim_end().to_owned()
}

/// "1 run", "3 runs"; `thing` has a regular plural.
pub fn counted<C: core::fmt::Display + PartialEq + From<u8>>(count: C, thing: &str) -> String {
    format!("{count} {thing}{}", if count == C::from(1) { "" } else { "s" })
}

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

/// The decimal place of the last digit that a half-width supports: two digits of the half-width.
fn place_of(half_width: f64) -> i32 {
    libm::floor(libm::log10(half_width) + 1e-9) as i32 - 1
}

/// `value` rounded to a multiple of 10^`place`: up, down or to nearest; its own rounding error never moves it.
fn rounded(value: f64, place: i32, up: Option<bool>) -> f64 {
    let [times, over] = [-place, place].map(|power| libm::exp10(f64::from(power.max(0))));
    let (steps, mut whole) = (value * times / over, libm::round(value * times / over));
    if (steps - whole).abs() >= 1e-13 * steps.abs() {
        whole = up.map_or(whole, |up| if up { libm::ceil(steps) } else { libm::floor(steps) });
    }
    whole / times * over
}

/// `value` with its last digit at 10^`place`; in scientific notation if `largest` needs it.
fn at_place(value: f64, place: i32, largest: f64) -> String {
    // zero borrows its power: "0.0e-4" beside "1.3e-4"
    let size = if value == 0.0 { largest } else { value.abs() };
    let power = libm::floor(libm::log10(size) + 1e-12) as i32;
    let digits = (power - place).clamp(0, MOST_DIGITS - 1) as usize;
    if (1e-3..1e6).contains(&largest) && place > -12 {
        format!("{:.*}", (-place).max(0) as usize, value + 0.0)
    } else if value == 0.0 {
        format!("{:.digits$}e{power}", 0.0)
    } else {
        format!("{value:.digits$e}")
    }
}

const MOST_DIGITS: i32 = 15;
/// Extra digits for an estimate that would otherwise show as zero.
const MOST_MORE: i32 = 2;
/// If numbers of one sign without bounds differ by a larger ratio, each keeps its own digits.
const MOST_RATIO: f64 = 100.0;

/// An estimate and its interval to a common decimal place, as fine as the interval supports, ends rounded outward;
/// unknown ends (NaN) give `None`. No end is shown at one of the `bounds` unless it is exactly there; numbers without
/// bounds over several decades have three digits each.
fn interval_texts(value: f64, ends: [f64; 2], bounds: [f64; 2]) -> (String, [Option<String>; 2]) {
    let known: Vec<f64> = ends.into_iter().filter(|end| end.is_finite()).collect();
    let all = || known.iter().copied().chain([value]);
    let sizes = || all().map(f64::abs).filter(|size| *size > 0.0);
    let [least, most] = [sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max)];
    let is_free = bounds.iter().all(|bound| bound.is_nan());
    let is_wide = is_free && (all().all(|one| one >= 0.0) || all().all(|one| one <= 0.0)) && most > MOST_RATIO * least;
    let half = match known[..] {
        [low, high] => 0.5 * (high - low).abs(),
        [end] => (end - value).abs(),
        _ => 0.0,
    };
    if half == 0.0 || is_wide {
        let outward = outward(ends, 3);
        return (brief(value), outward.map(|end| end.is_finite().then(|| brief(end))));
    }
    let least_place = libm::floor(libm::log10(most)) as i32 + 1 - MOST_DIGITS;
    let shown = |place: i32| [0, 1].map(|which| rounded(ends[which], place, Some(which == 1)));
    let reaches = |place: i32| (0..2).any(|which| shown(place)[which] == bounds[which] && ends[which] != bounds[which]);
    // a one-sided bound supports three digits
    let coarsest = if known.len() == 1 { libm::floor(libm::log10(most)) as i32 - 2 } else { i32::MIN };
    let mut place = place_of(half).max(coarsest);
    while place > least_place && reaches(place) {
        place -= 1;
    }
    let own = libm::floor(libm::log10(value.abs()) + 1e-12);
    if rounded(value, place, None) == 0.0 && own >= f64::from(place - MOST_MORE) {
        place = own as i32;
    }
    let place = place.max(least_place);
    let text = |one: f64| one.is_finite().then(|| at_place(one, place, most));
    (at_place(rounded(value, place, None), place, most), shown(place).map(text))
}

/// "0.938 [0.901, 0.994]", with `?` for an unknown end; no brackets if both are unknown.
pub fn with_interval(value: f64, ends: [f64; 2]) -> String {
    bracketed(value, ends, [f64::NAN; 2], "")
}

fn bracketed(value: f64, ends: [f64; 2], bounds: [f64; 2], unit: &str) -> String {
    let (value, ends) = interval_texts(value, ends, bounds);
    if ends.iter().all(Option::is_none) {
        return format!("{value}{unit}");
    }
    let [low, high] = ends.map(|end| end.unwrap_or_else(|| "?".to_owned()));
    format!("{value}{unit} [{low}, {high}]")
}

/// A share in per cent with three digits, near 100 with enough to differ from it.
pub fn percent(share: f64) -> String {
    let left = 100.0 * (1.0 - share);
    if (1e-12..1.0).contains(&left) {
        format!("{:.*}", (-libm::floor(libm::log10(left))) as usize, 100.0 * share)
    } else {
        brief(100.0 * share)
    }
}

/// A share, or the range that missing runs leave open, with its interval: "98.40% [91.45, 99.96]".
pub fn share([least, most]: [f64; 2], interval: [f64; 2]) -> String {
    if least == most && interval.iter().any(|end| end.is_finite()) {
        return bracketed(100.0 * least, interval.map(|end| 100.0 * end), [0.0, 100.0], "%");
    }
    if least == most {
        return format!("{}%", percent(least));
    }
    let range = format!("{}% to {}%", percent(least), percent(most));
    if interval.iter().any(|end| !end.is_finite()) {
        return range;
    }
    let (_, ends) = interval_texts(50.0 * (least + most), interval.map(|end| 100.0 * end), [0.0, 100.0]);
    format!("{range} [{}]", ends.map(Option::unwrap_or_default).join(", "))
}

/// Three digits each, more if needed to separate different numbers.
pub fn apart<const N: usize>(values: [f64; N]) -> [String; N] {
    let texts = |digits: usize| values.map(|value| significant(value, digits));
    let is_apart = |digits: &usize| {
        let texts = texts(*digits);
        (0..N).all(|one| (0..one).all(|other| values[one] == values[other] || texts[one] != texts[other]))
    };
    texts((3..MOST_DIGITS as usize).find(is_apart).unwrap_or(3))
}

/// True minus signs and superscript powers of ten, for pages.
pub fn typeset(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let (mut out, mut at) = (String::with_capacity(text.len()), 0);
    let is_digit = |place: usize| letters.get(place).is_some_and(char::is_ascii_digit);
    while at < letters.len() {
        let before = at.checked_sub(1).map(|at| letters[at]);
        let is_power = letters[at] == 'e' && before.is_some_and(|letter| letter.is_ascii_digit());
        let sign = usize::from(letters.get(at + 1) == Some(&'-'));
        if is_power && is_digit(at + 1 + sign) {
            out += "\u{202f}\u{d7}\u{202f}10";
            at += 1;
            while at < letters.len() && (letters[at] == '-' || letters[at].is_ascii_digit()) {
                let digit = letters[at].to_digit(10);
                let digit = digit.and_then(|digit| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(digit as usize));
                out.push(digit.unwrap_or('⁻'));
                at += 1;
            }
            continue;
        }
        let is_minus = letters[at] == '-' && is_digit(at + 1) && before.is_none_or(|one| " [(=".contains(one));
        out.push(if is_minus { '\u{2212}' } else { letters[at] });
        at += 1;
    }
    out
}

/// Longest word that stays on the line of the number before it, as units do.
const MOST_JOINED: usize = 6;

/// No line break between a number and its unit, for texts of pages.
pub fn unbroken(text: &str) -> String {
    let mut words = text.split(' ');
    let mut last = words.next().unwrap_or_default();
    let mut out = last.to_owned();
    for word in words {
        // a name may end in a digit
        let is_joined = !last.starts_with(char::is_alphabetic)
            && out.ends_with(|letter: char| letter.is_numeric() || letter == ']')
            && word.chars().count() <= MOST_JOINED
            && word.starts_with(char::is_alphabetic)
            && word != "of";
        out += [" ", "\u{a0}"][usize::from(is_joined)];
        out += word;
        last = word;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: every number fits its column.
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

    /// Law: a rounded interval contains the original, by at most one unit of its last digit; rounding is idempotent.
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

    /// Law: a shown interval contains the original and is hardly wider, has a common decimal place with its estimate,
    /// and touches a bound only if the original does.
    #[test]
    fn shown_intervals_contain_theirs() {
        let decimals =
            |text: &str| text.split('e').next().and_then(|one| one.split_once('.')).map_or(0, |(_, d)| d.len());
        let (mut half, bounds) = (3e-10, [0.0, 100.0]);
        while half < 40.0 {
            for value in [50.0, 1.000_001_2 + half, 99.999 - half] {
                for ends in [[value - half, value + half], [value - half, value + 0.01 * half]] {
                    let (estimate, texts) = interval_texts(value, ends, bounds);
                    let texts = texts.map(|text| text.expect("an end"));
                    let shown = texts.each_ref().map(|text| text.parse::<f64>().expect("a number"));
                    assert!(
                        shown[0] <= ends[0] * (1.0 + 1e-13) && shown[1] >= ends[1] * (1.0 - 1e-13),
                        "{ends:?} {texts:?}"
                    );
                    assert!(shown[1] - shown[0] < 1.3 * (ends[1] - ends[0]) + 1e-12, "{ends:?} {texts:?}");
                    assert!(shown[0] > 0.0 && shown[1] < 100.0, "{ends:?} {texts:?}");
                    assert_eq!(texts.each_ref().map(|one| decimals(one)), [decimals(&estimate); 2], "{texts:?}");
                }
            }
            half *= 1.7;
        }
        for (value, ends, text) in [
            (0.938_1, [0.901_2, 0.993_6], "0.938 [0.901, 0.994]"),
            (1.000_001_2, [1.000_000_9, 1.000_001_52], "1.00000120 [1.00000090, 1.00000152]"),
            (3.0, [f64::NAN; 2], "3"),
            (2.0, [f64::NAN, 2.456], "2.00 [?, 2.46]"),
            (3.332_248e-16, [f64::NAN, 3.332_272e-16], "3.33e-16 [?, 3.34e-16]"),
            (4e-6, [-1.3e-4, 1.5e-4], "4e-6 [-1.30e-4, 1.50e-4]"),
            (4e-9, [-1.3e-4, 1.5e-4], "0.0e-4 [-1.3e-4, 1.5e-4]"),
            (-3.47, [-106.0, 173.0], "-3 [-106, 173]"),
            (12_345.6, [11_000.0, 14_000.0], "12300 [11000, 14000]"),
            (1.07e-13, [9.1e-14, 1.2e-13], "1.07e-13 [9.1e-14, 1.20e-13]"),
            (3e-12, [1e-15, 1.234e-9], "3.00e-12 [1.00e-15, 1.24e-9]"),
            (5.0, [5.0; 2], "5 [5, 5]"),
        ] {
            assert_eq!(with_interval(value, ends), text);
        }
        assert_eq!(share([0.984; 2], [0.914_6, 0.999_58]), "98.40% [91.46, 99.96]");
        assert_eq!(share([1.0; 2], [0.988, 1.0]), "100.00% [98.80, 100.00]");
        assert_eq!(share([0.003_34; 2], [0.000_084_6, 0.018_48]), "0.334% [0.008, 1.848]");
        assert_eq!(share([0.25, 0.98], [f64::NAN; 2]), "25% to 98%");
        let shares = [0.0, 0.95, 0.982, 0.005_027, 0.999_51, 0.999_987, 1.0 - 2e-9].map(percent);
        assert_eq!(shares, ["0", "95", "98.2", "0.503", "99.95", "99.999", "99.9999998"]);
    }

    /// Law: different neighbours differ in text; times take a readable unit if it is exact.
    #[test]
    fn neighbours_stay_apart() {
        assert_eq!(apart([1.000_001_2, 1.000_003_4, 2.0]), ["1.000001", "1.000003", "2"]);
        assert_eq!(apart([0.5, 0.5]), ["0.500", "0.500"]);
        assert_eq!([90.0, 7200.0, 172_800.0, 12_345.6].map(time), ["90 s", "2 h", "2 days", "12345.6 s"]);
        assert_eq!([12_345.6, 172_800.0, 1e6].map(duration), ["12345.6 s", "2 days", "11.6 days"]);
        assert_eq!(unbroken("2 deg/s, 3 [1, 4] N m, 3 of 5"), "2\u{a0}deg/s, 3 [1, 4]\u{a0}N m, 3 of 5");
        assert_eq!(unbroken("density_kg_m3 from s3 at"), "density_kg_m3 from s3 at");
        assert_eq!(typeset("-3e-13 [-4, 5-6]"), "\u{2212}3\u{202f}\u{d7}\u{202f}10⁻¹³ [\u{2212}4, 5-6]");
    }
}
