//! Reads one `[[puppets]]` entry and the files it names.

use glam::DVec3;
use kelir_reader::{Node, did_you_mean, list};

use super::bitmap::{AlphaFrom, Bitmap};
use super::figure::{Figure, Pose};
use super::grid::{Lattice, Texture};
use super::manifest::{Manifest, Part};
use super::svg::Svg;
use crate::fields::{length, point};
use crate::limits;
use crate::load::Loader;
use crate::staging::{Puppet, Setting};

/// A puppet as the file has it, with what later messages need.
pub(crate) struct Entry<'a> {
    pub node: Node<'a>,
    pub position: Option<Node<'a>>,
    pub tilt: Option<Node<'a>>,
    pub setting: Setting,
    /// Which parts its `pose` names.
    pub posed: Vec<bool>,
    pub puppet: Puppet,
}

enum Drawing {
    Svg(Svg),
    Bitmap(Bitmap),
}

struct Art {
    drawing: Drawing,
    parts: Vec<Part>,
}

pub(crate) fn degrees(node: &Node) -> Option<f64> {
    node.number_in(-limits::DEGREES..=limits::DEGREES, "an angle is from −1e6 to 1e6 degrees")
}

pub(crate) fn tilt(node: &Node) -> Option<[f64; 2]> {
    let rule = "a tilt is between −90 and 90 degrees, without these";
    node.items(|x| {
        let tilt = x.number_in(-90.0..=90.0, rule)?;
        if tilt.abs() < 90.0 { Some(tilt) } else { x.refuse(rule) }
    })
}

/// A pose of `part` in degrees, within its limits.
pub(crate) fn pose_deg(node: &Node, part: &Part) -> Option<f64> {
    if part.pivot.is_none() {
        return node
            .refuse(format!("part {:?} has no pivot in the puppet's manifest to turn about", part.id));
    }
    let value = degrees(node)?;
    match part.limits_deg {
        Some([least, most]) if !(least..=most).contains(&value) => {
            node.refuse(format!("part {:?} turns from {least} to {most} degrees", part.id))
        }
        _ => Some(value),
    }
}

/// The index of the part of that name; refused with the known ones otherwise.
pub(crate) fn find_part(node: &Node, name: &str, parts: &[Part]) -> Option<usize> {
    let ids: Vec<&str> = parts.iter().map(|p| p.id.as_str()).collect();
    match ids.iter().position(|id| *id == name) {
        Some(index) => Some(index),
        None if ids.is_empty() => node.refuse("this puppet has no parts: only a puppet manifest names parts"),
        None => node.refuse(format!("no such part{}; parts are {}", did_you_mean(name, &ids), list(&ids))),
    }
}

/// Reads a puppet; `name` is the scene's path from the root.
pub(crate) fn read<'a>(node: &Node<'a>, name: &str, loader: &Loader) -> Option<Entry<'a>> {
    let mut fields = node.table()?;
    let (mut image, mut image_node) = (None, None);
    let art = fields.need("image", "the path of an SVG, a PNG or a puppet manifest", |n| {
        image = n.as_str().map(str::to_owned);
        image_node = Some(n.clone());
        open(n, name, loader)
    });
    let height_m = fields.need("height_m", "the puppet's height in metres", length);
    let mut position = None;
    let position_m = fields.need("position_m", "the puppet's centre [x, y, z] in metres", |n| {
        position = Some(n.clone());
        point(n)
    });
    let translucent = fields.optional(
        "translucent",
        "whether the image's colour is what it lets through; without it false",
        false,
        |n| n.boolean(),
    );
    let alpha_from = fields.given(
        "alpha_from",
        "what a scan without alpha is opaque by: \"luminance\", as dark as it is, or the luminance below which it is; without it its alpha",
    );
    let alpha = alpha_from.as_ref().map_or(Some(None), |n| AlphaFrom::read(n).map(Some));
    let rotate_deg =
        fields.optional("rotate_deg", "turn in its plane, counter-clockwise; without it 0", 0.0, degrees);
    let tilt_node = fields.given("tilt_deg", "turn about x, then about y; without it [0, 0]");
    let tilt_deg = tilt_node.as_ref().map_or(Some([0.0; 2]), tilt);
    let parts = art.as_ref().map(|a| a.parts.as_slice());
    let pose = fields.optional(
        "pose",
        "part = degrees about its pivot, counter-clockwise; parts that are not named rest, cut at the drawing's edge",
        vec![None; parts.map_or(0, <[Part]>::len)],
        |n| read_pose(n, parts),
    );
    let texels = fields.given("texels", "rows of its grid at rest; without it 1024, or a PNG's own");
    let rows = texels.as_ref().map_or(Some(None), |n| {
        let rule = "a puppet's grid has 64 to 8192 rows";
        n.integer_in(64..=limits::IMAGE_SIDE as i64, rule).map(|rows| Some(rows as usize))
    });
    let bits = fields.optional(
        "bits",
        "bits a texel, 8 or 16; without it 8, or 16 where 8 would miss a hundredth of what the puppet covers",
        None,
        |n| match n.integer()? {
            bits @ (8 | 16) => Some(Some(bits as u32)),
            _ => n.refuse("a mask has 8 or 16 bits"),
        },
    );
    fields.done();

    let (art, height_m, translucent, bits) = (art?, height_m?, translucent?, bits?);
    let image_node = image_node?;
    let lattice = lattice(node, texels.as_ref().unwrap_or(node), &art, rows?)?;
    let alpha = alpha?;
    match (&art.drawing, &alpha_from) {
        (Drawing::Svg(_), Some(node)) => return node.refuse("belongs to a PNG or JPEG: an SVG draws what is opaque"),
        (Drawing::Bitmap(bitmap), None) if !translucent && bitmap.is_opaque() => image_node.warn(
            "has no transparent texel and casts the shadow of its rectangle: is this a scan without alpha? alpha_from = \"luminance\" lets \
             through what is bright, alpha_from = 0.5 what is brighter than that",
        ),
        _ => {}
    }
    let figure = rasterise(&image_node, &art, lattice, Surface { translucent, alpha, bits })?;
    let pose = pose?;
    let parts_deg = pose.iter().map(|degrees| degrees.unwrap_or(0.0)).collect();
    let setting = Setting {
        position_m: DVec3::from(position_m?),
        tilt_deg: tilt_deg?,
        pose: Pose { parts_deg, rotate_deg: rotate_deg? },
    };
    let posed = pose.iter().map(Option::is_some).collect();
    let texel_m = height_m / lattice.rows as f64;
    let puppet = Puppet { image: image?, parts: art.parts, figure, texel_m };
    Some(Entry { node: node.clone(), position, tilt: tilt_node, setting, posed, puppet })
}

