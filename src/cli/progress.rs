//! [`Bar`]: progress with rate and remaining time, on a terminal only.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Redraws per second; progress is reported far more often.
const REFRESH_HZ: u8 = 8;

/// A progress bar over samples.
#[derive(Debug)]
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar of `samples` samples on standard error.
    pub fn new(samples: u64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(samples), ProgressDrawTarget::stderr_with_hz(REFRESH_HZ));
        let template = "{bar:30} {human_pos}/{human_len} samples  {per_sec}  {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style.progress_chars("=> "));
        }
        Bar(bar)
    }

    /// Adds `samples` completed samples.
    pub fn advance(&self, samples: u64) {
        self.0.inc(samples);
    }

    /// Removes the bar; returns the elapsed time.
    pub fn finish(self) -> Duration {
        let elapsed = self.0.elapsed();
        self.0.finish_and_clear();
        elapsed
    }
}
