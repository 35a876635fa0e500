//! [`LoopTables`]: the reader of control loops, which a program chooses with its [`super::Overrides`].

use super::section::Section;
use crate::loops::ControlLaw;
use crate::loops::attitude_law::LawKind;
use crate::scene::SceneInput;
use serde_json::Value;

/// Reads `[control]`, `[[sensors]]` and `[[guidance]]`.
pub trait LoopTables {
    /// Reads the loop at the top of a file, whose phases may name the law `own` of the calling program; its numbers
    /// become parameters of `scene`. `None` after a problem.
    fn read(&self, root: &mut Section<'_, '_>, scene: &mut SceneInput, own: Option<&LawKind>) -> Option<ControlLaw>;

    /// Header, largest number and JSON Schema of each table.
    fn schema(&self) -> Vec<(&'static str, Option<usize>, Value)>;
}

/// A program without control loops, such as a test of what lies below them.
impl LoopTables for () {
    fn read(&self, root: &mut Section<'_, '_>, _: &mut SceneInput, _: Option<&LawKind>) -> Option<ControlLaw> {
        root.refused("control", "left out: this program flies no control loops", "delete this table")
    }

    fn schema(&self) -> Vec<(&'static str, Option<usize>, Value)> {
        Vec::new()
    }
}
