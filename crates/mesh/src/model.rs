//! Meshes where the nodes of a tree put them, and poses of that tree.

use glam::{DAffine3, DQuat, DVec3};

use crate::Mesh;
use crate::mesh::vector;

/// The meshes of a file, hung on a tree of nodes: a figure and its limbs. Lengths are metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The tree; a parent stands before its children.
    pub nodes: Vec<Node>,
    /// What bends the meshes whose vertices have weights.
    pub skin: Option<Skin>,
    /// Movements of the nodes.
    pub animations: Vec<Animation>,
}

/// A place in the tree, and what hangs there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Its name in the file; may be empty.
    pub name: String,
    /// The node that it moves with.
    pub parent: Option<usize>,
    /// Where it stands in its parent unless posed; its translation is the pivot that it turns about.
    pub rest: Transform,
    /// What hangs there, in the node's own frame.
    pub parts: Vec<Part>,
}

/// A mesh of one colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// The mesh.
    pub mesh: Mesh,
    /// For each vertex up to four of the skin's joints and their weights, which add up to 1; `None` where the node alone moves it.
    pub weights: Option<Vec<[(u16, f32); 4]>>,
}

/// A node's frame in its parent's: scaled, then turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Metres.
    pub translation: DVec3,
    /// A unit quaternion.
    pub rotation: DQuat,
    /// Factors along the node's own axes.
    pub scale: DVec3,
}

impl Default for Transform {
    fn default() -> Self {
        Transform { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }
}

impl Transform {
    fn affine(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// Joints that vertices follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Nodes of the model.
    pub joints: Vec<usize>,
    /// For each joint: from the frame that the mesh was made in to the joint's.
    pub inverse_bind: Vec<DAffine3>,
}

/// A movement: nodes' transforms over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// Its name in the file; may be empty.
    pub name: String,
    /// One quantity of one node each.
    pub channels: Vec<Channel>,
}

/// Values of one quantity of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The node that it moves.
    pub node: usize,
    /// Seconds, increasing, at least one.
    pub times: Vec<f32>,
    /// One value a time.
    pub values: Values,
    /// Whether a value holds until the next time (`STEP`) or is blended into the next (`LINEAR`; rotations along the shorter arc).
    pub step: bool,
}

/// What of a node a channel sets.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Metres.
    Translation(Vec<DVec3>),
    /// Unit quaternions.
    Rotation(Vec<DQuat>),
    /// Factors.
    Scale(Vec<DVec3>),
}

impl Animation {
    /// When its last channel ends, seconds.
    pub fn seconds(&self) -> f32 {
        self.channels.iter().filter_map(|channel| channel.times.last()).copied().fold(0.0, f32::max)
    }
}

impl Channel {
    /// The two values around a time, and how far it is from the one to the other; before the first and behind the last it is that one.
    fn around(&self, seconds: f32) -> (usize, usize, f64) {
        let after = self.times.partition_point(|time| *time <= seconds);
        let (from, to) = (after.saturating_sub(1), after.min(self.times.len() - 1));
        let span = self.times[to] - self.times[from];
        let share = if self.step || span <= 0.0 { 0.0 } else { (seconds - self.times[from]) / span };
        (from, to, f64::from(share))
    }

    fn apply(&self, seconds: f32, pose: &mut Transform) {
        let (from, to, share) = self.around(seconds);
        match &self.values {
            Values::Translation(values) => pose.translation = values[from].lerp(values[to], share),
            Values::Rotation(values) => pose.rotation = values[from].slerp(values[to], share),
            Values::Scale(values) => pose.scale = values[from].lerp(values[to], share),
        }
    }
}

impl From<Mesh> for Model {
    /// One node without a name.
    fn from(mesh: Mesh) -> Model {
        let part = Part { mesh, weights: None };
        Model { nodes: vec![Node { parts: vec![part], ..Node::default() }], ..Model::default() }
    }
}

impl Model {
    /// Every node where it rests: a pose to turn some of them in.
    pub fn rest(&self) -> Vec<Transform> {
        self.nodes.iter().map(|node| node.rest).collect()
    }

    /// The first node of a name.
    pub fn node(&self, name: &str) -> Option<usize> {
        self.nodes.iter().position(|node| node.name == name)
    }

    /// The pose of an animation of this model at a time, seconds.
    pub fn animated(&self, animation: &Animation, seconds: f32) -> Vec<Transform> {
        let mut pose = self.rest();
        animation.channels.iter().for_each(|channel| channel.apply(seconds, &mut pose[channel.node]));
        pose
    }

