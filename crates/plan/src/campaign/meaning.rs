//! [`meant`]: the likely meaning of an unknown name: a misspelling, a key with another unit, or a name from another
//! program.

use super::units;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meant<'a> {
    pub name: &'a str,
    change: Change,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    None,
    Unit(&'static str),
    /// Another quantity, with the conversion.
    Converted(&'static str),
}

impl Meant<'_> {
    /// The remedy for a key with this value as written.
    pub fn remedy_of_key(&self, value: &str) -> String {
        let name = self.name;
        match self.change {
            Change::None => format!("did you mean {name}?"),
            Change::Unit(unit) if value.parse::<f64>().is_ok() => format!("write {name} = \"{value} {unit}\""),
            Change::Unit(unit) => format!("write {name}, with the unit in each value, as in \"1 {unit}\""),
            Change::Converted(how) => format!("write {name}: {how}"),
        }
    }

    /// The remedy for a name that is a value.
    pub fn remedy(&self) -> String {
        let name = self.name;
        match self.change {
            Change::None => format!("did you mean {name:?}?"),
            Change::Unit(unit) => {
                format!("did you mean {name:?}? Values that belong to it may be in {unit}: \"1 {unit}\"")
            }
            Change::Converted(how) => format!("name {name:?}: {how}"),
        }
    }
}

/// Names of other programs, without units; the name here; the conversion, empty for equal numbers. A name matches only
/// in tables that have the key.
const OTHERS: &[(&[&str], &str, &str)] = &[
    (
        &["mean_anomaly", "mean_anomaly_at_epoch"],
        "true_anomaly_rad",
        "the mean anomaly M is another angle: solve E - e sin E = M for E, then tan(true anomaly / 2) = sqrt((1 + e) / \
         (1 - e)) tan(E / 2); they are equal where eccentricity is 0",
    ),
    (
        &["eccentric_anomaly"],
        "true_anomaly_rad",
        "the eccentric anomaly E is another angle: tan(true anomaly / 2) = sqrt((1 + e) / (1 - e)) tan(E / 2)",
    ),
    (
        &["argument_of_latitude"],
        "true_anomaly_rad",
        "it is the argument of latitude less argument_of_periapsis_rad, which a circular orbit leaves out",
    ),
    (
        &["true_longitude"],
        "true_anomaly_rad",
        "it is the true longitude less ascending_node_rad and argument_of_periapsis_rad",
    ),
    (
        &["mean_longitude", "mean_argument_of_latitude"],
        "true_anomaly_rad",
        "less argument_of_periapsis_rad (and ascending_node_rad, of a longitude) it is the mean anomaly M: solve \
         E - e sin E = M, then tan(true anomaly / 2) = sqrt((1 + e) / (1 - e)) tan(E / 2)",
    ),
    (&["raan", "right_ascension_of_ascending_node", "right_ascension", "node"], "ascending_node_rad", ""),
    (
        &["longitude_of_ascending_node", "lan", "longitude"],
        "ascending_node_rad",
        "it is measured from e1, fixed in space: to a longitude on the turning Earth add Greenwich sidereal time",
    ),
    (
        &["ltan", "local_time_of_ascending_node"],
        "ascending_node_rad",
        "it is the right ascension of the mean Sun plus 15 deg for each hour of local time after noon",
    ),
    (&["argument_of_perigee", "arg_perigee", "argp", "aop"], "argument_of_periapsis_rad", ""),
    (
        &["longitude_of_periapsis", "longitude_of_perigee"],
        "argument_of_periapsis_rad",
        "it is the longitude of the periapsis less ascending_node_rad",
    ),
    (&["sma", "semimajor_axis"], "semi_major_axis_m", ""),
    (&["ecc"], "eccentricity", ""),
    (&["inc", "incl"], "inclination_rad", ""),
    (
        &["altitude", "height", "orbit_altitude"],
        "semi_major_axis_m",
        "of a circular orbit it is body_radius_m (6378137 m for the Earth) plus the altitude",
    ),
    (
        &[
            "perigee_altitude",
            "apogee_altitude",
            "altitude_of_perigee",
            "altitude_of_apogee",
            "periapsis_altitude",
            "apoapsis_altitude",
            "perigee_height",
            "apogee_height",
            "perigee",
            "apogee",
        ],
        "semi_major_axis_m",
        "it is body_radius_m plus the mean of the altitudes of perigee and apogee; eccentricity is half of their \
         difference over semi_major_axis_m",
    ),
    (
        &[
            "perigee_radius",
            "apogee_radius",
            "radius_of_perigee",
            "radius_of_apogee",
            "periapsis_radius",
            "apoapsis_radius",
            "radius_of_periapsis",
            "radius_of_apoapsis",
        ],
        "semi_major_axis_m",
        "it is the mean of the radii of periapsis and apoapsis; eccentricity is half of their difference over it",
    ),
    (
        &["semi_latus_rectum", "semilatus_rectum"],
        "semi_major_axis_m",
        "it is the semi-latus rectum over 1 - eccentricity^2",
    ),
    (&["period", "orbital_period"], "semi_major_axis_m", "it is the cube root of mu_m3_s2 (period / (2 pi))^2"),
    (&["mean_motion"], "semi_major_axis_m", "it is the cube root of mu_m3_s2 / (mean motion in rad/s)^2"),
    (&["diameter"], "radius_m", "it is half of the diameter"),
    (&["outer_diameter", "diameter"], "outer_radius_m", "it is half of the diameter"),
    (&["inner_radius", "inner_diameter"], "wall_thickness_m", "it is outer_radius_m less the inner radius"),
    (&["height"], "length_m", ""),
    (&["spin_inertia"], "axial_inertia_kg_m2", ""),
    (&["radial_inertia"], "transverse_inertia_kg_m2", ""),
    (&["max_torque"], "torque_limit_n_m", ""),
    (&["max_speed", "max_rate"], "speed_limit_rad_s", ""),
    (
        &["max_momentum", "momentum_capacity", "momentum_limit"],
        "speed_limit_rad_s",
        "it is the largest momentum over axial_inertia_kg_m2",
    ),
    (&["speed", "initial_speed", "initial_rate"], "rate_rad_s", ""),
    (&["momentum", "initial_momentum"], "rate_rad_s", "it is the momentum over axial_inertia_kg_m2"),
    (&["thrust", "max_force"], "max_thrust_n", ""),
    (&["quaternion"], "attitude", "[w, x, y, z], the scalar first, turns vectors of the spacecraft into F_e"),
    (
        &["euler_angles", "roll_pitch_yaw", "mrp", "rotation_vector", "dcm"],
        "attitude",
        "it is the quaternion [w, x, y, z] of this rotation, the scalar first, from the spacecraft to F_e",
    ),
    (&["omega", "body_rates", "rates", "angular_rate"], "angular_velocity_rad_s", ""),
    (
        &["angular_momentum"],
        "angular_velocity_rad_s",
        "it is the inverse of the inertia tensor times the angular momentum, less that of the wheels",
    ),
    (&["sigma", "stdev", "std_dev", "standard_deviation"], "std", ""),
    (&["variance"], "std", "it is the square root of the variance"),
    (&["mean"], "std", "the mean is the nominal value, which stands at the parameter's own key"),
    (&["width", "full_width", "range"], "half_width", "it is half of the width"),
    (&["field_of_view", "fov"], "half_field_of_view_rad", "it is half of the field of view"),
    (&["cone_angle", "full_angle", "angle"], "half_angle_rad", "it is half of the full angle of the cone"),
    (&["frequency", "sample_rate", "update_rate", "rate_hz"], "period_s", "it is one over the frequency"),
    (&["bandwidth_hz", "frequency_hz", "natural_frequency_hz"], "bandwidth_rad_s", "it is 2 pi times the frequency"),
    (&["natural_frequency"], "bandwidth_rad_s", ""),
    (&["dt", "time_step", "step_size"], "step_s", ""),
    (&["dt", "time_step"], "period_s", ""),
    (&["duration", "length"], "end_s", "it is start_s plus the duration"),
    (&["stop_time", "end_time", "t_end", "final_time"], "duration_s", ""),
    (&["runs", "trials", "n"], "samples", "the nominal run is one of them"),
];

