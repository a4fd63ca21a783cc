#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

mod card;

use std::collections::BTreeMap;

use kelir_fixtures as fixtures;
use kelir_scene::{Assets, Masks};

use super::*;
use crate::{encode, mc, oracle, pa};

struct Files(BTreeMap<String, Vec<u8>>);

impl Assets for Files {
    fn read(&self, path: &str) -> std::io::Result<Vec<u8>> {
        self.0
            .get(path)
            .cloned()
            .ok_or_else(|| std::io::Error::new(std::io::ErrorKind::NotFound, path.to_owned()))
    }
}

fn job(timeline: &str, technique: Technique, output: Output) -> Job {
    let toml = format!("{}{timeline}", fixtures::SCENE);
    let files = Files([("puppets/square.svg".to_owned(), fixtures::SQUARE.as_bytes().to_vec())].into());
    Job {
        scene: Scene::parse("scenes/scene.toml", &toml, &files).unwrap(),
        technique,
        view: View { size: [96, 54], pixel: Pixel::Area, skip: true },
        backend: Backend::Cpu,
        camera: None,
        time_s: None,
        exposure: output.exposure(),
        output,
        reference: None,
    }
}

fn pa() -> Technique {
    Technique::Pa(pa::Knobs::default())
}

const SLIDE: &str = r#"
[timeline]
fps = 10
seconds = 0.6
loop = true
[[timeline.tracks]]
target = "puppets[0].position_m"
keys = [ { t = 0.0, value = [0.0, 0.0, -0.3] }, { t = 0.2, value = [0.2, 0.0, -0.3] }, { t = 0.6, value = [0.2, 0.0, -0.3] } ]
"#;

#[test]
fn the_same_job_gives_the_same_bytes_and_says_where_they_came_from() {
    let mut steps = Vec::new();
    let mut first = job("", pa(), Output::Still);
    first.reference = Some(Technique::Oracle(oracle::Knobs { geometric: true, ..Default::default() }));
    let one = run(&mut first, &mut |p| steps.push((p.done, p.total))).unwrap();
    let two = run(&mut job("", pa(), Output::Still), &mut |_| ()).unwrap();
    assert_eq!((one.media_type.as_str(), &one.bytes[1..4]), ("image/png", &b"PNG"[..]));
    assert_eq!((&one.bytes, &one.sha256), (&two.bytes, &two.sha256));
    assert_eq!(one.sha256, hex::encode(Sha256::digest(&one.bytes)));
    assert_eq!(steps.last(), Some(&(3, 3)));
    assert!(steps.windows(2).all(|w| w[0].0 < w[1].0));
    let json = serde_json::to_value(&one.provenance).unwrap();
    assert_eq!(json["technique"], "pa");
    assert_eq!(json["scene_sha256"], first.scene.sha256());
    assert_eq!(
        (&json["revision"], &json["shared_revision"]),
        (&pa::REVISION.into(), &crate::REVISION.into())
    );
    assert_eq!((&json["backend"], &json["exposure"]), (&"cpu".into(), &"still".into()));
    assert_eq!(json["error"]["reference"]["technique"], "oracle");
    // PA draws E⁰ · Vgeo: against the oracle's the error is rounding. The floor is unknown: no random numbers.
    let max = json["error"]["all"]["max"].as_f64().unwrap();
    assert!(max > 0.0 && max < 1e-6, "{max}");
    assert_eq!(json["error"]["floor"], serde_json::Value::Null);
    // Another technique is another image.
    let mc = Technique::Mc(mc::Knobs { spp: 16, ..mc::Knobs::default() });
    let mut other = job("", mc, Output::Still);
    other.reference = Some(Technique::Mc(mc::Knobs { spp: 64, seed: 9, ..mc::Knobs::default() }));
    let other = run(&mut other, &mut |_| ()).unwrap();
    assert_ne!(other.sha256, one.sha256);
    assert_eq!(other.provenance.white, one.provenance.white, "exposure does not depend on the technique");
    let own = other.provenance.standard_error.unwrap();
    assert!(0.0 < own.rms_sampled && own.rms_sampled < own.max && own.max < 0.5, "{own:?}");
    // Sixteen times the samples: a spread at most half as large. PA has no random numbers and no spread.
    let finer = Technique::Mc(mc::Knobs { spp: 256, ..mc::Knobs::default() });
    let finer =
        run(&mut job("", finer, Output::Still), &mut |_| ()).unwrap().provenance.standard_error.unwrap();
    assert!(finer.rms_sampled < 0.5 * own.rms_sampled, "{finer:?} against {own:?}");
    assert_eq!(one.provenance.standard_error, None);
    let error = other.provenance.error.unwrap();
    assert!(error.floor.unwrap() > 0.0 && error.penumbra.rmse > error.all.rmse);
}

