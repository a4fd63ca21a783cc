//! `kelir mesh` as people use it: files in, a folder of levels out.

use std::path::Path;

use kelir_tests::{kelir, kelir_ok};
use serde_json::Value;

/// A pyramid in millimetres, one face turned round, one twice there, one vertex unused.
const PYRAMID: &str = "v 0 0 0\nv 100 0 0\nv 100 0 -100\nv 0 0 -100\nv 50 80 -50\nv 9 9 9\n\
    f 4 3 2 1\nf 1 2 5\nf 3 2 5\nf 3 4 5\nf 4 1 5\nf 5 4 1\n";

fn written(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Exit code 2, and what it says.
fn refused(args: &[&str]) -> String {
    let out = kelir(args);
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(2), "{args:?}: {said}");
    assert!(!said.contains("panicked"), "{said}");
    said
}

#[test]
fn a_broken_mesh_is_counted_refused_and_repaired() {
    let folder = tempfile::tempdir().unwrap();
    let file = written(folder.path(), "pyramid.obj", PYRAMID);
    let out = folder.path().join("pyramid.glb");
    let out = out.to_str().unwrap();
    let said = refused(&["mesh", "check", &file]);
    for fault in ["1 duplicate face", "3 edges with more than two faces", "3 edges between faces wound apart"]
    {
        assert!(said.contains(&format!("{file}: ")) && said.contains(fault), "no {fault}: {said}");
    }
    let report = kelir(&["mesh", "check", "--json", &file]);
    let report: Value = serde_json::from_slice(&report.stdout).unwrap();
    assert_eq!((&report[0]["good"], &report[0]["about"]["unused_vertices"]), (&false.into(), &1.into()));

    assert!(refused(&["mesh", "import", &file, "-o", out]).contains("--repair mends"));
    assert!(!Path::new(out).exists());
    let said = kelir_ok(&["mesh", "import", &file, "--unit", "mm", "--repair", "-o", out]);
    for done in
        ["5 vertices, 6 triangles, 1 part, closed, Euler number 2", "1 duplicate faces dropped", "1 unused"]
    {
        assert!(said.contains(done), "no {done}: {said}");
    }
    assert!(kelir_ok(&["mesh", "check", out]).contains("good"));
    // In metres now, and as another program reads a container: its length stands in the header.
    let bytes = std::fs::read(out).unwrap();
    assert_eq!(u32::from_le_bytes(bytes[8..12].try_into().unwrap()) as usize, bytes.len());
    let text = String::from_utf8_lossy(&bytes).into_owned();
    assert!(text.contains("\"max\":[0.10000000149011612,0.07999999821186066,0.0]"), "{text}");
    let wrong = out.replace(".glb", ".stl");
    assert!(refused(&["mesh", "import", &file, "--repair", "-o", &wrong]).contains("the name ends in .glb"));
    assert!(refused(&["mesh", "check", &wrong]).contains("ends in .obj, .ply, .gltf or .glb"));
    let bad = written(folder.path(), "bad.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n");
    assert!(refused(&["mesh", "check", &bad]).contains("bad.ply: line 4 = quad: an unknown type of number"));
}

#[test]
fn levels_are_written_measured_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("levels");
    let out = out.to_str().unwrap();
    let lod = |more: &[&str]| {
        let mut args = vec!["mesh", "lod", "hare", "-o", out, "--json"];
        args.extend(more);
        serde_json::from_str::<Value>(&kelir_ok(&args)).unwrap()
    };
    let first = lod(&["--triangles", "3000,401"]);
    assert_eq!(first["triangles"], 68_960);
    let levels = first["levels"].as_array().unwrap();
    let triangles: Vec<u64> = levels.iter().map(|level| level["triangles"].as_u64().unwrap()).collect();
    // A closed surface has an even number.
    assert_eq!(triangles, [3000, 400]);
    assert_eq!(levels[0]["missed"], Value::Null);
    assert!(levels[1]["missed"].as_str().unwrap().contains("takes two triangles with it"));
    for level in levels {
        assert_eq!(level["lost"], Value::Array(Vec::new()));
        let share = level["rms_share"].as_f64().unwrap();
        assert!(share > 1e-5 && share < 0.02 && level["hausdorff_share"].as_f64().unwrap() > share);
        let file = Path::new(out).join(level["file"].as_str().unwrap());
        let said = kelir_ok(&["mesh", "check", file.to_str().unwrap()]);
        assert!(said.contains(&format!("{} triangles, 1 part, closed", level["triangles"])), "{said}");
    }
    // Asked again it is what stands there, times and all; a file that was touched, or another setting, is made anew.
    assert_eq!(lod(&["--triangles", "3000,401"]), first);
    std::fs::write(Path::new(out).join("level-01-3000.glb"), b"touched").unwrap();
    let again = lod(&["--triangles", "3000,401"]);
    assert_eq!(again["levels"][0]["sha256"], first["levels"][0]["sha256"]);
    assert_ne!(std::fs::read(Path::new(out).join("level-01-3000.glb")).unwrap(), b"touched");
    let ladder = lod(&["--steps", "3", "--min", "200", "--normals"]);
    assert_ne!(ladder["key"], first["key"]);
    assert_eq!(ladder["levels"].as_array().unwrap().len(), 3);
    let mut names: Vec<String> = std::fs::read_dir(out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let mut expected: Vec<String> = ladder["levels"]
        .as_array()
        .unwrap()
        .iter()
        .map(|level| level["file"].as_str().unwrap().to_owned())
        .collect();
    expected.push("levels.json".to_owned());
    assert_eq!(names, expected);

    // The table says the same, and what is refused leaves the folder as it was.
    let table = kelir_ok(&["mesh", "lod", "hare", "-o", out, "--steps", "3", "--min", "200", "--normals"]);
    assert!(table.contains("as before") && table.contains("guided by positions and normals"), "{table}");
    let said = refused(&["mesh", "lod", "hare", "-o", out, "--triangles", "100,200"]);
    assert!(said.contains("200 triangles: each level has fewer than the one before it, here 100"), "{said}");
    let said = refused(&["mesh", "lod", "hare", "-o", out, "--steps", "3", "--min", "99999"]);
    assert!(said.contains("min = 99999: a level has fewer triangles than the mesh, here 68960"), "{said}");
    assert!(Path::new(out).join("levels.json").exists());
}

#[test]
fn what_ships_is_listed() {
    let models: Value = serde_json::from_str(&kelir_ok(&["mesh", "list", "--json"])).unwrap();
    let names: Vec<&str> = models.as_array().unwrap().iter().map(|m| m["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["hare", "amphora", "horse"]);
    assert_eq!(models[2]["nodes"].as_array().unwrap().len(), 5);
    assert!(kelir_ok(&["mesh", "list"]).contains("0.30 × 0.36 × 0.16 m"));
    let said = refused(&["mesh", "lod", "hare", "--unit", "mm", "--triangles", "300", "-o", "nowhere"]);
    assert!(said.contains("hare: unit = mm: a model that ships is in metres"), "{said}");
}
