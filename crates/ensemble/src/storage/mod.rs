//! Layer 7: results in a folder or an object store.
//!
//! - [`store`]: the operations on the files of a dataset; [`disk`]: in a folder; `s3`, [`address`]: in an object store.
//! - [`dataset`]: the files of a dataset and the rule by which parts are added; [`identity`]: of its rows; [`names`].
//! - [`found`]: contents of a folder and its whole parts; [`claim`]: whether a campaign may write there, and
//!   [`folder_error`]: why not; [`lock`]; [`replacement`] of an older result.
//! - [`rows_file`]: files of rows, written by [`part_sink`] and read by [`rows_reader`]; [`bands_file`]: of bands.
//! - [`columnar`]: tables to Parquet, with [`arrow_metadata`].
//! - [`table_file`]: tables in a single file: [`timeseries`], [`bands_table`], [`drawn_table`], [`precision_table`],
//!   whole or absent ([`atomic`]).
//! - [`parallel`]: threads.
//!
//! Statistics of rows are in `analysis`, texts and figures in `report`, input tables in `campaign`.

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
pub mod s3;
#[cfg(test)]
mod scratch;
pub mod store;
pub mod table_file;
pub mod timeseries;
