//! `spindrift compare`: compares two results.

use crate::cli::arguments::CompareOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::cli::terminal::Terminal;
use crate::findings::comparison::findings;
use crate::report::screen::{LINES, list};
use crate::workflow::compared::{ComparisonFormat, compared};
use crate::workflow::outputs::refuse_within;
use crate::workflow::{Results, Session};

pub fn run(options: &CompareOptions) -> Result<CommandOutcome, Failure> {
    let watch = Terminal::default();
    let session = Session::new(&watch)?.on_threads(options.threads.number);
    let format = options.out.as_deref().map(ComparisonFormat::of).transpose()?;
    let roots = [&options.first, &options.second];
    for root in roots {
        refuse_within(root, &[("--out", options.out.as_deref())])?;
    }
    let (first, second) = (Results::open(roots[0], session)?, Results::open(roots[1], session)?);
    let mut found = compared([&first, &second], roots.map(|root| root.display().to_string()))?;
    (found.tolerance, found.is_strict) = (options.tolerance, options.strict);
    if let Some((path, format)) = options.out.as_deref().zip(format) {
        format.write(&found, path)?;
    }
    screen::print(&list(&findings(&found), options.verbose, [LINES, screen::width()]))?;
    Ok(match found.failed() {
        0 => CommandOutcome::Done,
        failed => CommandOutcome::RequirementsFailed(failed),
    })
}
