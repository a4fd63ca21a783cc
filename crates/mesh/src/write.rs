//! A model as one binary glTF file: it holds all that a [`Model`] is to the bit, every program opens it, and it is one file.

use glam::DMat4;
use serde_json::{Map, Value, json};

use crate::model::{Channel, Model, Part, Values};

/// Bytes of numbers, and what of them is where.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds an accessor of four-byte components; answers its index.
    fn add<const N: usize>(&mut self, kind: &str, component_type: u32, values: &[[[u8; 4]; N]]) -> usize {
        let bytes = values.as_flattened().as_flattened();
        self.accessor(kind, component_type, values.len(), bytes)
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        const KINDS: [&str; 5] = ["", "SCALAR", "VEC2", "VEC3", "VEC4"];
        let bytes: Vec<[[u8; 4]; N]> = values.iter().map(|value| value.map(f32::to_le_bytes)).collect();
        self.add(KINDS.get(N).copied().unwrap_or("MAT4"), 5126, &bytes)
    }

    fn accessor(&mut self, kind: &str, component_type: u32, count: usize, bytes: &[u8]) -> usize {
        let view = self.views.len();
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let accessor =
            json!({ "bufferView": view, "componentType": component_type, "count": count, "type": kind });
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The extremes, which glTF wants of positions and of times.
    fn bound<const N: usize>(&mut self, accessor: usize, values: &[[f32; N]]) {
        let fold = |pick: fn(f32, f32) -> f32| {
            let first = values.first().copied().unwrap_or([0.0; N]);
            values.iter().fold(first, |all, value| std::array::from_fn(|k| pick(all[k], value[k])))
        };
        self.accessors[accessor]["min"] = json!(fold(f32::min).to_vec());
        self.accessors[accessor]["max"] = json!(fold(f32::max).to_vec());
    }
}

/// The file.
pub fn write_glb(model: &Model) -> Vec<u8> {
    let mut buffer = Buffer::default();
    let (mut meshes, mut materials) = (Vec::new(), Vec::new());
    let mut nodes: Vec<Value> = Vec::new();
    let mut children = vec![Vec::new(); model.nodes.len()];
    for (n, node) in model.nodes.iter().enumerate() {
        node.parent.iter().for_each(|parent| children[*parent].push(n));
    }
    for (n, node) in model.nodes.iter().enumerate() {
        let mut entry = Map::new();
        if !node.name.is_empty() {
            entry.insert("name".into(), json!(node.name));
        }
        let rest = &node.rest;
        entry.insert("translation".into(), json!(rest.translation.to_array()));
        entry.insert("rotation".into(), json!(rest.rotation.to_array()));
        entry.insert("scale".into(), json!(rest.scale.to_array()));
        if !children[n].is_empty() {
            entry.insert("children".into(), json!(children[n]));
        }
        if !node.parts.is_empty() {
            let primitives: Vec<Value> =
                node.parts.iter().map(|part| primitive(part, &mut buffer, &mut materials)).collect();
            entry.insert("mesh".into(), json!(meshes.len()));
            meshes.push(json!({ "primitives": primitives }));
            if node.parts.iter().any(|part| part.weights.is_some()) {
                entry.insert("skin".into(), json!(0));
            }
        }
        nodes.push(Value::Object(entry));
    }
    let roots: Vec<usize> = (0..model.nodes.len()).filter(|n| model.nodes[*n].parent.is_none()).collect();
    let skins: Vec<Value> = model
        .skin
        .iter()
        .map(|skin| {
            let columns = |m: &glam::DAffine3| DMat4::from(*m).to_cols_array().map(|x| x as f32);
            let matrices: Vec<[f32; 16]> = skin.inverse_bind.iter().map(columns).collect();
            json!({ "joints": skin.joints, "inverseBindMatrices": buffer.floats(&matrices) })
        })
        .collect();
    let animations: Vec<Value> = model
        .animations
        .iter()
        .map(|animation| {
            let samplers: Vec<Value> =
                animation.channels.iter().map(|channel| sampler(channel, &mut buffer)).collect();
            let channels: Vec<Value> = animation
                .channels
                .iter()
                .enumerate()
                .map(|(s, channel)| {
                    let path = match channel.values {
                        Values::Translation(_) => "translation",
                        Values::Rotation(_) => "rotation",
                        Values::Scale(_) => "scale",
                    };
                    json!({ "sampler": s, "target": { "node": channel.node, "path": path } })
                })
                .collect();
            json!({ "name": animation.name, "channels": channels, "samplers": samplers })
        })
        .collect();
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "kelir" },
        "scene": 0,
        "scenes": [{ "nodes": roots }],
    });
    let lists = [
        ("nodes", nodes),
        ("meshes", meshes),
        ("materials", materials),
        ("skins", skins),
        ("animations", animations),
        ("accessors", buffer.accessors),
        ("bufferViews", buffer.views),
    ];
    // glTF knows no empty lists.
    for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
        document[name] = Value::Array(list);
    }
    if !buffer.bytes.is_empty() {
        document["buffers"] = json!([{ "byteLength": buffer.bytes.len() }]);
    }
    container(document.to_string().into_bytes(), &buffer.bytes)
}

