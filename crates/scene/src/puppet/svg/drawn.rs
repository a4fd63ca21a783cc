//! What of an SVG is drawn, and whether it can be: what never is may be whatever it likes.

use std::collections::{BTreeSet, HashMap};

use resvg::usvg::roxmltree::{Document, Node, NodeId};

use super::style::Styles;
use crate::limits;

/// The namespace of SVG.
pub(super) const SVG: &str = "http://www.w3.org/2000/svg";

/// Elements that hold others.
const CONTAINERS: &[&str] = &["svg", "g", "a"];
/// Elements that are shapes.
const SHAPES: &[&str] = &["path", "rect", "circle", "ellipse", "line", "polyline", "polygon"];
/// Elements that draw nothing where they stand: definitions, which others may refer to, and notes.
#[rustfmt::skip]
const UNDRAWN: &[&str] = &[
    "defs", "title", "desc", "metadata", "style", "linearGradient", "radialGradient", "stop", "symbol", "clipPath", "mask", "marker",
    "pattern", "filter", "view", "cursor", "script", "font", "font-face", "color-profile", "animate", "animateColor", "animateMotion",
    "animateTransform", "set", "discard", "mpath", "switch",
];
/// Elements that would be drawn and can't be, with what to do about it.
#[rustfmt::skip]
const REFUSED: &[(&str, &str)] = &[
    ("text", "fonts differ from machine to machine; convert text to paths (Inkscape: Path › Object to Path; Illustrator: Type › Create Outlines)"),
    ("flowRoot", "fonts differ from machine to machine; convert text to paths (Inkscape: Text › Convert to Text, then Path › Object to Path)"),
    ("image", "a puppet is drawn, not photographed; trace it (Inkscape: Path › Trace Bitmap), or name the picture itself as the puppet's image"),
    ("foreignObject", "it is no drawing; delete it, or convert it to paths"),
];
/// Properties that refer to what is drawn with them.
const REFERRING: &[&str] =
    &["fill", "stroke", "clip-path", "mask", "marker-start", "marker-mid", "marker-end"];

/// Whether an element is one of SVG's; editors' notes (`inkscape:…`, `rdf:…`) draw nothing.
pub(super) fn is_svg(node: Node) -> bool {
    node.is_element() && matches!(node.tag_name().namespace(), None | Some(SVG))
}

/// Whether SVG has an element of this name, drawn or not.
pub(super) fn is_known(name: &str) -> bool {
    let refused = || REFUSED.iter().any(|(refused, _)| *refused == name);
    [CONTAINERS, SHAPES, UNDRAWN].iter().any(|names| names.contains(&name)) || name == "use" || refused()
}

/// What was found on a walk over everything that is drawn, each thing once.
#[derive(Default)]
pub(super) struct Found {
    /// Why it can't be drawn.
    pub refused: BTreeSet<String>,
    /// What may be a mistake.
    pub odd: BTreeSet<String>,
    /// Ids that something drawn refers to.
    pub referred: BTreeSet<String>,
}

/// Follows a drawing from its root through all references.
pub(super) struct Walk<'a> {
    styles: &'a Styles<'a>,
    by_id: HashMap<&'a str, Node<'a, 'a>>,
    /// Elements drawn by a node; `None` while it is being counted.
    counts: HashMap<NodeId, Option<u64>>,
    found: Found,
}

impl<'a> Walk<'a> {
    /// Everything that is drawn of `document`.
    pub(super) fn over(document: &'a Document<'a>, styles: &'a Styles<'a>) -> Found {
        let mut by_id = HashMap::new();
        for node in document.descendants() {
            if let Some(id) = node.attribute("id") {
                by_id.entry(id).or_insert(node);
            }
        }
        let mut walk = Self { styles, by_id, counts: HashMap::new(), found: Found::default() };
        let drawn = walk.count(document.root_element(), 0);
        if drawn > limits::SVG_ELEMENTS {
            let most = limits::SVG_ELEMENTS;
            walk.refuse(format!("draws more than {most} elements, references followed; simplify it or export it without patterns and clones"));
        }
        walk.found
    }

    fn refuse(&mut self, rule: String) {
        self.found.refused.insert(rule);
    }

    /// Elements that are drawn where a node stands; itself, what is in it and what it refers to are looked at.
    fn count(&mut self, node: Node<'a, 'a>, depth: usize) -> u64 {
        if !is_svg(node) || self.styles.value(node, "display") == Some("none") || !conditions_hold(node) {
            return 0;
        }
        let name = node.tag_name().name();
        if let Some((_, cure)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
            if self.shows(node) {
                self.refuse(format!("has <{name}>, which a puppet can't have: {cure}"));
            }
            return 1;
        }
        if !is_known(name) {
            self.refuse(format!(
                "has <{name}>, which is none of SVG's elements; delete it, or export as plain SVG"
            ));
            return 1;
        }
        if UNDRAWN.contains(&name) && name != "switch" {
            return 0;
        }
        self.guarded(node, depth, |walk| {
            let filter = walk.styles.value(node, "filter").unwrap_or("none");
            if !matches!(filter, "none" | "inherit" | "initial" | "unset" | "") {
                walk.refuse(format!(
                    "has a filter ({filter:.60?}), which a puppet can't have: delete it (Inkscape: Filters › Remove Filters), or draw what it shows"
                ));
            }
            // Long paths count for more: what takes long is reading and drawing them.
            let bytes: usize = node.attributes().map(|a| a.value().len()).sum();
            let mut count = 1 + bytes as u64 / 256;
            for property in REFERRING {
                for id in walk.urls(node, property) {
                    // A marker is drawn at every vertex.
                    let times = if property.starts_with("marker") { 1 + bytes as u64 / 3 } else { 1 };
                    count = count.saturating_add(walk.target(&id, node, depth).saturating_mul(times));
                }
            }
            if name == "use" {
                count = count.saturating_add(walk.href(node, depth));
            }
            count.saturating_add(match name {
                "switch" => walk.chosen(node).map_or(0, |child| walk.count(child, depth + 1)),
                _ => walk.children(node, depth),
            })
        })
    }

