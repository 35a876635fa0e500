//! [`Session`]: means for all work on campaigns and results; [`Watch`]: its listener, which may stop it.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use super::error::{Result, WorkflowError};
use crate::control::tables::Overrides;
use crate::ensemble::Supervision;
use crate::ensemble::runner::threads;
use crate::ensemble::supervision::{Alone, Crew};
use crate::loops::OwnLaw;
use crate::math::Isa;
use crate::math::isa::VARIABLE;
use crate::storage::address::Address;
use crate::storage::disk::{folder, meant};
use crate::storage::store::{OpenFolder, Store, at};

/// Receives events from any thread, and may stop the work.
pub trait Watch: Sync {
    /// A note for a person: damage, existing samples, looks of `[stop]`.
    fn note(&self, _text: &str) {}

    /// Runs of this many samples begin.
    fn begin(&self, _samples: u64) {}

    /// This many more have ended.
    fn advance(&self, _samples: u64) {}

    /// No further run follows.
    fn end(&self) {}

    /// Starts no further part once set; committed parts stay, and the same campaign continues.
    fn stop(&self) -> &AtomicBool;

    /// Abandons parts under way once set.
    fn abandon(&self) -> &AtomicBool;
}

/// Ignores everything and never stops.
#[derive(Debug, Default)]
pub struct Quiet {
    stop: AtomicBool,
    abandon: AtomicBool,
}

impl Watch for Quiet {
    fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    fn abandon(&self) -> &AtomicBool {
        &self.abandon
    }
}

/// Connects to the store at an address.
///
/// # Errors
/// A wrong environment, or a store that does not answer or refuses.
pub type Connect = fn(&Address) -> std::io::Result<Arc<dyn Store>>;

static CONNECT: OnceLock<Connect> = OnceLock::new();

/// Makes `connect` the client of this process if the build has none: the Python package has object stores with the
/// library of the program, compiled once.
pub fn connect_by(connect: Connect) {
    let _ = CONNECT.set(connect);
}

/// The client of this process, if any.
pub fn connect() -> Option<Connect> {
    #[cfg(feature = "cloud")]
    return Some(crate::storage::s3::connect);
    #[cfg(not(feature = "cloud"))]
    CONNECT.get().copied()
}

#[derive(Clone, Copy)]
pub struct Session<'a> {
    /// Opens folders of results.
    pub folders: &'a OpenFolder<'a>,
    pub isa: Isa,
    /// Number of threads for runs and files; `None`: one per core.
    pub threads: Option<NonZeroUsize>,
    /// The program's law.
    pub law: Option<&'a OwnLaw>,
    /// Runs the share of each thread.
    pub crew: &'a dyn Crew,
    pub watch: &'a dyn Watch,
}

impl<'a> Session<'a> {
    /// Disk, all cores, no law of the program, and the listener `watch`.
    ///
    /// # Errors
    /// An unavailable instruction set in the environment.
    pub fn new(watch: &'a dyn Watch) -> Result<Self> {
        let isa = isa()?;
        Ok(Session { folders: &folder, isa, threads: None, law: None, crew: &Alone, watch })
    }

    /// The store of a folder or an address `s3://bucket/name`.
    ///
    /// # Errors
    /// An invalid address, or an unreachable store.
    pub fn store(&self, root: &Path) -> Result<Arc<dyn Store>> {
        let Some(address) = Address::of(root, connect().is_some()).map_err(WorkflowError::Input)? else {
            let root = meant(root).map_err(at(root))?;
            return Ok((self.folders)(&root));
        };
        let none = || std::io::Error::other("this build of spindrift has no object stores");
        let connected = connect().ok_or_else(none).and_then(|connect| connect(&address));
        connected.map_err(at(root)).map_err(WorkflowError::files)
    }

    /// Sets the number of threads.
    #[must_use]
    pub fn on_threads(self, threads: Option<NonZeroUsize>) -> Self {
        Session { threads, ..self }
    }

    /// Sets the program's law for campaigns and results.
    #[must_use]
    pub fn under(self, law: &'a OwnLaw) -> Self {
        Session { law: Some(law), ..self }
    }

    /// Overrides with the program's law.
    pub(super) fn overrides(&self) -> Overrides {
        Overrides { law: self.law.cloned(), ..Overrides::default() }
    }

    /// Number of threads that read files.
    pub(super) fn readers(&self) -> usize {
        threads(self.threads, usize::MAX)
    }

    /// Supervision of runs; `progress` receives numbers of ended ones.
    pub(super) fn supervision<'s>(&'s self, progress: &'s (dyn Fn(u64) + Sync)) -> Supervision<'s> {
        Supervision { progress, stop: self.watch.stop(), abandon: self.watch.abandon(), crew: self.crew }
    }
}

/// The instruction set of this process.
///
/// # Errors
/// An unknown or unavailable one in the environment.
pub fn isa() -> Result<Isa> {
    Isa::chosen().map_err(|value| {
        let names: Vec<&str> = Isa::available().iter().map(|isa| isa.name()).collect();
        WorkflowError::Input(format!("{VARIABLE}={value}: must be one of {}, or unset", names.join(", ")))
    })
}
