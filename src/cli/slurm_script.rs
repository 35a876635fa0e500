//! [`Jobs`]: the scripts of the Slurm jobs that run a campaign: an array with a task for each shard, and a job that finishes the result.
//!
//! Slurm: <https://slurm.schedmd.com/sbatch.html>. The array asks for SIGUSR1 before its time limit (`--signal=B:`: to the shell of the
//! script, which passes it on). The program then stops with code 138, and the task puts itself back into the queue, unless it was put back before
//! and has made no part since: it would be put back for ever. Not here: who writes the scripts and submits them ([`super::slurm`]).

use std::fmt::Write as _;
use std::path::Path;

use crate::report::shell_word::{quoted, quoted_path};
use crate::storage::names::SHARDS;

/// The second line of a script: by it, a script of this program is recognised.
pub const MARK: &str = "# made by `spindrift slurm`";

/// Exit code of the program where SIGUSR1 has stopped it.
const STOPPED: u8 = 138;
/// Exit code of a program that SIGKILL has ended: by Slurm, an operator, or the kernel where memory is short.
const KILLED: u8 = 137;
/// A task that was killed is put back into the queue so many times: one that needs more memory than it gets must end at some time.
const RESTARTS: u8 = 3;
/// The signal comes this long before the time limit, s, but not before three quarters of it have passed. The program takes up to 6.5 s to stop;
/// Slurm sends signals up to a minute early.
const WARNING_S: u64 = 60;

/// The time limit of a task.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TimeLimit {
    pub text: String,
    pub seconds: u64,
}

impl TimeLimit {
    /// Reads minutes, `minutes:seconds`, `hours:minutes:seconds`, `days-hours`, `days-hours:minutes` or `days-hours:minutes:seconds`; `None`
    /// where it is none of them, or zero, which Slurm reads as no limit.
    pub fn of(text: &str) -> Option<TimeLimit> {
        const DAY_S: u64 = 86_400;
        let (days, rest) = text.split_once('-').map_or((None, text), |(days, rest)| (Some(days), rest));
        let number = |text: &str| -> Option<u64> {
            let is_number = (1..=6).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
            is_number.then(|| text.parse().ok()).flatten()
        };
        let fields = rest.split(':').map(number).collect::<Option<Vec<u64>>>()?;
        let of_fields = match (days.is_some(), &fields[..]) {
            (false, [minutes]) => 60 * minutes,
            (false, [minutes, seconds]) => 60 * minutes + seconds,
            (_, [hours, minutes, seconds]) => 3600 * hours + 60 * minutes + seconds,
            (true, [hours]) => 3600 * hours,
            (true, [hours, minutes]) => 3600 * hours + 60 * minutes,
            _ => return None,
        };
        let days = days.map_or(Some(0), number)?;
        let seconds = DAY_S * days + of_fields;
        (seconds > 0).then(|| TimeLimit { text: text.to_owned(), seconds })
    }

    /// How long before the limit the signal comes, s.
    fn warning(&self) -> u64 {
        WARNING_S.min(self.seconds / 4).max(1)
    }
}

/// What the scripts have to know.
#[derive(Clone, Copy, Debug)]
pub struct Jobs<'a> {
    pub name: &'a str,
    pub program: &'a Path,
    pub file: &'a Path,
    /// The folder of the result.
    pub out: &'a Path,
    /// Further arguments of `campaign`.
    pub arguments: &'a [String],
    pub shards: u64,
    pub cpus: u64,
    /// Time limit of a task.
    pub time: &'a TimeLimit,
    /// Further options of `sbatch`.
    pub options: &'a [String],
}

