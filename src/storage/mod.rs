//! Layer 7: results on disk.
//!
//! - [`found`]: what is in the folder of a result.
//! - [`mod@claim`]: whether a campaign may write there, [`folder_error`]: and if not, why.
//! - [`folder`]: the dataset, and the protocol by which parts are added, [`whole_file`]: and each file. [`manifest`]:
//!   what it consists of, [`mod@identity`]: what its rows are, [`names`]: of its files.
//! - [`replacement`]: a result takes the place of an older one.
//! - [`verify`]: whether files are what was written, [`recovery`]: the manifest of a result that has lost it.
//! - [`disk`]: file operations, [`stored_file`]: of open files.
//! - [`atomic`]: files that are whole or absent.
//! - [`rows_file`]: the files of rows, which [`part_sink`] writes and [`rows_reader`] reads, through
//!   [`parquet_source`]; [`bands_file`]: of bands.
//! - [`columnar`]: tables to Parquet, with [`arrow_metadata`].
//! - [`table_file`]: tables in a single file: [`timeseries`], [`bands_table`], [`drawn_table`], [`precision_table`].
//! - [`parallel`]: threads.
//! - [`remote`]: results in an object store.
//!
//! Not here: what the rows say (`analysis`), text and figures for people (`report`), and reading tables for a campaign
//! (`campaign`).

pub mod arrow_metadata;
pub mod atomic;
pub mod bands_file;
pub mod bands_table;
pub mod claim;
pub mod columnar;
pub mod disk;
pub mod drawn_table;
pub mod folder;
pub mod folder_error;
pub mod found;
pub mod identity;
pub mod manifest;
pub mod names;
pub mod parallel;
pub mod parquet_source;
pub mod part_sink;
pub mod precision_table;
pub mod recovery;
pub mod remote;
pub mod replacement;
pub mod rows_file;
pub mod rows_reader;
pub mod stored_file;
pub mod table_file;
pub mod timeseries;
pub mod verify;
pub mod whole_file;
