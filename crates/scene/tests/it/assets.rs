//! Scenes on disk: roots, links, devices, hashes.

use std::fs;

use crate::support::{Files, MANIFEST, PUPPET_SVG, SCENE, files, parse};
use kelir_scene::{Assets, DirAssets, Scene};

fn stage() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    for folder in ["stimuli/scenes", "stimuli/puppets"] {
        fs::create_dir_all(dir.path().join(folder)).unwrap();
    }
    let write = |path: &str, text: &str| fs::write(dir.path().join("stimuli").join(path), text).unwrap();
    write("scenes/a.toml", SCENE);
    write("puppets/figure.svg", PUPPET_SVG);
    write("puppets/figure.toml", MANIFEST);
    dir
}

#[test]
fn a_scene_in_a_scenes_folder_reaches_its_sibling_folders() {
    let dir = stage();
    let path = dir.path().join("stimuli/scenes/a.toml");
    let scene = Scene::from_path(&path).unwrap();
    assert_eq!(
        scene.sha256(),
        parse(SCENE, &files()).unwrap().sha256(),
        "disk or memory, it is the same scene"
    );
    // One level further up is out of bounds, even though the file is there.
    fs::write(dir.path().join("secret.svg"), PUPPET_SVG).unwrap();
    fs::write(&path, SCENE.replace("../puppets/figure.toml", "../../secret.svg")).unwrap();
    let errors = Scene::from_path(&path).unwrap_err().to_string();
    assert!(errors.starts_with(&*path.to_string_lossy()) && errors.contains("must not leave"), "{errors}");
    // A manifest's problems are told under its own path.
    fs::write(&path, SCENE).unwrap();
    fs::write(dir.path().join("stimuli/puppets/figure.toml"), "imagee = 1").unwrap();
    let errors = Scene::from_path(&path).unwrap_err().to_string();
    assert!(errors.contains(&*dir.path().join("stimuli/puppets/figure.toml").to_string_lossy()), "{errors}");
}

#[test]
fn links_and_devices_are_not_followed_out() {
    let dir = stage();
    let puppets = dir.path().join("stimuli/puppets");
    fs::write(dir.path().join("secret"), "secret").unwrap();
    std::os::unix::fs::symlink(dir.path().join("secret"), puppets.join("out")).unwrap();
    std::os::unix::fs::symlink("figure.svg", puppets.join("in")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", puppets.join("zero")).unwrap();
    let assets = DirAssets::new(dir.path().join("stimuli"));
    assert_eq!(assets.read("puppets/in").unwrap(), PUPPET_SVG.as_bytes());
    assert_eq!(assets.read("puppets/out").unwrap_err().kind(), std::io::ErrorKind::PermissionDenied);
    assert!(assets.read("puppets/zero").is_err());
    assert!(assets.read("puppets").is_err());
    assert!(assets.read("../secret").is_err());
    assert!(Scene::from_path(std::path::Path::new("/dev/zero")).is_err());
    assert!(Scene::from_path(&dir.path().join("stimuli")).is_err());
    assert!(
        Scene::from_path(&dir.path().join("nothing.toml")).unwrap_err().to_string().contains("can't be read")
    );
}

#[test]
fn the_hash_is_of_values_and_files_not_of_layout() {
    let hash = |scene: &str, files: &Files| parse(scene, files).unwrap().sha256().to_owned();
    let plain = hash(SCENE, &files());
    assert_eq!(plain.len(), 64);
    let laid_out = SCENE.replace("radiance = [40, 40.0, 30.5]", "radiance = [40.0, # warm\n  4e1,30.50]");
    assert_eq!(hash(&laid_out, &files()), plain);
    assert_ne!(hash(&SCENE.replace("30.5", "30.6"), &files()), plain);
    assert_ne!(
        hash(&SCENE.replace("texels = 128", "texels = 128\nbits = 8"), &files()),
        plain,
        "written out"
    );
    let mut other = files();
    other
        .insert("puppets/figure.svg".into(), PUPPET_SVG.replace("56\" height=\"8", "55\" height=\"8").into());
    assert_ne!(hash(SCENE, &other), plain);
    // A file that the scene doesn't name is none of its business.
    let mut more = files();
    more.insert("puppets/other.svg".into(), PUPPET_SVG.into());
    assert_eq!(hash(SCENE, &more), plain);
}
