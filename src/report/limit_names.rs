//! Limits of a [`Panel`]: lines with their names, none over another name or the line of another limit, and, where there is room, none over a curve.

use crate::report::figure::Mark;
use crate::report::panel::Panel;
use crate::report::shapes::PALETTE;
use crate::report::svg::{Anchor, Font, LABEL, Stroke, Svg};

/// Height of a row of names, pixels.
const ROW: f64 = 16.0;
/// Rows of names, at most, where there is room for them.
const ROWS: usize = 8;

/// Where names across stand between the left edge and the right one, the best places first.
const EIGHTHS: [f64; 9] = [0.0, 8.0, 4.0, 2.0, 6.0, 1.0, 3.0, 5.0, 7.0];

/// A point, pixels.
type Place = [f64; 2];
/// The corners of a rectangle, left and top first, pixels.
type Corners = [Place; 2];

/// A limit on the picture.
struct Limit<'m> {
    label: &'m str,
    /// Where its line is, pixels from the left or from the top; it may be beyond the axes.
    at: f64,
    is_vertical: bool,
}

/// The name of a limit on the picture.
struct LimitName<'m> {
    label: &'m str,
    place: Place,
    anchor: Anchor,
    /// What it covers, with its arrow.
    corners: Corners,
    /// Tip and direction of the arrow to a limit that is beyond the axes.
    arrow: Option<[Place; 2]>,
}

impl Limit<'_> {
    /// The ends of its line; `None` where it is beyond the `edges` of the axes.
    fn line(&self, [left, top, right, bottom]: [f64; 4]) -> Option<[Place; 2]> {
        let at = self.at;
        match self.is_vertical {
            true => (left..=right).contains(&at).then_some([[at, top], [at, bottom]]),
            false => (top..=bottom).contains(&at).then_some([[left, at], [right, at]]),
        }
    }

    /// Where its name, `width` pixels wide, may stand, the best places first: beside its line, or at the edge beyond which it is, with an arrow.
    fn candidates(&self, width: f64, edges: [f64; 4]) -> Vec<LimitName<'_>> {
        let [left, top, right, bottom] = edges;
        let at = self.at;
        let name = |place: Place, anchor: Anchor| LimitName {
            label: self.label,
            place,
            anchor,
            corners: corners(place, anchor, width),
            arrow: None,
        };
        let rows = (0..ROWS).map(|row| ROW * row as f64);
        match (self.is_vertical, self.line(edges)) {
            (true, Some(_)) => {
                let sides = [(at + 5.0, Anchor::Start), (at - 5.0, Anchor::End)];
                let places = sides
                    .into_iter()
                    .flat_map(|(x, anchor)| rows.clone().map(move |row| ([x, top + 13.0 + row], anchor)));
                places.map(|(place, anchor)| name(place, anchor)).collect()
            }
            (false, Some(_)) => {
                let room = right - left - 12.0 - width;
                let starts = EIGHTHS.into_iter().map(|eighth| left + 6.0 + room * eighth / 8.0);
                let places = starts.flat_map(|x| [at - 4.0, at + 14.0].map(|y| [x, y]));
                places.map(|place| name(place, Anchor::Start)).collect()
            }
            (true, None) => {
                let is_before = at < left;
                let (edge, inward, anchor) =
                    if is_before { (left, 1.0, Anchor::Start) } else { (right, -1.0, Anchor::End) };
                let of_row = |row: f64| {
                    // at the edge, or farther inward
                    [0.0, 0.25, 0.5].map(|part| {
                        let (x, y) = (edge + inward * part * (right - left), top + 10.0 + row);
                        let mut name = name([x + 20.0 * inward, y + 4.0], anchor);
                        name.corners[usize::from(!is_before)][0] = x;
                        LimitName { arrow: Some([[x + 3.0 * inward, y], [6.0 * inward, 0.0]]), ..name }
                    })
                };
                rows.flat_map(of_row).collect()
            }
            (false, None) => {
                let (edge, inward) = if at < top { (top, 1.0) } else { (bottom, -1.0) };
                let of_row = |row: f64| {
                    [left + 9.0, right - 17.0 - width].map(|x| {
                        let y = edge + inward * (10.0 + row);
                        let mut name = name([x + 11.0, y + 4.0], Anchor::Start);
                        name.corners[0] = [x - 5.0, y - 8.0];
                        LimitName { arrow: Some([[x, y - 7.0 * inward], [0.0, 7.0 * inward]]), ..name }
                    })
                };
                rows.flat_map(of_row).collect()
            }
        }
    }
}

