//! Layer 3: observables of a run.
//!
//! - [`group`]: groups of columns by name. [`table`]: the one table of series, direct values and columns; `rows`: types
//!   of its rows; `inputs`: inputs of each value; [`headlines`]: columns of a summary.
//! - [`request`]: columns of a campaign, and the fields of the state table that they need. [`observer`]: [`Observer`]
//!   turns a state table into a row, by a `row_plan` and a `finished_run`.
//! - [`reduction`]: series to numbers; `reduce`, `correlation`: passes over series (`weights`).
//! - `measure`: states to series, by `energies`, `momenta`, `attitude`, `motion`, `orbit` and `surroundings`, eight
//!   points at a time (`points`). [`nominal_attitude`]: attitude of the nominal run.
//! - `conditioning`, `error_sums`, `rotor`, `acting`: amplification of errors of the state.
//! - [`law_columns`]: columns of a control law. [`band_series`], [`band_reader`]: bands over time; [`window`]: extremes
//!   in an interval. `exchange`, `spectrum`: exchange of energy between the bodies, and its frequency.
//!
//! Sources of energies and momenta: Berdoz, *Final Report - ADR Spacecraft*, (36), and the balances of the gyrostat
//! (Zhukovskii; Volterra 1899). Nothing depends on the integration of a run, and nothing is assumed to be conserved:
//! every error is measured from the computed states.

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
