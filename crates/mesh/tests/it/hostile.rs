//! Files that were damaged, by chance: they are read or refused, and nothing else.

use kelir_mesh::{Fault, Format, Mesh, Model, Unit, check, read, repair, write_glb};
use proptest::prelude::*;

/// A small surface with all that a vertex may have.
fn grid() -> Mesh {
    let n = 4u32;
    let at = |k: u32| (k as f32) / (n as f32);
    let vertices = || (0..=n).flat_map(move |y| (0..=n).map(move |x| (x, y)));
    let cell = |x: u32, y: u32| {
        let a = y * (n + 1) + x;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Mesh {
        positions: vertices().map(|(x, y)| [at(x), at(y), at(x) * at(y)]).collect(),
        triangles: (0..n).flat_map(|y| (0..n).flat_map(move |x| cell(x, y))).collect(),
        normals: Some(vec![[0.0, 0.0, 1.0]; 25]),
        texture: Some(vertices().map(|(x, y)| [at(x), at(y)]).collect()),
        base_colour: [0.25, 0.5, 1.0],
    }
}

fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from("o grid\n");
    for [x, y, z] in &mesh.positions {
        text += &format!("v {x} {y} {z}\n");
    }
    for [u, v] in mesh.texture.iter().flatten() {
        text += &format!("vt {u} {}\n", 1.0 - v);
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|index| index + 1)) {
        text += &format!("f {a}/{a} {b}/{b} {c}/{c}\n");
    }
    text.into_bytes()
}

fn ply(mesh: &Mesh, text: bool) -> Vec<u8> {
    let format = if text { "ascii" } else { "binary_little_endian" };
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for position in &mesh.positions {
        match text {
            true => bytes.extend(format!("{} {} {}\n", position[0], position[1], position[2]).bytes()),
            false => position.iter().for_each(|x| bytes.extend(x.to_le_bytes())),
        }
    }
    for triangle in &mesh.triangles {
        match text {
            true => bytes.extend(format!("3 {} {} {}\n", triangle[0], triangle[1], triangle[2]).bytes()),
            false => {
                bytes.push(3);
                triangle.iter().for_each(|index| bytes.extend(index.to_le_bytes()));
            }
        }
    }
    bytes
}

fn files() -> Vec<(Format, Vec<u8>)> {
    let mesh = grid();
    let glb = write_glb(&Model::from(mesh.clone()));
    // The same as text, its buffer beside it.
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let json = String::from_utf8_lossy(&glb[20..20 + length])
        .replace("{\"byteLength\"", "{\"uri\":\"a.bin\",\"byteLength\"");
    assert!(json.contains("a.bin"), "{json}");
    vec![
        (Format::Obj, obj(&mesh)),
        (Format::Ply, ply(&mesh, true)),
        (Format::Ply, ply(&mesh, false)),
        (Format::Gltf, json.into_bytes()),
        (Format::Glb, glb),
    ]
}

fn read_file(format: Format, bytes: &[u8]) -> Result<Model, Fault> {
    read(bytes, format, Unit::Millimetre, &mut |_| Ok(vec![7; 4096]))
}

#[test]
fn the_undamaged_files_are_read() {
    let expected = grid();
    for (format, bytes) in files() {
        let model = read_file(format, &bytes).expect("good");
        let mesh = model.merged(&model.rest());
        assert_eq!(mesh.positions.len(), 25, "{format:?}");
        assert_eq!(mesh.triangles.len(), 32, "{format:?}");
        if format != Format::Gltf {
            assert!((mesh.area() / expected.area() - 1e-6).abs() < 1e-12, "{format:?}: {}", mesh.area());
        }
    }
}

/// A change of a file's bytes.
#[derive(Clone, Debug)]
enum Damage {
    Set(usize, u8),
    Cut(usize),
    Repeat(usize, usize, usize),
    Put(usize, &'static str),
}

/// What stands in for a number.
const WORDS: &[&str] = &[
    "-1",
    "0",
    "99999999",
    "1e999",
    "nan",
    "4294967295",
    "18446744073709551615",
    "\n",
    " ",
    "/",
    "null",
    "[]",
    "{}",
    "-",
    "1.5",
];

fn damage() -> impl Strategy<Value = Damage> {
    prop_oneof![
        (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Damage::Set(at, byte)),
        any::<usize>().prop_map(Damage::Cut),
        (any::<usize>(), 0usize..64, 0usize..4)
            .prop_map(|(at, length, times)| Damage::Repeat(at, length, times)),
        (any::<usize>(), proptest::sample::select(WORDS)).prop_map(|(at, word)| Damage::Put(at, word)),
    ]
}

fn damaged(mut bytes: Vec<u8>, changes: &[Damage]) -> Vec<u8> {
    for change in changes {
        let length = bytes.len().max(1);
        match *change {
            Damage::Set(at, byte) => bytes.iter_mut().skip(at % length).take(1).for_each(|old| *old = byte),
            Damage::Cut(at) => bytes.truncate(at % length),
            Damage::Repeat(at, count, times) => {
                let from = at % length;
                let piece = bytes[from.min(bytes.len())..(from + count).min(bytes.len())].repeat(times);
                bytes.splice(from.min(bytes.len())..from.min(bytes.len()), piece);
            }
            Damage::Put(at, word) => {
                // In place of a word, if there is one: numbers are where files are most easily believed.
                let from = (at % length).min(bytes.len());
                let end = bytes[from..]
                    .iter()
                    .position(|byte| !byte.is_ascii_digit())
                    .map_or(bytes.len(), |end| from + end);
                bytes.splice(from..end, word.bytes());
            }
        }
    }
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(12), ..ProptestConfig::default() })]

    #[test]
    fn damaged_files_are_read_or_refused(which in 0usize..5, changes in proptest::collection::vec(damage(), 1..4)) {
        let (format, bytes) = files().swap_remove(which);
        let bytes = damaged(bytes, &changes);
        match read_file(format, &bytes) {
            Err(fault) => prop_assert!(!fault.rule.is_empty() && fault.to_string().len() < 400, "{fault}"),
            Ok(model) => {
                let mesh = model.merged(&model.rest());
                // All that is computed of it has an answer.
                let _ = (mesh.area(), mesh.bounds(), mesh.signed_volume(), mesh.hash());
                prop_assert_eq!(mesh.smooth_normals().len(), mesh.positions.len());
                let _ = check(&mesh);
                let mut repaired = mesh;
                repair(&mut repaired);
                let report = check(&repaired);
                prop_assert_eq!([report.out_of_range, report.zero_area, report.duplicates, report.unused_vertices], [0; 4]);
            }
        }
    }
}
