//! Scene files that show a stage.

use glam::DVec3;
use kelir_scene::stage::*;
use kelir_scene::{AnyScene, Exposure, Scene};

use crate::support::Files;

const STAGE: &str = r#"subject = "stage"

[stage]
ambient = 0.1

[stage.camera]
position_m = [0, 1, 3]
look_at_m = [0, 0.5, 0]
field_of_view_deg = 40
aspect = 1.5

[[stage.objects]]
name = "ground"
shape = "rectangle"
size_m = [4, 3]
rotate_deg = [-90, 0, 0]
albedo = [0.5, 0.6, 0.7]

[[stage.objects]]
name = "tetra"
shape = "mesh"
file = "../meshes/tetra.obj"
unit = "cm"
scale = 2
normals = "flat"

[[stage.lights]]
name = "lamp"
kind = "point"
position_m = [1, 2, 0]
intensity = 5

[[stage.lights]]
name = "slides"
kind = "projector"
position_m = [0, 1, 2]
throw_deg = 30
intensity = [1, 2, 3]
slide = { pattern = "sine", amplitude = 0.5, frequency = [1, 4] }

[exposure]
white = 3.0

[timeline]
fps = 10
seconds = 1

[[timeline.tracks]]
target = "stage.objects[1].rotate_deg"
keys = [{ t = 0, value = [0, 0, 0] }, { t = 1, value = [0, 90, 0] }]

[[timeline.tracks]]
target = "stage.lights[1].position_m"
keys = [{ t = 0, value = [0, 1, 2] }, { t = 1, value = [2, 1, 0] }]

[[timeline.tracks]]
target = "stage.lights[1].slide.phase_deg"
keys = [{ t = 0, value = [0, 0] }, { t = 1, value = [360, 0] }]
"#;

const TETRA: &str = "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

fn files() -> Files {
    let texts = [
        ("meshes/tetra.obj", TETRA.to_owned()),
        // One face twice, one that is none.
        ("meshes/faulty.obj", format!("{TETRA}f 2 3 4\nf 1 2 2\n")),
        ("meshes/far.obj", TETRA.replace("10", "1e9")),
        ("meshes/broken.obj", "v 0 0\n".to_owned()),
    ];
    texts.into_iter().map(|(path, text)| (path.to_owned(), text.into_bytes())).collect()
}

fn stage(toml: &str) -> StageScene {
    match AnyScene::parse("scenes/test.toml", toml, &files()).map_err(|e| e.to_string()).unwrap() {
        AnyScene::Stage(scene) => scene,
        AnyScene::Theatre(_) => panic!("a stage is wanted"),
    }
}

#[test]
fn what_is_written_is_what_stands_there() {
    let scene = stage(STAGE);
    let still = scene.still();
    assert_eq!((still.ambient, still.exposure), ([0.1; 3], Exposure::White(3.0)));
    // The camera sees what it looks at in its middle.
    let seen = still.camera.sees(DVec3::new(0.0, 0.5, 0.0)).unwrap();
    assert!((seen.x - 0.5).abs() < 1e-12 && (seen.y - 1.0 / 3.0).abs() < 1e-12, "{seen}");
    let [ground, tetra] = &still.objects[..] else { panic!("two objects") };
    // The floor's front, its own +z, is upwards.
    assert!((ground.pose.rotation * DVec3::Z).distance(DVec3::Y) < 1e-12);
    assert!(matches!(ground.surface, Surface::Matte { albedo: [0.5, 0.6, 0.7], texture: None }));
    let Form::Mesh(mesh) = &tetra.form else { panic!("a mesh") };
    assert_eq!((mesh.seen.positions[1], mesh.smooth, tetra.pose.scale), ([0.1, 0.0, 0.0], false, 2.0));
    let LightKind::Projector(projector) = &still.lights[1].kind else { panic!("a projector") };
    assert_eq!((projector.intensity, projector.falloff), ([1.0, 2.0, 3.0], true));
    assert!((projector.at(DVec3::ZERO)[0] - 0.5).abs() < 1e-12, "the slide's middle is at the origin");
}

#[test]
fn a_timeline_moves_objects_lights_and_slides() {
    let scene = stage(STAGE);
    let (start, end) = (scene.at(0.0), scene.at(1.0));
    assert!(start.same_staging(&scene.still()) && !start.same_staging(&scene.at(0.3)));
    assert!(
        (end.objects[1].pose.rotation * DVec3::X).distance(DVec3::NEG_Z) < 1e-12,
        "a quarter turn about y"
    );
    let LightKind::Projector(projector) = &end.lights[1].kind else { panic!("a projector") };
    assert_eq!(projector.pose.position_m, DVec3::new(2.0, 1.0, 0.0));
    assert!(
        (projector.pose.rotation * DVec3::NEG_Z).distance(DVec3::new(-2.0, -1.0, 0.0).normalize()) < 1e-12
    );
    let LightKind::Projector(half) = &scene.at(0.5).lights[1].kind else { panic!("a projector") };
    assert!(matches!(half.slide.pattern, Pattern::Sine { phase_deg: [180.0, 0.0], .. }));
}

