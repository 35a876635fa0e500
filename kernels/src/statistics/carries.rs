//! [`Carries`]: makes counters of 32 bits count without an end. There may be millions of them.
//!
//! A campaign has tens of megabytes of counters that stay below 2^32, and may have one that does not.

use std::collections::BTreeMap;

/// What counters of 32 bits have carried: for each, how often it was full. A counter has a number of its own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Carries(BTreeMap<u32, u64>);

impl Carries {
    /// Adds `count` to the counter with the number `key`, whose lower 32 bits are `low`.
    #[inline(always)]
    pub fn add(&mut self, key: u32, low: &mut u32, count: u64) {
        let sum = u64::from(*low) + (count & u64::from(u32::MAX));
        *low = sum as u32;
        let carried = (sum >> 32) + (count >> 32);
        if carried > 0 {
            self.carry(key, carried);
        }
    }

    #[cold]
    fn carry(&mut self, key: u32, carried: u64) {
        *self.0.entry(key).or_default() += carried;
    }

    /// Whether no counter has carried: those whose lower 32 bits are zero have counted nothing then.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// What the counter with the number `key` has counted, whose lower 32 bits are `low`.
    pub fn whole(&self, key: u32, low: u32) -> u64 {
        match self.0.get(&key) {
            Some(carried) => carried << 32 | u64::from(low),
            None => u64::from(low),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: counters add up beyond 32 bits, each for itself, in any order.
    #[test]
    fn counters_do_not_end() {
        let counts = [1, u64::from(u32::MAX), 5, 1 << 32, (7 << 32) + 3, u64::from(u32::MAX) - 1, 0];
        for turn in 0..counts.len() {
            let (mut carries, mut lows, mut turned) = (Carries::default(), [0_u32; 2], counts);
            turned.rotate_left(turn);
            for count in turned {
                carries.add(4, &mut lows[0], count);
                carries.add(9, &mut lows[1], 2);
            }
            assert_eq!(carries.whole(4, lows[0]), counts.iter().sum::<u64>());
            assert_eq!(carries.whole(9, lows[1]), 2 * counts.len() as u64);
        }
    }
}
