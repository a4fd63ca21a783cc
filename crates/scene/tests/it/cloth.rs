//! The screen's albedo: woven or an image.

use std::sync::Arc;

use crate::support::{SCENE, files, parse, png};
use kelir_scene::{Albedo, LinearImage, srgb_to_linear};

fn albedo(written: &str) -> Arc<LinearImage> {
    let mut files = files();
    let image = png(3, 2, |x, y| [if x == 0 { 255 } else { 0 }, 188, if y == 0 { 10 } else { 11 }, 255]);
    files.insert("scenes/cloth.png".into(), image);
    let scene = SCENE.replace("albedo = 0.8", &format!("albedo = {written}"));
    match parse(&scene, &files).unwrap().still().screen.albedo {
        Albedo::Image(image) => image,
        Albedo::Uniform(_) => panic!("an image"),
    }
}

/// Mean and standard deviation of channel `c` over rows `rows` (as shares of the height).
fn moments(image: &LinearImage, c: usize, rows: std::ops::Range<f64>) -> [f64; 2] {
    let at = |share: f64| (share * image.height as f64) as usize * image.width;
    let values: Vec<f64> =
        image.channel(c)[at(rows.start)..at(rows.end)].iter().map(|v| f64::from(*v)).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64;
    [mean, variance.sqrt()]
}

#[test]
fn the_transfer_function_is_iec_61966() {
    // Values of the standard's formula, worked out with 30 digits.
    let known = [(0.0, 0.0), (0.04045, 0.003130804953560372), (0.5, 0.21404114048223255), (1.0, 1.0)];
    for (encoded, linear) in known {
        assert!((srgb_to_linear(encoded) - linear).abs() < 1e-15, "{encoded}");
    }
    // Control: the plain power law of 2.2 is another function.
    assert!((srgb_to_linear(0.5) - 0.5f64.powf(2.2)).abs() > 1e-3);
}

#[test]
fn an_image_is_linearised_row_by_row_from_the_top() {
    let image = albedo("{ image = \"cloth.png\" }");
    assert_eq!((image.width, image.height), (3, 2));
    let near = |found: f32, code: f64| (f64::from(found) - srgb_to_linear(code / 255.0)).abs() < 1e-7;
    for i in 0..6 {
        let (x, y) = (i % 3, i / 3);
        let pixel = [0, 1, 2].map(|c| image.channel(c)[i]);
        assert!(near(pixel[0], if x == 0 { 255.0 } else { 0.0 }) && near(pixel[1], 188.0), "{i}: {pixel:?}");
        assert!(near(pixel[2], if y == 0 { 10.0 } else { 11.0 }) && !near(pixel[2], 12.0), "{i}: {pixel:?}");
    }
}

#[test]
fn a_weave_has_its_base_albedo_its_contrast_and_its_seed() {
    let weave =
        |keys: &str| albedo(&format!("{{ weave = {{ base = [0.8, 0.5, 0.2], threads = 120, {keys} }} }}"));
    let cloth = weave("contrast = 0.08, seed = 1");
    assert_eq!((cloth.width, cloth.height), (480, 270));
    for (c, base) in [0.8, 0.5, 0.2].into_iter().enumerate() {
        let [mean, deviation] = moments(&cloth, c, 0.0..1.0);
        assert!((mean / base - 1.0).abs() < 0.02, "channel {c}: mean {mean}");
        assert!((0.01..0.08).contains(&(deviation / base)), "channel {c}: deviation {deviation}");
    }
    assert!(cloth.planes.iter().flatten().all(|v| (0.0..=1.0).contains(v)));
    assert_eq!(weave("contrast = 0.08, seed = 1").planes, cloth.planes, "the same seed is the same cloth");
    assert_ne!(weave("contrast = 0.08, seed = 2").planes, cloth.planes, "another seed is another");
    assert!(moments(&weave("contrast = 0.0"), 0, 0.0..1.0)[1] < 1e-6, "no contrast is a plain sheet");
    let [edge, middle] = [0.0..0.1, 0.45..0.55].map(|rows| moments(&weave("vignette = 0.5"), 0, rows)[0]);
    assert!(edge < 0.95 * middle, "{edge} at the edge, {middle} in the middle");
}
