//! SVG puppets: checked element by element, then rasterised part by part with resvg.

mod check;
mod cost;

use resvg::tiny_skia::{Pixmap, PremultipliedColorU8, Transform};
use resvg::usvg::roxmltree::{Document, ParsingOptions};
use resvg::usvg::{ImageHrefResolver, Options, Tree};

use self::check::{check_elements, check_references, find_parts};
use super::grid::{Lattice, Rect, Texture};
use crate::colour::srgb8_to_linear;
use crate::limits;

/// A checked SVG.
pub(crate) struct Svg {
    /// The drawing's size in user units.
    pub size: [f64; 2],
    /// User coordinates of its top left corner.
    pub origin: [f64; 2],
    /// One drawing a part, in drawing order.
    trees: Vec<Tree>,
}

impl Svg {
    /// Checks an SVG and splits it into the groups named `parts` (all of it is one part when there are none).
    /// Every problem is handed to `refuse`.
    pub(crate) fn open(bytes: &[u8], parts: &[String], refuse: &mut dyn FnMut(String)) -> Option<Self> {
        if bytes.len() > limits::SVG_BYTES {
            refuse(format!("has {} bytes; an SVG has at most {}", bytes.len(), limits::SVG_BYTES));
            return None;
        }
        let Ok(text) = std::str::from_utf8(bytes) else {
            refuse("is not UTF-8 text".to_owned());
            return None;
        };
        // Without a document type there are no entities, neither exploding nor external ones.
        let options =
            ParsingOptions { nodes_limit: 4 * limits::SVG_ELEMENTS as u32, ..ParsingOptions::default() };
        let document = match Document::parse_with_options(text, options) {
            Ok(document) => document,
            Err(error) => {
                refuse(format!("is not an SVG: {error}"));
                return None;
            }
        };
        let refused = std::cell::Cell::new(false);
        let mut refuse = |rule| {
            refused.set(true);
            refuse(rule);
        };
        check_elements(&document, &mut refuse);
        let groups = find_parts(&document, parts, &mut refuse);
        check_references(&document, &groups, &mut refuse);
        if refused.get() {
            return None;
        }
        if bytes.len() * groups.len() > limits::SVG_SPLIT_BYTES {
            refuse(format!("has {} bytes in {} parts; that is too much", bytes.len(), groups.len()));
            return None;
        }
        let view = View::of(&document).map_err(&mut refuse).ok()?;
        let mut trees = Vec::new();
        for own in 0..groups.len().max(1) {
            // Each part is the document without the other parts, so that styles, definitions and view box hold as written.
            let mut alone = String::with_capacity(text.len());
            let mut at = 0;
            for (k, group) in groups.iter().enumerate().filter(|(k, _)| *k != own) {
                let range = document.get_node(*group).map_or(at..at, |n| n.range());
                debug_assert!(range.start >= at, "groups {k} come in document order");
                alone.push_str(&text[at..range.start]);
                at = range.end;
            }
            alone.push_str(&text[at..]);
            match tree(&alone) {
                Ok(tree) => trees.push(tree),
                Err(rule) => refuse(rule),
            }
        }
        if refused.get() || trees.is_empty() {
            return None;
        }
        // `groups` is in document order, the manifest's order is the drawing order.
        let mut order: Vec<(usize, Tree)> = match parts {
            [] => vec![(0, trees.remove(0))],
            _ => {
                let ids = groups.iter().map(|g| document.get_node(*g).and_then(|n| n.attribute("id")));
                let rank = |id: Option<&str>| parts.iter().position(|p| Some(p.as_str()) == id).unwrap_or(0);
                ids.map(rank).zip(trees).collect()
            }
        };
        order.sort_by_key(|(rank, _)| *rank);
        let trees = order.into_iter().map(|(_, tree)| tree).collect();
        Some(Self { size: view.size, origin: view.origin, trees })
    }

