//! A scene: read, checked as a whole, and staged at any instant.

use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use kelir_reader::{Fields, Node, Problem, Problems, Reading};
use sha2::{Digest, Sha256};

use crate::assets::{Assets, DirAssets, read_file, root_of};
use crate::fields;
use crate::limits;
use crate::load::Loader;
use crate::puppet::masks::Masks;
use crate::puppet::read::{Entry, degrees, find_part, pose_deg, tilt};
use crate::stage::StageScene;
use crate::staging::{Misplaced, Puppet, Staging};
use crate::subject::{self, Subject};
use crate::theatre::{Albedo, Ambient, Emitter, Exposure, Lamp, Mask, Texels, Theatre};
use crate::timeline::{self, Driven, Target, Timeline};

/// A valid scene: what is drawn, still or moving. It never changes and may be shared; what drawing it makes anew is kept in [`Masks`].
///
/// Every theatre it gives keeps the invariants that techniques rely on: everything is finite, sizes are positive, and
/// every corner of every plane lies strictly between lamp and screen (for a timeline: at every frame and key).
#[derive(Debug)]
pub struct Scene {
    label: String,
    sha256: String,
    toml: String,
    puppets: Vec<Puppet>,
    staging: Staging,
    timeline: Option<Timeline>,
    still: Theatre,
    warnings: Vec<Problem>,
}

/// A scene of either subject.
#[derive(Debug)]
pub enum AnyScene {
    /// Puppets between a lamp and a screen.
    Theatre(Scene),
    /// Meshes on a stage.
    Stage(StageScene),
}

impl AnyScene {
    /// As [`Scene::from_path`], whatever it shows.
    ///
    /// # Errors
    /// Everything that is wrong with the scene and the files that it names.
    pub fn from_path(path: &Path) -> Result<AnyScene, Problems> {
        let label = path.to_string_lossy();
        let refuse = |rule: String| Problems::new(vec![Problem::new(label.clone(), "", None, rule)]);
        let bytes =
            read_file(path, limits::SCENE_BYTES).map_err(|e| refuse(format!("can't be read: {e}")))?;
        let text = String::from_utf8(bytes).map_err(|_| refuse("is not UTF-8 text".to_owned()))?;
        let (root, name) = root_of(path);
        read(&label, &name, &text, &DirAssets::new(root))
    }

    /// As [`Scene::parse`], whatever it shows.
    ///
    /// # Errors
    /// Everything that is wrong with the scene and the files that it names.
    pub fn parse(name: &str, toml: &str, assets: &dyn Assets) -> Result<AnyScene, Problems> {
        read(name, name, toml, assets)
    }

    /// What may be a mistake in it or in the files that it names, though it can be drawn.
    pub fn warnings(&self) -> &[Problem] {
        match self {
            Self::Theatre(scene) => scene.warnings(),
            Self::Stage(scene) => scene.warnings(),
        }
    }

    /// SHA-256, in hexadecimal, over its values and files.
    pub fn sha256(&self) -> &str {
        match self {
            Self::Theatre(scene) => scene.sha256(),
            Self::Stage(scene) => scene.sha256(),
        }
    }

    /// How it moves, if it does.
    pub fn timeline(&self) -> Option<&Timeline> {
        match self {
            Self::Theatre(scene) => scene.timeline(),
            Self::Stage(scene) => scene.timeline(),
        }
    }

    fn theatre(self, label: &str) -> Result<Scene, Problems> {
        match self {
            Self::Theatre(scene) => Ok(scene),
            Self::Stage(_) => Err(Problems::new(vec![Problem::new(
                label,
                "subject",
                Some("\"stage\"".to_owned()),
                "a theatre is asked for here, not a stage",
            )])),
        }
    }
}

impl Scene {
    /// Reads a scene file. The files that it names lie below the scene's folder, or below that folder's parent when
    /// the folder is called `scenes`.
    ///
    /// # Errors
    /// Everything that is wrong with the scene and the files that it names.
    pub fn from_path(path: &Path) -> Result<Scene, Problems> {
        AnyScene::from_path(path)?.theatre(&path.to_string_lossy())
    }

