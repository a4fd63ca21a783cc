//! Animations as one file, for sharing: APNG (lossless) and MP4 (H.264, small). Studies show separate frames; see the manifest of `kelir animate`.

#[cfg(feature = "mp4")]
mod boxes;
#[cfg_attr(not(feature = "mp4"), path = "film/no_mp4.rs")]
mod mp4;

use crate::RenderError;
use mp4::Mp4;

/// What a film is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Every frame exact; large.
    Apng,
    /// H.264, 4:2:0; small, plays everywhere.
    Mp4,
}

/// The longer and the shorter side of the largest MP4: H.264's level 5.2, which the encoder ends at.
const MP4_MOST: [usize; 2] = [3840, 2160];

/// How a film runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Pixels [width, height].
    pub size: [usize; 2],
    /// Frames a second, above 0.
    pub fps: f64,
    /// How many frames come.
    pub frames: usize,
    /// Whether it starts again (APNG; an MP4 leaves that to its player).
    pub repeat: bool,
}

/// A film being written, frame by frame, in memory.
pub struct Film {
    kind: Kind,
    written: usize,
    frames: usize,
}

enum Kind {
    Apng(Apng),
    Mp4(Box<Mp4>),
}

impl Film {
    /// Begins a film. Errors: no frames, a rate that the format cannot say, a size that it cannot hold.
    pub fn new(format: Format, run: Run) -> Result<Self, RenderError> {
        let refused = |rule: String| Err(RenderError::View(rule));
        if run.frames == 0 || run.size.contains(&0) {
            return refused("frames and size must be at least 1".into());
        }
        // APNG counts delays in 16-bit fractions.
        if !(run.fps >= 0.01 && run.fps <= 600.0) {
            return refused(format!("timeline.fps = {}: a film has 0.01 to 600 frames a second", run.fps));
        }
        let kind = match format {
            Format::Apng => Kind::Apng(Apng::new(run)?),
            Format::Mp4 if run.size.iter().any(|side| *side < 16) => {
                return refused(format!(
                    "size = {}x{}: an MP4 is at least 16x16 pixels",
                    run.size[0], run.size[1]
                ));
            }
            Format::Mp4
                if run.size.iter().max() > Some(&MP4_MOST[0])
                    || run.size.iter().min() > Some(&MP4_MOST[1]) =>
            {
                return refused(format!(
                    "size = {}x{}: an MP4 is at most {}x{} pixels, upright or not; an APNG or a folder of frames may be larger",
                    run.size[0], run.size[1], MP4_MOST[0], MP4_MOST[1]
                ));
            }
            Format::Mp4 => Kind::Mp4(Box::new(Mp4::new(run)?)),
        };
        Ok(Self { kind, written: 0, frames: run.frames })
    }

    /// Adds a frame of display codes `0x__BBGGRR`, `width * height` of them.
    pub fn frame(&mut self, codes: &[u32]) -> Result<(), RenderError> {
        self.written += 1;
        match &mut self.kind {
            Kind::Apng(film) => film.frame(codes),
            Kind::Mp4(film) => film.frame(codes),
        }
    }

    /// The file's bytes. Errors: not as many frames as announced.
    pub fn finish(self) -> Result<Vec<u8>, RenderError> {
        if self.written != self.frames {
            return Err(RenderError::Encode(format!("film: {} of {} frames", self.written, self.frames)));
        }
        match self.kind {
            Kind::Apng(film) => film.writer.finish().map_err(failed("apng")).map(|()| take(&film.bytes)),
            Kind::Mp4(film) => film.finish(),
        }
    }
}

/// What both libraries' writers write to.
type Shared = std::sync::Arc<std::sync::Mutex<Vec<u8>>>;

struct Sink(Shared);

impl std::io::Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn take(bytes: &Shared) -> Vec<u8> {
    std::mem::take(&mut *bytes.lock().unwrap_or_else(std::sync::PoisonError::into_inner))
}

fn failed<E: std::fmt::Display>(what: &'static str) -> impl Fn(E) -> RenderError {
    move |error| RenderError::Encode(format!("{what}: {error}"))
}

fn rgb(code: &u32) -> [u8; 3] {
    [*code as u8, (code >> 8) as u8, (code >> 16) as u8]
}

struct Apng {
    writer: png::Writer<Sink>,
    bytes: Shared,
    width: usize,
    last: Option<Vec<u32>>,
}

impl Apng {
    fn new(run: Run) -> Result<Self, RenderError> {
        let bytes = Shared::default();
        let mut encoder = png::Encoder::new(Sink(bytes.clone()), run.size[0] as u32, run.size[1] as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_animated(run.frames as u32, u32::from(!run.repeat)).map_err(failed("apng"))?;
        let denominator = (run.fps * 100.0).round() as u16;
        encoder.set_frame_delay(100, denominator.max(1)).map_err(failed("apng"))?;
        encoder.set_blend_op(png::BlendOp::Source).map_err(failed("apng"))?;
        let writer = encoder.write_header().map_err(failed("apng"))?;
        Ok(Self { writer, bytes, width: run.size[0], last: None })
    }

    /// Only the rectangle that changed is written.
    fn frame(&mut self, codes: &[u32]) -> Result<(), RenderError> {
        let height = codes.len() / self.width;
        let [left, top, right, bottom] = match &self.last {
            None => [0, 0, self.width, height],
            Some(last) => changed(last, codes, self.width),
        };
        let (width, rows) = (right - left, bottom - top);
        let apng = failed("apng");
        self.writer.reset_frame_position().map_err(&apng)?;
        self.writer.set_frame_dimension(width as u32, rows as u32).map_err(&apng)?;
        self.writer.set_frame_position(left as u32, top as u32).map_err(&apng)?;
        let pixels: Vec<u8> = (top..bottom)
            .flat_map(|row| codes[row * self.width + left..row * self.width + right].iter().flat_map(rgb))
            .collect();
        self.writer.write_image_data(&pixels).map_err(&apng)?;
        self.last = Some(codes.to_vec());
        Ok(())
    }
}

/// The smallest rectangle [left, top, right, bottom] that holds every pixel that differs; one pixel where none does.
fn changed(before: &[u32], after: &[u32], width: usize) -> [usize; 4] {
    let mut bounds = [usize::MAX, usize::MAX, 0, 0];
    for (row, (a, b)) in before.chunks(width).zip(after.chunks(width)).enumerate() {
        let differs = |(a, b): (&u32, &u32)| a != b;
        let Some(first) = a.iter().zip(b).position(differs) else { continue };
        let last = a.iter().zip(b).rposition(differs).unwrap_or(first);
        bounds = [bounds[0].min(first), bounds[1].min(row), bounds[2].max(last + 1), row + 1];
    }
    if bounds[2] == 0 { [0, 0, 1, 1] } else { bounds }
}

#[cfg(test)]
mod tests;
