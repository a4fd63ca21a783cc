//! The reference page of EXR channels and of what `kelir render --json` counts: names as each technique gives them, each with its meaning.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use kelir_render::techniques::knobs::Knob;
use kelir_render::{Backend, Pixel, Technique, View, renderer};
use kelir_scene::Theatre;

use crate::support::shipped;

/// Channels; E is an emitter's name, C one of R, G, B.
const CHANNELS: [(&str, &str, &str); 5] = [
    (
        "R, G, B",
        "radiance, in the scene's unit",
        "what the audience sees, linear; `white` (attribute) is what a display shows as white",
    ),
    ("Vgeo.E", "share, 0 to 1", "share of the emitter's area that is seen from the pixel"),
    ("Virr.E", "share, 0 to 1", "share of the emitter's irradiance that reaches the pixel"),
    ("V….E.C", "share, 0 to 1", "the same for one channel, where a puppet is coloured"),
    ("SE.C", "radiance, in the scene's unit", "standard error of the channel; 0 where nothing was sampled"),
];

/// What `stats.counts` holds.
const COUNTS: &[(&str, &str)] = &[
    ("background_reused", "1 where the empty screen of the drawing before was taken"),
    ("batches", "pieces of work handed to the GPU"),
    ("boxes", "sums over a box that were looked up"),
    ("boxes_known", "boxes known without looking: all clear or all opaque"),
    ("boxes_shared", "boxes whose sum served several emitters"),
    ("domes_built", "maps of the dome's light that were made"),
    ("emitters_dark", "emitters without radiance, which were skipped"),
    ("frames_repeated", "frames equal to the one before, not drawn again (films)"),
    ("lights", "point lights in all"),
    ("maps_built", "shadow maps that were made"),
    ("pixels", "pixels drawn"),
    ("pixels_dark", "pixels in full shadow"),
    ("pixels_in_penumbra", "pixels that were sampled"),
    ("pixels_lit_copied", "pixels in full light, copied from the empty screen"),
    ("pixels_penumbra", "pixels in penumbra"),
    ("planes", "puppets on the beam"),
    ("planes_off_beam", "puppets that no light passes"),
    ("replicates", "independent scrambles, by which the error is known"),
    ("samples", "samples taken"),
    ("samples_skipped", "samples not needed"),
    ("searches", "searches for a blocker"),
    ("searches_skipped", "searches not needed"),
    ("spp", "samples a pixel and emitter"),
    ("tables_built", "summed-area tables that were made"),
    ("tables_reused", "summed-area tables of the drawing before that were taken"),
];

/// What `stats.values` holds.
const VALUES: [(&str, &str); 3] = [
    ("se_max", "largest standard error over penumbra pixels, in units of the brightest unshadowed pixel"),
    ("se_mean", "its mean"),
    ("se_rms", "its root mean square"),
];

/// A channel's name with the emitter's and the colour's replaced by what they stand for.
fn pattern(name: &str, theatre: &Theatre) -> String {
    let Some((kind, rest)) = name.split_once('.') else {
        assert!(["R", "G", "B"].contains(&name), "{name} has no meaning");
        return "R, G, B".to_owned();
    };
    if kind == "SE" {
        return "SE.C".to_owned();
    }
    let colour = [".R", ".G", ".B"].iter().find_map(|end| rest.strip_suffix(end));
    let emitter = colour.unwrap_or(rest);
    let known = theatre.lamp.emitters.iter().any(|e| e.name == emitter) || emitter == "dome";
    assert!(known, "{name} is of no emitter");
    if colour.is_some() { "V….E.C".to_owned() } else { format!("{kind}.E") }
}

/// Names that a technique gives, over scenes without and with colours.
#[derive(Default)]
struct Given {
    channels: BTreeSet<String>,
    counts: BTreeSet<String>,
    values: BTreeSet<String>,
    steps: BTreeSet<String>,
}

fn given(technique: &Technique) -> Given {
    let mut given = Given::default();
    for scene in shipped().iter().filter(|scene| ["arjuna-near", "putri-near"].contains(&scene.name.as_str()))
    {
        let view = View { size: [64, 36], pixel: Pixel::Area, skip: true };
        let frame = renderer(technique, Backend::Cpu).unwrap().radiance(&scene.still, &view).unwrap();
        given.channels.extend(frame.channels().map(|(name, _)| pattern(&name, &scene.still)));
        given.counts.extend(frame.stats.counts.into_keys());
        given.values.extend(frame.stats.values.into_keys());
        given.steps.extend(frame.stats.steps_ms.into_iter().map(|(step, _)| step));
    }
    given
}

fn list(names: &BTreeSet<String>) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    if names.is_empty() { "–".to_owned() } else { names.join(", ") }
}

