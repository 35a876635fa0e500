//! Layer 5: campaign files: as written ([`Spec`]), resolved ([`Plan`]), or with all problems ([`CampaignError`]).
//!
//! - Reading: [`mod@find`], [`input_file`], [`size`], `sources`; [`document`] and [`section`] (with [`numbers`],
//!   `units`) read key by key and keep lines, since serde's derive stops at the first error and knows no
//!   line of a valid key. [`problem`], [`excerpt`] and [`meaning`] make the messages.
//! - Keys: `keys` reads and writes declared rows. [`settings`], [`scene`] (with [`scene_table`], [`failure_tables`]),
//!   [`loop_tables`], [`draws`], [`analysis`] ([`requirement`],
//!   [`derived_observable`], [`stop`]), [`event`], [`extreme`], [`retention`], [`data`]; [`parameter`] and
//!   [`known_columns`] resolve names, [`schema`] is the JSON Schema.
//! - Plans: [`plan`], [`canonical`] and `lines` (text and hash), [`columns`] and [`event_columns`], `plan_rows` and
//!   [`chosen`], [`mod@draw`] (from a sample's number to its scene), [`notes`], [`difference`], [`common_draws`].
//!
//! Scenes and dispersions are checked in [`crate::scene`] and [`crate::sampling`]; their errors get lines here.

pub mod analysis;
pub mod bands;
pub mod canonical;
pub mod chosen;
pub mod columns;
pub mod common_draws;
pub mod data;
mod data_columns;
pub mod data_keys;
pub mod derived_observable;
mod description;
pub mod difference;
mod display;
pub mod document;
pub mod draw;
pub mod draws;
pub mod event;
pub mod event_columns;
pub mod excerpt;
pub mod extreme;
pub mod failure_tables;
pub mod find;
pub mod forces;
pub mod input_file;
mod keys;
pub mod known_columns;
mod lines;
pub mod loop_tables;
pub mod meaning;
pub mod notes;
pub mod numbers;
pub mod parameter;
pub mod plan;
mod plan_rows;
pub mod problem;
pub mod requirement;
pub mod retention;
pub mod scene;
pub mod scene_table;
pub mod schema;
pub mod section;
pub mod settings;
pub mod size;
mod sources;
pub mod spec;
pub mod stop;
pub mod tables;
pub mod units;
pub mod watched_quantity;

pub use analysis::Analysis;
pub use derived_observable::DerivedObservable;
pub use display::{Display, ShownUnit};
pub use document::Overrides;
pub use draw::{SceneDraws, draw};
pub use failure_tables::failed_device;
pub use find::{find, nearest_file};
pub use loop_tables::LoopTables;
pub use plan::{FilesRead, Plan};
pub use problem::{CampaignError, Problem};
pub use requirement::{Requirement, Statement};
pub use retention::Retention;
pub use settings::Compression;
pub use spec::Spec;
pub use stop::Stop;
