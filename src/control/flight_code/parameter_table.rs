//! [`parse`]: the parameters that a module declares: a text in its memory, a line each.
//!
//! `key | unit | default | meaning`: the default is empty where a campaign file must give the number. The numbers stand in the memory of the module in the
//! order of the lines.

use crate::scene::LawParameter;
use crate::scene::schema::Limit;

/// Most parameters of a module.
pub const MOST: usize = 64;
/// Longest key of one.
const LONGEST_KEY: usize = 40;

/// The parameters that `text` declares; it is kept for good, as the module is.
///
/// # Errors
/// What is wrong with a line.
pub fn parse(text: String) -> Result<&'static [LawParameter], String> {
    let text: &'static str = String::leak(text);
    let mut list: Vec<LawParameter> = Vec::new();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let parts: Vec<&'static str> = line.split('|').map(str::trim).collect();
        let &[key, unit, default, meaning] = &parts[..] else {
            return Err(format!("{line:?} is not of the form \"key | unit | default | meaning\""));
        };
        let is_key = key.starts_with(|first: char| first.is_ascii_lowercase())
            && key.len() <= LONGEST_KEY
            && key.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_');
        if !is_key {
            return Err(format!("{key:?} is no key: a key has small letters, digits and _, at most {LONGEST_KEY}"));
        }
        if list.iter().any(|known| known.facts.key == key) {
            return Err(format!("{key:?} stands in it twice"));
        }
        let parameter = LawParameter::number(key, unit, meaning, Limit::Finite);
        list.push(match default {
            "" => parameter,
            number => match number.parse::<f64>() {
                Ok(number) if number.is_finite() => parameter.or(Vec::leak(vec![number])),
                _ => return Err(format!("the default {number:?} of {key} is no finite number")),
            },
        });
    }
    if list.len() > MOST {
        return Err(format!("{} parameters are more than {MOST}", list.len()));
    }
    Ok(Vec::leak(list))
}
