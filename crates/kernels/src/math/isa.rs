//! [`Isa`]: the instruction set of the kernels, chosen once per process.
//!
//! One portable binary contains the kernels three times (AVX-512, AVX2 with FMA, plain), with the same bits: arithmetic
//! is IEEE 754, fused only in [`super::Real::mul_add`].

use std::sync::OnceLock;

use fearless_simd::{Level, Simd};

use crate::math::lanes::Lanes;
use crate::math::real::Real;

/// Environment variable that forces a path (`avx512`, `avx2`, `plain`), for tests and comparisons.
pub const VARIABLE: &str = "SPINDRIFT_ISA";

/// An instruction set that this processor has.
#[derive(Clone, Copy, Debug)]
pub struct Isa {
    level: Level,
    name: &'static str,
}

/// Work compiled once per instruction set, for [`Isa::run`]; closures cannot be generic over the token. `run` and all
/// hot callees should be `#[inline(always)]`, else they are compiled without the instruction set.
pub trait Work {
    /// Result of the work.
    type Output;
    /// Does the work with vectors of the instruction set `S`.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Work in lanes, for [`Isa::run_wide`] in as many as suit the registers.
///
/// AVX-512 (32 registers of eight lanes) takes sixteen lanes, AVX2 (16 of four) eight. The plain path of x86-64 takes
/// one number at a time: its time is spent in library calls for the fused operation, and lanes would cost several times
/// the machine code. [`Isa::run_narrow`] saves compile time.
pub trait LaneWork {
    /// Result of the work.
    type Output;
    /// Does the work; `zero` determines the number of lanes.
    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output;
}

impl Isa {
    /// The best instruction set of this processor.
    pub fn best() -> Self {
        let level = Level::new();
        Self::named(level, "avx512").or_else(|| Self::named(level, "avx2")).unwrap_or_else(Self::plain)
    }

    /// The path `name` (`avx512`, `avx2`, `plain`), if known and available.
    pub fn from_name(name: &str) -> Option<Self> {
        if name == "plain" { Some(Self::plain()) } else { Self::named(Level::new(), name) }
    }

    /// The choice of this process: the value of [`VARIABLE`], else the best.
    ///
    /// # Errors
    /// The value of the variable, if it is no available path.
    pub fn chosen() -> Result<Self, String> {
        static CHOICE: OnceLock<Result<Isa, String>> = OnceLock::new();
        CHOICE
            .get_or_init(|| match std::env::var(VARIABLE) {
                Ok(name) => Isa::from_name(&name).ok_or(name),
                Err(_) => Ok(Isa::best()),
            })
            .clone()
    }

    /// All available paths, best first.
    pub fn available() -> Vec<Self> {
        ["avx512", "avx2", "plain"].into_iter().filter_map(Self::from_name).collect()
    }

    /// The name of the path.
    pub fn name(self) -> &'static str {
        self.name
    }

    fn named(level: Level, name: &str) -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        {
            match name {
                "avx512" => level.as_avx512().map(|simd| Isa { level: simd.level(), name: "avx512" }),
                "avx2" => level.as_avx2().map(|simd| Isa { level: simd.level(), name: "avx2" }),
                _ => None,
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            let _ = (level, name);
            None
        }
    }

    /// The target's baseline; on x86-64 fused operations are library calls.
    fn plain() -> Self {
        Isa { level: Level::baseline(), name: "plain" }
    }

    /// Runs `work` in lanes of AVX2 if this instruction set has them, else one number at a time.
    pub fn run_narrow<W: LaneWork>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        {
            if self.name != "plain"
                && let Some(simd) = self.level.as_avx2()
            {
                return work.run(simd, Lanes::broadcast(simd, 0.0));
            }
            work.run(self.level.as_sse2().expect("every x86-64 processor has SSE2"), 0.0)
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            fearless_simd::dispatch!(self.level, simd => work.run(simd, 0.0))
        }
    }

    /// Runs `work` in the number of lanes that suits this instruction set.
    pub fn run_wide<W: LaneWork>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        {
            match self.name {
                "avx512" => {
                    if let Some(simd) = self.level.as_avx512() {
                        let zero = Lanes::broadcast(simd, 0.0);
                        return work.run(simd, crate::math::pair::Pair(zero, zero));
                    }
                }
                "avx2" => {
                    if let Some(simd) = self.level.as_avx2() {
                        return work.run(simd, Lanes::broadcast(simd, 0.0));
                    }
                }
                _ => {}
            }
            work.run(self.level.as_sse2().expect("every x86-64 processor has SSE2"), 0.0)
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            fearless_simd::dispatch!(self.level, simd => work.run(simd, Lanes::broadcast(simd, 0.0)))
        }
    }

    /// Runs `work` compiled for this instruction set.
    #[inline]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        {
            match self.name {
                "avx512" => {
                    if let Some(simd) = self.level.as_avx512() {
                        return simd.vectorize(
                            #[inline(always)]
                            || work.run(simd),
                        );
                    }
                }
                "avx2" => {
                    if let Some(simd) = self.level.as_avx2() {
                        return simd.vectorize(
                            #[inline(always)]
                            || work.run(simd),
                        );
                    }
                }
                _ => {}
            }
            let simd = self.level.as_sse2().expect("every x86-64 processor has SSE2");
            simd.vectorize(
                #[inline(always)]
                || work.run(simd),
            )
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            fearless_simd::dispatch!(self.level, simd => work.run(simd))
        }
    }
}