fn knobs() -> String {
    let table = |technique: Technique| {
        let stand = technique.stand();
        let row = |knob: &Knob| {
            let stands = stand.get(knob.name).map_or_else(|| "–".to_owned(), |value| format!("`{value}`"));
            let unit = if knob.unit.is_empty() { "–" } else { knob.unit };
            format!("| `{}` | {unit} | {stands} | {} | {} |\n", knob.name, knob.range, knob.about)
        };
        let rows: String = technique.knobs().iter().map(row).collect();
        let head = "| knob | unit | default | must be | what it does |\n|---|---|---|---|---|\n";
        format!("`{}`: {}\n\n{head}{rows}\n", technique.name(), technique.about())
    };
    Technique::all().map(table).concat()
}

fn page(given: &BTreeMap<&str, Given>) -> String {
    let rows = |cell: &dyn Fn(&Given) -> String| {
        let lines: Vec<String> =
            given.iter().map(|(name, given)| format!("| `{name}` | {} |", cell(given))).collect();
        lines.join("\n")
    };
    let pairs = |table: &[(&str, &str)]| {
        table.iter().map(|(name, meaning)| format!("| `{name}` | {meaning} |")).collect::<Vec<_>>().join("\n")
    };
    let channels: Vec<String> =
        CHANNELS.iter().map(|(name, unit, meaning)| format!("| `{name}` | {unit} | {meaning} |")).collect();
    format!(
        "# Techniques: their knobs, EXR channels and the counts of `--json`\n\n\
         Made of what each technique gives: `KELIR_BLESS=1 cargo test -p kelir-render --test it reference` writes this page, and a test compares it.\n\n\
         ## Knobs\n\n\
         As keys of a study's `[conditions.NAME]`, as `--knob NAME=VALUE` or an option of that name; `kelir technique NAME` prints them.\n\n{}\n\
         ## Channels of an `.exr`\n\n\
         All are f32, in scan lines from the top. E stands for an emitter's name (`dome` for the dome), C for R, G or B.\n\n\
         | channel | unit | what it is |\n|---|---|---|\n{}\n\n\
         | technique | channels |\n|---|---|\n{}\n\n\
         Attributes: `white` (the radiance that a display shows as white), `exposure` (what that is the brightest of: `still` or `timeline`), `technique`\n\
         (name and knobs as JSON), `sceneSha256` (hash of the scene's values and files), `kelirVersion`.\n\n\
         ## `kelir render --json`\n\n\
         `technique`, `adapter` (what drew it), `size` ([width, height] in pixels), `exposure`, `white`, `scene_sha256`, `total_ms`, `stats`, and\n\
         `standard_error` (null where the technique has none: `mean_sampled`, `max`, `sampled_share`, in units of white). `kelir animate --json` has\n\
         `adapter`, `exposure`, `white`, `total_ms`, `frames_repeated`, and in `frames` the stats of each frame that was drawn.\n\n\
         `stats.counts`, whole numbers:\n\n| name | what it counts |\n|---|---|\n{}\n\n\
         `stats.values`:\n\n| name | what it is |\n|---|---|\n{}\n\n\
         `stats.steps_ms`: [name, milliseconds] of each step, in order.\n\n\
         | technique, on the CPU | counts |\n|---|---|\n{}\n\n| technique, on the CPU | steps |\n|---|---|\n{}\n",
        knobs(),
        channels.join("\n"),
        rows(&|given| list(&given.channels)),
        pairs(COUNTS),
        pairs(&VALUES),
        rows(&|given| list(&given.counts)),
        rows(&|given| list(&given.steps)),
    )
}

#[test]
fn the_page_names_every_channel_and_count_with_its_meaning() {
    let techniques = [
        r#"{"technique":"pa"}"#,
        r#"{"technique":"mc","spp":16}"#,
        r#"{"technique":"points"}"#,
        r#"{"technique":"pcss"}"#,
        r#"{"technique":"oracle"}"#,
    ];
    let techniques: Vec<Technique> =
        techniques.iter().map(|text| serde_json::from_str(text).unwrap()).collect();
    let given: BTreeMap<&str, Given> =
        techniques.iter().map(|technique| (technique.name(), given(technique))).collect();
    let meant = |name: &str| COUNTS.iter().any(|(known, _)| *known == name);
    for (technique, given) in &given {
        for name in &given.channels {
            assert!(CHANNELS.iter().any(|(known, ..)| known == name), "{technique}: {name} has no meaning");
        }
        for name in &given.counts {
            assert!(meant(name), "{technique}: {name} has no meaning");
        }
        for name in &given.values {
            assert!(VALUES.iter().any(|(known, _)| known == name), "{technique}: {name} has no meaning");
        }
    }
    let page = page(&given);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/pictures.md");
    if std::env::var_os("KELIR_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, &page).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap_or_default(), page, "KELIR_BLESS=1 writes it anew");
    // Negative control: a name that nobody explains is seen.
    assert!(!meant("pixels_of_gold"));
}
