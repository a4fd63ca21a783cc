//! Where a drawing's user units lie in its pixels.

use resvg::usvg::roxmltree::{Document, Node};

/// The map from user units of the root to CSS pixels of the drawing, whose top left corner is the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Units {
    scale: [f64; 2],
    shift: [f64; 2],
}

impl Units {
    /// For a drawing of `size` pixels. Errors: a view box that is none.
    pub(super) fn of(document: &Document, size: [f64; 2]) -> Result<Self, String> {
        let root = document.root_element();
        let Some(text) = root.attribute("viewBox") else {
            return Ok(Self { scale: [1.0; 2], shift: [0.0; 2] });
        };
        let [x, y, w, h] = view_box(text)?;
        let mut scale = [size[0] / w, size[1] / h];
        let (align, meet) = aspect(root);
        if align != "none" {
            let least = if meet { scale[0].min(scale[1]) } else { scale[0].max(scale[1]) };
            scale = [least; 2];
        }
        // What is left over of the drawing lies before and behind, as xMidYMid and its like share it out.
        let share = |low: &str, high: &str| {
            if align == "none" || align.contains(low) {
                0.0
            } else if align.contains(high) {
                1.0
            } else {
                0.5
            }
        };
        let left = (size[0] - w * scale[0]) * share("xMin", "xMax");
        let top = (size[1] - h * scale[1]) * share("YMin", "YMax");
        Ok(Self { scale, shift: [left - x * scale[0], top - y * scale[1]] })
    }

    /// The pixel of a point in user units.
    pub(crate) fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x * self.scale[0] + self.shift[0], y * self.scale[1] + self.shift[1]]
    }
}

fn aspect<'a>(root: Node<'a, 'a>) -> (&'a str, bool) {
    let text = root.attribute("preserveAspectRatio").unwrap_or("xMidYMid meet");
    let mut words = text.split_whitespace().filter(|word| *word != "defer");
    let align = words.next().unwrap_or("xMidYMid");
    (align, words.next() != Some("slice"))
}

/// Four numbers, of which the last two are the size.
fn view_box(text: &str) -> Result<[f64; 4], String> {
    let parts = text.split(|c: char| c.is_whitespace() || c == ',').filter(|s| !s.is_empty());
    let numbers: Vec<f64> = parts.map(|s| s.parse().unwrap_or(f64::NAN)).collect();
    let &[x, y, w, h] = numbers.as_slice() else {
        return Err(format!("has viewBox = {text:?}; it must be four numbers"));
    };
    if !(numbers.iter().all(|n| n.abs() <= 1e6) && w >= 1e-3 && h >= 1e-3) {
        return Err(format!("has viewBox = {text:?}; its size must be positive and its numbers at most 1e6"));
    }
    Ok([x, y, w, h])
}

/// Looks at what the root says of its size. Errors: nothing that a size follows from.
pub(super) fn check(document: &Document) -> Result<(), String> {
    let root = document.root_element();
    if let Some(text) = root.attribute("viewBox") {
        view_box(text)?;
    } else if root.attribute("width").is_none() && root.attribute("height").is_none() {
        return Err(
            "has neither a viewBox nor width and height, so how large it is nobody knows: set the page to the drawing (Inkscape: File › Document \
             Properties › Resize to content) and save it again"
                .to_owned(),
        );
    }
    for name in ["width", "height"] {
        let Some(text) = root.attribute(name) else { continue };
        let number = text.trim().trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '%').trim();
        let number = number.parse::<f64>().ok().filter(|n| n.is_finite() && *n > 0.0);
        let unit = text.trim().trim_start_matches(|c: char| !(c.is_ascii_alphabetic() || c == '%'));
        if number.is_none() || !["", "px", "mm", "cm", "in", "pt", "pc", "Q", "em", "ex", "%"].contains(&unit)
        {
            return Err(format!(
                "has {name} = {text:?}; it must be a positive number, with px, mm, cm, in, pt, pc, Q, em, ex or % behind it"
            ));
        }
    }
    Ok(())
}
