//! Layer 7: text and figures for people.
//!
//! - [`summary`], [`audit_summary`]: statistics of a campaign. - [`precision_text`]: work-precision measurements as text.
//! - [`plot`]: curves in panels. - [`energy_figure`], [`drawn_figure`], [`precision_figure`]: the figures of the commands.
//! - [`number`]: numbers in text.

pub mod audit_summary;
pub mod drawn_figure;
pub mod energy_figure;
pub mod number;
pub mod plot;
pub mod precision_figure;
pub mod precision_text;
pub mod summary;
