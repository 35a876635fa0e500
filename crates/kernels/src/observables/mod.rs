//! Layer 3: observables of a run, by Berdoz, *Final Report - ADR Spacecraft*, (36), and the balances of the gyrostat
//! (Zhukovskii; Volterra 1899). Every error is measured from the computed states; nothing is assumed to be conserved.
#![expect(clippy::needless_range_loop, reason = "wheels and vectors are numbered alike in several arrays")]

#[macro_use]
mod rows;

pub mod accuracy;
mod acting;
mod attitude;
pub mod band_reader;
pub mod band_series;
mod conditioning;
mod energies;
mod error_sums;
pub(crate) mod exchange;
mod finished_run;
pub(crate) mod group;
pub mod headlines;
mod inputs;
pub(crate) mod law_columns;
pub mod loop_error;
mod measure;
mod momenta;
mod motion;
pub mod nominal_attitude;
pub(crate) mod observer;
mod orbit;
mod points;
mod reduce;
pub(crate) mod reduction;
pub mod request;
mod rotor;
mod row_plan;
mod spectrum;
mod surroundings;
pub mod table;
mod torque_growth;
mod weights;
pub mod window;

pub use group::{Group, Groups};
pub use law_columns::{LawColumn, LawColumns, LawSeries};
pub use loop_error::LoopError;
pub use observer::{FlownRun, Observer};
pub use reduction::{ChangeStatistic, ErrorStatistic, OrderStatistic, Reduction, ValueStatistic};
pub use request::Request;
pub use rows::ColumnKind;
pub use table::{Column, ColumnId, Series, error_id};
