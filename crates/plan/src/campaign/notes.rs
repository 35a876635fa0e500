//! [`Plan::notes`]: valid settings that are probably not meant.

use super::plan::{Plan, ROUNDING_OF_PLATES};
use super::requirement::{Requirement, Subject};
use crate::dynamics::effects::{Effect, ForceModel, Form};
use crate::observables::accuracy::Accuracy;
use crate::sampling::design::{MAX_SAMPLES, Size};
use crate::scene::Scene;

impl Plan {
    /// Notes for the user before a run, one sentence each.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = self.ignored.clone();
        if self.samples > 1 && self.dispersions.columns().is_empty() {
            notes.push(match self.law {
                Some(_) => "nothing is dispersed: samples differ by noise in the control loop alone".to_owned(),
                None => format!("nothing is dispersed: all {} samples are the nominal scene", self.samples),
            });
        }
        notes.extend(self.part_of_a_design());
        notes.extend(self.bound_inputs(self.samples - 1));
        for replaced in self.dispersions.replaced_correlations() {
            notes.push(format!(
                "nearest_psd: the correlations of {} cannot be had; `check`, plan.toml and summary.json state those \
                used",
                replaced.names.join(", ")
            ));
        }
        if Accuracy::new(&self.request()).is_blind() {
            notes.push(
                "no requested column says how accurate a run is, so none can end as inaccurate; add \
                \"energy_conservation\", \"momentum_conservation\" or \"numerics\" to observe.groups"
                    .to_owned(),
            );
        }
        let is_of_bands = |one: &Requirement| matches!(one.subject, Subject::Band(_));
        let (runs, last) = (self.samples - 1, self.last_counted().0);
        if runs > last && self.analysis.requirements.iter().any(is_of_bands) {
            notes.push(format!(
                "quantiles over time are of the first {last} runs, and a requirement at each time may stay undecided; \
                bands.runs = {runs} counts all"
            ));
        }
        let is_of_plates = |effect: &Effect| effect.form() == Form::Evaluated;
        let of_plates: Vec<&str> =
            ForceModel::of_input(&self.nominal).effects().filter(is_of_plates).map(Effect::key).collect();
        if !of_plates.is_empty() && self.tolerance.relative < ROUNDING_OF_PLATES {
            notes.push(format!(
                "at tolerances below {ROUNDING_OF_PLATES:e} the rounding of {} counts, which state_error_estimate does \
                not know: errors can be thirty times as large",
                of_plates.join(" and ")
            ));
        }
        if let (Some(law), Ok(scene)) = (&self.law, Scene::resolve(&self.nominal)) {
            notes.extend(law.maker().notes(&self.nominal.control, &scene, self.grid.duration()));
        }
        notes
    }

    /// Why `runs` runs separate no drivers: the design binds inputs to each other ([`Design::bound`]).
    ///
    /// [`Design::bound`]: crate::sampling::Design::bound
    pub fn bound_inputs(&self, runs: u64) -> Option<String> {
        let names = self.dispersions.dimensions();
        let [first, second, third] = self.design.bound(names.len(), runs)?.map(|dimension| names[dimension].as_str());
        let others = if second == third { second.to_owned() } else { format!("{second} and {third} together") };
        Some(format!(
            "design \"{}\": {runs} runs do not tell {first} from {others}, so no driver is tested; write design \
            \"random\" or \"latin_hypercube\"",
            self.design.name()
        ))
    }

    /// A note on fewer samples than the design has points.
    fn part_of_a_design(&self) -> Option<String> {
        let drawn = self.samples - 1;
        let (points, remedy) = match self.design.size(self.dispersions.dimensions().len()) {
            Size::Points(points) if points < MAX_SAMPLES => {
                (format!("{points} points"), "leave campaign.samples out for all points")
            }
            Size::Points(_) | Size::TooMany => {
                ("more points than a campaign may have".to_owned(), "write fewer levels for all points")
            }
            Size::Any => return None,
        };
        (drawn > 0 && points != format!("{drawn} points")).then(|| {
            format!(
                "{} samples are a part of the {} design ({drawn} of {points}), and levels may be missing; {remedy}",
                self.samples,
                self.design.name(),
            )
        })
    }
}
