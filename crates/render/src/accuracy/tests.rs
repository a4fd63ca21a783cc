#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;
use crate::{Pixel, VisibilityModel};

/// Two emitters and opaque blocks at an angle, far enough off axis that the models differ.
const SCENE: &str = r#"
[screen]
width_m = 1.6
height_m = 0.9
albedo = [0.8, 0.7, 0.6]

[lamp]
position_m = [0.3, 0.1, -1.2]

[[lamp.emitters]]
name = "inner"
shape = "rectangle"
size_m = [0.04, 0.04]
radiance = 400.0

[[lamp.emitters]]
name = "outer"
shape = "rectangle"
size_m = [0.3, 0.2]
radiance = 20.0

[ambient]
model = "none"

[[puppets]]
image = "puppet.png"
height_m = 0.4
position_m = [0.05, 0.0, -0.3]
rotate_deg = 20.0
texels = 64

[exposure]
white = "auto"
"#;

fn scene(changed: &[(&str, &str)]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let codes: Vec<u8> =
        (0..32 * 32).flat_map(|k| [0, 0, 0, if (k / 8 + k / 256) % 2 == 0 { 255 } else { 0 }]).collect();
    image::save_buffer(folder.path().join("puppet.png"), &codes, 32, 32, image::ColorType::Rgba8).unwrap();
    let text = changed.iter().fold(SCENE.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    std::fs::write(folder.path().join("scene.toml"), text).unwrap();
    Scene::from_path(&folder.path().join("scene.toml")).unwrap()
}

fn options() -> Options {
    let view = View { size: [64, 36], pixel: Pixel::Area, skip: true };
    Options { runs: 2, reference_spp: 1 << 14, crops: [3, 3], ..Options::new(view) }
}

fn run(scene: &Scene, cases: &[Case], options: &Options) -> Report {
    let mut steps = Vec::new();
    let report = measure(scene, cases, options, &mut |p| steps.push((p.done, p.total))).unwrap();
    let total = cases.len() * options.backends.len() + 2;
    assert_eq!(steps, (0..=total).map(|done| (done, total)).collect::<Vec<_>>());
    report
}

fn measured<'a>(report: &'a Report, series: &str) -> Vec<&'a Measured> {
    let of = |r: &'a CaseReport| match &r.outcome {
        Outcome::Measured(measured) if r.case.series == series => Some(measured),
        _ => None,
    };
    report.results.iter().filter_map(of).collect()
}

/// All techniques on a small scene: errors are ordered as they must be, and each kind is where theory has it.
#[test]
fn errors_are_what_theory_has_them() {
    let scene = scene(&[]);
    let cases = all(&scene.still());
    let report = run(&scene, &cases, &options());
    assert_eq!(report.results.len(), cases.len());
    let floor = report.reference.floor;
    assert!(floor > 0.0 && report.penumbra_pixels > 300, "{floor} {}", report.penumbra_pixels);

    // Monte Carlo's error falls as a power of the count, −½ or (its points are stratified) steeper, down to the floor.
    let mc: Vec<f64> = measured(&report, "MC").iter().map(|m| m.penumbra.rmse).collect();
    let slope = (mc[5] / mc[0]).log2() / 5.0;
    assert!((-1.2..-0.45).contains(&slope), "{slope} {mc:?}");
    assert!(mc.windows(2).all(|e| e[1] < e[0]) && mc[7] > 0.7 * floor, "{mc:?} {floor}");

    // PA: nothing numerical, all model; by irradiance the model error goes, too.
    let [pa] = measured(&report, "PA")[..] else { panic!("one split is enough behind one plane") };
    let crops = pa.crops.as_ref().unwrap();
    assert_eq!(crops.model, VisibilityModel::Geometric);
    assert!(crops.visibility_max <= 1e-6 && crops.numerical.max <= 1e-6, "{crops:?}");
    assert_eq!(crops.total.count, 3 * 3 * 9);
    let model = report.oracle.geometric;
    assert!((crops.total.rmse / model.rmse - 1.0).abs() < 1e-2, "{crops:?} {model:?}");
    assert!(model.rmse > 20.0 * floor, "{model:?} {floor}");
    let by_irradiance: Vec<_> = measured(&report, "PA by irradiance");
    let rmse: Vec<f64> = by_irradiance.iter().map(|m| m.penumbra.rmse).collect();
    // From 4 × 4 pieces on, what is left does not come from the pieces: by the oracle, too, 8 × 8 are no better.
    assert!(rmse[1..].iter().all(|e| *e < 0.25 * rmse[0]), "{rmse:?}, floor {floor}");
    assert!(by_irradiance[2].penumbra.rmse < 0.2 * pa.penumbra.rmse);
    assert!(by_irradiance.iter().all(|m| m.crops.as_ref().unwrap().model == VisibilityModel::Irradiance));

    // The rivals come down to PA's model error and no further.
    for series in ["points", "PCSS", "PA shadow map"] {
        let of = measured(&report, series);
        let (first, last) = (of[0], of[of.len() - 1]);
        assert!(last.penumbra.rmse < 0.5 * first.penumbra.rmse, "{series}");
        let numerical = [first, last].map(|m| m.crops.as_ref().unwrap().numerical.rmse);
        assert!(numerical[1] < 0.5 * numerical[0] && numerical[1] > 10.0 * crops.numerical.rmse, "{series}");
        assert!(last.ssim > first.ssim && last.flip < first.flip, "{series}");
    }
    for m in report
        .results
        .iter()
        .filter_map(|r| if let Outcome::Measured(m) = &r.outcome { Some(m) } else { None })
    {
        assert!(0.0 < m.first.lower && m.first.lower <= m.first.median && m.first.median <= m.first.upper);
        // All pixels' error is the penumbra's, thinned out.
        assert!(m.all.rmse <= m.penumbra.rmse && m.all.max == m.penumbra.max);
    }
    let json: serde_json::Value = serde_json::from_str(&serde_json::to_string(&report).unwrap()).unwrap();
    assert_eq!(json["results"].as_array().unwrap().len(), cases.len());
    assert_eq!(json["results"][0]["technique"], "pa");
    assert_eq!(json["reference"]["seed"], 2);
    assert!(json["results"][0]["measured"]["penumbra"]["rmse"].as_f64().unwrap() > 0.0);
    assert_eq!(json["scene_sha256"].as_str().unwrap().len(), 64);
}

