//! Columns of rows, against motions in closed form and golden truth.

pub mod columns;
pub mod judged_columns;
pub mod mass_properties;
pub mod motion;
pub mod observation;
pub mod observed_tables;
pub mod orbit;
