//! Files that a command is told to write: tried before the work that they are for, and written whole or not at all.

use std::path::Path;

use kelir_tests::{kelir, kelir_ok};

/// Runs a command that can't write `file`: it says so, and has printed and left nothing.
fn refused(args: &[&str], file: &Path, folder: &Path) {
    let out = kelir(args);
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert!(!out.status.success() && !said.contains("panicked"), "{args:?}: {said}");
    assert!(said.contains(file.to_str().unwrap()), "{args:?} does not name its file: {said}");
    assert!(out.stdout.is_empty(), "{args:?} printed {}", String::from_utf8_lossy(&out.stdout));
    let mut left: Vec<_> = folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["full", "taken"], "{args:?}");
}

/// A file where a folder should be, and a folder with something in it where a file should be.
#[test]
fn an_output_that_cannot_be_written_is_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("taken"), b"").unwrap();
    std::fs::create_dir(at("full")).unwrap();
    std::fs::write(at("full/file"), b"").unwrap();
    let data = tempfile::tempdir().unwrap();
    let data = data.path().to_str().unwrap();
    let good = at("good.json");
    let good = good.to_str().unwrap();
    for file in [at("taken/out"), at("full")] {
        let name = file.to_str().unwrap();
        let frames = ["bench", "frames", "kayon", "--technique", "pa", "--size", "64x36", "--frames", "1"];
        refused(&[&frames[..], &["--backend", "cpu", "--json", name]].concat(), &file, folder.path());
        refused(&["bench", "numerics", "--most", "64", "--json", name], &file, folder.path());
        refused(&["bench", "numerics", "--stats", "--json", name], &file, folder.path());
        let accuracy = ["bench", "accuracy", "kayon", "--size", "64x36", "--runs", "1", "--crops", "1"];
        let accuracy = [&accuracy[..], &["--only", "PCSS", "--json", good, "--plot", name]].concat();
        refused(&accuracy, &file, folder.path());
        refused(&["power", "--design", "shadow-puppets", "--json", name], &file, folder.path());
        let glb = file.with_extension("glb");
        if file.parent().is_some_and(|parent| parent.is_file()) {
            refused(&["mesh", "import", "nothing.obj", "-o", glb.to_str().unwrap()], &glb, folder.path());
            refused(&["mesh", "lod", "nothing.obj", "--triangles", "4", "-o", name], &file, folder.path());
        }
    }
    // What these read is missing too: the output is looked at first.
    for ending in ["html", "md", "csv", "xlsx"] {
        let file = at("taken").join("out").with_extension(ending);
        let command = if ["html", "md"].contains(&ending) { "report" } else { "export" };
        let said = kelir(&[command, "nothing", "--data", data, "-o", file.to_str().unwrap()]);
        let said = String::from_utf8_lossy(&said.stderr).into_owned();
        assert!(said.contains("taken"), "{said}");
    }
}

/// Figures replace a file of before, and leave nothing beside it.
#[test]
fn figures_are_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("figures.json");
    std::fs::write(&file, b"of before").unwrap();
    kelir_ok(&["bench", "numerics", "--stats", "--json", file.to_str().unwrap()]);
    let figures: serde_json::Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    assert!(figures.is_object());
    assert_eq!(folder.path().read_dir().unwrap().count(), 1);
}
