//! Plans of a test, and their rows column by column.

use crate::prelude::*;

pub const SPREAD: &str =
    "[[disperse]]\nparameter = \"initial.angular_velocity_rad_s\"\ndistribution = \"normal\"\nstd = 0.1\n";

/// A free body of moments 30, `middle` and 20 kg m^2 at 0.3 rad/s across s3 and 0.6 rad/s about it, for a minute.
pub fn free_body(integrator: &str, points: usize, middle: f64) -> String {
    format!(
        "[campaign]\nname = \"free\"\nsamples = 40\nseed = 3\nduration_s = 60.0\n[integrator]\n{integrator}\n\
         [observe]\npoints = {points}\ngroups = [\"energy_conservation\", \"momentum_conservation\", \"attitude\", \
         \"energies\", \"final_state\", \"effort\", \"numerics\", \"motion\"]\n[body]\nmass_kg = 10.0\n\
         center_of_mass_m = [0, 0, 0]\nprincipal_moments_kg_m2 = [30, {middle}, 20]\n\
         [initial]\nangular_velocity_rad_s = [0.3, 0.0, 0.6]\n"
    )
}

pub fn precession() -> (f64, f64) {
    let (across, along): (f64, f64) = (30.0 * 0.3, 20.0 * 0.6);
    (across.hypot(along) / 30.0, across.atan2(along))
}

pub fn plan(text: &str) -> Plan {
    planned(text)
}

pub fn near_rounding(method: Method) -> String {
    match method.has_fixed_step() {
        true => format!("method = \"{}\"\nstep_s = 0.002", method.name()),
        false => format!("method = \"{}\"\ntolerance = 1e-13", method.name()),
    }
}

pub fn event(name: &str, quantity: &str, value: f64, more: &str) -> String {
    format!("[[event]]\nname = \"{name}\"\nquantity = \"{quantity}\"\nvalue = {value:?}\n{more}\n")
}

pub fn rows(plan: &Plan, isa: Isa, first: u64, count: usize) -> Rows {
    let ensemble = Ensemble::new(plan, isa);
    let mut rows = ensemble.rows(count);
    let part = Part { id: PartId(0), first: SampleId(first), count };
    ensemble.worker().run(part, &mut rows, Supervision::progress(&|_| {}));
    rows
}

pub fn bits(rows: &Rows) -> Vec<RowBits> {
    (0..rows.statuses().len()).map(|row| row_bits(rows, row)).collect()
}

pub fn own_rows(plan: &Plan, count: usize) -> Rows {
    let all = rows(plan, Isa::best(), 0, count);
    let expected = bits(&all);
    for isa in Isa::available() {
        assert!(bits(&rows(plan, isa, 0, count)) == expected, "{}", isa.name());
    }
    for (first, length) in [(7, 1), (count / 4, 9), (count - 7, 7)] {
        let part = bits(&rows(plan, Isa::best(), first as u64, length));
        assert!(part == expected[first..first + length], "{length} from sample {first} on");
    }
    for sample in (0..count).step_by(4) {
        let single = single(plan, sample as u64);
        assert_eq!(single.outcome.status, all.statuses()[sample]);
        for (index, value) in single.row.iter().enumerate() {
            assert_eq!(value.to_bits(), all.observable(index)[sample].to_bits(), "sample {sample}, column {index}");
        }
    }
    all
}

pub fn names(plan: &Plan) -> Vec<String> {
    plan.request().columns().iter().map(|column| column.quantity.name().to_owned()).collect()
}

pub fn column<'r>(plan: &Plan, rows: &'r Rows, name: &str) -> &'r [f64] {
    rows.observable(names(plan).iter().position(|other| other == name).unwrap_or_else(|| panic!("no {name}")))
}
