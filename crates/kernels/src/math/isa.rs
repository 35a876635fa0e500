//! [`Isa`]: the instruction set of the kernels, chosen once per process.
//!
//! One portable binary contains the kernels three times (AVX-512, AVX2 with FMA, plain), with the same bits: arithmetic
//! is IEEE 754, fused only in [`super::Real::mul_add`].

use std::sync::OnceLock;

use fearless_simd::{Level, Simd};

use crate::math::lanes::Lanes;
use crate::math::one::One;
use crate::math::pair::Pair;
use crate::math::real::Real;

/// Environment variable that forces a path: `avx512`, `avx2` or `plain`.
pub const VARIABLE: &str = "SPINDRIFT_ISA";

/// An instruction set that this processor has.
#[derive(Clone, Copy, Debug)]
pub struct Isa {
    level: Level,
    name: &'static str,
}

/// Work compiled once per instruction set; closures cannot be generic over the token. Hot code must be
/// `#[inline(always)]`, else it is compiled without the instruction set.
pub trait Work {
    /// Result of the work.
    type Output;
    /// Does the work with vectors of the instruction set `S`.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Work in lanes, for [`Isa::run_wide`] in as many as suit the registers.
///
/// AVX-512 (32 registers of eight lanes) takes sixteen lanes, AVX2 (16 of four) eight. The plain path of x86-64 takes
/// one number at a time: its fused operation is a library call, and lanes would cost several times the machine code.
pub trait LaneWork {
    /// Result of the work.
    type Output;
    /// Does the work; `zero` determines the number of lanes.
    fn run<S: Simd, R: Real + Send + 'static>(self, simd: S, zero: R) -> Self::Output;
}

/// An expression with the token `$simd` of the path of `$isa`, on x86-64 one for each path.
macro_rules! dispatch {
    ($isa:ident, $simd:ident, $($path:literal $token:ident => $work:expr,)*
     plain => $plain:expr, elsewhere => $elsewhere:expr,) => {{
        #[cfg(target_arch = "x86_64")]
        {
            $(if $isa.name == $path && let Some($simd) = $isa.level.$token() {
                return $work;
            })*
            let $simd = $isa.level.as_sse2().expect("every x86-64 processor has SSE2");
            $plain
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            fearless_simd::dispatch!($isa.level, $simd => $elsewhere)
        }
    }};
}

impl Isa {
    /// The best instruction set of this processor.
    pub fn best() -> Self {
        let level = Level::new();
        Self::named(level, "avx512").or_else(|| Self::named(level, "avx2")).unwrap_or_else(Self::plain)
    }

    /// The path `name`, if known and available.
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

    /// Runs `work` one number at a time, with the fused operation of AVX2 if there is one.
    pub fn run_one<W: LaneWork>(self, work: W) -> W::Output {
        dispatch! { self, simd,
            "avx512" as_avx2 => work.run(simd, One(0.0, simd)),
            "avx2" as_avx2 => work.run(simd, One(0.0, simd)),
            plain => work.run(simd, 0.0),
            elsewhere => work.run(simd, 0.0),
        }
    }

    /// Runs `work` in lanes of AVX2 if there are any, else one number at a time, to save compile time.
    pub fn run_narrow<W: LaneWork>(self, work: W) -> W::Output {
        dispatch! { self, simd,
            "avx512" as_avx2 => work.run(simd, Lanes::broadcast(simd, 0.0)),
            "avx2" as_avx2 => work.run(simd, Lanes::broadcast(simd, 0.0)),
            plain => work.run(simd, 0.0),
            elsewhere => work.run(simd, 0.0),
        }
    }

    /// Runs `work` in the number of lanes that suits this instruction set.
    pub fn run_wide<W: LaneWork>(self, work: W) -> W::Output {
        dispatch! { self, simd,
            "avx512" as_avx512 => {
                let zero = Lanes::broadcast(simd, 0.0);
                work.run(simd, Pair(zero, zero))
            },
            "avx2" as_avx2 => work.run(simd, Lanes::broadcast(simd, 0.0)),
            plain => work.run(simd, 0.0),
            elsewhere => work.run(simd, Lanes::broadcast(simd, 0.0)),
        }
    }

    /// Runs `work` in eight lanes, one register of AVX-512: where operands of sixteen exceed the first cache.
    pub fn run_eight<W: LaneWork>(self, work: W) -> W::Output {
        dispatch! { self, simd,
            "avx512" as_avx512 => work.run(simd, Lanes::broadcast(simd, 0.0)),
            "avx2" as_avx2 => work.run(simd, Lanes::broadcast(simd, 0.0)),
            plain => work.run(simd, 0.0),
            elsewhere => work.run(simd, Lanes::broadcast(simd, 0.0)),
        }
    }

    /// Runs `work` compiled for this instruction set.
    #[inline]
    pub fn run<W: Work>(self, work: W) -> W::Output {
        macro_rules! vectorized {
            ($simd:ident) => {
                $simd.vectorize(
                    #[inline(always)]
                    || work.run($simd),
                )
            };
        }
        dispatch! { self, simd,
            "avx512" as_avx512 => vectorized!(simd),
            "avx2" as_avx2 => vectorized!(simd),
            plain => vectorized!(simd),
            elsewhere => work.run(simd),
        }
    }
}
