//! FLIP: the error that a viewer sees when two display images alternate (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström &
//! Fairchild 2020). A second opinion, never the accuracy claim.

use crate::filter::{Plane, separable};

/// FLIP's default viewing condition: a 0.7 m wide 3840-pixel display at 0.7 m, in pixels per degree.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * (3840.0 / 0.7) * std::f64::consts::PI / 180.0;

/// FLIP's error map in [0, 1] of two images of sRGB values in [0, 1], row-major RGB triples; 0 where they look the same.
///
/// `pixels_per_degree` > 0 is the viewing condition. Panics when the lengths are not `width * height`.
pub fn flip(
    reference: &[[f64; 3]],
    test: &[[f64; 3]],
    width: usize,
    height: usize,
    pixels_per_degree: f64,
) -> Vec<f64> {
    assert_eq!(reference.len(), width * height);
    assert_eq!(test.len(), width * height);
    let (reference, test) = (opponent(reference, width, height), opponent(test, width, height));
    let colour = colour_difference(&reference, &test, pixels_per_degree);
    let feature = feature_difference(&reference[0], &test[0], pixels_per_degree);
    colour.iter().zip(&feature).map(|(c, f)| c.powf(1.0 - f)).collect()
}

/// Mean of [`flip`]'s map.
pub fn mean_flip(reference: &[[f64; 3]], test: &[[f64; 3]], width: usize, height: usize) -> f64 {
    let map = flip(reference, test, width, height, PIXELS_PER_DEGREE);
    map.iter().sum::<f64>() / map.len() as f64
}

const XYZ_OF_RGB: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];

fn multiply(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|row| m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2])
}

fn white() -> [f64; 3] {
    multiply(&XYZ_OF_RGB, [1.0; 3])
}

fn linear(code: f64) -> f64 {
    if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

fn xyz_over_white(rgb: [f64; 3]) -> [f64; 3] {
    let (xyz, white) = (multiply(&XYZ_OF_RGB, rgb), white());
    [xyz[0] / white[0], xyz[1] / white[1], xyz[2] / white[2]]
}

/// The planes Y, Cx, Cz of the linearised YCxCz space.
fn opponent(srgb: &[[f64; 3]], width: usize, height: usize) -> [Plane; 3] {
    let mut planes = [0, 1, 2].map(|_| Plane { width, height, values: Vec::with_capacity(srgb.len()) });
    for pixel in srgb {
        let [x, y, z] = xyz_over_white(pixel.map(linear));
        for (plane, value) in planes.iter_mut().zip([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]) {
            plane.values.push(value);
        }
    }
    planes
}

fn rgb_of_opponent([y, cx, cz]: [f64; 3]) -> [f64; 3] {
    let (y, white) = ((y + 16.0) / 116.0, white());
    let xyz = [(y + cx / 500.0) * white[0], y * white[1], (y - cz / 200.0) * white[2]];
    multiply(&inverse(&XYZ_OF_RGB), xyz)
}

fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * cofactor(0, c)).sum();
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| cofactor(c, r) / determinant))
}

/// CIELab with the Hunt effect: colour differences matter less in the dark.
fn hunt_lab(rgb: [f64; 3]) -> [f64; 3] {
    const DELTA: f64 = 6.0 / 29.0;
    let f = |t: f64| if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let [x, y, z] = xyz_over_white(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// The colour pipeline: contrast-sensitivity filters, then the HyAB distance squeezed into [0, 1].
fn colour_difference(reference: &[Plane; 3], test: &[Plane; 3], ppd: f64) -> Vec<f64> {
    const EXPONENT: f64 = 0.7;
    const KNEE: (f64, f64) = (0.4, 0.95);
    let seen = |image: &[Plane; 3]| {
        let [y, cx, cz] = [0, 1, 2].map(|channel| see(&image[channel], channel, ppd));
        let pixels = y.iter().zip(&cx).zip(&cz);
        pixels
            .map(|((y, cx), cz)| hunt_lab(rgb_of_opponent([*y, *cx, *cz]).map(|v| v.clamp(0.0, 1.0))))
            .collect::<Vec<_>>()
    };
    let largest = hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])).powf(EXPONENT);
    let knee = KNEE.0 * largest;
    let squeeze = |distance: f64| {
        let error = distance.powf(EXPONENT);
        if error < knee {
            KNEE.1 / knee * error
        } else {
            KNEE.1 + (error - knee) / (largest - knee) * (1.0 - KNEE.1)
        }
    };
    seen(reference).iter().zip(&seen(test)).map(|(r, t)| squeeze(hyab(*r, *t))).collect()
}

