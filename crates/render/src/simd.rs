//! One plain loop, compiled for each instruction set and chosen at run time.
//!
//! No fused multiply-add is used anywhere, so every instruction set gives the same bits.

/// Instruction sets that loops are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Isa {
    /// AVX-512 F, BW, DQ, VL and VBMI.
    Avx512,
    /// AVX2.
    Avx2,
    /// What the target guarantees.
    Plain,
}

impl Isa {
    /// The best that this machine has; asked once.
    pub fn detect() -> Self {
        static BEST: std::sync::OnceLock<Isa> = std::sync::OnceLock::new();
        *BEST.get_or_init(|| {
            #[cfg(target_arch = "x86_64")]
            {
                if std::arch::is_x86_feature_detected!("avx512f")
                    && std::arch::is_x86_feature_detected!("avx512bw")
                    && std::arch::is_x86_feature_detected!("avx512dq")
                    && std::arch::is_x86_feature_detected!("avx512vl")
                    && std::arch::is_x86_feature_detected!("avx512vbmi")
                {
                    return Isa::Avx512;
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    return Isa::Avx2;
                }
            }
            Isa::Plain
        })
    }

    /// Lower-case name, for provenance.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Plain => "plain",
        }
    }
}

/// `multiversion! { fn name(args…) = body; }` makes `name`, which runs the `#[inline(always)]` function `body` as compiled
/// for the best instruction set of this machine.
macro_rules! multiversion {
    ($(#[$meta:meta])* $vis:vis fn $name:ident $(<const $n:ident: $t:ty>)? ($($arg:ident: $ty:ty),* $(,)?) = $body:path;) => {
        $(#[$meta])*
        #[allow(clippy::too_many_arguments, reason = "those of the body")]
        $vis fn $name $(<const $n: $t>)? ($($arg: $ty),*) {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
                #[allow(clippy::too_many_arguments, reason = "those of the body")]
                fn avx512 $(<const $n: $t>)? ($($arg: $ty),*) {
                    $body($($arg),*)
                }
                #[target_feature(enable = "avx2")]
                #[allow(clippy::too_many_arguments, reason = "those of the body")]
                fn avx2 $(<const $n: $t>)? ($($arg: $ty),*) {
                    $body($($arg),*)
                }
                match $crate::simd::Isa::detect() {
                    // SAFETY: detected on this machine.
                    $crate::simd::Isa::Avx512 => return unsafe { avx512 $(::<$n>)? ($($arg),*) },
                    // SAFETY: detected on this machine.
                    $crate::simd::Isa::Avx2 => return unsafe { avx2 $(::<$n>)? ($($arg),*) },
                    $crate::simd::Isa::Plain => {}
                }
            }
            $body($($arg),*)
        }
    };
}
pub(crate) use multiversion;
