//! Where something is and how it is turned.

use glam::{DQuat, DVec3};
use kelir_reader::{Fields, Node};

use super::super::Pose;
use super::super::moving::{Aim, turned};
use crate::fields::point;
use crate::limits;

pub(super) fn degrees(node: &Node) -> Option<f64> {
    node.number_in(-limits::DEGREES..=limits::DEGREES, "an angle is from −1e6 to 1e6 degrees")
}

/// Turns about x, y and z, degrees.
pub(super) fn turn_deg(node: &Node) -> Option<[f64; 3]> {
    node.items(degrees)
}

/// Two angles, degrees.
pub(super) fn angles(node: &Node) -> Option<[f64; 2]> {
    node.items(degrees)
}

fn quaternion(node: &Node) -> Option<DQuat> {
    let q: [f64; 4] = node.items(|x| x.number_in(-1.0..=1.0, "a quaternion's numbers are from −1 to 1"))?;
    let q = DQuat::from_array(q);
    if (q.length() - 1.0).abs() < 1e-3 {
        Some(q.normalize())
    } else {
        node.refuse(format!("[x, y, z, w] is a unit quaternion; this one's length is {}", q.length()))
    }
}

/// A pose by `position_m`, and a turn by `rotate_deg` or `rotation`.
pub(super) fn pose(fields: &mut Fields) -> Option<Pose> {
    let position_m = fields.optional(
        "position_m",
        "where its origin is, [x, y, z] in metres; without it [0, 0, 0]",
        [0.0; 3],
        point,
    );
    let turn = fields.given(
        "rotate_deg",
        "turns about its z, then the stage's x, then its y, [x, y, z] in degrees; or a rotation; without either none",
    );
    let rotation = fields.given("rotation", "its turn as a unit quaternion [x, y, z, w]; or rotate_deg");
    if let (Some(turn), Some(_)) = (&turn, &rotation) {
        turn.refuse::<()>("a turn is given by rotate_deg or by rotation, not by both");
        return None;
    }
    let turn_deg = turn.as_ref().map_or(Some([0.0; 3]), turn_deg)?;
    let rotation = match &rotation {
        Some(node) => quaternion(node)?,
        None => turned(turn_deg),
    };
    Some(Pose { position_m: position_m?.into(), rotation, scale: 1.0 })
}

/// The pose of what stands at `position_m` and looks at `look_at_m`, and what it looks at.
pub(super) fn looking(fields: &mut Fields, what: &str) -> Option<(Pose, Aim)> {
    let from = fields.need("position_m", &format!("where {what} is, [x, y, z] in metres"), point);
    let at_node = fields
        .given("look_at_m", &format!("what {what} looks at, [x, y, z] in metres; without it the origin"));
    let at = at_node.as_ref().map_or(Some([0.0; 3]), point);
    let up = fields.optional(
        "up",
        "what is upwards for it, [x, y, z]; without it [0, 1, 0]",
        [0.0, 1.0, 0.0],
        |n| {
            let up: [f64; 3] =
                n.items(|x| x.number_in(-1e6..=1e6, "a direction's numbers are from −1e6 to 1e6"))?;
            if DVec3::from(up).length() > 1e-9 { Some(up) } else { n.refuse("a direction has a length") }
        },
    );
    let (from, at, up): (DVec3, DVec3, DVec3) = (from?.into(), at?.into(), up?.into());
    if from.distance(at) < limits::LENGTH_M {
        return at_node.as_ref().unwrap_or(fields.node()).refuse(format!("{what} looks at where it is"));
    }
    Some((Pose::looking(from, at, up), Aim { at_m: at, up }))
}
