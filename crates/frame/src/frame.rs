//! What a renderer is asked for and what it answers.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::{RenderError, encode};

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
    /// Checks the view against the sides of what is shown, in any unit: sizes above zero, and square pixels to within half a pixel.
    ///
    /// # Errors
    /// [`RenderError::View`]: which size, and which it would have to be.
    pub fn check(&self, [screen_w, screen_h]: [f64; 2]) -> Result<(), RenderError> {
        let [w, h] = self.size;
        if w == 0 || h == 0 || w > 1 << 16 || h > 1 << 16 {
            return Err(RenderError::View(format!("size = {w}x{h}: each side from 1 to 65536 pixels")));
        }
        let ideal = w as f64 * screen_h / screen_w;
        if (ideal - h as f64).abs() > 0.5 && (h as f64 * screen_w / screen_h - w as f64).abs() > 0.5 {
            return Err(RenderError::View(format!(
                "size = {w}x{h}: what is shown is as wide and high as {screen_w} by {screen_h}, so {w} pixels of width need {} of height",
                ideal.round().max(1.0)
            )));
        }
        Ok(())
    }
}

/// A drawn image in linear light; every plane holds `width * height` values, row-major, first row on top.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// The audience's linear radiance: R, G, B.
    pub radiance: [Vec<f32>; 3],
    /// How much of each emitter is seen; none where only the radiance was asked for.
    pub visibilities: Vec<Visibility>,
    /// Standard error of the radiance, R, G, B, where the technique knows it; 0 where nothing was sampled.
    pub standard_error: Option<[Vec<f32>; 3]>,
    /// What was done and skipped.
    pub stats: Stats,
}

/// The visibility of one emitter on every pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Visibility {
    /// The emitter's name; `dome` for the dome.
    pub emitter: String,
    /// What it is a share of.
    pub model: VisibilityModel,
    /// 0, 1, 2 for R, G, B where puppets are coloured; otherwise it holds for all.
    pub channel: Option<usize>,
    /// One a pixel.
    pub values: Vec<f32>,
}

/// The visibility that a technique's formula tends to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum VisibilityModel {
    /// Share of the emitter's area that is seen.
    Geometric,
    /// Share of the emitter's irradiance that arrives, which a light meter reads: no model error.
    Irradiance,
}

/// Names of the channels R, G, B.
const RGB: [&str; 3] = ["R", "G", "B"];

impl Frame {
    /// Every plane under its channel's name in an EXR file.
    pub fn channels(&self) -> impl Iterator<Item = (String, &[f32])> {
        let radiance = RGB.iter().zip(&self.radiance).map(|(c, values)| ((*c).to_owned(), &values[..]));
        let visibilities = self.visibilities.iter().map(|v| (v.name(), &v.values[..]));
        let errors = RGB.iter().zip(self.standard_error.iter().flatten());
        radiance.chain(visibilities).chain(errors.map(|(c, values)| (format!("SE.{c}"), &values[..])))
    }

    /// Errors: the first value that is no finite number.
    pub fn check(&self) -> Result<(), RenderError> {
        for (channel, values) in self.channels() {
            // A count, as a search that may end early is no vector code.
            if values.iter().map(|v| u32::from(!v.is_finite())).sum::<u32>() == 0 {
                continue;
            }
            if let Some(k) = values.iter().position(|v| !v.is_finite()) {
                let at = [k % self.size[0], k / self.size[0]];
                return Err(RenderError::NotFinite { drawn: String::new(), channel, value: values[k], at });
            }
        }
        Ok(())
    }
}

impl Visibility {
    /// `Vgeo.EMITTER` or `Virr.EMITTER`, with `.R`, `.G` or `.B` behind it where it holds for one channel.
    pub fn name(&self) -> String {
        let kind = match self.model {
            VisibilityModel::Geometric => "Vgeo",
            VisibilityModel::Irradiance => "Virr",
        };
        match self.channel {
            None => format!("{kind}.{}", self.emitter),
            Some(c) => format!("{kind}.{}.{}", self.emitter, RGB[c]),
        }
    }
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

impl Stats {
    /// Notes a step that began at `since` and is done now.
    pub fn step(&mut self, name: &str, since: Instant) {
        self.steps_ms.push((name.into(), since.elapsed().as_secs_f64() * 1e3));
    }
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

/// Draws one kind of subject with one technique on one backend; keeps what it built between calls and reuses what did not change.
pub trait Renderer<S>: Send {
    /// The audience's linear radiance, and the emitters' visibilities where they are wanted: what gives no light is skipped otherwise. What
    /// leaves a renderer is asked for by [`radiance`](Self::radiance) and [`display`](Self::display), which check it.
    fn frame(&mut self, subject: &S, view: &View, visibilities: bool) -> Result<Frame, RenderError>;

    /// The audience's linear radiance with all visibilities, every value of it finite.
    fn radiance(&mut self, subject: &S, view: &View) -> Result<Frame, RenderError> {
        let frame = self.frame(subject, view, true)?;
        frame.check().map(|()| frame)
    }

    /// Display codes: sRGB-encoded clip(L / white), each pixel `0xFFBBGGRR` (bytes R, G, B, 255), into `out` of `width * height`. Who
    /// overrides it gives the codes of the radiance, only sooner.
    fn display(
        &mut self,
        subject: &S,
        view: &View,
        white: f64,
        out: &mut [u32],
    ) -> Result<Stats, RenderError> {
        check_display(view, white, out)?;
        let frame = self.frame(subject, view, false)?;
        frame.check()?;
        encode::display_into(&frame, white, out);
        Ok(frame.stats)
    }

    /// Counts the rows of what is drawn from now on; techniques that are done before anyone looks do not.
    fn watch(&mut self, meter: &Meter) {
        let _ = meter;
    }

    /// The kind of backend, for a job's key: `cpu`, or `gpu:ADAPTER/DRIVER`, because drivers differ.
    fn class(&self) -> String {
        "cpu".into()
    }

    /// What drew it, for provenance: [`crate::Isa::native`] or the GPU adapter's name and driver.
    fn adapter(&self) -> String;
}

/// Errors: room for another number of pixels than the view's, or a white that nothing can be divided by.
pub fn check_display(view: &View, white: f64, out: &[u32]) -> Result<(), RenderError> {
    let [w, h] = view.size;
    if out.len() != w * h {
        return Err(RenderError::View(format!("{} pixels given for {w}x{h}", out.len())));
    }
    if !(white.is_finite() && white > 0.0) {
        return Err(RenderError::View(format!("white = {white}: a radiance above 0")));
    }
    Ok(())
}
