//! [`ControlLaw`]: a control law of a plan.

use std::fmt;
use std::sync::Arc;

use super::context::LawContext;
use super::control_loop::ControlLoop;
use super::outcome::columns::OutcomeColumns;
use super::runs::{LawMaker, LawRuns};
use super::spec::LoopSpec;
use crate::dynamics::actuation::ActuationLaw;
use crate::observables::{LawColumn, LawColumns};
use crate::scene::{Actuated, LawParameter};

/// A control law that a campaign flies.
///
/// Its name and parameters are part of the plan, hence of the identity of the rows: change the name when you change the
/// law. The law of a run is made at its start and must depend on nothing but its context and its input in that run.
#[derive(Clone)]
pub struct ControlLaw {
    name: &'static str,
    commands: Actuated,
    parameters: &'static [LawParameter],
    columns: LawColumns,
    make: Arc<LawMaker>,
    /// The loop of a campaign file.
    spec: Option<Arc<LoopSpec>>,
}

impl ControlLaw {
    /// The law called `name`, which commands `commands`, with the parameters `parameters`; `make` makes the
    /// law of a run.
    ///
    /// ```
    /// use spindrift::control::ControlLaw;
    /// use spindrift::dynamics::actuation::{Actuation, BodyState, WheelState, ZeroOrderHold};
    /// use spindrift::scene::schema::Limit;
    /// use spindrift::scene::{Actuated, LawParameter};
    ///
    /// static PARAMETERS: [LawParameter; 1] =
    ///     [LawParameter::number("gain_n_m_s", "N m s", "Torque against a rate", Limit::NotNegative)];
    /// let commands = Actuated { body_torque: true, ..Actuated::NONE };
    /// let law = ControlLaw::new("rate_damping", commands, &PARAMETERS, |context| {
    ///     let gain = context.number("gain_n_m_s");
    ///     ZeroOrderHold::new(0.1, move |_: f64, body: &BodyState, _: &WheelState| Actuation {
    ///         body_torque: body.omega_se_s.map(|rate| -gain * rate),
    ///         ..Actuation::none(f64::INFINITY)
    ///     })
    /// });
    /// assert_eq!(law.name(), "rate_damping");
    /// ```
    pub fn new<L: ActuationLaw + Send + 'static>(
        name: &'static str,
        commands: Actuated,
        parameters: &'static [LawParameter],
        make: impl Fn(&LawContext<'_>) -> L + Send + Sync + 'static,
    ) -> Self {
        let make: Arc<LawMaker> = Arc::new(move |context: &LawContext<'_>| Box::new(make(context)));
        ControlLaw { name, commands, parameters, columns: LawColumns::NONE, make, spec: None }
    }

    /// The loop `spec` of a campaign file. Its parameters are tables of the scene.
    pub fn closed_loop(spec: LoopSpec) -> Self {
        let spec = Arc::new(spec);
        let columns = Arc::new(OutcomeColumns::of(&spec));
        let commands =
            Actuated { thrusters: !spec.thrusters.is_empty(), motors: !spec.wheels.is_empty(), body_torque: false };
        let reported = LawColumns { over_time: spec.over_time(), ..columns.columns() };
        let own = spec.clone();
        let law =
            ControlLaw::new("closed_loop", commands, &[], move |context| ControlLoop::new(&own, &columns, context));
        ControlLaw { columns: reported, spec: Some(spec), ..law }
    }

    /// The loop of a campaign file; `None` for a program's own law.
    pub fn spec(&self) -> Option<&LoopSpec> {
        self.spec.as_deref()
    }

    /// Adds columns that the law reports at the end of a run ([`ActuationLaw::report`]).
    #[must_use]
    pub fn reporting(self, columns: &'static [LawColumn]) -> Self {
        ControlLaw { columns: LawColumns { list: columns, ..self.columns }, ..self }
    }

    /// Its name, as in `control.law` of a plan.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The actuators that it commands, which have columns of work and impulse.
    pub fn commands(&self) -> Actuated {
        self.commands
    }

    /// The columns that it reports.
    pub fn columns(&self) -> LawColumns {
        self.columns
    }

    /// Its parameters, keys of `[control]`.
    pub fn parameters(&self) -> &'static [LawParameter] {
        self.parameters
    }

    /// Memory for the laws of one worker's runs.
    pub fn runs(&self) -> LawRuns {
        LawRuns::new(self.make.clone(), self.spec.is_some())
    }
}

impl fmt::Debug for ControlLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ControlLaw").field("name", &self.name).finish_non_exhaustive()
    }
}

/// Laws are equal by name, loops of campaign files also by content.
impl PartialEq for ControlLaw {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.spec == other.spec
    }
}
