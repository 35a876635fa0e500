//! Ends of the help texts: exit codes for the program, two examples for each command.

pub const EXIT_CODES: &str = "\
Exit codes:
  0  done (also: the same campaign was already complete)
  1  ran, but some runs failed (their rows say how), or audited errors exceed
     their estimates more often than promised
  2  bad input: arguments, campaign file, or a sample that is not physical
  3  ran, and a requirement failed; compare: a verdict got worse, or a shift
     is beyond the tolerance
  4  input/output error, or the folder has a result that may not be overwritten
  5  ran, and no requirement failed, but one is undecided, or [stop] did not
     reach its precision; verify: the result is not finished
  129, 130, 138, 143  stopped by SIGHUP, SIGINT, SIGUSR1, SIGTERM; the same
     command continues
Where several apply, the first of 2, 4, that of a signal, 3, 5, 1, 0 is returned.

A FILE without a folder, with or without .toml, is also looked for in campaigns/.
SPINDRIFT_ISA=avx512|avx2|plain selects an instruction set; results do not
depend on it.";

pub const CAMPAIGN: &str = "\
Examples:
  spindrift campaign spin_sweep.toml --samples 10000
  spindrift campaign net_launch.toml --set control.delay_s=0.2 --out slow";

pub const FINISH: &str = "\
Examples:
  spindrift finish results/spin_sweep
  spindrift finish results/spin_sweep --junit verdicts.xml";

pub const SHOW: &str = "\
Examples:
  spindrift show results/spin_sweep --verbose
  spindrift show results/spin_sweep --json";

pub const VERIFY: &str = "\
Examples:
  spindrift verify results/spin_sweep
  spindrift verify results/spin_sweep --fraction 1 --repair";

pub const CHECK: &str = "\
Examples:
  spindrift check spin_sweep.toml
  spindrift check net_launch.toml --set campaign.samples=100000";

pub const COMPARE: &str = "\
Examples:
  spindrift compare results/before results/after
  spindrift compare results/before results/after --out shifts.json";

pub const SIMULATE: &str = "\
Examples:
  spindrift simulate spin_sweep.toml --sample 17 --plot run17.svg
  spindrift simulate net_launch.toml --sample 7 --out run7.csv";

pub const SAMPLE: &str = "\
Examples:
  spindrift sample spin_sweep.toml --plot inputs.svg
  spindrift sample spin_sweep.toml --samples 100000 --out inputs.parquet";

pub const REPORT: &str = "\
Examples:
  spindrift report results/spin_sweep
  spindrift report results/net_launch --figures figures";

pub const INDEX: &str = "\
Examples:
  spindrift index results
  spindrift index /data/studies";

pub const PRECISION: &str = "\
Examples:
  spindrift precision spin_sweep.toml
  spindrift precision burn.toml --methods auto,dop853 --tolerances 1e-6,1e-12";

pub const NEW: &str = "\
Examples:
  spindrift new my_sweep.toml
  spindrift new studies/first.toml";

pub const SCHEMA: &str = "\
Examples:
  spindrift schema > spindrift.schema.json
  spindrift schema > schemas/spindrift.schema.json";

pub const COLUMNS: &str = "\
Examples:
  spindrift columns momentum
  spindrift columns pointing --campaign slew_closed.toml";
