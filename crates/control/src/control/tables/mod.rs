//! The tables of a loop in a campaign file.

mod control;
mod module;
mod phases;
mod schema;
mod sensors;

use serde_json::Value;

use crate::campaign::section::Section;
use crate::campaign::{self, LoopTables};
use crate::loops::ControlLaw;
use crate::loops::attitude_law::LawKind;
use crate::sampling::keys::{Row, Rule};
use crate::scene::SceneInput;

/// The tables of a loop, without the parameters of its parts.
pub const TABLES: [(&str, &[Row], &[Rule]); 4] = [
    ("[control]", &control::ROWS, &control::RULES),
    ("[control.model]", &control::MODEL, &[]),
    ("[[sensors]]", &sensors::ROWS, &[]),
    ("[[guidance]]", &phases::ROWS, &phases::RULES),
];

/// The reader of the loops of this program.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loops;

/// Values of the command line that replace the file's, and the calling program's law, in files with control loops.
pub type Overrides = campaign::Overrides<Loops>;

impl LoopTables for Loops {
    fn read(&self, root: &mut Section<'_, '_>, scene: &mut SceneInput, own: Option<&LawKind>) -> Option<ControlLaw> {
        control::read(root, scene, own)
    }

    fn schema(&self) -> Vec<(&'static str, Option<usize>, Value)> {
        schema::schema()
    }
}
