//! [`Campaign`]: a campaign file, its overrides and the place of its result; runs missing samples.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use crate::campaign::{FilesRead, Plan};
use crate::control::tables::Overrides;
use crate::ensemble::Ensemble;
use crate::storage::claim::{Claim, Shard};
use crate::storage::store::Store;
use crate::workflow::error::{Result, WorkflowError};
use crate::workflow::failed_samples::plan_of_failed;
use crate::workflow::finishing::{Job, Outputs, already, keep};
use crate::workflow::outcome::CampaignOutcome;
use crate::workflow::results::Results;
use crate::workflow::running::run_missing;
use crate::workflow::session::Session;
use crate::workflow::source::{claimed, plan_and_files, refuse_missing_law};
use crate::workflow::workload::Workload;

/// Default folder of results, in the current folder.
pub const RESULTS: &str = "results";

#[derive(Clone)]
pub struct Campaign<'a> {
    session: Session<'a>,
    file: PathBuf,
    /// The text of the file, unless it is read from disk.
    text: Option<String>,
    overrides: Overrides,
    root: Option<PathBuf>,
    shard: Option<Shard>,
    only_failed_of: Option<PathBuf>,
    overwrite: bool,
    fail_fast: bool,
    outputs: Outputs,
}

impl<'a> Campaign<'a> {
    /// The campaign of `file`, possibly without folder and extension.
    pub fn from_file(file: impl Into<PathBuf>, session: Session<'a>) -> Self {
        let overrides = session.overrides();
        Campaign {
            session,
            file: file.into(),
            text: None,
            overrides,
            root: None,
            shard: None,
            only_failed_of: None,
            overwrite: false,
            fail_fast: false,
            outputs: Outputs::default(),
        }
    }

    /// The campaign described by `text`; `name` is its file in messages.
    pub fn from_text(name: &str, text: &str, session: Session<'a>) -> Self {
        Campaign { text: Some(text.to_owned()), ..Self::from_file(name, session) }
    }

    /// Overrides the values of the file.
    #[must_use]
    pub fn with(mut self, overrides: Overrides) -> Self {
        self.overrides = Overrides { law: self.overrides.law, ..overrides };
        self
    }

    /// Overrides a key, named as in error messages: `("wheels.w1.rate_rad_s", "20 rpm")`.
    #[must_use]
    pub fn set(mut self, key: &str, value: &str) -> Self {
        self.overrides.settings.push((key.to_owned(), value.to_owned()));
        self
    }

    /// Overrides the number of samples.
    #[must_use]
    pub fn samples(mut self, samples: u64) -> Self {
        self.overrides.samples = Some(samples);
        self
    }

    /// Overrides the seed.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.overrides.seed = Some(seed);
        self
    }

    /// Overrides the audited fraction of the samples.
    #[must_use]
    pub fn audit(mut self, fraction: f64) -> Self {
        self.overrides.audit_fraction = Some(fraction);
        self
    }

    /// Stores the result in the folder `root` or at `s3://bucket/name`, instead of [`RESULTS`] under the campaign's
    /// name.
    #[must_use]
    pub fn store(mut self, root: impl Into<PathBuf>) -> Self {
        self.root = Some(root.into());
        self
    }

    /// Replaces an existing result.
    #[must_use]
    pub fn overwrite(mut self) -> Self {
        self.overwrite = true;
        self
    }

    /// Runs only the parts of one of several processes; [`super::finish`] then finishes.
    #[must_use]
    pub fn shard(mut self, shard: Shard) -> Self {
        self.shard = Some(shard);
        self
    }

    /// Runs only the samples that failed in the result `of`, with its seed and number of samples.
    #[must_use]
    pub fn only_failed_of(mut self, of: impl Into<PathBuf>) -> Self {
        self.only_failed_of = Some(of.into());
        self
    }

    /// Ends after the first part with a failed run.
    #[must_use]
    pub fn fail_fast(mut self) -> Self {
        self.fail_fast = true;
        self
    }

    /// Writes these files besides tables and summary.
    #[must_use]
    pub fn outputs(mut self, outputs: Outputs) -> Self {
        self.outputs = outputs;
        self
    }

    /// Reads and checks the file; `None` if [`Campaign::only_failed_of`] finds no failed run.
    ///
    /// # Errors
    /// A wrong file, or an unusable result with failed samples.
    pub fn prepare(self) -> Result<Option<PreparedCampaign<'a>>> {
        let found = match (&self.only_failed_of, &self.text) {
            (None, Some(text)) => Some(Plan::from_text_of(&self.file, text, self.overrides.clone())?),
            (None, None) => Some(plan_and_files(&self.file, self.overrides.clone())?),
            (Some(of), _) => plan_of_failed(&self.session, &self.file, of, self.overrides.clone())?,
        };
        let Some((plan, files)) = found else { return Ok(None) };
        if let Some(Shard { number, of }) = self.shard {
            refuse_shards_with_stop(&plan, &format!("--shard {number}/{of}"))?;
        }
        let root = self.root.clone().unwrap_or_else(|| PathBuf::from(RESULTS).join(&plan.name));
        let store = self.session.store(&root)?;
        if self.overwrite && !store.replaces() {
            return Err(WorkflowError::Input(format!(
                "--overwrite: must be left out for {}: what is in a store is not replaced; choose another --out",
                root.display()
            )));
        }
        Ok(Some(PreparedCampaign { campaign: self, plan, files, root, store, counted: Arc::default() }))
    }

    /// Runs missing samples, and opens the finished result.
    ///
    /// # Errors
    /// A campaign that cannot run or does not finish: of a shard, after a stop, without failed samples.
    pub fn results(self) -> Result<Results<'a>> {
        let session = self.session;
        let unfinished = |what: &str| WorkflowError::Input(format!("{what}: there is no finished result"));
        let Some(prepared) = self.prepare()? else { return Err(unfinished("no run failed")) };
        let root = prepared.root.clone();
        match prepared.run()? {
            CampaignOutcome::Finished(_) | CampaignOutcome::AlreadyFinished(_) => Results::open(root, session),
            CampaignOutcome::ShardDone { .. } => Err(unfinished("a shard alone was run")),
            CampaignOutcome::Stopped { .. } | CampaignOutcome::FailedFast(_) => {
                Err(unfinished("the campaign was stopped"))
            }
        }
    }
}

