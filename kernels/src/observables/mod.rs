//! Layer 3: what is observed of a run.
//!
//! - [`group`]: the groups that a campaign asks for by name.
//! - [`table`]: the one table of observables: series, direct values and the columns of a row; `rows`: what its rows
//!   consist of; `inputs`: what each value is made of; [`headlines`]: the columns of a summary.
//! - [`reduction`]: how a series becomes a number; `reduce`, `correlation`: the passes over series that compute it
//!   (`weights`).
//! - [`request`]: what a campaign observes; from it the columns, and which fields of the state table they need and why.
//! - [`observer`]: [`Observer`] reads a state table and writes a row, by a `row_plan` and with direct values of a
//!   `finished_run`.
//! - `measure`: states to series, by `energies`, `momenta`, `attitude`, `motion`, `orbit` and `surroundings`, eight
//!   points at a time (`points`).
//! - [`nominal_attitude`]: the attitude of the nominal run, with which those of the others are compared.
//! - `conditioning`, `error_sums`, `rotor`, `acting`: how much the motion amplifies errors of its state.
//! - [`law_columns`]: the columns that a control law reports.
//! - [`band_series`]: the quantities over time that have bands; [`band_reader`]: theirs of a run; [`window`]: their
//!   extremes in an interval of time.
//! - `exchange`, `spectrum`: the exchange of energy between the bodies, and its frequency.
//!
//! Source of energies and momenta: Berdoz, *Final Report - ADR Spacecraft*, (36), and the balances of the gyrostat
//! (Zhukovskii; Volterra 1899). Nothing here depends on how a run was integrated, and nothing is assumed to be
//! conserved: every error is measured from the computed states.

pub mod accuracy;
mod acting;
mod attitude;
pub mod band_reader;
pub mod band_series;
mod conditioning;
#[cfg(test)]
mod conditioning_laws;
mod correlation;
mod energies;
mod error_sums;
pub mod exchange;
mod finished_run;
pub mod group;
pub mod headlines;
mod inputs;
pub mod law_columns;
mod measure;
mod momenta;
mod motion;
pub mod nominal_attitude;
pub mod observer;
mod orbit;
mod points;
mod reduce;
pub mod reduction;
pub mod request;
mod rotor;
mod row_plan;
#[macro_use]
mod rows;
mod spectrum;
mod surroundings;
pub mod table;
mod torque_growth;
mod weights;
pub mod window;

pub use group::{Group, Groups};
pub use law_columns::{LawColumn, LawColumns, LawSeries};
pub use observer::Observer;
pub use reduction::{ChangeStatistic, ErrorStatistic, OrderStatistic, Reduction, ValueStatistic};
pub use request::Request;
pub use rows::ColumnKind;
pub use table::{Column, ColumnId, Series};