#[test]
fn an_animation_is_a_manifest_and_its_frames_equal_ones_shared() {
    let stimulus = run(&mut job(SLIDE, pa(), Output::Animation), &mut |_| ()).unwrap();
    assert_eq!(stimulus.media_type, ANIMATION);
    let manifest: serde_json::Value = serde_json::from_slice(&stimulus.bytes).unwrap();
    assert_eq!((&manifest["fps"], &manifest["loop"]), (&serde_json::json!(10.0), &serde_json::json!(true)));
    assert_eq!((&manifest["width"], &manifest["height"]), (&serde_json::json!(96), &serde_json::json!(54)));
    let frames: Vec<&str> =
        manifest["frames"].as_array().unwrap().iter().map(|f| f.as_str().unwrap()).collect();
    assert_eq!(frames.len(), 6);
    assert_eq!(stimulus.attachments.len(), 3, "the puppet stops after a third of the time");
    assert_eq!(frames[2], frames[5]);
    assert_eq!(stimulus.provenance.counts["frames_repeated"], 3);
    assert!(
        stimulus
            .attachments
            .iter()
            .all(|b| b.media_type == "image/png" && frames.contains(&b.sha256.as_str()))
    );
    let again = run(&mut job(SLIDE, pa(), Output::Animation), &mut |_| ()).unwrap();
    assert_eq!(stimulus.bytes, again.bytes);
}

const LAMP: &str = r#"
[timeline]
fps = 10
seconds = 0.4
loop = false
[[timeline.tracks]]
target = "lamp.position_m"
keys = [ { t = 0.0, value = [0.0, 0.0, -1.4] }, { t = 0.3, value = [0.0, 0.0, -1.0] } ]
"#;

#[test]
fn each_rule_of_exposure_by_its_definition() {
    let mut job = job(LAMP, pa(), Output::Still);
    let view = job.view;
    let at: Vec<f64> = (0..4)
        .map(|k| crate::white([&job.scene.theatre_at(0.1 * f64::from(k), &mut Masks::default())], &view))
        .collect();
    let white = |rule: Rule, time_s| job.scene.white(rule, &view, time_s);
    assert_eq!(white(Rule::Still, None), crate::white([&job.scene.still()], &view));
    assert_eq!(white(Rule::Still, Some(0.2)), at[2]);
    for time_s in [None, Some(0.2)] {
        assert_eq!(white(Rule::Timeline, time_s), at[3], "the lamp is nearest at the end");
    }
    assert!(white(Rule::Still, None) < at[0] && at[0] < at[2] && at[2] < at[3], "{at:?}");
    job = self::job("", pa(), Output::Still);
    assert_eq!(job.scene.white(Rule::Timeline, &view, None), job.scene.white(Rule::Still, &view, Some(0.3)));
}

