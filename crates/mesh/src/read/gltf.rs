//! glTF 2.0, as text and as one binary file.

mod accessor;
mod document;

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

use self::accessor::Source;
use self::document::{AnimationEntry, Document, NodeEntry, Primitive};
use super::obj::unit;
use super::within;
use crate::model::{Animation, Channel, Node, Part, Skin, Transform, Values};
use crate::{Fault, Mesh, Model};

/// `glTF`, `JSON` and `BIN\0` as little-endian numbers.
const MAGIC: u32 = 0x4654_6c67;
const JSON: u32 = 0x4e4f_534a;
const BIN: u32 = 0x004e_4942;
/// Nodes of a file, and joints of its skin.
const MOST_NODES: usize = 1 << 16;

/// What answers files beside the one that is read.
type Beside<'a> = &'a mut dyn FnMut(&str) -> Result<Vec<u8>, String>;

/// A `.gltf`.
pub(super) fn read_text(bytes: &[u8], beside: Beside) -> Result<Model, Fault> {
    read(bytes, None, beside)
}

/// A `.glb`: a header of 12 bytes, then chunks of JSON and, perhaps, one buffer.
pub(super) fn read_binary(bytes: &[u8], beside: Beside) -> Result<Model, Fault> {
    let word = |at: usize| {
        let four: Option<[u8; 4]> = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
        four.map(u32::from_le_bytes)
            .ok_or_else(|| Fault::new(format!("byte {at}"), "the file ends before it"))
    };
    if word(0)? != MAGIC {
        return Err(Fault::new("byte 0", "a binary glTF file begins with glTF"));
    }
    if word(4)? != 2 {
        return Err(Fault::of("byte 4", word(4)?, "the version is 2"));
    }
    if word(8)? as usize > bytes.len() {
        return Err(Fault::of("byte 8", word(8)?, format!("the file's length is {}", bytes.len())));
    }
    let chunk = |at: usize| {
        let (length, kind) = (word(at)? as usize, word(at + 4)?);
        let chunk = bytes.get(at + 8..).and_then(|rest| rest.get(..length));
        let rule = || format!("the chunk ends with the file, after {} bytes", bytes.len());
        chunk.map(|chunk| (kind, chunk)).ok_or_else(|| Fault::of(format!("byte {at}"), length, rule()))
    };
    let (kind, json) = chunk(12)?;
    if kind != JSON {
        return Err(Fault::new("byte 16", "the first chunk is JSON"));
    }
    let next = 20 + json.len().next_multiple_of(4);
    let buffer = if next < bytes.len() { Some(chunk(next)?).filter(|(kind, _)| *kind == BIN) } else { None };
    read(json, buffer.map(|(_, buffer)| buffer), beside)
}

fn read(json: &[u8], chunk: Option<&[u8]>, beside: Beside) -> Result<Model, Fault> {
    let document: Document = serde_json::from_slice(json).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let text = error.to_string();
        Fault::new(place, text.split(" at line ").next().unwrap_or_default())
    })?;
    let version = &document.asset.version;
    if !version.starts_with("2.") {
        return Err(Fault::of("asset.version", version, "is 2.0"));
    }
    if let Some(extension) = document.extensions_required.first() {
        return Err(Fault::of("extensionsRequired", extension, "no extension is read"));
    }
    within_nodes(document.nodes.len(), "nodes")?;
    let source = Source::open(&document, chunk, beside)?;
    let mut reader = Reader { document: &document, source, vertices: 0, triangles: 0 };
    let order = order(&document)?;
    reader.model(&order)
}

fn within_nodes(count: usize, place: &str) -> Result<(), Fault> {
    match count {
        0..=MOST_NODES => Ok(()),
        _ => Err(Fault::of(place, count, format!("at most {MOST_NODES}"))),
    }
}

/// A node's place in the file, its parent's place in the order, and whether the scene shows it.
struct Place {
    entry: usize,
    parent: Option<usize>,
    shown: bool,
}

