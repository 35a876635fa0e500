//! A still of the replay as SVG, for print and for browsers without scripts or WebGL: the bodies, where s3 points, and the path to the debris at
//! scale, in an orthographic view from the direction of the replay's camera.

use std::fmt::Write as _;

use crate::campaign::Plan;
use crate::ensemble::SingleRun;
use crate::math::vector::{cross, dcm_from_quaternion, difference, dot, norm, product, scaled, sum};
use crate::report::page::readable::with_unit;
use crate::report::page::replay::{ShownPart, approach_goal, keep_out, shown_parts};
use crate::report::page::sky;
use crate::run::StateField;
use crate::scene::WheelMode;

/// Side of a panel, in units of the drawing.
const SIDE: f64 = 380.0;
/// What is left free around it.
const MARGIN: f64 = 34.0;
const CORNERS: usize = 24;
/// Points of a curve, at most.
const MOST_POINTS: usize = 400;
/// Where the camera is, as that of the replay.
const CAMERA: [f64; 3] = [0.75, 0.5, 0.42];

/// A drawing of things in space.
#[derive(Default)]
struct Drawing {
    /// Class, points in space, and whether it counts for the extent.
    lines: Vec<(&'static str, Vec<[f64; 3]>)>,
    /// Class, centre and radius of spheres.
    spheres: Vec<(&'static str, [f64; 3], f64)>,
    /// Where a label is, what it says, and whether it is below its point.
    labels: Vec<([f64; 3], String, bool)>,
}

/// The components of `point` to the right of the picture and upwards.
fn projected(point: [f64; 3]) -> [f64; 2] {
    let unit = |v: [f64; 3]| scaled(1.0 / norm(v), v);
    let towards = unit(CAMERA);
    let right = unit(cross([0.0, 0.0, 1.0], towards));
    [dot(point, right), dot(point, cross(towards, right))]
}

impl Drawing {
    /// As the content of a panel whose left edge is at `left`, with a bar of a round length where `has_bar`.
    fn svg(&self, left: f64, has_bar: bool) -> String {
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut take = |point: [f64; 3], radius: f64| {
            for (end, at) in ends.iter_mut().zip(projected(point)) {
                *end = [end[0].min(at - radius), end[1].max(at + radius)];
            }
        };
        self.lines.iter().flat_map(|(_, points)| points).for_each(|point| take(*point, 0.0));
        self.spheres.iter().for_each(|(_, center, radius)| take(*center, *radius));
        let span = ends.iter().map(|[low, high]| high - low).fold(1e-9, f64::max);
        let scale = (SIDE - 2.0 * MARGIN) / span;
        let [middle_x, middle_y] = ends.map(|[low, high]| 0.5 * (low + high));
        let place = |point: [f64; 3]| {
            let [x, y] = projected(point);
            [left + 0.5 * SIDE + scale * (x - middle_x), 0.5 * SIDE - scale * (y - middle_y)]
        };
        let mut text = String::new();
        // writing to a String does not fail
        for (class, center, radius) in &self.spheres {
            let [x, y] = place(*center);
            let _ = write!(
                text,
                "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.1}\"/>",
                (scale * radius).max(2.5)
            );
        }
        for (class, points) in &self.lines {
            let points: Vec<String> =
                points.iter().map(|point| place(*point)).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            let _ = write!(text, "<polyline class=\"{class}\" points=\"{}\"/>", points.join(" "));
        }
        for (point, label, is_below) in &self.labels {
            let [x, y] = place(*point);
            let _ = write!(
                text,
                "<text x=\"{:.1}\" y=\"{:.1}\">{label}</text>",
                x + 5.0,
                if *is_below { y + 14.0 } else { y - 5.0 }
            );
        }
        if has_bar {
            let length = libm::pow(10.0, libm::floor(libm::log10(0.4 * span)));
            let (from, y) = (left + MARGIN, SIDE - 10.0);
            let _ = write!(
                text,
                "<line class=\"bar\" x1=\"{from:.1}\" x2=\"{:.1}\" y1=\"{y}\" y2=\"{y}\"/><text x=\"{from:.1}\" y=\"{}\">{}</text>",
                from + scale * length,
                y - 5.0,
                with_unit(length, "m")
            );
        }
        text
    }

    /// An arrow from `from` to `tip`, whose head is across the line of sight.
    fn arrow(&mut self, class: &'static str, from: [f64; 3], tip: [f64; 3]) {
        let along = difference(tip, from);
        let across = scaled(0.25 / norm(CAMERA), cross(along, CAMERA));
        let back = difference(tip, scaled(0.4, along));
        self.lines.push((class, vec![from, tip]));
        self.lines.push((class, vec![sum(back, across), tip, difference(back, across)]));
    }

    /// The edges of `parts` and of wheels, turned by `c_es` about the centre of mass, which is at `at`.
    fn craft(&mut self, plan: &Plan, parts: &[ShownPart], center: [f64; 3], (c_es, at): ([[f64; 3]; 3], [f64; 3])) {
        let to_e = |point: [f64; 3]| sum(at, product(c_es, difference(point, center)));
        for part in parts {
            for edge in part.edges() {
                self.lines.push(("craft", edge.into_iter().map(to_e).collect()));
            }
        }
        let wheels = plan.nominal.wheels.iter().filter(|wheel| wheel.mode != WheelMode::Locked);
        for wheel in wheels {
            let circle = circle(wheel.axis, wheel.position_m, wheel.radius_m.unwrap_or(0.1));
            self.lines.push(("wheel", circle.into_iter().map(to_e).collect()));
        }
    }
}

/// A circle about `axis`.
fn circle(axis: [f64; 3], center: [f64; 3], radius: f64) -> Vec<[f64; 3]> {
    let unit = |v: [f64; 3]| scaled(1.0 / norm(v).max(f64::MIN_POSITIVE), v);
    let axis = unit(axis);
    let other = if axis[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let first = unit(cross(axis, other));
    let second = cross(axis, first);
    let corner = |k: usize| {
        let angle = core::f64::consts::TAU * k as f64 / CORNERS as f64;
        let [a, b] = [libm::cos(angle), libm::sin(angle)].map(|factor| radius * factor);
        sum(center, sum(scaled(a, first), scaled(b, second)))
    };
    (0..=CORNERS).map(corner).collect()
}

impl ShownPart {
    fn edges(&self) -> Vec<Vec<[f64; 3]>> {
        let size = |k: usize| self.size.get(k).copied().unwrap_or(0.1);
        let own: Vec<Vec<[f64; 3]>> = match self.shape {
            "hollow_cylinder" | "solid_cylinder" => {
                let (radius, half) = (size(0), 0.5 * size(1));
                let ends = [-half, half].map(|z| circle([0.0, 0.0, 1.0], [0.0, 0.0, z], radius));
                let sides = (0..CORNERS).step_by(CORNERS / 4).map(|k| vec![ends[0][k], ends[1][k]]);
                sides.chain(ends.clone()).collect()
            }
            "box" => {
                let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 0.5 } else { -0.5 } * size(axis));
                let edges = (0..8usize).flat_map(|k| [1, 2, 4].map(|axis| (k, k | axis))).filter(|(a, b)| a != b);
                edges.map(|(a, b)| vec![corner(a), corner(b)]).collect()
            }
            _ => {
                let radius = if self.shape == "sphere" { size(0) } else { 0.05 };
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| circle(axis, [0.0; 3], radius)).to_vec()
            }
        };
        let to_s = |point: [f64; 3]| sum(self.position, product(self.turn, point));
        own.into_iter().map(|edge| edge.into_iter().map(to_s).collect()).collect()
    }
}

