//! [`Card`]: what the first screen says about one requirement, or, without requirements, about one outcome.

use crate::analysis::statistics::ColumnStatistics;
use crate::analysis::survey::{Survey, SurveyedOutcome};
use crate::campaign::{Display, ShownUnit};
use crate::findings::names;
use crate::findings::names::sentence as sentence_case;
use crate::report::escaped::escaped;
use crate::report::page::NO_INTERVAL;
use crate::report::page::influence::Influence;
use crate::report::page::readable::{in_brackets, number, with_unit};
use crate::report::share_text::{percent, with_interval};

/// How a requirement was judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judged {
    /// It is met with the asked confidence.
    Pass,
    /// It is not met, with the asked confidence.
    Fail,
    /// The runs do not decide it.
    Undecided,
    /// No requirement: what was found.
    Finding,
}

impl Judged {
    pub const fn word(self) -> &'static str {
        match self {
            Judged::Pass => "PASS",
            Judged::Fail => "FAIL",
            Judged::Undecided => "UNDECIDED",
            Judged::Finding => "FOUND",
        }
    }

    /// A shape of its own for each word: a disc with a tick, a square with a cross, a diamond with a question mark, a ring.
    const fn shape(self) -> &'static str {
        match self {
            Judged::Pass => r#"<circle cx="12" cy="12" r="11"/><path class="sign" d="M6 12.5l4 4 8-9"/>"#,
            Judged::Fail => {
                r#"<rect x="1.5" y="1.5" width="21" height="21" rx="2"/><path class="sign" d="M7 7l10 10M17 7L7 17"/>"#
            }
            Judged::Undecided => {
                r#"<path d="M12 0.5L23.5 12L12 23.5L0.5 12z"/><path class="sign" d="M9 10c0-4 6-4 6-1c0 2-3 2-3 4.5M12 16.2v1.2"/>"#
            }
            Judged::Finding => r#"<circle class="ring" cx="12" cy="12" r="9.5"/><circle cx="12" cy="12" r="3.5"/>"#,
        }
    }

    /// Its class in the style sheet.
    pub const fn class(self) -> &'static str {
        match self {
            Judged::Pass => "pass",
            Judged::Fail => "fail",
            Judged::Undecided => "undecided",
            Judged::Finding => "finding",
        }
    }
}

/// A requirement with its verdict, or a finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Card {
    pub judged: Judged,
    pub quantity: String,
    /// The requirement, or the finding, as a sentence.
    pub sentence: String,
    /// What the estimate is of: "99% quantile".
    pub statistic: String,
    /// The estimate; NaN where there is none.
    pub estimate: f64,
    /// The ends of its interval; NaN where the runs do not bound it.
    pub interval: [f64; 2],
    /// The smallest and the largest value, of a finding; NaN where there are none, or of a requirement.
    pub extremes: [f64; 2],
    /// The limit, and whether it is an upper one.
    pub limit: Option<(f64, bool)>,
    /// Unit of estimate and limit.
    pub unit: String,
    /// The bound that decided, where the interval does not show it.
    pub decided_by: String,
    /// What else there is to say: the number of runs that would decide.
    pub note: String,
    /// What drives the outcome; empty where that is not known.
    pub drivers: String,
}

/// Cards of a campaign without requirements, of its first outcomes; with the quantiles of the table `statistics` at the bottom of the page.
pub fn findings(
    survey: &Survey,
    (statistics, confidence): (&[ColumnStatistics], Option<f64>),
    influences: &[Influence],
    display: &Display,
) -> Vec<Card> {
    const MOST: usize = 6;
    let outcomes = survey.outcomes.iter().filter(|outcome| outcome.is_outcome && outcome.sketch.count() > 0);
    let card = |outcome: &SurveyedOutcome| {
        let name = outcome.quantity.name();
        let row = statistics.iter().find(|row| row.quantity.name() == name);
        let shown = display.of(name, outcome.quantity.unit());
        finding(outcome, (row, confidence), &shown, driven_by(name, influences))
    };
    outcomes.take(MOST).map(card).collect()
}

