//! [`Carries`]: extends 32-bit counters, few of which exceed 2^32, without limit.

use std::collections::BTreeMap;

/// Carries of 32-bit counters, by their keys.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Carries(BTreeMap<u32, u64>);

impl Carries {
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

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Value of the counter `key` with the lower 32 bits `low`.
    pub fn whole(&self, key: u32, low: u32) -> u64 {
        self.0.get(&key).map_or(0, |carried| carried << 32) | u64::from(low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: each counter counts beyond 32 bits, in any order.
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
