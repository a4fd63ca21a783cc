//! Drawings as editors write them: what draws right is accepted, what can't be drawn is refused where it would be seen, with what to do.

use crate::support::{SCENE, files, parse, png};
use kelir_scene::{Mask, Scene};

/// A square and a disk, of which all drawings here are made.
const SHAPES: &str = r#"<rect x="20" y="20" width="60" height="60"/><circle cx="50" cy="12" r="8"/>"#;

fn read(svg: &[u8], lines: &str) -> Result<Scene, String> {
    let mut files = files();
    files.insert("puppets/p.svg".into(), svg.to_vec());
    let scene =
        SCENE.replace("figure.toml", "p.svg").replace("texels = 128", &format!("texels = 100\n{lines}"));
    parse(&scene, &files).map_err(|e| e.to_string())
}

/// Opacity of the whole mask, in texels.
fn opacity(mask: &Mask) -> f64 {
    let all = (0..mask.height).flat_map(|y| (0..mask.width).map(move |x| (x, y)));
    all.map(|(x, y)| 1.0 - mask.transmittance(0, x, y)).sum()
}

/// A drawing of [`SHAPES`] with a root of these attributes and `before` and `after` around them.
fn around(root: &str, before: &str, after: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" {root}>{before}{SHAPES}{after}</svg>"
    )
}

const BOX: &str = "viewBox=\"0 0 100 100\"";

