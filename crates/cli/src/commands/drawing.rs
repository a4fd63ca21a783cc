//! The options that `render` and `animate` share: technique, knobs, size, backend.

use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use kelir_render::exposure::Rule;
use kelir_render::job::{Job, Output};
use kelir_render::{Backend, Pixel, RenderError, Technique, View, mc, oracle, pa, pcss, points};
use kelir_scene::{Scene, Theatre};
use kelir_server::shipped;
use serde::Serialize;

use crate::bad_input;
use crate::output::print_json;

/// What to draw and how.
#[derive(clap::Args)]
pub struct Drawing {
    /// Scene file (TOML), or the name of a scene that ships: `kelir scene list`.
    pub scene: PathBuf,
    /// What draws: pa (summed-area tables), mc (Monte Carlo, the ground truth), points (point lights),
    /// pcss (percentage-closer soft shadows), oracle (slow f64 sums).
    #[arg(long, value_enum)]
    pub technique: TechniqueName,
    /// Samples a pixel (mc), rounded up to a multiple of 16 replicates.
    #[arg(long, default_value_t = 64)]
    pub spp: u32,
    /// Seed of the sample points (mc, pcss): same seed and count, same bytes.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// In place of --spp: enough samples for this root mean square error over penumbra, in units of full scale (mc).
    #[arg(long)]
    pub target_error: Option<f64>,
    /// In place of --spp: as many samples as this many seconds allow; the count is recorded and replays the image (mc).
    #[arg(long, value_name = "SECONDS")]
    pub time_limit: Option<f64>,
    /// Split each emitter into K × K pieces (pa): 1 is the paper's way.
    #[arg(long, value_name = "K", default_value_t = 1)]
    pub split: u32,
    /// How the pieces of a split emitter weigh (pa): area tends to the geometric visibility, irradiance to what a meter reads.
    #[arg(long, value_enum, default_value = "area")]
    pub weights: WeightsName,
    /// Strips that a disk is cut into (pa).
    #[arg(long, default_value_t = pa::Knobs::default().strips)]
    pub strips: u32,
    /// Point lights that stand for each emitter, a square number (points).
    #[arg(long, value_name = "N", default_value_t = points::Knobs::default().lights)]
    pub lights: u32,
    /// Tables of the puppets themselves, or of a shadow map drawn from the lamp, as in the paper (pa).
    #[arg(long, value_enum, default_value = "exact")]
    pub variant: VariantName,
    /// Samples a side of that shadow map (pa), or of each puppet's (pcss).
    #[arg(long, value_name = "N", default_value_t = pa::Knobs::default().map_size)]
    pub map_size: u32,
    /// Lattice points per distance of a puppet for the dome's light (pa).
    #[arg(long, value_name = "N", default_value_t = pa::Knobs::default().dome_steps)]
    pub dome_steps: u32,
    /// Samples of the search for blockers (pcss).
    #[arg(long, value_name = "N", default_value_t = pcss::Knobs::default().blocker_samples)]
    pub blocker_samples: u32,
    /// Samples of the filter (pcss).
    #[arg(long, value_name = "N", default_value_t = pcss::Knobs::default().filter_samples)]
    pub filter_samples: u32,
    /// Depth bias: a puppet no further than this before the screen casts no shadow (pcss).
    #[arg(long, value_name = "METRES", default_value_t = pcss::Knobs::default().bias_m)]
    pub bias: f64,
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
pub struct Told {
    /// Print one JSON document: what was done, skipped and how long each step took.
    #[arg(long)]
    json: bool,
    /// As `--json`.
    #[arg(long, value_enum, hide = true)]
    stats: Option<StatsFormat>,
}

impl Told {
    /// Prints the document, if it is asked for.
    pub fn tell(&self, document: &impl Serialize) -> Result<()> {
        if self.json || self.stats.is_some() { print_json(document) } else { Ok(()) }
    }
}

/// Format of `--stats`.
#[derive(Clone, Copy, ValueEnum)]
enum StatsFormat {
    Json,
}

/// Names of the techniques on the command line.
#[derive(Clone, Copy, ValueEnum)]
pub enum TechniqueName {
    /// Summed-area tables.
    Pa,
    /// Monte Carlo.
    Mc,
    /// Point lights averaged.
    Points,
    /// Percentage-closer soft shadows.
    Pcss,
    /// f64 sums.
    Oracle,
}

/// Names of PA's variants on the command line.
#[derive(Clone, Copy, ValueEnum)]
pub enum VariantName {
    /// Exact boxes.
    Exact,
    /// The paper's pipeline.
    ShadowMap,
}

/// Names of the weightings on the command line.
#[derive(Clone, Copy, ValueEnum)]
pub enum WeightsName {
    /// 1/k² each.
    Area,
    /// By unshadowed irradiance.
    Irradiance,
}

/// Names of the pixel rules on the command line.
#[derive(Clone, Copy, ValueEnum)]
pub enum PixelName {
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
    /// What is asked of the renderer, as a study would ask it.
    pub fn job(&self, output: Output, exposure: ExposureName, time_s: Option<f64>) -> Result<Job> {
        let scene = self.load()?;
        Ok(Job {
            technique: self.technique(),
            view: self.view(&scene.still()),
            scene,
            backend: self.backend,
            camera: None,
            time_s,
            exposure: exposure.into(),
            output,
            reference: None,
        })
    }