/// The nodes with each parent before its children. Errors: what is no tree.
fn order(document: &Document) -> Result<Vec<Place>, Fault> {
    let count = document.nodes.len();
    let mut is_child = vec![false; count];
    for (n, node) in document.nodes.iter().enumerate() {
        for &child in &node.children {
            let at = || format!("nodes[{n}].children");
            match is_child.get_mut(child) {
                None => return Err(Fault::of(at(), child, format!("is one of {count} nodes"))),
                Some(true) => return Err(Fault::of(at(), child, "a node has one parent")),
                Some(known) => *known = true,
            }
        }
    }
    // Without a scene all is shown.
    let mut shown = vec![document.scenes.is_empty(); count];
    let scene = document.scene.unwrap_or(0);
    match document.scenes.get(scene) {
        Some(scene) => {
            for &root in &scene.nodes {
                let known = shown
                    .get_mut(root)
                    .ok_or_else(|| Fault::of("scenes.nodes", root, format!("is one of {count} nodes")))?;
                *known = true;
            }
        }
        None if document.scenes.is_empty() && document.scene.is_none() => {}
        None => return Err(Fault::of("scene", scene, format!("is one of {} scenes", document.scenes.len()))),
    }
    let mut order: Vec<Place> = Vec::with_capacity(count);
    let roots = (0..count).filter(|n| !is_child[*n]);
    order.extend(roots.map(|entry| Place { entry, parent: None, shown: shown[entry] }));
    let mut next = 0;
    while let Some(&Place { entry, shown: above, .. }) = order.get(next) {
        let children = document.nodes[entry].children.iter();
        order.extend(children.map(|&entry| Place {
            entry,
            parent: Some(next),
            shown: above || shown[entry],
        }));
        next += 1;
    }
    // What no root leads to goes round in a circle.
    if order.len() < count {
        return Err(Fault::new("nodes", "a node is not among its own descendants"));
    }
    Ok(order)
}

struct Reader<'a> {
    document: &'a Document,
    source: Source<'a>,
    /// So far: a file may show one mesh at many nodes.
    vertices: usize,
    triangles: usize,
}

