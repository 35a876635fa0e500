//! Units in values: `"5 deg/s"` or `"5 deg/s / 3"` for rad/s. Plain numbers are in the unit of the key.

use core::f64::consts::PI;

/// Unit, its SI unit, and its size there as a fraction.
const UNITS: &[(&str, &str, f64, f64)] = &[
    ("deg", "rad", PI, 180.0),
    ("arcmin", "rad", PI, 10_800.0),
    ("arcsec", "rad", PI, 648_000.0),
    ("mrad", "rad", 1.0, 1e3),
    ("rev", "rad", 2.0 * PI, 1.0),
    ("deg/s", "rad/s", PI, 180.0),
    ("deg/min", "rad/s", PI, 10_800.0),
    ("deg/h", "rad/s", PI, 648_000.0),
    ("mrad/s", "rad/s", 1.0, 1e3),
    ("rpm", "rad/s", PI, 30.0),
    ("rev/s", "rad/s", 2.0 * PI, 1.0),
    ("deg/sqrt(h)", "rad/sqrt(s)", PI, 10_800.0),
    ("arcsec/sqrt(s)", "rad/sqrt(s)", PI, 648_000.0),
    ("ms", "s", 1.0, 1e3),
    ("min", "s", 60.0, 1.0),
    ("h", "s", 3600.0, 1.0),
    ("day", "s", 86_400.0, 1.0),
    ("mm", "m", 1.0, 1e3),
    ("cm", "m", 1.0, 1e2),
    ("km", "m", 1e3, 1.0),
    ("mm/s", "m/s", 1.0, 1e3),
    ("cm/s", "m/s", 1.0, 1e2),
    ("km/s", "m/s", 1e3, 1.0),
    ("km/h", "m/s", 1.0, 3.6),
    ("km^3/s^2", "m^3/s^2", 1e9, 1.0),
    ("g", "kg", 1.0, 1e3),
    ("t", "kg", 1e3, 1.0),
    ("g/cm^3", "kg/m^3", 1e3, 1.0),
    ("kg cm^2", "kg m^2", 1.0, 1e4),
    ("g cm^2", "kg m^2", 1.0, 1e7),
    ("mN", "N", 1.0, 1e3),
    ("kN", "N", 1e3, 1.0),
    ("mN m", "N m", 1.0, 1e3),
    ("kN m", "N m", 1e3, 1.0),
    ("mA m^2", "A m^2", 1.0, 1e3),
    ("nT", "T", 1.0, 1e9),
    ("uT", "T", 1.0, 1e6),
    ("%", "1", 1.0, 1e2),
];

/// SI units without other names here.
const MORE: [&str; 13] = [
    "J",
    "W",
    "N s",
    "N m s",
    "Hz",
    "1/s",
    "m/s^2",
    "rad/s^2",
    "rad/sqrt(s)",
    "rad/s/sqrt(s)",
    "m/s/sqrt(s)",
    "1/(N m s)",
    "A m^2 s/T",
];

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    pub name: &'static str,
    /// Its SI unit.
    pub of: &'static str,
    /// Its size in the SI unit, as a fraction.
    pub size: [f64; 2],
}

pub(super) fn named(name: &str) -> Option<Unit> {
    let listed = UNITS.iter().find(|(unit, ..)| *unit == name);
    let listed = listed.map(|(name, of, numerator, denominator)| Unit { name, of, size: [*numerator, *denominator] });
    let si = || known(name).filter(|name| *name != "1").map(|name| Unit { name, of: name, size: [1.0; 2] });
    listed.or_else(si)
}

pub(super) fn names() -> impl Iterator<Item = &'static str> {
    let si = UNITS.iter().enumerate().filter(|(at, unit)| UNITS[..*at].iter().all(|other| other.1 != unit.1));
    let si = si.map(|(_, unit)| unit.1).filter(|name| *name != "1");
    UNITS.iter().map(|unit| unit.0).chain(si).chain(MORE)
}

pub(super) fn written(text: &str) -> Option<&'static str> {
    let (head, _) = factors(text);
    named(split(head).1).map(|unit| unit.name)
}

/// `unit`, if values can be written in it; "1" for a pure number.
pub(super) fn known(unit: &str) -> Option<&'static str> {
    let names = UNITS.iter().flat_map(|(name, si, ..)| [*name, *si]);
    if unit.is_empty() { Some("1") } else { names.chain(MORE).find(|name| *name == unit) }
}

/// The unit at the end of `key`; `1` without one.
pub fn in_name(key: &str) -> &'static str {
    const ENDINGS: [(&str, &str); 22] = [
        ("_m3_s2", "m^3/s^2"),
        ("_rad_s_sqrt_s", "rad/s/sqrt(s)"),
        ("_rad_sqrt_s", "rad/sqrt(s)"),
        ("_m_s_sqrt_s", "m/s/sqrt(s)"),
        ("_1_n_m_s", "1/(N m s)"),
        ("_n_m_s", "N m s"),
        ("_n_s", "N s"),
        ("_rad_s2", "rad/s^2"),
        ("_rad_s", "rad/s"),
        ("_kg_m3", "kg/m^3"),
        ("_kg_m2", "kg m^2"),
        ("_a_m2_s_t", "A m^2 s/T"),
        ("_a_m2", "A m^2"),
        ("_m_s", "m/s"),
        ("_n_m", "N m"),
        ("_rad", "rad"),
        ("_kg", "kg"),
        ("_n", "N"),
        ("_s", "s"),
        ("_m", "m"),
        ("_j", "J"),
        ("_t", "T"),
    ];
    ENDINGS.iter().find(|(ending, _)| key.ends_with(ending)).map_or("1", |(_, unit)| unit)
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UnitProblem {
    /// Follows "must be".
    pub allowed: String,
    pub remedy: String,
}

