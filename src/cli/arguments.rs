//! [`Arguments`]: commands and options of the program, with their help texts.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand};

use crate::cli::argument_values::{count, fraction, method, seconds, setting, shard, shift, threads, tolerance};
use crate::cli::colour::Colour;
use crate::cli::help::{EXIT_CODES, examples};
use crate::cli::screen;
use crate::control::tables::Overrides;
use crate::propagation::Method;
use crate::storage::claim::Shard;
use crate::workflow::Outputs;

/// Monte Carlo analysis of spacecraft attitude dynamics.
#[derive(Debug, Parser)]
#[command(name = "spindrift", version, about, after_help = EXIT_CODES, propagate_version = true)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Colour verdicts, help and notes; `auto` does on a terminal, unless NO_COLOR is set.
    #[arg(long, value_name = "WHEN", global = true, value_enum, default_value_t = Colour::Auto,
        hide_possible_values = true)]
    pub color: Colour,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a campaign: rows, statistics, verdicts and the report page.
    #[command(after_help = examples!(
        "campaign spin_sweep.toml --samples 10000",
        "campaign net_launch.toml --set control.delay_s=0.2 --out slow"
    ))]
    Campaign(CampaignOptions),
    /// Merge shards into a finished result.
    #[command(name = "finish", after_help = examples!(
        "finish results/spin_sweep",
        "finish results/spin_sweep --junit verdicts.xml"
    ))]
    CompleteResult(FinishOptions),
    /// Print again what a finished result has found, as text or JSON.
    #[command(after_help = examples!("show results/spin_sweep --verbose", "show results/spin_sweep --json"))]
    Show(ShowOptions),
    /// Check a result: checksums, recomputed rows, and every file derived from the rows.
    #[command(after_help = examples!("verify results/spin_sweep", "verify results/spin_sweep --fraction 1 --repair"))]
    Verify(VerifyOptions),
    /// Show what a campaign would run: time, disk, dispersions, masses, what is integrated and why.
    #[command(after_help = examples!("check spin_sweep.toml", "check net_launch.toml --set campaign.samples=100000"))]
    Check(CheckOptions),
    /// Compare two results: plans, verdicts, and the shift of every outcome.
    #[command(after_help = examples!(
        "compare results/before results/after",
        "compare results/before results/after --out shifts.json"
    ))]
    Compare(CompareOptions),
    /// Run one sample as a time series: a table, a Parquet or CSV file, a plot.
    #[command(after_help = examples!(
        "simulate spin_sweep.toml --sample 17 --plot run17.svg",
        "simulate net_launch.toml --sample 7 --out run7.csv"
    ))]
    Simulate(SimulateOptions),
    /// Draw the dispersed parameters without running: percentiles, a table, histograms and correlations.
    #[command(after_help = examples!(
        "sample spin_sweep.toml --plot inputs.svg",
        "sample spin_sweep.toml --samples 100000 --out inputs.parquet"
    ))]
    Sample(SampleOptions),
    /// Rebuild the report page of a finished result, and write its figures as files.
    #[command(after_help = examples!("report results/spin_sweep", "report results/net_launch --figures figures"))]
    Report(ReportOptions),
    /// List all results below a folder, with verdicts and what changed, also as a page.
    #[command(after_help = examples!("index results", "index /data/studies"))]
    Index(IndexOptions),
    /// Measure run time against error for methods and tolerances.
    #[command(after_help = examples!(
        "precision spin_sweep.toml",
        "precision burn.toml --methods auto,dop853 --tolerances 1e-6,1e-12"
    ))]
    Precision(PrecisionOptions),
    /// Write a campaign file to start from.
    #[command(after_help = examples!("new my_sweep.toml", "new studies/first.toml"))]
    New(NewOptions),
    /// Print the JSON Schema of campaign files, by which editors complete and check them.
    ///
    /// A campaign file names it in its first line: #:schema spindrift.schema.json
    #[command(after_help = examples!("schema > spindrift.schema.json", "schema > schemas/spindrift.schema.json"))]
    Schema,
    /// List the columns of the rows: name, unit, meaning.
    #[command(after_help = examples!("columns momentum", "columns pointing --campaign slew_closed.toml"))]
    Columns(ColumnsOptions),
}

