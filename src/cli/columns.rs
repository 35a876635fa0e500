//! `spindrift columns`: the groups of columns of the rows of a result, and the columns with unit and meaning.

use std::path::Path;

use crate::campaign::meaning::meant;
use crate::campaign::{Overrides, Plan};
use crate::cli::arguments::ColumnsOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::control::outcome::columns::OutcomeColumns;
use crate::ensemble::Ensemble;
use crate::findings::shell_word::quoted_path;
use crate::observables::{Group, table};
use crate::run::Quantity;
use crate::storage::rows_file;
use crate::table::text::Align;
use crate::table::{Column, Table};
use crate::workflow::isa;
use crate::workflow::source::plan;

/// A column that a row may have.
#[derive(Clone, Debug)]
pub struct ListedColumn {
    /// Its group, or what else it has in common with those beside it.
    pub group: String,
    pub quantity: Quantity,
    /// The scenes that have it; empty for all.
    pub only: &'static str,
}

/// The columns of a group, in their order.
fn by_group(all: &[ListedColumn]) -> impl Iterator<Item = &[ListedColumn]> {
    all.chunk_by(|one, next| one.group == next.group)
}

/// Runs the command.
///
/// # Errors
/// Where the campaign file is wrong, or does not observe the group.
pub fn run(options: &ColumnsOptions) -> Result<CommandOutcome, Failure> {
    let all = match &options.campaign {
        None => of_all_campaigns(),
        Some(file) => of_campaign(&plan(file, Overrides::default())?)?,
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

/// The groups: how many columns each has, what they are about, and what they need.
fn groups(all: &[ListedColumn], campaign: Option<&Path>) -> String {
    let heads = [("group", Align::Left), ("columns", Align::Right), ("what they are about", Align::Sentence)];
    let mut table = Table::with(heads);
    for columns in by_group(all) {
        let title = &columns[0].group;
        let (about, needs) = about(title);
        // a campaign has what its columns need
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

/// What the columns of a section are about, and what a campaign needs for them.
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

/// What groups need that no campaign observes unless it says so.
const NAMED: &str = "in observe.groups";

/// The group called `word`; or of all groups the columns with the word in their name, their unit or their meaning.
/// `None` where there is none.
fn found(all: &[ListedColumn], word: &str) -> Option<Vec<ListedColumn>> {
    let lower = word.to_lowercase();
    let has = |column: &&ListedColumn| {
        let quantity = &column.quantity;
        let texts = [quantity.name(), quantity.unit(), quantity.meaning()];
        texts.iter().any(|text| text.to_lowercase().contains(&lower))
    };
    let group: Vec<ListedColumn> = all.iter().filter(|column| column.group == word).cloned().collect();
    match group.is_empty() {
        false => Some(group),
        // a group that is not observed
        true if Group::from_name(word).is_some() => None,
        true => Some(all.iter().filter(has).cloned().collect()).filter(|found: &Vec<_>| !found.is_empty()),
    }
}

/// The columns of every group; those of wheels once, with the place of the name.
pub fn of_all_campaigns() -> Vec<ListedColumn> {
    let column = |group: &str, quantity: &Quantity, only| ListedColumn {
        group: group.to_owned(),
        quantity: quantity.clone(),
        only,
    };
    let of_group = |group: Group| table::all().filter(move |column| column.group == group);
    let of_groups = Group::ALL.into_iter().flat_map(of_group);
    let of_groups = of_groups.map(|one| column(one.group.name(), &one.quantity, one.scenes()));
    let of_loops = OutcomeColumns::of_all_loops();
    of_groups.chain(of_loops.iter().map(|(quantity, only)| column(CONTROL, quantity, only))).collect()
}

/// The columns of the rows of `plan`: what is of the sample, its groups, and audits.
///
/// # Errors
/// Where the environment names an instruction set that is not available.
pub fn of_campaign(plan: &Plan) -> Result<Vec<ListedColumn>, Failure> {
    let ensemble = Ensemble::new(plan, isa()?);
    let observed = ensemble.request().columns();
    let group = |name: &str| observed.iter().find(|one| one.quantity.name() == name).map(|one| one.group.name());
    let mut all: Vec<ListedColumn> = Vec::new();
    for Column { quantity, .. } in rows_file::columns(&ensemble) {
        let other = if all.last().is_none_or(|last| last.group == SAMPLE) { SAMPLE } else { AUDIT };
        let group = group(quantity.name()).unwrap_or(other).to_owned();
        all.push(ListedColumn { group, quantity, only: "" });
    }
    Ok(all)
}

/// The columns as a table of their own.
pub fn table_of(all: &[ListedColumn]) -> Table<'_> {
    Table::of(all)
        .word("group", "", |column| &*column.group)
        .word("name", "", |column| column.quantity.name())
        .word("unit", "", |column| column.quantity.unit())
        .word("meaning", "", |column| column.quantity.meaning())
        .word("only", "", |column| column.only)
        .finish()
}

/// Title of the columns before the observables.
const SAMPLE: &str = "the sample and what it applies";
/// Title of the columns of control loops.
const CONTROL: &str = "control loop";
/// Title of the columns after them.
const AUDIT: &str = "audit";

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
