#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use std::collections::{BTreeMap, BTreeSet};

use super::*;
use crate::camera::Camera;
use crate::exposure::Rule;
use crate::job::Output;
use crate::{Pixel, View, mc, oracle, pa, pcss, points};

const SCENE: &str = "5ce7e0000000000000000000000000000000000000000000000000000000cafe";

/// A job with everything that a job can have.
fn job() -> Job<()> {
    Job {
        scene: (),
        technique: Technique::Pa(pa::Knobs::default()),
        view: View { size: [96, 54], pixel: Pixel::Area, skip: true },
        backend: Backend::Cpu,
        camera: Some(Camera::default()),
        time_s: Some(0.5),
        exposure: Rule::Still,
        output: Output::Still,
        reference: Some(Technique::Mc(mc::Knobs::default())),
    }
}

fn parsed(technique: Value) -> Technique {
    serde_json::from_value(technique).unwrap()
}

fn key(job: &Job<()>) -> String {
    job.preimage_for(SCENE).unwrap()
}

/// The contract, spelled out: whoever has a scene's hash can compute the key without kelir.
#[test]
fn the_preimage_is_the_contracts() {
    let preimage = key(&job());
    let expected = concat!(
        "kelir-job/2\n",
        r#"{"backend":"cpu","camera":{"defocus_px":0.8,"jpeg_quality":90,"noise":0.012,"seed":1,"vignette":0.25},"#,
        r#""exposure":"still","knobs":{"dome_steps":32,"map_size":1024,"split":1,"strips":64,"variant":"exact","weights":"area"},"#,
        r#""output":"still","pixel":"area","reference":{"knobs":{"seed":1,"spp":64},"revision":3,"technique":"mc"},"#,
        r#""revision":1,"scene":"5ce7e0000000000000000000000000000000000000000000000000000000cafe","shared_revision":3,"#,
        r#""size":[96,54],"technique":"pa","time_s":0.5}"#
    );
    assert_eq!(
        preimage, expected,
        "after a revision was raised, this text and the hash below are written anew"
    );
    // sha256sum of that text.
    assert_eq!(
        hex::encode(Sha256::digest(preimage)),
        "e5c81f89e43185963667d4e27536a612488dd9e4312ce7e737780b8a8df3a2d6"
    );
}

/// Every leaf's path and text.
fn leaves(value: &Value, path: &str, into: &mut BTreeMap<String, String>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(k, v)| leaves(v, &format!("{path}/{k}"), into)),
        Value::Array(values) => {
            values.iter().enumerate().for_each(|(k, v)| leaves(v, &format!("{path}/{k}"), into));
        }
        leaf => drop(into.insert(path.to_owned(), leaf.to_string())),
    }
}

