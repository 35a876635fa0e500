//! [`watch`]: signals that ask the program to stop.
//!
//! The first one lets parts under way end if they can within [`GRACE`]; the second one ends the program at once. Either
//! way what is committed stays, and the same command continues. A signal that was ignored when the program started
//! (`nohup`) stays ignored.

use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::time::Duration;

/// How long parts under way may take to end.
pub const GRACE: Duration = Duration::from_secs(5);
/// After this long a run that does not end is left behind: committed parts are whole whenever the program ends.
const LAST: Duration = Duration::from_millis(1500);

/// What signals have asked for.
#[derive(Debug)]
pub struct Signals {
    /// No further part is to be started.
    pub stop: AtomicBool,
    /// Parts under way are to be given up.
    pub abandon: AtomicBool,
    signal: AtomicI32,
}

static ASKED: Signals =
    Signals { stop: AtomicBool::new(false), abandon: AtomicBool::new(false), signal: AtomicI32::new(0) };

impl Signals {
    /// The first signal, where there was one.
    pub fn first(&self) -> Option<i32> {
        Some(self.signal.load(Ordering::SeqCst)).filter(|signal| *signal != 0)
    }
}

/// The name of a signal that stops the program.
pub fn name(signal: i32) -> &'static str {
    match signal {
        1 => "SIGHUP",
        2 => "SIGINT",
        10 => "SIGUSR1",
        15 => "SIGTERM",
        _ => "a signal",
    }
}

/// The exit code of a program that a signal has stopped, as shells have it.
pub fn exit_code(signal: i32) -> u8 {
    u8::try_from(128 + signal).unwrap_or(u8::MAX)
}

/// What signals have asked for so far.
pub fn asked() -> &'static Signals {
    &ASKED
}

/// Makes the write that exceeds the file size that the process may have (`ulimit -f`) fail with an error, which is then
/// told as any other. Without a handler the system would end the program.
#[cfg(unix)]
pub fn report_file_limit() {
    // where it cannot be registered, only that message is lost
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default());
}

/// There is no such limit here.
#[cfg(not(unix))]
pub fn report_file_limit() {}

/// Starts to watch for signals, once. Where its thread cannot be started, the program ends: it would not end at a
/// signal.
#[cfg(unix)]
pub fn watch() -> &'static Signals {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1};
    static IS_WATCHING: AtomicBool = AtomicBool::new(false);
    if IS_WATCHING.swap(true, Ordering::SeqCst) {
        return &ASKED;
    }
    let ignored = ignored_signals();
    let wanted = [SIGHUP, SIGINT, SIGTERM, SIGUSR1].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    if let Ok(mut signals) = signal_hook::iterator::Signals::new(wanted) {
        let watching = std::thread::Builder::new().spawn(move || {
            for signal in signals.forever() {
                if ASKED.signal.compare_exchange(0, signal, Ordering::SeqCst, Ordering::SeqCst).is_err() {
                    std::process::exit(i32::from(exit_code(signal)));
                }
                ASKED.stop.store(true, Ordering::SeqCst);
                // without a further thread the command ends when its runs do
                let _ = std::thread::Builder::new().spawn(move || {
                    std::thread::sleep(GRACE);
                    ASKED.abandon.store(true, Ordering::SeqCst);
                    std::thread::sleep(LAST);
                    crate::cli::screen::note(
                        "a run under way did not end in time and is left out; what is committed stays",
                    );
                    std::process::exit(i32::from(exit_code(signal)));
                });
            }
        });
        if let Err(error) = watching {
            crate::cli::screen::note(&format!("error: cannot start a thread: {error}"));
            std::process::exit(4);
        }
    }
    &ASKED
}

/// Starts to watch for signals; there are none here.
#[cfg(not(unix))]
pub fn watch() -> &'static Signals {
    &ASKED
}

/// The signals that this process ignores, bit by bit from signal 1 on. Only Linux says.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
