//! Reads one `[[stage.lights]]`.

use std::sync::Arc;

use glam::DVec3;
use kelir_reader::{Fields, Node};

use super::super::moving::{Aim, facing};
use super::super::{AreaShape, Environment, Light, LightKind, Pattern, Projector, Slide};
use super::{called, pose};
use crate::fields::{length, picture_light, point, radiance};
use crate::load::Loader;

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Point,
    Directional,
    Rectangle,
    Disk,
    Environment,
    Projector,
}

/// Keys that belong to some kinds alone, and to which.
const OWN: [(&str, &[Kind], &str); 15] = [
    (
        "position_m",
        &[Kind::Point, Kind::Rectangle, Kind::Disk, Kind::Projector],
        "a point, rectangle, disk or projector",
    ),
    ("look_at_m", &[Kind::Rectangle, Kind::Disk, Kind::Projector], "a rectangle, disk or projector"),
    ("up", &[Kind::Rectangle, Kind::Disk, Kind::Projector], "a rectangle, disk or projector"),
    ("intensity", &[Kind::Point, Kind::Projector], "a point or projector"),
    ("direction", &[Kind::Directional], "directional light"),
    ("irradiance", &[Kind::Directional], "directional light"),
    ("angular_radius_deg", &[Kind::Directional], "directional light"),
    ("radiance", &[Kind::Rectangle, Kind::Disk], "a rectangle or disk"),
    ("size_m", &[Kind::Rectangle], "a rectangle"),
    ("radius_m", &[Kind::Disk], "a disk"),
    ("image", &[Kind::Environment], "an environment"),
    ("scale", &[Kind::Environment], "an environment"),
    ("throw_deg", &[Kind::Projector], "a projector"),
    ("falloff", &[Kind::Projector], "a projector"),
    ("slide", &[Kind::Projector], "a projector"),
];

/// A light, and what it looks at.
pub(super) fn light(node: &Node, name: &str, loader: &Loader) -> Option<(Light, Option<Aim>)> {
    let mut fields = node.table()?;
    let called = fields.need("name", "the light's name", called);
    let kind = fields.need(
        "kind",
        "\"point\", \"directional\", \"rectangle\", \"disk\", \"environment\" or \"projector\"",
        |n| {
            n.choice(&[
                ("point", Kind::Point),
                ("directional", Kind::Directional),
                ("rectangle", Kind::Rectangle),
                ("disk", Kind::Disk),
                ("environment", Kind::Environment),
                ("projector", Kind::Projector),
            ])
        },
    );
    for (key, kinds, owners) in OWN {
        match kind {
            Some(kind) if !kinds.contains(&kind) => fields.reject(key, &format!("belongs to {owners}")),
            Some(_) => {}
            None => drop(fields.get(key)),
        }
    }
    let read = kind.and_then(|kind| read(kind, &mut fields, name, loader));
    fields.done();
    let (kind, aim) = read?;
    Some((Light { name: called?, kind }, aim))
}

fn read(kind: Kind, fields: &mut Fields, name: &str, loader: &Loader) -> Option<(LightKind, Option<Aim>)> {
    match kind {
        Kind::Point => {
            let position_m = fields.need("position_m", "where it is, [x, y, z] in metres", point);
            let intensity = fields.need("intensity", "W/sr, a number or [r, g, b]", radiance);
            Some((LightKind::Point { position_m: position_m?.into(), intensity: intensity? }, None))
        }
        Kind::Directional => {
            let direction = fields.need("direction", "where the light goes, [x, y, z]", |n| {
                let to: [f64; 3] =
                    n.items(|x| x.number_in(-1e6..=1e6, "a direction's numbers are from −1e6 to 1e6"))?;
                DVec3::from(to).try_normalize().or_else(|| n.refuse("a direction has a length"))
            });
            let irradiance =
                fields.need("irradiance", "W/m² on a plane that faces it, a number or [r, g, b]", radiance);
            let angular_radius_deg = fields.optional(
                "angular_radius_deg",
                "degrees from its middle to its edge, as 0.27 of the sun; without it 0: shadows have edges",
                0.0,
                |n| n.number_in(0.0..=89.0, "an angular radius is from 0 to 89 degrees"),
            );
            let kind = LightKind::Directional {
                direction: direction?,
                irradiance: irradiance?,
                angular_radius_deg: angular_radius_deg?,
            };
            Some((kind, None))
        }
        Kind::Rectangle | Kind::Disk => {
            let posed = pose::looking(fields, "the lamp");
            let shape = if kind == Kind::Rectangle {
                let size_m = fields.need("size_m", "its [width, height] in metres", |n| n.items(length));
                size_m.map(|size_m| AreaShape::Rectangle { size_m })
            } else {
                let radius_m = fields.need("radius_m", "its radius in metres", length);
                radius_m.map(|radius_m| AreaShape::Disk { radius_m })
            };
            let radiance =
                fields.need("radiance", "W·m⁻²·sr⁻¹ to its front, a number or [r, g, b]", radiance);
            let (pose, aim) = posed?;
            Some((LightKind::Area { pose: facing(pose), shape: shape?, radiance: radiance? }, Some(aim)))
        }
        Kind::Environment => {
            let image = fields.need("image", "an equirectangular picture of radiance, .exr or .hdr", |n| {
                picture_light(n, name, loader)
            });
            let scale = fields.optional(
                "scale",
                "what its values are multiplied by, a number or [r, g, b]; without it 1",
                [1.0; 3],
                radiance,
            );
            Some((LightKind::Environment(Environment { image: Arc::new(image?), scale: scale? }), None))
        }
        Kind::Projector => {
            let posed = pose::looking(fields, "the projector");
            let throw_deg =
                fields.need("throw_deg", "the angle between opposite sides of its square, degrees", |n| {
                    n.number_in(0.1..=170.0, "a throw is from 0.1 to 170 degrees")
                });
            let intensity =
                fields.need("intensity", "W/sr where the slide is 1, a number or [r, g, b]", radiance);
            let falloff = fields.optional(
                "falloff",
                "\"square\": light falls off with the distance's square; \"none\": it does not, as in 2003; without it square",
                true,
                |n| n.choice(&[("square", true), ("none", false)]),
            );
            let slide = fields.need("slide", "what it throws: the [stage.lights.slide] section", |n| {
                slide(n, name, loader)
            });
            let (pose, aim) = posed?;
            let projector = Projector {
                pose,
                throw_deg: throw_deg?,
                intensity: intensity?,
                falloff: falloff?,
                slide: slide?,
            };
            Some((LightKind::Projector(Box::new(projector)), Some(aim)))
        }
    }
}

