//! What invalid scenes are refused for.

use crate::support::{Files, MANIFEST, PUPPET_SVG, SCENE, files, parse, png};

fn messages(scene: &str) -> Vec<String> {
    let errors = parse(scene, &files()).expect_err("must be refused");
    errors.to_string().lines().map(str::to_owned).collect()
}

#[test]
fn a_puppet_on_the_audience_side_is_refused_in_the_issues_words() {
    let scene = SCENE.replace("[0.0, 0.0, -0.2]", "[0.0, 0.0, 0.3]");
    assert_eq!(
        messages(&scene),
        [
            "scenes/test.toml:26:25: puppets[0].position_m[2] = 0.3: a puppet hangs backstage, between lamp (−1.5) and screen (0)"
        ]
    );
}

#[test]
fn every_problem_is_reported() {
    let scene = SCENE
        .replace("width_m = 1.6", "widht_m = 1.6")
        .replace("albedo = 0.8", "albedo = [0.8, nan, 2]")
        .replace("size_m = [0.02, 0.02]", "size_m = [0, 0.02]")
        .replace("radiance = 2000.0", "radiance = -1")
        .replace("name = \"outer\"", "name = 3")
        .replace("[0.0, 0.0, -0.2]", "[0.0, 0.0]")
        .replace("model = \"none\"", "model = \"papr\"")
        .replace("texels = 128", "pose = { leef = 3.0 }\nrotate_deg = inf")
        .replace("white = \"auto\"", "white = 0");
    let found = messages(&scene);
    let expected = [
        "screen.width_m: is missing",
        "screen.albedo[1] = nan: a number must be finite",
        "screen.albedo[2] = 2: an albedo is between 0 and 1",
        "screen.widht_m = 1.6: is not a known key (did you mean width_m?)",
        "lamp.emitters[0].size_m[0] = 0: a length is",
        "lamp.emitters[0].radiance = -1: a radiance is",
        "lamp.emitters[1].name = 3: a string is wanted here",
        "ambient.model = \"papr\": must be one of none, paper and dome (did you mean paper?)",
        "exposure.white = 0: white is",
        "puppets[0].position_m = [0.0, 0.0]: must have 3 numbers, not 2",
        "puppets[0].rotate_deg = inf: a number must be finite",
        "puppets[0].pose.leef = 3.0: no such part (did you mean leaf?); parts are body, bar and leaf",
    ];
    for wanted in expected {
        assert!(found.iter().any(|m| m.contains(wanted)), "{wanted:?} in {found:#?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:#?}");
}

/// Parses the scene after `edits` (from, to), each of which must apply, with changed files; its problems.
fn problems_of(edits: &[(&str, &str)], files: &Files) -> Vec<String> {
    let scene = edits.iter().fold(SCENE.to_owned(), |scene, (from, to)| {
        assert!(scene.contains(from), "the scene has no {from:?}");
        scene.replacen(from, to, 1)
    });
    match parse(&scene, files) {
        Ok(_) => Vec::new(),
        Err(errors) => errors.to_string().lines().map(str::to_owned).collect(),
    }
}

/// Exactly one problem, whose message holds `wanted`.
fn refused_once(edits: &[(&str, &str)], files: &Files, wanted: &str) {
    let found = problems_of(edits, files);
    assert!(found.len() == 1 && found[0].contains(wanted), "{wanted:?} for {edits:?} in {found:#?}");
}

/// What there is no drawing for is refused by name, whatever sections it has; a theatre may say that it is one.
#[test]
fn another_subject_cannot_be_drawn_yet() {
    let found = messages("subject = \"plate\"\n[photograph]\nfile = \"a.png\"\n");
    let what = "a photographed shadow can't be drawn yet, only a \"theatre\" or a \"stage\"";
    assert_eq!(found, [format!("scenes/test.toml:1:11: subject = \"plate\": {what}")]);
    assert!(parse(&format!("subject = \"theatre\"\n{SCENE}"), &files()).is_ok());
}

#[test]
fn each_rule_of_a_scene_is_kept() {
    let position = "[0.0, 0.0, -0.2]";
    let emitter = "name = \"inner\"\nshape = \"rectangle\"\nsize_m = [0.02, 0.02]";
    #[rustfmt::skip]
    let cases: &[(&str, &str, &str)] = &[
        ("[screen]", "subject = \"theater\"\n[screen]", "must be one of theatre, stage and plate (did you mean theatre?)"),
        ("width_m = 1.6", "width_m = -1.6", "screen.width_m = -1.6: a length is"),
        ("width_m = 1.6", "width_m = 1e-300", "screen.width_m = 1e-300: a length is"),
        ("width_m = 1.6", "width_m = \"wide\"", "screen.width_m = \"wide\": a number is wanted here, not a string"),
        ("width_m = 1.6", "width_m = 99999999999999999999", "must fit 64 bits"),
        ("width_m = 1.6", "width_m = 1.6\nwidth_m = 1.7", "scenes/test.toml:4:1: width_m: is no TOML: duplicate key"),
        ("albedo = 0.8", "albedo = 1.01", "screen.albedo = 1.01: an albedo is between 0 and 1"),
        ("albedo = 0.8", "albedo = { image = \"a.png\", weave = {} }", "either an image or a weave"),
        ("albedo = 0.8", "albedo = { weave = { threads = 0 } }", "screen.albedo.weave.threads = 0: threads across"),
        ("albedo = 0.8", "albedo = { image = \"a.png\" }", "there is no file scenes/a.png"),
        ("albedo = 0.8", "albedo = 0", "lamp or cloth are black"),
        ("[0.0, 0.0, -1.5]", "[0.0, 0.0, 1.5]", "lamp.position_m[2] = 1.5: the lamp is backstage"),
        ("[0.0, 0.0, -1.5]", "[0.0, 2e6, -1.5]", "lamp.position_m[1] = 2e6: a coordinate is"),
        ("name = \"outer\"", "name = \"inner\"", "lamp.emitters[1]: an emitter's name must be unique"),
        ("name = \"outer\"", "name = \"o.R\"", "lamp.emitters[1].name = \"o.R\": a name has"),
        (emitter, "name = \"inner\"\nshape = \"disk\"\nradius_m = 0", "lamp.emitters[0].radius_m = 0: a length is"),
        (emitter, "name = \"inner\"\nshape = \"circle\"", "must be one of rectangle and disk"),
        ("radiance = 2000.0", "radiance = [1, 2]", "lamp.emitters[0].radiance = [1, 2]: must have 3 numbers, not 2"),
        ("model = \"none\"", "model = \"none\"\nk_d_m = 1", "ambient.k_d_m = 1: belongs to model = \"paper\""),
        ("model = \"none\"", "model = \"paper\"\nk_d_m = 1", "ambient.s: is missing"),
        ("model = \"none\"", "model = \"paper\"\ns = 1.5\nk_d_m = 1", "ambient.s = 1.5: is a share"),
        ("model = \"none\"", "model = \"dome\"\nradiance = -1", "ambient.radiance = -1: a radiance is"),
        ("white = \"auto\"", "white = \"bright\"", "exposure.white = \"bright\": must be one of auto"),
        ("[exposure]", "[exposre]", "exposre: is not a known key (did you mean exposure?)"),
        ("texels = 128", "texels = 63", "puppets[0].texels = 63: a puppet's grid has 64 to 8192 rows"),
        ("texels = 128", "bits = 12", "puppets[0].bits = 12: a mask has 8 or 16 bits"),
        ("texels = 128", "tilt_deg = [90, 0]", "puppets[0].tilt_deg[0] = 90: a tilt is between"),
        ("texels = 128", "translucent = 1", "puppets[0].translucent = 1: true or false is wanted here"),
        ("texels = 128", "pose = { bar = -121 }", "puppets[0].pose.bar = -121: part \"bar\" turns from -120 to 180"),
        ("texels = 128", "pose = { body = 5 }", "part \"body\" has no pivot"),
        (position, "[0.0, 0.0, -1.5]", "puppets[0].position_m[2] = -1.5: a puppet hangs backstage"),
        (position, "[0.0, 0.0, 0]", "puppets[0].position_m[2] = 0: a puppet hangs backstage"),
        ("figure.toml", "figure.gif", "is an .svg, a .png or a .toml puppet manifest"),
        ("../puppets/figure.toml", "/etc/passwd.svg", "never absolute"),
        ("../puppets/figure.toml", "../../x.svg", "must not leave the folder"),
        ("../puppets/figure.toml", "..\\\\x.svg", "without '\\'"),
        ("../puppets/figure.toml", "../puppets/other.svg", "there is no file puppets/other.svg"),
    ];
    for (from, to, wanted) in cases {
        refused_once(&[(from, to)], &files(), wanted);
    }
    // Control: unedited, and with harmless edits, nothing is refused.
    assert_eq!(problems_of(&[], &files()), Vec::<String>::new());
    for (from, to) in [
        ("albedo = 0.8", "albedo = 1"),
        ("texels = 128", "tilt_deg = [20, -10]"),
        (position, "[9, 9, -1e-9]"),
    ] {
        assert_eq!(problems_of(&[(from, to)], &files()), Vec::<String>::new(), "{to}");
    }
}

#[test]
fn corners_beyond_lamp_or_screen_are_refused() {
    // Half the height is 0.3; tilted by 60° about x its upper edge comes 0.26 nearer to the audience.
    let tilted = ("texels = 128", "texels = 128\ntilt_deg = [60, 0]");
    refused_once(
        &[tilted],
        &files(),
        "puppets[0].tilt_deg = [60, 0]: a corner of the puppet's grid is at z = 0.0598",
    );
    let back = ("[0.0, 0.0, -0.2]", "[0.0, 0.0, -0.3]");
    assert_eq!(problems_of(&[tilted, back], &files()), Vec::<String>::new());
    // Turned by 45° the figure has no margin around it any more, and comes less far up.
    let turned = ("texels = 128", "texels = 128\ntilt_deg = [60, 0]\nrotate_deg = 45");
    let between = ("[0.0, 0.0, -0.2]", "[0.0, 0.0, -0.22]");
    assert_eq!(problems_of(&[turned, between], &files()), Vec::<String>::new());
    refused_once(&[tilted, between], &files(), "a corner of the puppet's grid");
    // The lamp's side.
    let near = ("[0.0, 0.0, -0.2]", "[0.0, 0.0, -1.3]");
    refused_once(&[tilted, near], &files(), "is at z = −1.5598");
}

#[test]
fn every_line_of_bad_toml_is_named() {
    let found = problems_of(
        &[("width_m = 1.6", "width_m == 1.6"), ("radiance = 2000.0", "radiance = 2,0")],
        &files(),
    );
    assert!(found.iter().any(|m| m.contains("toml:3:")), "{found:#?}");
    assert!(found.iter().any(|m| m.contains("toml:13:")), "{found:#?}");
    let deep = "a = ".to_owned() + &"[".repeat(100_000);
    assert!(parse(&deep, &files()).is_err());
    let long = format!("# {}", "x".repeat(1 << 20));
    assert!(parse(&long, &files()).unwrap_err().to_string().contains("at most 1048576"));
}

#[test]
fn timelines_are_checked_at_every_frame_and_key() {
    let timeline = |tracks: &str| format!("{SCENE}[timeline]\nfps = 10\nseconds = 2.0\n{tracks}");
    let track =
        |target: &str, keys: &str| format!("[[timeline.tracks]]\ntarget = \"{target}\"\nkeys = [{keys}]\n");
    #[rustfmt::skip]
    let cases = [
        (track("puppets[0].position_m", "{ t = 0, value = [0, 0, -0.2] }, { t = 1, value = [0, 0, 0.2] }"),
         "timeline: at 0.5 s puppets[0].position_m[2] is 0: a puppet hangs backstage"),
        (track("lamp.position_m", "{ t = 0, value = [0, 0, -0.1] }"), "between lamp (−0.1) and screen (0)"),
        (track("puppets[0].tilt_deg", "{ t = 1.3, value = [0, 0] }, { t = 1.31, value = [80, 0] }, { t = 1.32, value = [0, 0] }"),
         "timeline: at 1.31 s puppets[0] is out of place: a corner"),
        (track("puppets[0].pose.bar", "{ t = 0, value = 200 }"), "timeline.tracks[0].keys[0].value = 200: part \"bar\" turns"),
        (track("puppets[0].pose.arm", "{ t = 0, value = 0 }"), "timeline.tracks[0].target = \"puppets[0].pose.arm\": no such part"),
        (track("puppets[1].rotate_deg", "{ t = 0, value = 0 }"), "there is no puppets[1]; the scene has 1 puppets"),
        (track("puppets[0].height_m", "{ t = 0, value = 0 }"), "targets are lamp.position_m and"),
        (track("puppets[0].rotate_deg", "{ t = 0, value = nan }"), "keys[0].value = nan: a number must be finite"),
        (track("puppets[0].rotate_deg", "{ t = 2.5, value = 1 }"), "keys[0].t = 2.5: a key's time is from 0 s"),
        (track("puppets[0].rotate_deg", "{ t = 1, value = 1 }, { t = 1, value = 2 }"), "keys come in the order of time"),
        (track("puppets[0].rotate_deg", ""), "a track has at least one key"),
        (track("puppets[0].rotate_deg", "{ t = 1, value = 1 }").repeat(2), "timeline.tracks[1]: drives what"),
    ];
    for (tracks, wanted) in &cases {
        let errors = parse(&timeline(tracks), &files()).expect_err(wanted);
        let found = errors.to_string();
        assert!(errors.len() == 1 && found.contains(wanted), "{wanted:?} in {found}");
    }
    for (from, to, wanted) in [
        ("fps = 10", "fps = 0", "timeline.fps = 0: frames a second"),
        ("fps = 10", "fps = 1000\n#", "fps × seconds is"),
        ("seconds = 2.0", "seconds = 1e5", "timeline.seconds = 1e5: the length"),
    ] {
        let text = timeline("")
            .replace(from, to)
            .replace("seconds = 2.0", if to.contains('#') { "seconds = 2000" } else { "seconds = 2.0" });
        let found = parse(&text, &files()).expect_err(wanted).to_string();
        assert!(found.contains(wanted), "{wanted:?} in {found}");
    }
    let sound =
        track("puppets[0].position_m", "{ t = 0, value = [0, 0, -0.2] }, { t = 1, value = [0, 0, -0.01] }");
    assert!(parse(&timeline(&sound), &files()).is_ok());
}

#[test]
fn absurd_counts_are_refused() {
    let emitters =
        "[[lamp.emitters]]\nname = \"e\"\nshape = \"disk\"\nradius_m = 1\nradiance = 1\n".repeat(65);
    let found = problems_of(&[("[ambient]", &format!("{emitters}[ambient]"))], &files());
    assert_eq!(found.len(), 1);
    assert!(found[0].contains("lamp.emitters") && found[0].contains("more than the 64 allowed"), "{found:?}");
    let found =
        problems_of(&[("[exposure]", &format!("{}[exposure]", "[[puppets]]\n".repeat(256)))], &files());
    assert!(found[0].contains("more than the 256 allowed"), "{found:?}");
}

const SVG: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 128 128\">";

/// The scene with `svg` as its puppet, without a manifest.
fn with_svg(svg: &str) -> Vec<String> {
    let mut files = files();
    files.insert("puppets/p.svg".into(), svg.as_bytes().to_vec());
    problems_of(&[("figure.toml", "p.svg")], &files)
}

#[test]
fn svgs_that_are_bombs_or_reach_outside_are_refused() {
    let rect = "<rect width=\"64\" height=\"64\"/>";
    let lol: String = (1..9)
        .map(|i| format!("<g id=\"l{i}\">{}</g>", format!("<use href=\"#l{}\"/>", i - 1).repeat(10)))
        .collect();
    #[rustfmt::skip]
    let cases = [
        (format!("{SVG}<image href=\"/etc/passwd\" width=\"9\" height=\"9\"/>{rect}</svg>"), "has <image>"),
        (format!("{SVG}<image href=\"data:image/png;base64,AAAA\"/>{rect}</svg>"), "has <image>"),
        (format!("{SVG}<text>hello</text>{rect}</svg>"), "has <text>, which a puppet can't have: fonts differ"),
        (format!("{SVG}<use href=\"other.svg#x\"/>{rect}</svg>"), "only elements of the same file"),
        (format!("{SVG}<rect fill=\"url(http://x/y)\" width=\"9\" height=\"9\"/></svg>"), "only url(#id) is allowed"),
        (format!("{SVG}<g id=\"a\"><use href=\"#a\"/></g>{rect}</svg>"), "refers to itself"),
        (format!("{SVG}<rect id=\"a\" width=\"1\" height=\"1\"/>{rect}<g id=\"a\"/><use href=\"#a\"/></svg>"), "two elements of id \"a\""),
        (format!("{SVG}<g id=\"l0\">{rect}</g>{lol}</svg>"), "draws more than 100000 elements"),
        (format!("<!DOCTYPE svg [<!ENTITY a \"aaaa\"><!ENTITY b SYSTEM \"/etc/passwd\">]>{SVG}{rect}&b;</svg>"), "is not an SVG: "),
        (format!("{SVG}{}{}</svg>", "<g>".repeat(70), "</g>".repeat(70)), "nested deeper than 64"),
        (format!("{SVG}{rect}"), "is not an SVG"),
        ("<html/>".to_owned(), "its root is no <svg>"),
        (format!("{SVG}</svg>"), "draws nothing"),
        (format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{rect}</svg>"), "neither a viewBox nor width and height"),
        (format!("{}{rect}</svg>", SVG.replace("128 128", "128 0")), "its size must be positive"),
        (format!("{}{rect}</svg>", SVG.replace("128 128", "1e6 1")), "the grid would have"),
        (format!("{SVG}<filter id=\"f\"/><rect filter=\"url(#f)\" width=\"9\" height=\"9\"/></svg>"), "has a filter"),
        (format!("{SVG}<rect filter=\"blur(9px)\" width=\"9\" height=\"9\"/></svg>"), "has a filter"),
        (format!("{SVG}<path stroke=\"red\" stroke-dasharray=\"1e-6\" d=\"M0 0H128\"/></svg>"), "dashes; at most"),
        (format!("{SVG}{}{rect}{}</svg>", "<g opacity=\"0.99\">".repeat(60), "</g>".repeat(60)), ""),
    ];
    for (svg, wanted) in &cases {
        let found = with_svg(svg);
        if wanted.is_empty() {
            assert_eq!(found, Vec::<String>::new(), "control: {svg:.100}");
        } else {
            assert!(found.iter().any(|m| m.contains(wanted)), "{wanted:?} for {svg:.100} in {found:#?}");
            assert!(found.iter().all(|m| m.contains("puppets[0]")), "{found:#?}");
        }
    }
}

#[test]
fn manifests_are_checked() {
    #[rustfmt::skip]
    let cases = [
        ("id = \"leaf\"", "id = \"leef\"", "has no group \"leef\" (did you mean leaf?)"),
        ("id = \"leaf\"", "id = \"bar\"", "a part's id must be unique"),
        ("parent = \"bar\"", "parent = \"baar\"", "no such part (did you mean bar?); parts are body, bar and leaf"),
        ("parent = \"body\"", "parent = \"leaf\"", "must not hang on itself"),
        ("pivot = [112, 64]", "pivot = [112]", "parts[2].pivot = [112]: must have 2 numbers, not 1"),
        ("limits_deg = [-120, 180]", "limits_deg = [10, 180]", "include the rest pose"),
        ("image = \"figure.svg\"", "image = \"../scenes/figure.svg\"", "there is no file scenes/figure.svg"),
        ("image = \"figure.svg\"", "", "puppets/figure.toml: image: is missing"),
        ("title =", "titel =", "titel = \"A test figure\": is not a known key (did you mean title?)"),
        ("[[parts]]\nid = \"body\"", "", "parts[0].parent = \"body\": no such part"),
    ];
    for (from, to, wanted) in cases {
        let mut files = files();
        files.insert("puppets/figure.toml".into(), MANIFEST.replacen(from, to, 1).into_bytes());
        let found = problems_of(&[], &files);
        assert!(found.iter().any(|m| m.contains(wanted)), "{wanted:?} in {found:#?}");
    }
    // What is drawn outside every part would be lost.
    let mut files = files();
    files.insert(
        "puppets/figure.svg".into(),
        PUPPET_SVG.replace("</svg>", "<rect id=\"stray\" width=\"1\" height=\"1\"/></svg>").into(),
    );
    let found = problems_of(&[], &files);
    assert!(found[0].contains("puppets/figure.toml:5:9: image = \"figure.svg\": has <rect id=\"stray\"> outside the manifest's parts"), "{found:?}");
}

/// CRC-32 as PNG chunks have it.
pub(crate) fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}

#[test]
fn image_bombs_and_broken_images_are_refused() {
    let whole = png(4, 4, |_, _| [0, 0, 0, 255]);
    // The same file claims to be 100,000 pixels wide and high.
    let mut bomb = whole.clone();
    bomb[16..20].copy_from_slice(&100_000u32.to_be_bytes());
    bomb[20..24].copy_from_slice(&100_000u32.to_be_bytes());
    let sum = crc(&bomb[12..29]);
    bomb[29..33].copy_from_slice(&sum.to_be_bytes());
    let cases: [(&[u8], &str); 5] = [
        (&bomb, "is 100000 × 100000 pixels; an image has at most 8192 a side"),
        (&whole[..whole.len() / 2], "can't be decoded"),
        (b"GIF89a", "is not a PNG or JPEG file"),
        (b"", "is not a PNG or JPEG file"),
        (&whole, ""),
    ];
    for (bytes, wanted) in cases {
        let mut files = files();
        files.insert("puppets/p.png".into(), bytes.to_vec());
        for edits in
            [[("figure.toml", "p.png")], [("albedo = 0.8", "albedo = { image = \"../puppets/p.png\" }")]]
        {
            let found = problems_of(&edits, &files);
            let black = found.iter().all(|m| m.contains("black"));
            assert!(
                if wanted.is_empty() { black } else { found.len() == 1 && found[0].contains(wanted) },
                "{wanted:?} in {found:#?}"
            );
        }
    }
    // A clear pixel is a hole in the cloth.
    let mut files = files();
    files.insert("scenes/cloth.png".into(), png(2, 2, |x, _| [200, 200, 200, 200 + 55 * x as u8]));
    refused_once(&[("albedo = 0.8", "albedo = { image = \"cloth.png\" }")], &files, "must be opaque");
}