    /// Reads a scene from text. `name` is the scene's path from the assets' root (`scenes/arjuna.toml`): paths in the
    /// scene are relative to it, and messages use it.
    ///
    /// # Errors
    /// Everything that is wrong with the scene and the files that it names.
    pub fn parse(name: &str, toml: &str, assets: &dyn Assets) -> Result<Scene, Problems> {
        AnyScene::parse(name, toml, assets)?.theatre(name)
    }

    /// What messages call it: the file that it was read from.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// What may be a mistake in it or in the files that it names, though it can be drawn.
    pub fn warnings(&self) -> &[Problem] {
        &self.warnings
    }

    /// SHA-256, in hexadecimal, over the scene's values (not its comments or layout) and every file that it names.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The scene as TOML that reads to the same scene, with the same SHA-256, beside the same files: values as they were written, in one layout and
    /// without comments.
    pub fn to_toml(&self) -> &str {
        &self.toml
    }

    /// The scene as written, without its timeline.
    pub fn still(&self) -> Theatre {
        self.still.clone()
    }

    /// How the scene moves, if it does.
    pub fn timeline(&self) -> Option<&Timeline> {
        self.timeline.as_ref()
    }

    /// Where the lamp is at an instant of the timeline, metres; no puppet is posed for it.
    pub fn lamp_at(&self, time_s: f64) -> glam::DVec3 {
        self.staging_at(time_s).lamp_m
    }

    /// The puppets in the file's order.
    pub fn puppets(&self) -> &[Puppet] {
        &self.puppets
    }

    /// Where lamp and puppets are as written.
    pub fn staging(&self) -> &Staging {
        &self.staging
    }

    /// Where lamp and puppets are at an instant of the timeline; as written when there is none.
    pub fn staging_at(&self, time_s: f64) -> Staging {
        match &self.timeline {
            Some(timeline) => self.staging.at(timeline, timeline.instant_s(time_s)),
            None => self.staging.clone(),
        }
    }

    /// The scene at an instant of its timeline; as written when there is none. A puppet whose pose and rotation are as written, or as in a recent call
    /// with the same `masks`, keeps its mask (the same [`Arc`], the same [`Mask::id`]).
    pub fn theatre_at(&self, time_s: f64, masks: &mut Masks) -> Theatre {
        let staging = self.staging_at(time_s);
        let settings = self.puppets.iter().zip(&staging.puppets);
        let planes = settings.map(|(p, s)| p.posed(s, masks.posed(&p.figure, &s.pose))).collect();
        let mut theatre = Theatre { planes, ..self.still.clone() };
        theatre.lamp.position_m = staging.lamp_m;
        theatre
    }
}

/// `label` is how messages call the file, `name` its path from the assets' root.
fn read(label: &str, name: &str, toml: &str, assets: &dyn Assets) -> Result<AnyScene, Problems> {
    let reading = Reading::default();
    let scene = read_into(&reading, label, name, toml, assets);
    let warnings = reading.take_warnings();
    reading.end(scene.map(|scene| match scene {
        AnyScene::Theatre(scene) => AnyScene::Theatre(Scene { warnings, ..scene }),
        AnyScene::Stage(scene) => AnyScene::Stage(StageScene { warnings, ..scene }),
    }))
}

/// Reads a scene with the files that it names into a reading.
pub(crate) fn read_into(
    reading: &Reading,
    label: &str,
    name: &str,
    toml: &str,
    assets: &dyn Assets,
) -> Option<AnyScene> {
    let loader = Loader::new(assets, label, name, reading);
    let source = reading.source(label, toml);
    if toml.len() > limits::SCENE_BYTES {
        let rule = format!("has {} bytes; a scene has at most {}", toml.len(), limits::SCENE_BYTES);
        source.refuse("", None, rule);
        return None;
    }
    source.read(|root| read_scene(root, label, name, loader))
}