impl Reader<'_> {
    fn model(&mut self, order: &[Place]) -> Result<Model, Fault> {
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, node)| place[node.entry] = at);
        let mut model = Model::default();
        let skin =
            order.iter().filter(|node| node.shown).find_map(|node| self.document.nodes[node.entry].skin);
        if let Some(skin) = skin {
            model.skin = Some(self.skin(skin, &place)?);
        }
        for node in order {
            let entry = &self.document.nodes[node.entry];
            let at = format!("nodes[{}]", node.entry);
            if node.shown && entry.skin.is_some() && entry.skin != skin {
                return Err(Fault::of(
                    format!("{at}.skin"),
                    entry.skin.unwrap_or(0),
                    "a file's meshes have one skin",
                ));
            }
            let parts = match entry.mesh {
                Some(mesh) if node.shown => {
                    self.parts(mesh, &at, model.skin.as_ref().filter(|_| entry.skin.is_some()))?
                }
                _ => Vec::new(),
            };
            let rest = rest(entry, &at)?;
            model.nodes.push(Node { name: entry.name.clone(), parent: node.parent, rest, parts });
        }
        for (n, animation) in self.document.animations.iter().enumerate() {
            model.animations.push(self.animation(animation, n, &place)?);
        }
        Ok(model)
    }

    fn skin(&self, index: usize, place: &[usize]) -> Result<Skin, Fault> {
        let at = format!("skins[{index}]");
        let skin = self.document.skins.get(index).ok_or_else(|| Fault::new(&at, "is not in the file"))?;
        within_nodes(skin.joints.len(), &at)?;
        let joint = |joint: &usize| {
            place.get(*joint).copied().ok_or_else(|| {
                Fault::of(format!("{at}.joints"), joint, format!("is one of {} nodes", place.len()))
            })
        };
        let joints = skin.joints.iter().map(joint).collect::<Result<Vec<_>, _>>()?;
        let inverse_bind = match skin.inverse_bind_matrices {
            None => vec![DAffine3::IDENTITY; joints.len()],
            Some(matrices) => {
                let place = format!("{at}.inverseBindMatrices");
                let matrices = self.source.floats::<16>(matrices, &place)?;
                if matrices.len() < joints.len() {
                    return Err(Fault::of(place, matrices.len(), "there is one for each joint"));
                }
                let affine = |m: &[f32; 16]| DAffine3::from_mat4(DMat4::from_cols_array(&m.map(f64::from)));
                matrices[..joints.len()].iter().map(affine).collect()
            }
        };
        Ok(Skin { joints, inverse_bind })
    }

    fn parts(&mut self, index: usize, node: &str, skin: Option<&Skin>) -> Result<Vec<Part>, Fault> {
        let Some(mesh) = self.document.meshes.get(index) else {
            let count = self.document.meshes.len();
            return Err(Fault::of(format!("{node}.mesh"), index, format!("is one of {count} meshes")));
        };
        let mut parts = Vec::new();
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            parts.push(self.part(primitive, &format!("meshes[{index}].primitives[{p}]"), skin)?);
        }
        Ok(parts)
    }

    fn part(&mut self, primitive: &Primitive, at: &str, skin: Option<&Skin>) -> Result<Part, Fault> {
        const MODES: [&str; 7] =
            ["points", "lines", "line loops", "line strips", "triangles", "triangle strips", "triangle fans"];
        if let Some(mode) = primitive.mode.filter(|mode| *mode != 4) {
            let name = MODES.get(mode).copied().unwrap_or("unknown");
            return Err(Fault::of(
                format!("{at}.mode"),
                format!("{mode} ({name})"),
                "only triangles (4) are read",
            ));
        }
        if !primitive.targets.is_empty() {
            return Err(Fault::new(format!("{at}.targets"), "morph targets are not read"));
        }
        let attribute = |name: &str| {
            primitive.attributes.get(name).map(|accessor| (*accessor, format!("{at}.attributes.{name}")))
        };
        let Some((positions, place)) = attribute("POSITION") else {
            return Err(Fault::new(format!("{at}.attributes"), "has a POSITION"));
        };
        // Counted before it is read: a file may show one mesh at many nodes.
        let vertices = self.source.count(positions, &place)?;
        self.vertices = within(self.vertices + vertices, &place)?;
        let mut mesh = Mesh { positions: self.source.floats::<3>(positions, &place)?, ..Mesh::default() };
        let same = |count: usize, place: &str| match count == vertices {
            true => Ok(()),
            false => Err(Fault::of(place, count, format!("there is one for each of {vertices} positions"))),
        };
        let indices = match primitive.indices {
            Some(accessor) => {
                let place = format!("{at}.indices");
                let count = self.source.count(accessor, &place)?;
                self.triangles = within(self.triangles + count / 3, &place)?;
                self.source.indices(accessor, &place)?
            }
            None => {
                self.triangles = within(self.triangles + vertices / 3, at)?;
                (0..vertices as u32).collect()
            }
        };
        let (triangles, rest) = indices.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(Fault::of(
                format!("{at}.indices"),
                indices.len(),
                "there are three for each triangle",
            ));
        }
        mesh.triangles = triangles.to_vec();
        if let Some((accessor, place)) = attribute("NORMAL") {
            same(self.source.count(accessor, &place)?, &place)?;
            mesh.normals = Some(self.source.floats::<3>(accessor, &place)?.into_iter().map(unit).collect());
        }
        if let Some((accessor, place)) = attribute("TEXCOORD_0") {
            same(self.source.count(accessor, &place)?, &place)?;
            mesh.texture = Some(self.source.floats::<2>(accessor, &place)?);
        }
        if let Some(material) = primitive.material {
            mesh.base_colour = self.colour(material, at)?;
        }
        let weights = match (skin, attribute("JOINTS_0"), attribute("WEIGHTS_0")) {
            (None, ..) => None,
            (Some(skin), Some((joints, joints_at)), Some((weights, weights_at))) => {
                if let Some((_, place)) = attribute("JOINTS_1") {
                    return Err(Fault::new(place, "a vertex follows at most four joints"));
                }
                same(self.source.count(joints, &joints_at)?, &joints_at)?;
                same(self.source.count(weights, &weights_at)?, &weights_at)?;
                let joints = self.source.joints(joints, &joints_at)?;
                let weights = self.source.floats::<4>(weights, &weights_at)?;
                let each = joints.iter().zip(&weights).enumerate();
                let each = each.map(|(v, (joints, weights))| {
                    follows(joints, weights, skin.joints.len()).map_err(|rule| {
                        Fault::of(&weights_at, format!("{joints:?} by {weights:?} at vertex {v}"), rule)
                    })
                });
                Some(each.collect::<Result<Vec<_>, Fault>>()?)
            }
            _ => {
                return Err(Fault::new(
                    format!("{at}.attributes"),
                    "a skinned mesh has JOINTS_0 and WEIGHTS_0",
                ));
            }
        };
        Ok(Part { mesh, weights })
    }

    fn colour(&self, material: usize, at: &str) -> Result<[f32; 3], Fault> {
        let Some(material_entry) = self.document.materials.get(material) else {
            let count = self.document.materials.len();
            return Err(Fault::of(
                format!("{at}.material"),
                material,
                format!("is one of {count} materials"),
            ));
        };
        let [r, g, b, _] = material_entry.pbr_metallic_roughness.base_color_factor;
        if [r, g, b].iter().any(|channel| !(0.0..=1.0).contains(channel)) {
            let place = format!("materials[{material}].pbrMetallicRoughness.baseColorFactor");
            return Err(Fault::of(place, format!("[{r}, {g}, {b}]"), "from 0 to 1"));
        }
        Ok([r, g, b])
    }

    fn animation(&self, entry: &AnimationEntry, n: usize, place: &[usize]) -> Result<Animation, Fault> {
        let mut channels = Vec::new();
        for (c, channel) in entry.channels.iter().enumerate() {
            let at = format!("animations[{n}].channels[{c}]");
            let Some(sampler) = entry.samplers.get(channel.sampler) else {
                let rule = format!("is one of {} samplers", entry.samplers.len());
                return Err(Fault::of(format!("{at}.sampler"), channel.sampler, rule));
            };
            // A channel without a node belongs to an extension.
            let Some(node) = channel.target.node else { continue };
            let Some(&node) = place.get(node) else {
                return Err(Fault::of(
                    format!("{at}.target.node"),
                    node,
                    format!("is one of {} nodes", place.len()),
                ));
            };
            let sampler_at = format!("animations[{n}].samplers[{}]", channel.sampler);
            let step = match sampler.interpolation.as_deref() {
                None | Some("LINEAR") => false,
                Some("STEP") => true,
                Some(other) => {
                    return Err(Fault::of(
                        format!("{sampler_at}.interpolation"),
                        other,
                        "LINEAR and STEP are read",
                    ));
                }
            };
            let input = format!("{sampler_at}.input");
            let times: Vec<f32> =
                self.source.floats::<1>(sampler.input, &input)?.into_iter().flatten().collect();
            if times.is_empty() || times.iter().any(|time| !time.is_finite()) || !times.is_sorted() {
                return Err(Fault::new(input, "times are numbers that increase, at least one"));
            }
            let output = format!("{sampler_at}.output");
            let vectors = || {
                let values = self.source.floats::<3>(sampler.output, &output)?;
                finite(&output, values.into_iter().map(|v| DVec3::from_array(v.map(f64::from))), |v| {
                    v.is_finite()
                })
            };
            let values = match channel.target.path.as_str() {
                "translation" => Values::Translation(vectors()?),
                "scale" => Values::Scale(vectors()?),
                "rotation" => {
                    let values = self.source.floats::<4>(sampler.output, &output)?;
                    let turns = values.into_iter().map(|v| DQuat::from_array(v.map(f64::from)).normalize());
                    Values::Rotation(finite(&output, turns, |q| q.is_finite())?)
                }
                "weights" => {
                    return Err(Fault::of(
                        format!("{at}.target.path"),
                        "weights",
                        "morph targets are not read",
                    ));
                }
                other => {
                    return Err(Fault::of(
                        format!("{at}.target.path"),
                        other,
                        "is translation, rotation or scale",
                    ));
                }
            };
            let count = match &values {
                Values::Translation(values) | Values::Scale(values) => values.len(),
                Values::Rotation(values) => values.len(),
            };
            if count != times.len() {
                return Err(Fault::of(
                    output,
                    count,
                    format!("there is one value for each of {} times", times.len()),
                ));
            }
            channels.push(Channel { node, times, values, step });
        }
        Ok(Animation { name: entry.name.clone(), channels })
    }
}

