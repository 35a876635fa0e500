//! The outcomes of a campaign: observables that its file requires or names, else those of the motion.

use crate::campaign::{Plan, Requirement};
use crate::statistics::gate::GateLimit;

/// Default outcomes in order of importance: energy exchange, motion of the axis, final state.
pub const OF_MOTION: [&str; 8] = [
    "exchange_body_peak_to_peak_j",
    "nutation_angle_max_rad",
    "spin_axis_angle_max_rad",
    "angular_rate_final_rad_s",
    "omega_se_s_z_final_rad_s",
    "omega_se_s_x_final_rad_s",
    "omega_se_s_y_final_rad_s",
    "energy_error_max",
];

const FEW: usize = 3;

/// Required, listed and derived observables of `plan`, and the times of its events.
pub fn named(plan: &Plan) -> Vec<String> {
    let required = plan.analysis.requirements.iter().filter_map(Requirement::observable).map(str::to_owned);
    let listed = plan.analysis.summary_columns.iter().cloned();
    let derived = plan.analysis.derived.iter().map(|derived| derived.name.clone());
    let events = plan.events.iter().map(|event| event.quantities()[0].name().to_owned());
    unique(required.chain(listed).chain(derived).chain(events))
}

/// The first of equal items, in their order.
pub fn unique<T: PartialEq>(all: impl Iterator<Item = T>) -> Vec<T> {
    all.fold(Vec::new(), |mut list, one| {
        if !list.contains(&one) {
            list.push(one);
        }
        list
    })
}

/// Named outcomes, else the first default ones in the rows.
pub fn outcomes(plan: &Plan) -> Vec<String> {
    let named = named(plan);
    if !named.is_empty() {
        return named;
    }
    let columns = plan.request().columns();
    let has = |name: &&&str| columns.iter().any(|column| column.quantity.name() == **name);
    OF_MOTION.iter().filter(has).take(FEW).map(|name| (*name).to_owned()).collect()
}

/// True if small values of `name` are bad: all its limits are lower ones.
pub fn is_worst_when_low(plan: &Plan, name: &str) -> bool {
    let mut of = plan.analysis.requirements_on(name).peekable();
    of.peek().is_some() && of.all(|requirement| matches!(requirement.limit, GateLimit::AtLeast(_)))
}
