//! SVG puppets: checked element by element, then rasterised part by part with resvg.

use std::collections::{HashMap, HashSet};

use resvg::tiny_skia::{Pixmap, PremultipliedColorU8, Transform};
use resvg::usvg::roxmltree::{Document, Node, NodeId, ParsingOptions};
use resvg::usvg::{ImageHrefResolver, Options, Tree};

use super::grid::{Lattice, Rect, Texture};
use crate::colour::srgb8_to_linear;
use crate::limits;
use crate::read::{did_you_mean, list};

/// Elements that are drawn or define what is drawn. All else is refused by name: nothing is dropped in silence.
const ELEMENTS: &[&str] = &[
    "svg",
    "g",
    "defs",
    "title",
    "desc",
    "metadata",
    "style",
    "path",
    "rect",
    "circle",
    "ellipse",
    "line",
    "polyline",
    "polygon",
    "linearGradient",
    "radialGradient",
    "stop",
    "use",
    "symbol",
    "clipPath",
    "mask",
    "pattern",
];
/// Children of the root that draw nothing by themselves.
const UNDRAWN: &[&str] = &[
    "defs",
    "title",
    "desc",
    "metadata",
    "style",
    "linearGradient",
    "radialGradient",
    "symbol",
    "clipPath",
    "mask",
    "pattern",
];

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
    pub fn open(bytes: &[u8], parts: &[String], refuse: &mut dyn FnMut(String)) -> Option<Self> {
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

    /// Opacities α(1 − T) of part `part` on the lattice.
    pub fn texture(&self, part: usize, lattice: &Lattice, translucent: bool) -> Texture {
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

/// Only what can be drawn, no images, scripts, text (no fonts are loaded) or references to the outside.
fn check_elements(document: &Document, refuse: &mut dyn FnMut(String)) {
    let root = document.root_element();
    if root.tag_name().name() != "svg" || root.tag_name().namespace() != Some("http://www.w3.org/2000/svg") {
        return refuse("is not an SVG: its root is no <svg> of the SVG namespace".to_owned());
    }
    let mut unknown = HashSet::new();
    let mut ids = HashSet::new();
    for node in root.descendants().filter(Node::is_element) {
        let name = node.tag_name().name();
        let foreign = node.tag_name().namespace() != Some("http://www.w3.org/2000/svg");
        if foreign {
            // Editors' notes (inkscape:…, rdf:…) draw nothing.
            continue;
        }
        let nested = name == "svg" && node != root;
        if (nested || !ELEMENTS.contains(&name)) && unknown.insert(name.to_owned()) {
            let hint = if name == "text" { "; convert text to paths" } else { "" };
            refuse(format!("has <{name}>, which a puppet can't have{hint}"));
        }
        if let Some(id) = node.attribute("id")
            && !ids.insert(id)
        {
            refuse(format!("has two elements of id {id:?}"));
        }
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            if name == "href" && !value.starts_with('#') {
                refuse(format!("refers to {value:.60?}; only elements of the same file may be referred to"));
            }
            if name == "stroke-dasharray" && value != "none" && dashes(value) > 0.0 && dashes(value) < 0.1 {
                refuse(format!(
                    "has stroke-dasharray = {value:.60?}; dashes must be at least 0.1 units in all"
                ));
            }
        }
        if name == "style" && node.descendants().filter_map(|n| n.text()).any(|t| t.contains("url(")) {
            refuse("has url(…) in <style>; write it as an attribute of the element".to_owned());
        }
    }
}

fn dashes(text: &str) -> f64 {
    text.split(|c: char| c.is_whitespace() || c == ',').filter_map(|s| s.parse::<f64>().ok()).sum()
}

/// The groups of the named parts in document order; everything that is drawn must be in one of them.
fn find_parts(document: &Document, parts: &[String], refuse: &mut dyn FnMut(String)) -> Vec<NodeId> {
    if parts.is_empty() {
        return Vec::new();
    }
    let mut found = Vec::new();
    let root = document.root_element();
    let groups: Vec<&str> = root
        .children()
        .filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "g")))
        .filter_map(|n| n.attribute("id"))
        .collect();
    for node in root.children().filter(Node::is_element) {
        let name = node.tag_name().name();
        let foreign = node.tag_name().namespace() != Some("http://www.w3.org/2000/svg");
        if foreign || UNDRAWN.contains(&name) {
            continue;
        }
        match node.attribute("id").filter(|id| name == "g" && parts.iter().any(|p| p == id)) {
            Some(_) => found.push(node.id()),
            None => {
                let id = node.attribute("id").unwrap_or("");
                refuse(format!("has <{name} id={id:?}> outside the manifest's parts ({})", list(parts)));
            }
        }
    }
    for part in parts.iter().filter(|p| !groups.contains(&p.as_str())) {
        let hint = did_you_mean(part, &groups);
        refuse(format!(
            "has no <g id={part:?}> directly under <svg>{hint}; its groups are {}",
            list(&groups)
        ));
    }
    found
}

