//! [`simulation_figure`]: one run over time with the figures of its scene ([`crate::report::over_time::figure_list`]).
//! The energy panels are Figures 3 to 5 of the paper.

use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::report::figure::Figure;
use crate::report::figure_files::FigureSheet;
use crate::report::over_time::curves::Curves;

pub fn simulation_figure(title: String, plan: &Plan, run: &SingleRun) -> FigureSheet {
    let mut panels: Vec<Figure> = Curves::of_plot(plan, run).figures();
    panels.retain(has_values);
    if panels.len() % 2 == 1
        && let Some(last) = panels.last_mut()
    {
        last.columns = 12;
    }
    FigureSheet { title, figures: panels }
}

/// Titles of omitted figures, which are zero or absent throughout the run.
pub fn left_out(plan: &Plan, run: &SingleRun) -> Vec<String> {
    let figures = Curves::of_plot(plan, run).figures().into_iter();
    figures.filter(|figure| !has_values(figure)).map(|figure| figure.title).collect()
}

fn has_values(figure: &Figure) -> bool {
    figure.is_visible() && figure.marks.iter().any(|mark| mark.largest() > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ensemble::replays::GROUPS;
    use crate::ensemble::single::SingleRuns;
    use crate::findings::shipped;
    use crate::math::Isa;
    use crate::report::figure::Mark;
    use crate::run::Grid;
    use crate::sampling::SampleId;
    use crate::storage::timeseries::time_series;

    fn nominal(plan: &Plan, points: usize) -> SingleRun {
        let grid = Grid::uniform(plan.grid.duration(), points);
        SingleRuns::new(plan, grid, Isa::best(), &GROUPS, false).run(SampleId(0)).expect("a run")
    }

    /// Law: an idle thruster keeps its curve and is marked; curves that share a panel have labels; all-zero figures are
    /// omitted and listed.
    #[test]
    fn a_dead_thruster_is_drawn() {
        let text = shipped::text("net_launch");
        for (dead, names) in [("p2", ["p1", "p2: none", "p3"]), ("p1", ["p1: none", "p2", "p3"])] {
            let scale = format!("thrusters.{dead}.thrust_scale");
            let plan = shipped::plan_of(&text, &[("campaign.duration_s", "60.0"), (&scale, "0.0")]);
            let panels = simulation_figure("x".to_owned(), &plan, &nominal(&plan, 61)).figures;
            for title in ["Thrust", "Impulse of the thrusters"] {
                let panel = panels.iter().find(|panel| panel.title == title).expect(title);
                let drawn: Vec<&str> = panel.marks.iter().map(Mark::legend).filter(|name| !name.is_empty()).collect();
                assert_eq!(drawn[..3], names, "{title}");
            }
            for panel in &panels {
                assert!(panel.marks.iter().any(|mark| mark.largest() > 0.0), "{}", panel.title);
                let lines = panel.marks.iter().filter(|mark| matches!(mark, Mark::Line { .. }));
                let names: Vec<&str> = lines.map(Mark::legend).collect();
                assert!(
                    names.iter().all(|name| !name.is_empty()) || names.iter().all(|name| name.is_empty()),
                    "{}: {names:?}",
                    panel.title
                );
            }
        }
        // without thrusters their figures are not called for; a spin about one axis has that axis's label
        let text = "[campaign]\nname = \"o\"\nsamples = 1\nseed = 1\nduration_s = 9.0\n[body]\nmass_kg = \
            10.0\nprincipal_moments_kg_m2 = [1.0, 2.0, 2.5]\n[initial]\nangular_velocity_rad_s = [0.0, 0.0, 0.1]\n";
        let plan = shipped::plan_of(text, &[]);
        let run = nominal(&plan, 10);
        let panels = simulation_figure("x".to_owned(), &plan, &run).figures;
        let rate = panels.iter().find(|panel| panel.title.starts_with("Angular velocity of the body")).expect("a rate");
        assert_eq!(rate.marks.iter().map(Mark::legend).collect::<Vec<_>>(), ["z"]);
        assert!(left_out(&plan, &run).contains(&"Linear momentum in F_e".to_owned()), "{:?}", left_out(&plan, &run));
    }

    /// Law: every curve is the column named by panel and label.
    #[test]
    fn curves_are_their_columns() {
        let plan = shipped::plan("spin_sweep");
        let run = nominal(&plan, plan.grid.points());
        let series = time_series(SampleId(0), &run, |_| true);
        let column = |name: String| -> Vec<f64> {
            let found = series.numbers(&name);
            found.unwrap_or_else(|| panic!("no column {name}")).1.to_vec()
        };
        let mut seen = 0;
        for panel in simulation_figure("x".to_owned(), &plan, &run).figures {
            let title = panel.title.split(" (").next().expect("a title").to_owned();
            for mark in &panel.marks {
                let Mark::Line { label, x, y, .. } = mark else { continue };
                assert_eq!(*x, column("time_s".to_owned()), "{title}");
                let known = match title.as_str() {
                    "Angular velocity of the body, in F_s" => column(format!("omega_se_s_{label}_rad_s")),
                    "Attitude quaternion of the body, F_s to F_e" => column(format!("q_es_{label}")),
                    "Angular velocity of the debris, in F_d" => column(format!("omega_de_d_{label}_rad_s")),
                    "Attitude quaternion of the debris, F_d to F_e" => column(format!("q_ed_{label}")),
                    "Wheel rates" => column(format!("rate_{label}_rad_s")),
                    "Drift of energy" => column("energy_error".to_owned()),
                    "Drift of momentum" => column(format!("{label}_momentum_error")),
                    title if title.starts_with("Kinetic energy of ") => {
                        let body = title.trim_start_matches("Kinetic energy of ").trim_start_matches("the ");
                        let body = body.trim_start_matches("wheel ");
                        column(format!("energy_{body}_j"))
                    }
                    _ => continue, // momenta are not columns of a file
                };
                assert_eq!(*y, known, "{label} of {title}");
                seen += 1;
            }
        }
        assert!(seen > 20, "{seen} curves");
    }
}