/// A campaign with its plan.
pub struct PreparedCampaign<'a> {
    campaign: Campaign<'a>,
    plan: Plan,
    files: FilesRead,
    root: PathBuf,
    store: Arc<dyn Store>,
    /// Time of a run, s, once it is known.
    counted: Arc<OnceLock<f64>>,
}

impl PreparedCampaign<'_> {
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The files behind the plan.
    pub fn files(&self) -> &FilesRead {
        &self.files
    }

    /// The folder or address of the result.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The plan ready to run.
    pub fn ensemble(&self) -> Ensemble<'_> {
        Ensemble::new(&self.plan, self.campaign.session.isa).counted_in(self.counted.clone())
    }

    /// Refuses impossible work, and without `yes` long work or most of the disk.
    ///
    /// # Errors
    /// The refusal, with the numbers and the remedy.
    pub fn refuse_work(&self, yes: bool) -> Result<()> {
        let Campaign { session, shard, overwrite, .. } = &self.campaign;
        let (plan, root, ensemble) = (&self.plan, &*self.root, self.ensemble());
        let there = Some(&*self.store).filter(|_| !overwrite);
        let work =
            |samples| Workload::of_campaign((&ensemble, samples), there, *shard, session.threads).measured(&ensemble);
        if let [first, .., last] = plan.looks()[..] {
            work(first).check(root, yes, shard.is_some())?;
            work(last).check_limit(root, yes)
        } else {
            work(plan.rows()).check(root, yes, shard.is_some())
        }
    }

    /// Runs missing samples: all, those left by an interruption, or those of a larger campaign.
    ///
    /// # Errors
    /// A result that must not be replaced, or a failed file operation.
    pub fn run(&self) -> Result<CampaignOutcome> {
        refuse_missing_law(&self.plan)?;
        let Campaign { session, shard, overwrite, fail_fast, outputs, .. } = &self.campaign;
        let (ensemble, root) = (self.ensemble(), &*self.root);
        let ready = match claimed(session, &self.store, &ensemble, (*overwrite, *shard))? {
            Claim::Finished(finished) => {
                let junit = outputs.junit.as_deref().filter(|_| shard.is_none());
                return already(session, root, &self.plan, finished, junit).map(CampaignOutcome::AlreadyFinished);
            }
            Claim::Ready(ready) => *ready,
        };
        keep(&ready, &self.files)?;
        let (session, ensemble, ready) = (*session, &ensemble, &ready);
        run_missing(&Job { session, ensemble, ready, root, outputs, shard: *shard, fail_fast: *fail_fast })
    }
}

/// Refuses `what`, which divides the campaign into shards, for a plan with `[stop]`.
///
/// # Errors
/// If the plan has `[stop]`.
pub fn refuse_shards_with_stop(plan: &Plan, what: &str) -> Result<()> {
    match plan.analysis.stop {
        None => Ok(()),
        Some(_) => Err(WorkflowError::Input(format!(
            "{what}: must be left out with [stop], which looks at all samples before it runs more; delete [stop], or \
            run without shards"
        ))),
    }
}
