//! Layer 5: campaign files. What was written ([`Spec`]) -> what will run ([`Plan`]), or every reason why not
//! ([`CampaignError`]).
//!
//! - [`problem`]: one reason, with file, line, key, value, allowed range and remedy. [`excerpt`]: the line with a mark.
//!   [`meaning`]: what an unknown name probably means.
//! - [`input_file`]: regular files of bounded size. [`size`]: how large a campaign file may be.
//! - [`document`], [`section`], [`numbers`], [`lists`]: a TOML document that is read key by key and remembers the
//!   lines. By hand and not by serde's derive, which stops at the first error and knows no line of a key that passed.
//! - [`spec`]: a campaign file as written. [`settings`]: keys outside the scene. [`scene`], [`scene_table`]: keys of
//!   the scene, with the numbers that [`crate::scene::schema`] declares. `control`, `sensor_tables`, `phase_tables`:
//!   control loops. [`failure_tables`]: devices that fail. [`draws`]: dispersions and designs. `keys`: rows of keys,
//!   read and written. [`schema`]: the JSON Schema of campaign files. [`data`], `data_columns`, `data_keys`: files of
//!   numbers. [`parameter`]: names of parameters. [`bands`].
//! - [`analysis`]: what is made of the rows: [`requirement`], [`derived_observable`], [`stop`]; [`known_columns`]: what
//!   they can name; [`columns`]: what runs are observed for; [`event`]: quantities that cross a value; [`extreme`]:
//!   their largest values; `watched_quantity`: which there are; [`event_columns`]: when events and failures happened.
//!   [`retention`]: which runs keep their time series.
//! - [`plan`]: defaults filled in, scene and dispersions checked against each other.
//! - [`chosen`], `plan_rows`: which samples are its rows.
//! - `units`: units in values.
//! - [`notes`]: what is allowed and probably not meant.
//! - [`mod@draw`]: from a plan and the number of a sample to its scene.
//! - [`canonical`], `lines`: the plan as text that reads back to the same plan, and its hash.
//! - [`difference`]: the keys in which two plans differ; [`common_draws`]: whether they draw the same samples.
//! - [`mod@find`]: which file a name means.
//!
//! Not here: what is physical ([`crate::scene`]) and what can be drawn ([`crate::sampling`]); their errors get lines
//! here.

pub mod analysis;
pub mod bands;
pub mod canonical;
pub mod chosen;
pub mod columns;
pub mod common_draws;
mod control;
pub mod data;
mod data_columns;
mod data_keys;
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
pub mod lists;
pub mod meaning;
mod module_key;
pub mod notes;
pub mod numbers;
pub mod parameter;
mod phase_tables;
pub mod plan;
mod plan_rows;
pub mod problem;
pub mod requirement;
pub mod retention;
pub mod scene;
pub mod scene_table;
pub mod schema;
pub mod section;
mod sensor_tables;
pub mod settings;
pub mod size;
mod sources;
pub mod spec;
pub mod stop;
mod tables;
mod units;
mod watched_quantity;

pub use analysis::Analysis;
pub use derived_observable::DerivedObservable;
pub use display::{Display, ShownUnit};
pub use draw::{SceneDraws, draw};
pub use failure_tables::failed_device;
pub use find::{find, nearest_file};
pub use plan::{FilesRead, Overrides, Plan};
pub use problem::{CampaignError, Problem};
pub use requirement::{Requirement, Statement};
pub use retention::Retention;
pub use settings::Compression;
pub use spec::Spec;
pub use stop::Stop;
