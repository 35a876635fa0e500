//! The ground track: where on the Earth the run passes, in light and in shadow.

use core::f64::consts::TAU;

use crate::ensemble::SingleRun;
use crate::math::vector::{scaled, sum};
use crate::report::figure::{Axis, Dash, Figure, FigureSection, Hue, Mark, PointShape};
use crate::report::over_time::curves::Curves;
use crate::report::over_time::figure_list::ListedFigure;
use crate::report::surroundings::{Surroundings, turning_rate};
use crate::run::StateField;

/// Between two points of the curve the orbit turns by this angle at most, rad.
const STEP: f64 = 2.0 / 360.0 * TAU;
/// Points of the run that are farther apart than this are not joined, rad.
const FARTHEST: f64 = TAU / 5.0;
/// So many revolutions are shown: more cover each other.
const REVOLUTIONS: f64 = 16.0;
/// Coordinates are rounded to multiples of this, deg: they take less space on a page.
const UNIT: f64 = 1.0 / 1024.0;

/// A place on the Earth below the run.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Passed {
    /// deg, from -180 to 180.
    longitude: f64,
    /// deg.
    latitude: f64,
    /// Whether the Earth hides a part of the Sun.
    is_dark: bool,
}

/// A part of the track in one line.
#[derive(Clone, Debug, Default, PartialEq)]
struct Part {
    is_dark: bool,
    longitudes: Vec<f64>,
    latitudes: Vec<f64>,
}

impl Curves<'_> {
    /// The track of the run; `None` where there is none.
    pub(super) fn ground_track(&self, listed: &ListedFigure) -> Option<Figure> {
        let run = self.run?;
        let track = Track::of(run, &self.times())?;
        let first = *track.places.first()?;
        let name = |is_dark| if is_dark { "in shadow" } else { "in sunlight" };
        let look = |is_dark| if is_dark { (Hue::Reference, Dash::Dotted) } else { (listed.hue, Dash::Solid) };
        let line = |part: Part| {
            let (hue, dash) = look(part.is_dark);
            Mark::line(name(part.is_dark), hue, dash, part.longitudes, part.latitudes)
        };
        let points = |label: &str, hue, shape, places: Vec<Passed>| Mark::Points {
            label: label.to_owned(),
            hue,
            shape,
            x: places.iter().map(|place| place.longitude).collect(),
            y: places.iter().map(|place| place.latitude).collect(),
            samples: Vec::new(),
        };
        let mut marks: Vec<Mark> = if track.is_joined {
            parts(&track.places).into_iter().map(line).collect()
        } else {
            let of = |is_dark| track.places.iter().copied().filter(|place| place.is_dark == is_dark).collect();
            [false, true].map(|is_dark| points(name(is_dark), look(is_dark).0, PointShape::Disc, of(is_dark))).into()
        };
        marks.push(points("start", Hue::Nominal, PointShape::Disc, vec![first]));
        let mut caption =
            "Nominal run: the place below it, by geocentric latitude; in shadow, the Earth hides a part of the Sun."
                .to_owned();
        if track.is_cut {
            caption += &format!(" The first {REVOLUTIONS} revolutions.");
        }
        if !track.is_joined {
            caption += " The times of the run are too far apart for a line.";
        }
        Some(Figure {
            name: "ground_track".to_owned(),
            section: FigureSection::Time,
            title: listed.title.to_owned(),
            caption,
            columns: 6,
            is_over_time: false,
            x: Axis::of_globe("longitude", 180.0),
            y: Axis::of_globe(listed.quantity, 90.0),
            marks,
        })
    }
}

/// The places below a run.
#[derive(Clone, Debug)]
struct Track {
    places: Vec<Passed>,
    /// Whether its points are so near that a line between them is the track.
    is_joined: bool,
    /// Whether the run goes on.
    is_cut: bool,
}

impl Track {
    /// That of `run`, which reached the times `times`; `None` without a date, or where it reached none beyond the
    /// start.
    fn of(run: &SingleRun, times: &[f64]) -> Option<Self> {
        let around = Surroundings::of(&run.scene)?;
        let state = |point: usize| {
            [StateField::ComPosition, StateField::ComVelocity].map(|field| run.table.at::<3>(field, point))
        };
        let place = |time: f64, position: [f64; 3]| {
            let [longitude, latitude] = around.below(time, position)?.map(|angle| UNIT * libm::round(angle / UNIT));
            let (_, hidden) = around.sun(time, position)?;
            Some(Passed { longitude, latitude, is_dark: hidden > 0.0 })
        };
        let turned = |point: usize| {
            let rates = [point, point + 1].map(|point| {
                let [position, velocity] = state(point);
                turning_rate(position, velocity)
            });
            0.5 * (rates[0] + rates[1]) * (times[point + 1] - times[point])
        };
        let intervals = times.len().checked_sub(1).filter(|intervals| *intervals > 0)?;
        let is_joined = (0..intervals).all(|point| turned(point) < FARTHEST);
        let (mut places, mut all) = (vec![place(times[0], state(0)[0])?], 0.0);
        for point in 0..intervals {
            let steps = if is_joined { libm::ceil(turned(point) / STEP).max(1.0) } else { 1.0 };
            for step in 1..=steps as usize {
                let share = step as f64 / steps;
                let length = times[point + 1] - times[point];
                places.push(place(
                    times[point] + share * length,
                    between([state(point), state(point + 1)], length, share),
                )?);
            }
            all += turned(point);
            if all > REVOLUTIONS * TAU {
                return Some(Track { places, is_joined, is_cut: point + 1 < intervals });
            }
        }
        Some(Track { places, is_joined, is_cut: false })
    }
}

/// The position at the part `s` of an interval of `length` seconds between two states: the cubic with their positions
/// and velocities.
fn between([from, to]: [[[f64; 3]; 2]; 2], length: f64, s: f64) -> [f64; 3] {
    let r = 1.0 - s;
    let start = sum(scaled(r * r * (1.0 + 2.0 * s), from[0]), scaled(r * r * s * length, from[1]));
    let end = sum(scaled(s * s * (1.0 + 2.0 * r), to[0]), scaled(-s * s * r * length, to[1]));
    sum(start, end)
}

/// The track as lines: one ends where light changes, and at a longitude of 180 deg, beyond which another goes on.
fn parts(places: &[Passed]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let mut before: Option<Passed> = None;
    for place in places {
        let mut start = None;
        if let (Some(last), Some(part)) = (before, parts.last_mut()) {
            let step = place.longitude - last.longitude;
            if step.abs() > 180.0 {
                // across the edge, by the shorter way
                let edge = 180.0_f64.copysign(last.longitude);
                let share = (edge - last.longitude) / (step - 360.0_f64.copysign(step));
                let latitude = last.latitude + share * (place.latitude - last.latitude);
                part.push(edge, latitude);
                parts.push(Part { is_dark: last.is_dark, ..Part::default() });
                start = Some((-edge, latitude));
            }
        }
        let is_new = before.is_none_or(|last| last.is_dark != place.is_dark);
        if let Some(part) = parts.last_mut() {
            start.into_iter().for_each(|(longitude, latitude)| part.push(longitude, latitude));
            part.push(place.longitude, place.latitude);
        }
        if is_new {
            let (longitudes, latitudes) = (vec![place.longitude], vec![place.latitude]);
            parts.push(Part { is_dark: place.is_dark, longitudes, latitudes });
        }
        before = Some(*place);
    }
    parts
}

impl Part {
    fn push(&mut self, longitude: f64, latitude: f64) {
        self.longitudes.push(longitude);
        self.latitudes.push(latitude);
    }
}
