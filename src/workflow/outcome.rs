//! [`CampaignOutcome`]: how a campaign ended.

use crate::report::summary::SummaryEnd;
use crate::storage::claim::Shard;
use crate::workflow::failed_samples::FailedRun;
use crate::workflow::finishing::{Completed, Made};

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
