//! Floor 6: results on the disk and on the screen.
//!
//! - [`folder`]: the folder of a result, what makes it whole, and what may be replaced. - [`atomic`]: files whole or absent.
//! - [`columnar`]: columns with unit and meaning as Parquet. - [`rows_file`]: the files of rows. - [`part_sink`]: parts into files.
//! - [`sketch`], [`summary`]: order statistics of any number of samples in flat memory.
//! - [`timeseries`]: one run over time. - [`plot`], [`energy_figure`]: curves as SVG and PNG.
//! - [`drawn_table`], [`drawn_figure`]: drawn samples as a table, their marginals and correlation.
//! - [`precision_table`], [`precision_figure`]: run time against error, as Parquet, text and a logarithmic plot.
//!
//! Not here: what is measured (the observables' table says it), and arguments and exit codes (the command line).

pub mod atomic;
pub mod audit_summary;
pub mod columnar;
pub mod drawn_figure;
pub mod drawn_table;
pub mod energy_figure;
pub mod folder;
pub mod part_sink;
pub mod plot;
pub mod precision_figure;
pub mod precision_table;
pub mod rows_file;
pub mod sketch;
pub mod summary;
pub mod timeseries;
