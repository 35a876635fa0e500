//! [`Plan::implausible`]: numbers that can be computed with, and look like a mistake: degrees for radians, revolutions for radians, a wheel
//! outside of its body, an arc after the end of the run.
//!
//! Each note says key and value, why it looks implausible, and what is usual. Nothing is refused: bodies of other scales are allowed.

use std::f64::consts::{PI, TAU};

use super::digits::digits;
use super::draw::SceneDraws;
use super::plan::Plan;
use super::positions;
use super::without_effect::earliest_arcs;
use crate::sampling::SampleId;
use crate::sampling::distribution::attitude_error::AttitudeError;
use crate::sampling::distribution::{Nested, Quantile, WrittenDistribution};
use crate::sampling::keys::Values;
use crate::scene::magnitude::Magnitude;
use crate::scene::{Parameter, SceneInput, WheelInput};
use crate::statistics::quantile::quantile;

/// An angular velocity of a body from which on it is noted, rad/s: five turns per second. The fastest spin-stabilised stages turn once a second.
const FAST_BODY: f64 = 30.0;
/// A rate of a wheel from which on it is noted, rad/s: some 60,000 rpm. Reaction wheels have up to 6,000, flywheels of magnetic bearings 40,000.
const FAST_WHEEL: f64 = 6283.0;
/// A speed of the rim of a wheel from which on it is noted, m/s. The hoop stress of a thin ring is density times speed squared: at this speed
/// 1.95 GPa in steel, which is the strength of the strongest.
const FAST_RIM: f64 = 500.0;
/// An alignment error from which on it is noted, rad: 5.7 degrees. A tenth of a degree and more, typed as radians, is beyond it.
const LARGE_TILT: f64 = 0.1;
/// A standard deviation of an attitude from which on it is noted, rad: the attitudes are then nearly uniform.
const LARGE_ATTITUDE: f64 = 0.5 * PI;
/// Most draws that are looked at.
const DRAWS: u64 = 1000;
/// The fraction of the draws that may be beyond a limit.
const FEW: f64 = 0.01;

impl Plan {
    /// The numbers of the plan that look like a mistake, one sentence or two each.
    pub fn implausible(&self) -> Vec<String> {
        let mut notes = self.sizes();
        notes.extend(self.spreads_of_attitudes());
        notes.extend(positions::implausible(&self.nominal));
        notes.extend(self.late_arcs());
        notes
    }

    /// Rates, angles and alignment errors, of the nominal scene or as they are dispersed.
    fn sizes(&self) -> Vec<String> {
        let scene = &self.nominal;
        let judged: Vec<Judged> = Parameter::all(scene).filter_map(|parameter| Judged::of(parameter, scene)).collect();
        let mut draws = SceneDraws::new(self);
        let mut drawn: Vec<Vec<f64>> = vec![Vec::new(); judged.len()];
        for sample in 1..self.samples.min(DRAWS + 1) {
            let input = draws.input(SampleId(sample));
            judged.iter().zip(&mut drawn).for_each(|(one, sizes)| sizes.push(one.size(input, scene)));
        }
        let note = |(one, mut sizes): (&Judged, Vec<f64>)| {
            let (name, nominal) = (one.parameter.name(), one.size(scene, scene));
            if nominal >= one.limit() {
                let values: Vec<f64> =
                    (0..one.parameter.width()).filter_map(|component| one.parameter.value(scene, component)).collect();
                let value = if let [value] = values[..] { format!("{value:?}") } else { format!("{values:?}") };
                return Some(format!("{name} = {value}: {}", one.text(nominal, scene)));
            }
            sizes.retain(|size| !size.is_nan());
            sizes.sort_by(f64::total_cmp);
            let large = quantile(&sizes, 1.0 - FEW).filter(|size| *size >= one.limit())?;
            Some(format!("{name}, as dispersed: 1 draw in 100 is beyond this: {}", one.text(large, scene)))
        };
        judged.iter().zip(drawn).filter_map(note).collect()
    }

