//! Reads `[stage.camera]`.

use kelir_reader::Node;

use super::super::moving::Aim;
use super::super::{Camera, Projection};
use super::pose::looking;
use crate::fields::length;

pub(super) fn camera(node: &Node) -> Option<(Camera, Aim)> {
    let mut fields = node.table()?;
    let posed = looking(&mut fields, "the camera");
    let angle =
        fields.given("field_of_view_deg", "perspective: the angle that the picture's height covers, degrees");
    let width = fields.given("width_m", "orthographic: what the picture's width covers, metres");
    let intrinsics = fields.given("intrinsics", "perspective by a calibrated camera's numbers, in pixels");
    let aspect =
        fields.given("aspect", "width over height of the picture; without it 16/9, or that of intrinsics");
    if [&angle, &width, &intrinsics].iter().filter(|given| given.is_some()).count() != 1 {
        fields.done();
        return node.refuse("a camera has one of field_of_view_deg, width_m and intrinsics");
    }
    let ratio = |node: &Node| node.number_in(0.01..=100.0, "width over height is from 0.01 to 100");
    let aspect = match (&aspect, &intrinsics) {
        (Some(node), Some(_)) => node.refuse("the picture's size stands in intrinsics"),
        (Some(node), None) => ratio(node),
        (None, _) => Some(16.0 / 9.0),
    };
    let seen = match (&angle, &width, &intrinsics) {
        (Some(node), ..) => {
            let angle = node.number_in(0.1..=179.0, "a field of view is from 0.1 to 179 degrees");
            angle.zip(aspect).map(|(angle, aspect)| (Projection::with_field_of_view(angle, aspect), aspect))
        }
        (_, Some(node), _) => {
            let width_m = length(node);
            width_m.zip(aspect).map(|(width_m, aspect)| (Projection::Orthographic { width_m }, aspect))
        }
        (.., Some(node)) => calibrated(node),
        _ => None,
    };
    fields.done();
    let ((pose, aim), (projection, aspect)) = (posed?, seen?);
    Some((Camera { pose, projection, aspect }, aim))
}

/// `{ size_px = [w, h], focal_px = [fx, fy], centre_px = [cx, cy] }`.
fn calibrated(node: &Node) -> Option<(Projection, f64)> {
    let mut fields = node.table()?;
    let pixels = |n: &Node| n.number_in(1e-3..=1e6, "a number of pixels, from 0.001 to 1e6");
    let size =
        fields.need("size_px", "the picture's [width, height] in pixels", |n| n.items::<f64, 2>(pixels));
    let focal =
        fields.need("focal_px", "the focal lengths [fx, fy] in pixels", |n| n.items::<f64, 2>(pixels));
    let centre = fields.need(
        "centre_px",
        "where the axis meets the picture, [cx, cy] from the top left, in pixels",
        |n| n.items::<f64, 2>(|x| x.number_in(-1e6..=1e6, "a place in pixels, from −1e6 to 1e6")),
    );
    fields.done();
    let ([w, h], focal, centre) = (size?, focal?, centre?);
    if !(0.01..=100.0).contains(&(w / h)) {
        return node.refuse("width over height is from 0.01 to 100");
    }
    Some((Projection::Perspective { focal: focal.map(|f| f / w), centre: centre.map(|c| c / w) }, w / h))
}