/// `{ part = degrees }`; without a known puppet only the values' types are checked.
fn read_pose(node: &Node, parts: Option<&[Part]>) -> Option<Vec<Option<f64>>> {
    let entries = node.entries(limits::PARTS)?;
    let Some(parts) = parts else {
        entries.iter().for_each(|(_, value)| {
            degrees(value);
        });
        return None;
    };
    let mut pose = vec![None; parts.len()];
    let mut sound = true;
    for (name, value) in entries {
        match find_part(&value, name, parts).and_then(|p| Some((p, pose_deg(&value, &parts[p])?))) {
            Some((part, degrees)) => pose[part] = Some(degrees),
            None => sound = false,
        }
    }
    sound.then_some(pose)
}

/// Opens an SVG, a PNG or a manifest, told apart by the path's end.
fn open(node: &Node, from: &str, loader: &Loader) -> Option<Art> {
    if !node.string()?.to_ascii_lowercase().ends_with(".toml") {
        return Some(Art { drawing: open_image(node, from, &[], loader)?, parts: Vec::new() });
    }
    let (path, bytes) = loader.read(from, node, limits::MANIFEST_BYTES)?;
    let Ok(text) = std::str::from_utf8(&bytes) else { return node.refuse("is not UTF-8 text") };
    let label = loader.label(&path);
    loader.reading.source(&label, text).read(|root| {
        let manifest = Manifest::read(root)?;
        let ids: Vec<String> = manifest.parts.iter().map(|p| p.id.clone()).collect();
        let drawing = open_image(&manifest.image, &path, &ids, loader)?;
        if matches!(drawing, Drawing::Bitmap(_)) && !ids.is_empty() {
            return manifest.image.refuse("a PNG has no groups: parts need an SVG");
        }
        Some(Art { drawing, parts: manifest.parts })
    })
}

fn open_image(node: &Node, from: &str, parts: &[String], loader: &Loader) -> Option<Drawing> {
    let path = node.string()?.to_ascii_lowercase();
    if path.ends_with(".svg") {
        let (_, bytes) = loader.read(from, node, limits::SVG_BYTES)?;
        let mut refuse = |rule: String| {
            node.refuse::<()>(rule);
        };
        let svg = Svg::open(&bytes, parts, &mut refuse)?;
        svg.odd.iter().for_each(|odd| node.warn(odd));
        return Some(Drawing::Svg(svg));
    }
    if path.ends_with(".png") {
        let (_, bytes) = loader.read(from, node, limits::IMAGE_BYTES)?;
        return match Bitmap::open(&bytes) {
            Ok(bitmap) => Some(Drawing::Bitmap(bitmap)),
            Err(rule) => node.refuse(rule),
        };
    }
    node.refuse("a puppet's image is an .svg, a .png or a .toml puppet manifest")
}

