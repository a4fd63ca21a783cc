//! `kelir render`: one image of a scene.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use kelir_render::encode::{self, Attributes};
use kelir_render::exposure::Rule;
use kelir_render::job::{self, Drawn, Output};
use kelir_render::subject::Staged;
use kelir_render::{Frame, Meter, RenderError, Stats, file};
use kelir_scene::AnyScene;
use serde::Serialize;

use super::drawing::{Drawing, ExposureName, Told, render_error};
use crate::bad_input;
use crate::progress;

/// Arguments of `kelir render`.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    drawing: Drawing,
    #[command(flatten)]
    told: Told,
    /// Instant of the timeline, in seconds; by default the scene as written, its timeline not applied.
    #[arg(long)]
    time: Option<f64>,
    /// What is shown as white.
    #[arg(long, value_enum, default_value = "still")]
    exposure: ExposureName,
    /// Image to write: .png (display-encoded sRGB) or .exr (linear radiance, visibilities, standard errors).
    #[arg(short, long)]
    output: PathBuf,
}

enum Container {
    Png,
    Exr,
}

/// Runs the command.
pub(crate) fn run(args: Args) -> Result<()> {
    let container =
        match args.output.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("png") => Container::Png,
            Some("exr") => Container::Exr,
            _ => {
                return Err(bad_input(format!(
                    "output = {}: the name ends in .png or .exr",
                    args.output.display()
                )));
            }
        };
    match args.drawing.scene()? {
        AnyScene::Theatre(scene) => still(&args, &container, scene),
        AnyScene::Stage(scene) => still(&args, &container, scene),
    }
}

fn still<S: Staged>(args: &Args, container: &Container, scene: S) -> Result<()> {
    let mut job = args.drawing.job(scene, Output::Still, args.exposure, args.time)?;
    let (technique, size, exposure) = (job.technique.clone(), job.view.size, job.exposure);
    let scene_sha256 = job.scene.sha256().to_owned();

    let begun = Instant::now();
    file::try_writing(&args.output)?;
    let mut drawing = progress::watch(&Meter::default(), "exposure", || job::Drawing::open(&mut job))
        .map_err(render_error)?;
    let white = drawing.white();
    let attributes = Attributes {
        white,
        exposure,
        technique: serde_json::to_string(&technique)?,
        scene_sha256: scene_sha256.clone(),
    };
    let meter = Meter::default();
    drawing.watch(&meter);
    let (bytes, stats, linear) =
        progress::watch(&meter, technique.name(), || draw(&mut drawing, container, &attributes))
            .map_err(render_error)?;
    file::write_atomic(&args.output, &bytes)?;

    let standard_error = linear.and_then(|frame| StandardError::of(&frame, white));
    if let Some(error) = &standard_error {
        eprintln!(
            "standard error of a pixel, in units of white: mean {:.2e} where sampled, at most {:.2e}",
            error.mean_sampled, error.max
        );
    }
    args.told.tell(&Report {
        technique: technique.name(),
        adapter: drawing.adapter(),
        size,
        exposure,
        white,
        scene_sha256,
        total_ms: begun.elapsed().as_secs_f64() * 1e3,
        stats: &stats,
        standard_error,
    })
}

/// The file's bytes, what was done, and the image in linear light where it was drawn in that.
fn draw<S: Staged>(
    drawing: &mut job::Drawing<'_, S>,
    container: &Container,
    attributes: &Attributes,
) -> Result<(Vec<u8>, Stats, Option<Frame>), RenderError> {
    match container {
        Container::Png => {
            let Drawn { stats, linear, .. } = drawing.frame(0)?;
            Ok((drawing.file()?.bytes, stats, linear))
        }
        Container::Exr => {
            let frame = drawing.radiance(0)?;
            Ok((encode::exr(&frame, attributes)?, frame.stats.clone(), Some(frame)))
        }
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    technique: &'a str,
    adapter: String,
    size: [usize; 2],
    exposure: Rule,
    white: f64,
    scene_sha256: String,
    total_ms: f64,
    stats: &'a Stats,
    standard_error: Option<StandardError>,
}

/// Monte Carlo's own standard error, in units of white.
#[derive(Serialize)]
struct StandardError {
    /// Mean over the pixels and channels that were sampled (elsewhere it is exactly 0).
    mean_sampled: f64,
    /// The largest.
    max: f64,
    /// Share of the pixels that were sampled.
    sampled_share: f64,
}

impl StandardError {
    fn of(frame: &Frame, white: f64) -> Option<Self> {
        let errors = frame.standard_error.as_ref()?;
        let values = || errors.iter().flatten().map(|value| f64::from(*value) / white);
        let (sampled, sum) =
            values().filter(|value| *value > 0.0).fold((0_u64, 0.0), |(n, sum), value| (n + 1, sum + value));
        let all = values().count().max(1) as f64;
        Some(Self {
            mean_sampled: sum / sampled.max(1) as f64,
            max: values().fold(0.0, f64::max),
            sampled_share: sampled as f64 / all,
        })
    }
}
