//! Measurements of run time against error as lines of text.

use std::fmt::Write as _;

use crate::ensemble::precision::{Deviation, Measurement, Setting, Skipped};

/// The names of the columns of [`line()`].
pub fn headline() -> String {
    format!(
        "{:<17} {:>9} {:>10} {:>11} {:>8} {:>9} {:>9} {:>9} {:>9}  {}\n",
        "method", "setting", "us/run", "runs/s", "steps", "rate", "attitude", "energy", "momentum", "notes"
    )
}

/// A measurement as a line, with its maximum errors.
pub fn line(measurement: &Measurement) -> String {
    let m = measurement;
    let error = |of: Option<Deviation>| of.map_or("-".to_owned(), |error| format!("{:.1e}", error.max));
    let mut line = format!(
        "{:<17} {:>9} {:>10} {:>11} {:>8.0} {:>9} {:>9} {:>9} {:>9}",
        m.method.name(),
        setting(m.setting),
        significant(1e6 * m.cpu[0]),
        significant(1.0 / m.cpu[0]),
        m.steps,
        error(m.rate),
        error(m.attitude),
        error(m.energy),
        error(m.momentum),
    );
    // writing to a String does not fail
    if m.runs[1] > 0 {
        let _ = write!(line, "  {} of {} runs failed", m.runs[1], m.runs[0]);
    }
    if m.repeats < 3 {
        let _ = write!(line, "  {} repetition{}", m.repeats, if m.repeats == 1 { "" } else { "s" });
    }
    line.push('\n');
    line
}

/// The settings that were not measured, with the reason; empty where all were.
pub fn omissions(skipped: &[Skipped], limit: f64) -> String {
    let mut text = String::new();
    let mut methods: Vec<_> = skipped.iter().map(|skipped| skipped.method).collect();
    methods.dedup();
    for method in methods {
        let of = || skipped.iter().filter(|skipped| skipped.method == method);
        let settings: Vec<String> = of().map(|skipped| setting(skipped.setting)).collect();
        let predicted = of().map(|skipped| skipped.predicted).fold(f64::INFINITY, f64::min);
        let _ = writeln!(
            text,
            "skipped: {} at {}: a pass over the samples would take {} s or more, the limit is {} s (--limit-s)",
            method.name(),
            settings.join(", "),
            significant(predicted),
            significant(limit),
        );
    }
    text
}

/// A tolerance or a step in one or two digits.
fn setting(setting: Setting) -> String {
    match setting {
        Setting::Tolerance(tolerance) => format!("{tolerance:.0e}"),
        Setting::Step(step) => format!("{step:.1e}s"),
    }
}

/// A positive number in three significant digits, without an exponent.
fn significant(value: f64) -> String {
    if !(value > 0.0 && value.is_finite()) {
        return format!("{value}");
    }
    let decimals = (2.0 - libm::floor(libm::log10(value))).clamp(0.0, 9.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagation::Method;

    #[test]
    fn numbers_are_short() {
        assert_eq!([0.012_34, 1.0, 123.4, 98_765.0].map(significant), ["0.0123", "1.00", "123", "98765"]);
    }

    /// Law: a setting that is not measured is named with the reason.
    #[test]
    fn omissions_are_named() {
        let skip = |setting| Skipped { method: Method::NullSpace, setting, predicted: 44.0 };
        let skipped = vec![skip(Setting::Tolerance(1e-11)), skip(Setting::Tolerance(1e-12))];
        let text = omissions(&skipped, 20.0);
        assert!(text.contains("null_space at 1e-11, 1e-12") && text.contains("44.0 s"), "{text}");
        assert_eq!(omissions(&[], 20.0), "");
    }
}
