//! [`CampaignSource`]: what a campaign is made from. It is read whenever it is used, as the command line reads it.

use std::path::PathBuf;

use spindrift::campaign::Overrides;
use spindrift::workflow::{Campaign, PreparedCampaign, Session, WorkflowError};

/// The name of a campaign from a dict in messages.
const DICT: &str = "dict";

/// A campaign file, or the text of one, and what is changed of it.
#[derive(Clone)]
pub struct CampaignSource {
    file: PathBuf,
    text: Option<String>,
    /// Dotted keys and their values as TOML.
    pub settings: Vec<(String, String)>,
}

impl CampaignSource {
    pub fn of_file(file: PathBuf) -> Self {
        CampaignSource { file, text: None, settings: Vec::new() }
    }

    pub fn of_text(text: String) -> Self {
        CampaignSource { file: PathBuf::from(DICT), text: Some(text), settings: Vec::new() }
    }

    /// The campaign, with so many samples.
    pub fn campaign<'a>(&self, session: Session<'a>, samples: Option<u64>) -> Campaign<'a> {
        let campaign = match &self.text {
            Some(text) => Campaign::from_text(DICT, text, session),
            None => Campaign::from_file(&self.file, session),
        };
        campaign.with(Overrides { samples, settings: self.settings.clone(), ..Overrides::default() })
    }
}

/// The file of `campaign`, read and checked.
///
/// # Errors
/// Where it is wrong.
pub fn prepared(campaign: Campaign<'_>) -> Result<PreparedCampaign<'_>, WorkflowError> {
    let nothing = || WorkflowError::Input("no run failed; nothing to do".to_owned());
    campaign.prepare()?.ok_or_else(nothing)
}