/// Accepts every unit.
pub(super) const UNKNOWN: &str = "";

/// The number of `text` in the SI unit `unit`; with [`UNKNOWN`], in the SI unit of the written one.
///
/// # Errors
/// The problem of the text.
pub(super) fn parsed(text: &str, unit: &str) -> Result<f64, UnitProblem> {
    let (head, factors) = factors(text.trim());
    let value = single(head, unit, !factors.is_empty())?;
    let apply =
        |value: f64, (is_quotient, factor): &(bool, f64)| if *is_quotient { value / factor } else { value * factor };
    let value = factors.iter().fold(value, apply);
    if value.is_finite() {
        return Ok(value);
    }
    Err(UnitProblem { allowed: allowed(unit), remedy: "do not divide by zero".to_owned() })
}

/// The quantity at the start of a text, and its factors and (`true`) divisors in order.
fn factors(text: &str) -> (&str, Vec<(bool, f64)>) {
    let (mut head, mut found) = (text.trim(), Vec::new());
    while let Some(at) = head.rfind(['*', '/'])
        && let Ok(factor) = head[at + 1..].trim().parse::<f64>()
    {
        found.push((head[at..].starts_with('/'), factor));
        head = head[..at].trim_end();
    }
    if let Some((factor, rest)) = head.split_once('*')
        && let Ok(factor) = factor.trim().parse()
    {
        found.push((false, factor));
        head = rest.trim_start();
    }
    found.reverse();
    (head, found)
}

fn split(text: &str) -> (&str, &str) {
    let end = text.char_indices().find(|(at, c)| !is_of_number(text, *at, *c)).map_or(text.len(), |(at, _)| at);
    (&text[..end], text[end..].trim())
}

/// [`parsed`] without arithmetic; `may_be_plain`: a unit is optional.
fn single(text: &str, unit: &str, may_be_plain: bool) -> Result<f64, UnitProblem> {
    let (number, written) = split(text);
    let problem = |remedy: String| Err(UnitProblem { allowed: allowed(unit), remedy });
    let Some(number) = number.parse::<f64>().ok().filter(|number| number.is_finite()) else {
        return problem(format!("write a number, or a number with its unit in quotes, {}", example(unit)));
    };
    if written.is_empty() && may_be_plain || written == unit {
        return Ok(number);
    }
    if written.is_empty() {
        return problem("write it without quotes, or add the unit".to_owned());
    }
    if let Some((_, of, numerator, denominator)) = UNITS.iter().find(|(name, ..)| *name == unit) {
        // an observable in a unit other than SI
        return single(text, of, false).map(|value| value * denominator / numerator);
    }
    let is_unknown = unit == UNKNOWN;
    match UNITS.iter().find(|(name, ..)| *name == written) {
        Some((_, of, numerator, denominator)) if *of == unit || is_unknown => Ok(number * numerator / denominator),
        Some((_, of, ..)) => problem(format!("{written} is a unit of other quantities ({of}); check key and unit")),
        None if is_unknown && UNITS.iter().any(|(_, of, ..)| *of == written) => Ok(number),
        None if UNITS.iter().any(|(_, of, ..)| *of == written) => {
            problem(format!("{written} is the unit of other quantities; check key and unit"))
        }
        None => problem(format!("{written:?} is not a known unit; {}", example(unit))),
    }
}

/// True if the character at `at` belongs to the leading number.
fn is_of_number(text: &str, at: usize, c: char) -> bool {
    match c {
        '0'..='9' | '.' | '+' | '-' | '_' => true,
        // an exponent, not a unit
        'e' | 'E' => text[at + 1..].starts_with(|next: char| next.is_ascii_digit() || next == '+' || next == '-'),
        _ => false,
    }
}

/// The units of values in the SI unit `unit`.
fn units(unit: &str) -> Vec<&str> {
    let own = Some(unit).filter(|unit| !["1", UNKNOWN].contains(unit));
    own.into_iter().chain(UNITS.iter().filter(|(_, of, ..)| *of == unit).map(|(name, ..)| *name)).collect()
}

fn allowed(unit: &str) -> String {
    match units(unit)[..] {
        [] => "a finite number".to_owned(),
        ref units => format!("a finite number, or one with a unit ({})", units.join(", ")),
    }
}

fn example(unit: &str) -> String {
    match UNITS.iter().find(|(_, of, ..)| *of == unit) {
        Some((name, ..)) => format!("such as \"5 {name}\""),
        None => "such as 5.0".to_owned(),
    }
}
