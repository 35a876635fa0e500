//! The `[design]` table. How a design is written is in its own file ([`crate::sampling::design`]).

use super::section::Section;
use crate::sampling::Design;

/// The design of a campaign; `None` where something is wrong, which is then noted. Without the table, the default.
pub fn read(table: &mut Section<'_, '_>) -> Option<Design> {
    if !table.is_present() {
        table.finish();
        return Some(Design::DEFAULT);
    }
    let design = Design::read(table);
    if design.is_some() || table.is_name_of("kind", Design::NAMES) {
        table.finish();
    }
    design
}
