//! The `[design]` table. The keys of a design are in its own file ([`crate::sampling::design`]).

use super::limits::MAX_SAMPLES;
use super::section::Section;
use crate::sampling::Design;
use crate::sampling::design::replicates::REPLICATES;

/// The design of a campaign; `None` where something is wrong, which is then noted. Without the table, the default.
pub fn read(table: &mut Section<'_, '_>) -> Option<Design> {
    if !table.is_present() {
        return Some(Design::DEFAULT);
    }
    let name = table.required_word("kind", Design::NAMES, "\"sobol\"")?;
    let (rows, rules) = Design::keys_of(name)?;
    let written = table.rows(rows, rules);
    let key = REPLICATES.key;
    let mut is_right = true;
    if !rows.iter().any(|row| row.key == key) && table.has(key) && table.counts(key, 1..=MAX_SAMPLES).is_some() {
        let allowed = format!(
            "left out with design {name:?}: designs with replicates are {}",
            Design::names_with(key).join(", ")
        );
        table.refuse(key, allowed, "delete it, or choose one of these designs");
        is_right = false;
    }
    table.finish();
    Design::of(name, &written?).filter(|_| is_right)
}