/// Keys in the unit of the parameter or column that their table is about.
const OF_THE_SUBJECT: [&str; 16] = [
    "std",
    "three_sigma",
    "half_width",
    "min",
    "max",
    "mode",
    "median",
    "offset",
    "scale",
    "lower",
    "upper",
    "value",
    "values",
    "at_most",
    "at_least",
    "between",
];

/// Words for units at the end of a key.
const UNIT_WORDS: [(&str, &str); 12] = [
    ("degrees", "deg"),
    ("degree", "deg"),
    ("degrees_s", "deg/s"),
    ("deg_per_s", "deg/s"),
    ("dps", "deg/s"),
    ("minutes", "min"),
    ("hours", "h"),
    ("hour", "h"),
    ("hr", "h"),
    ("days", "day"),
    ("kilometers", "km"),
    ("percent", "%"),
];

/// The stem of `key` and the unit at its end.
fn unit_in(key: &str) -> Option<(&str, &'static str)> {
    let stem = |ending: &str| key.strip_suffix(ending)?.strip_suffix('_');
    let as_ending = |unit: &str| unit.to_lowercase().replace(['/', ' ', '('], "_").replace(['^', ')'], "");
    let words = UNIT_WORDS.iter().map(|(word, unit)| ((*word).to_owned(), *unit));
    let endings = words.chain(units::names().map(|unit| (as_ending(unit), unit)));
    let found = endings.filter_map(|(ending, unit)| Some((stem(&ending)?, unit)));
    // the longest ending: `_deg_s` before `_s`
    found.min_by_key(|(stem, _)| stem.len())
}

/// Longer names, bytes, are not compared: comparison takes time proportional to the product of the lengths.
const LONGEST_NAME: usize = 300;