#[derive(Clone, Debug, Default, Args)]
pub struct Changed {
    /// Override a key, KEY as shown in error messages: --set campaign.duration_s=20, --set "wheels.w1.rate_rad_s=20
    /// rpm"; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pub settings: Vec<(String, String)>,
}

impl Changed {
    pub fn overrides(&self) -> Overrides {
        Overrides { settings: self.settings.clone(), ..Overrides::default() }
    }
}

#[derive(Clone, Copy, Debug, Args)]
pub struct Drawn {
    /// Number of samples; overrides the file.
    #[arg(long, value_name = "N", value_parser = count)]
    pub samples: Option<u64>,
    /// Seed; overrides the file.
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,
    /// Allow campaigns longer than 24 CPU hours, or larger than half of the free disk space.
    #[arg(long)]
    pub yes: bool,
}

impl Drawn {
    /// With the changes of `changed`.
    pub fn overrides(&self, changed: &Changed) -> Overrides {
        Overrides { samples: self.samples, seed: self.seed, ..changed.overrides() }
    }
}

#[derive(Clone, Copy, Debug, Args)]
pub struct Threads {
    /// Number of threads, at most four per core [default: one per core]; nothing that is computed depends on it.
    #[arg(long = "threads", value_name = "N", value_parser = threads)]
    pub number: Option<std::num::NonZeroUsize>,
}

/// Files beside a result.
#[derive(Clone, Debug, Args)]
pub struct Written {
    /// Write the verdicts to this file as JUnit XML.
    #[arg(long, value_name = "FILE")]
    pub junit: Option<PathBuf>,
    /// Do not write report.html.
    #[arg(long)]
    pub no_report: bool,
    /// Write every figure of the report to this folder: SVG where the program draws it, else a page.
    #[arg(long, value_name = "DIR", conflicts_with = "no_report")]
    pub figures: Option<PathBuf>,
}

impl Written {
    pub fn outputs(&self) -> Outputs {
        Outputs { without_page: self.no_report, figures: self.figures.clone(), junit: self.junit.clone() }
    }

