//! Pictures in files, PNG and JPEG, with what they say of themselves: what is said is applied, or refused by name.

mod statements;

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use self::statements::{Transfer, colours_of_png, ends, profile_name};
use crate::limits;

/// A picture as it is meant to be seen, upright.
pub(crate) struct Picture {
    pub image: DynamicImage,
    /// How its codes stand for light; why that is not known, where it says something that can't be applied.
    colours: Result<Transfer, String>,
}

impl Picture {
    /// Decodes a PNG or JPEG, or says which rule it breaks. The size is checked before any pixel is decoded.
    pub(crate) fn decode(bytes: &[u8]) -> Result<Picture, String> {
        let format = match image::guess_format(bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            _ => return Err("is not a PNG or JPEG file".to_owned()),
        };
        if format == ImageFormat::Jpeg && !ends(bytes) {
            // The decoder would make up the rest.
            return Err("is cut off before its end; copy the file again".to_owned());
        }
        let most = limits::IMAGE_SIDE;
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        let mut allowed = Limits::default();
        // RGBA in 16 bits of the largest image, and as much again for the decoder.
        allowed.max_alloc = Some((most * most * 16) as u64);
        reader.limits(allowed);
        let unreadable = |e: image::ImageError| format!("can't be decoded: {e}");
        let mut decoder = reader.into_decoder().map_err(unreadable)?;
        let (width, height) = decoder.dimensions();
        if width == 0 || height == 0 {
            return Err("has no pixels".to_owned());
        }
        if width as usize > most || height as usize > most {
            return Err(format!("is {width} × {height} pixels; an image has at most {most} a side"));
        }
        let orientation = decoder.orientation().map_err(unreadable)?;
        let profile = decoder.icc_profile().map_err(unreadable)?;
        let mut colours = match format {
            ImageFormat::Png => colours_of_png(bytes),
            _ => Ok(Transfer::Srgb),
        };
        if let Some(name) = profile.and_then(|profile| profile_name(&profile))
            && !name.to_ascii_lowercase().contains("srgb")
        {
            colours =
                Err(format!("has the colour profile {name:.60?}, which is not applied; convert it to sRGB"));
        }
        let mut image = DynamicImage::from_decoder(decoder).map_err(unreadable)?;
        image.apply_orientation(orientation);
        Ok(Picture { image, colours })
    }

    /// Linear values of all codes, 2⁸ or 2¹⁶ of them. Errors: it says something of its colours that can't be applied.
    pub(crate) fn linear(&self, codes: usize) -> Result<Vec<f32>, String> {
        let transfer = self.colours.clone()?;
        Ok((0..codes).map(|code| transfer.linear(code as f64 / (codes - 1) as f64) as f32).collect())
    }
}
