#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use serde_json::{Value, json};

use super::*;
use crate::write_glb;

/// A triangle with indices of two bytes, positions of a stride of 16, below a moved parent and a turned child, written by hand.
fn triangle() -> Value {
    let mut bytes = Vec::new();
    for index in [0u16, 1, 2, 0] {
        bytes.extend(index.to_le_bytes());
    }
    for vertex in [[0f32, 0.0, 0.0, 9.0], [1.0, 0.0, 0.0, 9.0], [0.0, 1.0, 0.0, 9.0]] {
        vertex.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    }
    // Texture coordinates as bytes, two a vertex.
    bytes.extend([0u8, 0, 255, 0, 0, 51, 0, 0]);
    json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_materials_sheen"],
        "scene": 0,
        "scenes": [{ "nodes": [1] }],
        "nodes": [
            { "name": "child", "mesh": 0, "rotation": [0.0, 0.0, 0.6, 0.8] },
            { "name": "parent", "children": [0], "matrix": [2,0,0,0, 0,2,0,0, 0,0,2,0, 10,0,0,1] },
            { "name": "elsewhere", "mesh": 0 },
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 1, "TEXCOORD_0": 2 }, "indices": 0, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.125, 1] } }],
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes)) }],
        "bufferViews": [
            { "buffer": 0, "byteLength": 8 },
            { "buffer": 0, "byteOffset": 8, "byteLength": 48, "byteStride": 16 },
            { "buffer": 0, "byteOffset": 56, "byteLength": 8 },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR" },
            { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 2, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC2" },
        ],
    })
}

fn read_value(document: &Value) -> Result<Model, Fault> {
    read_text(document.to_string().as_bytes(), &mut |_| Err("no files here".to_owned()))
}

#[test]
fn meshes_stand_where_their_nodes_put_them() {
    let model = read_value(&triangle()).unwrap();
    let names: Vec<&str> = model.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["parent", "elsewhere", "child"]);
    // What the scene does not show is not there.
    assert!(model.nodes[1].parts.is_empty());
    let mesh = model.merged(&model.rest());
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.base_colour, [0.5, 0.25, 0.125]);
    assert_eq!(mesh.texture.unwrap(), [[0.0, 0.0], [1.0, 0.0], [0.0, 0.2]]);
    for (position, expected) in
        mesh.positions.iter().zip([[10.0, 0.0, 0.0], [10.56, 1.92, 0.0], [8.08, 0.56, 0.0]])
    {
        let apart = DVec3::from_array(position.map(f64::from)) - DVec3::from_array(expected);
        assert!(apart.length() < 1e-6, "{position:?}");
    }
}

#[test]
fn buffers_may_lie_beside_the_file_and_nowhere_else() {
    let mut document = triangle();
    let data = document["buffers"][0]["uri"].as_str().unwrap().to_owned();
    let bytes = STANDARD.decode(data.split_once(',').unwrap().1).unwrap();
    let mut with_uri = |uri: &str| {
        document["buffers"][0]["uri"] = json!(uri);
        read_text(document.to_string().as_bytes(), &mut |name| {
            if name == "a b/c.bin" { Ok(bytes.clone()) } else { Err(format!("{name}: not there")) }
        })
    };
    assert_eq!(with_uri("a%20b/c.bin").unwrap(), read_value(&triangle()).unwrap());
    assert_eq!(
        with_uri("other.bin").unwrap_err().to_string(),
        "buffers[0].uri = other.bin: other.bin: not there"
    );
    for uri in ["../c.bin", "/etc/passwd", "a/../../b", "..%2Fc.bin", "http://example.org/a", "C:\\a", ""] {
        let found = with_uri(uri).unwrap_err().to_string();
        assert!(found.ends_with("a file beside this one, or in a folder beside it"), "{found}");
    }
    assert!(with_uri("%zz").unwrap_err().to_string().contains("hexadecimal"));
}