fn finding(
    outcome: &SurveyedOutcome,
    (row, confidence): (Option<&ColumnStatistics>, Option<f64>),
    shown: &ShownUnit,
    drivers: String,
) -> Card {
    const P: f64 = 0.99;
    let runs = outcome.sketch.count();
    // the plan may have other quantiles: the highest of them that is not above
    let quantiles = row.map_or(Vec::new(), ColumnStatistics::quantile_numbers);
    let quantile = quantiles.iter().rfind(|quantile| quantile[0] <= P).or(quantiles.first());
    let [p, estimate, low, high] = quantile.copied().unwrap_or([P, f64::NAN, f64::NAN, f64::NAN]);
    let percent = number(100.0 * p);
    let what = names::of_quantity(&outcome.quantity);
    let text = |value: f64| with_unit(shown.value(value), &shown.unit);
    let (min, max) = (outcome.sketch.min().unwrap_or(f64::NAN), outcome.sketch.max().unwrap_or(f64::NAN));
    let [lower, upper] = [0.05, 0.95].map(|p| quantiles.iter().find(|quantile| quantile[0] == p));
    let statistic = if runs > 1 { format!("{percent}% quantile") } else { "value".to_owned() };
    let (sentence, note) = if runs == 1 {
        (format!("The only run that was computed: {what} {}.", text(estimate)), String::new())
    } else {
        let sentence = match (lower, upper) {
            (Some(lower), Some(upper)) if min < 0.0 => format!(
                "In 90% of the runs, the {what} is between {} and {}; the extremes are {} and {}.",
                text(lower[1]),
                text(upper[1]),
                text(min),
                text(max)
            ),
            _ => format!(
                "In {percent}% of the runs, the {what} is below {}; the largest is {}.",
                text(estimate),
                text(max)
            ),
        };
        let note = match confidence.filter(|_| row.is_some()) {
            None => NO_INTERVAL.to_owned(),
            Some(confidence) if !high.is_finite() => format!(
                "{runs} runs do not bound the {statistic} from above with {}% confidence.",
                number(100.0 * confidence)
            ),
            Some(_) => String::new(),
        };
        (sentence, note)
    };
    Card {
        judged: Judged::Finding,
        quantity: sentence_case(&what),
        sentence,
        statistic,
        estimate: shown.value(estimate),
        interval: [low, high].map(|end| shown.value(end)),
        extremes: if runs > 1 { [min, max].map(|end| shown.value(end)) } else { [f64::NAN; 2] },
        limit: None,
        unit: shown.unit.clone(),
        decided_by: String::new(),
        note,
        drivers,
    }
}

/// What the verdicts are together: failed where one is, else undecided where one is; `None` without any.
pub fn overall(verdicts: &[Card]) -> Option<Judged> {
    let order = [Judged::Fail, Judged::Undecided, Judged::Pass];
    order.into_iter().find(|judged| verdicts.iter().any(|card| card.judged == *judged))
}

/// The strongest inputs of an outcome in words; empty where that is not known.
pub fn driven_by(outcome: &str, influences: &[Influence]) -> String {
    let of = |is_event: bool| {
        let of = influences.iter().filter(|one| one.outcome == outcome && one.event.is_some() == is_event);
        of.map(|one| one.drivers.as_str()).collect::<Vec<_>>().join(". ")
    };
    [of(true), of(false)].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(". Spread: ")
}

impl Card {
    pub fn html(&self) -> String {
        let mut rows = String::new();
        let mut row = |term: &str, text: &str| {
            if !text.is_empty() {
                rows += &format!("<p class=\"detail\"><b>{}</b> {}</p>", escaped(term), escaped(text));
            }
        };
        if self.estimate.is_finite() {
            row(&format!("{}:", sentence_case(&self.statistic)), &self.found());
        }
        row(if self.judged == Judged::Undecided { "Undecided:" } else { "Decided by:" }, &self.decided_by);
        let shown = core::mem::take(&mut rows);
        let mut row = |term: &str, text: &str| {
            if !text.is_empty() {
                rows += &format!("<p class=\"detail\"><b>{}</b> {}</p>", escaped(term), escaped(text));
            }
        };
        row("Drivers:", &sentence_case(&self.drivers));
        row("Note:", &self.note);
        let more = if rows.is_empty() {
            rows
        } else {
            format!("<details class=\"more\"><summary>Drivers and notes</summary>{rows}</details>")
        };
        format!(
            "<article class=\"card {}\"><h3><svg class=\"verdict\" viewBox=\"0 0 24 24\" aria-hidden=\"true\">{}</svg><span class=\"word\">{}</span> {}</h3><p>{}</p>{}{shown}{more}</article>\n",
            self.judged.class(),
            self.judged.shape(),
            self.judged.word(),
            escaped(&self.quantity),
            escaped(&self.sentence),
            self.scale()
        )
    }

    /// The estimate with its interval in brackets: "98.4% [91.5, 99.96]", "0.9381 [0.901, 0.994] deg".
    fn found(&self) -> String {
        if self.unit == "%" {
            return with_interval([0.01 * self.estimate; 2], self.interval.map(|end| 0.01 * end));
        }
        format!("{}{}\u{a0}{}", number(self.estimate), in_brackets(self.interval), self.unit).trim_end().to_owned()
    }

