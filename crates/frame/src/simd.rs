//! One plain loop, compiled for each instruction set and chosen at run time.
//!
//! No fused multiply-add is used anywhere, so every instruction set gives the same bits.

use std::cell::Cell;

thread_local! {
    /// What [`Isa::detect`] answers on this thread, where [`Isa::with`] says so.
    static CHOSEN: Cell<Option<Isa>> = const { Cell::new(None) };
}

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
    /// That of this thread's loops: the best that this machine has, but within [`Isa::with`].
    #[inline]
    pub fn detect() -> Self {
        CHOSEN.get().unwrap_or_else(Self::best)
    }

    /// What this machine has, the plain loops first.
    pub fn all() -> Vec<Self> {
        match Self::best() {
            Self::Avx512 => vec![Self::Plain, Self::Avx2, Self::Avx512],
            Self::Avx2 => vec![Self::Plain, Self::Avx2],
            Self::Plain => vec![Self::Plain],
        }
    }

    /// What `run` answers with the loops of this one, on this thread alone: to compare them.
    ///
    /// # Panics
    /// Where this machine does not have it.
    pub fn with<R>(self, run: impl FnOnce() -> R) -> R {
        assert!(Self::all().contains(&self), "this machine has no {}", self.name());
        let before = CHOSEN.replace(Some(self));
        let answer = run();
        CHOSEN.set(before);
        answer
    }

    /// Asked once.
    fn best() -> Self {
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
#[macro_export]
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
                    // SAFETY: this machine has it.
                    $crate::simd::Isa::Avx512 => return unsafe { avx512 $(::<$n>)? ($($arg),*) },
                    // SAFETY: this machine has it.
                    $crate::simd::Isa::Avx2 => return unsafe { avx2 $(::<$n>)? ($($arg),*) },
                    $crate::simd::Isa::Plain => {}
                }
            }
            $body($($arg),*)
        }
    };
}
#[cfg(test)]
mod tests {
    use super::Isa;

    /// Each instruction set that the machine has is what the thread's loops are of, as long as it is asked for and no longer.
    #[test]
    fn an_instruction_set_is_chosen_for_a_while() {
        let best = Isa::detect();
        assert_eq!(Isa::all().last(), Some(&best));
        for isa in Isa::all() {
            let nested = isa.with(|| (Isa::detect(), Isa::Plain.with(Isa::detect), Isa::detect()));
            assert_eq!(nested, (isa, Isa::Plain, isa));
            assert_eq!(isa.with(|| std::thread::spawn(Isa::detect).join().ok()), Some(best));
        }
        assert_eq!(Isa::detect(), best);
    }
}
