//! Inline pictures of a few lines' height, as static SVG: histograms with limits, estimates on a scale.

use crate::findings::number::{trimmed, typeset};
use crate::findings::{Finding, Number};
use crate::report::figure::{Axis, Figure, Mark, Scale};
use crate::statistics::gate::GateLimit;
use crate::table::html::escaped;

pub const WIDTH: f64 = 220.0;
/// Height of bars, and of the labels below.
const HEIGHT: f64 = 26.0;
const WORDS: f64 = 13.0;
/// Width of a letter on screen, and on paper, where text is larger.
const LETTER: f64 = 5.4;
const LETTER_ON_PAPER: f64 = 6.8;
/// Limits beyond this multiple of the runs' range are named at the edge.
const FAR: f64 = 6.0;
/// Pattern of bars beyond a limit, defined once per page.
pub const HATCH: &str = "<svg width=\"0\" height=\"0\" class=\"defs\" aria-hidden=\"true\"><defs><pattern id=\"hatch\" \
    width=\"4\" height=\"4\" patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate(45)\"><rect class=\"ground\" \
    width=\"4\" height=\"4\"/><line x1=\"0\" x2=\"0\" y1=\"0\" y2=\"4\"/></pattern></defs></svg>\n";

#[derive(Clone, Copy, Debug)]
pub struct Span {
    ends: [f64; 2],
    is_log: bool,
}

impl Span {
    /// The range of the finite `values`, logarithmic for several positive decades; `None` if it is empty.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let known = values.into_iter().filter(|value| value.is_finite());
        let [low, high] = known.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        let is_log = low > 0.0 && high > 100.0 * low;
        (low < high).then_some(Span { ends: [low, high], is_log })
    }

    fn mark(&self) -> &'static str {
        if self.is_log { "<text class=\"log\" x=\"0\" y=\"8\">log</text>" } else { "" }
    }

    fn part(&self, value: f64) -> f64 {
        let of = |value: f64| if self.is_log { libm::log10(value.max(f64::MIN_POSITIVE)) } else { value };
        let [low, high] = self.ends.map(of);
        (of(value) - low) / (high - low)
    }
}

/// A centred text at `x`, kept within the picture.
fn label(x: f64, y: f64, text: &str) -> String {
    let half = 0.5 * LETTER * text.chars().count() as f64;
    let (anchor, x) = match () {
        () if x < half => ("start", x.max(0.0)),
        () if x > WIDTH - half => ("end", x.min(WIDTH)),
        () => ("middle", x),
    };
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>", escaped(text))
}

fn dashed(x: f64, height: f64) -> String {
    format!("<line class=\"limit\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"0\" y2=\"{height:.1}\"/>")
}

fn picture(class: &str, height: f64, name: &str, inside: &str) -> String {
    let said = if name.is_empty() {
        "aria-hidden=\"true\"".to_owned()
    } else {
        format!("role=\"img\" aria-label=\"{}\"", escaped(name))
    };
    format!("<svg class=\"{class}\" viewBox=\"0 0 {WIDTH} {height}\" {said}>{inside}</svg>")
}

/// Estimate and interval of a number with its limit take at least this part of a shared scale; else it has its own.
const LEAST_PART: f64 = 0.1;

/// The first number of each finding on a scale shared by its unit: estimate, interval, limit and required side. Without
/// a limit the scale spans all numbers of the outcome. Empty if there is nothing to compare.
pub fn scales(found: &[&Finding]) -> Vec<String> {
    let known = |number: &Number| {
        let (value, [low, high], limit) = number.in_shown();
        [value, low, high, limit.unwrap_or(f64::NAN)]
    };
    let unit = |number: &Number| (number.unit.clone(), number.shown.unit.clone());
    let scale = |number: &Number| {
        let of_unit = found.iter().filter(|one| one.numbers.first().is_some_and(|other| unit(other) == unit(number)));
        let of_unit = of_unit.filter_map(|one| one.numbers.first());
        // a share ends at 100%, and limits are mostly near it
        let all = (number.unit == "%").then_some(100.0);
        let span = Span::of(of_unit.flat_map(known).chain(all))?;
        let own = Span::of(known(number)).filter(|own| span.part(own.ends[1]) - span.part(own.ends[0]) < LEAST_PART);
        number.value.is_finite().then(|| of_number(number, own.unwrap_or(span)))
    };
    // without limits, each outcome lies on the range of its own values
    let outcome = |one: &&Finding| {
        let number = one.numbers.first()?;
        if number.limit.is_some() {
            return scale(number);
        }
        let span = Span::of(one.numbers.iter().flat_map(known))?;
        number.value.is_finite().then(|| of_number(number, span))
    };
    found.iter().map(|one| outcome(one).unwrap_or_default()).collect()
}