    /// The estimate with its unit; a share that is not all is not 100%.
    fn value(&self) -> String {
        if self.unit == "%" {
            format!("{}%", percent(0.01 * self.estimate))
        } else {
            with_unit(self.estimate, &self.unit)
        }
    }

    /// Dot, whisker, and limit line or the ends of what was found; an axis by decades where the range exceeds 100.
    fn scale(&self) -> String {
        const LEFT: f64 = 8.0;
        const RIGHT: f64 = 312.0;
        let limit = self.limit.map(|(limit, _)| limit);
        let known = [self.estimate].into_iter().chain(self.interval).chain(self.extremes).chain(limit);
        let values: Vec<f64> = known.filter(|x| x.is_finite()).collect();
        if !self.estimate.is_finite() || values.len() < 2 {
            return String::new();
        }
        let (low, high) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        let is_log = low > 0.0 && high > 100.0 * low;
        let map = |value: f64| if is_log { libm::log10(value) } else { value };
        let (first, last) = (map(low), map(high));
        let margin = if last > first { 0.12 * (last - first) } else { 0.1 * first.abs().max(1e-300) };
        let at = |value: f64| LEFT + (RIGHT - LEFT) * (map(value) - first + margin) / (last - first + 2.0 * margin);
        let [start, end] = [(0, LEFT), (1, RIGHT)]
            .map(|(place, edge)| if self.interval[place].is_finite() { at(self.interval[place]) } else { edge });
        let label = |x: f64, y: u32, anchor: &str, text: &str| {
            format!("<text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"{anchor}\">{}</text>", escaped(text))
        };
        let anchor = |x: f64| {
            if x < 90.0 {
                "start"
            } else if x > 230.0 {
                "end"
            } else {
                "middle"
            }
        };
        let mut inside = format!("<line class=\"axis\" x1=\"{LEFT}\" y1=\"28\" x2=\"{RIGHT}\" y2=\"28\"/>");
        if self.interval.iter().any(|end| end.is_finite()) {
            inside += &format!("<line class=\"whisker\" x1=\"{start:.1}\" y1=\"28\" x2=\"{end:.1}\" y2=\"28\"/>");
            let tick = |x: f64| format!("<line class=\"whisker\" x1=\"{x:.1}\" y1=\"23\" x2=\"{x:.1}\" y2=\"33\"/>");
            let ends = [(self.interval[0], start), (self.interval[1], end)];
            inside +=
                &ends.into_iter().filter(|(value, _)| value.is_finite()).map(|(_, x)| tick(x)).collect::<String>();
        }
        let x = at(self.estimate);
        inside += &format!("<circle class=\"dot\" cx=\"{x:.1}\" cy=\"28\" r=\"5\"/>");
        inside += &label(x, 47, anchor(x), &self.value());
        for (end, word, (edge, anchor)) in
            [(self.extremes[0], "smallest", (LEFT, "start")), (self.extremes[1], "largest", (RIGHT, "end"))]
        {
            if end.is_finite() {
                let x = at(end);
                inside += &format!("<line class=\"end\" x1=\"{x:.1}\" y1=\"20\" x2=\"{x:.1}\" y2=\"36\"/>");
                inside += &label(edge, 11, anchor, &format!("{word} {}", with_unit(end, &self.unit)));
            }
        }
        if let Some((limit, is_upper)) = self.limit {
            let x = at(limit);
            let word = if is_upper { "at most" } else { "at least" };
            inside += &format!("<line class=\"limit\" x1=\"{x:.1}\" y1=\"15\" x2=\"{x:.1}\" y2=\"38\"/>");
            inside += &label(x, 11, anchor(x), &format!("{word} {}", with_unit(limit, &self.unit)));
        }
        let scale = if is_log { ", logarithmic" } else { "" };
        format!(
            "<svg class=\"scale\" viewBox=\"0 0 320 52\" role=\"img\" aria-label=\"{}{scale}\">{inside}</svg>",
            escaped(&self.statistic)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn card(judged: Judged, estimate: f64, interval: [f64; 2], limit: Option<(f64, bool)>) -> Card {
        Card {
            judged,
            quantity: "energy <error>".to_owned(),
            sentence: "99% of runs stay below 1e-9.".to_owned(),
            statistic: "99% quantile".to_owned(),
            estimate,
            interval,
            extremes: [f64::NAN; 2],
            decided_by: String::new(),
            limit,
            unit: "J".to_owned(),
            note: String::new(),
            drivers: String::new(),
        }
    }

    /// Law: equal ratios are equally far apart where the axis is by decades, equal differences where it is not.
    #[test]
    fn places_are_those_of_the_axis() {
        let places = |low: f64, estimate: f64, high: f64| {
            let html = card(Judged::Pass, estimate, [low, high], None).html();
            let number = |text: &str| -> f64 {
                let (_, rest) = html.split_once(text).expect("a mark");
                rest.split('"').next().expect("an end").parse().expect("a number")
            };
            [number("class=\"whisker\" x1=\""), number("class=\"dot\" cx=\"")]
        };
        for (low, estimate, high) in [(1e-9, 1e-6, 1e-3), (1.0, 2.0, 3.0)] {
            let [left, dot] = places(low, estimate, high);
            assert!((dot - 160.0).abs() < 0.11 && left < 60.0, "{left} and {dot}");
        }
        // 3 of 4 decades
        let [left, dot] = places(1e-4, 1e-1, 1.0);
        let right = 320.0 - left;
        assert!((dot - (left + 0.75 * (right - left))).abs() < 0.2, "{left}, {dot}, {right}");
    }

    /// Law: what is said of drivers is a sentence of its own after its label, whatever it says.
    #[test]
    fn drivers_are_a_sentence() {
        for (drivers, said) in [
            ("no single input was found to explain more", "No single input was found to explain more"),
            ("1 of 63 runs fails", "1 of 63 runs fails"),
        ] {
            let html = Card { drivers: drivers.to_owned(), ..card(Judged::Fail, 1.0, [0.5, 2.0], None) }.html();
            assert!(html.contains(&format!("<b>Drivers:</b> {said}</p>")), "{html}");
        }
    }

    /// Law: a verdict is a word and a shape of its own; text is escaped; no number on the card is NaN.
    #[test]
    fn verdicts_have_word_and_shape() {
        let all = [Judged::Pass, Judged::Fail, Judged::Undecided, Judged::Finding];
        for judged in all {
            let html = card(judged, 1e-12, [1e-13, f64::NAN], Some((1e-9, true))).html();
            assert!(html.contains(judged.word()) && html.contains(judged.shape()), "{html}");
            assert!(html.contains("energy &lt;error&gt;") && html.contains("not bounded"), "{html}");
            assert!(!html.contains("NaN") && html.contains("logarithmic"), "{html}");
        }
        for (index, judged) in all.into_iter().enumerate() {
            assert!(all[index + 1..].iter().all(|other| other.shape() != judged.shape()));
        }
        // estimate, ends and the unit of both
        let bounded = card(Judged::Pass, 0.1, [0.0, 0.1497], None).html();
        assert!(bounded.contains("0.1 [0, 0.15]\u{a0}J</p>"), "{bounded}");
        // a share that is not all, and one whose interval ends below all
        let share = Card { unit: "%".to_owned(), ..card(Judged::Pass, 99.984, [99.44, 99.9975], None) }.html();
        assert!(share.contains("99.98% [99.4, 99.998]</p>") && share.contains(">99.98%</text>"), "{share}");
        // what was found has a scale without an interval too: from the smallest to the largest value
        let found = Card { extremes: [0.0, 3.0], ..card(Judged::Finding, 2.0, [f64::NAN; 2], None) }.html();
        for said in ["class=\"dot\"", "class=\"end\"", ">smallest 0\u{a0}J</text>", ">largest 3\u{a0}J</text>"] {
            assert!(found.contains(said) && !found.contains("NaN"), "{said}: {found}");
        }
        // the bound that decided is not folded away
        let decided = Card { decided_by: "at least 95.1%".to_owned(), ..card(Judged::Pass, 97.0, [94.9, 99.0], None) };
        let (seen, _) = (decided.html() + "<details")
            .split_once("<details")
            .map(|(seen, rest)| (seen.to_owned(), rest.to_owned()))
            .expect("a part");
        assert!(seen.contains("Decided by:</b> at least 95.1%"), "{seen}");
        let open = Card { decided_by: "missed at 95%".to_owned(), ..card(Judged::Undecided, 93.0, [90.0, 94.9], None) };
        assert!(open.html().contains("Undecided:</b> missed at 95%"), "{}", open.html());
        let empty = card(Judged::Finding, f64::NAN, [f64::NAN; 2], None).html();
        assert!(!empty.contains("NaN") && !empty.contains("<circle class=\"dot\""), "{empty}");
        assert!(!card(Judged::Pass, 0.0, [0.0; 2], Some((0.0, true))).html().contains("NaN"));
    }
}