/// The drawing of `run`, with what it shows in a sentence.
pub fn still(plan: &Plan, run: &SingleRun) -> String {
    let points = run.outcome.points.min(run.grid.points());
    let every = points.div_ceil(MOST_POINTS).max(1);
    let shown: Vec<usize> = (0..points).step_by(every).chain(points.checked_sub(1)).collect();
    let (parts, center) = (shown_parts(plan), run.scene.mass.center);
    let turned = |point: usize| dcm_from_quaternion(run.table.at(StateField::Attitude, point));
    let mut attitude = Drawing::default();
    attitude.craft(plan, &parts, center, (turned(0), [0.0; 3]));
    let reach = attitude.lines.iter().flat_map(|(_, points)| points).map(|point| norm(*point)).fold(0.2, f64::max);
    attitude.spheres.push(("sphere", [0.0; 3], 1.4 * reach));
    for (name, axis) in [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])] {
        let end = scaled(1.2 * reach, axis);
        attitude.lines.push(("axis", vec![[0.0; 3], end]));
        attitude.labels.push((end, name.to_owned(), true));
    }
    let s3 = |point: &usize| scaled(1.4 * reach, product(turned(*point), [0.0, 0.0, 1.0]));
    attitude.lines.push(("path", shown.iter().map(s3).collect()));
    let end = shown.last().map_or([0.0; 3], s3);
    attitude.labels.push((end, "s3".to_owned(), true));
    let mut caption = "Still of the nominal run, seen from the replay's camera: the body at the start, the axes of F_e, and the path of s3 on a sphere.".to_owned();
    let around: Vec<_> = sky::at_start(run).collect();
    for (name, direction) in &around {
        let tip = scaled(1.75 * reach, *direction);
        attitude.arrow(name, scaled(1.4 * reach, *direction), tip);
        attitude.labels.push((tip, (*name).to_owned(), false));
    }
    if let [others @ .., (last, _)] = around.as_slice() {
        let names: Vec<&str> = others.iter().map(|(name, _)| *name).collect();
        let _ = write!(caption, " Arrows at the start: {} and {last}.", names.join(", "));
    }
    let mut panels = attitude.svg(0.0, false);
    let mut width = SIDE;
    if run.request.debris {
        panels += &approach(plan, run, &shown, &parts).svg(SIDE, true);
        caption += " Right, at scale: the path relative to the debris, with the spacecraft at the start and at the end";
        caption += if approach_goal(plan, run).is_some() { ", the axis A_d and the station on it" } else { "" };
        caption += if keep_out(plan) > 0.0 { ", and the keep-out sphere." } else { "." };
        width = 2.0 * SIDE;
    }
    format!(
        "<svg class=\"still\" viewBox=\"0 0 {width} {SIDE}\" role=\"img\" aria-label=\"{caption}\">{panels}</svg><p class=\"caption still\">{caption}</p>"
    )
}