fn read_scene(root: &Node, label: &str, name: &str, loader: Loader) -> Option<AnyScene> {
    let mut sections = root.table()?;
    let subject = sections.optional(
        "subject",
        "what the scene shows, \"theatre\" or \"stage\"; without it a theatre",
        Subject::Theatre,
        subject::subject,
    );
    match subject {
        Some(Subject::Theatre) | None => {}
        Some(Subject::Stage) => {
            return crate::stage::read::stage(root, sections, label, name, loader).map(AnyScene::Stage);
        }
        // It has other sections: what lacks of a theatre's would only hide the reason.
        Some(Subject::Plate) => return None,
    }
    let screen = sections.need("screen", "the [screen] section", |n| fields::screen(n, name, &loader));
    let (lamp_m, emitters) = sections.need("lamp", "the [lamp] section", fields::lamp).unwrap_or_default();
    let ambient = sections.optional(
        "ambient",
        "light that the lamp does not send directly; without it there is none",
        Ambient::None,
        fields::ambient,
    );
    let mut white = None;
    let exposure = sections.optional(
        "exposure",
        "what is shown as white; without it the brightest that can be seen",
        Exposure::Auto,
        |n| {
            white = Some(n.clone());
            fields::exposure(n)
        },
    );
    let mut entries = read_puppets(&mut sections, name, &loader);
    let timeline = match sections.given("timeline", "how the scene moves; without it it stands still") {
        Some(node) => read_timeline(&node, &entries).map(Some),
        None => Some(None),
    };
    sections.done();
    free_parts(&mut entries, timeline.as_ref().and_then(Option::as_ref));

    if let (Some(screen), Some(emitters), Some(ambient), Some(Exposure::Auto)) =
        (&screen, &emitters, &ambient, exposure)
    {
        check_light(&screen.albedo, emitters, ambient, white.as_ref(), root);
    }
    if let Some(lamp_m) = lamp_m {
        check_still(lamp_m.z, &entries, root);
    }
    let lamp = Lamp { position_m: lamp_m?, emitters: emitters? };
    let entries: Vec<Entry> = entries.into_iter().collect::<Option<_>>()?;
    let timeline = timeline?;
    let settings = entries.iter().map(|e| e.setting.clone()).collect();
    let staging = Staging { lamp_m: lamp.position_m, puppets: settings };
    if let Some(timeline) = &timeline {
        check_timeline(timeline, &staging, &entries, root);
    }
    if !loader.reading.is_sound() {
        return None;
    }

    let (screen, ambient, exposure) = (screen?, ambient?, exposure?);
    let mut puppets: Vec<Puppet> = entries.into_iter().map(|e| e.puppet).collect();
    let settled = puppets.iter_mut().zip(&staging.puppets).enumerate().map(|(i, (puppet, setting))| {
        let moving = moving_parts(timeline.as_ref(), i, puppet);
        let rest = puppet.figure.settle(moving, &setting.pose);
        puppet.posed(setting, rest)
    });
    let planes = settled.collect();
    let still = Theatre { screen, lamp, ambient, planes, exposure };
    let sha256 = hash(&root.canonical(), loader.files(), &BTreeMap::new());
    Some(AnyScene::Theatre(Scene {
        label: label.to_owned(),
        sha256,
        toml: root.to_toml(),
        puppets,
        staging,
        timeline,
        still,
        warnings: Vec::new(),
    }))
}

fn read_puppets<'a>(sections: &mut Fields<'a>, name: &str, loader: &Loader) -> Vec<Option<Entry<'a>>> {
    let Some(node) = sections
        .given("puppets", "what hangs behind the cloth, one table each; without any the cloth is empty")
    else {
        return Vec::new();
    };
    let Some(items) = node.array(limits::PUPPETS) else { return vec![None] };
    items.iter().map(|item| crate::puppet::read::read(item, name, loader)).collect()
}

/// Light that `white = "auto"` can be taken from.
fn check_light(albedo: &Albedo, emitters: &[Emitter], ambient: &Ambient, white: Option<&Node>, root: &Node) {
    let dome = if let Ambient::Dome { radiance } = ambient { *radiance } else { [0.0; 3] };
    let lit = |c: usize| dome[c] > 0.0 || emitters.iter().any(|e| e.radiance[c] > 0.0);
    let seen = |c: usize| match albedo {
        Albedo::Uniform(rgb) => rgb[c] > 0.0,
        Albedo::Image(image) => image.channel(c).iter().any(|v| *v > 0.0),
    };
    if !(0..3).any(|c| lit(c) && seen(c)) {
        let rule = "white = \"auto\" needs light: lamp or cloth are black in every channel";
        white.unwrap_or(root).refuse::<()>(rule);
    }
}