#[test]
fn what_draws_right_is_accepted() {
    let doctype = "<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\">";
    let entities = "<!DOCTYPE svg [<!ENTITY ns \"http://www.w3.org/2000/svg\">]>";
    let hidden = |what: &str| format!("<g inkscape:groupmode=\"layer\" style=\"display:none\">{what}</g>");
    let text = "<text x=\"10\" y=\"10\">hello</text>";
    let image = "<image width=\"100\" height=\"100\" xlink:href=\"scan.jpg\"/>";
    let mut drawings = vec![
        around(BOX, "", ""),
        format!(
            "{doctype}{}",
            around(
                &format!("version=\"1.1\" x=\"0px\" y=\"0px\" {BOX} enable-background=\"new 0 0 100 100\""),
                "",
                ""
            )
        ),
        format!(
            "{entities}{}",
            around(BOX, "", "").replace("xmlns=\"http://www.w3.org/2000/svg\"", "xmlns=\"&ns;\"")
        ),
        format!("\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\"?>{}", around(BOX, "", "")),
        around(BOX, "<g style=\"fill:#000;color-interpolation-filters:linearRGB;filter:none\">", "</g>"),
        around(BOX, "<defs><filter id=\"f\"><feGaussianBlur stdDeviation=\"2\"/></filter></defs>", ""),
        around(
            BOX,
            "<defs><marker id=\"m\"><path d=\"M0 0L1 1\"/></marker><pattern id=\"p\"><image href=\"x.png\"/></pattern></defs>",
            "",
        ),
        around(BOX, &hidden(text), ""),
        around(BOX, &hidden(image), ""),
        around(BOX, &format!("<style>.n{{display:none}}</style><g class=\"n\">{text}{image}</g>"), ""),
        around(BOX, &format!("<g visibility=\"hidden\">{text}</g>"), ""),
        around(BOX, "<text x=\"1\" y=\"1\"> <tspan/> </text>", ""),
        around(BOX, &format!("<defs>{text}</defs>"), ""),
        around(
            BOX,
            "<switch><foreignObject requiredExtensions=\"http://ns.adobe.com/x\" width=\"9\" height=\"9\"/><g>",
            "</g></switch>",
        ),
        around(BOX, "<a xlink:href=\"http://example.org/\">", "</a>"),
        around(BOX, "<svg width=\"100\" height=\"100\" viewBox=\"0 0 100 100\">", "</svg>"),
        around(BOX, "<script>alert(1)</script>", ""),
        around(BOX, "<g id=\"a\"/><g id=\"a\"/>", ""),
        around(
            BOX,
            "<style type=\"text/css\">.st0{fill:url(#g);}</style><linearGradient id=\"g\"><stop stop-color=\"#000\"/><stop offset=\"1\" stop-color=\"#f00\"/></linearGradient><g class=\"st0\">",
            "</g>",
        ),
        around(
            BOX,
            "<defs><style>.cls-1{fill:#231f20;}.cls-2{display:none;}</style></defs><g class=\"cls-1\">",
            "</g><rect class=\"cls-2\" width=\"100\" height=\"100\"/>",
        ),
        around(
            BOX,
            "<pattern id=\"q\" width=\"5\" height=\"5\" patternUnits=\"userSpaceOnUse\"><rect width=\"5\" height=\"5\"/></pattern><g fill=\"url(#q)\">",
            "</g>",
        ),
    ];
    for size in ["width=\"100%\" height=\"100%\"", "width=\"100\"", "height=\"50pt\""] {
        drawings.push(around(&format!("{size} {BOX}"), "", ""));
    }
    for unit in ["Q", "cm", "em", "in", "mm", "pc", "pt", "px", ""] {
        drawings.push(around(&format!("width=\"10{unit}\" height=\"10{unit}\" {BOX}"), "", ""));
    }
    let expected = 3600.0 + std::f64::consts::PI * 64.0;
    for drawing in &drawings {
        let scene = read(drawing.as_bytes(), "").unwrap_or_else(|e| panic!("{e}\n{drawing}"));
        let found = opacity(&scene.still().planes[0].mask);
        assert!((found - expected).abs() < 6.0, "{found}, not {expected}: {drawing}");
        assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
    }
    // Other encodings.
    let plain = around(BOX, "<!-- Pfeil über é -->", "");
    let latin: Vec<u8> = format!("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>{plain}")
        .chars()
        .map(|c| c as u32 as u8)
        .collect();
    let wide: Vec<u8> =
        [0xff, 0xfe].into_iter().chain(plain.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    assert!(read(&latin, "").is_ok() && read(&wide, "").is_ok());
    assert!(read(&latin[44..], "").unwrap_err().contains("save it as plain SVG"));
}

/// Sizes in units, without a view box: the drawing's user units are pixels of 1/96 inch.
#[test]
fn lengths_are_converted() {
    for (size, px) in [
        ("width=\"2in\" height=\"1in\"", [192.0, 96.0]),
        ("width=\"25.4mm\" height=\"50.8mm\"", [96.0, 192.0]),
        ("width=\"101.6Q\" height=\"72pt\"", [96.0, 96.0]),
    ] {
        let rect = format!("<rect width=\"{}\" height=\"{}\"/>", px[0] / 2.0, px[1] / 2.0);
        let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {size}>{rect}</svg>");
        let mask = &read(svg.as_bytes(), "").unwrap().still().planes[0].mask;
        let share = opacity(mask) / (mask.width * mask.height) as f64;
        assert!((share - 0.25).abs() < 0.01, "{share} of {size}");
        assert!((mask.width as f64 / mask.height as f64 - px[0] / px[1]).abs() < 0.02);
    }
}

#[test]
fn what_would_be_lost_is_refused_with_its_cure() {
    for (what, wanted) in [
        ("<text x=\"10\" y=\"10\">hello</text>", "Path › Object to Path"),
        ("<flowRoot><flowPara>hello</flowPara></flowRoot>", "Convert to Text"),
        ("<image width=\"9\" height=\"9\" xlink:href=\"scan.jpg\"/>", "trace it"),
        ("<foreignObject width=\"9\" height=\"9\"/>", "foreignObject"),
        ("<filter id=\"f\"/><g filter=\"url(#f)\"><rect width=\"9\" height=\"9\"/></g>", "Remove Filters"),
        ("<style>.f{filter:blur(2px)}</style><rect class=\"f\" width=\"9\" height=\"9\"/>", "has a filter"),
        ("<defs><g id=\"t\"><text>x</text></g></defs><use href=\"#t\"/>", "<text>"),
        ("<style>rect{fill:url(other.svg#g)}</style>", "draw it into this file"),
        ("<recct width=\"9\"/>", "none of SVG's elements"),
        (
            "<rect id=\"a\" width=\"9\" height=\"9\"/><g id=\"a\"/><use href=\"#a\"/>",
            "two elements of id \"a\"",
        ),
    ] {
        let said = read(around(BOX, what, "").as_bytes(), "").map(|_| ()).unwrap_err();
        assert!(said.contains(wanted), "{wanted:?} in {said}");
    }
    let unsized_ = read(around("", "", "").as_bytes(), "").unwrap_err();
    assert!(unsized_.contains("Resize to content"), "{unsized_}");
    // What is missing draws nothing anywhere: it is told, and drawn without.
    let odd = read(around(BOX, "<use href=\"#gone\"/>", "").as_bytes(), "").unwrap();
    assert!(odd.warnings()[0].to_string().contains("#gone"), "{:?}", odd.warnings());
}

/// Bombs: entities of entities, entities without end, markers on every vertex.
#[test]
fn what_explodes_is_refused() {
    let loud = format!(
        "<!DOCTYPE svg [<!ENTITY a \"{}\"><!ENTITY b \"&a;&a;\">]>{}",
        "x".repeat(999),
        around(BOX, "<desc>&b;</desc>", "")
    );
    assert!(read(loud.as_bytes(), "").unwrap_err().contains("entities"));
    let many = format!(
        "<!DOCTYPE svg [<!ENTITY a \"{}\">]>{}",
        "x".repeat(9999),
        around(BOX, &format!("<desc>{}</desc>", "&a;".repeat(9999)), "")
    );
    assert!(read(many.as_bytes(), "").unwrap_err().contains("entities"));
    let marked = format!(
        "<marker id=\"m\">{}</marker><path marker-mid=\"url(#m)\" d=\"M0 0{}\"/>",
        "<path d=\"M0 0h1v1\"/>".repeat(200),
        "h1".repeat(4000)
    );
    assert!(read(around(BOX, &marked, "").as_bytes(), "").unwrap_err().contains("draws more than"));
}

fn scan(file: &str, bytes: Vec<u8>, lines: &str) -> Result<Scene, String> {
    let mut files = files();
    files.insert(format!("puppets/{file}"), bytes);
    let scene = SCENE.replace("figure.toml", file).replace("texels = 128", lines);
    parse(&scene, &files).map_err(|e| e.to_string())
}

/// A scan without alpha is told, with its cure; the cure cures.
#[test]
fn scans_without_alpha_are_told() {
    // Dark left, light grey right.
    let paper =
        |alpha: u8| png(128, 128, move |x, _| if x < 64 { [0, 0, 0, 255] } else { [188, 188, 188, alpha] });
    let slab = scan("p.png", paper(255), "").unwrap();
    let told = slab.warnings()[0].to_string();
    assert!(
        told.contains("is this a scan without alpha?") && told.contains("alpha_from = \"luminance\""),
        "{told}"
    );
    let opacity_of =
        |lines: &str| opacity(&scan("p.png", paper(255), lines).unwrap().still().planes[0].mask) / 8192.0;
    assert!((opacity_of("") - 2.0).abs() < 1e-9);
    // sRGB code 188 is a luminance of 0.503.
    assert!(
        (opacity_of("alpha_from = \"luminance\"") - 1.497).abs() < 2e-3,
        "{}",
        opacity_of("alpha_from = \"luminance\"")
    );
    assert_eq!((opacity_of("alpha_from = 0.5"), opacity_of("alpha_from = 0.51")), (1.0, 2.0));
    for (bytes, lines) in
        [(paper(255), "alpha_from = 0.5"), (paper(255), "translucent = true"), (paper(0), "")]
    {
        assert!(scan("p.png", bytes, lines).unwrap().warnings().is_empty());
    }
    for (lines, wanted) in [("alpha_from = 1.5", "is \"luminance\""), ("alpha_from = \"dark\"", "luminance")]
    {
        let said = scan("p.png", paper(255), lines).unwrap_err();
        assert!(said.contains(wanted), "{said}");
    }
    assert!(
        read(around(BOX, "", "").as_bytes(), "alpha_from = 0.5")
            .unwrap_err()
            .contains("belongs to a PNG or JPEG")
    );
}

/// A JPEG of a red left half, with an EXIF orientation.
fn jpeg(orientation: u8) -> Vec<u8> {
    let image =
        image::RgbImage::from_fn(64, 32, |x, _| image::Rgb(if x < 32 { [255, 0, 0] } else { [255; 3] }));
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Jpeg).unwrap();
    let bytes = bytes.into_inner();
    let exif = [
        b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".as_slice(),
        &[orientation],
        b"\0\0\0\0\0\0",
    ]
    .concat();
    let head = [b"\xff\xd8\xff\xe1".as_slice(), &((exif.len() + 2) as u16).to_be_bytes(), &exif].concat();
    [head, bytes[2..].to_vec()].concat()
}

