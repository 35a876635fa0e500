//! [`CampaignOutcome`]: how a campaign ended; [`again`]: the same of a finished result.

use std::path::{Path, PathBuf};

use crate::findings::end::SummaryEnd;
use crate::findings::findings;
use crate::report::summary;
use crate::storage::claim::Shard;
use crate::storage::names::REPORT;
use crate::workflow::analysed::end_of_analysed;
use crate::workflow::error::WorkflowError;
use crate::workflow::failed_samples::FailedRun;
use crate::workflow::finishing::{Completed, Made};
use crate::workflow::results::Results;

/// How a campaign ended that could run.
#[derive(Clone, Debug)]
pub enum CampaignOutcome {
    /// All rows are there, and so is everything that follows from them.
    Finished(Box<Completed>),
    /// Everything of the same plan was there already.
    AlreadyFinished(SummaryEnd),
    /// The parts of a shard are there.
    ShardDone {
        shard: Shard,
        /// What this process has run.
        made: Made,
    },
    /// It was stopped; the same campaign continues.
    Stopped {
        samples: u64,
        /// Samples that are not there yet.
        left: u64,
    },
    /// A run failed, where that ends the campaign.
    FailedFast(FailedRun),
}

/// Where a reader of the result in `root` goes: its page, where there is one.
pub fn place(root: &Path) -> PathBuf {
    Some(root.join(REPORT)).filter(|page| page.is_file()).unwrap_or_else(|| root.to_owned())
}

/// What a result was when it was finished, and the text of its summary.
pub fn again(results: &Results<'_>) -> Result<(Completed, String), WorkflowError> {
    let (plan, analysed) = (results.plan(), results.analysed()?);
    let findings = findings(plan, &analysed, &[]);
    let summary = summary::json(plan, &analysed, &findings);
    let completed = Completed {
        plan: plan.clone(),
        root: results.root().to_owned(),
        end: end_of_analysed(&analysed, &findings),
        findings,
        made: None,
        is_audited: analysed.tally.audits.is_some(),
        files: results.parts().len(),
        bytes: results.parts().iter().flat_map(|part| &part.files).map(|file| file.bytes).sum(),
    };
    Ok((completed, summary))
}
