//! [`Stream`]: the random numbers of one component of one parameter, addressed by sample.
//!
//! The generator is ChaCha with 8 rounds (D. J. Bernstein, *ChaCha, a variant of Salsa20*, 2008), 64-bit block counter
//! and nonce zero. The 256-bit key is, byte by byte,
//!
//! | bytes | |
//! | --- | --- |
//! | 0..8 | seed, little-endian |
//! | 8..24 | FNV-1a, 128 bits, of the component's name (`initial.angular_velocity_rad_s.y`), little-endian |
//! | 24..32 | the ASCII text `sampling` |
//!
//! Sample k takes the k-th little-endian 64-bit word of the key stream: a draw depends on (seed, sample, name) alone, a
//! new parameter renumbers no other, and eight neighbours share a block.

use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};

use crate::math::normal::quantiles;

/// The number of a sample within a campaign; 0 is the nominal scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SampleId(pub u64);

impl std::fmt::Display for SampleId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

/// The last eight bytes of every key: separates these streams from other uses of the seed.
const PURPOSE: [u8; 8] = *b"sampling";
/// Offset basis and prime of FNV-1a, 128 bits (G. Fowler, L. C. Noll, K.-P. Vo).
const FNV_BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
const FNV_PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

fn fnv1a(text: &str) -> u128 {
    text.bytes().fold(FNV_BASIS, |hash, byte| (hash ^ u128::from(byte)).wrapping_mul(FNV_PRIME))
}

pub(super) fn generator(seed: u64, name: &str, purpose: [u8; 8]) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..24].copy_from_slice(&fnv1a(name).to_le_bytes());
    key[24..].copy_from_slice(&purpose);
    ChaCha8Rng::from_seed(key)
}

/// A 64-bit key for the dimension `name` of a design: the first word of a stream for `purpose`.
pub(super) fn key(seed: u64, name: &str, purpose: [u8; 8]) -> u64 {
    generator(seed, name, purpose).next_u64()
}

/// The random numbers of one component, addressed by sample; reading samples in order is fastest.
#[derive(Debug)]
pub struct Stream {
    generator: ChaCha8Rng,
    next: u64,
}

impl Stream {
    pub fn new(seed: u64, name: &str) -> Self {
        Stream { generator: generator(seed, name, PURPOSE), next: 0 }
    }

    #[inline]
    pub fn bits(&mut self, sample: SampleId) -> u64 {
        self.seek(sample.0, 1);
        self.generator.next_u64()
    }

    /// Goes to `place`, from which `count` words are read.
    #[inline]
    fn seek(&mut self, place: u64, count: u64) {
        if place != self.next {
            self.generator.set_word_pos(2 * u128::from(place));
        }
        self.next = place.wrapping_add(count);
    }

    /// The numbers u of the eight samples of `block`, 8 `block` and after: one block of ChaCha.
    #[inline]
    pub fn uniforms(&mut self, block: u64, u: &mut [f64; 8]) {
        self.seek(block.wrapping_mul(8), 8);
        let mut bytes = [0; 64];
        self.generator.fill_bytes(&mut bytes);
        for (u, word) in u.iter_mut().zip(bytes.as_chunks().0) {
            *u = unit(u64::from_le_bytes(*word));
        }
    }

    /// u of `sample`: an odd multiple of 2^-53, so 0 < u < 1 and 1 - u is exact.
    #[inline]
    pub fn uniform(&mut self, sample: SampleId) -> f64 {
        unit(self.bits(sample))
    }
}

#[inline]
pub(super) fn unit(bits: u64) -> f64 {
    const STEP: f64 = f64::EPSILON / 2.0;
    ((bits >> 11) | 1) as f64 * STEP
}

/// The random numbers called `name` in one run, for sensors and control laws, addressed by tick: those of the key
/// (seed, name, `noise`) with the sample as ChaCha's stream number, the k-th word for tick k. Reading ticks in order is
/// fastest.
#[derive(Debug)]
pub struct Noise {
    stream: Stream,
    /// Normal numbers of the eight ticks from eight times `block` on.
    normals: [f64; 8],
    block: Option<u64>,
}

impl Noise {
    pub fn new(seed: u64, name: &str, sample: SampleId) -> Self {
        let mut generator = generator(seed, name, *b"noise\0\0\0");
        generator.set_stream(sample.0);
        Noise { stream: Stream { generator, next: 0 }, normals: [0.0; 8], block: None }
    }

    /// The number u of `tick`, 0 < u < 1.
    pub fn uniform(&mut self, tick: u64) -> f64 {
        self.stream.uniform(SampleId(tick))
    }

    /// The standard normal number of `tick`.
    #[inline]
    pub fn normal(&mut self, tick: u64) -> f64 {
        let block = tick / 8;
        if self.block != Some(block) {
            self.block = Some(block);
            let mut u = [0.0; 8];
            self.stream.uniforms(block, &mut u);
            quantiles(&u, &mut self.normals);
        }
        self.normals[(tick % 8) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal::quantile;

    /// ChaCha8, key and nonce zero: first bytes of the key stream (J. Strombergson, *Test Vectors for the Stream Cipher
    /// ChaCha*, draft-strombergson-chacha-test-vectors-01, TC1, 256-bit key, 8 rounds).
    #[test]
    fn the_generator_gives_the_published_key_stream() {
        let mut generator = ChaCha8Rng::from_seed([0; 32]);
        let mut bytes = [0; 32];
        generator.fill_bytes(&mut bytes);
        let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(hex, "3e00ef2f895f40d67f5bb8e81f09a5a12c840ec3ce9a7f3b181be188ef711a1e");
    }

    #[test]
    fn the_hash_gives_the_published_values() {
        assert_eq!(fnv1a(""), FNV_BASIS);
        assert_eq!(fnv1a("a"), 0xd228_cb69_6f1a_8caf_7891_2b70_4e4a_8964);
    }

    /// Law: a number depends on seed, name, sample and tick alone, not on the order of reading.
    #[test]
    fn numbers_depend_on_their_address_alone() {
        let mut noise = Noise::new(1, "gyro", SampleId(7));
        let in_order: Vec<f64> = (0..40).map(|tick| noise.uniform(tick)).collect();
        for tick in [39, 0, 17, 17, 3] {
            assert_eq!(noise.uniform(tick), in_order[tick as usize]);
            assert_eq!(noise.normal(tick), quantile(in_order[tick as usize]));
        }
        for mut other in
            [Noise::new(2, "gyro", SampleId(7)), Noise::new(1, "gyrp", SampleId(7)), Noise::new(1, "gyro", SampleId(8))]
        {
            assert!((0..40).all(|tick| other.uniform(tick) != in_order[tick as usize]));
        }
        assert_ne!(Stream::new(1, "gyro").uniform(SampleId(7)), in_order[7]);
    }
}
