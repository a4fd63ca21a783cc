//! `kelir animate`: a scene's timeline as frames for a study, or as one file for sharing.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use kelir_render::film::{Film, Format, Run};
use kelir_render::{Stats, encode, exposure, file, renderer};
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
    /// Folder to write (frame-0000.png, frame-0001.png, … and manifest.json, for studies), or FILE.apng (lossless), or FILE.mp4 (H.264, for sharing).
    #[arg(short, long)]
    output: PathBuf,
}

/// Endings of films that kelir does not write: a folder of such a name is a mistake.
const OTHER_FILMS: [&str; 9] = ["gif", "png", "webp", "webm", "mov", "mkv", "avi", "m4v", "jpg"];

/// Where the frames go.
enum Target {
    Folder { names: Vec<String> },
    Film(Film),
}

impl Target {
    fn new(output: &Path, run: Run) -> Result<Self> {
        let ending = output.extension().and_then(|end| end.to_str()).unwrap_or_default().to_ascii_lowercase();
        let film = |format| Ok(Self::Film(Film::new(format, run).map_err(render_error)?));
        match ending.as_str() {
            "mp4" => film(Format::Mp4),
            "apng" => film(Format::Apng),
            other if OTHER_FILMS.contains(&other) => Err(bad_input(format!(
                "output = {}: a folder, or a name that ends in .apng or .mp4",
                output.display()
            ))),
            _ => Ok(Self::Folder { names: Vec::new() }),
        }
    }

    /// Adds a frame; `repeated` says that it equals the one before.
    fn frame(&mut self, output: &Path, codes: &[u32], size: [usize; 2], repeated: bool) -> Result<()> {
        match self {
            Self::Film(film) => film.frame(codes).map_err(render_error)?,
            Self::Folder { names } => {
                let name = match names.last() {
                    Some(last) if repeated => last.clone(),
                    _ => {
                        let name = format!("frame-{:04}.png", names.len());
                        file::write_atomic(
                            &output.join(&name),
                            &encode::png(codes, size).map_err(render_error)?,
                        )?;
                        name
                    }
                };
                names.push(name);
            }
        }
        Ok(())
    }
}

/// Runs the command.
pub fn run(args: Args) -> Result<()> {
    let mut scene = args.drawing.load()?;
    let Some(timeline) = scene.timeline() else {
        return Err(bad_input(format!("{}: timeline: an animation needs one", args.drawing.scene.display())));
    };
    let view = args.drawing.view(&scene.still());
    let run =
        Run { size: view.size, fps: timeline.fps, frames: timeline.frame_count(), repeat: timeline.repeat };
    let times: Vec<f64> = (0..run.frames).map(|frame| timeline.frame_time_s(frame)).collect();
    let mut target = Target::new(&args.output, run)?;
    let mut renderer = renderer(&args.drawing.technique(), args.drawing.backend).map_err(render_error)?;
    // One exposure for the whole timeline.
    let white = exposure::of_scene(&scene, &view, true);

    let begun = Instant::now();
    let bar = progress::bar(run.frames as u64, "frames");
    let mut codes = vec![0; view.size[0] * view.size[1]];
    let mut stats: Vec<Stats> = Vec::new();
    let mut repeated = 0;
    let mut last: Option<kelir_scene::Theatre> = None;
    for time_s in times {
        let theatre = scene.theatre_at(time_s);
        let same = last.as_ref().is_some_and(|last| last.same_staging(&theatre));
        if same {
            repeated += 1;
        } else {
            stats.push(renderer.display(&theatre, &view, white, &mut codes).map_err(render_error)?);
        }
        target.frame(&args.output, &codes, view.size, same)?;
        last = Some(theatre);
        bar.inc(1);
    }
    bar.finish_and_clear();
    match target {
        Target::Film(film) => file::write_atomic(&args.output, &film.finish().map_err(render_error)?)?,
        Target::Folder { names } => {
            let manifest = json!({
                "fps": run.fps, "loop": run.repeat, "width": view.size[0], "height": view.size[1],
                "white": white, "frames": names,
            });
            // The manifest comes last: a folder that has one is whole.
            file::write_atomic(
                &args.output.join("manifest.json"),
                serde_json::to_string_pretty(&manifest)?.as_bytes(),
            )?;
        }
    }
    if let Some(StatsFormat::Json) = args.drawing.stats {
        let report = Report {
            adapter: renderer.adapter(),
            total_ms: begun.elapsed().as_secs_f64() * 1e3,
            frames_repeated: repeated,
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
    /// Frames equal to the one before, not drawn again.
    frames_repeated: usize,
    frames: &'a [Stats],
}
