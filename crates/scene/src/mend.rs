//! The drawings of a scene that can't be drawn as they are, mended.

use std::path::{Path, PathBuf};

use crate::assets::{Assets, DirAssets, read_file, resolve, root_of};
use crate::limits;
use crate::puppet::svg::{self, Mended};

/// A drawing with which something is wrong.
#[derive(Debug)]
pub struct Mending {
    /// The drawing's file.
    pub drawing: PathBuf,
    /// The drawing mended, or what can't be, with its cure.
    pub result: Result<Mended, Vec<String>>,
}

/// Looks at every SVG that a scene file's puppets name, by themselves or by their manifests, each once; what is good isn't listed.
///
/// # Errors
/// The scene, a manifest or a drawing can't be read.
pub fn mend(scene: &Path) -> Result<Vec<Mending>, String> {
    let (root, name) = root_of(scene);
    let assets = DirAssets::new(&root);
    let text = read_file(scene, limits::SCENE_BYTES)
        .map_err(|e| format!("{} can't be read: {e}", scene.display()))?;
    let puppets = table(&text, &scene.display().to_string())?;
    let mut mendings: Vec<Mending> = Vec::new();
    let images = puppets.get("puppets").and_then(toml::Value::as_array).into_iter().flatten();
    for image in images.filter_map(|puppet| puppet.get("image")?.as_str()) {
        let (mut path, mut parts) = (resolve(&name, image)?, Vec::new());
        let read = |path: &str| {
            assets.read(path).map_err(|e| format!("{} can't be read: {e}", root.join(path).display()))
        };
        if path.to_ascii_lowercase().ends_with(".toml") {
            let manifest = table(&read(&path)?, &root.join(&path).display().to_string())?;
            let named = manifest.get("parts").and_then(toml::Value::as_array).into_iter().flatten();
            parts = named.filter_map(|part| Some(part.get("id")?.as_str()?.to_owned())).collect();
            path = resolve(&path, manifest.get("image").and_then(toml::Value::as_str).unwrap_or_default())?;
        }
        let drawing = root.join(&path);
        if path.to_ascii_lowercase().ends_with(".svg")
            && mendings.iter().all(|known| known.drawing != drawing)
        {
            let result = svg::mend(&read(&path)?, &parts);
            mendings.extend(result.map(|result| Mending { drawing, result }));
        }
    }
    Ok(mendings)
}

fn table(text: &[u8], label: &str) -> Result<toml::Table, String> {
    let text = std::str::from_utf8(text).map_err(|_| format!("{label} is not UTF-8 text"))?;
    text.parse().map_err(|e: toml::de::Error| format!("{label}: {}", e.message()))
}
