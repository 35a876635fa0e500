//! A plan as text: every key with its value, defaults too, in one order and one spelling; it reads back to the same plan.
//!
//! Its SHA-256 (FIPS 180-4) is the plan's identity, which `sha256sum` reproduces. Floats are written with the fewest digits
//! that read back to the same bits.

use super::canonical_draws::{correlation_lines, derivation_lines, design_lines, dispersion_lines};
use super::plan::Plan;
use crate::sampling::Values;
use crate::scene::{DebrisInput, PrincipalInertia, PrincipalMoments};
use sha2::{Digest, Sha256};

/// A table's lines while they are written.
pub(super) struct Lines(String);

impl Lines {
    pub(super) fn table(&mut self, header: &str) {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
        self.0.push_str(header);
        self.0.push('\n');
    }

    /// `value` in its Debug form: of floats, lists of floats, whole numbers and plain text that form is TOML.
    pub(super) fn key(&mut self, key: &str, value: impl std::fmt::Debug) {
        self.0.push_str(&format!("{key} = {value:?}\n"));
    }

    pub(super) fn values(&mut self, key: &str, values: &Values) {
        match values {
            Values::All(value) => self.key(key, value),
            Values::Each(list) => self.key(key, list),
        }
    }
}

impl Plan {
    /// The plan as canonical text.
    pub fn text(&self) -> String {
        let mut lines = Lines(String::new());
        lines.table("[campaign]");
        lines.key("name", &self.name);
        lines.key("samples", self.samples);
        lines.key("seed", self.seed);
        lines.key("duration_s", self.grid.duration());
        lines.table("[integrator]");
        lines.key("method", self.method.name());
        lines.key("relative_tolerance", self.tolerance.relative);
        lines.key("absolute_tolerance", self.tolerance.absolute);
        if let Some(step) = self.step_s {
            lines.key("step_s", step);
        }
        lines.key("max_steps", self.max_steps);
        lines.table("[observe]");
        lines.key("points", self.grid.points());
        lines.key("groups", self.groups.iter().map(|group| group.name()).collect::<Vec<_>>());
        self.write_bodies(&mut lines);
        self.write_state(&mut lines);
        design_lines(&self.design, &mut lines);
        for dispersion in &self.dispersed {
            dispersion_lines(dispersion, &mut lines);
        }
        for correlation in &self.correlated {
            correlation_lines(correlation, &mut lines);
        }
        for derivation in &self.derived {
            derivation_lines(derivation, &mut lines);
        }
        lines.table("[audit]");
        lines.key("fraction", self.audit_fraction);
        lines.table("[output]");
        lines.key("compression", self.compression.name());
        lines.0
    }