    fn children(&mut self, node: Node<'a, 'a>, depth: usize) -> u64 {
        node.children().map(|child| self.count(child, depth + 1)).fold(0, u64::saturating_add)
    }

    /// Counts a node once, however often it is met, and not within itself.
    fn guarded(&mut self, node: Node<'a, 'a>, depth: usize, count: impl FnOnce(&mut Self) -> u64) -> u64 {
        match self.counts.get(&node.id()) {
            Some(Some(count)) => return *count,
            Some(None) => {
                let id = node.attribute("id").unwrap_or("");
                self.refuse(format!("has an element {id:?} that refers to itself"));
                return 1;
            }
            None => {}
        }
        if depth > limits::SVG_DEPTH {
            self.refuse(format!("is nested deeper than {}; ungroup it", limits::SVG_DEPTH));
            return 1;
        }
        self.counts.insert(node.id(), None);
        let count = count(self);
        self.counts.insert(node.id(), Some(count));
        count
    }

    /// What a definition draws: its children, and what its own properties and those of a definition that it is made from refer to.
    fn definition(&mut self, node: Node<'a, 'a>, depth: usize) -> u64 {
        if !UNDRAWN.contains(&node.tag_name().name()) {
            return self.count(node, depth + 1);
        }
        self.guarded(node, depth, |walk| {
            let mut count = 1u64;
            for property in REFERRING {
                for id in walk.urls(node, property) {
                    count = count.saturating_add(walk.target(&id, node, depth));
                }
            }
            if node.attributes().any(|a| a.name() == "href") {
                count = count.saturating_add(walk.href(node, depth));
            }
            count.saturating_add(walk.children(node, depth))
        })
    }

    fn target(&mut self, id: &str, from: Node<'a, 'a>, depth: usize) -> u64 {
        self.found.referred.insert(id.to_owned());
        match self.by_id.get(id) {
            Some(target) => self.definition(*target, depth + 1),
            None => {
                let name = from.tag_name().name();
                self.found.odd.insert(format!(
                    "refers to #{id:.60} in <{name}>, which it doesn't have: nothing is drawn for it"
                ));
                0
            }
        }
    }

    fn href(&mut self, node: Node<'a, 'a>, depth: usize) -> u64 {
        let hrefs = || node.attributes().filter(|a| a.name() == "href");
        let Some(href) = hrefs().find(|a| a.namespace().is_none()).or_else(|| hrefs().next()) else {
            return 0;
        };
        match href.value().trim().strip_prefix('#') {
            Some(id) => self.target(id, node, depth),
            None => {
                self.refuse(format!(
                    "refers to {:.60?}; only elements of the same file may be referred to: draw it into this file",
                    href.value()
                ));
                0
            }
        }
    }

    /// Ids that a property of the element itself refers to.
    fn urls(&mut self, node: Node<'a, 'a>, property: &str) -> Vec<String> {
        let Some(value) = self.styles.value(node, property) else { return Vec::new() };
        let Some((_, rest)) = value.split_once("url(") else { return Vec::new() };
        let target = rest.split(')').next().unwrap_or("").trim().trim_matches(['"', '\'']).trim();
        match target.strip_prefix('#') {
            Some(id) => vec![id.to_owned()],
            None => {
                self.refuse(format!(
                    "refers to url({target:.60}); only url(#id) is allowed: draw it into this file"
                ));
                Vec::new()
            }
        }
    }

    /// The child of a `<switch>` that is drawn: the first whose conditions hold.
    fn chosen(&self, node: Node<'a, 'a>) -> Option<Node<'a, 'a>> {
        node.children().filter(|n| n.is_element()).find(|n| conditions_hold(*n))
    }

    /// Whether what can't be drawn would be seen if it could: visible, and no text without letters.
    fn shows(&self, node: Node<'a, 'a>) -> bool {
        let hidden = matches!(self.styles.inherited(node, "visibility"), Some("hidden" | "collapse"));
        let letters = || {
            node.descendants().filter(Node::is_text).any(|n| n.text().is_some_and(|t| !t.trim().is_empty()))
        };
        let empty = matches!(node.tag_name().name(), "text" | "flowRoot") && !letters();
        let size = |name: &str| node.attribute(name).is_some_and(|text| text.trim().parse() == Ok(0.0));
        !(hidden || empty || size("width") || size("height"))
    }
}

/// Whether the conditions of an element, if it has any, are those under which it is drawn, as usvg has them.
fn conditions_hold(node: Node) -> bool {
    let english =
        |languages: &str| languages.split(',').any(|tag| tag.trim() == "en" || tag.trim().starts_with("en-"));
    node.attribute("requiredExtensions").is_none() && node.attribute("systemLanguage").is_none_or(english)
}
