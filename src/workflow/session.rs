//! [`Session`]: with what all work on campaigns and results is done; [`Watch`]: who is told of it, and may stop it.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, OnceLock};

use super::error::WorkflowError;
use crate::campaign::Overrides;
use crate::control::ControlLaw;
use crate::control::laws::LawKind;
use crate::ensemble::Supervision;
use crate::ensemble::runner::threads;
use crate::ensemble::supervision::{Alone, Crew};
use crate::math::Isa;
use crate::math::isa::VARIABLE;
use crate::storage::address::Address;
use crate::storage::disk::{folder, meant};
use crate::storage::store::{OpenFolder, Store, at};

/// Is told what happens, and may stop it; called from any thread.
pub trait Watch: Sync {
    /// What a person should know: damage that was found, samples that are there already, looks of `[stop]`.
    fn note(&self, _text: &str) {}

    /// Runs of so many samples begin.
    fn begin(&self, _samples: u64) {}

    /// So many more of them have ended.
    fn advance(&self, _samples: u64) {}

    /// No further run is made.
    fn end(&self) {}

    /// No further part is started once this is set; what is committed stays, and the same campaign continues.
    fn stop(&self) -> &AtomicBool;

    /// Parts under way are given up once this is set.
    fn abandon(&self) -> &AtomicBool;
}

/// Tells nobody, and lets everything end.
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
/// Where the environment does not say how to get there, or the store does not answer, or refuses.
pub type Connect = fn(&Address) -> std::io::Result<Arc<dyn Store>>;

static CONNECT: OnceLock<Connect> = OnceLock::new();

/// Makes `connect` the client of this process, where the build has none of its own: so the Python package has object
/// stores and the library of the program, compiled once.
pub fn connect_by(connect: Connect) {
    let _ = CONNECT.set(connect);
}

/// How this process connects to a store, where it can.
pub fn connect() -> Option<Connect> {
    #[cfg(feature = "cloud")]
    return Some(crate::storage::s3::connect);
    #[cfg(not(feature = "cloud"))]
    CONNECT.get().copied()
}

/// With what work is done.
#[derive(Clone, Copy)]
pub struct Session<'a> {
    /// Opens folders of results.
    pub folders: &'a OpenFolder<'a>,
    pub isa: Isa,
    /// How many threads run and read; `None`: one per core.
    pub threads: Option<NonZeroUsize>,
    /// The control law that the program brings, for campaigns that fly one.
    pub law: Option<&'a ControlLaw>,
    /// The law of attitude that the program brings, for phases that name it.
    pub attitude_law: Option<&'static LawKind>,
    /// How each thread does its share of a campaign.
    pub crew: &'a dyn Crew,
    pub watch: &'a dyn Watch,
}

impl<'a> Session<'a> {
    /// The disk, all cores, no control law; `watch` is told.
    ///
    /// # Errors
    /// Where the environment names an instruction set that is not available.
    pub fn new(watch: &'a dyn Watch) -> Result<Self, WorkflowError> {
        let isa = isa()?;
        Ok(Session { folders: &folder, isa, threads: None, law: None, attitude_law: None, crew: &Alone, watch })
    }

    /// The place of a result: a folder, or an address `s3://bucket/name` of an object store.
    ///
    /// # Errors
    /// Where it is no address, or the store cannot be reached.
    pub fn store(&self, root: &Path) -> Result<Arc<dyn Store>, WorkflowError> {
        let Some(address) = Address::of(root, connect().is_some()).map_err(WorkflowError::Input)? else {
            let root = meant(root).map_err(at(root))?;
            return Ok((self.folders)(&root));
        };
        let none = || std::io::Error::other("this build of spindrift has no object stores");
        let connected = connect().ok_or_else(none).and_then(|connect| connect(&address));
        connected.map_err(at(root)).map_err(WorkflowError::files)
    }

    /// The same on so many threads.
    #[must_use]
    pub fn on_threads(self, threads: Option<NonZeroUsize>) -> Self {
        Session { threads, ..self }
    }

    /// The same for campaigns that fly `law`, and their results.
    #[must_use]
    pub fn under(self, law: &'a ControlLaw) -> Self {
        Session { law: Some(law), ..self }
    }

    /// What plans are read with: the laws that the program brings.
    pub(super) fn overrides(&self) -> Overrides {
        Overrides { law: self.law.cloned(), attitude_law: self.attitude_law, ..Overrides::default() }
    }

    /// The number of threads that read files.
    pub(super) fn readers(&self) -> usize {
        threads(self.threads, usize::MAX)
    }

    /// What runs are told; `progress` is told how many have ended.
    pub(super) fn supervision<'s>(&'s self, progress: &'s (dyn Fn(u64) + Sync)) -> Supervision<'s> {
        Supervision { progress, stop: self.watch.stop(), abandon: self.watch.abandon(), crew: self.crew }
    }
}

/// The instruction set of this process.
///
/// # Errors
/// Where the environment names one that does not exist or is not available.
pub fn isa() -> Result<Isa, WorkflowError> {
    Isa::chosen().map_err(|value| {
        let names: Vec<&str> = Isa::available().iter().map(|isa| isa.name()).collect();
        WorkflowError::Input(format!("{VARIABLE}={value}: must be one of {}, or unset", names.join(", ")))
    })
}