    /// Whether it can be drawn on `rows` rows with bearable time and memory; the rule that it breaks otherwise.
    pub(crate) fn check_cost(&self, rows: usize) -> Result<(), String> {
        let mut sum = cost::Cost::default();
        for tree in &self.trees {
            sum = sum.and(cost::of_tree(tree, rows));
        }
        sum.check()
    }

    /// Opacities α(1 − T) of part `part` on the lattice.
    pub(crate) fn texture(&self, part: usize, lattice: &Lattice, translucent: bool) -> Texture {
        let tree = &self.trees[part];
        let scale = lattice.rows as f32 / tree.size().height();
        let transform = Transform::from_row(scale, 0.0, 0.0, scale, lattice.margin as f32, 0.0);
        let mut pixmap =
            Pixmap::new(lattice.columns as u32, lattice.rows as u32).expect("a checked grid has texels");
        resvg::render(tree, transform, &mut pixmap.as_mut());
        let pixels = pixmap.pixels();
        let linear = srgb8_to_linear();
        let opacity = |p: PremultipliedColorU8| {
            let alpha = f32::from(p.alpha()) / 255.0;
            if !translucent || p.alpha() == 0 {
                return [alpha; 3];
            }
            let colour = p.demultiply();
            [colour.red(), colour.green(), colour.blue()].map(|c| alpha * (1.0 - linear[c as usize]))
        };
        let within = Rect::of_size(lattice.columns, lattice.rows);
        Texture::new(within, |x, y| opacity(pixels[y as usize * lattice.columns + x as usize]))
    }
}

/// Parses with no access to files, fonts or the network.
fn tree(text: &str) -> Result<Tree, String> {
    let options = Options {
        image_href_resolver: ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..Options::default()
    };
    let document = Document::parse(text).map_err(|e| format!("is not an SVG: {e}"))?;
    Tree::from_xmltree(&document, &options).map_err(|e| format!("is not an SVG that can be drawn: {e}"))
}

/// The view box, which must have the aspect of `width` and `height` where those are given.
struct View {
    origin: [f64; 2],
    size: [f64; 2],
}

impl View {
    fn of(document: &Document) -> Result<Self, String> {
        let root = document.root_element();
        let length = |name: &str| -> Result<Option<f64>, String> {
            let Some(text) = root.attribute(name) else { return Ok(None) };
            let number = text.trim().trim_end_matches("px").trim_end_matches("mm").trim();
            match number.parse::<f64>() {
                Ok(value) if value.is_finite() && value > 0.0 => Ok(Some(value)),
                _ => Err(format!("has {name} = {text:?}; it must be a positive number, px or mm")),
            }
        };
        let (width, height) = (length("width")?, length("height")?);
        let Some(text) = root.attribute("viewBox") else {
            return match (width, height) {
                (Some(width), Some(height)) => Ok(Self { origin: [0.0; 2], size: [width, height] }),
                _ => Err("has neither a viewBox nor width and height".to_owned()),
            };
        };
        let numbers: Vec<f64> = text
            .split(|c: char| c.is_whitespace() || c == ',')
            .filter(|s| !s.is_empty())
            .map(|s| s.parse().unwrap_or(f64::NAN))
            .collect();
        let &[x, y, w, h] = numbers.as_slice() else {
            return Err(format!("has viewBox = {text:?}; it must be four numbers"));
        };
        if !(numbers.iter().all(|n| n.abs() <= 1e6) && w >= 1e-3 && h >= 1e-3) {
            return Err(format!(
                "has viewBox = {text:?}; its size must be positive and its numbers at most 1e6"
            ));
        }
        if let (Some(width), Some(height)) = (width, height)
            && (width / height - w / h).abs() > 1e-3 * w / h
        {
            return Err(format!("has a viewBox of aspect {} but width/height of {}", w / h, width / height));
        }
        if width.is_some() != height.is_some() {
            return Err("has only one of width and height beside its viewBox; give both or none".to_owned());
        }
        Ok(Self { origin: [x, y], size: [w, h] })
    }
}
