//! [`LoopMaker`]: the maker of the laws of a loop in a campaign file.

use std::sync::Arc;

use super::capacity::capacity;
use super::control_loop::ControlLoop;
use super::outcome::columns::OutcomeColumns;
use super::review;
use crate::dynamics::actuation::ActuationLaw;
use crate::loops::capacity::Capacity;
use crate::loops::{ControlLaw, LawContext, LawMaker, LoopSpec};
use crate::scene::{ControlInput, Scene};

pub struct LoopMaker {
    spec: Arc<LoopSpec>,
    columns: Arc<OutcomeColumns>,
}

pub fn closed_loop(spec: LoopSpec) -> ControlLaw {
    let columns = OutcomeColumns::of(&spec);
    let of_law = columns.columns();
    let maker = LoopMaker { spec: Arc::new(spec), columns: Arc::new(columns) };
    ControlLaw::closed_loop(&maker.spec.clone(), of_law, maker)
}

impl LawMaker for LoopMaker {
    fn law(&self, context: &LawContext<'_>) -> Box<dyn ActuationLaw + Send> {
        Box::new(ControlLoop::new(&self.spec, &self.columns, context))
    }

    fn spec(&self) -> Option<&LoopSpec> {
        Some(&self.spec)
    }

    fn notes(&self, numbers: &ControlInput, scene: &Scene, duration: f64) -> Vec<String> {
        review::notes(&self.spec, numbers, scene, duration)
    }

    fn capacity(&self, scene: &Scene) -> Option<Capacity> {
        Some(capacity(&self.spec, scene))
    }
}
