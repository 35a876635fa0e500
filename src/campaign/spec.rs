//! [`Spec`]: a campaign file as written, key by key.
//!
//! Every key of the file is read here (those of `[[disperse]]` in [`super::disperse`]); a number that is missing or wrong is
//! NaN here and noted in the document. What is left out stays `None`: the plan fills it in.

use super::document::{Document, Limit, POSITIVE, Section};
use super::plan::Compression;
use super::{dependence, design, disperse};
use crate::observables::Group;
use crate::propagation::Method;
use crate::sampling::{Correlation, Derivation, Design, Dispersion};
use crate::scene::{
    ActuationInput, ActuatorsInput, DebrisInput, FuselageInput, InitialInput, MassErrors, PrincipalInertia,
    PrincipalMoments, SceneInput, WheelInput, WheelMode,
};

/// A campaign file as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    /// `campaign.name`: also the name of the folder of results.
    pub name: Option<String>,
    /// `campaign.samples`.
    pub samples: Option<u64>,
    /// `campaign.seed`.
    pub seed: Option<u64>,
    /// `campaign.duration_s`, s.
    pub duration_s: Option<f64>,
    /// `integrator.method`.
    pub method: Option<Method>,
    /// `integrator.tolerance`: both of the following.
    pub tolerance: Option<f64>,
    /// `integrator.relative_tolerance`.
    pub relative_tolerance: Option<f64>,
    /// `integrator.absolute_tolerance`.
    pub absolute_tolerance: Option<f64>,
    /// `integrator.step_s`, s, of a method with a fixed step.
    pub step_s: Option<f64>,
    /// `integrator.max_steps`.
    pub max_steps: Option<u64>,
    /// `observe.points`.
    pub points: Option<u64>,
    /// `observe.groups`.
    pub groups: Option<Vec<Group>>,
    /// The scene; NaN where a number is missing or wrong.
    pub scene: SceneInput,
    /// `[design]`; `None` where it is wrong.
    pub design: Option<Design>,
    /// `[[disperse]]`; `None` where a table is wrong.
    pub dispersions: Vec<Option<Dispersion>>,
    /// `[[correlate]]`; `None` where a table is wrong.
    pub correlations: Vec<Option<Correlation>>,
    /// `[[derive]]`; `None` where a table is wrong.
    pub derivations: Vec<Option<Derivation>>,
    /// `audit.fraction`.
    pub audit_fraction: Option<f64>,
    /// `output.compression`.
    pub compression: Option<Compression>,
}

/// Most samples of a campaign: ids stay exact in a double.
pub const MOST_SAMPLES: u64 = crate::sampling::dispersions::MOST_SAMPLES;
/// Largest seed: TOML integers are signed.
pub const LARGEST_SEED: u64 = i64::MAX as u64;
/// Most observation points of a run: each worker holds the states at all of them (some 40 numbers each).
pub const MOST_POINTS: u64 = 10_000_000;
/// Tolerances between a few units in the last place and the point where nothing is accurate any more.
const TOLERANCE: Limit = Limit {
    allowed: "a number from 1e-16 to 1e-2",
    remedy: "1e-10 is a good start",
    test: |x| (1e-16..=1e-2).contains(&x),
};

/// A share of the samples.
pub const FRACTION: Limit = Limit {
    allowed: "a number from 0 to 1",
    remedy: "0.01 runs one sample in a hundred again exactly, 1 all of them",
    test: |x| (0.0..=1.0).contains(&x),
};

