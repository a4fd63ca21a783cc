//! Drawings mended: what stands in the way of drawing them and can be put right mechanically, so that the same is seen.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use resvg::usvg::roxmltree::{Error, Node};

use super::drawn::{SVG, is_known, is_svg};
use super::{Svg, raster, size, text, tree};

/// A drawing that is accepted, and what was changed for it, a line each.
#[derive(Debug)]
pub struct Mended {
    /// The drawing, as UTF-8 text.
    pub svg: String,
    /// What was changed.
    pub changes: Vec<String>,
}

/// Namespaces that are declared for prefixes which are used and are not.
const PREFIXES: &[(&str, &str)] = &[
    ("xlink", "http://www.w3.org/1999/xlink"),
    ("inkscape", "http://www.inkscape.org/namespaces/inkscape"),
    ("sodipodi", "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"),
];

/// Elements in which what is unknown would be drawn, were it known.
const HOLDERS: &[&str] =
    &["svg", "g", "a", "switch", "defs", "symbol", "clipPath", "mask", "marker", "pattern"];

/// Rows that two drawings are compared on.
const ROWS: f64 = 256.0;

/// Mends a drawing of which a manifest names these parts; `None` where nothing is wrong with it. Errors: what can't be mended, with its cure.
pub(crate) fn mend(bytes: &[u8], parts: &[String]) -> Option<Result<Mended, Vec<String>>> {
    let wrong = problems(bytes, parts);
    if wrong.is_empty() {
        return None;
    }
    let mut changes = Vec::new();
    let Some(before) = readable(bytes, &mut changes) else { return Some(Err(wrong)) };
    let after = edited(&before, parts, &mut changes).unwrap_or_else(|_| before.clone());
    let left = problems(after.as_bytes(), parts);
    Some(if !left.is_empty() {
        Err(left)
    } else if changes.is_empty() || !alike(&before, &after) {
        Err(wrong)
    } else {
        Ok(Mended { svg: after, changes })
    })
}

/// Why a drawing is refused, or what is odd of it.
fn problems(bytes: &[u8], parts: &[String]) -> Vec<String> {
    let mut wrong = Vec::new();
    let svg = Svg::open(bytes, parts, &mut |rule| wrong.push(rule));
    wrong.extend(svg.map(|svg| svg.odd).unwrap_or_default());
    wrong
}