fn finite<T>(place: &str, values: impl Iterator<Item = T>, is: fn(&T) -> bool) -> Result<Vec<T>, Fault> {
    let values: Vec<T> = values.collect();
    match values.iter().all(is) {
        true => Ok(values),
        false => Err(Fault::new(place, "values are finite numbers, and rotations not zero")),
    }
}

/// A vertex's joints with weights that add up to 1 exactly as f32 can.
fn follows(joints: &[u16; 4], weights: &[f32; 4], count: usize) -> Result<[(u16, f32); 4], String> {
    let sum: f32 = weights.iter().sum();
    if !(weights.iter().all(|weight| *weight >= 0.0) && sum > 0.5 && sum < 2.0) {
        return Err("weights are not negative and add up to 1".to_owned());
    }
    let mut follows = [(0, 0.0); 4];
    for k in 0..4 {
        if weights[k] > 0.0 {
            if usize::from(joints[k]) >= count {
                return Err(format!("a joint is one of the skin's {count}"));
            }
            follows[k] = (joints[k], weights[k] / sum);
        }
    }
    Ok(follows)
}

fn rest(entry: &NodeEntry, at: &str) -> Result<Transform, Fault> {
    let transform = match entry.matrix {
        Some(columns) => {
            let matrix = DMat4::from_cols_array(&columns);
            let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
            let back = DMat3::from_quat(rotation) * DMat3::from_diagonal(scale);
            let m = DMat3::from_mat4(matrix);
            let size = m.to_cols_array().iter().fold(0.0, |most, x| x.abs().max(most));
            if matrix.row(3) != glam::DVec4::W || !back.abs_diff_eq(m, 1e-5 * size) {
                let rule = "is made of a translation, a rotation and a scale";
                return Err(Fault::of(format!("{at}.matrix"), format!("{columns:?}"), rule));
            }
            Transform { translation, rotation, scale }
        }
        None => Transform {
            translation: DVec3::from_array(entry.translation.unwrap_or([0.0; 3])),
            rotation: DQuat::from_array(entry.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0])),
            scale: DVec3::from_array(entry.scale.unwrap_or([1.0; 3])),
        },
    };
    let length = transform.rotation.length();
    if !(length > 0.99 && length < 1.01) {
        let value = format!("{:?}", transform.rotation.to_array());
        return Err(Fault::of(format!("{at}.rotation"), value, "is a unit quaternion [x, y, z, w]"));
    }
    if !(transform.translation.is_finite() && transform.scale.is_finite()) {
        return Err(Fault::new(at, "translation and scale are finite"));
    }
    // Files have it rounded; one that is exact already stays as it is.
    let exact = (length - 1.0).abs() < 1e-12;
    let rotation = if exact { transform.rotation } else { transform.rotation.normalize() };
    Ok(Transform { rotation, ..transform })
}

#[cfg(test)]
mod tests;