impl Spec {
    /// Reads a document; what is wrong is noted there.
    pub fn read(document: &mut Document<'_>) -> Spec {
        let table = document.parse();
        let mut root = Section::root(document, &table);
        for (key, holds) in [
            ("campaign", "a table with name, samples, seed, duration_s"),
            ("fuselage", "a table with the fuselage's sizes and density"),
            ("initial", "a table with the state at time zero"),
        ] {
            if !root.has(key) {
                root.document.add(key, None, holds, format!("add a [{key}] table"));
            }
        }

        let design = design::read(&mut root.section("design"));
        let has_size = matches!(design, None | Some(Design::Grid(_) | Design::OneAtATime(_) | Design::Table(_)));

        let mut section = root.section("campaign");
        let name = name(&mut section);
        if !has_size {
            section.require("samples", "a whole number of at least 1", "1000");
        }
        let samples = section.count("samples", 1..=MOST_SAMPLES);
        section.require("seed", "a whole number of at least 0", "1");
        let seed = section.count("seed", 0..=LARGEST_SEED);
        section.require("duration_s", POSITIVE.allowed, "10.0");
        let duration_s = section.number("duration_s", POSITIVE);
        section.finish();

        let mut section = root.section("integrator");
        let method = section.name("method", &Method::ALL.map(Method::name), Method::from_name);
        let tolerance = section.number("tolerance", TOLERANCE);
        let relative_tolerance = section.number("relative_tolerance", TOLERANCE);
        let absolute_tolerance = section.number("absolute_tolerance", TOLERANCE);
        let step_s = section.number("step_s", POSITIVE);
        let max_steps = section.count("max_steps", 1..=LARGEST_SEED);
        section.finish();

        let mut section = root.section("observe");
        let points = section.count("points", 2..=MOST_POINTS);
        let groups = section.names("groups", &Group::ALL.map(Group::name), Group::from_name);
        section.finish();

        let scene = scene(&mut root);
        let dispersions = root.sections("disperse", disperse::read);
        let correlations = root.sections("correlate", dependence::correlation);
        let derivations = root.sections("derive", dependence::derivation);

        let mut section = root.section("audit");
        let audit_fraction = section.number("fraction", FRACTION);
        section.finish();

        let mut section = root.section("output");
        let names = Compression::ALL.map(Compression::name);
        let compression = section.name("compression", &names, Compression::from_name);
        section.finish();
        root.finish();

        Spec {
            name,
            samples,
            seed,
            duration_s,
            method,
            tolerance,
            relative_tolerance,
            absolute_tolerance,
            step_s,
            max_steps,
            points,
            groups,
            scene,
            design,
            dispersions,
            correlations,
            derivations,
            audit_fraction,
            compression,
        }
    }
}

/// A name that is a folder's name on every system.
fn name(section: &mut Section<'_, '_>) -> Option<String> {
    const ALLOWED: &str = "1 to 100 letters, digits, _, - or . (not the first)";
    section.require("name", ALLOWED, "\"my_campaign\"");
    let name = section.text("name")?;
    let plain = name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c));
    if !plain || name.starts_with('.') || name.is_empty() || name.len() > 100 {
        section.refuse("name", ALLOWED, "it names the folder of results: write it without spaces and slashes");
        return None;
    }
    Some(name.to_owned())
}

fn scene(root: &mut Section<'_, '_>) -> SceneInput {
    let has_actuation = root.has("actuation");
    let fuselage = fuselage(&mut root.section("fuselage"), has_actuation);
    let wheels = [wheel(&mut root.section("wheel1")), wheel(&mut root.section("wheel2"))];
    let debris = debris(&mut root.section("debris"));
    let initial = initial(&mut root.section("initial"), wheels.map(|wheel| wheel.is_some()), debris.is_some());
    let actuation = root.sections("actuation", actuation);
    if root.has("actuators") && !has_actuation {
        let remedy = "delete this table, or add [[actuation]] tables";
        root.refuse("actuators", "left out where there is no [[actuation]]", remedy);
    }
    let actuators = actuators(&mut root.section("actuators"));
    SceneInput { fuselage, wheels, debris, initial, actuation, actuators }
}

fn fuselage(section: &mut Section<'_, '_>, has_actuation: bool) -> FuselageInput {
    let fuselage = FuselageInput {
        wall_thickness_m: section.required_number("wall_thickness_m", "0.03"),
        outer_radius_m: section.required_number("outer_radius_m", "1.0"),
        length_m: section.required_number("length_m", "3.0"),
        density_kg_m3: section.required_number("density_kg_m3", "2700.0"),
        // Without actuation no force acts there, and nothing depends on the number.
        thruster_offset_m: if has_actuation {
            section.required_number("thruster_offset_m", "0.5")
        } else {
            section.optional_number("thruster_offset_m").unwrap_or(0.0)
        },
        mass_kg: section.optional_number("mass_kg"),
        center_of_mass_m: section.vector("center_of_mass_m"),
        inertia_kg_m2: section.matrix("inertia_kg_m2"),
        principal: principal(section),
        errors: MassErrors {
            mass_scale: section.optional_number("mass_scale").unwrap_or(1.0),
            stretch_log: section.vector("stretch_log").unwrap_or_default(),
            shear: section.vector("shear").unwrap_or_default(),
            center_offset_m: section.vector("center_offset_m").unwrap_or_default(),
        },
    };
    section.finish();
    fuselage
}

