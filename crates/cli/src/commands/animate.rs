//! `kelir animate`: a scene's timeline as frames for a study, or as one file for sharing.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use kelir_render::exposure::Rule;
use kelir_render::film::{Film, Format, Run};
use kelir_render::folder::Folder;
use kelir_render::job::{self, Output};
use kelir_render::subject::Staged;
use kelir_render::{Meter, Stats, file};
use kelir_scene::AnyScene;
use serde::Serialize;
use serde_json::json;

use super::drawing::{Drawing, ExposureName, Told, render_error};
use crate::{bad_input, progress};

/// Arguments of `kelir animate`.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    drawing: Drawing,
    #[command(flatten)]
    told: Told,
    /// What is shown as white.
    #[arg(long, value_enum, default_value = "timeline")]
    exposure: ExposureName,
    /// Folder to write (frame-0000.png, frame-0001.png, … and manifest.json, for studies), or FILE.apng (lossless), or FILE.mp4 (H.264, for sharing).
    #[arg(short, long)]
    output: PathBuf,
}

/// Endings of films that kelir does not write: a folder of such a name is a mistake.
const OTHER_FILMS: [&str; 9] = ["gif", "png", "webp", "webm", "mov", "mkv", "avi", "m4v", "jpg"];

/// Where the frames go.
enum Target {
    Folder { folder: Folder, names: Vec<String> },
    Film(Film),
}

impl Target {
    fn new(output: &Path, run: Run) -> Result<Self> {
        let ending = output.extension().and_then(|end| end.to_str()).unwrap_or_default().to_ascii_lowercase();
        let film = |format| {
            let film = Film::new(format, run).map_err(render_error)?;
            file::try_writing(output)?;
            Ok(Self::Film(film))
        };
        match ending.as_str() {
            "mp4" => film(Format::Mp4),
            "apng" => film(Format::Apng),
            other if OTHER_FILMS.contains(&other) => Err(bad_input(format!(
                "output = {}: a folder, or a name that ends in .apng or .mp4",
                output.display()
            ))),
            _ if output.as_os_str().is_empty() || output.as_os_str() == "-" => Err(bad_input(format!(
                "output = {:?}: name a folder, FILE.apng or FILE.mp4; nothing is written to standard output",
                output.display().to_string()
            ))),
            _ => Ok(Self::Folder { folder: Folder::begin(output)?, names: Vec::new() }),
        }
    }

    /// Adds the frame that was drawn last; `repeated` says that it equals the one before.
    fn frame<S: Staged>(&mut self, drawing: &job::Drawing<'_, S>, repeated: bool) -> Result<()> {
        match self {
            Self::Film(film) => film.frame(drawing.codes()).map_err(render_error)?,
            Self::Folder { folder, names } => {
                let name = match names.last() {
                    Some(last) if repeated => last.clone(),
                    _ => {
                        let name = format!("frame-{:04}.png", names.len());
                        let file = drawing.file().map_err(render_error)?;
                        folder.add(&name, &file.bytes)?;
                        name
                    }
                };
                names.push(name);
            }
        }
        Ok(())
    }
}

/// Whether a file of an older run's folder was a frame.
fn is_frame(name: &str) -> bool {
    let number = name.strip_prefix("frame-").and_then(|rest| rest.strip_suffix(".png"));
    number.is_some_and(|number| number.len() >= 4 && number.bytes().all(|digit| digit.is_ascii_digit()))
}

/// Runs the command.
pub(crate) fn run(args: Args) -> Result<()> {
    match args.drawing.scene()? {
        AnyScene::Theatre(scene) => animate(&args, scene),
        AnyScene::Stage(scene) => animate(&args, scene),
    }
}

fn animate<S: Staged>(args: &Args, scene: S) -> Result<()> {
    let mut job = args.drawing.job(scene, Output::Animation, args.exposure, None)?;
    let Some(timeline) = job.scene.timeline() else {
        return Err(bad_input(format!("{}: timeline: an animation needs one", args.drawing.scene.display())));
    };
    let (size, exposure) = (job.view.size, job.exposure);
    let run = Run { size, fps: timeline.fps, frames: timeline.frame_count(), repeat: timeline.repeat };
    let mut target = Target::new(&args.output, run)?;

    let begun = Instant::now();
    let mut drawing = progress::watch(&Meter::default(), "exposure", || job::Drawing::open(&mut job))
        .map_err(render_error)?;
    let white = drawing.white();
    let bar = progress::bar(run.frames as u64, "frames");
    let mut stats: Vec<Stats> = Vec::new();
    for frame in 0..run.frames {
        let drawn = drawing.frame(frame).map_err(render_error)?;
        target.frame(&drawing, drawn.repeated)?;
        if !drawn.repeated {
            stats.push(drawn.stats);
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    match target {
        Target::Film(film) => file::write_atomic(&args.output, &film.finish().map_err(render_error)?)?,
        Target::Folder { folder, names } => {
            let manifest = json!({
                "fps": run.fps, "loop": run.repeat, "width": size[0], "height": size[1],
                "exposure": exposure, "white": white, "frames": names,
            });
            let manifest = serde_json::to_string_pretty(&manifest)?;
            folder.finish("manifest.json", manifest.as_bytes(), is_frame)?;
        }
    }
    args.told.tell(&Report {
        adapter: drawing.adapter(),
        exposure,
        white,
        total_ms: begun.elapsed().as_secs_f64() * 1e3,
        frames_repeated: run.frames - stats.len(),
        frames: &stats,
    })
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    adapter: String,
    exposure: Rule,
    white: f64,
    total_ms: f64,
    /// Frames equal to the one before, not drawn again.
    frames_repeated: usize,
    frames: &'a [Stats],
}
