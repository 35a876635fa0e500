//! A plan as text: every key with its value, defaults too, in one order and one spelling; it reads back to the same
//! plan.
//!
//! Its SHA-256 (FIPS 180-4) is the plan's identity, which `sha256sum` reproduces. Floats are written with the fewest
//! digits that read back to the same bits.
//!
//! The row plan is the part of it that changes rows or their encoding: without the campaign's name, and with the number
//! of samples only where the design's points depend on it. Two campaigns with the same row hash have the same rows,
//! sample by sample.

use super::draws::{correlation_lines, derivation_lines, design_lines, dispersion_lines};
use super::lines::Lines;
use super::plan::Plan;
use super::{bands, control, event, extreme, failure_tables, retention, settings};
use crate::observables::request::NutationAxis;
use crate::sampling::keys::{Counts, Row, Value, Values};
use crate::scene::table::Table;
use crate::scene::{ArcErrors, EnvironmentInput, Name, Shadow};
use sha2::{Digest, Sha256};

fn digest(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Plan {
    /// The plan as canonical text.
    pub fn text(&self) -> String {
        self.text_of(true)
    }

    /// The part of the canonical text that changes rows or their encoding.
    pub fn row_text(&self) -> String {
        self.text_of(false)
    }

    /// SHA-256 of the row plan, in hexadecimal.
    pub fn row_hash(&self) -> String {
        digest(&self.row_text())
    }

    /// The keys that do not change rows, by the beginning of their path.
    pub const OUTSIDE_ROWS: [&'static str; 10] = [
        "retain.",
        "campaign.description",
        "campaign.name",
        "campaign.samples",
        "statistics.",
        "summary.",
        "observable",
        "require",
        "stop.",
        "display.",
    ];

    /// The canonical text: `whole`, or the row plan.
    fn text_of(&self, whole: bool) -> String {
        let mut lines = Lines::default();
        self.write_settings(&settings::HEAD, whole, &mut lines);
        self.write_scene(&mut lines);
        design_lines(&self.design, &mut lines);
        for dispersion in &self.dispersed {
            dispersion_lines(dispersion, &mut lines);
        }
        for correlation in &self.correlated {
            correlation_lines(correlation, &mut lines);
        }
        for replaced in self.dispersions.replaced_correlations() {
            lines.note(&format!("components: {}", replaced.names.join(", ")));
            lines.note(&format!("nearest correlation of the normal scores, which is used: {:?}", replaced.used));
        }
        for derivation in &self.derived {
            derivation_lines(derivation, &mut lines);
        }
        self.write_settings(&settings::TAIL, whole, &mut lines);
        for event in &self.events {
            lines.rows("[[event]]", &event::ROWS, |key| event.value(key));
        }
        for extreme in &self.extremes {
            lines.rows("[[extreme]]", &extreme::ROWS, |key| extreme.value(key));
        }
        if whole {
            self.analysis.write(&mut lines);
            lines.rows("[retain]", &retention::ROWS, |_| Some(self.retention.text().as_str().into()));
        }
        lines.into_text()
    }

    /// SHA-256 of the canonical text, in hexadecimal.
    pub fn hash(&self) -> String {
        digest(&self.text())
    }

    /// Tables of settings: `whole`, or without the keys that do not change rows.
    fn write_settings(&self, tables: &[(&str, &[Row])], whole: bool, lines: &mut Lines) {
        for (header, rows) in tables {
            lines.rows(&format!("[{header}]"), rows, |key| {
                let path = format!("{header}.{key}");
                let is_written = match path.as_str() {
                    "campaign.samples" => whole || self.design.facts().depends_on_samples.is_some(),
                    path => whole || !Self::OUTSIDE_ROWS.contains(&path),
                };
                self.setting(&path).filter(|_| is_written)
            });
        }
    }

    /// The value of a setting, if canonical text has it.
    fn setting(&self, path: &str) -> Option<Value> {
        Some(match path {
            "campaign.name" => self.name.as_str().into(),
            "campaign.description" => self.description.as_deref()?.into(),
            "campaign.samples" => self.first_samples().into(),
            "campaign.only" => Value::Counts(Counts::Each(self.chosen.as_ref()?.samples().to_vec())),
            "campaign.seed" => self.seed.into(),
            "campaign.duration_s" => self.grid.duration().into(),
            "integrator.method" => Value::Word(self.method.name()),
            "integrator.relative_tolerance" => self.tolerance.relative.into(),
            "integrator.absolute_tolerance" => self.tolerance.absolute.into(),
            "integrator.step_s" => self.step_s?.into(),
            "integrator.max_steps" => self.max_steps.into(),
            "observe.points" => (self.grid.points() as u64).into(),
            "observe.groups" => Value::Words(self.groups.iter().map(|group| group.name()).collect()),
            "observe.nutation_axis" => match self.nutation_axis {
                NutationAxis::SpinAxis => return None,
                NutationAxis::Principal => Value::Word("principal"),
                NutationAxis::Along(axis) => Value::Numbers(Values::Each(axis.to_vec())),
            },
            "audit.fraction" => self.audit_fraction.into(),
            "bands.points" => (self.band_points as u64).into(),
            "bands.runs" if self.band_runs != bands::RUNS => self.band_runs.into(),
            "output.compression" => Value::Word(self.compression.name()),
            // `tolerance` is both of those that are written
            _ => return None,
        })
    }

    /// The tables of the nominal scene, every key that it has in the order of the schema.
    fn write_scene(&self, lines: &mut Lines) {
        let scene = &self.nominal;
        lines.table("[body]");
        lines.keys(Table::Body, 0, scene);
        lines.keys(Table::BodyErrors, 0, scene);
        if scene.parts.is_empty() {
            lines.key("includes_wheels", scene.body.includes_wheels);
        }
        for (instance, part) in scene.parts.iter().enumerate() {
            lines.table("[[body.parts]]");
            lines.key("name", part.name);
            lines.key("shape", part.shape.name());
            lines.keys(Table::Part, instance, scene);
            lines.keys(Table::PartErrors, instance, scene);
        }
        for (instance, wheel) in scene.wheels.iter().enumerate() {
            lines.table("[[wheels]]");
            lines.key("name", wheel.name);
            lines.key("mode", wheel.mode.name());
            lines.keys(Table::Wheel, instance, scene);
        }
        for (instance, thruster) in scene.thrusters.iter().enumerate() {
            lines.table("[[thrusters]]");
            lines.key("name", thruster.name);
            lines.keys(Table::Thruster, instance, scene);
        }
        for (instance, rod) in scene.torque_rods.iter().enumerate() {
            lines.table("[[torque_rods]]");
            lines.key("name", rod.name);
            lines.keys(Table::TorqueRod, instance, scene);
        }
        if self.nominal.debris.is_some() {
            lines.keys_of("[debris]", Table::Debris, 0, &self.nominal);
        }
        lines.keys_of("[initial]", Table::Initial, 0, &self.nominal);
        if self.nominal.environment != EnvironmentInput::DEFAULT {
            lines.keys_of("[environment]", Table::Environment, 0, &self.nominal);
            let environment = &scene.environment;
            for (key, acts) in [
                ("gravity_gradient", environment.gravity_gradient),
                ("drag", environment.drag),
                ("solar_pressure", environment.solar_pressure),
                ("coupled", environment.coupled),
            ] {
                if acts {
                    lines.key(key, true);
                }
            }
            for (key, list) in
                [("air_heights_m", environment.air_heights_m), ("air_densities_kg_m3", environment.air_densities_kg_m3)]
            {
                if let Some(list) = list {
                    lines.key(key, list);
                }
            }
            if environment.shadow != Shadow::default() {
                lines.key("shadow", environment.shadow.name());
            }
            if let Some(model) = self.nominal.environment.magnetic_field {
                lines.key("magnetic_field", model.name());
            }
        }
        if let Some(orbit) = &self.nominal.orbit {
            lines.keys_of("[orbit]", Table::Orbit, 0, &self.nominal);
            if let Some(epoch) = orbit.epoch {
                lines.text_key("epoch", &epoch.to_string());
            }
        }
        for (instance, plate) in scene.plates.iter().enumerate() {
            lines.table("[[plates]]");
            lines.key("name", plate.name);
            lines.keys(Table::Plate, instance, scene);
        }
        for arc in 0..self.nominal.actuation.len() {
            let command = &self.nominal.actuation[arc];
            lines.table("[[actuation]]");
            if command.name != Name::NONE {
                lines.key("name", command.name);
            }
            lines.keys(Table::Actuation, arc, &self.nominal);
            // most arcs have none, and a schedule may have many thousands of arcs
            if command.errors != ArcErrors::NONE {
                lines.keys(Table::ArcErrors, arc, &self.nominal);
            }
            lines.by_name("thrust_n", self.nominal.thrusters.iter().map(|thruster| thruster.name), command.thrust_n);
            lines.by_name("torque_n_m", self.nominal.wheels.iter().map(|wheel| wheel.name), command.torque_n_m);
        }
        if !self.nominal.actuation.is_empty() {
            lines.keys_of("[actuators]", Table::Actuators, 0, &self.nominal);
        }
        if let Some(spec) = self.loop_spec() {
            control::write(spec, scene, lines);
        } else if let Some(law) = &self.law {
            lines.table("[control]");
            lines.key("law", law.name());
            lines.keys(Table::Control, 0, scene);
        }
        failure_tables::write(scene, lines);
    }
}