/// References must resolve, not go in circles, not reach into another part, and not multiply beyond the limit.
fn check_references(document: &Document, parts: &[NodeId], refuse: &mut dyn FnMut(String)) {
    let by_id: HashMap<&str, Node> =
        document.descendants().filter_map(|n| n.attribute("id").map(|id| (id, n))).collect();
    let mut walk = Walk { by_id, counts: HashMap::new(), refused: HashSet::new(), parts };
    let drawn = walk.count(document.root_element(), 0);
    let mut refused: Vec<_> = walk.refused.into_iter().collect();
    refused.sort();
    refused.into_iter().for_each(&mut *refuse);
    if drawn > limits::SVG_ELEMENTS {
        refuse(format!("draws more than {} elements, references followed", limits::SVG_ELEMENTS));
    }
}

struct Walk<'a, 'i> {
    by_id: HashMap<&'a str, Node<'a, 'i>>,
    /// Elements drawn by a node; `None` while it is being counted.
    counts: HashMap<NodeId, Option<u64>>,
    refused: HashSet<String>,
    parts: &'a [NodeId],
}

impl<'a, 'i> Walk<'a, 'i> {
    fn count(&mut self, node: Node<'a, 'i>, depth: usize) -> u64 {
        match self.counts.get(&node.id()) {
            Some(Some(count)) => return *count,
            Some(None) => {
                let id = node.attribute("id").unwrap_or("");
                self.refused.insert(format!("has an element {id:?} that refers to itself"));
                return 1;
            }
            None => {}
        }
        if depth > limits::SVG_DEPTH {
            self.refused.insert(format!("is nested deeper than {}", limits::SVG_DEPTH));
            return 1;
        }
        self.counts.insert(node.id(), None);
        let mut count = 1u64;
        for target in self.targets(node) {
            count = count.saturating_add(self.count(target, depth + 1));
        }
        for child in node.children().filter(Node::is_element) {
            count = count.saturating_add(self.count(child, depth + 1));
        }
        self.counts.insert(node.id(), Some(count));
        count
    }

    /// What a node refers to by href or url(#…).
    fn targets(&mut self, node: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
        let mut targets = Vec::new();
        for attribute in node.attributes() {
            let value = attribute.value();
            let mut ids = Vec::new();
            if attribute.name() == "href" {
                ids.extend(value.strip_prefix('#'));
            }
            for rest in value.split("url(").skip(1) {
                let target = rest.split(')').next().unwrap_or("").trim().trim_matches(['"', '\'']).trim();
                match target.strip_prefix('#') {
                    Some(id) => ids.push(id),
                    None => {
                        self.refused.insert(format!("refers to url({target:.60}); only url(#id) is allowed"));
                    }
                }
            }
            for id in ids {
                let Some(&target) = self.by_id.get(id) else {
                    self.refused.insert(format!("refers to #{id:.60}, which it doesn't have"));
                    continue;
                };
                let part_of = |n: Node| n.ancestors().map(|a| a.id()).find(|a| self.parts.contains(a));
                if let Some(theirs) = part_of(target)
                    && part_of(node) != Some(theirs)
                {
                    self.refused
                        .insert(format!("refers to #{id:.60} inside another part; move it to <defs>"));
                }
                targets.push(target);
            }
        }
        targets
    }
}