#[test]
fn a_skin_bends_and_an_animation_moves() {
    let mut document = triangle();
    let mut bytes = Vec::new();
    // Joints of two bytes and weights: all on joint 1.
    (0..3).for_each(|_| [1u16, 0, 0, 0].iter().for_each(|joint| bytes.extend(joint.to_le_bytes())));
    (0..3).for_each(|_| [1f32, 0.0, 0.0, 0.0].iter().for_each(|weight| bytes.extend(weight.to_le_bytes())));
    // Two times, two translations.
    [0f32, 2.0, 0.0, 0.0, 0.0, 0.0, 8.0, 0.0].iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    let uri = format!("data:;base64,{}", STANDARD.encode(&bytes));
    let list = |name: &'static str| {
        move |document: &mut Value, value: Value| document[name].as_array_mut().unwrap().push(value)
    };
    list("buffers")(&mut document, json!({ "byteLength": bytes.len(), "uri": uri }));
    for (offset, length) in [(0, 24), (24, 48), (72, 8), (80, 24)] {
        list("bufferViews")(
            &mut document,
            json!({ "buffer": 1, "byteOffset": offset, "byteLength": length }),
        );
    }
    for (view, component, count, kind) in
        [(3, 5123, 3, "VEC4"), (4, 5126, 3, "VEC4"), (5, 5126, 2, "SCALAR"), (6, 5126, 2, "VEC3")]
    {
        let accessor =
            json!({ "bufferView": view, "componentType": component, "count": count, "type": kind });
        list("accessors")(&mut document, accessor);
    }
    document["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(3);
    document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(4);
    document["nodes"][0]["skin"] = json!(0);
    document["skins"] = json!([{ "joints": [1, 2] }]);
    document["animations"] = json!([{
        "name": "lift",
        "channels": [{ "sampler": 0, "target": { "node": 2, "path": "translation" } }],
        "samplers": [{ "input": 5, "output": 6 }],
    }]);
    let model = read_value(&document).unwrap();
    let pose = model.animated(&model.animations[0], 1.5);
    // Its joint alone moves it: neither the parent's matrix nor its own turn.
    assert_eq!(model.merged(&pose).positions, [[0.0, 6.0, 0.0], [1.0, 6.0, 0.0], [0.0, 7.0, 0.0]]);
    // Written and read again it is the same.
    assert_eq!(read_binary(&write_glb(&model), &mut |_| Err(String::new())).unwrap(), model);

    let changed = |path: &str, value: Value| {
        let mut document = document.clone();
        *document.pointer_mut(path).unwrap() = value;
        read_value(&document).unwrap_err().to_string()
    };
    assert_eq!(changed("/skins/0/joints/1", json!(7)), "skins[0].joints = 7: is one of 3 nodes");
    assert!(changed("/skins/0/joints", json!([1])).contains("a joint is one of the skin's 1"));
    assert_eq!(
        changed("/animations/0/channels/0/target/path", json!("weights")),
        "animations[0].channels[0].target.path = weights: morph targets are not read"
    );
    let mut spline = document.clone();
    spline["animations"][0]["samplers"][0]["interpolation"] = json!("CUBICSPLINE");
    assert_eq!(
        read_value(&spline).unwrap_err().to_string(),
        "animations[0].samplers[0].interpolation = CUBICSPLINE: LINEAR and STEP are read"
    );
}

