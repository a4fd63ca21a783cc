//! `kelir animate`: the frames of a scene's timeline.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use kelir_render::{Stats, encode, file, renderer, white};
use serde::Serialize;
use serde_json::json;

use super::drawing::{Drawing, StatsFormat, render_error};
use crate::output::print;
use crate::{bad_input, progress};

/// Arguments of `kelir animate`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    drawing: Drawing,
    /// Folder to write: frame-0000.png, frame-0001.png, … and manifest.json.
    #[arg(short, long)]
    output: PathBuf,
}

/// Runs the command.
pub fn run(args: Args) -> Result<()> {
    let mut scene = args.drawing.load()?;
    let Some(timeline) = scene.timeline() else {
        return Err(bad_input(format!("{}: timeline: an animation needs one", args.drawing.scene.display())));
    };
    let (fps, looped) = (timeline.fps, timeline.repeat);
    let times: Vec<f64> = (0..timeline.frame_count()).map(|frame| timeline.frame_time_s(frame)).collect();
    let view = args.drawing.view(&scene.still());
    let mut renderer = renderer(&args.drawing.technique(), args.drawing.backend).map_err(render_error)?;
    let theatres: Vec<_> = times.iter().map(|time_s| scene.theatre_at(*time_s)).collect();
    // One exposure for the whole timeline.
    let white = white(&theatres, &view);

    let begun = Instant::now();
    let bar = progress::bar(theatres.len() as u64, "frames");
    let mut pixels = vec![0; view.size[0] * view.size[1]];
    let (mut names, mut stats) = (Vec::new(), Vec::new());
    for (index, theatre) in theatres.iter().enumerate() {
        stats.push(renderer.display(theatre, &view, white, &mut pixels).map_err(render_error)?);
        let name = format!("frame-{index:04}.png");
        file::write_atomic(
            &args.output.join(&name),
            &encode::png(&pixels, view.size).map_err(render_error)?,
        )?;
        names.push(name);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let manifest = json!({
        "fps": fps, "loop": looped, "width": view.size[0], "height": view.size[1], "white": white, "frames": names,
    });
    // The manifest comes last: a folder that has one is whole.
    file::write_atomic(
        &args.output.join("manifest.json"),
        serde_json::to_string_pretty(&manifest)?.as_bytes(),
    )?;
    if let Some(StatsFormat::Json) = args.drawing.stats {
        let report = Report {
            adapter: renderer.adapter(),
            total_ms: begun.elapsed().as_secs_f64() * 1e3,
            frames: &stats,
        };
        print(&serde_json::to_string_pretty(&report)?)?;
    }
    Ok(())
}

/// What `--stats json` prints.
#[derive(Serialize)]
struct Report<'a> {
    adapter: String,
    total_ms: f64,
    frames: &'a [Stats],
}
