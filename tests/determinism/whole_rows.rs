//! Plans written in a test, and their rows column by column: what the tests of events, extremes and ends of runs share.

use spindrift::campaign::{Overrides, Plan};
use spindrift::ensemble::{Ensemble, Part, PartId, Rows, Supervision};
use spindrift::math::Isa;
use spindrift::propagation::Method;
use spindrift::sampling::SampleId;

/// A dispersion of the angular velocity at time zero.
pub const SPREAD: &str =
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\nstd = 0.1\n";

pub fn plan(text: &str) -> Plan {
    Plan::from_text("rows.toml", text, Overrides::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The keys of `method` with settings near rounding for a rate of a radian a second.
pub fn near_rounding(method: Method) -> String {
    match method.has_fixed_step() {
        true => format!("method = \"{}\"\nstep_s = 0.002", method.name()),
        false => format!("method = \"{}\"\ntolerance = 1e-13", method.name()),
    }
}

pub fn event(name: &str, quantity: &str, value: f64, more: &str) -> String {
    format!("[[event]]\nname = \"{name}\"\nquantity = \"{quantity}\"\nvalue = {value:?}\n{more}\n")
}

/// The rows of `count` samples of `plan` from `first` on.
pub fn rows(plan: &Plan, isa: Isa, first: u64, count: usize) -> Rows {
    let ensemble = Ensemble::new(plan, isa);
    let mut rows = ensemble.rows(count);
    let part = Part { id: PartId(0), first: SampleId(first), count };
    ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
    rows
}

pub fn names(plan: &Plan) -> Vec<String> {
    plan.request().columns().iter().map(|column| column.quantity.name().to_owned()).collect()
}

/// The column `name` of `rows`.
pub fn column<'r>(plan: &Plan, rows: &'r Rows, name: &str) -> &'r [f64] {
    rows.observable(names(plan).iter().position(|other| other == name).unwrap_or_else(|| panic!("no {name}")))
}

/// All numbers of row `row`, as bits.
pub fn bits(plan: &Plan, rows: &Rows, row: usize) -> Vec<u64> {
    (0..names(plan).len()).map(|index| rows.observable(index)[row].to_bits()).collect()
}