    /// SHA-256 of the canonical text, in hexadecimal.
    pub fn hash(&self) -> String {
        Sha256::digest(self.text().as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
    }

    fn write_bodies(&self, lines: &mut Lines) {
        let fuselage = &self.nominal.fuselage;
        lines.table("[fuselage]");
        lines.key("wall_thickness_m", fuselage.wall_thickness_m);
        lines.key("outer_radius_m", fuselage.outer_radius_m);
        lines.key("length_m", fuselage.length_m);
        lines.key("density_kg_m3", fuselage.density_kg_m3);
        lines.key("thruster_offset_m", fuselage.thruster_offset_m);
        if let Some(mass) = fuselage.mass_kg {
            lines.key("mass_kg", mass);
        }
        if let Some(center) = fuselage.center_of_mass_m {
            lines.key("center_of_mass_m", center);
        }
        if let Some(inertia) = fuselage.inertia_kg_m2 {
            lines.key("inertia_kg_m2", inertia);
        }
        if let Some(principal) = &fuselage.principal {
            write_principal(principal, lines);
        }
        lines.key("mass_scale", fuselage.errors.mass_scale);
        lines.key("stretch_log", fuselage.errors.stretch_log);
        lines.key("shear", fuselage.errors.shear);
        lines.key("center_offset_m", fuselage.errors.center_offset_m);
        for (wheel, header) in self.nominal.wheels.iter().zip(["[wheel1]", "[wheel2]"]) {
            if let Some(wheel) = wheel {
                lines.table(header);
                lines.key("radius_m", wheel.radius_m);
                lines.key("length_m", wheel.length_m);
                lines.key("station_m", wheel.station_m);
                lines.key("density_kg_m3", wheel.density_kg_m3);
                lines.key("offset_m", wheel.offset_m);
                lines.key("tilt_rad", wheel.tilt_rad);
                lines.key("wheel_mode", wheel.mode.name());
            }
        }
        if let Some(debris) = &self.nominal.debris {
            lines.table("[debris]");
            match debris {
                DebrisInput::Cube { side_m, density_kg_m3 } => {
                    lines.key("side_m", side_m);
                    lines.key("density_kg_m3", density_kg_m3);
                }
                DebrisInput::Box { size_m, density_kg_m3 } => {
                    lines.key("size_m", size_m);
                    lines.key("density_kg_m3", density_kg_m3);
                }
                DebrisInput::Tensor { mass_kg, inertia_kg_m2 } => {
                    lines.key("mass_kg", mass_kg);
                    lines.key("inertia_kg_m2", inertia_kg_m2);
                }
                DebrisInput::Principal { mass_kg, principal } => {
                    lines.key("mass_kg", mass_kg);
                    write_principal(principal, lines);
                }
            }
        }
    }

    fn write_state(&self, lines: &mut Lines) {
        let initial = &self.nominal.initial;
        lines.table("[initial]");
        lines.key("position_m", initial.position_m);
        lines.key("velocity_m_s", initial.velocity_m_s);
        lines.key("attitude", initial.attitude);
        lines.key("angular_velocity_rad_s", initial.angular_velocity_rad_s);
        lines.key("wheel_angles_rad", initial.wheel_angles_rad);
        lines.key("wheel_rates_rad_s", initial.wheel_rates_rad_s);
        if self.nominal.debris.is_some() {
            lines.key("debris_position_m", initial.debris_position_m);
            lines.key("debris_velocity_m_s", initial.debris_velocity_m_s);
            lines.key("debris_attitude", initial.debris_attitude);
            lines.key("debris_relative_angular_velocity_rad_s", initial.debris_relative_angular_velocity_rad_s);
        }
        for actuation in &self.nominal.actuation {
            lines.table("[[actuation]]");
            lines.key("start_s", actuation.start_s);
            lines.key("end_s", actuation.end_s);
            lines.key("thrust_n", actuation.thrust_n);
            lines.key("torque_n_m", actuation.torque_n_m);
        }
        if !self.nominal.actuation.is_empty() {
            let actuators = &self.nominal.actuators;
            lines.table("[actuators]");
            lines.key("thrust_scale", actuators.thrust_scale);
            lines.key("thruster1_tilt_rad", actuators.thruster1_tilt_rad);
            lines.key("thruster2_tilt_rad", actuators.thruster2_tilt_rad);
            lines.key("thruster3_tilt_rad", actuators.thruster3_tilt_rad);
            lines.key("switch_on_delay_s", actuators.switch_on_delay_s);
            lines.key("switch_off_delay_s", actuators.switch_off_delay_s);
            lines.key("torque_scale", actuators.torque_scale);
            lines.key("torque_bias_n_m", actuators.torque_bias_n_m);
        }
    }
}

fn write_principal(principal: &PrincipalInertia, lines: &mut Lines) {
    match principal.moments {
        PrincipalMoments::Inertia(moments) => lines.key("principal_moments_kg_m2", moments),
        PrincipalMoments::Second(moments) => lines.key("principal_second_moments_kg_m2", moments),
    }
    lines.key("principal_axes", principal.axes);
}
