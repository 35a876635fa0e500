//! [`Seen`]: the crossings that show in the values of a run at its observation points.

use crate::campaign::event::Direction;

/// Where something begins that an event is about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// Between this point and the next.
    Crossing { before: usize, is_rising: bool },
    /// At this point: the quantity is not known before.
    Point(usize),
}

/// The crossings in the values of a run at its observation points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    pub count: u32,
    pub first: Option<Place>,
    pub last: Option<Place>,
    /// Where the quantity comes to the side on which it stays to the end.
    pub stays: Option<Place>,
    /// Whether some value is not known.
    pub has_gap: bool,
}

impl Seen {
    /// Those in `direction`, each a change from one side of zero to the other: zero itself is on neither side, so that
    /// a quantity that starts there, or touches it, does not cross. `rounding` is how far rounding may move the value
    /// at a point: where a quantity starts or ends no farther than that from zero, it starts or ends at zero. NaN is a
    /// value that is not known, and no crossing; behind it the quantity starts again.
    pub fn of(values: impl Iterator<Item = f64>, direction: Direction, rounding: impl Fn(usize) -> f64) -> Self {
        let mut seen = Seen { count: 0, first: None, last: None, stays: None, has_gap: false };
        let mut before: Option<bool> = None;
        // the point at which the quantity is at zero since its start, and the rounding of its start
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

#[cfg(test)]
mod tests {
    use super::*;

    fn up(before: usize) -> Option<Place> {
        Some(Place::Crossing { before, is_rising: true })
    }

    fn down(before: usize) -> Option<Place> {
        Some(Place::Crossing { before, is_rising: false })
    }

    /// Law: crossings are counted in their direction; what is not known crosses nothing; a quantity stays on a side
    /// from its last crossing on, or from where it is known.
    #[test]
    fn crossings_are_counted() {
        let nan = f64::NAN;
        let of = |values: &[f64], direction| Seen::of(values.iter().copied(), direction, |_| 0.0);
        let wave = [-1.0, 1.0, 2.0, -1.0, -2.0, 0.0, 1.0];
        let rising = of(&wave, Direction::Rising);
        assert_eq!(rising, Seen { count: 2, first: up(0), last: up(5), stays: up(5), has_gap: false });
        let falling = of(&wave, Direction::Falling);
        assert_eq!(falling, Seen { count: 1, first: down(2), last: down(2), stays: None, has_gap: false });
        let either = of(&wave, Direction::Either);
        assert_eq!((either.count, either.first, either.last), (3, up(0), up(5)));
        let point = |point| Some(Place::Point(point));
        let always = of(&[-1.0; 4], Direction::Falling);
        assert_eq!(always, Seen { count: 0, first: None, last: None, stays: point(0), has_gap: false });
        let gap = of(&[1.0, nan, -1.0, -2.0], Direction::Falling);
        assert_eq!(gap, Seen { count: 0, first: None, last: None, stays: point(2), has_gap: true });
        let never = Seen { count: 0, first: None, last: None, stays: None, has_gap: true };
        assert_eq!(of(&[nan; 3], Direction::Rising), never);
    }

    /// Law: zero is on neither side: a quantity that starts there, ends there, or touches it crosses nothing; one that
    /// goes through it crosses once, where it leaves it. So does the opposite quantity, in the other direction. The
    /// counter-test: with a rounding of nothing, a start at 1e-16 is above.
    #[test]
    fn a_start_at_the_value_is_no_crossing() {
        let none = (0, None);
        for (values, rising, falling, is_above) in [
            (&[0.0, 1.0, 2.0][..], none, none, Some(Place::Point(0))),
            (&[0.0, 0.0, 1.0], none, none, Some(Place::Point(1))),
            (&[1e-16, -1.0, -2.0], none, none, None),
            (&[-1e-16, 0.0, 1e-16, 1.0], none, none, Some(Place::Point(2))),
            (&[0.0, 1.0, -1.0], none, (1, down(1)), None),
            (&[0.0, 1.0, -1.0, 1.0], (1, up(2)), (1, down(1)), up(2)),
            (&[1.0, 0.0, 1.0], none, none, Some(Place::Point(0))),
            (&[1.0, 0.0], none, none, Some(Place::Point(0))),
            (&[-1.0, 0.0, 0.0], none, none, None),
            (&[-1.0, 0.0, 0.0, 1.0], (1, up(2)), none, up(2)),
            (&[-1.0, 1e-16], none, none, None),
            (&[-1.0, 1e-16, 1.0], (1, up(0)), none, up(0)),
            (&[-1.0, 1e-16, f64::NAN], none, none, None),
            (&[f64::NAN, 0.0, 1.0], none, none, Some(Place::Point(1))),
            (&[0.0; 5], none, none, None),
        ] {
            for sign in [1.0, -1.0] {
                let turned = |place| match place {
                    Some(Place::Crossing { before, is_rising }) if sign < 0.0 => {
                        Some(Place::Crossing { before, is_rising: !is_rising })
                    }
                    other => other,
                };
                let of = |direction| Seen::of(values.iter().map(|value| sign * value), direction, |_| 1e-15);
                let [up, down] = match sign > 0.0 {
                    true => [Direction::Rising, Direction::Falling],
                    false => [Direction::Falling, Direction::Rising],
                };
                let [up, down] = [of(up), of(down)];
                assert_eq!((up.count, turned(up.first)), rising, "{values:?} {sign}");
                assert_eq!((down.count, turned(down.first)), falling, "{values:?} {sign}");
                assert_eq!(turned(up.stays), is_above, "{values:?} {sign}");
                assert_eq!(of(Direction::Either).count, rising.0 + falling.0, "{values:?} {sign}");
            }
        }
        let exact = Seen::of([1e-16, -1.0].into_iter(), Direction::Falling, |_| 0.0);
        assert_eq!(exact.count, 1);
    }
}
