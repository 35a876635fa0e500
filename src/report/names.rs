//! What names of columns mean to a reader of the page: which are errors, what they are called, which interval a quantile has.

use crate::run::Quantity;

/// The name of a column as words: `energy_error_max` is "maximum energy error"; the unit is left out.
pub fn words(quantity: &Quantity) -> String {
    let suffix = match quantity.unit() {
        "" => String::new(),
        "1/s" => "_per_s".to_owned(),
        unit => format!("_{}", unit.to_lowercase().replace([' ', '/'], "_").replace('^', "")),
    };
    let name = quantity.name().strip_suffix(suffix.as_str()).unwrap_or(quantity.name());
    // what a mission has at its launch, and when its phases began
    if let Some(stem) = name.strip_suffix("_launch") {
        return format!("{} at launch", stem.replace('_', " "));
    }
    if let Some(phase) = name.strip_prefix("phase_").and_then(|rest| rest.strip_suffix("_begin")) {
        return format!("time until phase {}", phase.replace('_', " "));
    }
    if let Some(stem) = name.strip_suffix("_total") {
        return format!("total {}", stem.replace('_', " "));
    }
    let (stem, statistic) = [
        ("_peak_to_peak", "peak-to-peak "),
        ("_max", "maximum "),
        ("_min", "minimum "),
        ("_mean", "mean "),
        ("_final", "final "),
        ("_rms", "rms "),
    ]
    .into_iter()
    .find_map(|(suffix, words)| Some((name.strip_suffix(suffix)?, words)))
    .unwrap_or((name, ""));
    let axis = [("_x", "s1"), ("_y", "s2"), ("_z", "s3")].into_iter();
    let mut of_rate = axis.filter_map(|(end, axis)| (stem == format!("omega_se_s{end}")).then_some(axis));
    if let Some(axis) = of_rate.next() {
        return format!("{statistic}angular velocity about {axis}");
    }
    let stem = stem.strip_prefix("exchange_").map_or(stem.to_owned(), |rest| format!("energy transfer of {rest}"));
    format!("{statistic}{}", stem.replace('_', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words() {
        let words = |name: &'static str, unit: &'static str| words(&Quantity::new(name, unit, "A column."));
        assert_eq!(words("energy_error_max", ""), "maximum energy error");
        assert_eq!(words("exchange_body_peak_to_peak_j", "J"), "peak-to-peak energy transfer of body");
        assert_eq!(words("angular_rate_max_rad_s", "rad/s"), "maximum angular rate");
        assert_eq!(words("omega_se_s_y_final_rad_s", "rad/s"), "final angular velocity about s2");
        assert_eq!(words("steps", ""), "steps");
        assert_eq!(words("pointing_error_launch_rad", "rad"), "pointing error at launch");
        assert_eq!(words("phase_coast_again_begin_s", "s"), "time until phase coast again");
        assert_eq!(words("impulse_total_n_s", "N s"), "total impulse");
    }
}