/// Every leaf of the preimage is changed by a job, alone where it can be alone, and every such job has a key of its own.
#[test]
fn each_field_changes_the_key() {
    let with = |change: &dyn Fn(&mut Job<()>)| {
        let mut job = job();
        change(&mut job);
        key(&job)
    };
    let camera = |change: &dyn Fn(&mut Camera)| with(&|job| change(job.camera.as_mut().unwrap()));
    let pa = |change: &dyn Fn(&mut pa::Knobs)| {
        let mut knobs = pa::Knobs::default();
        change(&mut knobs);
        with(&|job| job.technique = Technique::Pa(knobs))
    };
    let reference = |knobs: mc::Knobs| with(&|job| job.reference = Some(Technique::Mc(knobs)));
    let at = |class: &str, revisions: &Revisions| job().preimage(SCENE, class, revisions).unwrap();
    let changed = [
        ("/scene", job().preimage_for(&SCENE.replace("cafe", "beef")).unwrap()),
        ("/time_s", with(&|job| job.time_s = Some(0.25))),
        ("/revision", at("cpu", &Revisions { of: |t| u32::from(t.name() == "pa") + t.revision(), ..NOW })),
        ("/shared_revision", at("cpu", &Revisions { shared: NOW.shared + 1, ..NOW })),
        ("/knobs/split", pa(&|knobs| knobs.split = 2)),
        ("/knobs/weights", pa(&|knobs| knobs.weights = pa::Weights::Irradiance)),
        ("/knobs/strips", pa(&|knobs| knobs.strips = 32)),
        ("/knobs/variant", pa(&|knobs| knobs.variant = pa::Variant::ShadowMap)),
        ("/knobs/map_size", pa(&|knobs| knobs.map_size = 512)),
        ("/knobs/dome_steps", pa(&|knobs| knobs.dome_steps = 16)),
        ("/size/0", with(&|job| job.view.size[0] = 97)),
        ("/size/1", with(&|job| job.view.size[1] = 55)),
        ("/pixel", with(&|job| job.view.pixel = Pixel::Centre)),
        ("/camera/defocus_px", camera(&|camera| camera.defocus_px = 1.0)),
        ("/camera/vignette", camera(&|camera| camera.vignette = 1.0)),
        ("/camera/noise", camera(&|camera| camera.noise = 1.0)),
        ("/camera/jpeg_quality", camera(&|camera| camera.jpeg_quality = None)),
        ("/camera/seed", camera(&|camera| camera.seed = 2)),
        ("/exposure", with(&|job| job.exposure = Rule::Timeline)),
        ("/output", with(&|job| (job.output, job.time_s) = (Output::Animation, None))),
        ("/reference/knobs/spp", reference(mc::Knobs { spp: 80, ..mc::Knobs::default() })),
        ("/reference/knobs/seed", reference(mc::Knobs { seed: 2, ..mc::Knobs::default() })),
        (
            "/reference/revision",
            at("cpu", &Revisions { of: |t| u32::from(t.name() == "mc") + t.revision(), ..NOW }),
        ),
        ("/reference/technique", with(&|job| job.reference = Some(parsed(json!({ "technique": "points" }))))),
        ("/technique", with(&|job| job.technique = parsed(json!({ "technique": "pcss" })))),
        ("/backend", at("gpu:An Adapter/a driver 1.2", &NOW)),
        ("", with(&|job| job.time_s = None)),
        ("", with(&|job| job.camera = None)),
        ("", with(&|job| job.reference = None)),
    ];
    let read = |preimage: &str| {
        let mut found = BTreeMap::new();
        leaves(&serde_json::from_str(preimage.strip_prefix(CONTRACT).unwrap()).unwrap(), "", &mut found);
        found
    };
    let (base, mut keys) = (read(&key(&job())), BTreeSet::from([key(&job())]));
    for (path, preimage) in &changed {
        assert!(keys.insert(preimage.clone()), "{path}: a key that another job has");
        let now = read(preimage);
        let differing: Vec<_> = base.keys().filter(|leaf| base.get(*leaf) != now.get(*leaf)).collect();
        match *path {
            "" => {}
            // What weighs by irradiance was changed alone.
            "/knobs/weights" => assert_eq!(differing, ["/knobs/weights", "/revision"]),
            "/technique" => assert!(differing.iter().all(|p| p.starts_with("/knobs/") || *p == path)),
            "/reference/technique" => assert!(differing.iter().all(|p| p.starts_with("/reference/"))),
            "/output" => assert_eq!(differing, ["/output", "/time_s"]),
            _ => assert_eq!(differing, [path]),
        }
    }
    let named: BTreeSet<&str> =
        changed.iter().map(|(path, _)| *path).filter(|path| !path.is_empty()).collect();
    let all: BTreeSet<&str> = base.keys().map(String::as_str).collect();
    assert_eq!(named, all, "a member of the preimage that nothing here changes");
}

