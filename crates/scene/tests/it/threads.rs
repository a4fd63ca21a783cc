//! Threads thinner than a texel: what they cover is an area, however thin, at any angle and wherever they lie.

use std::f64::consts::PI;

use crate::support::{SCENE, files, parse};
use kelir_scene::{Mask, Scene};

/// A drawing of 256 units on as many texels.
fn read(drawn: &str, lines: &str) -> Scene {
    let mut files = files();
    let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 256 256\">{drawn}</svg>");
    files.insert("puppets/p.svg".into(), svg.into_bytes());
    let scene =
        SCENE.replace("figure.toml", "p.svg").replace("texels = 128", &format!("texels = 256\n{lines}"));
    parse(&scene, &files).unwrap_or_else(|e| panic!("{e}: {drawn}"))
}

/// What a mask covers, in texels.
fn covered(mask: &Mask) -> f64 {
    let all = (0..mask.height).flat_map(|y| (0..mask.width).map(move |x| (x, y)));
    all.map(|(x, y)| 1.0 - mask.transmittance(0, x, y)).sum()
}

#[track_caller]
fn covers(drawn: &str, area: f64) {
    let scene = read(drawn, "");
    let found = covered(&scene.still().planes[0].mask);
    assert!((found / area - 1.0).abs() < 0.01, "{found}, not {area}: {drawn}");
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
}

/// Multiples of the golden ratio: angles and offsets like dice, the same in every run.
fn dice(k: usize) -> f64 {
    (k as f64 * 0.618_033_988_749_895).fract()
}

const WIDTHS: [f64; 8] = [0.02, 0.05, 0.1, 0.25, 0.5, 0.9, 1.3, 2.0];

#[test]
fn lines_cover_their_area() {
    for (k, width) in WIDTHS.into_iter().cycle().enumerate().take(40) {
        // Upright, level and slanted, in turn.
        let angle = [0.0, 90.0, 180.0 * dice(k)][k % 3];
        let [x, y] = [dice(3 * k + 1), dice(5 * k + 2)].map(|d| 128.0 + d);
        let place = format!("transform=\"translate({x} {y}) rotate({angle})\"");
        covers(
            &format!("<path {place} stroke=\"#000\" stroke-width=\"{width}\" d=\"M-90 0h180\"/>"),
            180.0 * width,
        );
        covers(&format!("<rect {place} x=\"-90\" width=\"180\" height=\"{width}\"/>"), 180.0 * width);
    }
}

#[test]
fn curves_cover_their_area() {
    for (k, width) in WIDTHS.into_iter().enumerate() {
        let (radius, x) = (20.0 + 90.0 * dice(k), 128.0 + dice(k + 9));
        let pen = format!("fill=\"none\" stroke=\"#000\" stroke-width=\"{width}\"");
        covers(&format!("<circle cx=\"{x}\" cy=\"127.3\" r=\"{radius}\" {pen}/>"), 2.0 * PI * radius * width);
        // A quarter of a circle with round ends, in small units.
        let ends = "stroke-linecap=\"round\"";
        let small = format!(
            "<g transform=\"scale(100)\"><path d=\"M.3 1.2A.9 .9 0 0 1 1.2 .3\" {ends} {}/></g>",
            pen.replace(&width.to_string(), &(width / 100.0).to_string())
        );
        covers(&small, 0.5 * PI * 90.0 * width + 0.25 * PI * width * width);
    }
}

/// What is drawn twice covers no more than once, and a crossing is counted once: within a path, as fill and stroke, and as shapes of their own.
#[test]
fn what_overlaps_counts_once() {
    for width in [0.02, 0.1, 0.5, 1.3] {
        let pen = format!("stroke=\"#000\" stroke-width=\"{width}\"");
        let line = format!("<path {pen} d=\"M30.3 20.2L220.1 190.7\"/>");
        let area = 189.8f64.hypot(170.5) * width;
        covers(&line.repeat(3), area);
        covers(&format!("<path {pen} d=\"M30.3 20.2L220.1 190.7M220.1 190.7L30.3 20.2\"/>"), area);
        covers(
            &format!("<rect {pen} x=\"40.37\" y=\"30.2\" width=\"{width}\" height=\"100\"/>"),
            2.0 * width * (100.0 + width),
        );
        let crossing = |k: usize| 1.7 * k as f64 + 20.37;
        let grid: String = (0..60).map(|k| format!("M{0} 10.2V200.2M10.2 {0}H200.2", crossing(k))).collect();
        let of_grid = 2.0 * 60.0 * 190.0 * width - 3600.0 * width * width;
        covers(&format!("<path {pen} d=\"{grid}\"/>"), of_grid);
        covers(
            &format!("<path {pen} d=\"{}\"/>", grid.replace('M', &format!("\"/><path {pen} d=\"M"))),
            of_grid,
        );
    }
}

/// Two shapes that share a slanted edge let nothing through between them; each texel is what is drawn of it.
#[test]
fn texels_are_shares() {
    let halves = "<path d=\"M10 10L90 200H10z\"/><path fill=\"#00f\" d=\"M10 10L90 200H95V10z\"/>";
    let mask = read(halves, "").still().planes[0].mask.clone();
    let within = (11..94).flat_map(|x| (11..199).map(move |y| (x, y)));
    assert!(within.clone().all(|(x, y)| mask.transmittance(0, x, y) == 0.0));
    // A disk's edge, against its area within each texel, summed over 64 × 64 points of it.
    let mask =
        read("<circle cx=\"50.3\" cy=\"60.7\" r=\"30.2\"/>", "bits = 16").still().planes[0].mask.clone();
    let points = || (0..64).map(|k| (f64::from(k) + 0.5) / 64.0);
    for (x, y) in (15..90).flat_map(|x| (25..95).map(move |y| (x, y))) {
        let inside = |u: f64, v: f64| (x as f64 + u - 50.3).hypot(y as f64 + v - 60.7) < 30.2;
        let share =
            points().flat_map(|u| points().map(move |v| (u, v))).filter(|(u, v)| inside(*u, *v)).count();
        let opacity = 1.0 - mask.transmittance(0, x, y);
        assert!((opacity - share as f64 / 4096.0).abs() < 0.01, "{opacity} at {x}, {y}");
    }
}

/// Threads that 8 bits can't hold get 16; whoever asked for 8 is told.
#[test]
fn codes_hold_what_is_thin() {
    let threads: String = (0..120)
        .map(|k| format!("<rect x=\"{}\" width=\"0.05\" height=\"256\"/>", 2.0 * k as f64 + 0.25))
        .collect();
    covers(&threads, 6.0 * 256.0);
    let told = read(&threads, "bits = 8");
    assert!(told.warnings()[0].to_string().contains("bits = 16"), "{:?}", told.warnings());
    assert!(read("<rect width=\"99.5\" height=\"256\"/>", "bits = 8").warnings().is_empty());
}
