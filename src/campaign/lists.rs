//! Lists of numbers, texts and counts in a [`Section`].

use super::numbers::number;
use super::section::Section;
use crate::sampling::Numbers;
use crate::sampling::keys::Counts;
use toml::Spanned;
use toml::de::DeValue;

impl Section<'_, '_> {
    /// Finite numbers in `unit`, if written.
    pub fn numbers(&mut self, key: &str, unit: &'static str) -> Option<Vec<f64>> {
        let value = self.take(key)?;
        let list = numbers(value.get_ref(), unit);
        let (allowed, remedy) = ("an array of finite numbers", "write it like [1.0, 2.0]");
        match (&list, value.get_ref()) {
            (Some(_), _) => {}
            (None, DeValue::Array(_)) => self.refuse_number(key, unit, value.get_ref(), allowed, remedy),
            (None, _) => self.refuse(key, allowed, remedy),
        }
        list
    }

    /// Texts, if written.
    pub fn texts(&mut self, key: &str, example: &str) -> Option<Vec<String>> {
        let value = self.take(key)?;
        let text = |item: &DeValue<'_>| item.as_str().map(str::to_owned);
        let list: Option<Vec<String>> =
            value.get_ref().as_array().and_then(|list| list.iter().map(|item| text(item.get_ref())).collect());
        if list.is_none() {
            self.refuse(key, "an array of texts", format!("write it like {example}"));
        }
        list
    }

    /// A finite number, or a matrix of them, if written.
    pub fn correlations(&mut self, key: &str) -> Option<Numbers> {
        let value = self.take(key)?;
        let found = match value.get_ref() {
            DeValue::Array(rows) => {
                let rows: Option<Vec<Vec<f64>>> = rows.iter().map(|row| numbers(row.get_ref(), "1")).collect();
                let is_matrix = |rows: &Vec<Vec<f64>>| {
                    rows.first().is_some_and(|first| rows.iter().all(|row| row.len() == first.len()))
                };
                rows.filter(is_matrix).map(Numbers::Rows)
            }
            single => number(single, "1").filter(|x| x.is_finite()).map(Numbers::One),
        };
        if found.is_none() {
            let allowed = "one number for two parameters, or rows of equally many finite numbers";
            self.refuse(key, allowed, "write it like 0.5 or [[1.0, 0.5], [0.5, 1.0]]");
        }
        found
    }

    /// A whole number within `range` for all, or a list of them, if written.
    pub fn counts(&mut self, key: &str, range: std::ops::RangeInclusive<u64>) -> Option<Counts> {
        let value = self.take(key)?;
        let count = |value: &DeValue<'_>| {
            let count = value.as_integer().and_then(|x| u64::from_str_radix(x.as_str(), x.radix()).ok());
            count.filter(|count| range.contains(count))
        };
        let counts = match value.get_ref() {
            DeValue::Array(list) => {
                list.iter().map(|item| count(item.get_ref())).collect::<Option<_>>().map(Counts::Each)
            }
            single => count(single).map(Counts::All),
        };
        if counts.is_none() {
            let allowed = format!("a whole number from {} to {}, or an array of them", range.start(), range.end());
            self.refuse(key, allowed, "write it like 5 or [5, 3]");
        }
        counts
    }

    pub(super) fn samples(&mut self, key: &str, most: usize) -> Option<Vec<u64>> {
        let list = self.take(key)?.get_ref().as_array();
        let number = |item: &Spanned<DeValue<'_>>| {
            let integer = item.get_ref().as_integer()?;
            u64::from_str_radix(integer.as_str(), integer.radix()).ok()
        };
        let samples = list.and_then(|list| list.iter().map(number).collect::<Option<Vec<u64>>>());
        let is_allowed =
            |list: &Vec<u64>| (1..=most).contains(&list.len()) && list.windows(2).all(|pair| pair[0] < pair[1]);
        let samples = samples.filter(is_allowed);
        if samples.is_none() {
            let allowed = format!("1 to {most} numbers of samples, ascending and different");
            self.refuse(key, allowed, "write it like [3, 17, 400], or leave it out for all samples");
        }
        samples
    }

    /// A flag, if written.
    pub fn flag(&mut self, key: &str) -> Option<bool> {
        let value = self.take(key)?;
        let flag = value.get_ref().as_bool();
        if flag.is_none() {
            self.refuse(key, "true or false", "write it without quotes");
        }
        flag
    }
}

fn numbers(value: &DeValue<'_>, unit: &str) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(|item| number(item.get_ref(), unit).filter(|x| x.is_finite())).collect()
}