/// The path of the centre of mass relative to the debris, and what it leads to.
fn approach(plan: &Plan, run: &SingleRun, shown: &[usize], parts: &[ShownPart]) -> Drawing {
    let at = |point: usize| {
        difference(
            run.table.at::<3>(StateField::ComPosition, point),
            run.table.at::<3>(StateField::DebrisPosition, point),
        )
    };
    let mut drawing = Drawing::default();
    for (point, label) in [(shown.first(), "start"), (shown.last(), "end")] {
        let Some(&point) = point else { continue };
        let turned = dcm_from_quaternion(run.table.at(StateField::Attitude, point));
        drawing.craft(plan, parts, run.scene.mass.center, (turned, at(point)));
        drawing.labels.push((at(point), label.to_owned(), false));
    }
    drawing.lines.push(("path", shown.iter().map(|point| at(*point)).collect()));
    drawing.spheres.push(("debris", [0.0; 3], 0.1));
    drawing.labels.push(([0.0; 3], "debris".to_owned(), true));
    if keep_out(plan) > 0.0 {
        drawing.spheres.push(("keep-out", [0.0; 3], keep_out(plan)));
    }
    if let Some(goal) = approach_goal(plan, run) {
        let station = scaled(-goal.distance, goal.axis);
        drawing.lines.push(("launch-axis", vec![scaled(1.4, station), scaled(-0.5, station)]));
        drawing.spheres.push(("station", station, 0.0));
        drawing.labels.push((station, "station".to_owned(), true));
    }
    drawing
}