/// The orientation that a picture states is how it is seen.
#[test]
fn orientation_is_applied() {
    let cloth = |orientation: u8| {
        let mut files = files();
        files.insert("scenes/cloth.jpg".into(), jpeg(orientation));
        let scene =
            parse(&SCENE.replace("albedo = 0.8", "albedo = { image = \"cloth.jpg\" }"), &files).unwrap();
        let kelir_scene::Albedo::Image(image) = scene.still().screen.albedo else { panic!("an image") };
        let green = |x: usize, y: usize| image.channel(1)[y * image.width + x] > 0.5;
        let (right, bottom) = (image.width - 3, image.height - 3);
        (image.width, [green(2, 2), green(right, 2), green(2, bottom), green(right, bottom)])
    };
    assert_eq!(cloth(1), (64, [false, true, false, true]));
    assert_eq!(cloth(3), (64, [true, false, true, false]));
    assert_eq!(cloth(6), (32, [false, false, true, true]));
    assert_eq!(cloth(8), (32, [true, true, false, false]));
}

/// What a picture says of its gamma is applied, where its colours matter; what can't be is refused by name.
#[test]
fn gamma_is_applied() {
    let with = |name: &[u8; 4], content: &[u8]| {
        let whole = png(64, 64, |_, _| [200, 200, 200, 255]);
        let body = [name.as_slice(), content].concat();
        let chunk = [
            (content.len() as u32).to_be_bytes().as_slice(),
            &body,
            &crate::refused::crc(&body).to_be_bytes(),
        ]
        .concat();
        [&whole[..33], &chunk, &whole[33..]].concat()
    };
    let through = |bytes: Vec<u8>| {
        let scene = scan("p.png", bytes, "translucent = true").unwrap();
        scene.still().planes[0].mask.transmittance(0, 32, 32)
    };
    assert!((through(png(64, 64, |_, _| [200, 200, 200, 255])) - 0.578).abs() < 3e-3);
    assert!((through(with(b"gAMA", &100_000u32.to_be_bytes())) - 200.0 / 255.0).abs() < 3e-3);
    let wide = with(b"cICP", &[9, 16, 0, 1]);
    assert!(scan("p.png", wide.clone(), "translucent = true").unwrap_err().contains("cICP"));
    // Opaque is opaque, in whatever colours.
    assert!(scan("p.png", wide, "").is_ok());
}

#[test]
fn a_jpeg_that_is_cut_off_is_refused() {
    let whole = jpeg(1);
    assert!(scan("p.png", whole.clone(), "").is_ok());
    for length in [whole.len() - 1, whole.len() * 3 / 4] {
        assert!(scan("p.png", whole[..length].to_vec(), "").unwrap_err().contains("cut off"), "{length}");
    }
}