/// The candidate that `written` probably means.
pub fn meant<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<Meant<'a>> {
    let is_short = |name: &&str| name.len() <= LONGEST_NAME && written.len() <= LONGEST_NAME;
    let candidates: Vec<&str> = candidates.into_iter().filter(is_short).collect();
    let (table, key) = written.rsplit_once('.').unwrap_or(("", written));
    let of_table =
        |name: &str| candidates.iter().copied().find(|c| c.rsplit_once('.').unwrap_or(("", c)) == (table, name));
    let stem = unit_in(key).map_or(key, |(stem, _)| stem);
    let other = || {
        OTHERS.iter().find_map(|(names, here, how)| {
            let name = names.iter().any(|name| *name == key || *name == stem).then(|| of_table(here))??;
            let unit = unit_in(key).map(|(_, unit)| unit).filter(|unit| is_other_unit(name, unit));
            Some(match (how.is_empty(), unit) {
                (true, Some(unit)) => Meant { name, change: Change::Unit(unit) },
                (true, None) => Meant { name, change: Change::None },
                (false, _) => Meant { name, change: Change::Converted(how) },
            })
        })
    };
    let in_unit = || {
        let (stem, unit) = unit_in(written)?;
        let is_same = |c: &&str| match unit_in(c) {
            Some((other, _)) => other == stem && is_other_unit(c, unit),
            None => *c == stem && OF_THE_SUBJECT.contains(c),
        };
        let name = candidates.iter().copied().find(is_same)?;
        Some(Meant { name, change: Change::Unit(unit) })
    };
    let named = |name| Meant { name, change: Change::None };
    let by_a_letter = || candidates.iter().find(|candidate| changes(written, candidate) < 2).copied().map(named);
    let near = || misspelt(written, &candidates).map(named);
    in_unit().or_else(by_a_letter).or_else(other).or_else(near)
}

/// True if `unit` differs from the unit at the end of `name` but has its dimension.
fn is_other_unit(name: &str, unit: &str) -> bool {
    let own = units::in_name(name);
    unit != own && units::named(unit).is_some_and(|unit| unit.of == own)
}

/// The misspelt candidate: one that contains `written`, else the nearest, with at most a third of the letters changed.
fn misspelt<'a>(written: &str, candidates: &[&'a str]) -> Option<&'a str> {
    // an unfinished name: the shortest completion
    let begun = candidates.iter().filter(|c| written.len() > 3 && c.starts_with(written));
    if let Some(whole) = begun.min_by_key(|c| c.len()) {
        return Some(whole);
    }
    let close = candidates
        .iter()
        .map(|candidate| (changes(written, candidate), *candidate))
        .filter(|(_, candidate)| !is_another_word(written, candidate))
        .min_by_key(|(changes, _)| *changes)
        .filter(|(changes, candidate)| *changes <= (own_part(written, candidate) / 3).max(2))
        .map(|(_, candidate)| candidate);
    // not for one or two letters, which mean nothing
    close.or_else(|| {
        let is_within = |c: &&&str| written.len() > 3 && (c.contains(written) || written.contains(**c));
        candidates.iter().find(is_within).copied()
    })
}

/// Letters of `written` outside the table that it shares with `candidate`.
fn own_part(written: &str, candidate: &str) -> usize {
    let shared =
        written.rsplit_once('.').filter(|(table, _)| candidate.rsplit_once('.').is_some_and(|c| c.0 == *table));
    shared.map_or(written, |(_, key)| key).chars().count()
}

/// True if a word of `written` is exchanged for one that it does not misspell: `min` for `max`, `inner` for `outer`.
fn is_another_word(written: &str, candidate: &str) -> bool {
    let words = |name: &str| name.split(['_', '.']).map(str::to_owned).collect::<Vec<_>>();
    let (written, candidate) = (words(written), words(candidate));
    let is_misspelt = |a: &String, b: &String| {
        let least = a.chars().count().min(b.chars().count());
        changes(a, b) <= (least / 3).max(1) && changes(a, b) < least.max(1)
    };
    let lacks = |of: &[String], from: &[String]| {
        of.iter().any(|word| !from.iter().any(|other| other == word || is_misspelt(word, other)))
    };
    lacks(&written, &candidate) && lacks(&candidate, &written)
}

/// Edit distance with exchanges of neighbours (optimal string alignment; Damerau 1964).
fn changes(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let first: Vec<usize> = (0..=b.len()).collect();
    let (mut before, mut row) = (first.clone(), first);
    for (i, x) in a.iter().enumerate() {
        let mut next = vec![i + 1; b.len() + 1];
        for (j, y) in b.iter().enumerate() {
            next[j + 1] = (row[j] + usize::from(x != y)).min(row[j + 1] + 1).min(next[j] + 1);
            let is_exchanged = i > 0 && j > 0 && a[i - 1] == *y && b[j - 1] == *x && x != y;
            if is_exchanged {
                next[j + 1] = next[j + 1].min(before[j - 1] + 1);
            }
        }
        (before, row) = (row, next);
    }
    row[b.len()]
}
