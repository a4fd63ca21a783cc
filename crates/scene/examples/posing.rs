//! How long a posed puppet takes to rasterise anew, beside a copy of the same grid.
//!
//! `cargo run --release -p kelir-scene --example posing [SCENE.toml]`: without a scene, a test figure of eight parts on
//! 1024² texels whose arms move, and the same figure turned as a whole.
#![allow(clippy::print_stdout, clippy::expect_used, reason = "it is run for what it prints, by hand")]

use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use kelir_scene::{Mask, Masks, Scene, Texels};

/// Frames per measurement: more than a puppet remembers, so that every one is drawn.
const FRAMES: usize = 241;

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    match std::env::args().nth(1) {
        Some(path) => measure(&path, Scene::from_path(Path::new(&path)).expect("a valid scene")),
        None => {
            for (name, target, most) in
                [("two arms posed", "pose.arm", 90.0), ("turned as a whole", "rotate_deg", 45.0)]
            {
                for translucent in [false, true] {
                    let colour = if translucent { "three channels" } else { "grey" };
                    measure(&format!("{name}, {colour}"), figure(target, most, translucent));
                }
            }
        }
    }
}

/// Prints the least, the median and the 95th percentile of `theatre_at`, and the time to copy as many bytes.
fn measure(name: &str, scene: Scene) {
    let Some(timeline) = scene.timeline().cloned() else { return println!("{name}: has no timeline") };
    let (mut times, mut masks) = (Vec::new(), Masks::default());
    let mut texels = 0;
    let mut copies = Vec::new();
    for frame in 0..FRAMES {
        let at = timeline.seconds * frame as f64 / FRAMES as f64;
        let start = Instant::now();
        let theatre = black_box(scene.theatre_at(at, &mut masks));
        times.push(start.elapsed());
        let mask = &theatre.planes[0].mask;
        texels = mask.width * mask.height;
        copies.push(copy(mask));
    }
    let [least, median, high] = quantiles(&mut times);
    let [_, floor, _] = quantiles(&mut copies);
    let ratio = median.as_secs_f64() / floor.as_secs_f64();
    println!(
        "{name}: median {median:.3?} (least {least:.3?}, 95% {high:.3?}), {ratio:.1} × a copy ({floor:.3?}) of {texels} texels"
    );
}

/// Time to copy a mask's texels into warm memory.
fn copy(mask: &Mask) -> Duration {
    let Texels::U8(codes) = &mask.texels else { return Duration::ZERO };
    let mut other = codes.clone();
    let start = Instant::now();
    other.copy_from_slice(black_box(codes));
    black_box(&other);
    start.elapsed()
}

fn quantiles(times: &mut [Duration]) -> [Duration; 3] {
    times.sort();
    [times[0], times[times.len() / 2], times[times.len() * 95 / 100]]
}

fn figure(target: &str, most: f64, translucent: bool) -> Scene {
    let mut svg = String::from(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1024 1024">"#);
    let mut manifest = String::from("image = \"figure.svg\"\n");
    // A large body, and two arms of three links each, with holes punched in a row.
    let mut part = |id: &str, parent: &str, pivot: [f64; 2], [x, y, w, h]: [f64; 4]| {
        svg += &format!(
            "<g id=\"{id}\"><path fill=\"#8a3010\" fill-rule=\"evenodd\" d=\"M{x} {y}h{w}v{h}h{}z",
            -w
        );
        for hole in 0..(w.max(h) / 24.0) as usize {
            let (dx, dy) = if w > h {
                (12.0 + 24.0 * hole as f64, h / 2.0)
            } else {
                (w / 2.0, 12.0 + 24.0 * hole as f64)
            };
            svg += &format!("M{} {}h12v12h-12z", x + dx - 6.0, y + dy - 6.0);
        }
        svg += "\"/></g>";
        let parent = if parent.is_empty() { String::new() } else { format!("parent = \"{parent}\"\n") };
        manifest += &format!("[[parts]]\nid = \"{id}\"\n{parent}pivot = [{}, {}]\n", pivot[0], pivot[1]);
    };
    part("body", "", [512.0, 512.0], [360.0, 120.0, 304.0, 800.0]);
    part("head", "body", [512.0, 130.0], [430.0, 10.0, 164.0, 130.0]);
    for (side, x) in [("left", 380.0), ("right", 640.0)] {
        let arm = if side == "left" { "arm".to_owned() } else { "arm_right".to_owned() };
        part(&arm, "body", [x, 260.0], [x - 40.0, 230.0, 80.0, 300.0]);
        part(&format!("fore_{side}"), &arm, [x, 510.0], [x - 30.0, 490.0, 60.0, 260.0]);
        part(&format!("hand_{side}"), &format!("fore_{side}"), [x, 740.0], [x - 30.0, 730.0, 60.0, 90.0]);
    }
    svg += "</svg>";
    let tracks = if target.starts_with("pose") {
        vec![target.to_owned(), format!("{target}_right")]
    } else {
        vec![target.to_owned()]
    };
    let tracks: String = tracks
        .iter()
        .map(|t| {
            format!(
                "[[timeline.tracks]]\ntarget = \"puppets[0].{t}\"\nkeys = [{{ t = 0.0, value = 1.0 }}, {{ t = 10.0, value = {most} }}]\n"
            )
        })
        .collect();
    let scene = format!(
        "[screen]\nwidth_m = 1.6\nheight_m = 0.9\nalbedo = 0.8\n[lamp]\nposition_m = [0.0, 0.0, -1.5]\n\
         [[lamp.emitters]]\nname = \"inner\"\nshape = \"rectangle\"\nsize_m = [0.02, 0.02]\nradiance = 1.0\n\
         [[puppets]]\nimage = \"figure.toml\"\nheight_m = 0.6\nposition_m = [0.0, 0.0, -0.2]\ntranslucent = {translucent}\n\
         [timeline]\nfps = 24\nseconds = 10.0\n{tracks}"
    );
    let files = BTreeMap::from([
        ("figure.svg".to_owned(), svg.into_bytes()),
        ("figure.toml".to_owned(), manifest.into_bytes()),
    ]);
    Scene::parse("figure.toml.scene", &scene, &files).expect("the test figure is valid")
}
