//! Drawings that are refused or warned about, mended by `kelir scene check --fix-drawing`.

use std::path::Path;

use kelir_tests::{kelir, kelir_ok};

const XMLNS: &str = "xmlns=\"http://www.w3.org/2000/svg\"";

/// A square with a hole, and what an editor left behind: an element that SVG doesn't have, a reference to nothing.
const WRONG: &str = r##"<svg viewBox="0 0 100 100"><recct width="9"/><use href="#gone"/>
    <path fill-rule="evenodd" d="M10 10h80v80h-80zM30.3 30h40v40h-40z"/></svg>"##;
const BROKEN: &str = r#"<svg viewBox="0 0 100 100"><circle cx="50" cy="50" r="40"/><image width="9" height="9" href="x.png"/></svg>"#;

/// The first as one mends it by hand.
fn by_hand() -> String {
    WRONG
        .replace("<svg", &format!("<svg {XMLNS}"))
        .replace("<recct width=\"9\"/>", "")
        .replace("<use href=\"#gone\"/>", "")
}

/// A folder with a scene of these drawings, `0.svg`, `1.svg` …, side by side.
fn folder(drawings: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = "[screen]\nwidth_m = 1.6\nheight_m = 0.9\nalbedo = 0.8\n[lamp]\nposition_m = [0.0, 0.0, -1.5]\n\
        [[lamp.emitters]]\nname = \"flame\"\nshape = \"rectangle\"\nsize_m = [0.02, 0.02]\nradiance = 2000.0\n"
        .to_owned();
    for (k, drawing) in drawings.iter().enumerate() {
        std::fs::write(folder.path().join(format!("{k}.svg")), drawing).unwrap();
        let x = 0.3 * k as f64;
        scene += &format!(
            "[[puppets]]\nimage = \"{k}.svg\"\nheight_m = 0.2\nposition_m = [{x:?}, 0.0, -0.2]\ntexels = 64\n"
        );
    }
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    folder
}

fn fix(folder: &Path, out: &Path) -> std::process::Output {
    let scene = folder.join("scene.toml");
    kelir(&["scene", "check", scene.to_str().unwrap(), "--fix-drawing", out.to_str().unwrap()])
}

/// What is said of a fix that is refused; it has left the folder as it was.
fn refused(folder: &Path, out: &Path) -> String {
    let before = names(folder);
    let output = fix(folder, out);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && output.stdout.is_empty() && !said.contains("panicked"), "{said}");
    assert_eq!(names(folder), before, "{said}");
    said
}

fn names(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entry = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.unwrap().path();
        (path.display().to_string(), std::fs::read(&path).unwrap_or_default())
    };
    let mut all: Vec<_> = folder.read_dir().unwrap().map(entry).collect();
    all.sort();
    all
}

/// The pixels that a folder's scene is drawn with.
fn drawn(folder: &Path) -> Vec<u8> {
    let (scene, out) = (folder.join("scene.toml"), folder.join("out.png"));
    let [scene, name] = [&scene, &out].map(|path| path.to_str().unwrap());
    kelir_ok(&["render", scene, "--technique", "pa", "--size", "160x90", "--backend", "cpu", "-o", name]);
    image::open(&out).unwrap().into_rgb8().into_raw()
}

#[test]
fn a_drawing_is_mended_as_one_would_by_hand() {
    let wrong = folder(&[WRONG]);
    let path = wrong.path();
    let refusal = kelir(&["scene", "check", path.join("scene.toml").to_str().unwrap()]);
    assert_eq!(refusal.status.code(), Some(2), "nothing is wrong");
    let out = path.join("new/mended.svg");
    let output = fix(path, &out);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for phrase in ["mended.svg: ", "0.svg, mended:", "says that it is an SVG", "<recct>", "<use> of #gone"] {
        assert!(said.contains(phrase), "no {phrase:?} in {said}");
    }
    assert_eq!(std::fs::read_to_string(path.join("0.svg")).unwrap(), WRONG, "the drawing itself is kept");
    // Put in its place it is accepted, without a warning, and drawn as what was mended by hand.
    std::fs::copy(&out, path.join("0.svg")).unwrap();
    let scene = path.join("scene.toml");
    let accepted = kelir_ok(&["scene", "check", scene.to_str().unwrap()]);
    assert!(accepted.contains("good (") && !accepted.contains("warning"), "{accepted}");
    assert!(drawn(path) == drawn(folder(&[&by_hand()]).path()));
    // Control: another hole would be seen.
    assert!(drawn(path) != drawn(folder(&[&by_hand().replace("h40v40h-40z", "h40v38h-40z")]).path()));
    let again =
        kelir_ok(&["scene", "check", scene.to_str().unwrap(), "--fix-drawing", out.to_str().unwrap()]);
    assert!(again.contains("no drawing needs mending"), "{again}");
}

#[test]
fn several_drawings_go_into_a_folder() {
    let wrong = folder(&[WRONG, &by_hand(), &WRONG.replace("h40v40h-40z", "h40v38h-40z")]);
    let path = wrong.path();
    let said = refused(path, &path.join("mended.svg"));
    assert!(said.contains("0.svg") && said.contains("2.svg") && said.contains("FOLDER/"), "{said}");
    let said = refused(path, path);
    assert!(said.contains("0.svg is a file of the scene, which is kept"), "{said}");
    let out = path.join("mended/");
    assert!(fix(path, &out.join("")).status.success());
    let mended: Vec<String> = names(&out).into_iter().map(|(name, _)| name).collect();
    assert_eq!(mended, [out.join("0.svg"), out.join("2.svg")].map(|path| path.display().to_string()));
    for name in ["0.svg", "2.svg"] {
        std::fs::copy(out.join(name), path.join(name)).unwrap();
    }
    let scene = path.join("scene.toml");
    assert!(!kelir_ok(&["scene", "check", scene.to_str().unwrap()]).contains("warning"));
    // One that can't be mended keeps the others from being written, too.
    let broken = folder(&[WRONG, BROKEN]);
    let said = refused(broken.path(), &broken.path().join("mended").join(""));
    assert!(said.contains("1.svg: has <image>") && said.contains("nothing is written"), "{said}");
}

#[test]
fn what_the_scene_is_made_of_is_kept_and_what_cannot_be_written_is_told_first() {
    let wrong = folder(&[WRONG]);
    let path = wrong.path();
    for kept in ["0.svg", "scene.toml"] {
        assert!(refused(path, &path.join(kept)).contains("a file of the scene, which is kept"));
    }
    // A file where a folder should be: told before the drawing is looked at, which can't be mended either.
    let broken = folder(&[BROKEN]);
    let said = refused(broken.path(), &broken.path().join("scene.toml/mended.svg"));
    assert!(said.contains("scene.toml/mended.svg") && !said.contains("image"), "{said}");
}
