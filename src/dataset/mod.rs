//! Layer 6: results on disk: the folder of a campaign, its parts, and tables.

pub mod atomic;
pub mod columnar;
pub mod drawn_table;
pub mod folder;
pub mod part_sink;
pub mod precision_table;
pub mod rows_file;
pub mod timeseries;
