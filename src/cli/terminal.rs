//! [`Terminal`]: notes, a progress bar on terminals, and signals.

use std::fmt::Write;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, MutexGuard, PoisonError};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use crate::cli::signals::{self, asked};
use crate::cli::{completed_text, screen};
use crate::workflow::Watch;

const REFRESH_HZ: u8 = 8;

/// Standard error, and the signals of this process.
#[derive(Debug, Default)]
pub struct Terminal {
    bar: Mutex<Option<ProgressBar>>,
}

impl Terminal {
    pub fn signal(&self) -> Option<i32> {
        asked().first()
    }

    fn bar(&self) -> MutexGuard<'_, Option<ProgressBar>> {
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
        *self.bar() = Some(bar);
    }

    fn advance(&self, samples: u64) {
        self.bar().iter().for_each(|bar| bar.inc(samples));
    }

    fn end(&self) {
        self.bar().take().iter().for_each(ProgressBar::finish_and_clear);
    }

    fn stop(&self) -> &AtomicBool {
        &asked().stop
    }

    fn abandon(&self) -> &AtomicBool {
        &asked().abandon
    }
}
