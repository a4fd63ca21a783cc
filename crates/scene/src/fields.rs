//! The sections of a scene file but puppets and timeline: screen, lamp, ambient, exposure.

use std::ops::Bound::{Excluded, Included};
use std::sync::Arc;

use glam::DVec3;
use image::DynamicImage;
use kelir_reader::Node;

use crate::limits::{self, COORDINATE_M, LENGTH_M, RADIANCE};
use crate::load::Loader;
use crate::picture::Picture;
use crate::theatre::{Albedo, Ambient, Emitter, EmitterShape, Exposure, LinearImage, Screen};
use crate::weave::Weave;

/// A length that has area when squared.
pub(crate) fn length(node: &Node) -> Option<f64> {
    node.number_in(LENGTH_M..=COORDINATE_M, "a length is from 1e-9 to 1e6 metres")
}

/// A point in metres.
pub(crate) fn point(node: &Node) -> Option<[f64; 3]> {
    node.items(|x| x.number_in(-COORDINATE_M..=COORDINATE_M, "a coordinate is from −1e6 to 1e6 metres"))
}

/// A lamp's position: backstage.
pub(crate) fn lamp_position(node: &Node) -> Option<DVec3> {
    let position = point(node)?;
    if position[2] <= -LENGTH_M {
        return Some(position.into());
    }
    node.items::<f64, 3>(|x| if x.path().ends_with("[2]") { behind(x) } else { x.number() })?;
    None
}

fn behind(node: &Node) -> Option<f64> {
    node.number_in(..=-LENGTH_M, "the lamp is backstage, behind the screen (z < 0)")
}

pub(crate) fn radiance(node: &Node) -> Option<[f64; 3]> {
    node.rgb(|x| x.number_in(0.0..=RADIANCE, "a radiance is from 0 to 1e15"))
}

fn share(node: &Node) -> Option<f64> {
    node.number_in(0.0..=1.0, "is a share, between 0 and 1")
}

pub(crate) fn screen(node: &Node, name: &str, loader: &Loader) -> Option<Screen> {
    let mut fields = node.table()?;
    let width_m = fields.need("width_m", "the screen's width in metres", length);
    let height_m = fields.need("height_m", "the screen's height in metres", length);
    let what = "a number, [r, g, b], { image = \"…\" } or { weave = { … } }";
    let albedo = fields.need("albedo", what, |n| {
        if n.is_table() { cloth(n, name, loader, width_m, height_m) } else { uniform(n).map(Albedo::Uniform) }
    });
    fields.done();
    Some(Screen { width_m: width_m?, height_m: height_m?, albedo: albedo? })
}

pub(crate) fn uniform(node: &Node) -> Option<[f64; 3]> {
    node.rgb(|x| x.number_in(0.0..=1.0, "an albedo is between 0 and 1"))
}

/// `{ image = … }` or `{ weave = … }`.
fn cloth(
    node: &Node,
    name: &str,
    loader: &Loader,
    width: Option<f64>,
    height: Option<f64>,
) -> Option<Albedo> {
    let mut fields = node.table()?;
    let image = fields.given("image", "an opaque sRGB picture, stretched over the cloth; or a weave");
    let weave = fields.given("weave", "a cotton cloth; or an image");
    let known = image.is_some() != weave.is_some();
    fields.done();
    if !known {
        return node.refuse("a cloth has either an image or a weave");
    }
    let cloth = match (image, weave) {
        (Some(image), _) => albedo_image(&image, name, loader)?,
        (_, Some(weave)) => Weave::read(&weave)?.rasterise(width?, height?),
        _ => return None,
    };
    Some(Albedo::Image(Arc::new(cloth)))
}

