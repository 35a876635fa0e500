//! Measured run times and errors as a table.

use crate::ensemble::precision::{Deviation, Measurement, Setting};
use crate::table::Table;

/// A row per setting, on the instruction set `isa`.
pub fn precision_table<'m>(measured: &'m [Measurement], isa: &str) -> Table<'m> {
    let most = |of: Option<Deviation>| of.map(|deviation| deviation.max);
    let rms = |of: Option<Deviation>| of.map(|deviation| deviation.rms);
    let same = "The same, root mean square over samples and points.";
    Table::of(measured)
        .word("method", "Method, as in campaign files.", |m| m.method.name())
        .real("tolerance", "Relative and absolute tolerance; absent for a fixed step.", |m| match m.setting {
            Setting::Tolerance(tolerance) => Some(tolerance),
            Setting::Step(_) => None,
        })
        .real("step_s", "Fixed step; absent for a tolerance.", |m| match m.setting {
            Setting::Step(step) => Some(step),
            Setting::Tolerance(_) => None,
        })
        .unit("s")
        .real("cpu_s", "CPU time of a run, median of the repetitions.", |m| Some(m.cpu[0]))
        .unit("s")
        .real("cpu_least_s", "CPU time of a run, minimum of the repetitions.", |m| Some(m.cpu[1]))
        .unit("s")
        .real("repeats", "Number of timed repetitions.", |m| Some(m.repeats as f64))
        .real("runs", "Number of samples.", |m| Some(m.runs[0] as f64))
        .real("failed", "Samples that did not reach their end; they have no error.", |m| Some(m.runs[1] as f64))
        .real("steps_mean", "Accepted steps of a run, mean.", |m| Some(m.steps))
        .real("runs_per_s", "One over the median CPU time.", |m| Some(1.0 / m.cpu[0]))
        .unit("1/s")
        .real("rate_error_max", "Maximum |omega - reference solution| over the run's maximum |omega|.", |m| {
            most(m.rate)
        })
        .real("rate_error_rms", same, |m| rms(m.rate))
        .real(
            "attitude_error_max_rad",
            "Maximum angle between the attitude and the reference solution, as 2 |q - q_ref|.",
            |m| most(m.attitude),
        )
        .unit("rad")
        .real("attitude_error_rms_rad", same, |m| rms(m.attitude))
        .unit("rad")
        .real("energy_error_max", "Maximum relative error of the energy balance.", |m| most(m.energy))
        .real("energy_error_rms", same, |m| rms(m.energy))
        .real("angular_momentum_error_max", "Maximum relative error of the balance of angular momentum.", |m| {
            most(m.momentum)
        })
        .real("angular_momentum_error_rms", same, |m| rms(m.momentum))
        .note("spindrift.isa", isa) // times depend on it, unlike rows
        .finish()
}