/// A technique made wrong (a bias that drops the puppet) shows a larger error; and the reference is held to a seed and a count of its own.
#[test]
fn what_is_wrong_shows() {
    let scene = scene(&[]);
    let case = |bias_m| Case {
        series: "PCSS",
        knob: format!("bias {bias_m}"),
        technique: Technique::Pcss(crate::pcss::Knobs { bias_m, filter_samples: 256, ..Default::default() }),
    };
    let report = run(&scene, &[case(0.0), case(1.0)], &options());
    let [right, wrong] = measured(&report, "PCSS")[..] else { panic!("two cases") };
    assert!(wrong.penumbra.rmse > 20.0 * right.penumbra.rmse);
    assert!(
        wrong.crops.as_ref().unwrap().numerical.rmse > 20.0 * right.crops.as_ref().unwrap().numerical.rmse
    );
    assert!(wrong.penumbra.bias > 0.1, "a lost shadow is too bright");

    let refused = |options: &Options, cases: &[Case]| {
        measure(&scene, cases, options, &mut |_| {}).unwrap_err().to_string()
    };
    assert!(refused(&Options { runs: 0, ..options() }, &[]).contains("runs = 0"));
    assert!(refused(&Options { reference_seed: SEED, ..options() }, &[]).contains("reference_seed = 1"));
    let few = Options { reference_spp: 2048, ..options() };
    assert!(refused(&few, &all(&scene.still())).contains("reference_spp = 2048"));
}

/// What a technique refuses is in the report with its reason, and the others are measured.
#[test]
fn refusals_are_reported() {
    let scene = scene(&[("model = \"none\"", "model = \"dome\"\nradiance = 1.0")]);
    let cases: Vec<Case> = all(&scene.still())
        .into_iter()
        .filter(|c| ["PA", "PCSS"].contains(&c.series) && !c.knob.contains("1024"))
        .collect();
    let options = Options { reference_spp: 256, crops: [1, 2], ..options() };
    let report = run(&scene, &cases, &options);
    let refused =
        report.results.iter().filter(|r| matches!(&r.outcome, Outcome::Refused(why) if why.contains("dome")));
    assert!(refused.clone().all(|r| r.case.series == "PCSS") && refused.count() == 4);
    assert_eq!(measured(&report, "PA").len(), 1);
    let json = serde_json::to_value(&report.results[1]).unwrap();
    assert!(json["refused"].as_str().unwrap().contains("dome"), "{json}");
}

#[test]
fn crops_lie_in_the_penumbra_and_never_move() {
    // A band of penumbra: columns 8..24 of 40.
    let penumbra: Vec<bool> = (0..40 * 30).map(|k| (8..24).contains(&(k % 40))).collect();
    let crops = crops::choose(&penumbra, [40, 30], [4, 8]);
    let places: Vec<_> = crops.iter().map(|c| (c.x, c.y)).collect();
    assert_eq!(places, [(8, 0), (8, 8), (16, 8), (16, 16)]);
    assert!(crops::choose(&vec![false; 1200], [40, 30], [4, 8]).is_empty());
    // Nowhere half full: the fullest.
    let thin: Vec<bool> = (0..40 * 30).map(|k| k % 40 == 3).collect();
    assert!(crops::choose(&thin, [40, 30], [2, 8]).iter().all(|c| c.x == 0));
}

#[test]
fn quartiles_by_hand() {
    let times = Times::of(vec![4.0, 1.0, 3.0, 2.0]);
    assert_eq!(times, Times { lower: 1.75, median: 2.5, upper: 3.25 });
    assert_eq!(Times::of(vec![7.0]), Times { lower: 7.0, median: 7.0, upper: 7.0 });
}
