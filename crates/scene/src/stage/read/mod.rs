//! Reads the sections of a scene file that shows a stage.

mod camera;
mod light;
mod mesh;
mod object;
mod pose;

use std::collections::BTreeMap;

use kelir_reader::{Fields, Node};

use super::moving::{Aim, Moved, Placed};
use super::scene::StageScene;
use super::{Light, Stage};
use crate::fields::{self, exposure};
use crate::limits;
use crate::load::Loader;
use crate::theatre::Exposure;
use crate::timeline::{self, Driven, ReadValue, Target, Timeline};

/// The stage's part of a scene file: what `subject = "stage"` has beside its subject.
pub(crate) fn stage(
    root: &Node,
    mut sections: Fields,
    label: &str,
    name: &str,
    loader: Loader,
) -> Option<StageScene> {
    let read = sections.need("stage", "the [stage] section", |node| section(node, name, &loader));
    let exposure = sections.optional(
        "exposure",
        "what is shown as white; without it the brightest that can be seen",
        Exposure::Auto,
        exposure,
    );
    let moving = sections.given("timeline", "how the scene moves; without it it stands still");
    let timeline: Option<Option<Timeline>> = match (moving, &read) {
        (None, _) => Some(None),
        (Some(node), Some((placed, _))) => timeline::read(&node, &|n| target(n, placed)).map(Some),
        (Some(_), None) => None,
    };
    sections.done();
    let (mut placed, made) = read?;
    placed.still.exposure = exposure?;
    let timeline = timeline?;
    if !loader.reading.is_sound() {
        return None;
    }
    let sha256 = crate::scene::hash(&root.canonical(), loader.files(), &made);
    Some(StageScene {
        label: label.to_owned(),
        sha256,
        toml: root.to_toml(),
        placed,
        timeline,
        warnings: Vec::new(),
    })
}

/// Hashes of what was made of files by arithmetic that other machines may round otherwise, by where it is.
pub(super) type Made = BTreeMap<String, String>;

fn section(node: &Node, name: &str, loader: &Loader) -> Option<(Placed, Made)> {
    let mut fields = node.table()?;
    let camera = fields.need("camera", "who looks: the [stage.camera] section", camera::camera);
    let mut made = Made::new();
    let objects = fields.optional("objects", "what stands there, one table each", Vec::new(), |n| {
        let items = n.array(limits::OBJECTS)?;
        let read: Vec<_> = items.iter().map(|item| object::object(item, name, loader, &mut made)).collect();
        let objects: Vec<_> = read.into_iter().collect::<Option<_>>()?;
        unique(&items, objects.iter().map(|object| object.name.as_str()), "an object").then_some(objects)
    });
    let lights = fields.optional("lights", "what shines, one table each", Vec::new(), |n| {
        let items = n.array(limits::LIGHTS)?;
        let read: Vec<_> = items.iter().map(|item| light::light(item, name, loader)).collect();
        let lights: Vec<(Light, Option<Aim>)> = read.into_iter().collect::<Option<_>>()?;
        unique(&items, lights.iter().map(|(light, _)| light.name.as_str()), "a light").then_some(lights)
    });
    let ambient = fields.optional(
        "ambient",
        "radiance that every surface is lit by from all sides, without shadow, a number or [r, g, b]; without it 0",
        [0.0; 3],
        fields::radiance,
    );
    fields.done();
    let ((camera, camera_aim), objects, lights) = (camera?, objects?, lights?);
    let (lights, light_aims) = lights.into_iter().unzip();
    let still = Stage { camera, objects, lights, ambient: ambient?, exposure: Exposure::Auto };
    Some((Placed { still, camera_aim, light_aims }, made))
}

/// Whether all names differ; the second of two alike is refused.
fn unique<'a>(items: &[Node], names: impl Iterator<Item = &'a str>, what: &str) -> bool {
    let mut known: Vec<&str> = Vec::new();
    let mut all = true;
    for (item, name) in items.iter().zip(names) {
        if known.contains(&name) {
            item.refuse::<()>(format!("the name of {what} must be unique, and there are two {name:?}"));
            all = false;
        }
        known.push(name);
    }
    all
}

/// A name that messages and channels can use.
fn called(node: &Node) -> Option<String> {
    let name = node.string()?;
    let sound = !name.is_empty()
        && name.len() <= 64
        && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    if sound {
        Some(name.to_owned())
    } else {
        node.refuse("a name has 1 to 64 ASCII letters, digits, _ or -")
    }
}

/// What a track's target names, and how its values are read.
fn target<'r>(node: &Node, placed: &'r Placed) -> Option<Driven<'r>> {
    let name = node.string()?;
    let point = || -> Box<ReadValue<'r>> { Box::new(|n| fields::point(n).map(|p| p.to_vec())) };
    if name == "stage.camera.position_m" {
        return Some((Target::Stage(Moved::Camera), point()));
    }
    let known = "targets are stage.camera.position_m, stage.objects[i].position_m and .rotate_deg, stage.lights[i].position_m, \
        .slide.phase_deg and .slide.orientation_deg";
    let numbered = |list: &str, count: usize| {
        let (index, field) = name.strip_prefix(list)?.strip_prefix('[')?.split_once("].")?;
        Some((index.parse::<usize>().ok().filter(|i| *i < count), field))
    };
    if let Some((index, field)) = numbered("stage.objects", placed.still.objects.len()) {
        let Some(i) = index else {
            return node.refuse(format!("the stage has {} objects", placed.still.objects.len()));
        };
        return match field {
            "position_m" => Some((Target::Stage(Moved::ObjectPosition(i)), point())),
            "rotate_deg" => Some((
                Target::Stage(Moved::ObjectTurn(i)),
                Box::new(|n| pose::turn_deg(n).map(|t| t.to_vec())),
            )),
            _ => node.refuse(known),
        };
    }
    if let Some((index, field)) = numbered("stage.lights", placed.still.lights.len()) {
        let Some(i) = index else {
            return node.refuse(format!("the stage has {} lights", placed.still.lights.len()));
        };
        let has = |what: bool, target, read| {
            if what { Some((target, read)) } else { node.refuse("this light has no such value") }
        };
        let light = &placed.still.lights[i];
        return match field {
            "position_m" => has(light.has_position(), Target::Stage(Moved::LightPosition(i)), point()),
            "slide.phase_deg" => has(
                light.has_phase(),
                Target::Stage(Moved::SlidePhase(i)),
                Box::new(|n| pose::angles(n).map(|p| p.to_vec())),
            ),
            "slide.orientation_deg" => has(
                light.has_slide(),
                Target::Stage(Moved::SlideTurn(i)),
                Box::new(|n| pose::degrees(n).map(|d| vec![d])),
            ),
            _ => node.refuse(known),
        };
    }
    node.refuse(known)
}
