//! Declarations of a module: text in its memory with one line each, in parts separated by `|`.
//!
//! - parameters, `key | unit | default | meaning`; an empty default makes a key required;
//! - sensors whose measurements it receives, `name | kind`;
//! - telemetry, `key | unit | meaning`.
//!
//! Their numbers are in the module's memory in the order of the lines. Declarations are leaked, like the module.

use crate::loops::flight_code::{DeclaredTelemetry, WantedSensor};
use crate::scene::LawParameter;
use crate::scene::schema::Limit;

const MOST_PARAMETERS: usize = 64;
const MOST_SENSORS: usize = 32;
const MOST_TELEMETRY: usize = 32;
const LONGEST_KEY: usize = 40;

/// The lines of `text`, each in the parts of `form`.
fn lines<const N: usize>(text: String, form: [&str; N], most: usize) -> Result<Vec<[&'static str; N]>, String> {
    if text.chars().any(|letter| letter.is_control() && letter != '\n') {
        return Err("its text has control characters".to_owned());
    }
    let text: &'static str = String::leak(text);
    let lines: Vec<&'static str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    if lines.len() > most {
        return Err(format!("{} lines are more than {most}", lines.len()));
    }
    let mut list: Vec<[&'static str; N]> = Vec::new();
    for line in lines {
        let parts: Vec<&'static str> = line.split('|').map(str::trim).collect();
        let parts: [&'static str; N] =
            parts.try_into().map_err(|_| format!("{line:?} is not of the form {:?}", form.join(" | ")))?;
        if list.iter().any(|known| known[0] == parts[0]) {
            return Err(format!("{:?} stands in it twice", parts[0]));
        }
        list.push(parts);
    }
    Ok(list)
}

fn check_key(key: &str) -> Result<(), String> {
    let is_key = key.starts_with(|first: char| first.is_ascii_lowercase())
        && key.len() <= LONGEST_KEY
        && key.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_');
    if is_key {
        return Ok(());
    }
    Err(format!("{key:?} is not a key: a key has lower-case letters, digits and _, at most {LONGEST_KEY}"))
}

/// Parses declared parameters.
///
/// # Errors
/// The reason why a line is refused; likewise below.
pub fn parameters(text: String) -> Result<&'static [LawParameter], String> {
    let mut list = Vec::new();
    for [key, unit, default, meaning] in lines(text, ["key", "unit", "default", "meaning"], MOST_PARAMETERS)? {
        check_key(key)?;
        let parameter = LawParameter::number(key, unit, meaning, Limit::Finite);
        list.push(match default {
            "" => parameter,
            number => match number.parse::<f64>() {
                Ok(number) if number.is_finite() => parameter.or(Vec::leak(vec![number])),
                _ => return Err(format!("the default {number:?} of {key} is not a finite number")),
            },
        });
    }
    Ok(Vec::leak(list))
}

pub fn sensors(text: String) -> Result<&'static [WantedSensor], String> {
    let list = lines(text, ["name", "kind"], MOST_SENSORS)?;
    Ok(Vec::leak(list.into_iter().map(|[name, kind]| WantedSensor { name, kind }).collect()))
}

pub fn telemetry(text: String) -> Result<&'static [DeclaredTelemetry], String> {
    let mut list = Vec::new();
    for [key, unit, meaning] in lines(text, ["key", "unit", "meaning"], MOST_TELEMETRY)? {
        check_key(key)?;
        let ending = ending(unit);
        if !key.ends_with(&ending) || key.len() == ending.len() {
            return Err(format!("the key {key:?} does not end in its unit, as in error{ending} of {unit:?}"));
        }
        list.push(DeclaredTelemetry { stem: &key[..key.len() - ending.len()], key, unit, meaning });
    }
    Ok(Vec::leak(list))
}

/// Suffix of keys in `unit`: `_kg_m2` for `kg m^2`, nothing for `1`.
fn ending(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let words = unit.split([' ', '/', '(', ')']).filter(|word| !word.is_empty());
    words.map(|word| format!("_{}", word.replace('^', "").to_ascii_lowercase())).collect()
}