fn slide(node: &Node, name: &str, loader: &Loader) -> Option<Slide> {
    #[derive(Clone, Copy, PartialEq)]
    enum Kind {
        Spot,
        Sine,
        Checker,
        Noise,
        Image,
    }
    let mut fields = node.table()?;
    let kind = fields.need("pattern", "\"spot\", \"sine\", \"checker\", \"noise\" or \"image\"", |n| {
        n.choice(&[
            ("spot", Kind::Spot),
            ("sine", Kind::Sine),
            ("checker", Kind::Checker),
            ("noise", Kind::Noise),
            ("image", Kind::Image),
        ])
    });
    let waves = kind.is_none_or(|kind| matches!(kind, Kind::Sine | Kind::Checker));
    let patterned = waves || kind == Some(Kind::Noise);
    for (key, belongs, owners) in [
        ("amplitude", patterned, "sine, checker or noise"),
        ("frequency", waves, "sine or checker"),
        ("phase_deg", waves, "sine or checker"),
        ("band", kind.is_none_or(|kind| kind == Kind::Noise), "noise"),
        ("seed", kind.is_none_or(|kind| kind == Kind::Noise), "noise"),
        ("image", kind.is_none_or(|kind| kind == Kind::Image), "image"),
        ("edge", kind != Some(Kind::Image), "patterns, which have a spot around them"),
    ] {
        if !belongs {
            fields.reject(key, &format!("belongs to {owners}"));
        } else if kind.is_none() {
            drop(fields.get(key));
        }
    }
    let frequency = |n: &Node| n.number_in(0.0..=1e4, "a frequency is from 0 to 10000 cycles a side");
    let mut amplitude = || {
        fields.optional("amplitude", "how far it goes from its mean, from 0 to 1; without it 1", 1.0, |n| {
            n.number_in(0.0..=1.0, "an amplitude is from 0 to 1")
        })
    };
    let pattern = match kind {
        None => None,
        Some(Kind::Spot) => Some(Pattern::Spot),
        Some(kind @ (Kind::Sine | Kind::Checker)) => {
            let amplitude = amplitude();
            let frequency =
                fields.need("frequency", "cycles a side, one number or [u, v]", |n| match n.as_number() {
                    Some(_) => frequency(n).map(|f| [f; 2]),
                    None => n.items(frequency),
                });
            let phase_deg = fields.optional(
                "phase_deg",
                "degrees along u and v; without it [0, 0]",
                [0.0; 2],
                pose::angles,
            );
            let (amplitude, frequency, phase_deg) = (amplitude?, frequency?, phase_deg?);
            Some(match kind {
                Kind::Sine => Pattern::Sine { amplitude, frequency, phase_deg },
                _ => Pattern::Checker { amplitude, frequency, phase_deg },
            })
        }
        Some(Kind::Noise) => {
            let amplitude = amplitude();
            let band = fields.need("band", "least and largest frequency, cycles a side", |n| {
                let [low, high]: [f64; 2] = n.items(frequency)?;
                if low <= high { Some([low, high]) } else { n.refuse("the first is the least") }
            });
            let seed = fields.optional("seed", "of its directions and phases; without it 1", 1, |n| {
                n.integer_in(0..=i64::MAX, "a seed is a whole number from 0")
            });
            Some(Pattern::Noise { amplitude: amplitude?, band: band?, seed: seed? as u64 })
        }
        Some(Kind::Image) => fields
            .need("image", "an opaque sRGB picture over the whole square", |n| {
                crate::fields::albedo_image(n, name, loader)
            })
            .map(|image| Pattern::Image(Arc::new(image))),
    };
    let orientation_deg = fields.optional(
        "orientation_deg",
        "turned about its middle, counter-clockwise as the projector sees it; without it 0",
        0.0,
        pose::degrees,
    );
    let edge = if kind == Some(Kind::Image) {
        Some(0.0)
    } else {
        fields.optional(
            "edge",
            "share of the half side over which the spot fades; without it 0.1",
            0.1,
            |n| n.number_in(0.0..=1.0, "a share, from 0 to 1"),
        )
    };
    fields.done();
    Some(Slide::new(pattern?, orientation_deg?, edge?))
}
