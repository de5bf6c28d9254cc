//! Kernels compiled for several generations of processors; the newest that the processor at hand can do is taken.
//!
//! `FAIRLEAD_SIMD=baseline`, `avx2` or `avx512` in the environment takes no newer one than that: for tools that follow only older
//! instructions, and to see that results do not depend on it.

/// A computation worth compiling for the widest registers of the processor at hand. (A trait, because a closure cannot be made to be inlined.)
pub trait Kernel {
    /// Its result.
    type Output;

    /// Computes it; to be marked `#[inline(always)]`, like all that it calls in its loops.
    fn run(self) -> Self::Output;
}

/// Generations of x86-64 processors, the oldest first.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Registers {
    /// What every one has.
    Baseline,
    /// Since about 2013: 4 numbers side by side.
    Avx2,
    /// 8 numbers side by side and 32 registers.
    Avx512,
}

#[cfg(target_arch = "x86_64")]
impl Registers {
    /// The newest that this processor has and the user has not ruled out: asked once in the life of the process.
    #[inline]
    fn at_hand() -> Self {
        static CHOSEN: std::sync::OnceLock<Registers> = std::sync::OnceLock::new();
        *CHOSEN.get_or_init(|| {
            let ceiling = match std::env::var("FAIRLEAD_SIMD").as_deref() {
                Ok("baseline") => Self::Baseline,
                Ok("avx2") => Self::Avx2,
                _ => Self::Avx512,
            };
            Self::of_the_processor().min(ceiling)
        })
    }

    fn of_the_processor() -> Self {
        macro_rules! has {
            ($($feature:tt),*) => { $(std::arch::is_x86_feature_detected!($feature))&&* };
        }
        if has!("avx512f", "avx512vl", "avx512dq", "avx2") {
            Self::Avx512
        } else if has!("avx2") {
            Self::Avx2
        } else {
            Self::Baseline
        }
    }
}

/// Whether kernels run in the widest registers.
#[cfg(target_arch = "x86_64")]
#[inline]
pub fn has_avx512() -> bool {
    Registers::at_hand() == Registers::Avx512
}

/// Runs a kernel compiled for this processor. Rounding does not depend on the processor: products and sums are not fused.
#[inline]
pub fn widest<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    {
        #[target_feature(enable = "avx512f,avx512vl,avx512dq")]
        fn avx512<K: Kernel>(kernel: K) -> K::Output {
            kernel.run()
        }
        #[target_feature(enable = "avx2")]
        fn avx2<K: Kernel>(kernel: K) -> K::Output {
            kernel.run()
        }
        // SAFETY (both): the features that the function is compiled for are those of this processor.
        #[allow(unsafe_code)]
        match Registers::at_hand() {
            Registers::Avx512 => return unsafe { avx512(kernel) },
            Registers::Avx2 => return unsafe { avx2(kernel) },
            Registers::Baseline => {}
        }
    }
    kernel.run()
}
