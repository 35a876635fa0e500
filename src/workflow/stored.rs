//! [`Stored`]: a result in an object store, and the folder of this machine in which it is worked on: there a campaign
//! runs as in any folder, and what it has finished is put into the store; and what commands read is a copy there
//! ([`fetched`]).

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::campaign::{CampaignError, FilesRead, Plan};
use crate::ensemble::Ensemble;
use crate::ensemble::run_cost::parts;
use crate::storage::claim::{Claim, ClaimOptions, Ready, Shard, claim, lock};
use crate::storage::disk::{StorageError, new_folder};
use crate::storage::identity::sha256;
use crate::storage::manifest::PartRecord;
use crate::storage::names::{DATA, PLAN};
use crate::storage::remote::connection::connect;
use crate::storage::remote::{Address, Fault, Remote, head_of};
use crate::storage::rows_file::identity;
use crate::workflow::error::WorkflowError;
use crate::workflow::session::Session;
use crate::workflow::source::data_copies;

/// The variable of the environment that names the folder of working folders.
pub const VARIABLE: &str = "SPINDRIFT_CACHE";
/// That folder, where the variable is not set.
const WORKING_FOLDERS: &str = "results/s3";

/// A result in an object store.
pub(super) struct Stored<'a> {
    session: Session<'a>,
    remote: Remote,
    /// The folder of this machine. Its name follows from what the rows are, so that the same plan has the same one,
    /// whatever the address.
    root: PathBuf,
}

/// The address that `path` is; `None` of a folder.
pub(super) fn address(path: &Path) -> Result<Option<Address>, WorkflowError> {
    Address::of(path, connect().is_some()).map_err(WorkflowError::Input)
}

/// The folder of this machine for rows with the first object `head`.
fn working_folder(head: &str) -> PathBuf {
    let base = std::env::var_os(VARIABLE).filter(|folder| !folder.is_empty());
    base.map_or_else(|| PathBuf::from(WORKING_FOLDERS), PathBuf::from).join(&sha256(head.as_bytes())[..16])
}

/// The folder in which the result `path` can be read: itself, or a copy of what is at an address.
///
/// # Errors
/// Where there is no result at the address, an object is damaged or missing, or a request or a file operation fails.
pub(super) fn fetched<'p>(session: &Session<'_>, path: &'p Path) -> Result<Cow<'p, Path>, WorkflowError> {
    let Some(address) = address(path)? else { return Ok(Cow::Borrowed(path)) };
    let stored = Stored::there(session, address)?;
    stored.fetch(false)?;
    Ok(Cow::Owned(stored.root))
}

impl<'a> Stored<'a> {
    /// The result of `ensemble` at `address`, which may not be there yet.
    pub fn of(session: &Session<'a>, address: Address, ensemble: &Ensemble<'_>) -> Result<Self, WorkflowError> {
        let remote = Remote::open(address).map_err(WorkflowError::files)?;
        let root = working_folder(&head_of(&ensemble.plan().text(), &identity(ensemble)));
        Ok(Stored { session: *session, remote, root })
    }

    /// The result at `address`.
    pub fn there(session: &Session<'a>, address: Address) -> Result<Self, WorkflowError> {
        let remote = Remote::open(address).map_err(WorkflowError::files)?;
        // an address without a result is a wrong argument, as a folder without one
        let (identity, plan) = remote.origin().map_err(|error| match error.source.kind() {
            std::io::ErrorKind::NotFound => WorkflowError::Input(error.to_string()),
            _ => WorkflowError::files(error),
        })?;
        Ok(Stored { session: *session, remote, root: working_folder(&head_of(&plan, &identity)) })
    }

    /// Its folder on this machine.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Copies what is there to the folder: the whole result, or the parts of one that is not finished; whether it is
    /// whole. With `afresh`, every object of a whole result is got and compared.
    ///
    /// # Errors
    /// Where an object is damaged or missing, or a request or a file operation fails.
    pub fn fetch(&self, afresh: bool) -> Result<bool, WorkflowError> {
        let (session, storage) = (&self.session, self.session.storage);
        if self.remote.is_whole().map_err(WorkflowError::files)? {
            let faults = self.copied(afresh)?;
            if !faults.is_empty() {
                return Err(self.faulty(&faults));
            }
            self.note(&format!("copied to {}", self.root.display()));
            return Ok(true);
        }
        self.remote.unpack(storage, &self.root).map_err(WorkflowError::files)?;
        let (_, text) = self.remote.origin().map_err(WorkflowError::files)?;
        let plan = Plan::from_text_of(&self.root.join(PLAN), &text, session.overrides());
        let unusable = |error: CampaignError| {
            let address = self.remote.address();
            WorkflowError::Files(format!("{address}: its plan cannot be used\n{}", error.with_excerpts()))
        };
        let (plan, _) = plan.map_err(unusable)?;
        let rows = identity(&Ensemble::new(&plan, session.isa));
        let options = ClaimOptions { overwrite: false, shard: None, threads: session.readers() };
        let claimed = claim(storage, &self.root, (&plan, &rows), options).map_err(WorkflowError::files)?;
        if let Claim::Ready(ready) = claimed {
            self.remote.pull(&ready.folder, &|_| true).map_err(WorkflowError::files)?;
        }
        self.note(&format!("not finished; its parts are copied to {}", self.root.display()));
        Ok(false)
    }

