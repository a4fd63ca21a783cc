//! An amphora with two handles, fluted; 0.4 m high.

use glam::DVec3;

use super::field::{Solid, at, cone, cosine_of_multiple, noise, step};

/// Radii of the body at heights, metres: foot, belly, shoulder, neck, lip.
const PROFILE: [(f64, f64); 15] = [
    (0.000, 0.052),
    (0.012, 0.054),
    (0.022, 0.040),
    (0.034, 0.034),
    (0.060, 0.056),
    (0.110, 0.093),
    (0.165, 0.117),
    (0.215, 0.118),
    (0.255, 0.096),
    (0.285, 0.060),
    (0.310, 0.043),
    (0.350, 0.041),
    (0.372, 0.047),
    (0.386, 0.057),
    (0.400, 0.060),
];
/// The mouth: how deep it is, and its radius.
const MOUTH: (f64, f64) = (0.330, 0.027);

/// Pieces that a handle's curve has between two of its points.
const STEPS: usize = 4;

fn radius(y: f64) -> f64 {
    let last = PROFILE.len() - 1;
    let k = PROFILE.iter().rposition(|(height, _)| *height <= y).unwrap_or(0).min(last - 1);
    let ((y0, r0), (y1, r1)) = (PROFILE[k], PROFILE[k + 1]);
    // Hermite, its slopes those between the neighbours.
    let slope = |i: usize| {
        let (low, high) = (PROFILE[i.saturating_sub(1)], PROFILE[(i + 1).min(last)]);
        (high.1 - low.1) / (high.0 - low.0)
    };
    let h = y1 - y0;
    let t = ((y - y0) / h).clamp(0.0, 1.0);
    let (a, b) = (t * t * (3.0 - 2.0 * t), h * t * (1.0 - t));
    r0 + (r1 - r0) * a + b * ((1.0 - t) * slope(k) - t * slope(k + 1))
}

fn soft_max(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.max(b) + h * h * h * k / 6.0
}

fn handles() -> Solid {
    let bow = [
        at(0.020, 0.336, 0.0),
        at(0.038, 0.346, 0.0),
        at(0.078, 0.358, 0.0),
        at(0.111, 0.336, 0.0),
        at(0.121, 0.294, 0.0),
        at(0.109, 0.252, 0.0),
        at(0.094, 0.232, 0.0),
        at(0.070, 0.210, 0.0),
    ];
    // Catmull and Rom's curve through all but the ends.
    let along = |k: usize, t: f64| {
        let [a, b, c, d] = [bow[k], bow[k + 1], bow[k + 2], bow[k + 3]];
        let (linear, square) = ((c - a) * t, (a * 2.0 - b * 5.0 + c * 4.0 - d) * (t * t));
        (b * 2.0 + linear + square + (b * 3.0 - a - c * 3.0 + d) * (t * t * t)) * 0.5
    };
    let curve: Vec<DVec3> = (0..=5 * STEPS)
        .map(|k| along((k / STEPS).min(4), (k - STEPS * (k / STEPS).min(4)) as f64 / STEPS as f64))
        .collect();
    let mut handles = Solid::default();
    for ends in curve.windows(2) {
        let flip = |p: DVec3| at(-p.x, p.y, p.z);
        handles = handles.add(cone(ends[0], 0.0105, ends[1], 0.0105), 0.0005);
        handles = handles.add(cone(flip(ends[0]), 0.0105, flip(ends[1]), 0.0105), 0.0005);
    }
    handles
}

/// Its field.
pub(super) fn field() -> impl Fn(DVec3) -> f64 + Sync {
    let handles = handles();
    move |p| {
        let r = (p.x * p.x + p.z * p.z).sqrt();
        // Steep walls make it about a distance.
        let wall = (r - radius(p.y)) * 0.85;
        let body = soft_max(soft_max(wall, p.y - 0.392, 0.016), -p.y, 0.010);
        let bow = handles.at(p);
        let h = (0.014 - (body - bow).abs()).max(0.0) / 0.014;
        let whole = body.min(bow) - h * h * h * 0.014 / 6.0;
        let mouth = soft_max(r - MOUTH.1 - 0.25 * step(0.36, 0.40, p.y) * 0.06, MOUTH.0 - p.y, 0.02);
        soft_max(whole, -mouth, 0.012)
    }
}

/// Flutes below, a band of leaves on the shoulder, and the marks of the wheel; metres.
pub(super) fn relief(p: DVec3) -> f64 {
    let r = (p.x * p.x + p.z * p.z).sqrt().max(1e-6);
    let cosine = p.x / r;
    // Outside and on the body alone.
    let outside = step(0.012, 0.004, (r - radius(p.y)).abs());
    let flutes = cosine_of_multiple(32, cosine) * step(0.055, 0.085, p.y) * step(0.178, 0.165, p.y);
    let rise = (p.y - 0.200) / 0.034;
    let leaf = cosine_of_multiple(20, cosine) * (1.0 - 0.5 * rise) - rise * rise * 1.6 + 0.25;
    let band = step(-0.45, 0.55, leaf) * step(0.183, 0.188, p.y) * step(0.245, 0.235, p.y);
    let rim = |y: f64| step(0.0065, 0.0010, (p.y - y).abs());
    let rims = rim(0.1815) + rim(0.2480);
    let clay = 0.00022 * noise(21, p * 160.0);
    outside * (0.0018 * flutes + 0.0022 * band + 0.0018 * rims) + clay
}
