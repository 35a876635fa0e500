//! Commands: what they print and write, how they end.

pub mod brief_screen;
pub mod campaign;
pub mod columns;
pub mod compare;
mod compare_screen;
pub mod exit_codes;
pub mod index;
pub mod memory;
pub mod precision;
pub mod recipes;
pub mod sample_and_check;
pub mod screen_numbers;
pub mod simulate;
pub mod tutorial;
mod widths;