    /// The technique with its knobs.
    pub fn technique(&self) -> Technique {
        match self.technique {
            TechniqueName::Pa => Technique::Pa(pa::Knobs {
                split: self.split,
                weights: match self.weights {
                    WeightsName::Area => pa::Weights::Area,
                    WeightsName::Irradiance => pa::Weights::Irradiance,
                },
                strips: self.strips,
                variant: match self.variant {
                    VariantName::Exact => pa::Variant::Exact,
                    VariantName::ShadowMap => pa::Variant::ShadowMap,
                },
                map_size: self.map_size,
                dome_steps: self.dome_steps,
            }),
            TechniqueName::Mc => Technique::Mc(mc::Knobs {
                spp: self.spp,
                seed: self.seed,
                target_error: self.target_error,
                time_limit_s: self.time_limit,
            }),
            TechniqueName::Points => {
                Technique::Points(points::Knobs { lights: self.lights, ..points::Knobs::default() })
            }
            TechniqueName::Pcss => Technique::Pcss(pcss::Knobs {
                blocker_samples: self.blocker_samples,
                filter_samples: self.filter_samples,
                map_size: self.map_size,
                seed: self.seed,
                bias_m: self.bias,
            }),
            TechniqueName::Oracle => Technique::Oracle(oracle::Knobs::default()),
        }
    }

    /// Reads and validates the scene; every problem is named.
    pub fn load(&self) -> Result<Scene> {
        shipped::scene(&self.scene).map_err(bad_input)
    }

    /// The image asked for.
    pub fn view(&self, theatre: &Theatre) -> View {
        let pixel = match self.pixel {
            PixelName::Area => Pixel::Area,
            PixelName::Centre => Pixel::Centre,
        };
        let aspect = theatre.screen.height_m / theatre.screen.width_m;
        let size = self.size.unwrap_or_else(|| [1920, (1920.0 * aspect).round() as usize]);
        View { size, pixel, skip: !self.no_skip }
    }
}

/// Errors of drawing: what the user can mend is bad input, a failing disk or GPU is not.
pub fn render_error(error: RenderError) -> anyhow::Error {
    match error {
        RenderError::Inapplicable { .. } | RenderError::View(_) | RenderError::Knob(_) => bad_input(error),
        other => anyhow::Error::new(other),
    }
}

/// WIDTHxHEIGHT.
pub fn parse_size(text: &str) -> Result<[usize; 2], String> {
    let rule = || format!("{text:?} is no size: write WIDTHxHEIGHT in pixels, as in 1920x1080");
    let (width, height) = text.split_once('x').ok_or_else(rule)?;
    let size = [width.parse().map_err(|_| rule())?, height.parse().map_err(|_| rule())?];
    if size.contains(&0) { Err(rule()) } else { Ok(size) }
}

/// auto, cpu or gpu.
pub fn parse_backend(text: &str) -> Result<Backend, String> {
    text.parse().map_err(|error: RenderError| error.to_string())
}
