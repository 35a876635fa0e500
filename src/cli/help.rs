//! Ends of the help texts: exit codes of the program, examples of a command.

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

/// Two commands without the name of the program.
macro_rules! examples {
    ($one:literal, $two:literal) => {
        concat!("Examples:\n  spindrift ", $one, "\n  spindrift ", $two)
    };
}
pub(super) use examples;