/// An inertia by principal moments and axes, if it was written; it excludes a tensor.
fn principal(section: &mut Section<'_, '_>) -> Option<PrincipalInertia> {
    const MOMENTS: &str = "principal_moments_kg_m2";
    const SECOND: &str = "principal_second_moments_kg_m2";
    let (inertia, second) = (section.vector(MOMENTS), section.vector(SECOND));
    let axes = section.vector("principal_axes");
    let written = if inertia.is_some() { MOMENTS } else { SECOND };
    if inertia.is_some() && second.is_some() {
        section.refuse(SECOND, format!("left out beside {MOMENTS}"), "delete one of the two");
    }
    if inertia.or(second).is_none() && axes.is_some() {
        let allowed = "left out where there are no principal moments";
        section.refuse("principal_axes", allowed, format!("delete this line, or add {MOMENTS}"));
    }
    if inertia.or(second).is_some() && section.has("inertia_kg_m2") {
        section.refuse("inertia_kg_m2", format!("left out beside {written}"), "delete one of the two");
    }
    let moments = inertia.map(PrincipalMoments::Inertia).or(second.map(PrincipalMoments::Second))?;
    Some(PrincipalInertia { moments, axes: axes.unwrap_or(IDENTITY) })
}

fn actuators(section: &mut Section<'_, '_>) -> ActuatorsInput {
    let ideal = ActuatorsInput::IDEAL;
    let actuators = ActuatorsInput {
        thrust_scale: section.vector("thrust_scale").unwrap_or(ideal.thrust_scale),
        thruster1_tilt_rad: section.vector("thruster1_tilt_rad").unwrap_or_default(),
        thruster2_tilt_rad: section.vector("thruster2_tilt_rad").unwrap_or_default(),
        thruster3_tilt_rad: section.vector("thruster3_tilt_rad").unwrap_or_default(),
        switch_on_delay_s: section.optional_number("switch_on_delay_s").unwrap_or(0.0),
        switch_off_delay_s: section.optional_number("switch_off_delay_s").unwrap_or(0.0),
        torque_scale: section.vector("torque_scale").unwrap_or(ideal.torque_scale),
        torque_bias_n_m: section.vector("torque_bias_n_m").unwrap_or_default(),
    };
    section.finish();
    actuators
}

fn wheel(section: &mut Section<'_, '_>) -> Option<WheelInput> {
    if !section.is_present() {
        return None;
    }
    let wheel = WheelInput {
        radius_m: section.required_number("radius_m", "0.25"),
        length_m: section.required_number("length_m", "0.1"),
        station_m: section.required_number("station_m", "1.0"),
        density_kg_m3: section.required_number("density_kg_m3", "2700.0"),
        offset_m: section.vector("offset_m").unwrap_or_default(),
        tilt_rad: section.vector("tilt_rad").unwrap_or_default(),
        mode: section
            .name("wheel_mode", &WheelMode::ALL.map(WheelMode::name), WheelMode::from_name)
            .unwrap_or_default(),
    };
    section.finish();
    Some(wheel)
}

fn debris(section: &mut Section<'_, '_>) -> Option<DebrisInput> {
    if !section.is_present() {
        return None;
    }
    const IRREGULAR: [&str; 4] =
        ["mass_kg", "inertia_kg_m2", "principal_moments_kg_m2", "principal_second_moments_kg_m2"];
    let is_irregular = IRREGULAR.iter().any(|key| section.has(key));
    let debris = if is_irregular { irregular_debris(section) } else { solid_debris(section) };
    section.finish();
    Some(debris)
}