    /// Each part with its node, in the model's own frame, as `pose` (one transform a node) has it.
    ///
    /// Panics when the pose is shorter than the list of nodes.
    pub fn posed(&self, pose: &[Transform]) -> Vec<(usize, Mesh)> {
        let mut world: Vec<DAffine3> = Vec::with_capacity(self.nodes.len());
        for (node, transform) in self.nodes.iter().zip(pose) {
            let above = node.parent.map_or(DAffine3::IDENTITY, |parent| world[parent]);
            world.push(above * transform.affine());
        }
        let joints: Vec<DAffine3> = self
            .skin
            .iter()
            .flat_map(|skin| {
                skin.joints
                    .iter()
                    .zip(&skin.inverse_bind)
                    .map(|(joint, inverse_bind)| world[*joint] * *inverse_bind)
            })
            .collect();
        let parts =
            self.nodes.iter().enumerate().flat_map(|(n, node)| node.parts.iter().map(move |part| (n, part)));
        parts.map(|(n, part)| (n, part.placed(world[n], &joints))).collect()
    }

    /// All parts as one mesh, in the pose. Its colour is the mean of theirs by area; it has normals and texture coordinates where all have.
    pub fn merged(&self, pose: &[Transform]) -> Mesh {
        let mut parts = self.posed(pose).into_iter().map(|(_, mesh)| mesh).collect::<Vec<_>>();
        match parts.len() {
            0 => Mesh::default(),
            1 => parts.remove(0),
            _ => merge(&parts),
        }
    }

    /// Multiplies every length.
    pub(crate) fn scale(&mut self, factor: f64) {
        let Model { nodes, skin, animations } = self;
        for node in nodes {
            node.rest.translation *= factor;
            for position in node.parts.iter_mut().flat_map(|part| &mut part.mesh.positions) {
                *position = (vector(*position) * factor).as_vec3().to_array();
            }
        }
        skin.iter_mut().flat_map(|skin| &mut skin.inverse_bind).for_each(|bind| bind.translation *= factor);
        for channel in animations.iter_mut().flat_map(|animation| &mut animation.channels) {
            if let Values::Translation(values) = &mut channel.values {
                values.iter_mut().for_each(|value| *value *= factor);
            }
        }
    }
}

