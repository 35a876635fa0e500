//! Results: statistics, verdicts, audits and failures, against rows.

pub mod absent_values;
pub mod audit;
pub mod audit_limit;
pub mod band_requirements;
pub mod drivers;
pub mod failed_again;
pub mod failed_runs;
pub mod lost_runs;
pub mod not_a_number;
pub mod requirements;
pub mod result_files;
pub mod retained;
pub mod run_ends;
pub mod said_once;
pub mod statistics;
pub mod stopping;
