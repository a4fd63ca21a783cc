//! Animations as one file, for sharing: APNG (lossless) and MP4 (H.264, small). Studies show separate frames; see the manifest of `kelir animate`.

use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use openh264::OpenH264API;
use openh264::encoder::{
    ColorPrimaries, Encoder, EncoderConfig, FrameRate, IntraFramePeriod, MatrixCoefficients, QpRange,
    RateControlMode, TransferCharacteristics, VuiConfig,
};
use openh264::formats::{RgbSliceU8, YUVBuffer};

use crate::RenderError;

/// Quantiser of the MP4, 0 (finest) to 51: at 14 the screens' slow gradients show no bands.
const QUANTISER: u8 = 14;

/// What a film is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Every frame exact; large.
    Apng,
    /// H.264, 4:2:0; small, plays everywhere.
    Mp4,
}

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
            Kind::Mp4(film) => film.muxer.finish().map_err(failed("mp4")).map(|()| take(&film.bytes)),
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

struct Mp4 {
    encoder: Encoder,
    muxer: Muxer<Sink>,
    bytes: Shared,
    run: Run,
    written: usize,
    /// The last frame as it was coded.
    last: Vec<u8>,
}

/// H.264 in 4:2:0 has even sides only; an odd picture repeats its last row or column.
fn even(side: usize) -> usize {
    side.next_multiple_of(2)
}

impl Mp4 {
    fn new(run: Run) -> Result<Self, RenderError> {
        let [width, height] = run.size.map(even);
        // The library's conversion is BT.601's matrix in limited range; a file that says so shows its colours right.
        let colours = VuiConfig::new()
            .color_primaries(ColorPrimaries::Bt709)
            .transfer_characteristics(TransferCharacteristics::Srgb)
            .matrix_coefficients(MatrixCoefficients::Smpte170M)
            .full_range(false);
        // With rate control on, or skipping allowed, the encoder drops frames.
        let config = EncoderConfig::new()
            .skip_frames(false)
            .rate_control_mode(RateControlMode::Off)
            .qp(QpRange::new(QUANTISER, QUANTISER))
            .max_frame_rate(FrameRate::from_hz(run.fps as f32))
            .intra_frame_period(IntraFramePeriod::from_num_frames(60))
            .scene_change_detect(false)
            .adaptive_quantization(false)
            .background_detection(false)
            .vui(colours);
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config).map_err(failed("mp4"))?;
        let bytes = Shared::default();
        let muxer = MuxerBuilder::new(Sink(bytes.clone()))
            .video(VideoCodec::H264, width as u32, height as u32, run.fps)
            .build()
            .map_err(failed("mp4"))?;
        Ok(Self { encoder, muxer, bytes, run, written: 0, last: Vec::new() })
    }

    fn frame(&mut self, codes: &[u32]) -> Result<(), RenderError> {
        let [width, height] = self.run.size;
        let [wide, high] = self.run.size.map(even);
        let pixels: Vec<u8> = (0..high)
            .flat_map(|row| (0..wide).map(move |column| row.min(height - 1) * width + column.min(width - 1)))
            .flat_map(|at| rgb(&codes[at]))
            .collect();
        let picture = YUVBuffer::from_rgb8_source(RgbSliceU8::new(&pixels, (wide, high)));
        let coded = self.encoder.encode(&picture).map_err(failed("mp4"))?;
        let key =
            matches!(coded.frame_type(), openh264::encoder::FrameType::IDR | openh264::encoder::FrameType::I);
        let time_s = self.written as f64 / self.run.fps;
        self.last = coded.to_vec();
        self.muxer.write_video(time_s, &self.last, key).map_err(failed("mp4"))?;
        self.written += 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