#[test]
fn levels_are_made_as_they_are_asked_for() {
    let mut files = files();
    // A closed sheet of many triangles: a subdivided tetrahedron is what it is simplified to.
    let grid = 24usize;
    let mut obj = String::new();
    for j in 0..=grid {
        for i in 0..=grid {
            let [x, y] = [i, j].map(|k| k as f64 / grid as f64);
            obj += &format!("v {x} {y} {}\n", 0.1 * (7.0 * x).sin() * (5.0 * y).cos());
        }
    }
    for j in 0..grid {
        for i in 0..grid {
            let a = j * (grid + 1) + i + 1;
            obj += &format!("f {a} {} {} {}\n", a + 1, a + grid + 2, a + grid + 1);
        }
    }
    files.insert("meshes/sheet.obj".to_owned(), obj.into_bytes());
    let toml = STAGE.replace("tetra.obj", "sheet.obj");
    let read = |more: &str| {
        let toml = toml.replace("normals = \"flat\"", &format!("normals = \"flat\"\n{more}"));
        match AnyScene::parse("scenes/test.toml", &toml, &files).map_err(|e| e.to_string()).unwrap() {
            AnyScene::Stage(scene) => scene,
            AnyScene::Theatre(_) => panic!("a stage is wanted"),
        }
    };
    let counts = |scene: &StageScene| {
        let Form::Mesh(mesh) = &scene.still().objects[1].form else { panic!("a mesh") };
        [mesh.seen.triangles.len(), mesh.caster.triangles.len()]
    };
    assert_eq!(counts(&read("")), [1152, 1152]);
    let coarse = read("level = 300");
    assert!((299..=300).contains(&counts(&coarse)[0]) && counts(&coarse)[0] == counts(&coarse)[1]);
    let caster = read("caster_level = 100");
    assert!(counts(&caster)[0] == 1152 && (99..=100).contains(&counts(&caster)[1]));
    let Form::Mesh(same) = &read("level = 300\ncaster_level = 300").still().objects[1].form.clone() else {
        panic!("a mesh")
    };
    assert!(std::sync::Arc::ptr_eq(&same.seen, &same.caster));
    assert_ne!(coarse.sha256(), read("").sha256());
}

#[test]
fn a_scenes_hash_is_of_its_values_and_meshes() {
    let hash = |toml: &str, files: &Files| match AnyScene::parse("scenes/test.toml", toml, files)
        .map_err(|e| e.to_string())
        .unwrap()
    {
        AnyScene::Stage(scene) => scene.sha256().to_owned(),
        AnyScene::Theatre(scene) => scene.sha256().to_owned(),
    };
    let right = hash(STAGE, &files());
    assert_eq!(hash(&format!("# a comment\n{STAGE}"), &files()), right);
    assert_eq!(hash(stage(STAGE).to_toml(), &files()), right, "as TOML it reads to the same scene");
    assert_ne!(hash(&STAGE.replace("ambient = 0.1", "ambient = 0.2"), &files()), right);
    let mut other = files();
    other.insert("meshes/tetra.obj".to_owned(), TETRA.replace("0 0 10", "0 0 11").into_bytes());
    assert_ne!(hash(STAGE, &other), right);
}

