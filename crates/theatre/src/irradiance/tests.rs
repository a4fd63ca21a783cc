#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
use kelir_scene::Screen;

use super::rows::means_over_pixels;
use super::*;
use crate::project::pixel_m;

/// Kind, half-sides, lamp, point and value from mpmath; `tests/data/irradiance.py` made them.
fn cases() -> Vec<(EmitterShape, DVec3, DVec2, f64)> {
    let parse = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let v: Vec<f64> = fields[1..].iter().map(|f| f.parse().unwrap()).collect();
        let shape = match fields[0] {
            "disk" => EmitterShape::Disk { radius_m: v[0] },
            _ => EmitterShape::Rectangle { size_m: [2.0 * v[0], 2.0 * v[1]] },
        };
        (shape, DVec3::new(v[2], v[3], v[4]), DVec2::new(v[5], v[6]), v[7])
    };
    include_str!("../../tests/data/irradiance.csv").lines().map(parse).collect()
}

#[test]
fn agrees_with_mpmath_to_1e12() {
    let cases = cases();
    assert_eq!(cases.len(), 170);
    for (shape, lamp, p, expected) in &cases {
        let got = unit(shape, *lamp, *p);
        assert!((got / expected - 1.0).abs() <= 1e-12, "{shape:?} {lamp} {p}: {got:e}, not {expected:e}");
    }
    // The negative control: Lambert's formula alone loses the digits of the smallest emitter.
    let (_, lamp, p, expected) = cases[1];
    let naive = lambert(lamp.truncate() - p, 5e-7, 5e-7, -lamp.z);
    assert!((naive / expected - 1.0).abs() > 1e-6, "{naive:e}");
}

#[test]
fn rows_keep_their_bound() {
    let screen = Screen { width_m: 1.6, height_m: 0.9, albedo: kelir_scene::Albedo::Uniform([1.0; 3]) };
    let size = [1600, 9];
    let mut strides = Vec::new();
    for (side, z) in [(1e-6, -1.5), (0.02, -1.5), (0.1, -1.5), (0.1, -0.3), (1.0, -0.4)] {
        let (shape, lamp) =
            (EmitterShape::Rectangle { size_m: [side, 0.7 * side] }, DVec3::new(0.3, -0.1, z));
        let image = unit_image(&shape, lamp, &screen, size);
        strides.push(UnitRows::new(&shape, lamp, &screen, size).stride);
        for (k, got) in image.iter().enumerate() {
            let p = pixel_m(&screen, size, (k % size[0]) as f64, (k / size[0]) as f64);
            let expected = unit(&shape, lamp, p);
            assert!((got / expected - 1.0).abs() <= 2e-8, "{side} {z}: {got:e}, not {expected:e}");
        }
    }
    assert_eq!(strides, [4, 4, 4, 1, 1], "both ways are tried");
}

/// Any columns of a row are those of the whole row, to the bit.
#[test]
fn spans_are_parts_of_rows() {
    let screen = Screen { width_m: 1.6, height_m: 0.9, albedo: kelir_scene::Albedo::Uniform([1.0; 3]) };
    let lamp = DVec3::new(0.3, -0.1, -1.5);
    for (shape, width) in [
        (EmitterShape::Rectangle { size_m: [0.1, 0.07] }, 1600),
        (EmitterShape::Rectangle { size_m: [0.1, 0.07] }, 37),
        (EmitterShape::Disk { radius_m: 0.05 }, 40),
    ] {
        let rows = UnitRows::new(&shape, lamp, &screen, [width, 9]);
        let mut whole = vec![0.0; width];
        rows.row(3, &mut whole);
        for (first, count) in
            [(0, 1), (1, 2), (3, 5), (4, 8), (7, 30), (width - 1, 1), (0, width), (5, width - 5)]
        {
            let mut part = vec![f64::NAN; count];
            rows.span(3, first, &mut part);
            assert_eq!(part, whole[first..first + count], "{width} columns, {count} from {first}");
        }
    }
}

/// Against 64 × 64 midpoints in each pixel; the value at the centre is far off (negative control).
#[test]
fn means_over_pixels_are_means() {
    let screen = Screen { width_m: 1.6, height_m: 0.9, albedo: kelir_scene::Albedo::Uniform([1.0; 3]) };
    let size = [48, 27];
    for shape in [EmitterShape::Rectangle { size_m: [0.1, 0.2] }, EmitterShape::Disk { radius_m: 0.05 }] {
        let lamp = DVec3::new(0.3, -0.1, -1.5);
        let image = unit_image(&shape, lamp, &screen, size);
        let means = means_over_pixels(&image, size);
        let (mut worst, mut at_centres) = (0f64, 0f64);
        for (i, j) in [(0, 0), (20, 13), (33, 0), (47, 26), (0, 12)] {
            let part = |k: usize| (k as f64 + 0.5) / 64.0 - 0.5;
            let at = |k: usize| pixel_m(&screen, size, i as f64 + part(k % 64), j as f64 + part(k / 64));
            let mean = (0..4096).map(|k| unit(&shape, lamp, at(k))).sum::<f64>() / 4096.0;
            worst = worst.max((means[j * size[0] + i] / mean - 1.0).abs());
            at_centres = at_centres.max((image[j * size[0] + i] / mean - 1.0).abs());
        }
        assert!(worst < 1e-6 && at_centres > 5e-5, "{worst:e} {at_centres:e}");
    }
}

#[test]
fn gauss_and_closed_form_meet() {
    for k in 0..40 {
        let (c, h) = (DVec2::new(0.03 * k as f64, 0.2), 0.7);
        let (closed, gauss) = (lambert(c, 0.05, 0.08, h), gauss(c, 0.05, 0.08, h));
        assert!((closed / gauss - 1.0).abs() < 1e-12, "{closed:e} {gauss:e}");
    }
}

#[test]
fn a_disk_and_a_square_of_one_area_agree_from_far_away() {
    let far = DVec3::new(0.0, 0.0, -100.0);
    let square = unit(&EmitterShape::Rectangle { size_m: [0.01; 2] }, far, DVec2::ZERO);
    let disk = unit(&EmitterShape::Disk { radius_m: 0.01 / std::f64::consts::PI.sqrt() }, far, DVec2::ZERO);
    assert!((square / disk - 1.0).abs() < 1e-9);
    assert!((square / 1e-8 - 1.0).abs() < 1e-7, "area over squared distance: {square:e}");
}