impl<'f> Panel<'f> {
    fn limits(&self) -> Vec<Limit<'f>> {
        let of = |mark: &'f Mark| match mark {
            Mark::Limit { label, at, vertical } => {
                let at = if *vertical { self.x(*at) } else { self.y(*at) };
                (!at.is_nan()).then_some(Limit { label, at, is_vertical: *vertical })
            }
            _ => None,
        };
        self.marks().iter().filter_map(of).collect()
    }

    /// What a name should not cross, as lines from point to point.
    fn curves(&self) -> Vec<Vec<Place>> {
        let mut curves = Vec::new();
        for mark in self.marks() {
            match mark {
                Mark::Line { x, y, .. } => curves.push(self.places(x, y)),
                Mark::Band { x, low, high, .. } => curves.extend([low, high].map(|ends| self.places(x, ends))),
                Mark::Points { x, y, .. } => curves.extend(self.places(x, y).into_iter().map(|at| vec![at, at])),
                Mark::Bars { edges, heights, .. } => {
                    let bar = |(ends, height): (&[f64], &f64)| {
                        let ([from, to], y) = ([self.x(ends[0]), self.x(ends[1])], self.y(*height));
                        vec![[from, y], [to, y], [0.5 * (from + to), self.edges[3]]]
                    };
                    curves.extend(edges.windows(2).zip(heights).filter(|(_, height)| **height > 0.0).map(bar));
                }
                _ => {}
            }
        }
        curves
    }

    /// The names of `limits`: those at the edges first, to which names beside their lines give way.
    fn limit_names<'l>(&self, font: &Font, limits: &'l [Limit<'_>]) -> Vec<LimitName<'l>> {
        let lines: Vec<[Place; 2]> = limits.iter().filter_map(|limit| limit.line(self.edges)).collect();
        let curves = self.curves();
        let is_across = |limit: &&Limit<'_>| !limit.is_vertical && limit.line(self.edges).is_some();
        let (across, others): (Vec<&Limit<'_>>, Vec<&Limit<'_>>) = limits.iter().partition(is_across);
        let mut names: Vec<LimitName<'l>> = Vec::new();
        for limit in others.into_iter().chain(across).filter(|limit| !limit.label.is_empty()) {
            let fault = |name: &LimitName<'_>| {
                let is_covered = names.iter().any(|other| do_meet(&name.corners, &other.corners));
                let parts = curves.iter().flat_map(|curve| curve.windows(2));
                let on_curves = parts.filter(|ends| crosses(ends[0], ends[1], &name.corners)).count();
                // an upright line is behind few letters, one across behind all of them
                let crossed = lines.iter().filter(|[from, to]| crosses(*from, *to, &name.corners));
                let crossed: usize = crossed.map(|[from, to]| if from[0] == to[0] { 1 } else { 4 }).sum();
                // what is worse first
                let is_wrong = is_covered || !is_inside(&name.corners, self.edges);
                (is_wrong, crossed + if on_curves > 0 { 2 } else { 0 }, on_curves)
            };
            let candidates = limit.candidates(font.width(limit.label, LABEL), self.edges);
            names.extend(candidates.into_iter().min_by_key(fault));
        }
        names
    }

    /// Limits as lines with their names; one that is outside of the axes is named at the edge beyond which it is, with an arrow.
    pub(super) fn draw_limits(&self, svg: &mut Svg) {
        let grey = Stroke { color: PALETTE[8], width: 1.0, dash: None };
        let limits = self.limits();
        for line in limits.iter().filter_map(|limit| limit.line(self.edges)) {
            svg.line(&line, Stroke { dash: Some([4, 4]), ..grey });
        }
        for LimitName { label, place, anchor, corners, arrow } in self.limit_names(&svg.font, &limits) {
            // a ground of its own, so that a curve behind it does not cross it out; above bars it needs none
            if arrow.is_none_or(|[_, step]| step[0] == 0.0) {
                svg.rectangle(corners[0], corners[1], "#ffffff", 0.8);
            }
            svg.text(label, place, LABEL, anchor, grey.color, false);
            let Some([tip, step]) = arrow else { continue };
            let wing = |side: f64| {
                [tip[0] + 0.7 * step[0] + 0.5 * side * step[1], tip[1] + 0.7 * step[1] + 0.5 * side * step[0]]
            };
            svg.line(&[tip, [tip[0] + 2.0 * step[0], tip[1] + 2.0 * step[1]]], grey);
            svg.line(&[wing(1.0), tip, wing(-1.0)], grey);
        }
    }
}

/// What a name of this `width` covers that stands at `place`.
fn corners(place: Place, anchor: Anchor, width: f64) -> Corners {
    let start = if anchor == Anchor::End { place[0] - width } else { place[0] };
    [[start - 2.0, place[1] - LABEL], [start + width + 2.0, place[1] + 3.0]]
}

