//! Layer 7: what people read: summaries and figures.

pub mod audit_summary;
pub mod drawn_figure;
pub mod energy_figure;
pub mod plot;
pub mod precision_figure;
pub mod summary;