/// An opaque image, linearised as it says.
pub(crate) fn albedo_image(node: &Node, name: &str, loader: &Loader) -> Option<LinearImage> {
    let (_, bytes) = loader.read(name, node, limits::IMAGE_BYTES)?;
    let picture = match Picture::decode(&bytes) {
        Ok(picture) => picture,
        Err(rule) => return node.refuse(rule),
    };
    let (width, height) = (picture.image.width() as usize, picture.image.height() as usize);
    let deep = matches!(
        picture.image,
        DynamicImage::ImageRgb16(_)
            | DynamicImage::ImageRgba16(_)
            | DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
    );
    let linear = match picture.linear(if deep { 1 << 16 } else { 1 << 8 }) {
        Ok(linear) => linear,
        Err(rule) => return node.refuse(rule),
    };
    let opaque = "an albedo image must be opaque: cloth has no alpha";
    let rgb: Vec<_> = if deep {
        let image = picture.image.into_rgba16();
        if image.pixels().any(|p| p.0[3] != u16::MAX) {
            return node.refuse(opaque);
        }
        image.pixels().map(|p| [p.0[0], p.0[1], p.0[2]].map(|c| linear[c as usize])).collect()
    } else {
        let image = picture.image.into_rgba8();
        if image.pixels().any(|p| p.0[3] != u8::MAX) {
            return node.refuse(opaque);
        }
        image.pixels().map(|p| [p.0[0], p.0[1], p.0[2]].map(|c| linear[c as usize])).collect()
    };
    Some(LinearImage::new(width, height, &rgb))
}

/// A picture of light: linear values, EXR or Radiance HDR.
pub(crate) fn picture_light(node: &Node, name: &str, loader: &Loader) -> Option<LinearImage> {
    let (path, bytes) = loader.read(name, node, limits::IMAGE_BYTES)?;
    let decoded = image::ImageReader::new(std::io::Cursor::new(&bytes[..])).with_guessed_format();
    let reader = match decoded {
        Ok(reader)
            if matches!(reader.format(), Some(image::ImageFormat::OpenExr | image::ImageFormat::Hdr)) =>
        {
            reader
        }
        _ => return node.refuse(format!("{} is neither an EXR nor a Radiance HDR", loader.label(&path))),
    };
    let rgb = match reader.decode() {
        Ok(image) => image.into_rgb32f(),
        Err(error) => return node.refuse(format!("{}: {error}", loader.label(&path))),
    };
    let (width, height) = (rgb.width() as usize, rgb.height() as usize);
    if width > limits::IMAGE_SIDE || height > limits::IMAGE_SIDE {
        return node.refuse(format!("a picture has at most {} pixels a side", limits::IMAGE_SIDE));
    }
    let pixels: Vec<[f32; 3]> = rgb.pixels().map(|p| p.0).collect();
    if pixels.iter().flatten().any(|x| !x.is_finite() || *x < 0.0) {
        return node.refuse("radiance is finite and not negative");
    }
    Some(LinearImage::new(width, height, &pixels))
}

/// The lamp's position and its emitters, each as far as it is sound: where puppets may hang depends on the position alone.
pub(crate) fn lamp(node: &Node) -> Option<(Option<DVec3>, Option<Vec<Emitter>>)> {
    let mut fields = node.table()?;
    let position_m = fields.need("position_m", "the lamp's centre [x, y, z] in metres", lamp_position);
    let emitters = fields.need("emitters", "at least one [[lamp.emitters]]", |n| {
        let items = n.array(limits::EMITTERS)?;
        if items.is_empty() {
            return n.refuse("a lamp has at least one emitter");
        }
        let read: Vec<_> = items.iter().map(emitter).collect();
        let emitters: Vec<Emitter> = read.into_iter().collect::<Option<_>>()?;
        let twin = |i: usize| emitters[..i].iter().any(|e| e.name == emitters[i].name);
        let twins: Vec<_> = (0..emitters.len()).filter(|&i| twin(i)).collect();
        for &i in &twins {
            items[i].refuse::<()>(format!(
                "an emitter's name must be unique, and there are two {:?}",
                emitters[i].name
            ));
        }
        twins.is_empty().then_some(emitters)
    });
    fields.done();
    Some((position_m, emitters))
}