impl Part {
    fn placed(&self, node: DAffine3, joints: &[DAffine3]) -> Mesh {
        let mut mesh = self.mesh.clone();
        if node == DAffine3::IDENTITY && self.weights.is_none() {
            return mesh;
        }
        let frame = |vertex: usize| match &self.weights {
            None => node,
            // glTF: a skinned mesh follows its joints alone, not its node.
            Some(weights) => blend(&weights[vertex], joints),
        };
        for (vertex, position) in mesh.positions.iter_mut().enumerate() {
            *position = frame(vertex).transform_point3(vector(*position)).as_vec3().to_array();
        }
        for (vertex, normal) in mesh.normals.iter_mut().flatten().enumerate() {
            // The inverse transpose, but for a factor.
            let m = frame(vertex).matrix3;
            let cofactors = glam::DMat3::from_cols(
                m.y_axis.cross(m.z_axis),
                m.z_axis.cross(m.x_axis),
                m.x_axis.cross(m.y_axis),
            );
            let turned = cofactors * vector(*normal) * m.determinant().signum();
            *normal = turned.normalize_or_zero().as_vec3().to_array();
        }
        // A mirror turns the inside out.
        if self.weights.is_none() && node.matrix3.determinant() < 0.0 {
            mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        mesh
    }
}

fn blend(weights: &[(u16, f32); 4], joints: &[DAffine3]) -> DAffine3 {
    let used = weights.iter().filter(|(_, weight)| *weight != 0.0);
    let mut sum = DAffine3::ZERO;
    for &(joint, weight) in used {
        let (joint, weight) = (joints[usize::from(joint)], f64::from(weight));
        sum.matrix3 += joint.matrix3 * weight;
        sum.translation += joint.translation * weight;
    }
    sum
}

fn merge(parts: &[Mesh]) -> Mesh {
    let mut whole = Mesh::default();
    let all = |has: fn(&Mesh) -> bool| parts.iter().all(has);
    whole.normals = all(|part| part.normals.is_some()).then(Vec::new);
    whole.texture = all(|part| part.texture.is_some()).then(Vec::new);
    let (mut colour, mut area) = (DVec3::ZERO, 0.0);
    for part in parts {
        let first = whole.positions.len() as u32;
        whole.positions.extend(&part.positions);
        whole.triangles.extend(part.triangles.iter().map(|triangle| {
            // What was out of range stays so.
            triangle
                .map(|index| if (index as usize) < part.positions.len() { first + index } else { u32::MAX })
        }));
        for (whole, part) in whole.normals.iter_mut().zip(&part.normals) {
            whole.extend(part);
        }
        for (whole, part) in whole.texture.iter_mut().zip(&part.texture) {
            whole.extend(part);
        }
        colour += vector(part.base_colour) * part.area();
        area += part.area();
    }
    if area > 0.0 && area.is_finite() {
        whole.base_colour = (colour / area).as_vec3().to_array();
    }
    whole
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;
    use crate::shapes::{cube, tetrahedron};
    use std::f64::consts::FRAC_PI_2;

    /// A cube with a tetrahedron hung at (1, 0, 0).
    fn two() -> Model {
        let mut model = Model::from(cube());
        model.nodes[0].name = "body".into();
        let part = Part { mesh: Mesh { base_colour: [0.0, 0.5, 1.0], ..tetrahedron() }, weights: None };
        let rest = Transform { translation: DVec3::X, ..Transform::default() };
        model.nodes.push(Node { name: "limb".into(), parent: Some(0), rest, parts: vec![part] });
        model
    }

    #[test]
    fn a_limb_turns_about_its_pivot_and_moves_with_its_parent() {
        let model = two();
        let mut pose = model.rest();
        let limb = model.node("limb").unwrap();
        pose[limb].rotation = DQuat::from_rotation_z(FRAC_PI_2);
        pose[0].translation = DVec3::new(0.0, 0.0, 5.0);
        let parts = model.posed(&pose);
        assert_eq!(parts[1].0, limb);
        // The limb's x axis points up now, from (1, 0, 5).
        let tip = vector(parts[1].1.positions[1]);
        assert!((tip - DVec3::new(1.0, 1.0, 5.0)).length() < 1e-7, "{tip}");
        let merged = model.merged(&pose);
        assert_eq!((merged.positions.len(), merged.triangles.len()), (12, 16));
        assert!((merged.signed_volume() - (1.0 + 1.0 / 6.0)).abs() < 1e-6);
        let limb_area = 1.5 + 3f64.sqrt() / 2.0;
        let expected = (6.0 + 0.5 * limb_area) / (6.0 + limb_area);
        assert!((f64::from(merged.base_colour[1]) - expected).abs() < 1e-6);
    }

    #[test]
    fn a_mirror_keeps_the_outside_out_and_normals_upright() {
        let mut model = Model::from(Mesh { normals: Some(cube().smooth_normals()), ..cube() });
        model.nodes[0].rest.scale = DVec3::new(-1.0, 2.0, 1.0);
        let mirrored = model.merged(&model.rest());
        assert_eq!(mirrored.signed_volume(), 2.0);
        for (position, normal) in mirrored.positions.iter().zip(mirrored.normals.as_ref().unwrap()) {
            let out = vector(*position) - DVec3::new(-0.5, 1.0, 0.5);
            assert!(vector(*normal).dot(out) > 0.5, "{normal:?} at {position:?}");
            assert!((vector(*normal).length() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_skin_blends_its_joints_and_forgets_its_node() {
        let mut model = Model::from(tetrahedron());
        model.nodes[0].rest.translation = DVec3::splat(100.0);
        let joint = |name: &str| Node { name: name.into(), ..Node::default() };
        model.nodes.extend([joint("a"), joint("b")]);
        model.skin =
            Some(Skin { joints: vec![1, 2], inverse_bind: vec![DAffine3::IDENTITY, DAffine3::IDENTITY] });
        let weights = [(0, 0.25), (1, 0.75), (0, 0.0), (0, 0.0)];
        model.nodes[0].parts[0].weights = Some(vec![weights; 4]);
        let mut pose = model.rest();
        pose[1].translation = DVec3::new(4.0, 0.0, 0.0);
        pose[2].translation = DVec3::new(0.0, 4.0, 0.0);
        assert_eq!(model.merged(&pose).positions[1], [1.0 + 1.0, 3.0, 0.0]);
    }

    #[test]
    fn animations_hold_and_blend() {
        let model = two();
        let channel = |step, values| Channel { node: 1, times: vec![1.0, 3.0], values, step };
        let turned = vec![DQuat::IDENTITY, DQuat::from_rotation_z(FRAC_PI_2)];
        let moved = vec![DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0)];
        let animation = Animation {
            name: String::new(),
            channels: vec![
                channel(false, Values::Rotation(turned)),
                channel(true, Values::Translation(moved)),
            ],
        };
        assert_eq!(animation.seconds(), 3.0);
        let angle = |seconds| model.animated(&animation, seconds)[1].rotation.to_axis_angle().1;
        assert!((angle(2.0) - FRAC_PI_2 / 2.0).abs() < 1e-12);
        assert_eq!(angle(0.0), 0.0);
        assert!((angle(9.0) - FRAC_PI_2).abs() < 1e-12);
        let x = |seconds| model.animated(&animation, seconds)[1].translation.x;
        assert_eq!([0.0, 2.9, 3.0].map(x), [0.0, 0.0, 2.0]);
    }

    #[test]
    fn every_length_is_scaled() {
        let mut model = two();
        let plain = model.merged(&model.rest());
        model.scale(0.001);
        let scaled = model.merged(&model.rest());
        assert!((scaled.area() / plain.area() - 1e-6).abs() < 1e-12);
        assert_eq!(model.nodes[1].rest.translation.x, 0.001);
    }
}