    /// The files, each with its option.
    pub fn named(&self) -> [(&'static str, Option<&Path>); 2] {
        [("--junit", self.junit.as_deref()), ("--figures", self.figures.as_deref())]
    }
}

#[derive(Debug, Args)]
pub struct CampaignOptions {
    /// The campaign file.
    pub file: PathBuf,
    #[command(flatten)]
    pub changed: Changed,
    /// Result folder, or s3://bucket/name [default: results/NAME, the campaign's name].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub drawn: Drawn,
    #[command(flatten)]
    pub threads: Threads,
    /// Fraction of the samples to compare with a reference solution; overrides the file.
    #[arg(long, value_name = "F")]
    pub audit: Option<f64>,
    /// Replace an existing result, which stays as it is until the new one is complete.
    #[arg(long)]
    pub overwrite: bool,
    /// Run share K of N, for instance on one of N machines; `finish` then merges the shares.
    #[arg(long, value_name = "K/N", value_parser = shard, conflicts_with = "overwrite")]
    pub shard: Option<Shard>,
    /// Run only the samples that failed in this result, into another folder, with its seed and number of samples.
    #[arg(long, value_name = "DIR", requires = "out", conflicts_with_all = ["samples", "seed"])]
    pub only_failed_of: Option<PathBuf>,
    /// Stop after the first part with a failed run, with exit code 1; the same command without this option continues.
    #[arg(long)]
    pub fail_fast: bool,
    /// Show all that the rows say, not one screen of it.
    #[arg(long)]
    pub verbose: bool,
    #[command(flatten)]
    pub written: Written,
}

#[derive(Debug, Args)]
pub struct ReportOptions {
    /// The result folder, with plan.toml and runs/.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Write every figure to this folder: SVG where the program draws it, else a page.
    #[arg(long, value_name = "DIR")]
    pub figures: Option<PathBuf>,
    /// Run this many scenes of a control loop twice with different sensor noise, and report the share of the variance
    /// that is noise.
    #[arg(long, value_name = "SCENES", value_parser = clap::value_parser!(u64).range(2..))]
    pub noise: Option<u64>,
    #[command(flatten)]
    pub threads: Threads,
}

#[derive(Debug, Args)]
pub struct FinishOptions {
    /// The result folder.
    pub folder: PathBuf,
    /// Show all that the rows say, not one screen of it.
    #[arg(long)]
    pub verbose: bool,
    #[command(flatten)]
    pub written: Written,
    #[command(flatten)]
    pub threads: Threads,
}

#[derive(Debug, Args)]
pub struct ShowOptions {
    /// The result folder.
    pub folder: PathBuf,
    /// Print summary.json in place of text.
    #[arg(long, conflicts_with = "verbose")]
    pub json: bool,
    /// Show all that the rows say, not one screen of it.
    #[arg(long)]
    pub verbose: bool,
    #[command(flatten)]
    pub threads: Threads,
}

#[derive(Debug, Args)]
pub struct VerifyOptions {
    /// The result folder.
    pub folder: PathBuf,
    /// Fraction of the parts whose rows are recomputed and compared bit for bit.
    #[arg(long, value_name = "F", default_value_t = 0.01, value_parser = fraction)]
    pub fraction: f64,
    /// Recompute damaged or differing parts and write them again.
    #[arg(long)]
    pub repair: bool,
    #[command(flatten)]
    pub threads: Threads,
}

#[derive(Debug, Args)]
pub struct CheckOptions {
    /// The campaign file.
    pub file: PathBuf,
    /// Show all that is known, not one screen of it: percentiles of the draws, masses, momenta, what is integrated and
    /// why.
    #[arg(long)]
    pub verbose: bool,
    /// Show the plan too: every key, with the defaults.
    #[arg(long)]
    pub plan: bool,
    #[command(flatten)]
    pub changed: Changed,
}

#[derive(Debug, Args)]
pub struct CompareOptions {
    /// The baseline result folder.
    pub first: PathBuf,
    /// The result folder to compare with it.
    pub second: PathBuf,
    /// Exit with code 3 if a statistic is shifted by more than this fraction of the standard deviation in the baseline;
    /// 0 allows no difference.
    #[arg(long, value_name = "F", value_parser = shift)]
    pub tolerance: Option<f64>,
    /// Exit with code 3 for every verdict that is worse, also where the data differ by no more than chance makes.
    #[arg(long)]
    pub strict: bool,
    /// Write the whole comparison to this file (.json or .parquet); .json has the plans and verdicts too.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// List every column that is shifted, and every key that differs, not one screen of them.
    #[arg(long)]
    pub verbose: bool,
    #[command(flatten)]
    pub threads: Threads,
}

#[derive(Debug, Args)]
pub struct SimulateOptions {
    /// The campaign file.
    pub file: PathBuf,
    #[command(flatten)]
    pub changed: Changed,
    /// The sample to run, exactly as the campaign runs it; 0 is the nominal scene.
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub sample: u64,
    /// Times in seconds, in any order; they override the campaign's grid and may exceed its duration. The output is
    /// ascending, without duplicates.
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', allow_negative_numbers = true)]
    pub times: Option<Vec<f64>>,
    /// Compare the run with a reference solution and show its errors.
    #[arg(long)]
    pub audit: bool,
    /// Write all columns to this file (.parquet or .csv).
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Plot states, energies and errors to this file (.html, or .svg where the program draws it), on a fine grid or at
    /// --times.
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct SampleOptions {
    /// The campaign file.
    pub file: PathBuf,
    #[command(flatten)]
    pub changed: Changed,
    #[command(flatten)]
    pub drawn: Drawn,
    /// Show only the values that this sample applies.
    #[arg(long, value_name = "K", conflicts_with_all = ["out", "plot"])]
    pub sample: Option<u64>,
    /// Write the dispersed parameters of every sample to this file (.parquet or .csv).
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Plot distributions and rank correlations to this file (.html, or .svg where the program draws it).
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct IndexOptions {
    /// The folder with results in it; index.html is written there.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

#[derive(Debug, Args)]
pub struct PrecisionOptions {
    /// The campaign file; its own method and tolerance are not used.
    pub file: PathBuf,
    #[command(flatten)]
    pub changed: Changed,
    /// Number of samples, starting with the nominal scene.
    #[arg(long, value_name = "N", default_value = "64")]
    pub samples: std::num::NonZeroU64,
    /// Methods, as named in campaign files [default: all].
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = method)]
    pub methods: Option<Vec<Method>>,
    /// Tolerances [default: 1e-4 to 1e-16 by decades]. A fixed-step method is run with as many steps, each half the
    /// previous one.
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_parser = tolerance)]
    pub tolerances: Option<Vec<f64>>,
    /// Timed repetitions of each measurement; the median is reported.
    #[arg(long, value_name = "N", default_value = "5")]
    pub repeats: std::num::NonZeroUsize,
    /// Allow measurements longer than 24 CPU hours.
    #[arg(long)]
    pub yes: bool,
    /// Integrate only the states that the file's groups of observables need.
    #[arg(long)]
    pub observed: bool,
    /// Skip settings predicted to take more CPU time than this for one pass over the samples.
    #[arg(long, value_name = "S", default_value = "20", value_parser = seconds)]
    pub limit_s: f64,
    /// Result folder, whose files are replaced [default: results/NAME_precision].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct NewOptions {
    /// The file to write; an existing file is not replaced.
    #[arg(default_value = "start.toml")]
    pub file: PathBuf,
}

