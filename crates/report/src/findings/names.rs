//! Columns and parameters in words, for pages, figures and sentences. Files, tooltips and commands keep the technical
//! names.

use crate::campaign::{Plan, ShownUnit};
use crate::run::Quantity;
use crate::scene::Parameter;

/// Suffixes of columns for a statistic of a series, with the words before and after it.
const STATISTICS: [(&str, [&str; 2]); 9] = [
    ("_peak_to_peak", ["peak-to-peak ", ""]),
    ("_max", ["maximum ", ""]),
    ("_min", ["minimum ", ""]),
    ("_mean", ["mean ", ""]),
    ("_final", ["", " at the end"]),
    ("_initial", ["initial ", ""]),
    ("_rms", ["rms ", ""]),
    ("_net", ["net ", ""]),
    ("_gross", ["gross ", ""]),
];

/// Columns of a control loop that are durations; other `_time` columns are times of events.
const DURATIONS: [&str; 5] = ["settling_time", "mission_settling_time", "plume_time", "rod_saturated_time", "end_time"];

const SAID: [(&str, &str); 7] = [
    ("dcm ", "rotation matrix "),
    ("nees", "NEES"),
    ("q es ", "attitude quaternion "),
    ("ill conditioned", "ill-conditioned"),
    ("orthonormality", "orthonormality error"),
    ("torque saturated", "time at the limit of motor torque"),
    ("speed saturated", "time at the limit of wheel speed"),
];

/// `name` without its suffix for `unit`.
fn without_unit<'n>(name: &'n str, unit: &str) -> &'n str {
    let suffix = match unit {
        "" | "1" => return name,
        "1/s" => "_per_s".to_owned(),
        unit => format!("_{}", unit.to_lowercase().replace([' ', '/'], "_").replace('^', "")),
    };
    name.strip_suffix(suffix.as_str()).unwrap_or(name)
}

/// `energy_error_max` becomes "maximum energy error"; the unit is dropped.
pub fn of_quantity(quantity: &Quantity) -> String {
    of_column(quantity.name(), quantity.unit())
}

pub fn title(quantity: &Quantity) -> String {
    sentence(&of_quantity(quantity))
}

/// The extreme of a quantity: "largest pointing error" for "highest pointing error".
pub fn of_extreme(name: &str, is_low: bool) -> String {
    let (side, said) = match is_low {
        true => ("smallest", ["lowest ", "minimum ", "smallest "]),
        false => ("largest", ["highest ", "maximum ", "largest "]),
    };
    format!("{side} {}", said.into_iter().find_map(|word| name.strip_prefix(word)).unwrap_or(name))
}

/// As [`of_quantity`], for the column `name` in `unit`.
pub fn of_column(name: &str, unit: &str) -> String {
    let name = without_unit(name, unit);
    let text = of_stem(name);
    SAID.iter().fold(text, |text, (written, said)| text.replace(written, said))
}

fn of_stem(name: &str) -> String {
    let spoken = |stem: &str| stem.replace('_', " ");
    // extremes within a window
    for end in ["highest", "lowest"] {
        if let Some((window, stem)) = name.strip_prefix(end).and_then(window_of) {
            return format!("{end} {}{window}", of_stem(stem));
        }
    }
    // mission state at launch, start of phases
    if let Some(stem) = name.strip_suffix("_launch") {
        return format!("{} at launch", spoken(stem));
    }
    if let Some(phase) = name.strip_prefix("phase_").and_then(|rest| rest.strip_suffix("_begin")) {
        return format!("time until phase {}", spoken(phase));
    }
    if let Some(event) = name.strip_suffix("_time").filter(|_| !DURATIONS.contains(&name)) {
        return format!("time until {}", spoken(event));
    }
    if let Some(stem) = name.strip_suffix("_total") {
        return format!("total {}", spoken(stem));
    }
    let found = STATISTICS.iter().find_map(|(suffix, words)| Some((name.strip_suffix(suffix)?, *words)));
    let (stem, [before, after]) = found.unwrap_or((name, ["", ""]));
    format!("{before}{}{after}", of_series(stem))
}

/// Splits `_from_120_s_to_600_s_pointing_error` into " from 120 s to 600 s" and `pointing_error`; `None` without a
/// window.
fn window_of(text: &str) -> Option<(String, &str)> {
    let (mut window, mut rest) = (String::new(), text);
    for word in ["from", "to"] {
        let of = rest.strip_prefix(&format!("_{word}_")).and_then(|rest| rest.split_once("_s_"));
        let is_time = |text: &str| text.starts_with(|letter: char| letter == 'm' || letter.is_ascii_digit());
        if let Some((time, after)) = of.filter(|(time, _)| is_time(time)) {
            window += &format!(" {word} {} s", time.replace('p', ".").replace('m', "-"));
            rest = &text[text.len() - after.len() - 1..];
        }
    }
    (!window.is_empty()).then(|| (window, &rest[1..]))
}

