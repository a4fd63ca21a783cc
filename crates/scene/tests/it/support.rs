//! Small scenes and puppets to test with.

use std::collections::BTreeMap;
use std::io::Cursor;

use kelir_scene::{Mask, Problems, Scene};

pub(crate) type Files = BTreeMap<String, Vec<u8>>;

/// A square in its view box's middle with a bar that turns about the square's centre, and a leaf at the bar's end.
pub(crate) const PUPPET_SVG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 128 128">
  <g id="body"><rect x="32" y="32" width="64" height="64" fill="#000"/></g>
  <g id="bar"><rect x="60" y="60" width="56" height="8" fill="#000"/></g>
  <g id="leaf"><rect x="108" y="56" width="16" height="16" fill="#000"/></g>
</svg>"##;

pub(crate) const MANIFEST: &str = r#"
title = "A test figure"
source = "drawn for kelir"
license = "MIT OR Apache-2.0"
image = "figure.svg"
[[parts]]
id = "body"
[[parts]]
id = "bar"
parent = "body"
pivot = [64.0, 64.0]
limits_deg = [-120, 180]
[[parts]]
id = "leaf"
parent = "bar"
pivot = [112, 64]
"#;

/// A valid scene with one articulated puppet.
pub(crate) const SCENE: &str = r#"
[screen]
width_m = 1.6
height_m = 0.9
albedo = 0.8

[lamp]
position_m = [0.0, 0.0, -1.5]
[[lamp.emitters]]
name = "inner"
shape = "rectangle"
size_m = [0.02, 0.02]
radiance = 2000.0
[[lamp.emitters]]
name = "outer"
shape = "rectangle"
size_m = [0.1, 0.1]
radiance = [40, 40.0, 30.5]

[ambient]
model = "none"

[[puppets]]
image = "../puppets/figure.toml"
height_m = 0.6
position_m = [0.0, 0.0, -0.2]
texels = 128

[exposure]
white = "auto"
"#;

pub(crate) fn files() -> Files {
    let mut files = Files::new();
    files.insert("puppets/figure.svg".into(), PUPPET_SVG.into());
    files.insert("puppets/figure.toml".into(), MANIFEST.into());
    files
}

/// A PNG of RGBA pixels.
pub(crate) fn png(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let image = image::RgbaImage::from_fn(width, height, |x, y| image::Rgba(pixel(x, y)));
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

pub(crate) fn parse(toml: &str, files: &Files) -> Result<Scene, Problems> {
    Scene::parse("scenes/test.toml", toml, files)
}

/// The codes of channel `c`, row by row.
pub(crate) fn rows(mask: &Mask, c: usize) -> Vec<Vec<u32>> {
    let code = |x, y| (mask.transmittance(c, x, y) * f64::from(mask.max_code())).round() as u32;
    (0..mask.height).map(|y| (0..mask.width).map(|x| code(x, y)).collect()).collect()
}