#[test]
fn each_rule_of_a_stage_is_kept() {
    let camera = "field_of_view_deg = 40\naspect = 1.5";
    let mesh = "file = \"../meshes/tetra.obj\"";
    #[rustfmt::skip]
    let cases: &[(&str, &str, &str)] = &[
        ("[stage]\nambient = 0.1", "[stage]\nambient = -1", "stage.ambient = -1: a radiance is from 0"),
        (camera, "", "stage.camera: a camera has one of", ),
        (camera, "field_of_view_deg = 40\nwidth_m = 2", "one of field_of_view_deg, width_m and intrinsics"),
        (camera, "field_of_view_deg = 200", "a field of view is from 0.1 to 179 degrees"),
        (camera, "intrinsics = { size_px = [640, 480], focal_px = [600, 0], centre_px = [320, 240] }", "stage.camera.intrinsics.focal_px[1] = 0"),
        (camera, "intrinsics = { size_px = [640, 480], focal_px = [600, 600], centre_px = [320, 240] }\naspect = 1.5", "the picture's size stands in intrinsics"),
        ("look_at_m = [0, 0.5, 0]", "look_at_m = [0, 1, 3]", "the camera looks at where it is"),
        ("name = \"tetra\"", "name = \"ground\"", "there are two \"ground\""),
        ("name = \"tetra\"", "name = \"te tra\"", "1 to 64 ASCII letters"),
        ("size_m = [4, 3]", "radius_m = 1", "stage.objects[0].radius_m = 1: belongs to a sphere"),
        ("size_m = [4, 3]", "size_m = [4, 0]", "stage.objects[0].size_m[1] = 0: a length is"),
        ("rotate_deg = [-90, 0, 0]", "rotate_deg = [-90, 0, 0]\nrotation = [0, 0, 0, 1]", "by rotate_deg or by rotation, not by both"),
        ("rotate_deg = [-90, 0, 0]", "rotation = [0.5, 0, 0, 0]", "unit quaternion; this one's length is 0.5"),
        ("albedo = [0.5, 0.6, 0.7]", "albedo = 1.5", "an albedo is between 0 and 1"),
        ("albedo = [0.5, 0.6, 0.7]", "albedo = 0.5\nmirror = 0.5", "a mirror has no albedo"),
        (mesh, "file = \"../meshes/tetra.stl\"", "a mesh is a file of .obj, .ply, .gltf or .glb"),
        (mesh, "file = \"../meshes/none.obj\"", "there is no file meshes/none.obj"),
        (mesh, "file = \"../meshes/broken.obj\"", "meshes/broken.obj: line 1"),
        (mesh, "file = \"../meshes/faulty.obj\"", "repair = true mends"),
        (mesh, "file = \"../meshes/far.obj\"", "coordinates are from −1e6 to 1e6"),
        (mesh, "", "stage.objects[1]: a mesh has a file or a model"),
        (mesh, "model = \"hair\"", "must be one of hare, amphora and horse (did you mean hare?)"),
        (mesh, "file = \"../meshes/tetra.obj\"\nmodel = \"hare\"", "of a file or a model, not of both"),
        ("unit = \"cm\"", "unit = \"yd\"", "must be one of m, cm, mm and in"),
        ("scale = 2", "scale = 0", "a scale is from 1e-6 to 1e6"),
        ("normals = \"flat\"", "level = 5", "stage.objects[1].level = 5: a level has from 4 to 4 triangles"),
        ("kind = \"point\"", "kind = \"spot\"", "must be one of point"),
        ("position_m = [1, 2, 0]\nintensity = 5", "position_m = [1, 2, 0]\nintensity = 5\nthrow_deg = 3", "belongs to a projector"),
        ("throw_deg = 30", "throw_deg = 180", "a throw is from 0.1 to 170 degrees"),
        ("pattern = \"sine\"", "pattern = \"spot\"", "stage.lights[1].slide.amplitude = 0.5: belongs to sine, checker or noise"),
        ("amplitude = 0.5", "amplitude = 1.5", "an amplitude is from 0 to 1"),
        ("frequency = [1, 4]", "frequency = -1", "a frequency is from 0 to 10000 cycles a side"),
        ("stage.lights[1].slide.phase_deg", "stage.lights[0].slide.phase_deg", "this light has no such value"),
        ("stage.objects[1].rotate_deg", "stage.objects[7].rotate_deg", "the stage has 2 objects"),
        ("stage.objects[1].rotate_deg", "puppets[0].rotate_deg", "targets are stage.camera.position_m"),
        ("[exposure]", "[screen]\nwidth_m = 1\n[exposure]", "screen: is not a known key"),
    ];
    let mut missed: Vec<String> = Vec::new();
    for (from, to, wanted) in cases {
        assert!(STAGE.contains(from), "{from}");
        // A track that the edit leaves without a target would be a problem of its own.
        let mut toml = STAGE.replacen(from, to, 1);
        if wanted.contains("there are two") || to.contains("spot") || to.contains("levels") {
            toml = toml.split("[timeline]").next().unwrap().to_owned();
        }
        let found: Vec<String> = match AnyScene::parse("scenes/test.toml", &toml, &files()) {
            Ok(_) => Vec::new(),
            Err(problems) => problems.to_string().lines().map(str::to_owned).collect(),
        };
        if !found.iter().any(|m| m.contains(wanted)) {
            missed.push(format!("{wanted:?} for {to:?} in {found:#?}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn a_stage_is_no_theatre() {
    let said = Scene::parse("scenes/test.toml", STAGE, &files()).unwrap_err().to_string();
    assert!(said.contains("subject = \"stage\": a theatre is asked for here, not a stage"), "{said}");
}

#[test]
fn a_model_that_ships_stands_there_by_its_name() {
    let toml = STAGE.replace("file = \"../meshes/tetra.obj\"", "model = \"hare\"");
    let scene = stage(&toml);
    let Form::Mesh(mesh) = &scene.still().objects[1].form.clone() else { panic!("a mesh") };
    assert!((68_000..71_000).contains(&mesh.seen.triangles.len()), "{}", mesh.seen.triangles.len());
    assert_ne!(scene.sha256(), stage(&toml.replace("hare", "horse")).sha256());
}

#[test]
fn a_faulty_mesh_is_repaired_where_the_file_says_so() {
    let toml = STAGE.replace("tetra.obj\"", "faulty.obj\"\nrepair = true");
    let Form::Mesh(mesh) = &stage(&toml).still().objects[1].form.clone() else { panic!("a mesh") };
    assert_eq!(mesh.seen.triangles.len(), 4);
}
