//! Frames a second of PA: `cargo run --release -p kelir-render --example frames -- SCENE.toml [FRAMES] [WIDTH] [slid|posed|lamp|all|every] [cpu|gpu]`, or `-- table`.
#![allow(clippy::print_stdout, clippy::expect_used, reason = "it is run for what it prints, by hand")]

use kelir_render::bench::{Case, frames, table};
use kelir_render::{Backend, Pixel, Technique, View, pa};
use kelir_scene::Scene;

fn main() {
    let mut args = std::env::args().skip(1).peekable();
    if args.peek().is_some_and(|a| a == "table") {
        let [build, copy] = table(4096, 40);
        return println!(
            "4096² table {build:.2} ms, widening copy {copy:.2} ms: {:.2} × its speed",
            copy / build
        );
    }
    let path = args.next().unwrap_or_else(|| "stimuli/scenes/benchmark.toml".into());
    let count = args.next().map_or(100, |n| n.parse().expect("a number of frames"));
    let width = args.next().map_or(1920, |n| n.parse().expect("a width in pixels"));
    let scene = Scene::from_path(std::path::Path::new(&path)).expect("a valid scene");
    let screen = scene.still().screen;
    let height = (width as f64 * screen.height_m / screen.width_m).round() as usize;
    let view = View { size: [width, height], pixel: Pixel::Area, skip: true };
    let technique = Technique::Pa(pa::Knobs::default());
    let cases = match args.next().as_deref() {
        Some("slid") => vec![Case::Slid],
        Some("posed") => vec![Case::Posed],
        Some("lamp") => vec![Case::LampMoved],
        Some("all") => vec![Case::NothingSkipped],
        _ => vec![Case::Slid, Case::Posed, Case::LampMoved, Case::NothingSkipped],
    };
    let backend = args.next().map_or(Backend::Cpu, |b| b.parse().expect("cpu or gpu"));
    let report = frames(&scene, &technique, backend, &view, count, &cases).expect("drawn");
    println!("{}x{} {}", report.size[0], report.size[1], report.adapter);
    for case in report.cases {
        println!(
            "{:?}: {:.1} fps, least {:.3} ms, median {:.3} ms, p99 {:.3} ms, floor {:.3} ms, ratio {:.1}",
            case.case, case.fps, case.least_ms, case.median_ms, case.p99_ms, case.floor_ms, case.ratio
        );
        println!("  {:?}\n  {:?}", case.steps_ms, case.counts);
    }
}
