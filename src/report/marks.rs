//! Marks of a [`Panel`] as shapes.

use crate::report::figure::Mark;
use crate::report::panel::{FLIGHT, Panel};
use crate::report::shapes::{BAR, PALETTE, bar_opacity, color, point, shade, stroke};
use crate::report::svg::{Anchor, INK, LABEL, Stroke, Svg};

/// With more points than this they are small and transparent.
const MANY: usize = 200;
/// Height of a row of names of limits, pixels.
const ROW: f64 = 16.0;
/// Cells of a matrix that are smaller have no number, pixels.
const NUMBER_CELL: f64 = 32.0;

impl Panel<'_> {
    /// The places that two columns of values have.
    fn places(&self, xs: &[f64], ys: &[f64]) -> Vec<[f64; 2]> {
        let places = xs.iter().zip(ys).map(|(x, y)| [self.x(*x), self.y(*y)]);
        places.filter(|place| place.iter().all(|value| value.is_finite())).collect()
    }

    /// Draws a mark; limits are drawn by [`Panel::draw_limits`].
    pub(super) fn draw_mark(&self, svg: &mut Svg, mark: &Mark) {
        let bottom = self.edges[3];
        match mark {
            Mark::Line { hue, dash, x, y, .. } => svg.line(&self.places(x, y), stroke(*hue, dash.lengths())),
            Mark::Band { hue, opacity, x, low, high, .. } => {
                let mut outline = self.places(x, low);
                outline.extend(self.places(x, high).into_iter().rev());
                svg.area(&outline, color(*hue), *opacity);
            }
            Mark::Points { hue, shape, x, y, .. } => {
                let places = self.places(x, y);
                let (size, opacity) = if places.len() > MANY { (1.8, 0.6) } else { (3.0, 1.0) };
                for place in places {
                    point(svg, place, (*shape, size, bottom), *hue, opacity);
                }
            }
            Mark::Bars { hue, edges, heights, .. } => {
                for (ends, height) in edges.windows(2).zip(heights).filter(|(_, height)| **height > 0.0) {
                    let corners = [[self.x(ends[0]), bottom], [self.x(ends[1]), self.y(*height)]];
                    svg.rectangle(corners[0], corners[1], color(*hue), bar_opacity(*hue));
                }
            }
            Mark::Whiskers { hue, x, low, high, .. } => {
                for (row, value) in x.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                    let (height, end) = (self.y(row as f64), self.x(*value));
                    svg.rectangle([self.x(0.0), height - 6.0], [end, height + 6.0], color(*hue), 0.35);
                    let ends = [self.x(low[row]), self.x(high[row])];
                    if ends.iter().all(|end| end.is_finite()) {
                        svg.line(&ends.map(|x| [x, height]), Stroke { color: INK, width: 1.2, dash: None });
                    }
                    svg.disc([end, height], 3.0, color(*hue), 1.0);
                }
            }
            Mark::Matrix { values } => {
                let names = libm::sqrt(values.len() as f64) as usize;
                let half = 0.5 * (self.edges[2] - self.edges[0]) / names.max(1) as f64;
                for (index, r) in values.iter().enumerate() {
                    let [x, y] = [self.x((index % names) as f64), self.y((index / names) as f64)];
                    let (color, opacity) = shade(*r);
                    svg.rectangle([x - half, y - half], [x + half - 1.0, y + half - 1.0], color, opacity);
                    if 2.0 * half >= NUMBER_CELL {
                        let text = format!("{r:.2}");
                        let text = if text == "-0.00" { "0.00" } else { &text };
                        let color = if opacity > 0.6 { "#ffffff" } else { INK };
                        svg.text(text, [x, y + 4.0], 11.0, Anchor::Middle, color, false);
                    }
                }
            }
            Mark::Limit { .. } | Mark::Flight { .. } => {}
        }
    }

    /// The runs in flight, as a strip whose height is their share.
    pub(super) fn draw_flight(&self, svg: &mut Svg) {
        let [left, _, right, bottom] = self.edges;
        let floor = bottom + FLIGHT - 2.0;
        for mark in self.marks() {
            let Mark::Flight { x, counts, runs, .. } = mark else { continue };
            let place =
                |(time, count): (&f64, &f64)| [self.x(*time).clamp(left, right), floor - (FLIGHT - 4.0) * count / runs];
            let mut outline: Vec<[f64; 2]> = x.iter().zip(counts).map(place).collect();
            let ends = [outline.last(), outline.first()].map(|end| end.map_or(left, |end| end[0]));
            outline.extend(ends.map(|x| [x, floor]));
            svg.area(&outline, PALETTE[8], BAR);
        }
    }

    /// Limits as lines with their names; one that is outside of the axes is named at the edge beyond which it is, with an arrow.
    pub(super) fn draw_limits(&self, svg: &mut Svg) {
        let [left, top, right, bottom] = self.edges;
        let grey = Stroke { color: PALETTE[8], width: 1.0, dash: None };
        let mut rows = 0;
        // names in rows from the top, none over another
        let mut named: Vec<(usize, [f64; 2])> = Vec::new();
        let mut covered: Vec<Corners> = Vec::new();
        let is_across = |mark: &&Mark| matches!(mark, Mark::Limit { at, vertical: false, .. } if (top..=bottom).contains(&self.y(*at)));
        let lines: Vec<f64> = self
            .marks()
            .iter()
            .filter(is_across)
            .filter_map(|mark| if let Mark::Limit { at, .. } = mark { Some(self.y(*at)) } else { None })
            .collect();
        // names that stand beside their lines give way to those at the edges
        let (across, others): (Vec<&Mark>, Vec<&Mark>) = self.marks().iter().partition(is_across);
        for mark in others.into_iter().chain(across) {
            let Mark::Limit { label, at, vertical } = mark else { continue };
            let at = if *vertical { self.x(*at) } else { self.y(*at) };
            let (low, high) = if *vertical { (left, right) } else { (top, bottom) };
            let width = svg.font.width(label, LABEL);
            if (low..=high).contains(&at) {
                let ends = if *vertical { [[at, top], [at, bottom]] } else { [[left, at], [right, at]] };
                svg.line(&ends, Stroke { dash: Some([4, 4]), ..grey });
                // beside the line, on the side that has space
                let is_right = at + width + 8.0 < right;
                let ends = if is_right { [at, at + width + 10.0] } else { [at - width - 10.0, at] };
                let row = if *vertical { row_of(&mut named, ends) } else { 0 };
                let below = top + 13.0 + ROW * row as f64;
                let (place, anchor) = match *vertical {
                    true if is_right => ([at + 5.0, below], Anchor::Start),
                    true => ([at - 5.0, below], Anchor::End),
                    false => beside((at, width), self.edges, &lines, &covered),
                };
                if !label.is_empty() {
                    covered.push(self.draw_name(svg, label, (place, anchor), width));
                }
            } else if !at.is_nan() && !label.is_empty() {
                let is_before = at < low;
                let y = if *vertical {
                    let reach = width + 24.0;
                    let ends = if is_before { [left, left + reach] } else { [right - reach, right] };
                    top + 10.0 + ROW * row_of(&mut named, ends) as f64
                } else {
                    rows += 1;
                    let place = 10.0 + ROW * f64::from(rows - 1);
                    if is_before { top + place } else { bottom - place }
                };
                let (edge, inward, anchor) = match *vertical && !is_before {
                    true => (right, -1.0, Anchor::End),
                    false => (left, 1.0, Anchor::Start),
                };
                let sign = if is_before { 1.0 } else { -1.0 };
                let (tip, step) = match *vertical {
                    true => ([edge + 3.0 * inward, y], [6.0 * sign, 0.0]),
                    false => ([edge + 9.0, y - 7.0 * sign], [0.0, 7.0 * sign]),
                };
                let wing = |side: f64| {
                    [tip[0] + 0.7 * step[0] + 0.5 * side * step[1], tip[1] + 0.7 * step[1] + 0.5 * side * step[0]]
                };
                svg.line(&[tip, [tip[0] + 2.0 * step[0], tip[1] + 2.0 * step[1]]], grey);
                svg.line(&[wing(1.0), tip, wing(-1.0)], grey);
                let place = [edge + 20.0 * inward, y + 4.0];
                if *vertical {
                    svg.text(label, place, LABEL, anchor, grey.color, false);
                } else {
                    covered.push(self.draw_name(svg, label, (place, anchor), width));
                }
            }
        }
    }

    /// Writes the name of a limit on a ground of its own, so that curves behind it do not cross it out; what it covers.
    fn draw_name(&self, svg: &mut Svg, label: &str, (place, anchor): (Place, Anchor), width: f64) -> Corners {
        let corners = corners(place, anchor, width);
        svg.rectangle(corners[0], corners[1], "#ffffff", 0.8);
        svg.text(label, place, LABEL, anchor, PALETTE[8], false);
        corners
    }
}