    /// Distributions of attitudes whose angles are beyond what a rotation has.
    fn spreads_of_attitudes(&self) -> Vec<String> {
        let note = |(index, written): (usize, &WrittenDistribution)| {
            let name = self.dispersed[index].parameter.name();
            match written {
                WrittenDistribution::AttitudeError(error) => {
                    let (key, std) = match error {
                        AttitudeError::Std(Values::All(std)) => ("std_rad", *std),
                        AttitudeError::Std(Values::Each(list)) => ("std_rad", list.iter().copied().fold(0.0, f64::max)),
                        AttitudeError::Covariance(m) => ("covariance_rad2", m[0][0].max(m[1][1]).max(m[2][2]).sqrt()),
                    };
                    (std >= LARGE_ATTITUDE).then(|| {
                        format!(
                            "disperse[{index}].{key} of {name}: a standard deviation of {} rad is {} deg: nearly every attitude is as likely; usual are below 0.2 rad; degrees are written with their unit, \"2 deg\", and distribution = \"uniform_attitude\" has no preferred attitude",
                            digits(std),
                            digits(std.to_degrees()),
                        )
                    })
                }
                WrittenDistribution::AboutAxis(about) => {
                    let angle = about.angle.quantile(index, "angle_rad", 0.0).ok()?;
                    let largest = [FEW, 1.0 - FEW].map(|p| angle.quantile(p).abs()).into_iter().fold(0.0, f64::max);
                    (largest > TAU).then(|| {
                        format!(
                            "disperse[{index}].angle_rad of {name}: 1 draw in 100 is beyond an angle of {} rad, {} deg, more than a turn; usual are angles of at most pi to either side; degrees are written with their unit, \"30 deg\"",
                            digits(largest),
                            digits(largest.to_degrees()),
                        )
                    })
                }
                _ => None,
            }
        };
        self.dispersed.iter().map(|dispersion| &dispersion.distribution).enumerate().filter_map(note).collect()
    }

    /// Arcs of the schedule that are not flown, or not to their end.
    fn late_arcs(&self) -> Vec<String> {
        let (arcs, duration) = (&self.nominal.actuation, self.grid.duration());
        let usual = format!("usual are arcs within campaign.duration_s = {duration:?}");
        let earliest = earliest_arcs(&self.nominal, &self.dispersions);
        // whether an arc is late: of its earliest start and its commanded end
        let note = |key: &str, time: fn(f64, f64) -> f64, what: &str, is_late: &dyn Fn(f64, f64) -> bool| {
            let late = |(index, arc): &(usize, &crate::scene::ActuationInput)| is_late(earliest[*index][0], arc.end_s);
            let mut late = arcs.iter().enumerate().filter(late);
            let (index, arc) = late.next()?;
            let others = match late.count() {
                0 => String::new(),
                1 => ", and one more arc".to_owned(),
                more => format!(", and {more} more arcs"),
            };
            let value = time(arc.start_s, arc.end_s);
            Some(format!("actuation[{index}].{key} = {value:?}{others}: {what}; {usual}"))
        };
        let never = note(
            "start_s",
            |start, _| start,
            "it starts at the end of the run or later, and never acts",
            &|start, _| start >= duration,
        );
        let cut =
            note("end_s", |_, end| end, "the run ends before, and the rest of the arc is not flown", &|start, end| {
                start < duration && end > duration
            });
        never.into_iter().chain(cut).collect()
    }
}

/// What is judged of a parameter.
#[derive(Clone, Copy)]
struct Judged {
    parameter: Parameter,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    /// The angular velocity of a body.
    Rate(Magnitude),
    /// The alignment error of a wheel or thruster.
    Tilt(Magnitude),
    /// An angle of a wheel.
    Angle,
    /// The rate of the wheel of this index.
    Wheel(usize),
}