    /// Makes the store's rows those of `ensemble`. Where everything is there, it is compared and copied to the folder;
    /// whether nothing is to be put.
    ///
    /// # Errors
    /// Where the store has other rows, an object is damaged, or a request or a file operation fails.
    pub fn begin(&self, ensemble: &Ensemble<'_>, files: &FilesRead) -> Result<bool, WorkflowError> {
        let (plan, rows) = (ensemble.plan(), identity(ensemble));
        if self.remote.is_new(plan, &rows).map_err(WorkflowError::files)? {
            // whoever finds the plan finds what it names
            for copy in data_copies(files) {
                let (name, bytes) = copy?;
                self.remote.put(&format!("{DATA}/{name}"), &bytes).map_err(WorkflowError::files)?;
            }
            self.remote.begin(plan, &rows).map_err(WorkflowError::files)?;
        }
        self.note(&format!("the working folder is {}", self.root.display()));
        if !self.remote.is_whole().map_err(WorkflowError::files)? {
            return Ok(false);
        }
        let faults = self.copied(true)?;
        if !faults.iter().all(|fault| fault.is_absent) {
            return Err(self.faulty(&faults));
        }
        // what was removed is put again
        faults.iter().for_each(|fault| self.note(&format!("{}: missing, put again", fault.object)));
        Ok(faults.is_empty())
    }

    /// Adds the parts that are in the store to the folder, of a shard its own, and puts those into the store that only
    /// the folder has.
    ///
    /// # Errors
    /// Where the store has another content, or a request or a file operation fails.
    pub fn join(&self, ensemble: &Ensemble<'_>, ready: &mut Ready, shard: Option<Shard>) -> Result<(), WorkflowError> {
        let is_mine = |part| shard.is_none_or(|shard: Shard| part % shard.of == shard.number - 1);
        ready.rows += self.remote.pull(&ready.folder, &is_mine).map_err(WorkflowError::files)?;
        let parts = ready.folder.parts();
        let mut mine = parts.iter().filter(|part| is_mine(part.part));
        mine.try_for_each(|part| self.put(ensemble, part)).map_err(WorkflowError::files)
    }

    /// Puts a part that is in the folder, unless it may still get further rows.
    ///
    /// # Errors
    /// Where the store has another content, or a request or a file operation fails.
    pub fn put(&self, ensemble: &Ensemble<'_>, part: &PartRecord) -> Result<(), StorageError> {
        let plan = ensemble.plan();
        let endless = parts(plan, ensemble.isa()).with_samples(u64::MAX);
        let is_final = plan.analysis.stop.is_none()
            || endless.part(part.samples().id).is_some_and(|whole| whole == part.samples());
        if is_final { self.remote.put_part(self.session.storage, &self.root, part) } else { Ok(()) }
    }

    /// Puts everything of the finished result in the folder that is not there yet.
    ///
    /// # Errors
    /// Where the store has another content, or a request or a file operation fails.
    pub fn publish(&self) -> Result<(), WorkflowError> {
        self.remote.publish(self.session.storage, &self.root).map_err(WorkflowError::files)?;
        self.note("everything is there");
        Ok(())
    }

    /// Makes the folder a copy of the whole result; what is wrong with its objects.
    fn copied(&self, afresh: bool) -> Result<Vec<Fault>, WorkflowError> {
        new_folder(self.session.storage, &self.root).map_err(WorkflowError::files)?;
        let _locks = lock(self.session.storage, &self.root).map_err(WorkflowError::files)?;
        self.remote.copy_to(self.session.storage, &self.root, afresh).map_err(WorkflowError::files)
    }

    /// That objects are not what was put.
    fn faulty(&self, faults: &[Fault]) -> WorkflowError {
        let what = |fault: &Fault| {
            format!("\n  {}: {}", fault.object, if fault.is_absent { "missing" } else { "its content has changed" })
        };
        WorkflowError::Files(format!(
            "{}: objects are not what was put; remove those that have changed, and the campaign's command with this \
            --out puts them again{}",
            self.remote.address(),
            faults.iter().map(what).collect::<String>()
        ))
    }

    fn note(&self, text: &str) {
        self.session.watch.note(&format!("{}: {text}", self.remote.address()));
    }
}