/// Whether a track of the timeline drives `target`.
fn drives(timeline: Option<&Timeline>, target: &Target) -> bool {
    timeline.is_some_and(|timeline| timeline.tracks.iter().any(|track| track.target == *target))
}

/// Parts that a pose names or a track drives reach beyond the drawing's edge, at whatever angle: what is seen of them follows from it smoothly.
fn free_parts(entries: &mut [Option<Entry>], timeline: Option<&Timeline>) {
    for (i, entry) in entries.iter_mut().enumerate() {
        let Some(Entry { posed, puppet, .. }) = entry else { continue };
        let named = posed.iter().enumerate();
        let posed: Vec<bool> =
            named.map(|(part, named)| *named || drives(timeline, &Target::Pose(i, part))).collect();
        puppet.figure.free(&posed);
    }
}

/// Which parts of puppet `i` the timeline may move.
fn moving_parts(timeline: Option<&Timeline>, i: usize, puppet: &Puppet) -> Vec<bool> {
    let turned = drives(timeline, &Target::Rotate(i));
    let posed: Vec<bool> =
        (0..limits::PARTS).map(|part| turned || drives(timeline, &Target::Pose(i, part))).collect();
    puppet.figure.followers(&posed)
}

/// A mask for planes whose corners alone are asked for.
fn nothing() -> Arc<Mask> {
    Arc::new(Mask::new(1, 1, 1, Texels::U8(vec![255])))
}

/// A number as messages write it.
fn shown(number: f64) -> String {
    format!("{number}").replace('-', "−")
}

fn rule_of(misplaced: &Misplaced, lamp_z_m: f64) -> String {
    let between = format!("backstage, between lamp ({}) and screen (0)", shown(lamp_z_m));
    match misplaced {
        Misplaced::Centre(_) => format!("a puppet hangs {between}"),
        Misplaced::Corner(z) => {
            format!("a corner of the puppet's grid is at z = {}; every corner hangs {between}", shown(*z))
        }
        Misplaced::Grid([w, h]) => format!(
            "the posed grid has {w} × {h} texels; at most {} a side and {} in all",
            limits::GRID_SIDE,
            limits::SCENE_TEXELS
        ),
    }
}

/// Where the puppets hang; those that were refused already have their own problems.
fn check_still(lamp_z_m: f64, entries: &[Option<Entry>], root: &Node) {
    let nothing = nothing();
    let mut texels = 0usize;
    for entry in entries.iter().flatten() {
        match entry.puppet.check(&entry.setting, lamp_z_m, &nothing) {
            Ok(values) => texels = texels.saturating_add(values),
            Err(misplaced) => {
                let rule = rule_of(&misplaced, lamp_z_m);
                let z = entry.position.as_ref().and_then(|n| n.array(3)?.pop());
                let node = match misplaced {
                    Misplaced::Centre(_) => z.as_ref(),
                    Misplaced::Corner(_) => entry.tilt.as_ref(),
                    Misplaced::Grid(_) => None,
                };
                node.unwrap_or(&entry.node).refuse::<()>(rule);
            }
        }
    }
    if texels > limits::SCENE_TEXELS {
        root.refuse::<()>(format!(
            "the puppets have {texels} texels in all; at most {}",
            limits::SCENE_TEXELS
        ));
    }
}

