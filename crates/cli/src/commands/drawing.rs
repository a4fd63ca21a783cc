//! The options that `render` and `animate` share: technique, knobs, size, backend.

use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use clap::builder::PossibleValuesParser;
use kelir_house::shipped;
use kelir_render::exposure::Rule;
use kelir_render::job::{Job, Output};
use kelir_render::subject::{Staged, Subject, check_view};
use kelir_render::{Backend, Meter, Pixel, RenderError, Technique, View};
use kelir_scene::{AnyScene, Scene};
use serde::Serialize;

use super::knobs::Turned;
use crate::bad_input;
use crate::output::print_json;
use crate::progress;

/// What to draw and how.
#[derive(clap::Args)]
pub(crate) struct Drawing {
    /// Scene file (TOML), or the name of a scene that ships: `kelir scene list`.
    pub scene: PathBuf,
    /// What draws; `kelir technique` says what each is, and what can be turned on it.
    #[arg(long, value_parser = PossibleValuesParser::new(Technique::all().map(|technique| technique.name())))]
    pub technique: String,
    #[command(flatten)]
    turned: Turned,
    /// Pixels, WIDTHxHEIGHT, of the screen's aspect; by default 1920 wide.
    #[arg(long, value_parser = parse_size)]
    pub size: Option<[usize; 2]>,
    /// A pixel's value: the mean over its area, or the value at its centre.
    #[arg(long, value_enum, default_value = "area")]
    pub pixel: PixelName,
    /// Where to draw: auto takes a real GPU if there is one, otherwise the native code.
    #[arg(long, default_value = "auto", value_parser = parse_backend)]
    pub backend: Backend,
    /// Compute everything, also what the scene does not need; the bytes are the same.
    #[arg(long)]
    pub no_skip: bool,
}

/// Whether what was done is printed.
#[derive(clap::Args)]
pub(super) struct Told {
    /// Print one JSON document: what was done, skipped and how long each step took.
    #[arg(long)]
    json: bool,
    /// As `--json`.
    #[arg(long, value_enum, hide = true)]
    stats: Option<StatsFormat>,
}

impl Told {
    /// Prints the document, if it is asked for.
    pub(super) fn tell(&self, document: &impl Serialize) -> Result<()> {
        if self.json || self.stats.is_some() { print_json(document) } else { Ok(()) }
    }
}

/// Format of `--stats`.
#[derive(Clone, Copy, ValueEnum)]
enum StatsFormat {
    Json,
}

/// Names of the pixel rules on the command line.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum PixelName {
    /// Mean over the pixel.
    Area,
    /// Value at the centre.
    Centre,
}

/// Names of the exposure rules on the command line.
#[derive(Clone, Copy, ValueEnum)]
pub enum ExposureName {
    /// The brightest pixel without puppets, as the scene is written or at its instant.
    Still,
    /// The brightest over every frame of the timeline: one white for all of them.
    Timeline,
}

impl From<ExposureName> for Rule {
    fn from(name: ExposureName) -> Self {
        match name {
            ExposureName::Still => Self::Still,
            ExposureName::Timeline => Self::Timeline,
        }
    }
}

impl Drawing {
    /// Reads the scene, with its warnings on the terminal.
    pub(super) fn scene(&self) -> Result<AnyScene> {
        let read = || shipped::any_scene(&self.scene).map_err(bad_input);
        let scene = progress::watch(&Meter::default(), "reading the scene", read)?;
        for warning in scene.warnings() {
            eprintln!("warning: {warning}");
        }
        Ok(scene)
    }

    /// What is asked of the renderer, as a study would ask it.
    pub(super) fn job<S: Staged>(
        &self,
        scene: S,
        output: Output,
        exposure: ExposureName,
        time_s: Option<f64>,
    ) -> Result<Job<S>> {
        Ok(Job {
            technique: self.technique()?,
            view: self.view(&scene.still())?,
            scene,
            backend: self.backend,
            camera: None,
            time_s,
            exposure: exposure.into(),
            output,
            reference: None,
        })
    }

    /// The technique with its knobs; one that it does not have is refused.
    pub(crate) fn technique(&self) -> Result<Technique> {
        Technique::parse(&self.technique, &self.turned.0).map_err(render_error)
    }

    /// Reads and validates a theatre's scene; every problem is named.
    pub(crate) fn load(&self) -> Result<Scene> {
        shipped::scene(&self.scene).map_err(bad_input)
    }

    /// The image asked for. Errors: a size that can't be drawn.
    pub(crate) fn view(&self, subject: &impl Subject) -> Result<View> {
        let pixel = match self.pixel {
            PixelName::Area => Pixel::Area,
            PixelName::Centre => Pixel::Centre,
        };
        let [width, height] = subject.sides();
        let size = self.size.unwrap_or_else(|| [1920, (1920.0 * height / width).round().max(1.0) as usize]);
        let view = View { size, pixel, skip: !self.no_skip };
        check_view(subject, &view).map_err(render_error)?;
        Ok(view)
    }
}

/// Errors of drawing: what the user can mend is bad input, a failing disk or GPU is not.
pub(super) fn render_error(error: RenderError) -> anyhow::Error {
    match error {
        RenderError::Inapplicable { .. } | RenderError::View(_) | RenderError::Knob(_) => bad_input(error),
        other => anyhow::Error::new(other),
    }
}

/// WIDTHxHEIGHT.
pub(super) fn parse_size(text: &str) -> Result<[usize; 2], String> {
    let rule = || format!("{text:?} is no size: write WIDTHxHEIGHT in pixels, as in 1920x1080");
    let (width, height) = text.split_once('x').ok_or_else(rule)?;
    let size = [width.parse().map_err(|_| rule())?, height.parse().map_err(|_| rule())?];
    if size.contains(&0) { Err(rule()) } else { Ok(size) }
}

/// auto, cpu or gpu.
pub(super) fn parse_backend(text: &str) -> Result<Backend, String> {
    text.parse().map_err(|error: RenderError| error.to_string())
}
