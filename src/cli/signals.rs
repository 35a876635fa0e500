//! [`watch`]: graceful termination. The first signal gives current parts [`GRACE`] to end, the second ends the program
//! at once. Committed parts stay and the same command continues. Signals ignored at the start (`nohup`) stay ignored.

use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::time::Duration;

/// Time for current parts to end.
pub const GRACE: Duration = Duration::from_secs(5);
/// Time before a hanging run is abandoned; committed parts are always whole.
const LAST: Duration = Duration::from_millis(1500);

#[derive(Debug)]
pub struct Signals {
    pub stop: AtomicBool,
    pub abandon: AtomicBool,
    signal: AtomicI32,
}

static ASKED: Signals =
    Signals { stop: AtomicBool::new(false), abandon: AtomicBool::new(false), signal: AtomicI32::new(0) };

impl Signals {
    pub fn first(&self) -> Option<i32> {
        Some(self.signal.load(Ordering::SeqCst)).filter(|signal| *signal != 0)
    }
}

pub fn name(signal: i32) -> &'static str {
    match signal {
        1 => "SIGHUP",
        2 => "SIGINT",
        10 => "SIGUSR1",
        15 => "SIGTERM",
        _ => "a signal",
    }
}

pub fn exit_code(signal: i32) -> u8 {
    u8::try_from(128 + signal).unwrap_or(u8::MAX)
}

pub fn asked() -> &'static Signals {
    &ASKED
}

/// Turns a write beyond the file size limit (`ulimit -f`) into an error; by default the signal ends the program.
#[cfg(unix)]
pub fn report_file_limit() {
    // failure to register only loses the message
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default());
}

#[cfg(not(unix))]
pub fn report_file_limit() {}

/// Starts the watch, once. Exits if its thread cannot start, since signals would then be ignored.
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
                // without a further thread, wait for the runs
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

#[cfg(not(unix))]
pub fn watch() -> &'static Signals {
    &ASKED
}

/// Mask of ignored signals, bit 0 for signal 1; known on Linux only.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
