//! Lists of numbers, texts and counts in a [`Section`].

use super::numbers::{number, whole};
use super::section::Section;
use crate::sampling::keys::{Counts, Numbers};
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
        let texts = |value: &DeValue<'_>| {
            value.as_array()?.iter().map(|item| item.get_ref().as_str().map(str::to_owned)).collect()
        };
        self.parsed(key, texts, "an array of texts", format!("write it like {example}"))
    }

    /// A finite number, or a matrix of them, if written.
    pub fn correlations(&mut self, key: &str) -> Option<Numbers> {
        let correlations = |value: &DeValue<'_>| match value {
            DeValue::Array(rows) => {
                let rows: Option<Vec<Vec<f64>>> = rows.iter().map(|row| numbers(row.get_ref(), "1")).collect();
                let is_matrix = |rows: &Vec<Vec<f64>>| {
                    rows.first().is_some_and(|first| rows.iter().all(|row| row.len() == first.len()))
                };
                rows.filter(is_matrix).map(Numbers::Rows)
            }
            single => number(single, "1").filter(|x| x.is_finite()).map(Numbers::One),
        };
        let allowed = "one number for two parameters, or rows of equally many finite numbers";
        self.parsed(key, correlations, allowed, "write it like 0.5 or [[1.0, 0.5], [0.5, 1.0]]")
    }

    /// A whole number within `range` for all, or a list of them, if written.
    pub fn counts(&mut self, key: &str, range: std::ops::RangeInclusive<u64>) -> Option<Counts> {
        let allowed = format!("a whole number from {} to {}, or an array of them", range.start(), range.end());
        let in_range = |value: &DeValue<'_>| whole(value).filter(|count| range.contains(count));
        let counts = |value: &DeValue<'_>| match value {
            DeValue::Array(list) => {
                list.iter().map(|item| in_range(item.get_ref())).collect::<Option<_>>().map(Counts::Each)
            }
            single => in_range(single).map(Counts::All),
        };
        self.parsed(key, counts, allowed, "write it like 5 or [5, 3]")
    }

    pub(super) fn samples(&mut self, key: &str, most: usize) -> Option<Vec<u64>> {
        let samples = |value: &DeValue<'_>| {
            let list: Vec<u64> = value.as_array()?.iter().map(|item| whole(item.get_ref())).collect::<Option<_>>()?;
            let is_ascending = list.windows(2).all(|pair| pair[0] < pair[1]);
            (is_ascending && (1..=most).contains(&list.len())).then_some(list)
        };
        let allowed = format!("1 to {most} numbers of samples, ascending and different");
        self.parsed(key, samples, allowed, "write it like [3, 17, 400], or leave it out for all samples")
    }

    /// A flag, if written.
    pub fn flag(&mut self, key: &str) -> Option<bool> {
        self.parsed(key, DeValue::as_bool, "true or false", "write it without quotes")
    }
}

fn numbers(value: &DeValue<'_>, unit: &str) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(|item| number(item.get_ref(), unit).filter(|x| x.is_finite())).collect()
}