#[derive(Debug, Args)]
pub struct ColumnsOptions {
    /// A group of columns, as named in campaign files, or a word to find in names and meanings [default: the groups].
    pub word: Option<String>,
    /// List the columns of every group.
    #[arg(long, conflicts_with = "word")]
    pub verbose: bool,
    /// List the columns of this campaign, with the names of its wheels, its dispersed values and audits.
    #[arg(long, value_name = "FILE")]
    pub campaign: Option<PathBuf>,
}

/// Parses `words`, the name of the program first; invalid ones end the process with a message and code 2, and a
/// request for help ends it with code 0.
pub fn arguments(words: impl Iterator<Item = OsString>) -> Arguments {
    Arguments::try_parse_from(words).unwrap_or_else(|error| {
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

    /// Law: the exit codes stand in the help of the program alone, and that of every command has two examples of it,
    /// which are valid.
    #[test]
    fn every_help_has_what_it_promises() {
        let mut command = Arguments::command();
        let root = command.render_help().to_string();
        for code in ["0  done", "1  ran", "2  bad input", "3  ran", "4  input/output", "5  ran"] {
            assert!(root.contains(code), "{root}");
        }
        // `help` is clap's own
        let ours = command.get_subcommands_mut().filter(|command| command.get_name() != "help");
        let mut count = 0;
        for command in ours {
            let (name, help) = (command.get_name().to_owned(), command.render_help().to_string());
            assert!(!help.contains("Exit codes"), "{help}");
            let (_, examples) = help.split_once("Examples:\n").expect("examples");
            let examples: Vec<&str> = examples.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
            assert_eq!(examples.len(), 2, "{help}");
            for example in examples {
                assert!(example.starts_with(&format!("spindrift {name} ")), "{example}");
                let command = example.split(" > ").next().unwrap_or_default();
                let parsed = Arguments::try_parse_from(command.split_whitespace());
                assert!(parsed.is_ok(), "{example}: {parsed:?}");
            }
            count += 1;
        }
        assert!(count > 10, "{count}");
    }
}
