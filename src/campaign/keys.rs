//! [`KeyReader`] for a table of a campaign file, [`KeyWriter`] for canonical text.

use super::data_keys;
use super::limits::MAX_SAMPLES;
use super::lines::Lines;
use super::numbers::FINITE;
use super::section::Section;
use crate::sampling::keys::{Counts, KeyReader, KeyWriter};
use crate::sampling::{DataColumn, Values, WrittenDistribution};

impl KeyReader for Section<'_, '_> {
    fn has(&self, key: &str) -> bool {
        Section::has(self, key)
    }

    fn require(&mut self, key: &'static str, allowed: &str, example: &str) {
        Section::require(self, key, allowed, example);
    }

    fn refuse(&mut self, key: &str, allowed: &str, remedy: &str) {
        Section::refuse(self, key, allowed, remedy);
    }

    fn number(&mut self, key: &'static str) -> Option<f64> {
        Section::number(self, key, FINITE)
    }

    fn values(&mut self, key: &'static str) -> Option<Values> {
        Section::values(self, key)
    }

    fn numbers(&mut self, key: &'static str) -> Option<Vec<f64>> {
        Section::numbers(self, key)
    }

    fn vector(&mut self, key: &'static str) -> Option<[f64; 3]> {
        Section::direction(self, key).filter(|vector| vector.iter().all(|x| x.is_finite()))
    }

    fn matrix(&mut self, key: &'static str) -> Option<[[f64; 3]; 3]> {
        Section::matrix(self, key).filter(|matrix| matrix.as_flattened().iter().all(|x| x.is_finite()))
    }

    fn choice(&mut self, key: &'static str, names: &[&str]) -> Option<usize> {
        Section::name(self, key, names, |name| names.iter().position(|known| *known == name))
    }

    fn count(&mut self, key: &'static str, most: u64) -> Option<u64> {
        Section::count(self, key, 1..=most)
    }

    fn counts(&mut self, key: &'static str) -> Option<Counts> {
        Section::counts(self, key, 1..=MAX_SAMPLES)
    }

    fn table(&mut self, key: &'static str, read: &mut dyn FnMut(&mut dyn KeyReader)) -> bool {
        let mut section = self.section(key);
        let is_present = section.is_present();
        if is_present {
            read(&mut section);
            if section.is_name_of("distribution", WrittenDistribution::NAMES) {
                section.finish();
            }
        }
        is_present
    }

    fn kind(&mut self, key: &'static str, names: &[&'static str], example: &str) -> Option<&'static str> {
        Section::require(self, key, &format!("one of {}", names.join(", ")), example);
        Section::name(self, key, names, |name| names.iter().copied().find(|known| *known == name))
    }

    fn column(&mut self) -> Option<DataColumn> {
        data_keys::column(self)
    }

    fn columns(&mut self) -> Option<Vec<DataColumn>> {
        data_keys::columns(self)
    }
}

impl KeyWriter for Lines {
    fn key(&mut self, key: &str, value: &dyn std::fmt::Debug) {
        Lines::key(self, key, value);
    }

    fn table(&mut self, key: &str) {
        Lines::table(self, &format!("[disperse.{key}]"));
    }
}
