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
        #[cfg(test)]
        if let Some(isa) = tests::FORCED.get() {
            return isa;
        }
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

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use std::cell::Cell;

    use super::Isa;
    use crate::numerics::{Case, cases};
    use crate::{Backend, Technique, View, renderer};

    thread_local! {
        /// What [`Isa::detect`] answers on this thread.
        pub(super) static FORCED: Cell<Option<Isa>> = const { Cell::new(None) };
    }

    /// What `run` answers with the loops of `isa`, on this thread alone.
    pub(crate) fn with<R>(isa: Isa, run: impl FnOnce() -> R) -> R {
        let before = FORCED.replace(Some(isa));
        let answer = run();
        FORCED.set(before);
        answer
    }

    /// What this machine has, the plain loops first.
    pub(crate) fn all() -> Vec<Isa> {
        match Isa::detect() {
            Isa::Avx512 => vec![Isa::Plain, Isa::Avx2, Isa::Avx512],
            Isa::Avx2 => vec![Isa::Plain, Isa::Avx2],
            Isa::Plain => vec![Isa::Plain],
        }
    }

    /// Bits of a drawing by the loops of `isa`, and its display codes.
    fn drawn(isa: Isa, technique: &Technique, case: &Case) -> (Vec<u32>, Vec<u32>) {
        let (theatre, view) = (case.theatre(), View { size: [96, 54], pixel: case.pixel, skip: true });
        // One thread, so that it is the forced one.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| {
            with(isa, || {
                let mut renderer = renderer(technique, Backend::Cpu).unwrap();
                if technique.name() == "pa" {
                    assert!(renderer.adapter().ends_with(isa.name()), "{}", renderer.adapter());
                }
                let frame = renderer.radiance(&theatre, &view).unwrap();
                let mut codes = vec![0; 96 * 54];
                renderer.display(&theatre, &view, 8.0, &mut codes).unwrap();
                (frame.radiance.iter().flatten().map(|v| v.to_bits()).collect(), codes)
            })
        })
    }

    /// The loops for each instruction set, and what they read without a check, draw what the plain ones draw, to the bit.
    #[test]
    fn every_instruction_set_draws_the_same_bits() {
        let technique = |name: &str, knobs: &[(&str, u64)]| {
            let knobs = knobs.iter().map(|(name, value)| ((*name).to_owned(), (*value).into()));
            Technique::parse(name, &knobs.collect()).unwrap()
        };
        let techniques = [
            technique("pa", &[]),
            technique("pa", &[("split", 2)]),
            technique("mc", &[("spp", 32)]),
            technique("pcss", &[]),
        ];
        let every = |n: usize, which: fn(&Case) -> bool| cases(512).into_iter().filter(which).step_by(n);
        let cases: Vec<_> = every(15, |_| true)
            .chain(every(2, |c| c.bits == 16))
            .chain(every(3, |c| !c.is_parallel()))
            .collect();
        assert!(cases.iter().any(|case| case.bits == 16) && cases.iter().any(|case| !case.is_parallel()));
        for case in &cases {
            for technique in &techniques {
                let Ok(_) = renderer(technique, Backend::Cpu)
                    .unwrap()
                    .radiance(&case.theatre(), &View { size: [16, 9], pixel: case.pixel, skip: true })
                else {
                    continue;
                };
                let plain = drawn(Isa::Plain, technique, case);
                for isa in all() {
                    assert!(
                        drawn(isa, technique, case) == plain,
                        "{}: {} on {}",
                        case.name,
                        technique.name(),
                        isa.name()
                    );
                }
            }
        }
        // The negative control: other sums are seen.
        let other = technique("mc", &[("spp", 32), ("seed", 2)]);
        assert!(drawn(Isa::Plain, &other, &cases[0]) != drawn(Isa::Plain, &techniques[2], &cases[0]));
    }
}
