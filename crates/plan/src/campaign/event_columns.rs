//! Columns for the times of failures and events.

use super::event::{ENDED_BY, Event};
use super::failure_tables::failed_device;
use crate::observables::{ColumnKind, LawColumn};
use crate::run::Quantity;
use crate::scene::SceneInput;

/// Columns of each failure, and of each event.
pub const EACH: usize = 2;

pub(super) fn of_failures(scene: &SceneInput) -> Vec<LawColumn> {
    let of = |failure: &crate::scene::FailureInput| {
        let name = failure.name;
        let device = failed_device(scene, failure.device);
        [
            column(
                format!("failure_{name}_time_s"),
                "s",
                format!("When the {device} failed; null if the run ended before."),
                ColumnKind::Float,
            ),
            column(
                format!("failure_{name}_happened"),
                "",
                format!("Whether the {device} failed before the end of the run: 1 or 0."),
                ColumnKind::Count,
            ),
        ]
    };
    scene.failures.iter().flat_map(of).collect()
}

fn column(name: String, unit: &str, meaning: String, kind: ColumnKind) -> LawColumn {
    LawColumn { quantity: Quantity::named(name, unit.to_owned(), meaning), kind, codes: &[] }
}

/// The columns of `events`, and the code of what ended a run: an event or, with `has_law`, a mission's law.
pub(super) fn of_events(events: &[Event], has_law: bool) -> Vec<LawColumn> {
    let kinds = [ColumnKind::Float, ColumnKind::Count];
    let of = |event: &Event| {
        event.quantities().into_iter().zip(kinds).map(|(quantity, kind)| LawColumn { quantity, kind, codes: &[] })
    };
    let ends: Vec<String> =
        Event::ends(events, has_law).iter().enumerate().map(|(code, end)| format!("{code} {end}")).collect();
    let meaning = format!("What ended the run: {}.", ends.join(", "));
    let ended_by = (!ends.is_empty()).then(|| column(ENDED_BY.to_owned(), "", meaning, ColumnKind::Count));
    events.iter().flat_map(of).chain(ended_by).collect()
}
