//! `kelir bench gpu`: whether a GPU draws what the native code draws, and how fast and how exact both are.

use std::path::PathBuf;

use anyhow::{Result, bail};
use kelir_house::shipped;
use kelir_render::accuracy::{self, Options};
use kelir_render::bench::{self, Case};
use kelir_render::twins::{Measure, Twin, Twins, twins};
use kelir_render::{Backend, Pixel, Technique, View};
use kelir_scene::Scene;
use serde_json::json;

use super::accuracy::text;
use super::frames::cases;
use crate::commands::drawing::render_error;
use crate::output::{Figures, table};
use crate::{bad_input, progress};

/// Where it is measured.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scene file (TOML), or the name of a scene that ships.
    #[arg(default_value = "benchmark")]
    scene: PathBuf,
    #[command(flatten)]
    pub(super) figures: Figures,
}

/// How much is drawn: a GPU's figures, or what a CPU that imitates one does in a minute or two.
struct Amount {
    frames: usize,
    frame_width: usize,
    accuracy_width: usize,
    runs: usize,
}

impl Amount {
    fn of(software: bool) -> Self {
        match software {
            false => Self { frames: 100, frame_width: 1920, accuracy_width: 480, runs: 2 },
            true => Self { frames: 5, frame_width: 960, accuracy_width: 96, runs: 1 },
        }
    }
}

/// Compares, measures, prints; fails where a comparison does not hold.
pub(super) fn run(args: &Args) -> Result<()> {
    let scene = shipped::scene(&args.scene).map_err(bad_input)?;
    let figures = &args.figures;
    let bar = progress::bar(0, "twins");
    let found = twins(&mut |technique| bar.set_message(format!("twins: {technique}")));
    bar.finish_and_clear();
    let found = found.map_err(render_error)?;
    figures.say(&about(&found))?;
    figures.say(&table(
        &["technique", "case", "measure", "gpu", "at most", "off", "more than", ""],
        &found.twins.iter().map(line).collect::<Vec<_>>(),
    ))?;
    let failed = found.twins.iter().filter(|twin| !twin.holds()).count();
    let all = found.twins.len();
    figures.say(&format!("\n{} of {all} comparisons hold", all - failed))?;

    let amount = Amount::of(found.software);
    let frames = frames(&scene, &amount, figures)?;
    let accuracy = errors(&scene, &amount)?;
    figures.say(&format!("\nError against time\n\n{}", text(&accuracy)))?;
    figures.give(&json!({ "gpu": found, "frames": frames, "accuracy": accuracy }))?;
    if failed > 0 {
        bail!("{failed} of {all} comparisons of the GPU with the native code do not hold");
    }
    Ok(())
}

/// The device, and what its figures are worth.
fn about(found: &Twins) -> String {
    let limits = &found.limits;
    let mut about = format!(
        "{}\ntextures of {} pixels a side, buffers of {} MB, {} MB of them seen by a shader\n",
        found.adapter,
        limits.texture_side,
        limits.buffer_bytes >> 20,
        limits.storage_binding_bytes >> 20,
    );
    if found.software {
        about += "No GPU here: a CPU imitates one. Its pictures are compared all the same, small; its times say nothing of a GPU.\n";
    }
    about
        + "\nEach technique on it beside the native code; off: a picture that is known to be wrong, as a negative control\n"
}

fn line(twin: &Twin) -> Vec<String> {
    let measure = match twin.measure {
        Measure::Visibility => "visibility",
        Measure::Layers => "visibility, standard error",
        Measure::LayersRms => "visibility, RMS",
        Measure::Radiance => "radiance / brightest",
        Measure::Codes => "display codes",
    };
    let short = |error: f64| if error == 0.0 { "0".to_owned() } else { format!("{error:.1e}") };
    let [off, least] = match twin.control {
        Some(control) => control.map(short),
        None => [(); 2].map(|()| "–".to_owned()),
    };
    let fault = match (twin.agrees(), twin.control_fails()) {
        (true, true) => "",
        (false, _) => "DIFFERS",
        (true, false) => "CONTROL NOT TOLD",
    };
    vec![
        twin.technique.to_owned(),
        twin.case.clone(),
        measure.to_owned(),
        short(twin.error),
        short(twin.most),
        off,
        least,
        fault.to_owned(),
    ]
}

/// PA's frames a second on both.
fn frames(scene: &Scene, amount: &Amount, figures: &Figures) -> Result<Vec<bench::FramesReport>> {
    let technique = Technique::Pa(kelir_render::pa::Knobs::default());
    let view = view(scene, amount.frame_width);
    let mut reports = Vec::new();
    for backend in [Backend::Cpu, Backend::Gpu] {
        let bar = progress::bar(0, "frames");
        let report =
            bench::frames(scene, &technique, backend, &view, amount.frames, &Case::ALL).map_err(render_error);
        bar.finish_and_clear();
        let report = report?;
        figures.say(&format!("\n{}", cases(&report)))?;
        reports.push(report);
    }
    Ok(reports)
}

/// Every technique's error against its time on both.
fn errors(scene: &Scene, amount: &Amount) -> Result<accuracy::Report> {
    let all = accuracy::all(&scene.still());
    let options = Options {
        backends: vec![Backend::Cpu, Backend::Gpu],
        runs: amount.runs,
        reference_spp: 4096,
        crops: [4, 8],
        ..Options::new(view(scene, amount.accuracy_width))
    };
    super::accuracy::watched(scene, &all, &options)
}

fn view(scene: &Scene, width: usize) -> View {
    let screen = &scene.still().screen;
    let height = (width as f64 * screen.height_m / screen.width_m).round() as usize;
    View { size: [width, height], pixel: Pixel::Area, skip: true }
}
