//! Parsers of option values; errors state the allowed values.

use std::num::NonZeroUsize;

use crate::propagation::Method;
use crate::storage::claim::Shard;
use crate::workflow::threads::usable;

const MOST_SHARDS: u64 = 1_000_000;

pub fn method(name: &str) -> Result<Method, String> {
    let names = || Method::ALL.map(Method::name).join(", ");
    Method::from_name(name).ok_or_else(|| format!("must be one of {}", names()))
}

/// A finite number for which `is` holds.
fn number(text: &str, is: impl Fn(f64) -> bool, allowed: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|value: &f64| value.is_finite() && is(*value));
    found.ok_or_else(|| format!("must be a number {allowed}"))
}

pub fn tolerance(text: &str) -> Result<f64, String> {
    number(text, |value| (1e-16..=0.1).contains(&value), "from 1e-16 to 0.1")
}

pub fn fraction(text: &str) -> Result<f64, String> {
    number(text, |value| (0.0..=1.0).contains(&value), "from 0 to 1")
}

/// A dotted key and its value, `campaign.duration_s=20`.
pub fn setting(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()));
    parts
        .filter(|(key, value)| !key.is_empty() && !value.is_empty())
        .ok_or_else(|| "must be KEY=VALUE, for instance campaign.duration_s=20".to_owned())
}

pub fn shard(text: &str) -> Result<Shard, String> {
    let numbers = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
    let shard = numbers.map(|(number, of)| Shard { number, of });
    let allowed = || format!("must be K/N with 1 <= K <= N <= {MOST_SHARDS}, for instance 3/8");
    shard.filter(|shard| (1..=shard.of).contains(&shard.number) && shard.of <= MOST_SHARDS).ok_or_else(allowed)
}

pub fn threads(text: &str) -> Result<NonZeroUsize, String> {
    usable(text.parse().unwrap_or(0))
}

pub fn shift(text: &str) -> Result<f64, String> {
    number(text, |value| value >= 0.0, "of at least 0")
}

pub fn count(text: &str) -> Result<u64, String> {
    let whole = |number: &f64| (0.0..=9e15).contains(number) && libm::floor(*number) == *number;
    text.parse().map_err(|_| match text.parse().ok().filter(whole) {
        Some(number) => format!("must be a whole number without decimal point or exponent; write {}", number as u64),
        None => "must be a whole number of at least 1".to_owned(),
    })
}

pub fn seconds(text: &str) -> Result<f64, String> {
    number(text, |value| value > 0.0, "of seconds above 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_have_a_range() {
        assert_eq!(shard("3/8"), Ok(Shard { number: 3, of: 8 }));
        for wrong in ["0/8", "9/8", "3", "3/8/2", "-1/8", "1/1000001"] {
            assert!(shard(wrong).is_err_and(|message| message.contains("1 <= K <= N")), "{wrong}");
        }
    }

    #[test]
    fn threads_have_a_range() {
        let most = 4 * std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        assert!(threads("1").is_ok() && threads(&most.to_string()).is_ok());
        for wrong in ["0", "-1", "1.5", "many", &(most + 1).to_string(), "100000", "99999999999999999999999"] {
            assert!(threads(wrong).is_err_and(|message| message.contains(&format!("from 1 to {most}"))), "{wrong}");
        }
    }
}