#[test]
fn what_is_left_out_or_wrong_is_named() {
    let with = |path: &str, value: Value| {
        let mut document = triangle();
        let (parent, key) = path.rsplit_once('/').unwrap();
        document.pointer_mut(parent).unwrap()[key] = value;
        read_value(&document).unwrap_err().to_string()
    };
    let primitive = "/meshes/0/primitives/0";
    let cases = [
        (
            with("/extensionsRequired", json!(["KHR_draco_mesh_compression"])),
            "extensionsRequired = KHR_draco_mesh_compression: no extension is read",
        ),
        (with("/asset/version", json!("1.0")), "asset.version = 1.0: is 2.0"),
        (
            with(&format!("{primitive}/targets"), json!([{ "POSITION": 1 }])),
            "meshes[0].primitives[0].targets: morph targets are not read",
        ),
        (
            with(&format!("{primitive}/mode"), json!(5)),
            "meshes[0].primitives[0].mode = 5 (triangle strips): only triangles (4) are read",
        ),
        (
            with("/accessors/1/sparse", json!({ "count": 1 })),
            "accessors[1].sparse: sparse accessors are not read",
        ),
        (
            with("/accessors/1/count", json!(4)),
            "accessors[1] = 4 elements from byte 0: the view has 48 bytes",
        ),
        (
            with("/accessors/1/count", json!(1u64 << 60)),
            "accessors[1].count = 384307168202282325: at most 16777216 vertices, and as many triangles",
        ),
        (
            with("/accessors/1/byteOffset", json!(u64::MAX)),
            "accessors[1] = 3 elements from byte 18446744073709551615: the view has 48 bytes",
        ),
        (
            with("/accessors/1/type", json!("VEC2")),
            "accessors[1].type = VEC2: meshes[0].primitives[0].attributes.POSITION is VEC3",
        ),
        (
            with("/accessors/0/componentType", json!(5126)),
            "accessors[0].componentType = 5126: meshes[0].primitives[0].indices is of one of the types [5121, 5123, 5125]",
        ),
        (
            with("/accessors/0/count", json!(2)),
            "meshes[0].primitives[0].indices = 2: there are three for each triangle",
        ),
        (
            with("/accessors/2/count", json!(2)),
            "meshes[0].primitives[0].attributes.TEXCOORD_0 = 2: there is one for each of 3 positions",
        ),
        (
            with("/bufferViews/1/byteStride", json!(8)),
            "bufferViews[1].byteStride = 8: is from 12, the size of an element, to 252",
        ),
        (
            with("/bufferViews/1/byteLength", json!(999)),
            "bufferViews[1] = 999 bytes from 8: the buffer has 64 bytes",
        ),
        (with("/bufferViews/1/buffer", json!(3)), "bufferViews[1].buffer = 3: is one of 1 buffers"),
        (with("/buffers/0/byteLength", json!(65)), "buffers[0].byteLength = 65: the buffer has 64 bytes"),
        (with("/nodes/1/children", json!([0, 0])), "nodes[1].children = 0: a node has one parent"),
        (with("/nodes/0/children", json!([1])), "nodes: a node is not among its own descendants"),
        (with("/nodes/0/mesh", json!(2)), "nodes[0].mesh = 2: is one of 1 meshes"),
        (
            with("/nodes/0/rotation", json!([0, 0, 0, 2])),
            "nodes[0].rotation = [0.0, 0.0, 0.0, 2.0]: is a unit quaternion [x, y, z, w]",
        ),
        (with("/scene", json!(4)), "scene = 4: is one of 1 scenes"),
        (
            with("/materials/0/pbrMetallicRoughness/baseColorFactor", json!([2, 0, 0, 1])),
            "materials[0].pbrMetallicRoughness.baseColorFactor = [2, 0, 0]: from 0 to 1",
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
    assert!(
        with("/nodes/1/matrix", json!([2, 0, 0, 0, 1, 2, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1]))
            .ends_with("is made of a translation, a rotation and a scale")
    );
    let no_number = with("/scene", json!("first"));
    assert!(no_number.starts_with("line 1, column "), "{no_number}");
    assert!(no_number.ends_with(": invalid type: string \"first\", expected usize"), "{no_number}");
}

#[test]
fn a_container_is_checked_before_it_is_believed() {
    let model = read_value(&triangle()).unwrap();
    let glb = write_glb(&model);
    let read = |bytes: &[u8]| read_binary(bytes, &mut |_| Err(String::new()));
    assert_eq!(read(&glb).unwrap(), model);
    for cut in 0..glb.len() {
        assert!(read(&glb[..cut]).is_err(), "{cut} bytes");
    }
    let broken = |at: usize, word: u32| {
        let mut glb = glb.clone();
        glb[at..at + 4].copy_from_slice(&word.to_le_bytes());
        read(&glb).unwrap_err().to_string()
    };
    assert_eq!(broken(0, 7), "byte 0: a binary glTF file begins with glTF");
    assert_eq!(broken(4, 1), "byte 4 = 1: the version is 2");
    assert!(broken(12, u32::MAX).starts_with("byte 12 = 4294967295: the chunk ends with the file"));
}
