//! What an SVG may hold, and what it may refer to.

use std::collections::{HashMap, HashSet};

use kelir_reader::{did_you_mean, list};
use resvg::usvg::roxmltree::{Document, Node, NodeId};

use crate::limits;

const SVG: &str = "http://www.w3.org/2000/svg";

/// Elements that are drawn or define what is drawn. All else is refused by name: nothing is dropped in silence.
#[rustfmt::skip]
const ELEMENTS: &[&str] = &[
    "svg", "g", "defs", "title", "desc", "metadata", "style", "path", "rect", "circle", "ellipse", "line", "polyline",
    "polygon", "linearGradient", "radialGradient", "stop", "use", "symbol", "clipPath", "mask",
];
/// Children of the root that draw nothing by themselves.
#[rustfmt::skip]
const UNDRAWN: &[&str] = &[
    "defs", "title", "desc", "metadata", "style", "linearGradient", "radialGradient", "symbol", "clipPath", "mask",
];

/// Only what can be drawn, no images, scripts, text (no fonts are loaded) or references to the outside.
pub(super) fn check_elements(document: &Document, refuse: &mut dyn FnMut(String)) {
    let root = document.root_element();
    if root.tag_name().name() != "svg" || root.tag_name().namespace() != Some(SVG) {
        return refuse("is not an SVG: its root is no <svg> of the SVG namespace".to_owned());
    }
    let mut unknown = HashSet::new();
    let mut ids = HashSet::new();
    let (mut rules, mut elements) = (0usize, 0usize);
    for node in root.descendants().filter(Node::is_element) {
        elements += 1;
        let name = node.tag_name().name();
        let foreign = node.tag_name().namespace() != Some(SVG);
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
            let filtered = name == "filter" || (name == "style" && value.contains("filter"));
            if filtered && value != "none" {
                refuse(format!("has a filter ({value:.60?}), which a puppet can't have"));
            }
        }
        if name == "style" {
            let sheet: Vec<&str> =
                node.descendants().filter(Node::is_text).filter_map(|n| n.text()).collect();
            if sheet.iter().any(|text| text.contains("url(") || text.contains("filter")) {
                refuse(
                    "has url(…) or filter in <style>; write url(…) as an attribute of the element".to_owned(),
                );
            }
            rules += sheet.iter().map(|text| text.len()).sum::<usize>();
        }
    }
    // Every rule is tried on every element.
    if rules.saturating_mul(elements) > limits::SVG_STYLING {
        refuse(format!("has {rules} bytes of <style> for {elements} elements; that is too much"));
    }
}

/// The groups of the named parts in document order; everything that is drawn must be in one of them.
pub(super) fn find_parts(
    document: &Document,
    parts: &[String],
    refuse: &mut dyn FnMut(String),
) -> Vec<NodeId> {
    if parts.is_empty() {
        return Vec::new();
    }
    let mut found = Vec::new();
    let root = document.root_element();
    let groups: Vec<&str> =
        root.children().filter(|n| n.has_tag_name((SVG, "g"))).filter_map(|n| n.attribute("id")).collect();
    for node in root.children().filter(Node::is_element) {
        let name = node.tag_name().name();
        let foreign = node.tag_name().namespace() != Some(SVG);
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
pub(super) fn check_references(document: &Document, parts: &[NodeId], refuse: &mut dyn FnMut(String)) {
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
        // Long paths count for more: what takes long is reading and drawing them.
        let bytes: usize = node.attributes().map(|a| a.value().len()).sum();
        let mut count = 1 + bytes as u64 / 256;
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
