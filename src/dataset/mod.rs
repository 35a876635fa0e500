//! Layer 6: results on disk.
//!
//! - [`found`]: what is in the folder of a result. - [`mod@claim`]: whether a campaign may write there, [`folder_error`]: and if not, why. - [`replacement`]: a result takes the
//!   place of an older one. - [`folder`]: the dataset, and the protocol by which parts are added, [`whole_file`]: and each file. - [`manifest`]: what it consists of. - [`mod@identity`]: what its rows are. - [`names`]: of its files.
//! - [`table_log`]: the log by which table engines read the rows. - [`storage`]: file operations, [`stored_file`]: of open files. - [`verify`]: whether files are what was written, [`recovery`]: the manifest of a result that has lost it. - [`part_sink`]: writes finished parts.
//! - [`rows_file`]: the files of rows; [`rows_reader`] reads them, through [`parquet_source`]. - [`bands_file`]: of bands. - [`columnar`]: columns to Parquet, with [`arrow_metadata`]. - [`atomic`]: files that are whole or absent.
//! - [`tally`], [`audit_tally`]: statistics counted while rows are written. - [`provenance`]: metadata on the origin.
//! - [`trajectories`]: time series of the runs that are retained.
//! - [`parts_read`]: the files of parts by what is in them.
//! - [`table`]: tables in a single file: [`timeseries`], [`bands_table`], [`drawn_table`], [`precision_table`].
//! - [`statistics`]: what the rows say of every observable ([`observed`], [`population`]), counted by [`column_counts`] from [`part_columns`],
//!   or by [`running_counts`] while the rows are made; [`verdicts`]: of the requirements, each an [`assessment`] (over time: `band_verdicts`); [`mod@stopping`]: whether
//!   they are enough.
//! - [`sensitivity`]: which input matters; [`drivers`]: which of them the rows show. - [`statistics_table`], [`sensitivity_table`]: both as files, by [`described_table`]. - [`parallel`]: threads.
//! - [`comparison`]: two results, by the samples that both drew ([`pairing`]); [`comparison_table`]: as a file.
//!
//! Not here: text and figures for people (`report`), and reading tables for a campaign (`campaign`).

pub mod arrow_metadata;
pub mod assessment;
pub mod atomic;
pub mod audit_tally;
mod band_verdicts;
pub mod bands_file;
pub mod bands_table;
pub mod claim;
pub mod column_counts;
pub mod columnar;
pub mod comparison;
pub mod comparison_table;
pub mod described_table;
pub mod drawn_table;
pub mod drivers;
pub mod folder;
pub mod folder_error;
pub mod found;
pub mod identity;
pub mod manifest;
pub mod names;
pub mod observed;
pub mod pairing;
pub mod parallel;
pub mod parquet_source;
pub mod part_columns;
pub mod part_sink;
pub mod parts_read;
pub mod population;
pub mod precision_table;
pub mod provenance;
pub mod recovery;
pub mod replacement;
pub mod rows_file;
pub mod rows_reader;
pub mod running_counts;
pub mod sensitivity;
pub mod sensitivity_table;
#[cfg(test)]
mod small_plan;
pub mod statistics;
pub mod statistics_table;
pub mod stopping;
pub mod storage;
pub mod stored_file;
pub mod table;
pub mod table_log;
pub mod tally;
pub mod timeseries;
pub mod trajectories;
pub mod verdicts;
pub mod verify;
pub mod whole_file;
