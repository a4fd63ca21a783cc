//! One plain loop, compiled for each instruction set and chosen at run time: the best that the machine has, or what [`FORCED_BY`] forces.
//!
//! No fused multiply-add is used anywhere, so every instruction set gives the same bits.

use std::cell::Cell;
use std::ffi::OsStr;
use std::sync::OnceLock;

/// The environment variable that forces an instruction set, by its name.
pub const FORCED_BY: &str = "KELIR_SIMD";

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
    Baseline,
}

impl Isa {
    /// That of this thread's loops: what is forced, or else the best that this machine has, but within [`Isa::with`].
    #[inline]
    pub fn detect() -> Self {
        CHOSEN.get().unwrap_or_else(Self::usual)
    }

    /// What this machine has, the narrowest first.
    pub fn all() -> &'static [Self] {
        match Self::best() {
            Self::Avx512 => &[Self::Baseline, Self::Avx2, Self::Avx512],
            Self::Avx2 => &[Self::Baseline, Self::Avx2],
            Self::Baseline => &[Self::Baseline],
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

    /// What [`FORCED_BY`] forces, read once; a program asks before it begins. Errors: no instruction set, or none of this machine's.
    pub fn forced() -> Result<Option<Self>, String> {
        static FORCED: OnceLock<Result<Option<Isa>, String>> = OnceLock::new();
        let read = || match std::env::var_os(FORCED_BY) {
            Some(word) if !word.is_empty() => Self::named(&word).map(Some),
            _ => Ok(None),
        };
        FORCED.get_or_init(read).clone()
    }

    fn named(word: &OsStr) -> Result<Self, String> {
        let here = || Self::all().iter().map(|isa| isa.name()).collect::<Vec<_>>().join(", ");
        match [Self::Baseline, Self::Avx2, Self::Avx512].into_iter().find(|isa| word == isa.name()) {
            Some(isa) if Self::all().contains(&isa) => Ok(isa),
            Some(isa) => Err(format!("{FORCED_BY} = {}: this machine has {}", isa.name(), here())),
            None => Err(format!(
                "{FORCED_BY} = {word:?}: must be one of {}, or unset for the last of them",
                here()
            )),
        }
    }

    /// What is forced, where it can be, or else the best.
    fn usual() -> Self {
        static USUAL: OnceLock<Isa> = OnceLock::new();
        *USUAL.get_or_init(|| Self::forced().ok().flatten().unwrap_or_else(Self::best))
    }

    /// The best that this machine has.
    fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if std::arch::is_x86_feature_detected!("avx512f")
                && std::arch::is_x86_feature_detected!("avx512bw")
                && std::arch::is_x86_feature_detected!("avx512dq")
                && std::arch::is_x86_feature_detected!("avx512vl")
                && std::arch::is_x86_feature_detected!("avx512vbmi")
            {
                return Self::Avx512;
            }
            if std::arch::is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// The name of this thread's, for provenance, and that it is forced where it is: "avx2" or "avx2 (forced by KELIR_SIMD)".
    pub fn provenance() -> String {
        let isa = Self::detect().name();
        match (CHOSEN.get(), Self::forced()) {
            (None, Ok(Some(_))) => format!("{isa} (forced by {FORCED_BY})"),
            _ => isa.to_owned(),
        }
    }

    /// What native loops run on, for provenance: "native 2 threads avx2".
    pub fn native() -> String {
        format!("native {} threads {}", rayon::current_num_threads(), Self::provenance())
    }

    /// Lower-case name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Baseline => "baseline",
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
                    $crate::simd::Isa::Baseline => {}
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
        let usual = Isa::detect();
        // A wrong word in the environment of the tests is no green run.
        let forced = Isa::forced().unwrap_or_else(|problem| panic!("{problem}"));
        assert_eq!(usual, forced.unwrap_or(Isa::all()[Isa::all().len() - 1]));
        for &isa in Isa::all() {
            let nested = isa.with(|| (Isa::detect(), Isa::Baseline.with(Isa::detect), Isa::detect()));
            assert_eq!(nested, (isa, Isa::Baseline, isa));
            assert_eq!(isa.with(|| std::thread::spawn(Isa::detect).join().ok()), Some(usual));
            assert_eq!(isa.with(Isa::provenance), isa.name());
        }
        assert_eq!(Isa::detect(), usual);
    }

    /// A word is an instruction set of this machine, or a problem that names those.
    #[test]
    fn a_forced_instruction_set_is_this_machines() {
        let named = |word: &str| Isa::named(word.as_ref());
        for isa in [Isa::Baseline, Isa::Avx2, Isa::Avx512] {
            match named(isa.name()) {
                Ok(found) => assert!(found == isa && Isa::all().contains(&isa)),
                Err(problem) => {
                    assert!(!Isa::all().contains(&isa) && problem.contains("has baseline"), "{problem}")
                }
            }
        }
        for word in ["sse9", "AVX2", "plain", " avx2"] {
            let problem = named(word).expect_err(word);
            assert!(
                problem.contains(&format!("KELIR_SIMD = {word:?}: must be one of baseline")),
                "{problem}"
            );
        }
    }
}