/// The puppet's grid at rest; `rows` defaults to a PNG's own and to 1024 for an SVG.
fn lattice(node: &Node, texels: &Node, art: &Art, rows: Option<usize>) -> Option<Lattice> {
    let (size, own_rows) = match &art.drawing {
        Drawing::Svg(svg) => (svg.size, 1024),
        Drawing::Bitmap(bitmap) => (bitmap.size().map(|s| s as f64), bitmap.size()[1]),
    };
    let rows = rows.unwrap_or(own_rows);
    let columns = (size[0] / size[1] * rows as f64).ceil();
    if columns > limits::IMAGE_SIDE as f64 {
        let rule = format!("the grid would have {columns} columns; at most {}", limits::IMAGE_SIDE);
        return texels.refuse(rule);
    }
    if let Drawing::Svg(svg) = &art.drawing
        && let Err(rule) = svg.check_cost(rows)
    {
        return texels.refuse(rule);
    }
    let lattice = Lattice::new(size, rows);
    let mut all = lattice.columns * lattice.rows * art.parts.len().max(1);
    if let Drawing::Svg(svg) = &art.drawing {
        for part in (0..art.parts.len()).filter(|part| turns(&art.parts, *part)) {
            let beyond = svg.reach(part, &lattice).map_or(0, |reach| reach.area());
            if beyond > limits::PART_TEXELS {
                let id = &art.parts[part].id;
                return node.refuse(format!("part {id:?} reaches far beyond the drawing's edge, and it turns; cut it off, or let it not turn"));
            }
            all = all.saturating_add(beyond);
        }
    }
    if all > limits::PART_TEXELS {
        let rule = format!("{} parts of {} × {rows} texels are too many", art.parts.len(), lattice.columns);
        return node
            .refuse(format!("{rule}; all parts together have at most {} texels", limits::PART_TEXELS));
    }
    Some(lattice)
}

/// Whether a pose may turn a part: by its own pivot, or by that of what it hangs on.
fn turns(parts: &[Part], part: usize) -> bool {
    std::iter::successors(Some(part), |p| parts.get(*p)?.parent).any(|p| parts[p].pivot.is_some())
}

/// The share of a puppet's opacity that its codes may miss.
const MISSED: f64 = 0.01;

/// How a drawing's alpha and colours become texels.
struct Surface {
    translucent: bool,
    alpha: Option<AlphaFrom>,
    /// Of a texel's codes, if it was said.
    bits: Option<u32>,
}

fn rasterise(image: &Node, art: &Art, lattice: Lattice, surface: Surface) -> Option<Figure> {
    let Surface { translucent, alpha, bits } = surface;
    let mut parts = art.parts.clone();
    let textures: Vec<(Texture, Option<Texture>)> = match &art.drawing {
        Drawing::Svg(svg) => {
            let pivot = |[x, y]: [f64; 2]| lattice.at(svg.units.pixel([x, y]));
            parts.iter_mut().for_each(|part| part.pivot = part.pivot.map(pivot));
            let drawn = |part: usize| {
                let reach =
                    svg.reach(part, &lattice).filter(|_| !art.parts.is_empty() && turns(&art.parts, part));
                let whole = reach.map(|reach| svg.texture(part, &lattice, reach, translucent));
                (svg.texture(part, &lattice, lattice.rest(), translucent), whole)
            };
            (0..art.parts.len().max(1)).map(drawn).collect()
        }
        Drawing::Bitmap(bitmap) => match bitmap.texture(&lattice, translucent, alpha) {
            Ok(texture) => vec![(texture, None)],
            Err(rule) => return image.refuse(rule),
        },
    };
    let is_empty = |(texture, whole): &(Texture, Option<Texture>)| {
        texture.rect.is_empty() && whole.as_ref().is_none_or(|whole| whole.rect.is_empty())
    };
    if textures.iter().all(is_empty) {
        return image.refuse("the image draws nothing: it is clear everywhere");
    }
    for (part, _) in art.parts.iter().zip(&textures).filter(|(_, texture)| is_empty(texture)) {
        image.warn(format!(
            "part {:?} draws nothing: it is hidden or empty, and its pose does nothing",
            part.id
        ));
    }
    let all = || textures.iter().flat_map(|(texture, whole)| std::iter::once(texture).chain(whole));
    let misses = all().any(|texture| texture.missed::<u8>() > MISSED);
    if misses && bits == Some(8) {
        image.warn("has threads so thin, or tones so faint, that 8 bits a texel miss more than a hundredth of what they cover; say bits = 16, or leave bits out");
    }
    Some(Figure::new(lattice, &parts, textures, bits.unwrap_or(if misses { 16 } else { 8 })))
}