impl Jobs<'_> {
    /// The script of the array.
    pub fn array(&self) -> String {
        let Jobs { name, shards, time, .. } = self;
        let own =
            format!("#SBATCH --array=1-{shards}\n#SBATCH --signal=B:USR1@{}\n#SBATCH --requeue\n", time.warning());
        let mut text = self.head(name, &format!("{name}-%a"), &own);
        let arguments: String = self.arguments.iter().map(|argument| format!(" {}", quoted(argument))).collect();
        let _ = write!(
            text,
            r#"
shard='' is_asked='' is_again=''
# the shard's manifest has a line for each part
parts() {{ cat {manifests}/"$SLURM_ARRAY_TASK_ID-of-{shards}.jsonl" 2>/dev/null | grep -c '^{{"part":'; }}
before=$(parts)
# Slurm signals this shell before the time limit; the program then stops, and what it has committed stays
trap 'is_asked=yes; kill -USR1 "$shard"' USR1
{program} campaign {file} --out {out}{arguments} \
    --threads "${{SLURM_CPUS_PER_TASK:-{cpus}}}" --shard "$SLURM_ARRAY_TASK_ID/{shards}" &
shard=$!
wait "$shard"
code=$?
if [ -n "$is_asked" ]; then # the signal has ended the first wait, and not the program
    wait "$shard"
    code=$?
fi
case $code in
{STOPPED}) # the time limit is near
    if [ "${{SLURM_RESTART_COUNT:-0}}" -gt 0 ] && [ "$(parts)" -le "$before" ]; then
        echo "shard $SLURM_ARRAY_TASK_ID/{shards} is not put back into the queue again: it made no part between two time limits ({time})." \
            "Make the scripts again with a longer --time or more --cpus; what is there stays." >&2
    else
        is_again=yes
    fi ;;
{KILLED}) [ "${{SLURM_RESTART_COUNT:-0}}" -lt {RESTARTS} ] && is_again=yes ;; # killed from outside
esac
if [ -n "$is_again" ]; then
    scontrol requeue "$SLURM_JOB_ID" # the same command continues the shard
fi
exit "$code"
"#,
            program = self.program(),
            file = quoted_path(self.file),
            out = quoted_path(self.out),
            cpus = self.cpus,
            manifests = quoted_path(&self.out.join(SHARDS)),
            time = time.text,
        );
        text
    }

    /// The script of the job that finishes the result.
    pub fn finish(&self) -> String {
        let name = format!("{}-finish", self.name);
        let mut text = self.head(&name, &name, "");
        let _ = write!(
            text,
            "\n# 1: some runs failed; 3: a requirement failed; 5: one is undecided; 4: parts are missing, and which\n\
             exec {} finish {} --threads \"${{SLURM_CPUS_PER_TASK:-{}}}\"\n",
            self.program(),
            quoted_path(self.out),
            self.cpus
        );
        text
    }

    fn program(&self) -> String {
        quoted_path(self.program)
    }

    /// The first lines of a script: what it asks of Slurm.
    fn head(&self, name: &str, log: &str, own: &str) -> String {
        let Jobs { cpus, time, .. } = self;
        let mut text = format!(
            "#!/bin/bash\n{MARK}\n#SBATCH --job-name={name}\n#SBATCH --nodes=1\n#SBATCH --ntasks=1\n\
             #SBATCH --cpus-per-task={cpus}\n#SBATCH --time={}\n#SBATCH --output={log}.log\n#SBATCH --open-mode=append\n{own}",
            time.text
        );
        for option in self.options {
            let _ = writeln!(text, "#SBATCH {option}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: every form of sbatch(1) is read, and nothing else.
    #[test]
    fn times_are_those_of_slurm() {
        for (text, seconds) in [
            ("90", 5400),
            ("2:30", 150),
            ("2:00:00", 7200),
            ("1-0", 86_400),
            ("1-12", 129_600),
            ("1-12:30", 131_400),
            ("1-12:30:15", 131_415),
        ] {
            assert_eq!(TimeLimit::of(text).map(|time| time.seconds), Some(seconds), "{text}");
        }
        for text in [
            "",
            "0",
            "0:00",
            "-1",
            "1-",
            "1h",
            "1:2:3:4",
            "1-1:1:1:1",
            "1.5",
            "+5",
            "99999999999999999999",
            "5\n#SBATCH -A x",
        ] {
            assert_eq!(TimeLimit::of(text), None, "{text:?}");
        }
    }

    /// Law: there is time between the signal and the limit, and time before the signal, however short the limit is.
    #[test]
    fn the_signal_comes_between_start_and_limit() {
        for text in ["0:02", "1", "5", "2:00:00"] {
            let time = TimeLimit::of(text).expect("a time");
            assert!((1..time.seconds).contains(&time.warning()), "{text}: {}", time.warning());
        }
        assert_eq!(TimeLimit::of("10").expect("a time").warning(), WARNING_S);
    }
}
