//! H.264 in an MP4.

use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use openh264::OpenH264API;
use openh264::encoder::{
    ColorPrimaries, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, MatrixCoefficients,
    QpRange, RateControlMode, TransferCharacteristics, VuiConfig,
};
use openh264::formats::{RgbSliceU8, YUVBuffer};

use super::{Run, Shared, Sink, boxes, failed, rgb, take};
use crate::RenderError;

/// Quantiser of the MP4, 0 (finest) to 51: at 14 the screens' slow gradients show no bands.
const QUANTISER: u8 = 14;

/// What its colours are, by the numbers of ITU-T H.273: BT.709's primaries, sRGB's transfer, BT.601's matrix.
const COLOURS: [u16; 3] = [1, 13, 6];

pub(super) struct Mp4 {
    encoder: Encoder,
    muxer: Muxer<Sink>,
    bytes: Shared,
    run: Run,
    written: usize,
    /// The last frame as it was coded.
    pub(super) last: Vec<u8>,
}

/// H.264 in 4:2:0 has even sides only; an odd picture repeats its last row or column.
pub(super) fn even(side: usize) -> usize {
    side.next_multiple_of(2)
}

impl Mp4 {
    pub(super) fn new(run: Run) -> Result<Self, RenderError> {
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

    pub(super) fn frame(&mut self, codes: &[u32]) -> Result<(), RenderError> {
        let [width, height] = self.run.size;
        let [wide, high] = self.run.size.map(even);
        let pixels: Vec<u8> = (0..high)
            .flat_map(|row| (0..wide).map(move |column| row.min(height - 1) * width + column.min(width - 1)))
            .flat_map(|at| rgb(&codes[at]))
            .collect();
        let picture = YUVBuffer::from_rgb8_source(RgbSliceU8::new(&pixels, (wide, high)));
        let coded = self.encoder.encode(&picture).map_err(failed("mp4"))?;
        let key = matches!(coded.frame_type(), FrameType::IDR | FrameType::I);
        let time_s = self.written as f64 / self.run.fps;
        self.last = coded.to_vec();
        self.muxer.write_video(time_s, &self.last, key).map_err(failed("mp4"))?;
        self.written += 1;
        Ok(())
    }

    pub(super) fn finish(self) -> Result<Vec<u8>, RenderError> {
        self.muxer.finish().map_err(failed("mp4"))?;
        let mut bytes = take(&self.bytes);
        let told = boxes::say_colours(&mut bytes, COLOURS).and_then(|()| match self.written {
            // How long a frame is shown the library sees at the next.
            1 => boxes::last(&mut bytes, 1.0 / self.run.fps),
            _ => Some(()),
        });
        told.map(|()| bytes).ok_or_else(|| RenderError::Encode("mp4: a box is not where it belongs".into()))
    }
}
