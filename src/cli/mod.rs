//! Floor 7: the command line. Arguments, progress, exit codes; no physics.
//!
//! - [`campaign`], [`check`], [`precision`], [`sample`], [`simulate`]: one command each. - [`dispersions`]: what is drawn, in words.
//! - [`verdict`]: how a command ends, and the exit code. - [`progress`]: the bar. - [`screen`]: what is printed.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::campaign::{Overrides, Plan, find};
use crate::cli::command_outcome::Failure;
use crate::math::Isa;
use crate::math::isa::VARIABLE;
use crate::propagation::Method;

pub mod check;
pub mod command_outcome;
pub mod dispersions;
pub mod precision;
pub mod progress;
pub mod run_campaign;
pub mod sample;
pub mod screen;
pub mod simulate;

/// What stands below every help text.
const EXIT_CODES: &str = "\
Exit codes:
  0  done (also: the same campaign had already run to its end)
  1  ran, but some runs failed (their rows say how)
  2  bad input: arguments, campaign file, or a sample that is not physical
  4  input/output error, or a result in the way that is not to be overwritten

A FILE without a folder, with or without .toml, is also looked up in campaigns/.
SPINDRIFT_ISA=avx512|avx2|plain forces an instruction set; results do not depend on it.";

/// Monte Carlo analysis of spacecraft attitude dynamics.
#[derive(Debug, Parser)]
#[command(name = "spindrift", version, about, after_help = EXIT_CODES, propagate_version = true)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run every sample of a campaign; rows go to Parquet files, a summary to the screen.
    #[command(after_help = EXIT_CODES)]
    Campaign(CampaignOptions),
    /// Show what a campaign would run: plan, masses and inertia, dispersions, what is integrated and why, time and disk.
    #[command(after_help = EXIT_CODES)]
    Check(CheckOptions),
    /// Run one sample as a time series: to a table, a Parquet or CSV file, a plot.
    #[command(after_help = EXIT_CODES)]
    Simulate(SimulateOptions),
    /// Draw the samples of a campaign without running them: percentiles, a table of all, marginals and correlation as a plot.
    #[command(after_help = EXIT_CODES)]
    Sample(SampleOptions),
    /// Measure run time against error for every method and tolerance: a table, a Parquet file, a plot.
    #[command(after_help = EXIT_CODES)]
    Precision(PrecisionOptions),
}

/// Arguments of `campaign`.
#[derive(Debug, Args)]
pub struct CampaignOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// Folder of the result [default: the campaign's name in results/].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of samples instead of the file's.
    #[arg(long, value_name = "N")]
    pub samples: Option<u64>,
    /// Seed instead of the file's.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Number of threads [default: one for each core]; rows do not depend on it.
    #[arg(long, value_name = "N")]
    pub threads: Option<std::num::NonZeroUsize>,
    /// Share of the samples to run again exactly and compare, instead of the file's.
    #[arg(long, value_name = "F")]
    pub audit: Option<f64>,
    /// Replace a result that is already there.
    #[arg(long)]
    pub overwrite: bool,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckOptions {
    /// The campaign file.
    pub file: PathBuf,
}

/// Arguments of `simulate`.
#[derive(Debug, Args)]
pub struct SimulateOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// The sample to run exactly as the campaign runs it; 0 is the nominal scene.
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub sample: u64,
    /// Times in seconds instead of the campaign's, in any order; the output is ascending, each time once. They may lie
    /// beyond the campaign's duration.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', allow_negative_numbers = true)]
    pub times: Option<Vec<f64>>,
    /// Run the sample again exactly, and say how far it is off.
    #[arg(long)]
    pub audit: bool,
    /// Write all columns to this file (.parquet or .csv).
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Plot the energies to this file (.svg or .png), smoothly, or at --times.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

/// Arguments of `sample`.
#[derive(Debug, Args)]
pub struct SampleOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// Number of samples instead of the file's.
    #[arg(long, value_name = "N")]
    pub samples: Option<u64>,
    /// Seed instead of the file's.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Write every sample's dispersed numbers to this file (.parquet or .csv).
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Plot marginals and rank correlation to this file (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

/// Arguments of `precision`.
#[derive(Debug, Args)]
pub struct PrecisionOptions {
    /// The campaign file; its own method and tolerance are not used.
    pub file: PathBuf,
    /// Number of samples, from the first.
    #[arg(long, value_name = "N", default_value = "64")]
    pub samples: std::num::NonZeroU64,
    /// Methods, by their names in campaign files [default: all].
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = precision::method)]
    pub methods: Option<Vec<Method>>,
    /// Tolerances [default: 1e-4 to 1e-16, a decade apart]. A method with a fixed step gets as many steps, each half the one
    /// before.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = precision::tolerance)]
    pub tolerances: Option<Vec<f64>>,
    /// Timed repetitions of each; the median counts.
    #[arg(long, value_name = "N", default_value = "5")]
    pub repeats: std::num::NonZeroUsize,
    /// Integrate only what the file's groups of observables need, not every state of the scene.
    #[arg(long)]
    pub observed: bool,
    /// Leave out what is predicted to take more CPU time than this for one pass over the samples.
    #[arg(long, value_name = "S", default_value = "20", value_parser = precision::seconds)]
    pub limit_s: f64,
    /// Folder of the result, whose files are replaced [default: the campaign's name and _precision in results/].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The arguments of this process; where they are wrong, says so and ends it with code 2.
pub fn arguments() -> Arguments {
    Arguments::parse()
}

/// The plan that `file` means.
fn plan(file: &std::path::Path, overrides: Overrides) -> Result<Plan, Failure> {
    let path = find(file).map_err(|tried| {
        let tried: Vec<String> = tried.iter().map(|path| format!("`{}`", path.display())).collect();
        Failure::Input(format!("there is no campaign file `{}`; looked for {}", file.display(), tried.join(", ")))
    })?;
    Plan::load(&path, overrides).map_err(|error| Failure::Input(error.to_string()))
}

/// The instruction set of this process.
fn isa() -> Result<Isa, Failure> {
    Isa::chosen().map_err(|value| {
        let names: Vec<&str> = Isa::available().iter().map(|isa| isa.name()).collect();
        Failure::Input(format!("{VARIABLE}={value}: must be one of {}, or unset", names.join(", ")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Arguments::command().debug_assert();
    }

    /// Law: whoever reads a help text finds the exit codes there.
    #[test]
    fn every_help_documents_the_exit_codes() {
        let mut command = Arguments::command();
        let mut helps = vec![command.render_help().to_string()];
        // `help` is clap's own
        let ours = command.get_subcommands_mut().filter(|command| command.get_name() != "help");
        helps.extend(ours.map(|command| command.render_help().to_string()));
        assert_eq!(helps.len(), 6);
        for help in helps {
            for code in ["0  done", "1  ran", "2  bad input", "4  input/output"] {
                assert!(help.contains(code), "{help}");
            }
        }
    }
}