fn of_number(number: &Number, span: Span) -> String {
    const MARGIN: f64 = 14.0;
    let at = |value: f64| MARGIN + (WIDTH - 2.0 * MARGIN) * span.part(value);
    let (value, [low, high], limit) = number.in_shown();
    let middle = 0.5 * HEIGHT;
    let mut inside = String::new();
    if let (Some(limit), Some(gate)) = (limit, number.limit) {
        let [from, to] = if matches!(gate, GateLimit::AtLeast(_)) { [at(limit), WIDTH] } else { [0.0, at(limit)] };
        inside += &format!("<rect class=\"within\" x=\"{from:.1}\" width=\"{:.1}\" height=\"{HEIGHT}\"/>", to - from);
    }
    inside += &format!("<line class=\"axis\" x1=\"0\" x2=\"{WIDTH}\" y1=\"{HEIGHT}\" y2=\"{HEIGHT}\"/>");
    if number.has_interval() {
        let end = |end: f64, edge: f64| if end.is_finite() { at(end) } else { edge };
        let [from, to] = [end(low, 0.0), end(high, WIDTH)];
        inside += &format!("<line class=\"whisker\" x1=\"{from:.1}\" x2=\"{to:.1}\" y1=\"{middle}\" y2=\"{middle}\"/>");
    }
    inside += &format!("<circle class=\"dot\" cx=\"{:.1}\" cy=\"{middle}\" r=\"4.5\"/>", at(value));
    let words = HEIGHT + WORDS - 2.0;
    match (limit, number.limit_text()) {
        (Some(limit), Some(text)) => {
            inside += &dashed(at(limit), HEIGHT);
            inside += &label(at(limit), words, &typeset(&text));
        }
        _ => {
            let ends = span.ends.map(|end| typeset(&format!("{} {}", trimmed(end, 4), number.shown.unit)));
            inside += &label(0.0, words, ends[0].trim_end());
            inside += &label(WIDTH, words, ends[1].trim_end());
        }
    }
    inside += span.mark();
    picture("scale", HEIGHT + WORDS, &typeset(&format!("{} {}", number.name, number.text())), &inside)
}

/// A small histogram with the expected curve, `limit` (its name in the figure beside it) with the runs beyond it
/// highlighted, and the vertical lines whose names begin with `lines`. Empty without bars.
pub fn histogram(figure: &Figure, limit: Option<&(GateLimit, String)>, lines: Option<&str>) -> String {
    let limits = figure.marks.iter().filter_map(|mark| match mark {
        Mark::Limit { label, at, vertical: true } => {
            let is_named = lines.is_some_and(|start| label.starts_with(start));
            let is_shown = is_named || limit.is_some_and(|(_, name)| name == label);
            is_shown.then_some(*at)
        }
        _ => None,
    });
    let limits: Vec<f64> = limits.collect();
    let bars = figure
        .marks
        .iter()
        .find_map(|mark| if let Mark::Bars { edges, heights, .. } = mark { Some((edges, heights)) } else { None });
    let Some((edges, heights)) = bars else { return String::new() };
    let highest = heights.iter().copied().fold(1.0, f64::max);
    let [Some(first), Some(last)] = [edges.first(), edges.last()] else { return String::new() };
    let reach = FAR * (last - first);
    let is_near = |limit: &&f64| first - **limit <= reach && **limit - last <= reach;
    let near = limits.iter().filter(is_near).copied();
    let is_log = figure.x.scale == Scale::Log;
    let Some(span) = Span::of([*first, *last].into_iter().chain(near)) else { return String::new() };
    let span = Span { is_log, ..span };
    let at = |value: f64| WIDTH * span.part(value).clamp(0.0, 1.0);
    let mut inside = String::new();
    for (ends, count) in edges.windows(2).zip(heights).filter(|(_, count)| **count > 0.0) {
        let middle = if is_log { libm::sqrt(ends[0] * ends[1]) } else { 0.5 * (ends[0] + ends[1]) };
        // the limit in the unit of the figure
        let is_beyond = |at: f64| match limit {
            Some((GateLimit::AtMost(_), _)) => middle > at,
            Some((GateLimit::AtLeast(_), _)) => middle < at,
            None => false,
        };
        let class = if limits.first().copied().is_some_and(is_beyond) { " class=\"missed\"" } else { "" };
        let (from, to) = (at(ends[0]), at(ends[1]));
        // keep single runs visible
        let height = ((HEIGHT - 2.0) * count / highest).max(1.2);
        inside += &format!(
            "<rect{class} x=\"{from:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{height:.1}\"/>",
            HEIGHT - height,
            (to - from - 0.4).max(0.6),
        );
    }
    inside += span.mark();
    for mark in &figure.marks {
        let Mark::Line { x, y, .. } = mark else { continue };
        let up = |count: f64| HEIGHT - (HEIGHT - 2.0) * (count / highest).min(1.0);
        let point = |(x, y): (&f64, &f64)| format!("{:.1},{:.1}", at(*x), up(*y));
        let points: Vec<String> = x.iter().zip(y).map(point).collect();
        inside += &format!("<polyline points=\"{}\"/>", points.join(" "));
    }
    inside += &format!("<line class=\"axis\" x1=\"0\" x2=\"{WIDTH}\" y1=\"{HEIGHT}\" y2=\"{HEIGHT}\"/>");
    let is_shown = |limit: &&f64| (span.ends[0]..=span.ends[1]).contains(*limit);
    for limit in limits.iter().filter(is_shown) {
        inside += &dashed(at(*limit), HEIGHT + 3.0);
    }
    picture("small", HEIGHT + WORDS, "", &(inside + &ends(&figure.x, span, &limits, &at)))
}

