//! What an SVG's attributes and style sheets say of an element, as usvg reads them.

use resvg::usvg::roxmltree::{Document, Node};
use simplecss::{AttributeOperator, DeclarationTokenizer, Element, PseudoClass, StyleSheet};

/// A document's style sheets.
pub(super) struct Styles<'a> {
    sheet: StyleSheet<'a>,
    /// Bytes of them all.
    pub bytes: usize,
}

impl<'a> Styles<'a> {
    pub(super) fn of(document: &'a Document<'a>) -> Self {
        let (mut sheet, mut bytes) = (StyleSheet::new(), 0);
        let css = |node: &Node| matches!(node.attribute("type"), None | Some("text/css"));
        for node in document.descendants().filter(|n| n.has_tag_name("style")).filter(css) {
            let text = node.text().unwrap_or_default();
            bytes += text.len();
            sheet.parse_more(text);
        }
        Self { sheet, bytes }
    }

    /// The value that holds for one of `names` on the element itself, the last name of equals: inline styles before rules before attributes.
    pub(super) fn value(&self, node: Node<'a, 'a>, name: &str) -> Option<&'a str> {
        let mut found: Option<(&'a str, bool)> = node.attribute(name).map(|value| (value.trim(), false));
        let mut say = |value: &'a str, important: bool| {
            if !found.is_some_and(|(_, before)| before) {
                found = Some((value, important));
            }
        };
        for rule in &self.sheet.rules {
            let mut declared = rule.declarations.iter().filter(|d| is(d.name, name)).peekable();
            if declared.peek().is_some() && rule.selector.matches(&Selected(node)) {
                declared.for_each(|d| say(d.value, d.important));
            }
        }
        if let Some(style) = node.attribute("style") {
            DeclarationTokenizer::from(style)
                .filter(|d| is(d.name, name))
                .for_each(|d| say(d.value, d.important));
        }
        found.map(|(value, _)| value)
    }

    /// The value of an inherited property.
    pub(super) fn inherited(&self, node: Node<'a, 'a>, name: &str) -> Option<&'a str> {
        node.ancestors().find_map(|node| self.value(node, name).filter(|value| *value != "inherit"))
    }
}

/// Whether a declaration is of the property: `marker` is of all three markers.
fn is(declared: &str, name: &str) -> bool {
    declared == name || (declared == "marker" && name.starts_with("marker-"))
}

struct Selected<'a>(Node<'a, 'a>);

impl Element for Selected<'_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Selected)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Selected)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator) -> bool {
        self.0.attribute(name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass) -> bool {
        class == PseudoClass::FirstChild && self.prev_sibling_element().is_none()
    }
}
