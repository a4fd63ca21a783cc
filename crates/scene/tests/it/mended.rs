//! Drawings mended: what comes out is accepted, and is the same picture.

use crate::support::{SCENE, parse};
use kelir_scene::{Scene, mend};
use std::path::Path;

const XMLNS: &str = "xmlns=\"http://www.w3.org/2000/svg\"";
const SHAPES: &str =
    "<g id=\"a\"><rect x=\"20\" y=\"30\" width=\"50\" height=\"20\"/></g><path d=\"M10 90L90 60V90z\"/>";

/// A folder with a scene of this drawing.
fn folder(svg: &[u8]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.svg"), svg).unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE.replace("../puppets/figure.toml", "p.svg"))
        .unwrap();
    folder
}

fn read(folder: &Path) -> Result<Scene, String> {
    Scene::from_path(&folder.join("scene.toml")).map_err(|e| e.to_string())
}

/// The transmittances of a drawing's mask.
fn seen(svg: &str) -> Vec<f64> {
    let files = [("p.svg".to_owned(), svg.as_bytes().to_vec())].into();
    let scene = parse(&SCENE.replace("../puppets/figure.toml", "../p.svg"), &files);
    let mask = scene.unwrap_or_else(|e| panic!("{e}: {svg}")).still().planes[0].mask.clone();
    (0..mask.height)
        .flat_map(|y| (0..mask.width).map(move |x| (x, y)))
        .map(|(x, y)| mask.transmittance(0, x, y))
        .collect()
}

/// What is wrong, and how the good drawing looks beside it.
#[test]
fn what_can_be_mended_is_the_same_picture() {
    let boxed = format!("{XMLNS} viewBox=\"0 0 100 100\"");
    let good = format!("<svg {boxed}>{SHAPES}</svg>");
    let within = |what: &str| format!("<svg {boxed}>{SHAPES}{what}</svg>");
    for (wrong, same, said) in [
        (good.replace(XMLNS, ""), good.clone(), "its root says that it is an SVG"),
        (good.replace("viewBox", "width=\"big\" viewBox"), good.clone(), "width and height"),
        (
            good.replace("viewBox=\"0 0 100 100\"", ""),
            good.replace("0 0 100 100", "10 30 80 60"),
            "viewBox=\"10 30 80 60\"",
        ),
        (within("<recct width=\"9\"/>"), good.clone(), "<recct>"),
        (within("<use href=\"#gone\"/>"), good.clone(), "#gone"),
        (within("<rect width=\"9\" height=\"9\" style=\"fill:url(#gone)\"/>"), good.clone(), "url(#gone)"),
        (
            within("<use href=\"#a\" y=\"9\"/><g id=\"a\"/>"),
            within("<use href=\"#a\" y=\"9\"/>"),
            "called \"a-2\"",
        ),
        (within("<use xlink:href=\"#a\" y=\"9\"/>"), within("<use href=\"#a\" y=\"9\"/>"), "prefix xlink"),
    ] {
        let folder = folder(wrong.as_bytes());
        let before = read(folder.path());
        assert!(before.is_err() || !before.unwrap().warnings().is_empty(), "nothing is wrong: {wrong}");
        let mended = mend(&folder.path().join("scene.toml"))
            .unwrap()
            .remove(0)
            .result
            .unwrap_or_else(|e| panic!("{e:?}: {wrong}"));
        assert!(mended.changes.len() == 1 && mended.changes[0].contains(said), "{:?}", mended.changes);
        std::fs::write(folder.path().join("p.svg"), &mended.svg).unwrap();
        assert!(read(folder.path()).unwrap().warnings().is_empty(), "{}", mended.svg);
        assert!(seen(&mended.svg) == seen(&same), "{}", mended.svg);
    }
    // What only does not say that it is an SVG is drawn as it is.
    assert!(seen(&good.replace(XMLNS, "")) == seen(&good));
    // Bytes that are no UTF-8.
    let latin: Vec<u8> = within("<!-- é -->").chars().map(|c| c as u32 as u8).collect();
    let mended = mend(&folder(&latin).path().join("scene.toml")).unwrap().remove(0).result.unwrap();
    assert!(mended.svg.contains("<!-- é -->") && mended.changes == ["it is written as UTF-8"]);
}

#[test]
fn a_part_becomes_a_group() {
    let svg = format!("<svg {XMLNS} viewBox=\"0 0 100 100\"><path id=\"arm\" d=\"M10 90L90 60V90z\"/></svg>");
    let folder = folder(svg.as_bytes());
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE.replace("../puppets/figure.toml", "m.toml")).unwrap();
    std::fs::write(
        folder.path().join("m.toml"),
        crate::support::MANIFEST.split("[[parts]]").next().unwrap().replace("figure.svg", "p.svg")
            + "[[parts]]\nid = \"arm\"\n",
    )
    .unwrap();
    assert!(read(folder.path()).unwrap_err().contains("group it by itself"));
    let mended = mend(&scene).unwrap().remove(0).result.unwrap();
    std::fs::write(folder.path().join("p.svg"), &mended.svg).unwrap();
    assert!(read(folder.path()).unwrap().warnings().is_empty(), "{}", mended.svg);
    assert!(mended.changes[0].contains("group of its own"), "{:?}", mended.changes);
}

/// What would be lost stays the researcher's to export: nothing comes out, and every reason does.
#[test]
fn what_would_look_otherwise_is_not_mended() {
    for (what, wanted) in [
        ("<text x=\"10\" y=\"10\">hello</text><recct/>", "Object to Path"),
        ("<use href=\"other.svg#a\"/>", "draw it into this file"),
        // Without it, the other element of that id would be meant.
        ("<use href=\"#b\"/><g id=\"b\"><text>x</text></g>", "<text>"),
    ] {
        let folder = folder(format!("<svg {XMLNS} viewBox=\"0 0 100 100\">{SHAPES}{what}</svg>").as_bytes());
        let wrong = mend(&folder.path().join("scene.toml")).unwrap().remove(0).result.unwrap_err();
        assert!(wrong.iter().any(|rule| rule.contains(wanted)), "{wrong:?}");
    }
    let good = folder(format!("<svg {XMLNS} viewBox=\"0 0 100 100\">{SHAPES}</svg>").as_bytes());
    assert!(mend(&good.path().join("scene.toml")).unwrap().is_empty());
}
