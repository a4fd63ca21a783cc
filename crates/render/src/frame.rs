//! What a renderer is asked for and what it answers.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use kelir_scene::Theatre;
use serde::{Deserialize, Serialize};

use crate::RenderError;

/// How a pixel's value is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pixel {
    /// The mean over the pixel's area (the default).
    #[default]
    Area,
    /// The value at the pixel's centre.
    Centre,
}

/// The image asked for; its aspect equals the screen's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct View {
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// Pixel rule.
    pub pixel: Pixel,
    /// Whether work that the scene does not need is skipped; the bytes are the same either way.
    pub skip: bool,
}

impl View {
    /// Checks the view against the screen: sizes above zero, and square pixels to within half a pixel.
    ///
    /// # Errors
    /// [`RenderError::View`]: which size, and which it would have to be.
    pub fn check(&self, theatre: &Theatre) -> Result<(), RenderError> {
        let [w, h] = self.size;
        if w == 0 || h == 0 || w > 1 << 16 || h > 1 << 16 {
            return Err(RenderError::View(format!("size = {w}x{h}: each side from 1 to 65536 pixels")));
        }
        let (screen_w, screen_h) = (theatre.screen.width_m, theatre.screen.height_m);
        let ideal = w as f64 * screen_h / screen_w;
        if (ideal - h as f64).abs() > 0.5 && (h as f64 * screen_w / screen_h - w as f64).abs() > 0.5 {
            return Err(RenderError::View(format!(
                "size = {w}x{h}: the screen is {screen_w} m x {screen_h} m, so {w} pixels of width need {} of height",
                ideal.round().max(1.0)
            )));
        }
        Ok(())
    }
}

/// A drawn image in linear light.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// The audience's linear radiance, three planes (R, G, B) of `width * height`, row-major, first row on top.
    pub radiance: [Vec<f32>; 3],
    /// Further channels: `Vgeo.<emitter>`, `Virr.<emitter>` (suffixed `.R/.G/.B` where puppets are coloured), `SE.R/G/B`.
    pub layers: Vec<Layer>,
    /// What was done and skipped.
    pub stats: Stats,
}

/// One named f32 channel of a frame.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Channel name, as written to EXR.
    pub name: String,
    /// `width * height` values, row-major, first row on top.
    pub values: Vec<f32>,
}

/// Counters and step times of one drawing, in the order they happened.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Stats {
    /// Name → count: what was done and what was skipped.
    pub counts: std::collections::BTreeMap<String, u64>,
    /// Name → measured number; MC's `se_mean`, `se_rms` and `se_max` are its standard error over penumbra pixels
    /// (the largest channel), in units of the brightest unshadowed pixel.
    pub values: std::collections::BTreeMap<String, f64>,
    /// (step, milliseconds of wall time).
    pub steps_ms: Vec<(String, f64)>,
}

/// How far a long drawing has come, in rows of the image, for whoever shows it; clones count together.
#[derive(Clone, Debug, Default)]
pub struct Meter(Arc<[AtomicU64; 2]>);

impl Meter {
    /// A drawing of `rows` rows begins.
    pub fn begin(&self, rows: usize) {
        self.0[0].store(0, Ordering::Relaxed);
        self.0[1].store(rows as u64, Ordering::Relaxed);
    }

    /// `rows` more are drawn.
    pub fn add(&self, rows: usize) {
        self.0[0].fetch_add(rows as u64, Ordering::Relaxed);
    }

    /// (drawn, of how many); (0, 0) before the drawing has begun.
    pub fn read(&self) -> (u64, u64) {
        (self.0[0].load(Ordering::Relaxed), self.0[1].load(Ordering::Relaxed))
    }
}

/// Draws theatres with one technique on one backend; keeps what it built between calls and reuses what did not change.
pub trait Renderer: Send {
    /// The audience's linear radiance.
    fn radiance(&mut self, theatre: &Theatre, view: &View) -> Result<Frame, RenderError>;

    /// Display codes: sRGB-encoded clip(L / white), each pixel `0xFFBBGGRR` (bytes R, G, B, 255), into `out` of `width * height`.
    fn display(
        &mut self,
        theatre: &Theatre,
        view: &View,
        white: f64,
        out: &mut [u32],
    ) -> Result<Stats, RenderError>;

    /// Counts the rows of what is drawn from now on; techniques that are done before anyone looks do not.
    fn watch(&mut self, meter: &Meter) {
        let _ = meter;
    }

    /// The kind of backend, for a job's key: `cpu`, or `gpu:ADAPTER/DRIVER`, because drivers differ.
    fn class(&self) -> String {
        "cpu".into()
    }

    /// What drew it, for provenance: "native 2 threads avx2" or the GPU adapter's name and driver.
    fn adapter(&self) -> String;
}
