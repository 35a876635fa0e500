//! [`Arguments`]: commands and options of the program, with their help texts.

use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use crate::campaign::Overrides;
use crate::cli::argument_values::{
    count, fraction, method, sbatch_option, seconds, setting, shard, shards, shift, size, threads, time_limit,
    tolerance,
};
use crate::cli::screen;
use crate::cli::slurm_script::TimeLimit;
use crate::propagation::Method;
use crate::report::image::PlotSize;
use crate::storage::claim::Shard;

/// Shown at the end of every help text.
const EXIT_CODES: &str = "\
Exit codes:
  0  done (also: the same campaign was already complete)
  1  ran, but some runs failed (their rows say how), or audited errors exceed their estimates more often than promised
  2  bad input: arguments, campaign file, or a sample that is not physical
  3  ran, and a requirement failed; of compare: a verdict got worse, or a shift is beyond the tolerance
  4  input/output error, or the folder has a result that may not be overwritten
  5  ran, and no requirement failed, but one is undecided, or [stop] did not reach its precision; of verify: the result is not finished
  129, 130, 138, 143  stopped by SIGHUP, SIGINT, SIGUSR1, SIGTERM; the same command continues
Where several apply, the first of 2, 4, that of a signal, 3, 5, 1, 0 is returned.

A FILE without a folder, with or without .toml, is also looked for in campaigns/.
SPINDRIFT_ISA=avx512|avx2|plain selects an instruction set; results do not depend on it.";

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
    /// Run every sample of a campaign: rows to Parquet files, a summary to the screen.
    #[command(after_help = EXIT_CODES)]
    Campaign(CampaignOptions),
    /// Complete a result whose parts several processes have made: check that all parts are there, make the summary.
    #[command(after_help = EXIT_CODES)]
    #[command(name = "finish")]
    CompleteResult(FinishOptions),
    /// Write the scripts that run a campaign on a cluster with Slurm, one shard a task, and submit them.
    #[command(after_help = EXIT_CODES)]
    Slurm(SlurmOptions),
    /// Check a result: every checksum, for a fraction of the parts every bit of every row, and every file that follows from the rows.
    #[command(after_help = EXIT_CODES)]
    Verify(VerifyOptions),
    /// Show what a campaign would run: plan, mass properties, dispersions, what is integrated and why, time and disk space.
    #[command(after_help = EXIT_CODES)]
    Check(CheckOptions),
    /// Compare two results: their plans, and the shift of every statistic, sample by sample where they drew the same samples.
    #[command(after_help = EXIT_CODES)]
    Compare(CompareOptions),
    /// Run one sample as a time series: to a table, a Parquet or CSV file, a plot.
    #[command(after_help = EXIT_CODES)]
    Simulate(SimulateOptions),
    /// Sample the dispersed parameters without running: percentiles, a table, a plot of distributions and correlations.
    #[command(after_help = EXIT_CODES)]
    Sample(SampleOptions),
    /// Make the report page of a finished campaign again, and its figures as files.
    #[command(after_help = EXIT_CODES)]
    Report(ReportOptions),
    /// Measure run time against error for every method and tolerance: a table, a Parquet file, a plot.
    #[command(after_help = EXIT_CODES)]
    Precision(PrecisionOptions),
    /// Write a campaign file to start from.
    #[command(after_help = EXIT_CODES)]
    New(NewOptions),
    /// Show the columns of the rows of a result: name, unit, meaning.
    #[command(after_help = EXIT_CODES)]
    Columns(ColumnsOptions),
}

/// What is changed of a campaign file.
#[derive(Clone, Debug, Default, Args)]
pub struct Changed {
    /// Give a key of the campaign file another value, as messages name it: --set campaign.duration_s=20, --set "wheels.w1.rate_rad_s=20 rpm"; may
    /// be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pub settings: Vec<(String, String)>,
}

impl Changed {
    /// The same for the reader of the file.
    pub fn overrides(&self) -> Overrides {
        Overrides { settings: self.settings.clone(), ..Overrides::default() }
    }
}

/// How large files of figures are.
#[derive(Args, Clone, Copy, Debug)]
pub struct SizeOptions {
    /// Width and height of each figure, mm [default: what its panels need]; texts keep their size.
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size: Option<[f64; 2]>,
    /// Dots per inch of PNG files.
    #[arg(long, value_name = "N", default_value_t = 192, value_parser = clap::value_parser!(u16).range(24..=2400))]
    pub dpi: u16,
}

impl SizeOptions {
    /// The size that they ask for.
    pub fn of(self) -> PlotSize {
        PlotSize { size_mm: self.size, dpi: f64::from(self.dpi) }
    }
}