/// Names of the fields that a struct which denies unknown ones knows, from what it says to an unknown one.
fn fields<T: serde::de::DeserializeOwned>(mut json: Value) -> BTreeSet<String> {
    json["?"] = json!(0);
    let said = serde_json::from_value::<T>(json).err().unwrap().to_string();
    let (_, known) = said.split_once("expected").unwrap();
    known.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Every knob of every technique: another value is another key, its default written out is the same one.
#[test]
fn knobs_change_the_key_and_defaults_do_not() {
    let defaults = [
        Technique::Pa(pa::Knobs::default()),
        Technique::Mc(mc::Knobs::default()),
        Technique::Points(points::Knobs::default()),
        Technique::Pcss(pcss::Knobs::default()),
        Technique::Oracle(oracle::Knobs::default()),
    ];
    let others = |name: &str, knob: &str| match (name, knob) {
        ("pa", "weights") => json!("irradiance"),
        ("pa", "variant") => json!("shadow-map"),
        ("points", "lights") => json!(25),
        ("mc", "target_error") | ("pcss", "bias_m") | ("oracle", "tolerance") => json!(1e-3),
        ("mc", "time_limit_s") => json!(1.5),
        ("oracle", "geometric") => json!(true),
        ("points", "subpixels") => json!(7),
        _ => json!(48),
    };
    let mut keys = BTreeSet::new();
    let mut of = |technique: &Technique| {
        let job = Job { technique: technique.clone(), ..job() };
        (key(&job), keys.insert(key(&job)))
    };
    for technique in &defaults {
        let (name, written) = (technique.name(), exact(technique).unwrap());
        let bare = parsed(json!({ "technique": name }));
        assert_eq!(of(technique).0, of(&bare).0, "{name}: defaults written out");
        for knob in fields::<Technique>(json!({ "technique": name })) {
            let mut other = written.clone();
            other[&knob] = others(name, &knob);
            assert!(of(&parsed(other)).1, "{name}.{knob}");
        }
    }
    assert_eq!(keys.len(), 5 + 6 + 4 + 2 + 5 + 2);
    let camera: Camera = serde_json::from_value(json!({})).unwrap();
    assert_eq!(key(&Job { camera: Some(camera), ..job() }), key(&job()));
    assert_eq!(fields::<Camera>(json!({})).len(), 5, "each stands in the test above");
}

#[test]
fn one_number_has_one_key_however_it_is_written() {
    let bias = |json: &str| {
        let technique = format!(r#"{{"technique":"pcss","bias_m":{json}}}"#);
        key(&Job { technique: serde_json::from_str(&technique).unwrap(), ..job() })
    };
    assert!(["0.0", "-0.0", "0e5"].iter().all(|zero| bias(zero) == bias("0")));
    assert!(["1.0", "1e0", "10e-1"].iter().all(|one| bias(one) == bias("1")));
    assert_ne!(bias("1"), bias("0"));
    let at = |time_s| key(&Job { time_s: Some(time_s), ..job() });
    assert_eq!(at(0.0), at(-0.0));
    assert_ne!(at(0.0), at(f64::MIN_POSITIVE));
    // Neighbours beyond 2^53, one number to JavaScript.
    let seeded =
        |seed| key(&Job { technique: Technique::Mc(mc::Knobs { seed, ..mc::Knobs::default() }), ..job() });
    assert_ne!(seeded(1 << 53), seeded((1 << 53) + 1));
    assert_ne!(seeded(u64::MAX), seeded(u64::MAX - 1));
    // Skipping changes no byte.
    let view = View { skip: false, ..job().view };
    assert_eq!(key(&Job { view, ..job() }), key(&job()));
}

#[test]
fn what_cannot_be_drawn_has_no_key() {
    let mc = |knobs| Some(Technique::Mc(knobs));
    let refused = [
        (Job { time_s: Some(f64::NAN), ..job() }, "time = NaN"),
        (Job { time_s: Some(f64::INFINITY), ..job() }, "time = inf"),
        (Job { output: Output::Animation, ..job() }, "time = 0.5"),
        (
            Job { camera: Some(Camera { noise: f64::NAN, ..Camera::default() }), ..job() },
            "camera.noise = NaN",
        ),
        (
            Job {
                reference: mc(mc::Knobs { target_error: Some(f64::NAN), ..mc::Knobs::default() }),
                ..job()
            },
            "target_error is not a finite number",
        ),
        (
            Job { technique: Technique::Pa(pa::Knobs { split: 0, ..pa::Knobs::default() }), ..job() },
            "split = 0",
        ),
    ];
    for (job, phrase) in refused {
        let error = job.preimage_for(SCENE).unwrap_err().to_string();
        assert!(error.contains(phrase), "{error}");
    }
}

/// A real device's class is in the key of what it draws; the oracle has none.
#[test]
fn another_backend_has_another_key() {
    let gpu = key(&Job { backend: Backend::Gpu, ..job() });
    assert!(gpu.contains(r#""backend":"gpu:"#), "{gpu}");
    assert_ne!(gpu, key(&job()));
    let oracle = Technique::Oracle(oracle::Knobs::default());
    let on = |backend| key(&Job { technique: oracle.clone(), backend, ..job() });
    assert_eq!(on(Backend::Gpu), on(Backend::Cpu));
}