/// A cube or a box.
fn solid_debris(section: &mut Section<'_, '_>) -> DebrisInput {
    let (side, size) = (section.optional_number("side_m"), section.vector("size_m"));
    if side.is_some() && size.is_some() {
        section.refuse("size_m", "left out beside side_m", "delete side_m or size_m");
    }
    let side_m = match (side, size) {
        (None, None) => section.required_number("side_m", "0.2"),
        _ => side.unwrap_or(f64::NAN),
    };
    let density_kg_m3 = section.required_number("density_kg_m3", "2700.0");
    match (side, size) {
        (None, Some(size_m)) => DebrisInput::Box { size_m, density_kg_m3 },
        _ => DebrisInput::Cube { side_m, density_kg_m3 },
    }
}

/// Any rigid body, by mass and inertia.
fn irregular_debris(section: &mut Section<'_, '_>) -> DebrisInput {
    let mass_kg = section.required_number("mass_kg", "21.6");
    let (tensor, principal) = (section.matrix("inertia_kg_m2"), principal(section));
    for key in ["side_m", "size_m", "density_kg_m3"] {
        if section.has(key) {
            section.refuse(key, "left out where the debris is given by mass and inertia", "delete this line");
        }
    }
    match (tensor, principal) {
        (_, Some(principal)) => DebrisInput::Principal { mass_kg, principal },
        (Some(inertia_kg_m2), None) => DebrisInput::Tensor { mass_kg, inertia_kg_m2 },
        (None, None) => {
            let allowed = "given beside mass_kg (or principal_moments_kg_m2, principal_second_moments_kg_m2)";
            section.require("inertia_kg_m2", allowed, "[[3, 0, 0], [0, 3, 0], [0, 0, 2]]");
            DebrisInput::Tensor { mass_kg, inertia_kg_m2: [[f64::NAN; 3]; 3] }
        }
    }
}

const IDENTITY: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

fn initial(section: &mut Section<'_, '_>, wheels: [bool; 2], has_debris: bool) -> InitialInput {
    section.require("angular_velocity_rad_s", "an array of 3 finite numbers", "[0.0, 0.0, 1.0]");
    let initial = InitialInput {
        position_m: section.vector("position_m").unwrap_or_default(),
        velocity_m_s: section.vector("velocity_m_s").unwrap_or_default(),
        attitude: section.vector("attitude").unwrap_or(IDENTITY),
        angular_velocity_rad_s: section.vector("angular_velocity_rad_s").unwrap_or([f64::NAN; 3]),
        wheel_angles_rad: section.vector("wheel_angles_rad").unwrap_or_default(),
        wheel_rates_rad_s: section.vector("wheel_rates_rad_s").unwrap_or_default(),
        debris_position_m: section.vector("debris_position_m").unwrap_or_default(),
        debris_velocity_m_s: section.vector("debris_velocity_m_s").unwrap_or_default(),
        debris_attitude: section.vector("debris_attitude").unwrap_or(IDENTITY),
        debris_relative_angular_velocity_rad_s: section
            .vector("debris_relative_angular_velocity_rad_s")
            .unwrap_or_default(),
    };
    for (key, values) in
        [("wheel_angles_rad", initial.wheel_angles_rad), ("wheel_rates_rad_s", initial.wheel_rates_rad_s)]
    {
        if let Some(k) = (0..2).find(|k| !wheels[*k] && values[*k] != 0.0 && values[*k].is_finite()) {
            let allowed = format!("0 for wheel {}, which this spacecraft does not have", k + 1);
            section.refuse(key, allowed, format!("write 0 there, or add a [wheel{}] table", k + 1));
        }
    }
    if !has_debris {
        for key in
            ["debris_position_m", "debris_velocity_m_s", "debris_attitude", "debris_relative_angular_velocity_rad_s"]
        {
            if section.has(key) {
                section.refuse(key, "left out where there is no debris", "delete this line, or add a [debris] table");
            }
        }
    }
    section.finish();
    initial
}

fn actuation(section: &mut Section<'_, '_>) -> ActuationInput {
    let actuation = ActuationInput {
        start_s: section.required_number("start_s", "0.0"),
        end_s: section.required_number("end_s", "1.0"),
        thrust_n: section.vector("thrust_n").unwrap_or_default(),
        torque_n_m: section.vector("torque_n_m").unwrap_or_default(),
    };
    section.finish();
    actuation
}