fn emitter(node: &Node) -> Option<Emitter> {
    #[derive(Clone, Copy)]
    enum Shape {
        Rectangle,
        Disk,
    }
    let mut fields = node.table()?;
    let name = fields.need("name", "the emitter's name", |n| {
        let name = n.string()?;
        let sound = !name.is_empty()
            && name.len() <= 64
            && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
        if sound {
            Some(name.to_owned())
        } else {
            n.refuse("a name has 1 to 64 ASCII letters, digits, _ or -")
        }
    });
    let shape = fields.need("shape", "\"rectangle\" or \"disk\"", |n| {
        n.choice(&[("rectangle", Shape::Rectangle), ("disk", Shape::Disk)])
    });
    let shape = match shape {
        Some(Shape::Rectangle) => {
            fields.reject("radius_m", "belongs to a disk; a rectangle has size_m");
            fields
                .need("size_m", "the rectangle's sides [width, height] in metres", |n| n.items(length))
                .map(|size_m| EmitterShape::Rectangle { size_m })
        }
        Some(Shape::Disk) => {
            fields.reject("size_m", "belongs to a rectangle; a disk has radius_m");
            fields
                .need("radius_m", "the disk's radius in metres", length)
                .map(|radius_m| EmitterShape::Disk { radius_m })
        }
        None => {
            fields.get("size_m");
            fields.get("radius_m");
            None
        }
    };
    let radiance = fields.need("radiance", "a number or [r, g, b]", radiance);
    fields.done();
    Some(Emitter { name: name?, shape: shape?, radiance: radiance? })
}

pub(crate) fn ambient(node: &Node) -> Option<Ambient> {
    #[derive(Clone, Copy, PartialEq)]
    enum Model {
        None,
        Paper,
        Dome,
    }
    let mut fields = node.table()?;
    let model = fields.need("model", "\"none\", \"paper\" or \"dome\"", |n| {
        n.choice(&[("none", Model::None), ("paper", Model::Paper), ("dome", Model::Dome)])
    });
    if model.is_some_and(|m| m != Model::Paper) {
        fields.reject("k_d_m", "belongs to model = \"paper\"");
        fields.reject("s", "belongs to model = \"paper\"");
    }
    if model.is_some_and(|m| m != Model::Dome) {
        fields.reject("radiance", "belongs to model = \"dome\"");
    }
    let ambient = match model {
        None => {
            ["k_d_m", "s", "radiance"].iter().for_each(|key| drop(fields.get(key)));
            None
        }
        Some(Model::None) => Some(Ambient::None),
        Some(Model::Paper) => {
            let k_d_m =
                fields.need("k_d_m", "the distance in metres at which a shadow has paled fully", length);
            let s = fields.need("s", "the fully paled shadow's share of the lit screen", |n| n.rgb(share));
            k_d_m.zip(s).map(|(k_d_m, s)| Ambient::Paper { k_d_m, s })
        }
        Some(Model::Dome) => {
            let radiance = fields.need("radiance", "the dome's radiance, a number or [r, g, b]", radiance);
            radiance.map(|radiance| Ambient::Dome { radiance })
        }
    };
    fields.done();
    ambient
}

pub(crate) fn exposure(node: &Node) -> Option<Exposure> {
    let mut fields = node.table()?;
    let white = fields.optional(
        "white",
        "\"auto\" or the radiance that is shown as white; without it \"auto\"",
        Exposure::Auto,
        |n| {
            if n.as_str().is_some() {
                return n.choice(&[("auto", Exposure::Auto)]);
            }
            let white =
                n.number_in((Excluded(0.0), Included(RADIANCE)), "white is \"auto\" or a radiance above 0")?;
            Some(Exposure::White(white))
        },
    );
    fields.done();
    white
}