/// Arguments of `campaign`.
#[derive(Debug, Args)]
pub struct CampaignOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// What is changed of it.
    #[command(flatten)]
    pub changed: Changed,
    /// Folder of the result [default: the campaign's name in results/].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of samples instead of the file's.
    #[arg(long, value_name = "N", value_parser = count)]
    pub samples: Option<u64>,
    /// Seed instead of the file's.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Start also what takes more than 24 hours of CPU time, or more than half of what the disk has left.
    #[arg(long)]
    pub yes: bool,
    /// Number of threads, at most four for each core [default: one for each core]; rows do not depend on it.
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<std::num::NonZeroUsize>,
    /// Fraction of the samples to compare with a reference solution, instead of the file's.
    #[arg(long, value_name = "F")]
    pub audit: Option<f64>,
    /// Replace an existing result, which stays as it is until the new one is complete.
    #[arg(long)]
    pub overwrite: bool,
    /// Write the verdicts on the requirements to this file, as JUnit XML.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Run part K of N of the work, for instance on one machine of N; `finish` then completes the result.
    #[arg(long, value_name = "K/N", value_parser = shard, conflicts_with = "overwrite")]
    pub shard: Option<Shard>,
    /// Run only the samples that failed in this result, with its seed and number of samples, into another folder.
    #[arg(long, value_name = "DIR", requires = "out", conflicts_with_all = ["samples", "seed"])]
    pub only_failed_of: Option<PathBuf>,
    /// Start no further part after one with a run that failed, and end with code 1; the same command without it continues.
    #[arg(long)]
    pub fail_fast: bool,
    /// Do not write report.html.
    #[arg(long)]
    pub no_report: bool,
    /// Write each figure of the report as SVG and PNG into this folder.
    #[arg(long, value_name = "DIR", conflicts_with = "no_report")]
    pub figures: Option<PathBuf>,
    /// How large they are.
    #[command(flatten)]
    pub size: SizeOptions,
}

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct ReportOptions {
    /// Folder of the result, with plan.toml and runs/.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Write each figure as SVG and PNG into this folder.
    #[arg(long, value_name = "DIR")]
    pub figures: Option<PathBuf>,
    /// How large they are.
    #[command(flatten)]
    pub size: SizeOptions,
    /// Fly so many scenes of a campaign with a control loop twice, with other noise of the sensors, and say which share of the variance is noise.
    #[arg(long, value_name = "SCENES", value_parser = clap::value_parser!(u64).range(2..))]
    pub noise: Option<u64>,
    /// Number of threads, at most four for each core [default: one for each core]; the page does not depend on it.
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<std::num::NonZeroUsize>,
}

/// Arguments of `finish`.
#[derive(Debug, Args)]
pub struct FinishOptions {
    /// The folder of the result.
    pub folder: PathBuf,
    /// Write the verdicts on the requirements to this file, as JUnit XML.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Do not write report.html.
    #[arg(long)]
    pub no_report: bool,
    /// Write each figure of the report as SVG and PNG into this folder.
    #[arg(long, value_name = "DIR", conflicts_with = "no_report")]
    pub figures: Option<PathBuf>,
    /// How large they are.
    #[command(flatten)]
    pub size: SizeOptions,
    /// Number of threads, at most four for each core [default: one for each core].
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<std::num::NonZeroUsize>,
}

/// Arguments of `slurm`.
#[derive(Debug, Args)]
pub struct SlurmOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// What is changed of it.
    #[command(flatten)]
    pub changed: Changed,
    /// Number of tasks: each is a shard, on a node or a share of one.
    #[arg(long, value_name = "N", value_parser = shards)]
    pub nodes: NonZeroU64,
    /// Cores of a task.
    #[arg(long, value_name = "C")]
    pub cpus: NonZeroU64,
    /// Time limit of a task, as Slurm reads it: minutes, H:MM:SS, D-HH. A task that meets it continues in another.
    #[arg(long, value_name = "T", value_parser = time_limit)]
    pub time: TimeLimit,
    /// Submit the scripts with sbatch.
    #[arg(long)]
    pub submit: bool,
    /// Folder of the result, which every node sees [default: the campaign's name in results/].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of samples instead of the file's.
    #[arg(long, value_name = "N")]
    pub samples: Option<u64>,
    /// Seed instead of the file's.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// A further option of both jobs, for instance --sbatch=--partition=long; may be repeated.
    #[arg(long, value_name = "OPTION", value_parser = sbatch_option)]
    pub sbatch: Vec<String>,
}

/// Arguments of `verify`.
#[derive(Debug, Args)]
pub struct VerifyOptions {
    /// The folder of the result.
    pub folder: PathBuf,
    /// Fraction of the parts whose rows are computed again and compared bit for bit.
    #[arg(long, value_name = "F", default_value_t = 0.01, value_parser = fraction)]
    pub fraction: f64,
    /// Make damaged or differing parts again.
    #[arg(long)]
    pub repair: bool,
    /// Number of threads, at most four for each core [default: one for each core].
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<std::num::NonZeroUsize>,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// What is changed of it.
    #[command(flatten)]
    pub changed: Changed,
}

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub struct CompareOptions {
    /// The folder of the first result: the baseline.
    pub first: PathBuf,
    /// The folder of the second.
    pub second: PathBuf,
    /// End with code 3 where a statistic is shifted by more than this fraction of the standard deviation in the first result; 0
    /// allows no difference.
    #[arg(long, value_name = "F", value_parser = shift)]
    pub tolerance: Option<f64>,
    /// Write the whole comparison to a file: every observable, in .json or .parquet; in .json the plans and verdicts too.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Number of threads, at most four for each core [default: one for each core].
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<std::num::NonZeroUsize>,
}

