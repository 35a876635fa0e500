//! [`ListedColumn`]: possible columns of rows, of all campaigns and of one.

use crate::campaign::Plan;
use crate::control::outcome::columns::OutcomeColumns;
use crate::ensemble::Ensemble;
use crate::observables::{Group, table};
use crate::run::Quantity;
use crate::storage::rows_file;
use crate::table::{Column, Table};
use crate::workflow::error::Result;
use crate::workflow::session::isa;

/// Title of the columns before the observables.
pub const SAMPLE: &str = "the sample and what it applies";
pub const CONTROL: &str = "control loop";
pub const AUDIT: &str = "audit";

#[derive(Clone, Debug)]
pub struct ListedColumn {
    /// Its group, or a title.
    pub group: String,
    pub quantity: Quantity,
    /// Scenes with the column; empty for all.
    pub only: &'static str,
}

pub fn by_group(all: &[ListedColumn]) -> impl Iterator<Item = &[ListedColumn]> {
    all.chunk_by(|one, next| one.group == next.group)
}

/// The group called `word`, or columns of all groups with the word in name, unit or meaning, if any.
pub fn found(all: &[ListedColumn], word: &str) -> Option<Vec<ListedColumn>> {
    let lower = word.to_lowercase();
    let has = |column: &&ListedColumn| {
        let quantity = &column.quantity;
        let texts = [quantity.name(), quantity.unit(), quantity.meaning()];
        texts.iter().any(|text| text.to_lowercase().contains(&lower))
    };
    let group: Vec<ListedColumn> = all.iter().filter(|column| column.group == word).cloned().collect();
    match group.is_empty() {
        false => Some(group),
        // an unobserved group
        true if Group::from_name(word).is_some() => None,
        true => Some(all.iter().filter(has).cloned().collect()).filter(|found: &Vec<_>| !found.is_empty()),
    }
}

/// The columns of every group; those of wheels once, with a placeholder for the name.
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

/// The columns of the rows of `plan`: of the sample, its groups, and audits.
///
/// # Errors
/// An unavailable instruction set in the environment.
pub fn of_campaign(plan: &Plan) -> Result<Vec<ListedColumn>> {
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

pub fn table_of(all: &[ListedColumn]) -> Table<'_> {
    Table::of(all)
        .word("group", "", |column| &*column.group)
        .word("name", "", |column| column.quantity.name())
        .word("unit", "", |column| column.quantity.unit())
        .word("meaning", "", |column| column.quantity.meaning())
        .word("only", "", |column| column.only)
        .finish()
}
