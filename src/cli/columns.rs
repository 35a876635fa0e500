//! `spindrift columns`: the columns of the rows, by group, with unit and meaning.

use std::path::Path;

use crate::campaign::meaning::meant;
use crate::cli::arguments::ColumnsOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::control::tables::Overrides;
use crate::findings::shell_word::quoted_path;
use crate::observables::Group;
use crate::table::Table;
use crate::table::text::Align;
use crate::workflow::columns::{AUDIT, CONTROL, ListedColumn, SAMPLE, by_group, found, of_all_campaigns, of_campaign};
use crate::workflow::source::plan_and_files;

pub fn run(options: &ColumnsOptions) -> Result<CommandOutcome, Failure> {
    let all = match &options.campaign {
        None => of_all_campaigns(),
        Some(file) => of_campaign(&plan_and_files(file, Overrides::default())?.0)?,
    };
    let shown = match &options.word {
        None if options.verbose => text(&all),
        None => groups(&all, options.campaign.as_deref()),
        Some(word) => text(&found(&all, word).ok_or_else(|| {
            let groups: Vec<&str> = by_group(&all).map(|columns| columns[0].group.as_str()).collect();
            let words = all.iter().map(|column| column.quantity.name());
            let meant = meant(word, words.chain(groups.iter().copied()));
            let meant = meant.map_or(String::new(), |meant| format!("; did you mean {}?", meant.name));
            Failure::Input(format!(
                "{word}: must be a group ({}) or a word in a column's name or meaning{meant}",
                groups.join(", ")
            ))
        })?),
    };
    screen::print(&shown)?;
    Ok(CommandOutcome::Done)
}

/// The groups with their sizes, subjects and prerequisites.
fn groups(all: &[ListedColumn], campaign: Option<&Path>) -> String {
    let heads = [("group", Align::Left), ("columns", Align::Right), ("what they are about", Align::Sentence)];
    let mut table = Table::with(heads);
    for columns in by_group(all) {
        let title = &columns[0].group;
        let (about, needs) = about(title);
        // a campaign fulfils the prerequisites
        let needs = if needs.is_empty() || campaign.is_some() { String::new() } else { format!(" ({needs})") };
        table.row([title.clone(), columns.len().to_string(), about.to_owned() + &needs]);
    }
    let of = campaign.map_or(String::new(), |file| format!(" --campaign {}", quoted_path(file)));
    let mut examples = Table::with([("", Align::Title), ("", Align::Sentence)]);
    for (word, says) in [
        ("momentum_conservation", "that group: names, units, meanings"),
        ("pointing", "every column with that word"),
        ("--verbose", "all of them"),
    ] {
        examples.row([format!("spindrift columns {word}{of}"), says.to_owned()]);
    }
    format!("{}{} columns in all\n\n{}", table.text(screen::width()), all.len(), examples.text(screen::width()))
}

fn about(title: &str) -> (&'static str, &'static str) {
    let Some(group) = Group::from_name(title) else {
        return match title {
            SAMPLE => ("number, status, every dispersed value", ""),
            AUDIT => ("errors against a reference solution", ""),
            title if [CONTROL, Group::Control.name()].contains(&title) => {
                ("pointing, phases, launch, filter", "[control]")
            }
            _ => ("when events and failures happened", ""),
        };
    };
    match group {
        Group::EnergyConservation => ("errors of the energy balance", ""),
        Group::MomentumConservation => ("errors of linear and angular momentum", ""),
        Group::Attitude => ("orthonormality; angle of s3 from its start", ""),
        Group::Constraints => ("constraint residuals", "method null_space"),
        Group::Energies => ("kinetic energy of each body in F_e", ""),
        Group::EnergiesCom => ("the same about the centre of mass", ""),
        Group::Exchange => ("energy of body and wheels", "wheels that turn"),
        Group::FinalState => ("the state at the end", ""),
        Group::StepStatistics => ("steps and evaluations of the integrator", ""),
        Group::Numerics => ("estimated numerical errors", ""),
        Group::Motion => ("rates, nutation, speeds", NAMED),
        Group::MassProperties => ("mass, principal moments", NAMED),
        Group::Orbit => ("distance, nadir, torques", NAMED),
        Group::Control | Group::Events => ("", ""),
    }
}

/// Prerequisite of groups that are not observed by default.
const NAMED: &str = "in observe.groups";

fn text(all: &[ListedColumn]) -> String {
    let section = |columns: &[ListedColumn]| {
        let mut table = Table::with([("", Align::Left), ("", Align::Left), ("", Align::Sentence)]);
        for ListedColumn { quantity, only, .. } in columns {
            let needs = if only.is_empty() { String::new() } else { format!(" ({only})") };
            table.row([quantity.name(), quantity.unit(), &(quantity.meaning().to_owned() + &needs)]);
        }
        format!("{}\n{}", columns[0].group, table.text(screen::width()))
    };
    by_group(all).map(section).collect::<Vec<_>>().join("\n")
}
