//! [`Seen`]: crossings in the values at observation points.

use crate::campaign::event::Direction;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// Between this point and the next.
    Crossing { before: usize, is_rising: bool },
    /// At this point, unknown before.
    Point(usize),
}

/// The crossings in the values of a run at its observation points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    pub count: u32,
    pub first: Option<Place>,
    pub last: Option<Place>,
    /// Start of the final stay on the event's side.
    pub stays: Option<Place>,
    pub has_gap: bool,
}

impl Seen {
    /// Crossings in `direction`, changes of the side of zero. Zero is on neither side: a quantity that starts there or
    /// touches it does not cross, and one that starts or ends within `rounding` of zero starts or ends at zero. After
    /// NaN, unknown, the quantity starts again.
    pub fn of(values: impl Iterator<Item = f64>, direction: Direction, rounding: impl Fn(usize) -> f64) -> Self {
        let mut seen = Seen { count: 0, first: None, last: None, stays: None, has_gap: false };
        let mut before: Option<bool> = None;
        // last point at zero since the start, rounding there
        let mut at_start: Option<(usize, f64)> = None;
        let mut values = values.enumerate().peekable();
        while let Some((point, value)) = values.next() {
            if value.is_nan() {
                (before, at_start, seen.has_gap) = (None, None, true);
                continue;
            }
            let is_last = values.peek().is_none_or(|(_, next)| next.is_nan());
            let at_zero = match (before, at_start) {
                (Some(_), _) if !is_last => 0.0,
                (None, Some((_, rounding))) => rounding,
                _ => rounding(point),
            };
            if value.abs() <= at_zero {
                if before.is_none() {
                    at_start = Some((point, at_zero));
                }
                continue;
            }
            let is_above = value > 0.0;
            let is_there = is_above == (direction != Direction::Falling);
            match before {
                Some(was_above) if was_above != is_above => {
                    let crossing = Place::Crossing { before: point - 1, is_rising: is_above };
                    if direction == Direction::Either || is_there {
                        seen.count += 1;
                        seen.first = seen.first.or(Some(crossing));
                        seen.last = Some(crossing);
                    }
                    seen.stays = is_there.then_some(crossing);
                }
                None => {
                    let since = at_start.map_or(point, |(last, _)| last);
                    seen.stays = is_there.then_some(Place::Point(since));
                }
                Some(_) => {}
            }
            before = Some(is_above);
        }
        seen
    }
}