fn of_series(stem: &str) -> String {
    let spoken = |stem: &str| stem.replace('_', " ");
    let owner = |of: &str| if ["body", "debris"].contains(&of) { format!("the {of}") } else { spoken(of) };
    let mut axes = [("_x", "s1"), ("_y", "s2"), ("_z", "s3")].into_iter();
    if let Some((_, axis)) = axes.find(|(end, _)| stem == format!("omega_se_s{end}")) {
        return format!("angular velocity about {axis}");
    }
    if let Some(of) = stem.strip_prefix("exchange_") {
        let ends = [("_fraction", "fraction of "), ("_power", "power of "), ("_correlation", "correlation of ")];
        let end = ends.iter().find_map(|(end, words)| Some((of.strip_suffix(end)?, *words)));
        let (of, what) = end.unwrap_or((of, ""));
        return match of {
            "frequency" => "frequency of the energy transfer".to_owned(),
            of => format!("{what}energy transfer of {}", owner(of)),
        };
    }
    let (stem, about) = match stem.strip_prefix("energy_com_") {
        Some(of) => (format!("energy_{of}"), " about the centre of mass"),
        None => (stem.to_owned(), ""),
    };
    let energy = match stem.strip_prefix("energy_") {
        Some("total") => "total energy".to_owned(),
        Some(of) if !of.starts_with("error") => format!("energy of {}", owner(of)),
        _ => spoken(&stem),
    };
    format!("{energy}{about}")
}

/// "initial angular velocity y", "wheel w1 rate", "thruster p2 thrust scale".
pub fn of_component(parameter: Parameter, component: usize) -> String {
    let text = of_parameter(parameter);
    match parameter.components()[component] {
        "" => text,
        suffix => format!("{text} {suffix}"),
    }
}

pub fn of_parameter(parameter: Parameter) -> String {
    let name = parameter.name();
    let words: Vec<&str> = without_unit(&name, parameter.unit()).split('.').collect();
    let said = match words[..] {
        ["body", "parts", owner, key] => [owner, key].join(" "),
        ["wheels", owner, key] => ["wheel", owner, key].join(" "),
        ["thrusters", owner, key] => ["thruster", owner, key].join(" "),
        ["sensors", owner, key] => [owner, key].join(" "),
        ["guidance", owner, key] => ["phase", owner, key].join(" "),
        ["actuation", owner, key] => ["arc", owner, key].join(" "),
        ["failure", owner, "at"] => format!("time of failure of {owner}"),
        ["control", key] => key.to_owned(),
        _ => words.join(" "),
    };
    said.replace('_', " ")
}

/// The index of the dispersed number with this `column`.
pub fn place_of(plan: &Plan, column: &str) -> Option<usize> {
    plan.dispersions.columns().iter().position(|one| one.parameter.column_name(one.component) == column)
}

pub fn of_input(plan: &Plan, place: usize) -> String {
    let column = &plan.dispersions.columns()[place];
    of_component(column.parameter, column.component)
}

/// The dispersed number with this `column`, or the parameter whose components share one distribution; other columns in
/// their own words.
pub fn of_input_column(plan: &Plan, column: &str) -> String {
    if let Some(place) = place_of(plan, column) {
        return of_input(plan, place);
    }
    let (key, component) = column.rsplit_once('.').unwrap_or((column, ""));
    let mut columns = plan.dispersions.columns().iter().map(|one| (one.parameter, one.parameter.name()));
    let found = columns.find(|(_, name)| name == column || name == key);
    found.map_or_else(
        || of_column(column, ""),
        |(parameter, name)| {
            let of = of_parameter(parameter);
            if name == column { of } else { format!("{of} {component}") }
        },
    )
}

/// The unit shown for the dispersed number at `place`.
pub fn unit_of_input(plan: &Plan, place: usize) -> ShownUnit {
    let parameter = plan.dispersions.columns()[place].parameter;
    plan.analysis.display.of(&parameter.name(), own_unit(parameter))
}

pub fn own_unit(parameter: Parameter) -> &'static str {
    if parameter.unit() == "1" { "" } else { parameter.unit() }
}

/// Capitalises the first letter.
pub fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words() {
        for (name, unit, words) in [
            ("energy_error_max", "", "maximum energy error"),
            ("exchange_body_peak_to_peak_j", "J", "peak-to-peak energy transfer of the body"),
            ("exchange_w1_power_max_w", "W", "maximum power of energy transfer of w1"),
            ("exchange_frequency_hz", "Hz", "frequency of the energy transfer"),
            ("energy_com_total_initial_j", "J", "initial total energy about the centre of mass"),
            ("energy_error_rate_per_s", "1/s", "energy error rate"),
            ("omega_se_s_y_final_rad_s", "rad/s", "angular velocity about s2 at the end"),
            ("q_es_w_final", "", "attitude quaternion w at the end"),
            ("pointing_error_launch_rad", "rad", "pointing error at launch"),
            ("phase_coast_again_begin_s", "s", "time until phase coast again"),
            ("impulse_total_n_s", "N s", "total impulse"),
            ("settling_time_s", "s", "settling time"),
            ("torque_saturated_s", "s", "time at the limit of motor torque"),
            ("detumbled_time_s", "s", "time until detumbled"),
            ("highest_from_120_s_to_600_s_pointing_error_rad", "rad", "highest pointing error from 120 s to 600 s"),
            ("lowest_to_1p5_s_energy_body_j", "J", "lowest energy of the body to 1.5 s"),
        ] {
            assert_eq!(of_column(name, unit), words);
        }
    }

    /// Known: parameters of body, part, wheel and thruster, with components.
    #[test]
    fn parameters_become_words() {
        let of = |name: &str| {
            let plan = crate::findings::shipped::plan(name);
            (0..plan.dispersions.columns().len()).map(|place| of_input(&plan, place)).collect::<Vec<_>>()
        };
        let (spin, launch) = (of("spin_sweep"), of("net_launch"));
        for (names, known) in [
            (&spin, "initial angular velocity y"),
            (&spin, "wheel w1 rate"),
            (&spin, "fuselage wall thickness"),
            (&launch, "thruster p2 thrust scale"),
            (&launch, "thruster p1 tilt 1"),
            (&launch, "body center offset x"),
        ] {
            assert!(names.iter().any(|name| name == known), "{known}: {names:?}");
        }
    }
}
