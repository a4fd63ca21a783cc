//! The groups of an SVG that a manifest names as its parts.

use kelir_reader::{did_you_mean, list};
use resvg::usvg::roxmltree::{Document, Node, NodeId};

use super::drawn::{Found, SVG, is_svg};
use super::style::Styles;

/// Elements that hold parts beside that themselves.
const HOLDERS: &[&str] = &["svg", "g", "a", "switch"];
/// Elements that are drawn.
const DRAWN: &[&str] = &["path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "use"];

/// The group of one part.
#[derive(Clone, Debug)]
pub(super) struct Group {
    node: NodeId,
    /// The style sheet's rule by which it is not drawn, whatever else is said of it.
    pub hidden: String,
}

/// The name that an editor shows for a layer.
fn label<'a>(node: Node<'a, 'a>) -> Option<&'a str> {
    node.attributes()
        .find(|a| a.name() == "label" && a.namespace().is_some_and(|n| n.contains("inkscape")))
        .map(|a| a.value())
}

/// The groups of `parts` in their order, by id or else by the label that Inkscape shows for a layer; whatever is drawn must be in one of them.
pub(super) fn find<'a>(
    document: &'a Document<'a>,
    styles: &Styles<'a>,
    parts: &[String],
    found: &Found,
    refuse: &mut dyn FnMut(String),
) -> Vec<Group> {
    if parts.is_empty() {
        return Vec::new();
    }
    let root = document.root_element();
    let groups: Vec<Node> =
        root.descendants().filter(|n| n.has_tag_name((SVG, "g")) || n.has_tag_name("g")).collect();
    let mut all = Vec::new();
    for part in parts {
        let by_id = |n: &&Node| n.attribute("id") == Some(part);
        let by_label = |n: &&Node| label(**n) == Some(part);
        let of: Vec<&Node> = match groups.iter().any(|n| by_id(&n)) {
            true => groups.iter().filter(by_id).collect(),
            false => groups.iter().filter(by_label).collect(),
        };
        match of[..] {
            [] => refuse(missing(part, root, &groups)),
            [node] => {
                let key = if by_id(&node) { "id" } else { "label" };
                let quote = if part.contains('"') { '\'' } else { '"' };
                let hidden = format!("[{key}={quote}{part}{quote}]{{display:none !important}}\n");
                all.push(Group { node: node.id(), hidden });
            }
            _ => refuse(format!(
                "has {} groups {part:?}; a part is one group: give the others other names",
                of.len()
            )),
        }
    }
    let nodes: Vec<NodeId> = all.iter().map(|group| group.node).collect();
    let is_part = |node: Node| nodes.contains(&node.id());
    for group in groups.iter().filter(|n| is_part(**n)) {
        let name = |node: Node<'a, 'a>| node.attribute("id").or(label(node)).unwrap_or_default();
        if let Some(outer) = group.ancestors().skip(1).find(|n| is_part(*n)) {
            refuse(format!(
                "has part {:?} within part {:?}; parts stand beside each other, and the manifest's `parent` says what carries what: move it out of that group",
                name(*group),
                name(outer)
            ));
        }
        // An instance of a hidden group would be hidden with it.
        if let Some(id) =
            group.ancestors().filter_map(|n| n.attribute("id")).find(|id| found.referred.contains(*id))
        {
            refuse(format!(
                "refers to #{id}, which is a part or holds one; refer to what is in it, or move that to <defs>"
            ));
        }
    }
    let mut stray = |node: Node<'a, 'a>| {
        let (name, id) = (node.tag_name().name(), node.attribute("id").or(label(node)).unwrap_or(""));
        refuse(format!(
            "has <{name} id={id:?}> outside the manifest's parts ({}); move it into one of their groups, or give it a part of its own",
            list(parts)
        ));
    };
    beside(root, styles, &is_part, &mut stray);
    all
}

/// Hands out what is drawn beside the parts.
fn beside<'a>(
    node: Node<'a, 'a>,
    styles: &Styles<'a>,
    is_part: &dyn Fn(Node) -> bool,
    stray: &mut dyn FnMut(Node<'a, 'a>),
) {
    for child in node.children().filter(|n| is_svg(*n) && !is_part(*n)) {
        if child.descendants().any(is_part) {
            beside(child, styles, is_part, stray);
        } else if draws(child, styles) {
            stray(child);
        }
    }
}

fn draws<'a>(node: Node<'a, 'a>, styles: &Styles<'a>) -> bool {
    let name = node.tag_name().name();
    is_svg(node)
        && styles.value(node, "display") != Some("none")
        && (DRAWN.contains(&name)
            || (HOLDERS.contains(&name) && node.children().any(|child| draws(child, styles))))
}

/// What to do about a part that is not there.
fn missing(part: &str, root: Node, groups: &[Node]) -> String {
    let ids: Vec<&str> =
        root.children().filter(|n| groups.contains(n)).filter_map(|n| n.attribute("id")).collect();
    let labels: Vec<&str> = groups.iter().filter_map(|n| label(*n)).collect();
    let known: Vec<&str> =
        groups.iter().filter_map(|n| n.attribute("id")).chain(labels.iter().copied()).collect();
    let labelled = match labels[..] {
        [] => String::new(),
        _ => format!(", its labels {}", list(&labels)),
    };
    let loose = root.descendants().find(|n| n.attribute("id") == Some(part)).map_or(String::new(), |n| {
        format!(
            "; #{part} is a <{}>: group it by itself (Inkscape: Object › Group) and give the group that id",
            n.tag_name().name()
        )
    });
    format!(
        "has no group {part:?}{}{loose}; its groups are {}{labelled} (Inkscape: Edit › XML Editor, or Object › Object Properties, shows ids)",
        did_you_mean(part, &known),
        list(&ids)
    )
}
