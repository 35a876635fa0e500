//! Layer 7: results in a folder or an object store.
//!
//! - [`store`]: the operations on the files of a dataset; [`disk`]: in a folder; `s3`, [`address`]: in an object store.
//! - [`dataset`]: the files of a dataset and the rule by which parts are added; [`identity`]: of its rows; [`names`].
//! - [`found`]: what is in a folder, and which parts are whole; [`claim`]: whether a campaign may write there, and
//!   [`folder_error`]: why not; [`lock`]; [`replacement`]: a result takes the place of an older one.
//! - [`rows_file`]: the files of rows, which [`part_sink`] writes and [`rows_reader`] reads; [`bands_file`]: of bands.
//! - [`columnar`]: tables to Parquet, with [`arrow_metadata`].
//! - [`table_file`]: tables in a single file: [`timeseries`], [`bands_table`], [`drawn_table`], [`precision_table`];
//!   [`atomic`]: which are whole or absent.
//! - [`parallel`]: threads.
//!
//! Not here: statistics of rows (`analysis`), text and figures for people (`report`), and reading tables for a campaign
//! (`campaign`).

pub mod address;
pub mod arrow_metadata;
pub mod atomic;
pub mod bands_file;
pub mod bands_table;
pub mod claim;
pub mod columnar;
pub mod dataset;
pub mod disk;
pub mod drawn_table;
pub mod folder_error;
pub mod found;
pub mod identity;
pub mod lock;
pub mod names;
pub mod parallel;
pub mod part_sink;
pub mod precision_table;
pub mod replacement;
pub mod rows_file;
pub mod rows_reader;
#[cfg(feature = "cloud")]
pub(crate) mod s3;
pub mod store;
pub mod table_file;
pub mod timeseries;
