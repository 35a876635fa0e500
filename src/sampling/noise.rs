//! [`Noise`]: random numbers within a run, addressed by tick, for sensors and control laws.
//!
//! The generator is that of [`super::stream`] with the key (seed, name, `noise`), the sample as ChaCha's stream number,
//! and the k-th word for tick k: a number depends on (seed, name, sample, tick) alone.

use rand::Rng;
use rand::rngs::ChaCha8Rng;

use super::stream::{SampleId, generator, unit};
use crate::math::normal;

const PURPOSE: [u8; 8] = *b"noise\0\0\0";

/// The random numbers called `name` in one run; reading ticks in order is fastest.
#[derive(Debug)]
pub struct Noise {
    generator: ChaCha8Rng,
    next: u64,
}

impl Noise {
    pub fn new(seed: u64, name: &str, sample: SampleId) -> Self {
        let mut generator = generator(seed, name, PURPOSE);
        generator.set_stream(sample.0);
        Noise { generator, next: 0 }
    }

    /// The number u of `tick`, 0 < u < 1.
    pub fn uniform(&mut self, tick: u64) -> f64 {
        if tick != self.next {
            self.generator.set_word_pos(2 * u128::from(tick));
        }
        self.next = tick.wrapping_add(1);
        unit(self.generator.next_u64())
    }

    pub fn normal(&mut self, tick: u64) -> f64 {
        normal::quantile(self.uniform(tick))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: a number depends on seed, name, sample and tick alone, not on the order of reading; each of the four
    /// changes it.
    #[test]
    fn numbers_depend_on_their_address_alone() {
        let mut noise = Noise::new(1, "gyro", SampleId(7));
        let in_order: Vec<f64> = (0..40).map(|tick| noise.uniform(tick)).collect();
        for tick in [39, 0, 17, 17, 3] {
            assert_eq!(noise.uniform(tick), in_order[tick as usize]);
        }
        for mut other in
            [Noise::new(2, "gyro", SampleId(7)), Noise::new(1, "gyrp", SampleId(7)), Noise::new(1, "gyro", SampleId(8))]
        {
            assert!((0..40).all(|tick| other.uniform(tick) != in_order[tick as usize]));
        }
        assert_ne!(super::super::Stream::new(1, "gyro").uniform(SampleId(7)), in_order[7]);
    }
}