#[test]
fn a_still_of_an_instant_is_the_animations_frame_when_exposed_like_it() {
    let animation = run(&mut job(LAMP, pa(), Output::Animation), &mut |_| ()).unwrap();
    assert_eq!(animation.provenance.exposure, Rule::Timeline);
    let still = |exposure, time_s| {
        let job = job(LAMP, pa(), Output::Still);
        run(&mut Job { time_s, exposure, ..job }, &mut |_| ()).unwrap()
    };
    let frame = still(Rule::Timeline, Some(0.2));
    assert_eq!(frame.sha256, animation.attachments[2].sha256);
    assert_eq!((frame.provenance.white, frame.provenance.time_s), (animation.provenance.white, Some(0.2)));
    // Negative controls: another instant, another rule.
    assert_ne!(still(Rule::Timeline, Some(0.1)).sha256, frame.sha256);
    assert_ne!(still(Rule::Timeline, None).sha256, frame.sha256);
    let own = still(Rule::Still, Some(0.2));
    assert!(own.sha256 != frame.sha256 && own.provenance.white < frame.provenance.white);
}

/// What is drawn on a device says so, in its provenance as in its key.
#[test]
fn a_device_has_a_class_of_its_own() {
    for technique in [pa(), Technique::Points(crate::points::Knobs { lights: 4, subpixels: 1 })] {
        let mut on_gpu = Job { backend: Backend::Gpu, ..job("", technique, Output::Still) };
        let backend = run(&mut on_gpu, &mut |_| ()).unwrap().provenance.backend;
        assert!(backend.starts_with("gpu:") && backend[4..].contains('/'), "{backend}");
        let preimage = on_gpu.preimage_for(on_gpu.scene.sha256()).unwrap();
        assert!(preimage.contains(&serde_json::to_string(&backend).unwrap()), "{preimage}");
        assert_ne!(on_gpu.key().unwrap(), Job { backend: Backend::Cpu, ..on_gpu }.key().unwrap());
    }
}

/// Files of codes that every machine computes alike: where an encoder writes other bytes, [`crate::REVISION`] must be raised.
#[test]
fn encoders_write_the_bytes_of_this_revision() {
    assert_eq!(crate::REVISION, 3, "after raising it, write the hashes below anew");
    let codes: Vec<u32> =
        (0..64 * 36u32).map(|k| encode::pack(k * k % 251, k / 9 % 256, k * 7 % 256)).collect();
    let hash = |bytes: Vec<u8>| Blob::new("", bytes).sha256;
    let camera = |jpeg_quality| Camera { jpeg_quality, ..Camera::default() };
    let png = "801523e36ff46bbf3e9b98c23ff3d9e2600399178b253d8b27dcedfc04643ed0";
    let jpeg = "0d3c7c8f418884d65aab52a5d6af0c5a3b3b516c032934c0914b019780dd0969";
    let files = [
        (encode::png(&codes, [64, 36]).unwrap(), png),
        (camera(None).file(&codes, [64, 36]).unwrap().bytes, png),
        (camera(Some(90)).file(&codes, [64, 36]).unwrap().bytes, jpeg),
    ];
    for (bytes, expected) in files {
        assert_eq!(hash(bytes), expected, "an encoder changed: raise kelir_render::REVISION");
    }
    assert_ne!(hash(camera(Some(89)).file(&codes, [64, 36]).unwrap().bytes), jpeg);
}

#[test]
fn a_simulated_photograph() {
    let mut with = job("", pa(), Output::Still);
    with.camera = Some(Camera::default());
    let photo = run(&mut with, &mut |_| ()).unwrap();
    assert_eq!(photo.media_type, "image/jpeg");
    let json = serde_json::to_value(&photo.provenance).unwrap();
    assert_eq!(json["camera"]["jpeg_quality"], 90);
}

#[test]
fn impossible_jobs_are_refused_by_name() {
    let error = run(&mut job("", pa(), Output::Animation), &mut |_| ()).unwrap_err().to_string();
    assert!(error.contains("timeline"), "{error}");
    let mut wrong = job("", pa(), Output::Still);
    wrong.view.size = [96, 96];
    assert!(run(&mut wrong, &mut |_| ()).unwrap_err().to_string().contains("96x96"));
    let mut camera = job("", pa(), Output::Still);
    camera.camera = Some(Camera { noise: -1.0, ..Camera::default() });
    assert!(run(&mut camera, &mut |_| ()).unwrap_err().to_string().contains("camera.noise"));
}
