//! SVG puppets: what is drawn of them is checked, then rasterised part by part.

mod cost;
mod drawn;
mod mend;
mod parts;
mod raster;
mod size;
mod style;
mod text;

use std::collections::HashSet;

use resvg::usvg::roxmltree::Document;
use resvg::usvg::{ImageHrefResolver, Options, Tree};

use self::drawn::{Found, Walk, is_svg};
use self::parts::Group;
use self::raster::Texel;
use self::size::Units;
use self::style::Styles;
use super::grid::{Lattice, Rect, Texture};
use crate::colour::srgb8_to_linear;
use crate::limits;

pub use self::mend::Mended;
pub(crate) use self::mend::mend;

/// A checked SVG.
pub(crate) struct Svg {
    /// The drawing's size in CSS pixels.
    pub size: [f64; 2],
    /// Where its user units lie in them.
    pub units: Units,
    /// What may be a mistake, though it can be drawn.
    pub odd: Vec<String>,
    /// One drawing a part, in the manifest's order: the whole drawing with the other parts hidden.
    trees: Vec<Tree>,
}

impl Svg {
    /// Checks an SVG and splits it into the groups named `parts` (all of it is one part when there are none).
    /// Every problem is handed to `refuse`.
    pub(crate) fn open(bytes: &[u8], parts: &[String], refuse: &mut dyn FnMut(String)) -> Option<Self> {
        let refused = std::cell::Cell::new(false);
        let mut refuse = |rule| {
            refused.set(true);
            refuse(rule);
        };
        if bytes.len() > limits::SVG_BYTES {
            refuse(format!("has {} bytes; an SVG has at most {}", bytes.len(), limits::SVG_BYTES));
            return None;
        }
        let text = text::decode(bytes).map_err(&mut refuse).ok()?;
        let written = text::parse(&text).map_err(&mut refuse).ok()?;
        let unnamed = text::is_unnamed(&written);
        let known = text::understood(&written, &text);
        let document = match &known {
            Some(known) => text::parse(known).map_err(&mut refuse).ok()?,
            None => written,
        };
        if document.root_element().tag_name().name() != "svg" || !is_svg(document.root_element()) {
            refuse("is not an SVG: its root is no <svg> of the SVG namespace".to_owned());
            return None;
        }
        size::check(&document).unwrap_or_else(&mut refuse);
        let styles = Styles::of(&document);
        let elements = document.descendants().filter(|n| n.is_element()).count();
        // Every rule is tried on every element.
        if styles.bytes.saturating_mul(elements) > limits::SVG_STYLING {
            refuse(format!(
                "has {} bytes of <style> for {elements} elements; that is too much",
                styles.bytes
            ));
            return None;
        }
        let found = Walk::over(&document, &styles);
        found.refused.iter().cloned().for_each(&mut refuse);
        twins(&document, parts, &found).into_iter().for_each(&mut refuse);
        let groups = parts::find(&document, &styles, parts, &found, &mut refuse);
        if bytes.len() * groups.len() > limits::SVG_SPLIT_BYTES {
            refuse(format!("has {} bytes in {} parts; that is too much", bytes.len(), groups.len()));
        }
        if refused.get() {
            return None;
        }
        let trees = trees(&document, &groups).map_err(&mut refuse).ok()?;
        let size = trees.first().map(|tree| [tree.size().width(), tree.size().height()].map(f64::from))?;
        let units = Units::of(&document, size).map_err(&mut refuse).ok()?;
        let unnamed = unnamed.then(|| {
            format!("does not say that it is an SVG, so browsers draw nothing of it: write xmlns=\"{}\" into its <svg>", drawn::SVG)
        });
        Some(Self { size, units, odd: unnamed.into_iter().chain(found.odd).collect(), trees })
    }

    /// Whether it can be drawn on `rows` rows with bearable time and memory; the rule that it breaks otherwise.
    pub(crate) fn check_cost(&self, rows: usize) -> Result<(), String> {
        let mut sum = cost::Cost::default();
        for tree in &self.trees {
            sum = sum.and(cost::of_tree(tree, rows));
        }
        sum.check()
    }

    /// The texels that part `part` is drawn on when nothing cuts it off at the drawing's edge; `None` where it does not reach beyond.
    pub(crate) fn reach(&self, part: usize, lattice: &Lattice) -> Option<Rect> {
        let bounds = self.trees[part].root().abs_layer_bounding_box();
        let [left, right] = [bounds.left(), bounds.right()].map(|x| lattice.at([f64::from(x), 0.0])[0]);
        let [top, bottom] = [bounds.top(), bounds.bottom()].map(|y| lattice.at([0.0, f64::from(y)])[1]);
        let rest = lattice.rest();
        let reach = Rect {
            x0: left.floor() as i64,
            y0: top.floor() as i64,
            x1: right.ceil() as i64,
            y1: bottom.ceil() as i64,
        };
        (!reach.is_empty() && rest.union(reach) != rest).then_some(reach)
    }

    /// Opacities α(1 − T) of part `part` on the texels of `within`.
    pub(crate) fn texture(&self, part: usize, lattice: &Lattice, within: Rect, translucent: bool) -> Texture {
        let tree = &self.trees[part];
        let scale = lattice.rows as f64 / f64::from(tree.size().height());
        let shift = [lattice.margin - within.x0 as f64, -within.y0 as f64];
        let texels = raster::draw(tree, scale, shift, [within.width(), within.height()]);
        let linear = srgb8_to_linear();
        Texture::new(within, |x, y| {
            let Texel { colour, alpha } = texels[(y - within.y0) as usize][(x - within.x0) as usize];
            if translucent { colour.map(|c| alpha * (1.0 - linear[c as usize])) } else { [alpha; 3] }
        })
    }
}

/// Two elements of one id, where it matters: something refers to it, or a part is called so.
fn twins(document: &Document, parts: &[String], found: &Found) -> Vec<String> {
    let mut ids = HashSet::new();
    let all = document.descendants().filter_map(|n| n.attribute("id"));
    let matters = |id: &&str| found.referred.contains(*id) || parts.iter().any(|part| part == id);
    let twins: HashSet<&str> = all.filter(matters).filter(|id| !ids.insert(*id)).collect();
    twins.into_iter().map(|id| format!("has two elements of id {id:?}; give one of them another")).collect()
}

/// The whole drawing, or for each group the drawing with all others hidden, by a style sheet that changes nothing else.
fn trees(document: &Document, groups: &[Group]) -> Result<Vec<Tree>, String> {
    if groups.is_empty() {
        return Ok(vec![tree(document, String::new())?]);
    }
    let alone = |own: usize| {
        let others = groups.iter().enumerate().filter(|(k, _)| *k != own);
        tree(document, others.map(|(_, group)| group.hidden.as_str()).collect())
    };
    (0..groups.len()).map(alone).collect()
}

/// Parses with no access to files, fonts or the network.
fn tree(document: &Document, style_sheet: String) -> Result<Tree, String> {
    let options = Options {
        image_href_resolver: ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        style_sheet: (!style_sheet.is_empty()).then_some(style_sheet),
        ..Options::default()
    };
    Tree::from_xmltree(document, &options).map_err(|e| format!("is not an SVG that can be drawn: {e}"))
}
