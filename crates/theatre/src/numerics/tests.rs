#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use kelir_frame::Backend;

use super::*;

/// Masks that are small enough for a test; `kelir bench numerics` goes to 8192².
const MOST: usize = 1024;

#[test]
fn every_case_holds_and_plain_floats_do_not() {
    let cases = cases(MOST);
    assert!(cases.len() > 90, "{}", cases.len());
    let rows: Vec<Row> = cases.iter().map(|case| measure(case).unwrap()).collect();
    let mut worst = [0f64; 5];
    let mut off = 0;
    for row in &rows {
        assert!(row.holds(), "{row:?}");
        // The product is the exact table that it says it is, to f32's last digits.
        let used = row.variants[VARIANTS.iter().position(|v| *v == row.uses).unwrap()];
        assert!(row.product <= used + 2e-7, "{row:?}");
        if row.parallel {
            worst.iter_mut().zip(row.variants).for_each(|(w, v)| *w = w.max(v));
            off += row.bytes_off;
        }
    }
    let [narrow, wide, float, biased, corners] = worst;
    assert!(wide <= 1e-7, "{wide:e}");
    // The negative controls: what the product does not do fails somewhere.
    assert!(narrow > 0.01, "16-bit boxes overflow u32: {narrow:e}");
    assert!(float > 0.01 && biased > 1e-4 && corners > 0.01, "{float:e} {biased:e} {corners:e}");
    // It uses the narrow table where that is exact, and the wide one where that is needed.
    assert!(rows.iter().any(|r| r.uses == "u32" && r.variants[0] <= 1e-7));
    assert!(rows.iter().any(|r| r.uses == "u64" && r.variants[0] > 0.01));
    assert!(off < rows.iter().map(|r| r.pixels).sum::<usize>() / 1000, "{off} bytes differ");
}

/// A slightly wrong theatre must not hold.
#[test]
fn a_wrong_theatre_is_told() {
    let mut case = cases(64).into_iter().find(|c| c.is_parallel()).unwrap();
    let right = case.theatre();
    case.emitters[0].0[0] *= 1.001;
    let wrong = case.theatre();
    let view = View { size: SIZE, pixel: case.pixel, skip: true };
    let plan = Plan::new(&right, &view, &pa::Knobs::default()).unwrap();
    let pixels = pixels(&right, &plan);
    let of = |theatre: &Theatre| -> Vec<Vec<f64>> {
        pixels.iter().map(|[i, j]| truth(theatre, Point::pixel(theatre, &view, *i, *j))).collect()
    };
    assert!(compare(&right, &view, &plan, &pixels, &of(&right))[1] <= 1e-12);
    assert!(compare(&right, &view, &plan, &pixels, &of(&wrong))[1] > 1e-5);
}

#[test]
fn tiny_emitters_keep_their_digits() {
    let all = emitters();
    assert_eq!(all.iter().map(|e| e.points).sum::<usize>(), 170);
    for e in &all {
        assert!(e.product <= 1e-12, "{e:?}");
    }
    // The negative controls: textbook formulas in f64, and in f32.
    let tiny = all.iter().find(|e| e.size_m == [1e-6; 2]).unwrap();
    assert!(tiny.closed_form > 1e-6 && tiny.closed_form_f32 > 0.5, "{tiny:?}");
}

#[test]
fn curves_fall_and_the_dome_keeps_its_bound() {
    let curves = curves().unwrap();
    for curve in &curves {
        let (first, last) = (&curve.steps[0], &curve.steps[curve.steps.len() - 1]);
        assert!(last.rmse < 0.5 * first.rmse, "{curve:?}");
        if curve.knob == "dome_steps" {
            let default = curve.steps.iter().find(|s| s.value == curve.default).unwrap();
            assert!(default.max <= 1e-3, "{curve:?}");
        }
    }
    let domes: Vec<_> = curves.iter().filter(|c| c.knob == "dome_steps").collect();
    assert_eq!(domes.len(), 3);
    // The negative control: a coarser lattice does not keep it.
    assert!(domes.iter().any(|c| c.steps[0].max > 1e-3), "{domes:?}");
}

/// From 1 to 256 puppets behind each other, in 8 and 16 bits, by every technique on both backends.
#[test]
fn many_puppets_are_a_product_that_stays_one() {
    // A software adapter takes long; `kelir bench numerics` asks any for all.
    for (backend, most, expected) in [(Backend::Cpu, 256, 28 * 5), (Backend::Gpu, 17, 20 * 4)] {
        let rows = stacks(most, backend, |_| ()).unwrap();
        assert_eq!(rows.len(), expected);
        for row in &rows {
            assert!(row.holds(), "{row:?}");
            assert!(row.error.is_some(), "{row:?}");
        }
        // The negative control: an edge that is seen wrongly is told, so a stack that lets nothing through is no excuse.
        assert!(
            rows.iter().any(|row| row.technique == "points" && row.error.is_some_and(|error| error > 0.01))
        );
    }
}