fn is_inside(corners: &Corners, [left, top, right, bottom]: [f64; 4]) -> bool {
    corners[0][0] >= left && corners[0][1] >= top && corners[1][0] <= right && corners[1][1] <= bottom
}

/// Whether two rectangles have a point in common.
fn do_meet(one: &Corners, other: &Corners) -> bool {
    (0..2).all(|axis| one[0][axis] < other[1][axis] && other[0][axis] < one[1][axis])
}

/// Whether the line between two points has one within a rectangle.
fn crosses(from: Place, to: Place, corners: &Corners) -> bool {
    let [low, high] = [f64::min, f64::max].map(|of| [of(from[0], to[0]), of(from[1], to[1])]);
    let is_beside = (0..2).any(|axis| high[axis] <= corners[0][axis] || low[axis] >= corners[1][axis]);
    let side = |x: usize, y: usize| {
        (to[0] - from[0]) * (corners[y][1] - from[1]) - (to[1] - from[1]) * (corners[x][0] - from[0])
    };
    let sides = [side(0, 0), side(0, 1), side(1, 0), side(1, 1)];
    let is_on_one_side = sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0);
    !is_beside && !is_on_one_side
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Overrides;
    use crate::ensemble::SingleRun;
    use crate::math::Isa;
    use crate::report::figure::{Axis, Dash, Figure, Hue};
    use crate::report::page::runs::GROUPS;
    use crate::report::sheet::Sheet;
    use crate::report::simulation_figure::simulation_figure;
    use crate::run::Grid;
    use crate::sampling::SampleId;
    use crate::workflow::source::plan_and_files;

    /// Law: the arrow of a limit that is beyond an axis points to where the limit is, from within the panel.
    #[test]
    fn arrows_point_to_their_limits() {
        for (vertical, at) in [(true, -50.0), (true, 90.0), (false, -50.0), (false, 90.0)] {
            let ends = vec![1.0, 40.0];
            let curve = Mark::line("", Hue::Body, Dash::Solid, ends.clone(), ends);
            let limit = Mark::Limit { label: "limit".to_owned(), at, vertical };
            let axis = || Axis::linear("", "").within(0.0, 41.0);
            let svg = Sheet::of(&Figure::new("", axis(), axis(), vec![curve, limit])).svg(None);
            let points = |line: &str| -> Vec<[f64; 2]> {
                let pair =
                    |text: &str| text.split_once(',').map(|(x, y)| [x, y].map(|one| one.parse().unwrap())).unwrap();
                line.split("points=\"").nth(1).unwrap().split('"').next().unwrap().split(' ').map(pair).collect()
            };
            let lines: Vec<Vec<[f64; 2]>> = svg.lines().filter(|line| line.contains("points=")).map(points).collect();
            let is_small = |line: &[[f64; 2]]| (0..2).all(|k| (line[0][k] - line[1][k]).abs() < 20.0);
            let head = lines.iter().find(|line| line.len() == 3 && is_small(line)).expect("wings that meet at the tip");
            let tip = head[1];
            let shaft = lines.iter().find(|line| line.len() == 2 && line[0] == tip).expect("a shaft");
            // upwards on the screen is down in pixels
            let outwards = |point: [f64; 2]| if vertical { point[0] } else { -point[1] } * f64::signum(at);
            for inner in [head[0], head[2], shaft[1]] {
                assert!(outwards(tip) > outwards(inner), "{vertical} {at}: {head:?} {shaft:?}");
            }
        }
    }

    /// A figure with an axis from 0 to 100 in both directions, with these marks.
    fn with(marks: Vec<Mark>) -> Figure {
        let axis = || Axis::linear("", "").within(0.0, 100.0);
        Figure::new("", axis(), axis(), marks)
    }

    /// What is wrong with the names of the limits of a figure: two that meet, one beyond the axes, one on the line of a limit; and the names on curves.
    fn faults(figure: &Figure, size: [f64; 2]) -> (Vec<String>, Vec<String>) {
        let font = Font::new();
        let panel = Panel::laid_out(&font, figure, [0.0, 0.0], size, true);
        let (limits, curves) = (panel.limits(), panel.curves());
        let names = panel.limit_names(&font, &limits);
        let (mut faults, mut on_curves) = (Vec::new(), Vec::new());
        for (place, name) in names.iter().enumerate() {
            let mut add = |what: &str| faults.push(format!("{}: {} {what}", figure.title, name.label));
            for other in &names[..place] {
                if do_meet(&name.corners, &other.corners) {
                    add(&format!("is over {}", other.label));
                }
            }
            if !is_inside(&name.corners, panel.edges) {
                add("is outside of the axes");
            }
            // between two lines that are as near as its height a name has no room
            let own = limits.iter().find(|limit| limit.label == name.label).expect("its limit").at;
            let is_apart = |limit: &&Limit<'_>| (limit.at - own).abs() > 20.0 || limit.is_vertical;
            let lines = limits.iter().filter(is_apart).filter_map(|limit| limit.line(panel.edges));
            if lines.into_iter().any(|[from, to]| crosses(from, to, &name.corners)) {
                add("is crossed by the line of a limit");
            }
            if curves.iter().any(|curve| curve.windows(2).any(|ends| crosses(ends[0], ends[1], &name.corners))) {
                on_curves.push(name.label.to_owned());
            }
        }
        assert_eq!(names.len(), limits.iter().filter(|limit| !limit.label.is_empty()).count(), "{}", figure.title);
        (faults, on_curves)
    }

    /// Law: names of limits do not cover each other, stay within the axes and are on no line of another limit, wherever two limits across the figure, one upright and one beyond the axes are.
    #[test]
    fn names_of_limits_do_not_meet() {
        let limit = |label: &str, at: f64, vertical| Mark::Limit { label: label.to_owned(), at, vertical };
        for first in (0..=100).step_by(4) {
            for second in (0..=100).step_by(3) {
                let marks = vec![
                    limit("station 10 m", f64::from(first), false),
                    limit("keep-out 5 m", f64::from(second), false),
                    limit("at most 20 deg", f64::from((7 * first + second) % 100), true),
                    limit("limit 500 rpm", if first % 8 == 0 { 900.0 } else { -900.0 }, second % 2 == 0),
                ];
                let (faults, _) = faults(&with(marks), [640.0, 320.0]);
                assert!(faults.is_empty(), "{first}, {second}: {faults:?}");
            }
        }
    }

    /// Law: a name is on no curve where it has a place beside its line, or at its edge, that none crosses: of a curve that covers one half of the figure it is in the other.
    #[test]
    fn names_leave_curves() {
        for (from, at, vertical) in [
            (0, 50.0, false),
            (50, 50.0, false),
            (0, 900.0, false),
            (50, 900.0, false),
            (50, -900.0, false),
            (50, 30.0, true),
            (0, 70.0, true),
        ] {
            let x: Vec<f64> = (0..200).map(|point| f64::from(from) + 0.25 * f64::from(point)).collect();
            let y = (0..200).map(|point| f64::from(point % 2) * 100.0).collect();
            let curve = Mark::line("", Hue::Body, Dash::Solid, x, y);
            let limit = Mark::Limit { label: "limit".to_owned(), at, vertical };
            let (faults, on_curves) = faults(&with(vec![curve, limit]), [640.0, 320.0]);
            assert!(faults.is_empty() && on_curves.is_empty(), "{from}, {at}: {faults:?} {on_curves:?}");
        }
    }

    /// Law: so it is in all figures of one run of each shipped campaign, and names are on curves only in those of errors, whose noise may cover all, and in few whose curve crosses its limit
    /// again and again.
    #[test]
    fn names_of_shipped_campaigns_do_not_meet() {
        let (mut seen, mut crossed) = (0, Vec::new());
        // tests of the library are compiled in a package of their own too
        let here = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let folder = here.ancestors().map(|above| above.join("campaigns")).find(|folder| folder.is_dir());
        for entry in std::fs::read_dir(folder.expect("campaigns")).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let (plan, _) = plan_and_files(&path, Overrides::default()).unwrap_or_else(|error| panic!("{error:?}"));
            let end = plan.grid.times().last().copied().unwrap_or(1.0);
            let grid = Grid::uniform(end, 201);
            let Ok(run) = SingleRun::with_series(&plan, SampleId(3), grid, Isa::best(), &GROUPS) else { continue };
            let sheet = simulation_figure(plan.name.clone(), &plan, &run).in_units(&plan.analysis.display);
            for panel in &sheet.panels {
                let (faults, on_curves) = faults(panel, [640.0, 320.0]);
                assert!(faults.is_empty(), "{}: {faults:?}", plan.name);
                if !panel.title.starts_with("Relative errors") {
                    crossed.extend(on_curves.into_iter().map(|label| format!("{}: {label}", plan.name)));
                }
                seen += panel.marks.iter().filter(|mark| matches!(mark, Mark::Limit { .. })).count();
            }
        }
        assert!(seen > 40 && crossed.len() <= 4, "{seen} limits, on curves: {crossed:?}");
    }
}