/// A point, pixels.
type Place = [f64; 2];
/// The corners of a rectangle, left and top first, pixels.
type Corners = [Place; 2];

/// What a name of this `width` covers that stands at `place`.
fn corners(place: Place, anchor: Anchor, width: f64) -> Corners {
    let start = if anchor == Anchor::End { place[0] - width } else { place[0] };
    [[start - 2.0, place[1] - LABEL], [start + width + 2.0, place[1] + 3.0]]
}

/// Where the name, `width` pixels wide, of a limit across the figure at the height `at` stands: within the `edges`, over no name that has `covered` its place, and if that can be on none of
/// the `lines` of other limits; above its line before below it, at the left before the right.
fn beside(
    (at, width): (f64, f64),
    [left, top, right, bottom]: [f64; 4],
    lines: &[f64],
    covered: &[Corners],
) -> (Place, Anchor) {
    let places = [(left + 6.0, Anchor::Start), (right - 6.0, Anchor::End)]
        .into_iter()
        .flat_map(|(x, anchor)| [at - 4.0, at + 14.0].map(|y| ([x, y], anchor)))
        .collect::<Vec<_>>();
    let of = |(place, anchor): &(Place, Anchor)| corners(*place, *anchor, width);
    let is_inside = |corners: &Corners| corners[0][1] >= top && corners[1][1] <= bottom;
    let is_free = |corners: &Corners| covered.iter().all(|other| !do_meet(corners, other));
    let is_off_lines = |[[_, above], [_, below]]: &Corners| {
        lines.iter().all(|line| (line - at).abs() < 1e-9 || *line <= *above || *line >= *below)
    };
    let fits = |place: &&(Place, Anchor)| is_inside(&of(place)) && is_free(&of(place));
    let best = places.iter().find(|place| fits(place) && is_off_lines(&of(place)));
    *best.or_else(|| places.iter().find(fits)).unwrap_or(&places[0])
}

