//! [`simulation_figure`]: one run over time: the figures that its scene calls for, those of the page ([`crate::report::over_time::figure_list`]).
//!
//! The panels of the energies are Figures 3 to 5 of the paper (body by body, total and its error).

use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::report::figure::{Figure, Mark};
use crate::report::over_time::curves::Curves;
use crate::report::sheet::Sheet;

/// The figure of a run of `plan`.
pub fn simulation_figure(title: String, plan: &Plan, run: &SingleRun) -> Sheet {
    let mut panels: Vec<Figure> = Curves::of_plot(plan, run).figures();
    panels.retain(Figure::is_visible);
    for panel in &mut panels {
        let curves = panel.marks.iter().filter(|mark| !mark.legend().is_empty()).count();
        if let ([Mark::Line { label, .. }], 1) = (&mut panel.marks[..], curves) {
            label.clear(); // the title names it
        }
    }
    if panels.len() % 2 == 1
        && let Some(last) = panels.last_mut()
    {
        last.columns = 12;
    }
    let width = if panels.len() > 1 { 1280.0 } else { 720.0 };
    Sheet { title, width, panel_height: 320.0, has_common_legend: false, panels }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;
    use crate::math::Isa;
    use crate::report::page::runs::GROUPS;
    use crate::sampling::SampleId;
    use crate::storage::timeseries::TimeSeries;

    /// Law: every curve is the column that its panel and its label name: states and energies as they are, their sum, and changes that are zero
    /// at the start and in balance throughout.
    #[test]
    fn curves_are_their_columns() {
        let text = include_str!("../../campaigns/spin_sweep.toml");
        let plan = Plan::from_text("spin_sweep", text, Overrides::default()).expect("valid");
        let run = SingleRun::with_series(&plan, SampleId(0), plan.grid.clone(), Isa::best(), &GROUPS).expect("a run");
        let series = TimeSeries::new(&plan, SampleId(0), &run, |_| true);
        let column = |name: String| -> Vec<f64> {
            let found = series.columns().find(|(quantity, _)| quantity.name() == name);
            found.unwrap_or_else(|| panic!("no column {name}")).1.to_vec()
        };
        let sum = |names: &[String]| -> Vec<f64> {
            let columns: Vec<Vec<f64>> = names.iter().cloned().map(column).collect();
            (0..series.points()).map(|point| columns.iter().map(|values| values[point]).sum()).collect()
        };
        let bodies = ["body", "w1", "w2", "debris"].map(|body| format!("energy_{body}_j"));
        let mut seen = 0;
        for panel in simulation_figure("x".to_owned(), &plan, &run).panels {
            let title = panel.title.split(" (").next().expect("a title").to_owned();
            let mut balance = vec![0.0; series.points()];
            for mark in &panel.marks {
                let Mark::Line { label, x, y, .. } = mark else { continue };
                assert_eq!(*x, column("time_s".to_owned()), "{title}");
                let of_wheel = label.trim_start_matches("wheel ").trim_start_matches("the ");
                let known = match title.as_str() {
                    "Angular velocity of the body, in F_s" => column(format!("omega_se_s_{label}_rad_s")),
                    "Attitude quaternion of the body, F_s to F_e" => column(format!("q_es_{label}")),
                    "Angular velocity of the debris, in F_d" => column(format!("omega_de_d_{label}_rad_s")),
                    "Attitude quaternion of the debris, F_d to F_e" => column(format!("q_ed_{label}")),
                    "Wheel rates" => column(format!("rate_{label}_rad_s")),
                    "Kinetic energy, total" => sum(&bodies),
                    "Relative errors of the balances" => {
                        let errors = ["energy minus work", "linear momentum", "angular momentum"];
                        let names = ["energy_error", "linear_momentum_error", "angular_momentum_error"];
                        match errors.iter().position(|error| error == label) {
                            Some(place) => column(names[place].to_owned()),
                            None => continue, // the tolerance, the rounding
                        }
                    }
                    title if title.starts_with("Kinetic energy of ") => {
                        let body = title.trim_start_matches("Kinetic energy of ").trim_start_matches("the ");
                        let body = body.trim_start_matches("wheel ");
                        column(format!("energy_{body}_j"))
                    }
                    title if title.starts_with("Energy transfer") => {
                        let values = column(format!("energy_com_{of_wheel}_j"));
                        balance.iter_mut().zip(y).for_each(|(balance, change)| *balance += change);
                        values.iter().map(|value| value - values[0]).collect()
                    }
                    _ => continue, // momenta are not columns of a file
                };
                assert_eq!(*y, known, "{label} of {title}");
                seen += 1;
            }
            let largest = panel.marks.iter().map(Mark::largest).fold(0.0, f64::max);
            assert!(balance.iter().all(|balance| balance.abs() <= 1e-6 * largest), "{title}");
        }
        assert!(seen > 20, "{seen} curves");
    }
}