fn primitive(part: &Part, buffer: &mut Buffer, materials: &mut Vec<Value>) -> Value {
    let mesh = &part.mesh;
    let mut attributes = Map::new();
    let position = buffer.floats(&mesh.positions);
    buffer.bound(position, &mesh.positions);
    attributes.insert("POSITION".into(), json!(position));
    if let Some(normals) = &mesh.normals {
        attributes.insert("NORMAL".into(), json!(buffer.floats(normals)));
    }
    if let Some(texture) = &mesh.texture {
        attributes.insert("TEXCOORD_0".into(), json!(buffer.floats(texture)));
    }
    if let Some(weights) = &part.weights {
        let joints: Vec<u8> = weights.iter().flatten().flat_map(|(joint, _)| joint.to_le_bytes()).collect();
        attributes.insert("JOINTS_0".into(), json!(buffer.accessor("VEC4", 5123, weights.len(), &joints)));
        let weights: Vec<[f32; 4]> = weights.iter().map(|four| four.map(|(_, weight)| weight)).collect();
        attributes.insert("WEIGHTS_0".into(), json!(buffer.floats(&weights)));
    }
    let indices: Vec<[[u8; 4]; 1]> =
        mesh.triangles.as_flattened().iter().map(|index| [index.to_le_bytes()]).collect();
    let indices = buffer.add("SCALAR", 5125, &indices);
    let [r, g, b] = mesh.base_colour;
    let colour = json!([r, g, b, 1.0]);
    let material = json!({ "pbrMetallicRoughness": { "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 1.0 } });
    let known = materials.iter().position(|known| *known == material).unwrap_or_else(|| {
        materials.push(material);
        materials.len() - 1
    });
    json!({ "attributes": attributes, "indices": indices, "material": known })
}

fn sampler(channel: &Channel, buffer: &mut Buffer) -> Value {
    let times: Vec<[f32; 1]> = channel.times.iter().map(|time| [*time]).collect();
    let input = buffer.floats(&times);
    buffer.bound(input, &times);
    let output = match &channel.values {
        Values::Translation(values) | Values::Scale(values) => {
            buffer.floats(&values.iter().map(|value| value.as_vec3().to_array()).collect::<Vec<_>>())
        }
        Values::Rotation(values) => {
            buffer.floats(&values.iter().map(|value| value.as_quat().to_array()).collect::<Vec<_>>())
        }
    };
    let interpolation = if channel.step { "STEP" } else { "LINEAR" };
    json!({ "input": input, "output": output, "interpolation": interpolation })
}

/// Header and chunks, each filled up to a multiple of four bytes.
fn container(mut json: Vec<u8>, buffer: &[u8]) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let buffer_length = if buffer.is_empty() { 0 } else { 8 + buffer.len() };
    let length = 12 + 8 + json.len() + buffer_length;
    let mut file = Vec::with_capacity(length);
    file.extend(b"glTF");
    for word in [2, length as u32, json.len() as u32] {
        file.extend(word.to_le_bytes());
    }
    file.extend(b"JSON");
    file.extend(json);
    if !buffer.is_empty() {
        file.extend((buffer.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(buffer);
    }
    file
}
