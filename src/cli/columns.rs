//! `spindrift columns`: the groups of columns of the rows of a result, and the columns with unit and meaning.

use std::path::Path;

use crate::campaign::problem::nearest;
use crate::campaign::{Overrides, Plan};
use crate::cli::arguments::ColumnsOptions;
use crate::cli::command_outcome::{CommandOutcome, Failure};
use crate::cli::screen;
use crate::control::outcome::columns::OutcomeColumns;
use crate::ensemble::Ensemble;
use crate::observables::{Group, table};
use crate::report::shell_word::quoted_path;
use crate::report::text_table::{Align, TextTable};
use crate::run::Quantity;
use crate::storage::rows_file::headings;
use crate::workflow::isa;
use crate::workflow::source::plan;

/// Runs the command.
///
/// # Errors
/// Where the campaign file is wrong, or does not observe the group.
pub fn run(options: &ColumnsOptions) -> Result<CommandOutcome, Failure> {
    let sections = match &options.campaign {
        None => of_all_campaigns(),
        Some(file) => of_campaign(&plan(file, Overrides::default())?)?,
    };
    let shown = match &options.word {
        None if options.verbose => text(&sections),
        None => groups(&sections, options.campaign.as_deref()),
        Some(word) => text(&found(&sections, word).ok_or_else(|| {
            let groups: Vec<&str> = sections.iter().map(|section| section.title.as_str()).collect();
            let words = sections.iter().flat_map(|section| section.columns.iter().map(|(quantity, _)| quantity.name()));
            let meant = nearest(word, words.chain(groups.iter().copied()));
            let meant = meant.map_or(String::new(), |meant| format!("; did you mean {meant}?"));
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
fn groups(sections: &[ColumnSection], campaign: Option<&Path>) -> String {
    let heads = [("group", Align::Left), ("columns", Align::Right), ("what they are about", Align::Sentence)];
    let mut table = TextTable::new(heads);
    for ColumnSection { title, columns } in sections {
        let (about, needs) = about(title);
        // a campaign has what its columns need
        let needs = if needs.is_empty() || campaign.is_some() { String::new() } else { format!(" ({needs})") };
        table.row([title.clone(), columns.len().to_string(), about.to_owned() + &needs]);
    }
    let of = campaign.map_or(String::new(), |file| format!(" --campaign {}", quoted_path(file)));
    let all: usize = sections.iter().map(|section| section.columns.len()).sum();
    let mut examples = TextTable::new([("", Align::Title), ("", Align::Sentence)]);
    for (word, says) in [
        ("momentum_conservation", "that group: names, units, meanings"),
        ("pointing", "every column with that word"),
        ("--verbose", "all of them"),
    ] {
        examples.row([format!("spindrift columns {word}{of}"), says.to_owned()]);
    }
    format!("{}{all} columns in all\n\n{}", table.text(screen::width()), examples.text(screen::width()))
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

/// The group called `word`; or of all groups the columns with the word in their name, their unit or their meaning. `None` where there is none.
fn found(sections: &[ColumnSection], word: &str) -> Option<Vec<ColumnSection>> {
    if let Some(group) = sections.iter().find(|section| section.title == word) {
        return Some(vec![group.clone()]);
    }
    if Group::from_name(word).is_some() {
        return None; // it is not observed
    }
    let word = word.to_lowercase();
    let has = |(quantity, _): &&(Quantity, &'static str)| {
        [quantity.name(), quantity.unit(), quantity.meaning()].iter().any(|text| text.to_lowercase().contains(&word))
    };
    let columns = |section: &ColumnSection| ColumnSection {
        title: section.title.clone(),
        columns: section.columns.iter().filter(has).cloned().collect(),
    };
    let found: Vec<ColumnSection> =
        sections.iter().map(columns).filter(|section| !section.columns.is_empty()).collect();
    (!found.is_empty()).then_some(found)
}

#[derive(Clone)]
pub struct ColumnSection {
    /// The group, or what else they have in common.
    pub title: String,
    /// The columns, and in which scenes there are those.
    pub columns: Vec<(Quantity, &'static str)>,
}

/// The columns of every group; those of wheels once, with the place of the name.
pub fn of_all_campaigns() -> Vec<ColumnSection> {
    let section = |group: Group| ColumnSection {
        title: group.name().to_owned(),
        columns: table::all()
            .filter(|column| column.group == group)
            .map(|column| (column.quantity.clone(), column.scenes()))
            .collect(),
    };
    let of_loops = OutcomeColumns::of_all_loops();
    Group::ALL
        .into_iter()
        .map(section)
        .chain([ColumnSection { title: CONTROL.to_owned(), columns: of_loops }])
        .collect()
}

/// The columns of the rows of `plan`: what is of the sample, its groups, and audits.
///
/// # Errors
/// Where the environment names an instruction set that is not available.
pub fn of_campaign(plan: &Plan) -> Result<Vec<ColumnSection>, Failure> {
    let ensemble = Ensemble::new(plan, isa()?);
    let observed = ensemble.request().columns();
    let title = |quantity: &Quantity| {
        observed.iter().find(|column| column.quantity.name() == quantity.name()).map(|column| column.group.name())
    };
    let mut sections: Vec<ColumnSection> = Vec::new();
    for heading in headings(&ensemble) {
        let is_first = sections.iter().all(|section| section.title == SAMPLE);
        let title = title(&heading.quantity).unwrap_or(if is_first { SAMPLE } else { AUDIT });
        match sections.last_mut().filter(|section| section.title == title) {
            Some(section) => section.columns.push((heading.quantity, "")),
            None => sections.push(ColumnSection { title: title.to_owned(), columns: vec![(heading.quantity, "")] }),
        }
    }
    Ok(sections)
}

/// Title of the columns before the observables.
const SAMPLE: &str = "the sample and what it applies";
/// Title of the columns of control loops.
const CONTROL: &str = "control loop";
/// Title of the columns after them.
const AUDIT: &str = "audit";

fn text(sections: &[ColumnSection]) -> String {
    let mut text = String::new();
    for section in sections {
        if !text.is_empty() {
            text.push('\n');
        }
        text += &format!("{}\n", section.title);
        let mut table = TextTable::new([("", Align::Left), ("", Align::Left), ("", Align::Sentence)]);
        for (quantity, needs) in &section.columns {
            let needs = if needs.is_empty() { String::new() } else { format!(" ({needs})") };
            table.row([quantity.name(), quantity.unit(), &(quantity.meaning().to_owned() + &needs)]);
        }
        text += &table.text(screen::width());
    }
    text
}