/// One opponent channel through its contrast-sensitivity function: a sum of two Gaussians (the paper's table 1).
fn see(plane: &Plane, channel: usize, ppd: f64) -> Vec<f64> {
    use std::f64::consts::PI;
    // (weight, b in degrees²) twice; the last b, 0.04, also sets the radius of every channel.
    const TERMS: [[(f64, f64); 2]; 3] =
        [[(1.0, 0.0047), (0.0, 1e-5)], [(1.0, 0.0053), (0.0, 1e-5)], [(34.1, 0.04), (13.5, 0.025)]];
    let radius = (3.0 * (0.04 / (2.0 * PI * PI)).sqrt() * ppd).ceil() as i32;
    let mut sum = vec![0.0; plane.values.len()];
    let mut total = 0.0;
    for (a, b) in TERMS[channel].into_iter().filter(|(a, _)| *a > 0.0) {
        let taps: Vec<f64> =
            (-radius..=radius).map(|x| (-PI * PI * (f64::from(x) / ppd).powi(2) / b).exp()).collect();
        let weight = a * (PI / b).sqrt();
        total += weight * taps.iter().sum::<f64>().powi(2);
        for (sum, value) in sum.iter_mut().zip(separable(plane, &taps, &taps).values) {
            *sum += weight * value;
        }
    }
    sum.iter().map(|value| value / total).collect()
}

/// The feature pipeline: where edges and points appear or vanish.
fn feature_difference(reference: &Plane, test: &Plane, ppd: f64) -> Vec<f64> {
    const EXPONENT: f64 = 0.5;
    let sigma = 0.5 * 0.082 * ppd;
    let radius = (3.0 * sigma).ceil() as i32;
    let at = |f: &dyn Fn(f64) -> f64| (-radius..=radius).map(|x| f(f64::from(x))).collect::<Vec<f64>>();
    let gauss = |x: f64| (-0.5 * (x / sigma).powi(2)).exp();
    let smooth = at(&gauss);
    let edge = at(&|x| -x * gauss(x));
    let point = at(&|x| ((x / sigma).powi(2) - 1.0) * gauss(x));
    // Positive weights of the two-dimensional kernel sum to 1, negative ones to −1.
    let (area, one_sided) = (smooth.iter().sum::<f64>(), |taps: &[f64], sign: f64| -> f64 {
        taps.iter().map(|tap| (sign * tap).max(0.0)).sum()
    });
    let balance = |taps: &[f64]| -> Vec<f64> {
        let (plus, minus) = (one_sided(taps, 1.0) * area, one_sided(taps, -1.0) * area);
        taps.iter().map(|tap| if *tap > 0.0 { tap / plus } else { tap / minus }).collect()
    };
    let (edge, point) = (balance(&edge), balance(&point));
    let strength = |image: &Plane, taps: &[f64]| -> Vec<f64> {
        let luma = Plane { values: image.values.iter().map(|y| (y + 16.0) / 116.0).collect(), ..*image };
        let (across, along) = (separable(&luma, taps, &smooth), separable(&luma, &smooth, taps));
        across.values.iter().zip(&along.values).map(|(x, y)| x.hypot(*y)).collect()
    };
    let difference = |taps: &[f64]| -> Vec<f64> {
        strength(reference, taps).iter().zip(&strength(test, taps)).map(|(r, t)| (r - t).abs()).collect()
    };
    let (edges, points) = (difference(&edge), difference(&point));
    edges.iter().zip(&points).map(|(e, p)| (e.max(*p) / std::f64::consts::SQRT_2).powf(EXPONENT)).collect()
}
