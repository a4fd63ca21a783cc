//! The loops for each instruction set, and what they read without a check, draw what the baseline draws, to the bit.

use kelir_render::numerics::{Case, cases};
use kelir_render::{Backend, Isa, Technique, View, renderer};

/// Bits of a drawing by the loops of `isa`, and its display codes.
fn drawn(isa: Isa, technique: &Technique, case: &Case) -> (Vec<u32>, Vec<u32>) {
    let (theatre, view) = (case.theatre(), View { size: [96, 54], pixel: case.pixel, skip: true });
    // One thread, so that it is the forced one.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        isa.with(|| {
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

/// The loops for each instruction set, and what they read without a check, draw what the baseline draws, to the bit.
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
    let cases: Vec<_> =
        every(15, |_| true).chain(every(2, |c| c.bits == 16)).chain(every(3, |c| !c.is_parallel())).collect();
    assert!(cases.iter().any(|case| case.bits == 16) && cases.iter().any(|case| !case.is_parallel()));
    for case in &cases {
        for technique in &techniques {
            let Ok(_) = renderer(technique, Backend::Cpu)
                .unwrap()
                .radiance(&case.theatre(), &View { size: [16, 9], pixel: case.pixel, skip: true })
            else {
                continue;
            };
            let baseline = drawn(Isa::Baseline, technique, case);
            for &isa in Isa::all() {
                assert!(
                    drawn(isa, technique, case) == baseline,
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
    assert!(drawn(Isa::Baseline, &other, &cases[0]) != drawn(Isa::Baseline, &techniques[2], &cases[0]));
}
