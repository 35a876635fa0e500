//! [`ArcRecord`]: the arcs of a run as differences: a control loop has an arc per tick and changes few numbers (40
//! bytes per arc with three wheels instead of 264).

use crate::scene::{Actuation, Arc, MAX_THRUSTERS, MAX_WHEELS};

/// Positions of body torque and dipole after thrusts and motor torques, and the count of numbers.
const BODY: usize = MAX_THRUSTERS + MAX_WHEELS;
const DIPOLE: usize = BODY + 3;
const NUMBERS: usize = DIPOLE + 3;

/// Bit of [`Actuation::ends_run`].
const ENDS_RUN: u64 = 1 << NUMBERS;

/// The arcs of a run in order, from time zero without a gap.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcRecord {
    /// For each arc: a mask of the numbers that changed, the end, and these numbers.
    words: Vec<u64>,
    count: usize,
    last: Arc,
}

const START: Arc = Arc { start: 0.0, applied: Actuation::none(0.0) };

impl Default for ArcRecord {
    fn default() -> Self {
        ArcRecord { words: Vec::new(), count: 0, last: START }
    }
}

impl ArcRecord {
    pub fn clear(&mut self) {
        self.words.clear();
        (self.count, self.last) = (0, START);
    }

    /// Appends an arc to the last one.
    #[inline]
    pub fn push(&mut self, arc: &Arc) {
        let (words, last, new) = (&mut self.words, &mut self.last.applied, &arc.applied);
        let mark = words.len();
        words.extend([if new.ends_run { ENDS_RUN } else { 0 }, new.until.to_bits()]);
        words[mark] |= record(words, &mut last.thrust, &new.thrust)
            | record(words, &mut last.motor_torque, &new.motor_torque) << MAX_THRUSTERS
            | record(words, &mut last.body_torque, &new.body_torque) << BODY
            | record(words, &mut last.dipole, &new.dipole) << DIPOLE;
        (last.until, last.ends_run) = (new.until, new.ends_run);
        self.last.start = arc.start;
        self.count += 1;
    }

    pub fn len(&self) -> usize {
        self.count
    }

    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    pub fn last(&self) -> Option<&Arc> {
        (self.count > 0).then_some(&self.last)
    }

    pub fn reader(&self) -> ArcReader<'_> {
        ArcReader { words: self.words.iter(), arc: START }
    }

    pub fn iter(&self) -> impl Iterator<Item = Arc> + '_ {
        let mut reader = self.reader();
        std::iter::from_fn(move || reader.next().copied())
    }

    pub fn to_vec(&self) -> Vec<Arc> {
        self.iter().collect()
    }
}

/// Reads a record arc by arc.
#[derive(Clone, Debug)]
pub struct ArcReader<'a> {
    words: std::slice::Iter<'a, u64>,
    arc: Arc,
}

impl ArcReader<'_> {
    pub fn next(&mut self) -> Option<&Arc> {
        let arc = &mut self.arc;
        let mut changed = *self.words.next()?;
        arc.start = arc.end();
        arc.applied.until = f64::from_bits(*self.words.next()?);
        arc.applied.ends_run = changed & ENDS_RUN != 0;
        changed &= !ENDS_RUN;
        while changed != 0 {
            let number = changed.trailing_zeros() as usize;
            *number_mut(&mut arc.applied, number) = f64::from_bits(*self.words.next()?);
            changed &= changed - 1;
        }
        Some(arc)
    }
}

impl Extend<Arc> for ArcRecord {
    fn extend<I: IntoIterator<Item = Arc>>(&mut self, arcs: I) {
        arcs.into_iter().for_each(|arc| self.push(&arc));
    }
}

/// Appends the numbers of `new` with other bits than in `last`, updates `last`, returns their mask.
#[inline]
fn record<const K: usize>(words: &mut Vec<u64>, last: &mut [f64; K], new: &[f64; K]) -> u64 {
    // mostly nothing changes: one test of the whole array
    if last.iter().zip(new).fold(0, |any, (last, new)| any | (last.to_bits() ^ new.to_bits())) == 0 {
        return 0;
    }
    let mut changed = 0;
    for (i, (last, new)) in last.iter_mut().zip(new).enumerate() {
        if last.to_bits() != new.to_bits() {
            changed |= 1 << i;
            *last = *new;
            words.push(new.to_bits());
        }
    }
    changed
}

fn number_mut(applied: &mut Actuation, number: usize) -> &mut f64 {
    match number {
        DIPOLE.. => &mut applied.dipole[number - DIPOLE],
        BODY.. => &mut applied.body_torque[number - BODY],
        MAX_THRUSTERS..BODY => &mut applied.motor_torque[number - MAX_THRUSTERS],
        _ => &mut applied.thrust[number],
    }
}
