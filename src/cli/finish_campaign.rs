//! `spindrift finish`: derives the result from the complete rows of a campaign.

use crate::cli::arguments::FinishOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::terminal::Terminal;
use crate::cli::{completed_text, screen};
use crate::findings::shell_word::quoted_path;
use crate::storage::names::PLAN;
use crate::table::wrapped::wrapped;
use crate::workflow::finishing::finish;
use crate::workflow::outputs::{refuse_inputs, refuse_within};
use crate::workflow::{Finished, Session};

pub fn run(options: &FinishOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let root = &options.folder;
    let (outputs, named) = (options.written.outputs(), options.written.named());
    let finished = finish(&Session::new(&watch)?.on_threads(options.threads.number), root, &outputs, &|files| {
        refuse_inputs(&files.paths(), &named[..1])?;
        refuse_within(root, &named)
    })?;
    let (outcome, text) = match finished {
        Finished::Now(completed) => (
            CommandOutcome::of_end(&completed.end),
            completed_text::text(&completed, &quoted_path(&root.join(PLAN)), options.verbose),
        ),
        Finished::Already(end) => (
            CommandOutcome::of_end(&end),
            wrapped(&format!("{}: already finished, every checksum verified\n", root.display()), screen::width())
                + &completed_text::of_end(&end, root),
        ),
    };
    screen::print(&text)?;
    Ok(outcome)
}
