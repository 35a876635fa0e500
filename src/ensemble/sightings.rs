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
}

impl Seen {
    /// Those in `direction`; NaN is a value that is not known, and no crossing.
    pub fn of(values: impl Iterator<Item = f64>, direction: Direction) -> Self {
        let mut seen = Seen { count: 0, first: None, last: None, stays: None };
        let mut before: Option<bool> = None;
        for (point, value) in values.enumerate() {
            if value.is_nan() {
                before = None;
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
                None => seen.stays = is_there.then_some(Place::Point(point)),
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

    /// Law: crossings are counted in their direction; a value on the limit is not beyond it; what is not known crosses nothing; a quantity stays on a side
    /// from its last crossing on, or from where it is known.
    #[test]
    fn crossings_are_counted() {
        let nan = f64::NAN;
        let up = |before| Some(Place::Crossing { before, is_rising: true });
        let down = |before| Some(Place::Crossing { before, is_rising: false });
        let of = |values: &[f64], direction| Seen::of(values.iter().copied(), direction);
        let wave = [-1.0, 1.0, 2.0, -1.0, -2.0, 0.0, 1.0];
        let rising = of(&wave, Direction::Rising);
        assert_eq!(rising, Seen { count: 2, first: up(0), last: up(5), stays: up(5) });
        let falling = of(&wave, Direction::Falling);
        assert_eq!(falling, Seen { count: 1, first: down(2), last: down(2), stays: None });
        let either = of(&wave, Direction::Either);
        assert_eq!((either.count, either.first, either.last), (3, up(0), up(5)));
        let always = of(&[-1.0; 4], Direction::Falling);
        assert_eq!(always, Seen { count: 0, first: None, last: None, stays: Some(Place::Point(0)) });
        let gap = of(&[1.0, nan, -1.0, -2.0], Direction::Falling);
        assert_eq!(gap, Seen { count: 0, first: None, last: None, stays: Some(Place::Point(2)) });
        assert_eq!(of(&[nan; 3], Direction::Rising), Seen { count: 0, first: None, last: None, stays: None });
    }
}