/// Labels of the limits, then of the ends of the axis if there is room.
fn ends(axis: &Axis, span: Span, limits: &[f64], at: &dyn Fn(f64) -> f64) -> String {
    let is_outside = |value: f64| value < span.ends[0] || value > span.ends[1];
    let text = |value: f64| {
        let arrow = if is_outside(value) { " \u{2192}" } else { "" };
        let said = format!("{} {}", trimmed(value, 4), axis.unit);
        typeset(said.trim_end()) + arrow
    };
    let width = |text: &str| LETTER_ON_PAPER * text.chars().count() as f64;
    let mut said: Vec<(f64, String)> = Vec::new();
    for value in limits.iter().copied().chain(span.ends) {
        let (x, text) = (at(value).clamp(0.0, WIDTH), text(value));
        let place = |x: f64, width: f64| (x - 0.5 * width).clamp(0.0, (WIDTH - width).max(0.0));
        let from = place(x, width(&text));
        let is_free = |(other, said): &(f64, String)| {
            let start = place(*other, width(said));
            from > start + width(said) + 4.0 || from + width(&text) + 4.0 < start
        };
        if said.iter().all(is_free) {
            said.push((x, text));
        }
    }
    said.iter().map(|(x, text)| label(*x, HEIGHT + WORDS - 2.0, text)).collect()
}

pub fn shares(yes: &Number) -> String {
    let width = WIDTH * yes.value.clamp(0.0, 1.0);
    let count = libm::round(yes.value * yes.of as f64) as u64;
    let inside = format!(
        "<rect x=\"0\" y=\"8\" width=\"{width:.1}\" height=\"14\"/><rect class=\"missed\" x=\"{width:.1}\" y=\"8\" \
         width=\"{:.1}\" height=\"14\"/>{}{}",
        WIDTH - width,
        label(0.0, HEIGHT + WORDS - 2.0, &count.to_string()),
        label(WIDTH, HEIGHT + WORDS - 2.0, &format!("{} not", yes.of.saturating_sub(count)))
    );
    picture("small", HEIGHT + WORDS, "", &inside)
}

/// Median, p95 and maximum of an outcome, as available.
pub fn said_of(outcome: &Finding) -> String {
    let numbers = ["median", "p95", "max"].iter().filter_map(|name| outcome.number(name));
    let known = numbers.filter(|number| number.value.is_finite());
    let said = known.map(|number| (number, format!("{} {}", number.name, number.alone())));
    let (numbers, said): (Vec<&Number>, Vec<String>) = said.unzip();
    let unit = numbers.last().map_or("", |number| &number.shown.unit);
    // the title ends with the number of runs that have it
    let of = outcome.title.split_once(" (").map_or_else(String::new, |(_, of)| format!(" ({of}"));
    typeset(format!("{} {unit}{of}", said.join(", ")).trim_end())
}
