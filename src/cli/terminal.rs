//! [`Terminal`]: notes, a progress bar on terminals and a line a minute elsewhere, and signals.

use std::fmt::Write;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::cli::signals::{self, asked};
use crate::cli::{completed_text, screen};
use crate::workflow::Watch;
use crate::workflow::workload::time;

const REFRESH_HZ: u8 = 8;
/// Time between two lines of progress in a file or a pipe.
const LINE: Duration = Duration::from_secs(60);

/// Standard error, and the signals of this process.
#[derive(Debug, Default)]
pub struct Terminal {
    bar: Mutex<Option<Bar>>,
}

#[derive(Debug)]
struct Bar {
    bar: ProgressBar,
    /// Time of the next line without a terminal.
    next: Duration,
}

/// Progress after `elapsed` of a campaign with `done` of `samples` samples.
fn line(done: u64, samples: u64, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs_f64();
    let left = seconds * (samples - done) as f64 / done as f64;
    let whole = |seconds: f64| if seconds < 120.0 { seconds.round() } else { 60.0 * (seconds / 60.0).round() };
    format!("{done} of {samples} samples after {}, about {} left", time(whole(seconds)), time(whole(left)))
}

impl Terminal {
    pub fn signal(&self) -> Option<i32> {
        asked().first()
    }

    fn bar(&self) -> MutexGuard<'_, Option<Bar>> {
        self.bar.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watch for Terminal {
    fn note(&self, text: &str) {
        screen::note(text);
    }

    /// From here on, signals stop the work before the program.
    fn begin(&self, samples: u64) {
        signals::watch();
        let bar = ProgressBar::with_draw_target(Some(samples), ProgressDrawTarget::stderr_with_hz(REFRESH_HZ));
        let template = "{bar:30} {human_pos}/{human_len} samples  {rate}  {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let rate = |state: &ProgressState, out: &mut dyn Write| {
                let _ = write!(out, "{}", completed_text::rate(state.per_sec()));
            };
            bar.set_style(style.progress_chars("=> ").with_key("rate", rate));
        }
        *self.bar() = Some(Bar { bar, next: LINE });
    }

    fn advance(&self, samples: u64) {
        for Bar { bar, next } in self.bar().iter_mut() {
            bar.inc(samples);
            let (elapsed, samples) = (bar.elapsed(), bar.length().unwrap_or_default());
            if bar.is_hidden() && elapsed >= *next && bar.position() < samples {
                *next = elapsed + LINE;
                screen::note(&line(bar.position(), samples, elapsed));
            }
        }
    }

    fn end(&self) {
        self.bar().take().iter().for_each(|Bar { bar, .. }| bar.finish_and_clear());
    }

    fn stop(&self) -> &AtomicBool {
        &asked().stop
    }

    fn abandon(&self) -> &AtomicBool {
        &asked().abandon
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: at an even pace, the time left is to the time taken as the samples left are to those done.
    #[test]
    fn the_time_left_follows_from_the_pace() {
        let text = line(250, 1000, Duration::from_secs_f64(601.3));
        assert_eq!(text, "250 of 1000 samples after 10 minutes, about 30 minutes left");
    }
}
