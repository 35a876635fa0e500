//! Canonical text: every key with its value or default, in one order and spelling; it reads back to the same plan.
//!
//! Its SHA-256 (FIPS 180-4) identifies the plan. Floats have the fewest digits that read back to the same bits.
//!
//! The row plan is the part on which rows and their encoding depend: without the campaign's name, and with the number
//! of samples only if the design's points depend on it. Equal row hashes mean equal rows.

use super::draws::{design_lines, dispersion_lines};
use super::lines::Lines;
use super::plan::Plan;
use super::{bands, scene, settings};
use crate::loops::LoopSpec;
use crate::observables::request::NutationAxis;
use crate::sampling::keys::{Row, Value, Values, Written};
use crate::scene::SceneInput;
use crate::scene::table::Table;
use sha2::{Digest, Sha256};

fn digest(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Plan {
    pub fn text(&self) -> String {
        self.text_of(true)
    }

    /// The row plan.
    pub fn row_text(&self) -> String {
        self.text_of(false)
    }

    /// SHA-256 of the row plan, in hexadecimal.
    pub fn row_hash(&self) -> String {
        digest(&self.row_text())
    }

    /// Prefixes of the keys outside the row plan.
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

    fn text_of(&self, whole: bool) -> String {
        let mut lines = Lines::default();
        self.write_settings(&settings::HEAD, whole, &mut lines);
        self.write_scene(&mut lines);
        design_lines(&self.design, &mut lines);
        for dispersion in &self.dispersed {
            dispersion_lines(dispersion, &mut lines);
        }
        for correlation in &self.correlated {
            lines.rows("[[correlate]]", &correlation.written);
        }
        for replaced in self.dispersions.replaced_correlations() {
            lines.note(&format!("components: {}", replaced.names.join(", ")));
            lines.note(&format!("nearest correlation of the normal scores, which is used: {:?}", replaced.used));
        }
        for derivation in &self.derived {
            lines.rows("[[derive]]", &derivation.written);
        }
        self.write_settings(&settings::TAIL, whole, &mut lines);
        let is_of_rows = |header: &str| ["[[event]]", "[[extreme]]"].contains(&header);
        for (header, written) in self.tables.iter().filter(|(header, _)| whole || is_of_rows(header)) {
            lines.rows(header, written);
        }
        lines.into_text()
    }

    /// SHA-256 of the canonical text, in hexadecimal.
    pub fn hash(&self) -> String {
        digest(&self.text())
    }

    fn write_settings(&self, tables: &[(&str, &[Row])], whole: bool, lines: &mut Lines) {
        for (header, rows) in tables {
            let value = |row: &Row| {
                let path = format!("{header}.{}", row.key);
                let is_written = match path.as_str() {
                    "campaign.samples" => whole || self.design.facts().depends_on_samples.is_some(),
                    path => whole || !Self::OUTSIDE_ROWS.contains(&path),
                };
                Some((row.key, self.setting(&path).filter(|_| is_written)?))
            };
            let values = rows.iter().filter_map(value);
            let written = values.fold(Written::NONE, |written, (key, value)| written.with(key, value));
            lines.rows(&format!("[{header}]"), &written);
        }
    }

    fn setting(&self, path: &str) -> Option<Value> {
        Some(match path {
            "campaign.name" => self.name.as_str().into(),
            "campaign.description" => self.description.as_deref()?.into(),
            "campaign.samples" => self.first_samples().into(),
            "campaign.only" => Value::Counts(Values::Each(self.chosen.as_deref()?.to_vec())),
            "campaign.seed" => self.seed.into(),
            "campaign.duration_s" => self.grid.duration().into(),
            "integrator.method" => self.method.name().into(),
            "integrator.relative_tolerance" => self.tolerance.relative.into(),
            "integrator.absolute_tolerance" => self.tolerance.absolute.into(),
            "integrator.step_s" => self.step_s?.into(),
            "integrator.max_steps" => self.max_steps.into(),
            "observe.points" => (self.grid.points() as u64).into(),
            "observe.groups" => Value::Texts(self.groups.iter().map(|group| group.name().to_owned()).collect()),
            "observe.nutation_axis" => match self.nutation_axis {
                NutationAxis::SpinAxis => return None,
                NutationAxis::Principal => "principal".into(),
                NutationAxis::Along(axis) => axis[..].into(),
            },
            "audit.fraction" => self.audit_fraction.into(),
            "bands.points" => (self.band_points as u64).into(),
            "bands.runs" if self.band_runs != bands::RUNS => self.band_runs.into(),
            "output.compression" => self.compression.name().into(),
            _ => return None,
        })
    }

    fn write_scene(&self, lines: &mut Lines) {
        scene::write(&self.nominal, lines, |lines| {
            if let Some(spec) = self.loop_spec() {
                write_loop(spec, &self.nominal, lines);
            } else if let Some(law) = &self.law {
                lines.table("[control]");
                lines.key("law", law.name);
                lines.keys(Table::Control, 0, &self.nominal);
            }
        });
    }
}

fn write_loop(spec: &LoopSpec, scene: &SceneInput, lines: &mut Lines) {
    lines.rows("[control]", &spec.written);
    lines.keys(Table::Control, 0, scene);
    if spec.model != Written::NONE {
        lines.rows("[control.model]", &spec.model);
    }
    for (place, sensor) in spec.sensors.iter().enumerate() {
        lines.rows("[[sensors]]", &sensor.written);
        lines.keys(Table::Sensors, place, scene);
    }
    for (place, phase) in spec.phases.iter().enumerate() {
        lines.rows("[[guidance]]", &phase.written);
        lines.keys(Table::Guidance, place, scene);
    }
}