/// The text as UTF-8, with its namespaces declared and a size.
fn readable(bytes: &[u8], changes: &mut Vec<String>) -> Option<String> {
    let mut svg = match text::decode(bytes) {
        Ok(text) => text.into_owned(),
        Err(_) if !bytes.contains(&0) => bytes.iter().map(|byte| char::from(*byte)).collect(),
        Err(_) => return None,
    };
    if std::str::from_utf8(bytes).is_err() {
        if let Some(declared) = svg.find("?>").filter(|_| svg.trim_start().starts_with("<?xml")) {
            svg.replace_range(..declared + 2, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
        }
        changes.push("it is written as UTF-8".to_owned());
    }
    for (prefix, namespace) in PREFIXES {
        if matches!(text::unchecked(&svg), Err(Error::UnknownNamespace(unknown, _)) if unknown == *prefix) {
            declare(&mut svg, &format!("xmlns:{prefix}=\"{namespace}\""))?;
            changes.push(format!("the prefix {prefix} is declared"));
        }
    }
    if text::is_unnamed(&text::parse(&svg).ok()?) {
        declare(&mut svg, &format!("xmlns=\"{SVG}\""))?;
        changes.push(format!("its root says that it is an SVG: xmlns=\"{SVG}\""));
    }
    let document = text::parse(&svg).ok()?;
    if size::check(&document).is_err() {
        let root = document.root_element();
        let sized = ["width", "height"].into_iter().filter_map(|name| root.attribute_node(name));
        let mut edits: Vec<(Range<usize>, String)> = sized.map(|a| (a.range(), String::new())).collect();
        let mut said =
            "its width and height, which are no lengths, are gone: its viewBox says how large it is"
                .to_owned();
        if root.attribute("viewBox").is_none() {
            let bounds = tree(&document, String::new()).ok()?.root().abs_stroke_bounding_box();
            let [x, y, w, h] = [bounds.x(), bounds.y(), bounds.width(), bounds.height()];
            let at = opening(&svg)?;
            edits.push((at..at, format!(" viewBox=\"{x} {y} {w} {h}\"")));
            said = format!("it has the size of what is drawn: viewBox=\"{x} {y} {w} {h}\"");
        }
        let sized = apply(&svg, edits);
        text::parse(&sized).ok().filter(|document| size::check(document).is_ok())?;
        changes.push(said);
        return Some(sized);
    }
    Some(svg)
}

/// Where attributes of the root may be put: behind its name.
fn opening(svg: &str) -> Option<usize> {
    svg.find("<svg").map(|at| at + 4)
}

fn declare(svg: &mut String, declaration: &str) -> Option<()> {
    let at = opening(svg)?;
    svg.insert_str(at, &format!(" {declaration}"));
    Some(())
}

/// The text without what draws nothing anywhere, ids told apart, parts as groups.
fn edited(svg: &str, parts: &[String], changes: &mut Vec<String>) -> Result<String, String> {
    let document = text::parse(svg)?;
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let mut count: HashMap<&str, usize> = HashMap::new();
    document
        .descendants()
        .filter_map(|n| n.attribute("id"))
        .for_each(|id| *count.entry(id).or_default() += 1);
    let mut known: HashSet<String> = count.keys().map(|id| (*id).to_owned()).collect();
    let mut met = HashSet::new();
    for node in document.descendants().filter(|n| n.is_element()) {
        let name = node.tag_name().name();
        let held = node.parent_element().is_some_and(|parent| HOLDERS.contains(&parent.tag_name().name()));
        if is_svg(node) && held && !is_known(name) {
            changes.push(format!("<{name}>, which is none of SVG's elements and is never drawn, is gone"));
            edits.push((node.range(), String::new()));
            continue;
        }
        if name == "use"
            && let Some(target) = target(node).filter(|id| !count.contains_key(id))
        {
            changes.push(format!("<use> of #{target}, which it doesn't have, is gone"));
            edits.push((node.range(), String::new()));
            continue;
        }
        if let Some(id) = node.attribute_node("id")
            && !met.insert(id.value())
        {
            let free = (2..).map(|k| format!("{}-{k}", id.value())).find(|id| known.insert(id.clone()));
            let free = free.unwrap_or_default();
            changes.push(format!("the second element of id {:?} is called {free:?}", id.value()));
            edits.push((id.range_value(), free));
        }
        if let Some(id) = node.attribute_node("id").filter(|id| parts.iter().any(|part| part == id.value()))
            && is_svg(node)
            && name != "g"
            && count[id.value()] == 1
        {
            changes.push(format!("part {:?}, a <{name}>, is a group of its own", id.value()));
            let whole = node.range();
            edits.push((whole.start..whole.start, format!("<g id=\"{}\">", &svg[id.range_value()])));
            edits.push((id.range(), String::new()));
            edits.push((whole.end..whole.end, "</g>".to_owned()));
        }
    }
    let mut after = apply(svg, edits);
    for id in vain(&after, &count) {
        let called = format!("url(#{id})");
        changes.push(format!("{called}, to which there is nothing, is none"));
        after = after.replace(&called, "none");
    }
    Ok(after)
}

/// What a `use` stands for.
fn target<'a>(node: Node<'a, 'a>) -> Option<&'a str> {
    node.attributes().find(|a| a.name() == "href")?.value().trim().strip_prefix('#')
}

/// Ids that properties refer to and no element has.
fn vain(svg: &str, known: &HashMap<&str, usize>) -> Vec<String> {
    let called = svg.split("url(#").skip(1).filter_map(|rest| rest.split_once(')'));
    let vain: HashSet<&str> = called.map(|(id, _)| id).filter(|id| !known.contains_key(id)).collect();
    let mut vain: Vec<String> = vain.into_iter().map(str::to_owned).collect();
    vain.sort();
    vain
}

/// The text with ranges replaced; what lies in one that is replaced as a whole goes with it.
fn apply(svg: &str, mut edits: Vec<(Range<usize>, String)>) -> String {
    edits.sort_by_key(|(range, _)| (range.start, std::cmp::Reverse(range.end)));
    let (mut out, mut at) = (String::new(), 0);
    for (range, written) in edits.into_iter().filter(|(range, _)| range.start <= range.end) {
        if range.start >= at {
            out += &svg[at..range.start];
            out += &written;
            at = range.end;
        }
    }
    out + &svg[at..]
}

/// Whether two drawings are the same picture.
fn alike(before: &str, after: &str) -> bool {
    let drawn = |svg: &str| {
        let known = text::parse(svg).ok().and_then(|document| text::understood(&document, svg));
        let tree = tree(&text::parse(known.as_deref().unwrap_or(svg)).ok()?, String::new()).ok()?;
        let scale = ROWS / f64::from(tree.size().height());
        let columns = (f64::from(tree.size().width()) * scale).ceil().clamp(1.0, 16.0 * ROWS);
        Some(raster::draw(&tree, scale, [0.0; 2], [columns as usize, ROWS as usize]))
    };
    drawn(before).is_some_and(|before| drawn(after).is_some_and(|after| before == after))
}
