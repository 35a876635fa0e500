//! Floor 3: what is measured in a run.
//!
//! - [`group`]: the groups that a campaign asks for by name.
//! - [`columns`]: the one table of what a row holds (name, unit, meaning, where the number comes from).
//! - [`series`]: the time series behind the columns, which `simulate` writes out.
//! - [`request`]: what was asked for; from it the columns, and which blocks of the state table they need and why.
//! - [`observer`]: [`Observer`] reads a state table and writes a row.
//! - `measure`, `momenta`, `attitude`, `points`: states to series, eight points at a time.
//! - `conditioning`, `error_sums`, `rotor`: how much the motion amplifies errors of its state.
//! - `reduce`, `spectrum`: series to numbers, the frequency of the exchange.
//!
//! Source of energies and momenta: Berdoz, *Final Report - ADR Spacecraft*, (36), and the balances of the gyrostat
//! (Zhukovskii; Volterra 1899). Nothing here knows how a run was integrated, and nothing is assumed to be conserved: every
//! error is measured from the produced states.

mod attitude;
pub mod columns;
mod conditioning;
mod error_sums;
pub mod group;
mod measure;
mod momenta;
pub mod observer;
mod points;
mod reduce;
pub mod request;
mod rotor;
pub mod series;
mod spectrum;

pub use columns::{Column, Kind};
pub use group::{Group, Groups};
pub use observer::Observer;
pub use request::Request;
pub use series::{Series, SeriesColumn};
