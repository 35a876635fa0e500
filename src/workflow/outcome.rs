//! [`CampaignOutcome`]: the end of a campaign; [`again`]: of a finished result.

use std::path::{Path, PathBuf};

use crate::findings::end::SummaryEnd;
use crate::findings::findings;
use crate::report::summary;
use crate::storage::claim::Shard;
use crate::storage::names::REPORT;
use crate::workflow::error::Result;
use crate::workflow::failed_samples::FailedRun;
use crate::workflow::finishing::{Completed, Made};
use crate::workflow::results::Results;

/// The end of a campaign that could run.
#[derive(Clone, Debug)]
pub enum CampaignOutcome {
    /// Complete, with everything that follows.
    Finished(Box<Completed>),
    /// Complete before.
    AlreadyFinished(SummaryEnd),
    /// The parts of a shard are complete.
    ShardDone {
        shard: Shard,
        /// The work of this process.
        made: Made,
    },
    /// Stopped; the same campaign continues.
    Stopped {
        samples: u64,
        /// Missing samples.
        left: u64,
    },
    /// A failed run ended the campaign.
    FailedFast(FailedRun),
}

/// The path at which to read the result in `root`: its page, if any.
pub fn place(root: &Path) -> PathBuf {
    Some(root.join(REPORT)).filter(|page| page.is_file()).unwrap_or_else(|| root.to_owned())
}

/// The end of a finished result, with the text of its summary.
pub fn again(results: &Results<'_>) -> Result<(Completed, String)> {
    let (plan, analysed) = (results.plan(), results.analysed()?);
    let findings = findings(plan, &analysed, &[]);
    let summary = summary::json(plan, &analysed, &findings);
    Ok((Completed::of(plan, results.root(), (&analysed, findings), results.parts(), None), summary))
}
