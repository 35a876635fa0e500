//! Layer 8: the command line.
//!
//! - [`arguments`]: commands and options; [`argument_values`]: their values. - [`input`]: the plan and the instruction set of a command.
//! - [`outputs`]: which files it may write. - [`workload`]: what a command would compute and write, refused where it cannot be done;
//!   [`machine`]: what is left of memory and disk.
//! - [`analysis`]: what is made of the rows at the end of a campaign.
//! - [`run_campaign`], [`finish_campaign`], [`verify`], [`check`], [`columns`], [`compare`], [`precision`], [`report`], [`sample`],
//!   [`simulate`], [`slurm`]: one command each. - [`slurm_script`]: the scripts of Slurm; [`shell_word`]: words of
//!   commands that are printed.
//! - [`failed_samples`]: samples that failed, again or as the end.
//! - [`dispersions`]: the dispersions of a plan as text. - [`progress`]: the progress bar. - [`screen`]: printing; [`signals`].
//! - [`command_outcome`]: how a command ends, and its exit code.
//!
//! Not here: physics, sampling, file formats.

pub mod analysis;
pub mod argument_values;
pub mod arguments;
pub mod check;
pub mod columns;
pub mod command_outcome;
pub mod compare;
pub mod dispersions;
pub mod failed_samples;
pub mod finish_campaign;
pub mod input;
pub mod machine;
pub mod outputs;
pub mod precision;
pub mod progress;
pub mod report;
pub mod run_campaign;
pub mod sample;
pub mod screen;
pub mod shell_word;
pub mod signals;
pub mod simulate;
pub mod slurm;
pub mod slurm_script;
pub mod verify;
pub mod workload;
