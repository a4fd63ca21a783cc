//! A stage at an instant: what its timeline can move.

use glam::{DQuat, DVec3, EulerRot};

use super::{Light, LightKind, Pattern, Pose, Slide, Stage};
use crate::timeline::{Target, Timeline};

/// What a track drives.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Moved {
    Camera,
    ObjectPosition(usize),
    ObjectTurn(usize),
    LightPosition(usize),
    SlidePhase(usize),
    SlideTurn(usize),
}

/// What something looks at, wherever it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    pub at_m: DVec3,
    pub up: DVec3,
}

/// The stage as written, and what of it is needed once it moves.
#[derive(Debug)]
pub(crate) struct Placed {
    pub still: Stage,
    pub camera_aim: Aim,
    /// Of each light that looks at something.
    pub light_aims: Vec<Option<Aim>>,
}

/// A turn about z, then x, then y, by [x, y, z] degrees.
pub(crate) fn turned([x, y, z]: [f64; 3]) -> DQuat {
    DQuat::from_euler(EulerRot::YXZ, y.to_radians(), x.to_radians(), z.to_radians())
}

/// A lamp shines along its own +z; what looks does so along −z.
pub(crate) fn facing(pose: Pose) -> Pose {
    Pose { rotation: pose.rotation * DQuat::from_rotation_y(std::f64::consts::PI), ..pose }
}

impl Placed {
    /// The stage at an instant within the timeline.
    pub(crate) fn at(&self, timeline: &Timeline, instant_s: f64) -> Stage {
        let mut stage = self.still.clone();
        for track in &timeline.tracks {
            let value = track.value(instant_s);
            let vector = || DVec3::from_slice(&value);
            let Target::Stage(moved) = &track.target else { continue };
            match *moved {
                Moved::Camera => {
                    let aim = &self.camera_aim;
                    stage.camera.pose = Pose::looking(vector(), aim.at_m, aim.up);
                }
                Moved::ObjectPosition(k) => stage.objects[k].pose.position_m = vector(),
                Moved::ObjectTurn(k) => {
                    stage.objects[k].pose.rotation = turned([value[0], value[1], value[2]])
                }
                Moved::LightPosition(k) => stage.lights[k].move_to(vector(), self.light_aims[k]),
                Moved::SlidePhase(k) => stage.lights[k].change(|slide| {
                    let mut pattern = slide.pattern.clone();
                    if let Pattern::Sine { phase_deg, .. } | Pattern::Checker { phase_deg, .. } = &mut pattern
                    {
                        *phase_deg = [value[0], value[1]];
                    }
                    Slide::new(pattern, slide.orientation_deg, slide.edge)
                }),
                Moved::SlideTurn(k) => {
                    stage.lights[k].change(|slide| Slide::new(slide.pattern.clone(), value[0], slide.edge));
                }
            }
        }
        stage
    }
}

impl Light {
    pub(crate) fn has_position(&self) -> bool {
        !matches!(self.kind, LightKind::Directional { .. } | LightKind::Environment(_))
    }

    pub(crate) fn has_slide(&self) -> bool {
        matches!(self.kind, LightKind::Projector(_))
    }

    pub(crate) fn has_phase(&self) -> bool {
        matches!(&self.kind, LightKind::Projector(p)
            if matches!(p.slide.pattern, Pattern::Sine { .. } | Pattern::Checker { .. }))
    }

    fn move_to(&mut self, to_m: DVec3, aim: Option<Aim>) {
        let looking = |aim: Aim| Pose::looking(to_m, aim.at_m, aim.up);
        match (&mut self.kind, aim) {
            (LightKind::Point { position_m, .. }, _) => *position_m = to_m,
            (LightKind::Area { pose, .. }, Some(aim)) => {
                *pose = facing(looking(aim));
            }
            (LightKind::Projector(projector), Some(aim)) => projector.pose = looking(aim),
            _ => {}
        }
    }

    fn change(&mut self, slide: impl FnOnce(&Slide) -> Slide) {
        if let LightKind::Projector(projector) = &mut self.kind {
            projector.slide = slide(&projector.slide);
        }
    }
}