/// Arguments of `simulate`.
#[derive(Debug, Args)]
pub struct SimulateOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// What is changed of it.
    #[command(flatten)]
    pub changed: Changed,
    /// The sample, run exactly as the campaign runs it; 0 is the nominal scene.
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub sample: u64,
    /// Times in seconds instead of the campaign's, in any order; the output is ascending, without duplicates. They may
    /// exceed the campaign's duration.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', allow_negative_numbers = true)]
    pub times: Option<Vec<f64>>,
    /// Compare the run with a reference solution and show its errors.
    #[arg(long)]
    pub audit: bool,
    /// Write all columns to this file (.parquet or .csv).
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Plot states, energies and errors to this file (.svg or .png), on a fine grid or at --times.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// How large they are.
    #[command(flatten)]
    pub size: SizeOptions,
}

/// Arguments of `sample`.
#[derive(Debug, Args)]
pub struct SampleOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// What is changed of it.
    #[command(flatten)]
    pub changed: Changed,
    /// Number of samples instead of the file's.
    #[arg(long, value_name = "N", value_parser = count)]
    pub samples: Option<u64>,
    /// Seed instead of the file's.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Start also what takes more than 24 hours of CPU time, or more than half of what the disk has left.
    #[arg(long)]
    pub yes: bool,
    /// Show the numbers that this sample applies, and nothing else.
    #[arg(long, value_name = "K", conflicts_with_all = ["out", "plot"])]
    pub sample: Option<u64>,
    /// Write the dispersed parameters of every sample to this file (.parquet or .csv).
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Plot distributions and rank correlations to this file (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// How large they are.
    #[command(flatten)]
    pub size: SizeOptions,
}

/// Arguments of `precision`.
#[derive(Debug, Args)]
pub struct PrecisionOptions {
    /// The campaign file; its own method and tolerance are not used.
    pub file: PathBuf,
    /// What is changed of it.
    #[command(flatten)]
    pub changed: Changed,
    /// Number of samples, starting with the nominal one.
    #[arg(long, value_name = "N", default_value = "64")]
    pub samples: std::num::NonZeroU64,
    /// Methods, named as in campaign files [default: all].
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = method)]
    pub methods: Option<Vec<Method>>,
    /// Tolerances [default: 1e-4 to 1e-16 by decades]. A fixed-step method is run with as many steps, each half the
    /// previous one.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = tolerance)]
    pub tolerances: Option<Vec<f64>>,
    /// Timed repetitions of each measurement; the median is reported.
    #[arg(long, value_name = "N", default_value = "5")]
    pub repeats: std::num::NonZeroUsize,
    /// Start also what takes more than 24 hours of CPU time.
    #[arg(long)]
    pub yes: bool,
    /// Integrate only the states that the file's groups of observables need.
    #[arg(long)]
    pub observed: bool,
    /// Skip settings predicted to take more CPU time than this for one pass over the samples.
    #[arg(long, value_name = "S", default_value = "20", value_parser = seconds)]
    pub limit_s: f64,
    /// Folder of the result, whose files are replaced [default: the campaign's name and _precision in results/].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// How large they are.
    #[command(flatten)]
    pub size: SizeOptions,
}

/// Arguments of `new`.
#[derive(Debug, Args)]
pub struct NewOptions {
    /// The file that is written; one that is there is not replaced.
    #[arg(default_value = "start.toml")]
    pub file: PathBuf,
}

/// Arguments of `columns`.
#[derive(Debug, Args)]
pub struct ColumnsOptions {
    /// A group of columns, named as in campaign files, or a word: the columns that have it in name or meaning [default: all].
    pub word: Option<String>,
    /// Show the columns of this campaign, with the names of its wheels, its dispersed values and audits.
    #[arg(long, value_name = "FILE")]
    pub campaign: Option<PathBuf>,
}

/// The arguments of this process; invalid ones end it with a message and code 2, and a request for help ends it with code 0.
pub fn arguments() -> Arguments {
    Arguments::try_parse().unwrap_or_else(|error| {
        // the parser would print names as they are, with what a terminal obeys
        let text = error.render().to_string();
        if error.use_stderr() {
            screen::note(text.trim_end());
        } else if let Err(error) = screen::print(&text) {
            screen::note(&format!("error: {error}"));
            std::process::exit(4);
        }
        std::process::exit(error.exit_code());
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

    /// Law: every help text lists the exit codes.
    #[test]
    fn every_help_documents_the_exit_codes() {
        let mut command = Arguments::command();
        let mut helps = vec![command.render_help().to_string()];
        // `help` is clap's own
        let ours = command.get_subcommands_mut().filter(|command| command.get_name() != "help");
        helps.extend(ours.map(|command| command.render_help().to_string()));
        assert_eq!(helps.len(), 13);
        for help in helps {
            for code in ["0  done", "1  ran", "2  bad input", "3  ran", "4  input/output", "5  ran"] {
                assert!(help.contains(code), "{help}");
            }
        }
    }
}