/// Whether two rectangles have a point in common.
fn do_meet(one: &Corners, other: &Corners) -> bool {
    (0..2).all(|axis| one[0][axis] < other[1][axis] && other[0][axis] < one[1][axis])
}

/// The first row in which a name from `ends[0]` to `ends[1]` covers none of those in `named`, where it is noted.
fn row_of(named: &mut Vec<(usize, [f64; 2])>, ends: [f64; 2]) -> usize {
    let is_free =
        |row: &usize| named.iter().all(|(other, [from, to])| other != row || ends[1] <= *from || ends[0] >= *to);
    let row = (0..).find(is_free).unwrap_or(0);
    named.push((row, ends));
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::figure::{Axis, Dash, Figure, Hue};
    use crate::report::sheet::Sheet;

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

    /// Law: names of two limits across a figure do not cover each other and stay within the axes, however near the limits are, at the edges too; where there is room, a name is on no
    /// line of another.
    #[test]
    fn names_across_do_not_meet() {
        let edges = [40.0, 20.0, 400.0, 220.0];
        for first in (22..=218).step_by(7) {
            for second in (22..=218).step_by(3) {
                let lines = [f64::from(first), f64::from(second)];
                let mut covered = Vec::new();
                for at in lines {
                    let (place, anchor) = beside((at, 90.0), edges, &lines, &covered);
                    covered.push(corners(place, anchor, 90.0));
                }
                assert!(!do_meet(&covered[0], &covered[1]), "{lines:?}: {covered:?}");
                let is_inside = |one: &Corners| one[0][1] >= edges[1] && one[1][1] <= edges[3];
                assert!(covered.iter().all(is_inside), "{lines:?}: {covered:?}");
                let crossed = |one: &Corners, line: f64| one[0][1] < line && line < one[1][1];
                let apart = (lines[0] - lines[1]).abs();
                assert!(
                    apart < 40.0 || !crossed(&covered[0], lines[1]) && !crossed(&covered[1], lines[0]),
                    "{lines:?}"
                );
            }
        }
    }

    /// Law: names in one row do not cover each other, and a name is in the first row that has space.
    #[test]
    fn names_of_limits_do_not_meet() {
        let mut named = Vec::new();
        let rows = [[0.0, 50.0], [40.0, 90.0], [50.0, 80.0], [45.0, 60.0]].map(|ends| row_of(&mut named, ends));
        assert_eq!(rows, [0, 1, 0, 2]);
    }
}