fn check_timeline(timeline: &Timeline, staging: &Staging, entries: &[Entry], root: &Node) {
    let frames = timeline.frame_count();
    let parts: usize = entries.iter().map(|e| e.puppet.parts.len() + 1).sum();
    let keys = timeline.tracks.iter().map(|t| t.keys.len()).sum::<usize>();
    if (frames + keys).saturating_mul(parts + timeline.tracks.len()) > 20_000_000 {
        let rule =
            format!("{frames} frames and {keys} keys of {parts} parts are too many; shorten the timeline");
        return root.report("timeline", rule);
    }
    let nothing = nothing();
    let key_times = timeline.tracks.iter().flat_map(|t| t.keys.iter().map(|(t, _)| *t));
    let frame_times = (0..frames).map(|frame| timeline.instant_s(timeline.frame_time_s(frame)));
    let mut refused = vec![false; entries.len()];
    for instant in frame_times.chain(key_times) {
        let staging = staging.at(timeline, instant);
        let mut texels = 0usize;
        for (i, (setting, entry)) in staging.puppets.iter().zip(entries).enumerate() {
            match entry.puppet.check(setting, staging.lamp_m.z, &nothing) {
                Ok(values) => texels = texels.saturating_add(values),
                Err(_) if refused[i] => {}
                Err(misplaced) => {
                    refused[i] = true;
                    let at = match misplaced {
                        Misplaced::Centre(z) => format!("puppets[{i}].position_m[2] is {}", shown(z)),
                        _ => format!("puppets[{i}] is out of place"),
                    };
                    let rule = rule_of(&misplaced, staging.lamp_m.z);
                    root.report("timeline", format!("at {instant} s {at}: {rule}"));
                }
            }
        }
        if texels > limits::SCENE_TEXELS {
            let most = limits::SCENE_TEXELS;
            let rule = format!("at {instant} s the puppets have {texels} texels in all; at most {most}");
            return root.report("timeline", rule);
        }
    }
}

fn read_timeline(node: &Node, entries: &[Option<Entry>]) -> Option<Timeline> {
    timeline::read(node, &|n| target(n, entries))
}

/// What a track's target names, and how its values are read.
fn target<'r>(node: &Node, entries: &'r [Option<Entry>]) -> Option<Driven<'r>> {
    let name = node.string()?;
    if name == "lamp.position_m" {
        return Some((
            Target::LampPosition,
            Box::new(|n| fields::lamp_position(n).map(|p| p.to_array().to_vec())),
        ));
    }
    let known =
        "targets are lamp.position_m and puppets[i].position_m, .rotate_deg, .tilt_deg and .pose.<part>";
    let Some((index, field)) = name.strip_prefix("puppets[").and_then(|rest| rest.split_once("].")) else {
        return node.refuse(known);
    };
    let Some(i) = index.parse::<usize>().ok().filter(|i| *i < entries.len()) else {
        return node
            .refuse(format!("there is no puppets[{index:.20}]; the scene has {} puppets", entries.len()));
    };
    let entry = entries[i].as_ref();
    match field {
        "position_m" => Some((Target::Position(i), Box::new(|n| fields::point(n).map(|p| p.to_vec())))),
        "rotate_deg" => Some((Target::Rotate(i), Box::new(|n| degrees(n).map(|d| vec![d])))),
        "tilt_deg" => Some((Target::Tilt(i), Box::new(|n| tilt(n).map(|t| t.to_vec())))),
        _ => {
            let Some(part) = field.strip_prefix("pose.") else { return node.refuse(known) };
            let parts = entry?.puppet.parts(); // a puppet that was refused has its own problems
            let part = find_part(node, part, parts)?;
            if parts[part].pivot.is_none() {
                let id = &parts[part].id;
                return node
                    .refuse(format!("part {id:?} has no pivot in the puppet's manifest to turn about"));
            }
            Some((Target::Pose(i, part), Box::new(move |n| pose_deg(n, &parts[part]).map(|d| vec![d]))))
        }
    }
}

/// Each piece is preceded by its length, so that no two different inputs run together to the same bytes.
/// `made` are hashes of what was made of files.
pub(crate) fn hash(
    canonical: &str,
    files: BTreeMap<String, Rc<[u8]>>,
    made: &BTreeMap<String, String>,
) -> String {
    let mut sha = Sha256::new();
    let mut piece = |bytes: &[u8]| {
        sha.update((bytes.len() as u64).to_le_bytes());
        sha.update(bytes);
    };
    piece(b"kelir scene 1");
    piece(canonical.as_bytes());
    for (path, bytes) in &files {
        piece(path.as_bytes());
        piece(bytes);
    }
    for (place, hash) in made {
        piece(place.as_bytes());
        piece(hash.as_bytes());
    }
    hex::encode(sha.finalize())
}
