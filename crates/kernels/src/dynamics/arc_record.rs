//! [`ArcRecord`]: the arcs of a run, stored as differences.
//!
//! A control loop has an arc per tick, and few numbers change between arcs: 40 bytes per arc with three wheels, against
//! 264 for an [`Arc`].

use crate::scene::{Actuation, Arc, MAX_THRUSTERS, MAX_WHEELS};

/// Numbers of an actuation, without its end.
const NUMBERS: usize = MAX_THRUSTERS + MAX_WHEELS + 6;

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
    /// Removes all arcs and keeps the memory.
    pub fn clear(&mut self) {
        self.words.clear();
        (self.count, self.last) = (0, START);
    }

    /// Appends an arc, which starts at the end of the last one.
    #[inline]
    pub fn push(&mut self, arc: &Arc) {
        let (last, new) = (&mut self.last.applied, &arc.applied);
        let thrusts = changes(&last.thrust, &new.thrust);
        let motors = changes(&last.motor_torque, &new.motor_torque);
        let body = changes(&last.body_torque, &new.body_torque);
        let dipole = changes(&last.dipole, &new.dipole);
        let external = body | dipole << 3;
        let all = thrusts | motors << MAX_THRUSTERS | external << (MAX_THRUSTERS + MAX_WHEELS);
        let ends_run = if new.ends_run { ENDS_RUN } else { 0 };
        self.words.extend([all | ends_run, new.until.to_bits()]);
        for (changed, last, numbers) in [
            (thrusts, &mut last.thrust[..], &new.thrust[..]),
            (motors, &mut last.motor_torque[..], &new.motor_torque[..]),
            (body, &mut last.body_torque[..], &new.body_torque[..]),
            (dipole, &mut last.dipole[..], &new.dipole[..]),
        ] {
            let mut left = changed;
            while left != 0 {
                let place = left.trailing_zeros() as usize;
                last[place] = numbers[place];
                self.words.push(numbers[place].to_bits());
                left &= left - 1;
            }
        }
        (last.until, last.ends_run) = (new.until, new.ends_run);
        self.last.start = arc.start;
        self.count += 1;
    }

    /// Number of arcs.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True if there are no arcs.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The last arc.
    pub fn last(&self) -> Option<&Arc> {
        (self.count > 0).then_some(&self.last)
    }

    /// A reader of the arcs in order, which lends each arc.
    pub fn reader(&self) -> ArcReader<'_> {
        ArcReader { words: self.words.iter(), arc: START }
    }

    /// The arcs in order.
    pub fn iter(&self) -> impl Iterator<Item = Arc> + '_ {
        let mut reader = self.reader();
        std::iter::from_fn(move || reader.next().copied())
    }

    /// Copies of the arcs in order.
    pub fn to_vec(&self) -> Vec<Arc> {
        self.iter().collect()
    }
}

/// Reads a record arc by arc without copying unchanged numbers.
#[derive(Clone, Debug)]
pub struct ArcReader<'a> {
    words: std::slice::Iter<'a, u64>,
    arc: Arc,
}

impl ArcReader<'_> {
    /// The next arc; `None` after the last.
    #[expect(clippy::should_implement_trait, reason = "an iterator could not lend what it has")]
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

/// Mask of the numbers that differ between `new` and `old`, bit for bit.
#[inline]
fn changes<const K: usize>(old: &[f64; K], new: &[f64; K]) -> u64 {
    // most are unchanged: one test of all together
    if old.iter().zip(new).fold(0, |any, (old, new)| any | (old.to_bits() ^ new.to_bits())) == 0 {
        return 0;
    }
    let mut changed = 0;
    for (i, (old, new)) in old.iter().zip(new).enumerate() {
        changed |= u64::from(old.to_bits() != new.to_bits()) << i;
    }
    changed
}

fn number_mut(applied: &mut Actuation, number: usize) -> &mut f64 {
    const BODY: usize = MAX_THRUSTERS + MAX_WHEELS;
    const DIPOLE: usize = BODY + 3;
    match number {
        DIPOLE.. => &mut applied.dipole[number - DIPOLE],
        BODY.. => &mut applied.body_torque[number - BODY],
        MAX_THRUSTERS..BODY => &mut applied.motor_torque[number - MAX_THRUSTERS],
        _ => &mut applied.thrust[number],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_its_arcs_bit_for_bit() {
        let end_of_run = Actuation { until: 9.0, ..Actuation::end_of_run() };
        let body = Actuation { body_torque: [0.0, -0.0, 7.0], dipole: [1.0, -0.0, 0.5], ..Actuation::none(3.5) };
        let answers = [
            Actuation::none(1.0),
            Actuation::none(2.0).with_thrust(&[1.0, 0.0, 3.0]).with_motor_torque(&[0.5; MAX_WHEELS]),
            Actuation::none(3.0).with_thrust(&[1.0; MAX_THRUSTERS]).with_motor_torque(&[-0.0]),
            body,
            body,
            end_of_run,
        ];
        let mut start = 0.0;
        let mut record = ArcRecord::default();
        for turn in 0..2 {
            record.clear();
            assert!(record.is_empty() && record.last().is_none() && record.iter().next().is_none());
            let mut arcs = Vec::new();
            for (k, applied) in answers.iter().enumerate().skip(turn) {
                let arc = Arc { start: if arcs.is_empty() { 0.0 } else { start }, applied: *applied };
                start = arc.end();
                arcs.push(arc);
                record.push(&arc);
                assert_eq!((record.len(), record.last()), (k + 1 - turn, Some(&arc)));
            }
            let words = |arcs: &[Arc]| format!("{arcs:?}");
            // as text, in which -0 differs from 0
            assert_eq!(words(&record.to_vec()), words(&arcs));
            assert!(record.words.len() < 27 * answers.len(), "{} words", record.words.len());
        }
    }
}
