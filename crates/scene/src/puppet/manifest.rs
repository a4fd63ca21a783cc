//! The puppet manifest: which groups of an SVG are parts, and how they hang together.

use std::collections::HashSet;

use kelir_reader::{Node, did_you_mean, list};

use crate::limits;

/// A part of a puppet that turns, as its manifest has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name: the id of the SVG's group, or the label that Inkscape shows for it.
    pub id: String,
    /// Index of the part that it hangs on, and is carried along by.
    pub parent: Option<usize>,
    /// The joint that it turns about, [x, y] in the SVG's user units, y down; a part without one can't be posed.
    pub pivot: Option<[f64; 2]>,
    /// The least and the greatest pose in degrees, counter-clockwise; 0, as drawn, is between them. Without them any.
    pub limits_deg: Option<[f64; 2]>,
}

/// A manifest's image path and parts.
pub(crate) struct Manifest<'a> {
    /// The node of the image's path, for messages.
    pub image: Node<'a>,
    pub parts: Vec<Part>,
}

impl<'a> Manifest<'a> {
    pub(crate) fn read(root: &Node<'a>) -> Option<Self> {
        let mut fields = root.table()?;
        let about = [
            ("title", "what it is called"),
            ("source", "who drew or scanned it, and where"),
            ("license", "under which terms it may be used"),
        ];
        for (key, what) in about {
            fields.given(key, what).and_then(|n| n.string());
        }
        let image =
            fields.need("image", "the path of the puppet's SVG or PNG", |n| n.string().map(|_| n.clone()));
        let parts = fields.optional(
            "parts",
            "groups of the SVG that turn, in drawing order; without any it is one piece",
            Vec::new(),
            read_parts,
        );
        fields.done();
        Some(Self { image: image?, parts: parts? })
    }
}

fn read_parts(node: &Node) -> Option<Vec<Part>> {
    let items = node.array(limits::PARTS)?;
    let raw: Vec<_> = items.iter().map(read_part).collect();
    let raw: Vec<_> = raw.into_iter().collect::<Option<Vec<_>>>()?;
    let ids: Vec<String> = raw.iter().map(|r| r.0.clone()).collect();
    let mut sound = true;
    let mut seen = HashSet::new();
    let mut parts = Vec::new();
    for ((id, parent, pivot, limits_deg), item) in raw.into_iter().zip(&items) {
        if !seen.insert(id.clone()) {
            item.refuse::<()>(format!("a part's id must be unique, and there are two {id:?}"));
            sound = false;
        }
        let parent = match parent {
            None => None,
            Some(node) => {
                let name = node.string()?;
                let found = ids.iter().position(|i| i == name);
                if found.is_none() {
                    node.refuse::<()>(format!(
                        "no such part{}; parts are {}",
                        did_you_mean(name, &ids),
                        list(&ids)
                    ));
                    sound = false;
                }
                found
            }
        };
        parts.push(Part { id, parent, pivot, limits_deg });
    }
    for (i, item) in items.iter().enumerate() {
        // A chain longer than there are parts goes round in a circle.
        let chain = std::iter::successors(Some(i), |&p| parts.get(p)?.parent).take(parts.len() + 1).count();
        if sound && chain > parts.len() {
            item.refuse::<()>(format!("part {:?} must not hang on itself", parts[i].id));
            sound = false;
        }
    }
    sound.then_some(parts)
}

type RawPart<'a> = (String, Option<Node<'a>>, Option<[f64; 2]>, Option<[f64; 2]>);

fn read_part<'a>(node: &Node<'a>) -> Option<RawPart<'a>> {
    let mut fields = node.table()?;
    let id = fields.need("id", "the id of the SVG group, or its Inkscape label", |n| {
        let id = n.string()?;
        // Whatever an editor lets a layer be called, but for what no style sheet can quote.
        let quoted = id.contains('"') && id.contains('\'');
        let sound = !id.is_empty()
            && id.len() <= 100
            && !quoted
            && !id.contains(|c: char| c.is_control() || c == '\\');
        if sound {
            Some(id.to_owned())
        } else {
            n.refuse(
                "an id has 1 to 100 bytes, no control character or backslash, and not both kinds of quotes",
            )
        }
    });
    let parent = fields.given("parent", "id of the part that it hangs on; without it on none");
    let pivot = fields.optional(
        "pivot",
        "what it turns about, [x, y] in SVG user units; without it it does not turn",
        None,
        |n| n.items(|x| x.number_in(-1e6..=1e6, "a pivot is given in SVG user units, at most 1e6")).map(Some),
    );
    let limits_deg = fields.optional("limits_deg", "[least, greatest] pose; without it any", None, |n| {
        let limits: [f64; 2] =
            n.items(|x| x.number_in(-360.0..=360.0, "a limit is between −360 and 360 degrees"))?;
        if limits[0] <= 0.0 && limits[1] >= 0.0 {
            Some(Some(limits))
        } else {
            n.refuse("limits are [least, greatest] and include the rest pose, 0")
        }
    });
    fields.done();
    if let Some(parent) = &parent {
        parent.string()?;
    }
    Some((id?, parent, pivot?, limits_deg?))
}