impl Judged {
    /// `None` where nothing is known of what is usual, or the scene does not have it.
    fn of(parameter: Parameter, scene: &SceneInput) -> Option<Self> {
        parameter.value(scene, 0)?;
        let magnitude = Magnitude::of(parameter);
        let kind = match (parameter.facts().key, magnitude) {
            ("tilt_rad", Some(tilt)) => Kind::Tilt(tilt),
            ("angular_velocity_rad_s" | "debris_relative_angular_velocity_rad_s", Some(rate)) => Kind::Rate(rate),
            ("angle_rad", _) => Kind::Angle,
            ("rate_rad_s", _) => {
                let is_its = |wheel: &WheelInput| parameter.name() == format!("wheels.{}.rate_rad_s", wheel.name);
                Kind::Wheel(scene.wheels.iter().position(is_its)?)
            }
            _ => return None,
        };
        Some(Judged { parameter, kind })
    }

    /// What is compared with the limit: of a wheel the rate over that which is noted, or its rim's speed over that.
    fn size(self, scene: &SceneInput, nominal: &SceneInput) -> f64 {
        match self.kind {
            Kind::Rate(magnitude) | Kind::Tilt(magnitude) => magnitude.value(scene, nominal),
            Kind::Angle => self.parameter.value(scene, 0).unwrap_or(f64::NAN).abs(),
            Kind::Wheel(wheel) => {
                let wheel = &scene.wheels[wheel];
                let rate = wheel.rate_rad_s.abs();
                (rate / FAST_WHEEL).max(rate * rim(wheel).1 / FAST_RIM)
            }
        }
    }

    fn limit(self) -> f64 {
        match self.kind {
            Kind::Rate(_) => FAST_BODY,
            Kind::Tilt(_) => LARGE_TILT,
            Kind::Angle => TAU,
            Kind::Wheel(_) => 1.0,
        }
    }

    /// Why the size looks implausible, and what is usual.
    fn text(self, size: f64, nominal: &SceneInput) -> String {
        match self.kind {
            Kind::Rate(_) => format!(
                "an angular velocity of {} rad/s is {} deg/s, {} turns/s; usual are below 1 rad/s, of a spinning body below 10 rad/s; degrees are written with their unit, \"30 deg/s\"",
                digits(size),
                digits(size.to_degrees()),
                digits(size / TAU),
            ),
            Kind::Tilt(_) => format!(
                "an alignment error of {} rad is {} deg; usual are below 0.02 rad (1 deg); degrees are written with their unit, \"0.1 deg\", and a nominal direction by its vector",
                digits(size),
                digits(size.to_degrees()),
            ),
            Kind::Angle => format!(
                "an angle of {} rad is more than a turn, {} deg; usual are 0 to 2 pi; degrees are written with their unit, \"30 deg\"",
                digits(size),
                digits(size.to_degrees()),
            ),
            Kind::Wheel(wheel) => {
                let (what, radius) = rim(&nominal.wheels[wheel]);
                // the rate that has this size
                let rate = size * FAST_WHEEL.min(FAST_RIM / radius);
                format!(
                    "a rate of {} rad/s is {} rpm, {} m/s at {what}; usual are up to 6000 rpm and 150 m/s: above some 500 m/s at the rim the hoop stress (density times speed squared) breaks steel; revolutions are written with their unit, \"3000 rpm\"",
                    digits(rate),
                    digits(rate * 60.0 / TAU),
                    digits(rate * radius),
                )
            }
        }
    }
}

/// What of a wheel has the largest speed that is known, and its distance from the axis, m: the rim, or where mass and inertia are given, the
/// radius of gyration, which the rim is beyond.
fn rim(wheel: &WheelInput) -> (&'static str, f64) {
    match (wheel.radius_m, wheel.mass_kg, wheel.axial_inertia_kg_m2) {
        (Some(radius), ..) => ("the rim", radius),
        (None, Some(mass), Some(axial)) => ("its radius of gyration, more at the rim", (axial / mass).sqrt()),
        _ => ("the rim", 0.0),
    }
}
