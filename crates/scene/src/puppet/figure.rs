//! A puppet ready to be posed: its parts' textures on one lattice, and the masks made of them.

use std::sync::Arc;

use super::compose::{Code, Placed, Plate, compose, multiply};
use super::grid::{Lattice, Rect, Rigid, Texture};
use super::manifest::Part;
use crate::theatre::{Mask, Texels};

/// How a puppet is posed: its parts about their pivots, then the whole about its centre. Degrees, counter-clockwise as the audience sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// Each part's turn against the part that it hangs on, in the order of [`Puppet::parts`](crate::Puppet::parts); 0 is as drawn.
    pub parts_deg: Vec<f64>,
    /// The whole puppet's turn in its plane.
    pub rotate_deg: f64,
}

/// Parts and their textures.
#[derive(Debug)]
pub(crate) struct Figure {
    lattice: Lattice,
    /// Pivots in lattice coordinates.
    parts: Vec<Joint>,
    textures: Vec<Texture>,
    /// The same without the drawing's edge, where a part that may turn reaches beyond it; [`Figure::free`] takes what is posed from here.
    whole: Vec<Option<Texture>>,
    channels: usize,
    bits: u32,
    /// Set by [`Figure::settle`]: which parts may move, and the product of those that don't.
    moving: Vec<bool>,
    plate: Option<Still>,
    /// Set by [`Figure::settle`]: the pose as written, which every drawing shares.
    rest: Option<Posed>,
}

/// The product of the parts that never move, as [`Plate`] wants it.
#[derive(Debug)]
struct Still {
    rect: Rect,
    light: Vec<f32>,
    codes: Texels,
}

impl Still {
    fn new<const L: usize>(rect: Rect, parts: &[Placed], bits: u32) -> Self {
        let mut light = vec![[1.0f32; L]; rect.area()];
        for part in parts {
            multiply(rect, part, &mut light);
        }
        let channels = if L == 1 { 1 } else { 3 };
        let planes = (0..channels).flat_map(|c| light.iter().map(move |texel| texel[c]));
        let codes = match bits {
            16 => Texels::U16(planes.map(u16::nearest).collect()),
            _ => Texels::U8(planes.map(u8::nearest).collect()),
        };
        Self { rect, light: light.into_flattened(), codes }
    }

    fn plate<C: Code, const L: usize>(&self) -> Plate<'_, C, L> {
        Plate { rect: self.rect, light: self.light.as_chunks().0, codes: C::slice(&self.codes) }
    }
}

#[derive(Clone, Debug)]
struct Joint {
    parent: Option<usize>,
    pivot: [f64; 2],
}

/// A figure in a pose: the texels that its mask covers, and the mask.
#[derive(Clone, Debug)]
pub(crate) struct Posed {
    pub pose: Pose,
    pub extent: Rect,
    pub mask: Arc<Mask>,
}

impl Figure {
    /// `parts` have their pivots in lattice coordinates; a part without one turns about the figure's centre. `textures` has one texture a part, in
    /// drawing order, and where a part reaches beyond the drawing the whole of it.
    pub(crate) fn new(
        lattice: Lattice,
        parts: &[Part],
        textures: Vec<(Texture, Option<Texture>)>,
        bits: u32,
    ) -> Self {
        let joints = parts
            .iter()
            .map(|part| Joint { parent: part.parent, pivot: part.pivot.unwrap_or(lattice.centre()) });
        let (mut textures, mut whole): (Vec<Texture>, Vec<Option<Texture>>) = textures.into_iter().unzip();
        let grey = textures.iter().chain(whole.iter().flatten()).all(|t| t.lanes == 1);
        let channels = if grey { 1 } else { 3 };
        if !grey {
            textures.iter_mut().chain(whole.iter_mut().flatten()).for_each(Texture::widen);
        }
        let moving = vec![true; textures.len()];
        Self {
            lattice,
            parts: joints.collect(),
            textures,
            whole,
            channels,
            bits,
            moving,
            plate: None,
            rest: None,
        }
    }

    /// Lets what the scene poses, and all that hangs on it, be drawn beyond the drawing's edge, at every angle; all else stays cut there.
    pub(crate) fn free(&mut self, posed: &[bool]) {
        let free = self.followers(posed);
        let parts = self.textures.iter_mut().zip(std::mem::take(&mut self.whole)).zip(free);
        for ((texture, whole), free) in parts {
            if let Some(whole) = whole.filter(|_| free) {
                *texture = whole;
            }
        }
    }

    fn forget(&mut self, part: usize) {
        // The bounds are still needed for the extent.
        self.textures[part].opacity = Vec::new();
    }

    /// 1 or 3.
    pub(crate) fn channels(&self) -> usize {
        self.channels
    }

    /// Which parts move when those of `posed` do: they and all that hangs on them.
    pub(crate) fn followers(&self, posed: &[bool]) -> Vec<bool> {
        (0..self.textures.len())
            .map(|part| self.chain(part).any(|p| posed.get(p).copied().unwrap_or(false)))
            .collect()
    }

    /// A part, its parent, its parent's parent …
    fn chain(&self, part: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(part), |&p| self.parts.get(p)?.parent)
    }

    /// Where a pose puts a part.
    fn motion(&self, part: usize, pose: &Pose) -> Rigid {
        let mut motion = Rigid::IDENTITY;
        for p in self.chain(part) {
            let degrees = pose.parts_deg.get(p).copied().unwrap_or(0.0);
            if let Some(joint) = self.parts.get(p) {
                motion = Rigid::turn(joint.pivot, degrees).after(&motion);
            }
        }
        Rigid::turn(self.lattice.centre(), pose.rotate_deg).after(&motion)
    }

    /// The grid of a pose: the rest grid and every moved part, or the parts alone when the whole figure is turned.
    pub(crate) fn extent(&self, pose: &Pose) -> Rect {
        let rest = Rect::of_size(self.lattice.columns, self.lattice.rows);
        let parts = (0..self.textures.len())
            .map(|part| self.motion(part, pose).bounds(self.textures[part].rect))
            .fold(Rect::EMPTY, Rect::union);
        let turned = Rigid::turn([0.0; 2], pose.rotate_deg) != Rigid::IDENTITY;
        if turned && !parts.is_empty() { parts } else { rest.union(parts) }
    }

    /// Centre of a pose's grid from the figure's centre, u right and v up, and its full size; in texels.
    pub(crate) fn placement(&self, extent: Rect) -> ([f64; 2], [f64; 2]) {
        let [cx, cy] = self.lattice.centre();
        let middle = |a: i64, b: i64| 0.5 * (a + b) as f64;
        let centre = [middle(extent.x0, extent.x1) - cx, cy - middle(extent.y0, extent.y1)];
        (centre, [extent.width() as f64, extent.height() as f64])
    }

    /// Fixes which parts may move from now on, multiplies the others, as `pose` has them, once and for all, and draws that pose.
    pub(crate) fn settle(&mut self, moving: Vec<bool>, pose: &Pose) -> Posed {
        if !moving.contains(&true) {
            // One mask is all there will be: draw it from the parts, and keep nothing else.
            let rest = self.posed(pose, None);
            (0..self.textures.len()).for_each(|part| self.forget(part));
            return self.rest.insert(rest).clone();
        }
        self.moving = moving;
        let still: Vec<usize> = (0..self.textures.len()).filter(|&p| !self.moving[p]).collect();
        let placed: Vec<Placed> = still
            .iter()
            .map(|&p| Placed { texture: &self.textures[p], motion: self.motion(p, pose) })
            .collect();
        let rect = placed.iter().map(|p| p.motion.bounds(p.texture.rect)).fold(Rect::EMPTY, Rect::union);
        self.plate = (!rect.is_empty()).then(|| match self.channels {
            1 => Still::new::<1>(rect, &placed, self.bits),
            _ => Still::new::<4>(rect, &placed, self.bits),
        });
        for p in still {
            // Multiplied into the plate.
            self.forget(p);
        }
        let rest = self.posed(pose, None);
        self.rest.insert(rest).clone()
    }

    /// The pose that it was settled in.
    pub(crate) fn rest(&self) -> Option<&Posed> {
        self.rest.as_ref()
    }

    /// Bytes of a mask that covers the texels of `extent`.
    pub(crate) fn bytes(&self, extent: Rect) -> usize {
        extent.area() * self.channels * (self.bits as usize / 8)
    }

    /// Draws a pose, into texels that nobody needs any more where there are some.
    pub(crate) fn posed(&self, pose: &Pose, spent: Option<Texels>) -> Posed {
        let extent = self.extent(pose);
        let texels = match (self.bits, spent) {
            (16, Some(Texels::U16(codes))) => Texels::U16(self.draw(extent, pose, codes)),
            (16, _) => Texels::U16(self.draw(extent, pose, Vec::new())),
            (_, Some(Texels::U8(codes))) => Texels::U8(self.draw(extent, pose, codes)),
            (..) => Texels::U8(self.draw(extent, pose, Vec::new())),
        };
        let mask = Arc::new(Mask::new(extent.width(), extent.height(), self.channels, texels));
        Posed { pose: pose.clone(), extent, mask }
    }

    /// The codes of a pose on the texels of `extent`, in a buffer that may be reused.
    fn draw<C: Code>(&self, extent: Rect, pose: &Pose, mut codes: Vec<C>) -> Vec<C> {
        let parts: Vec<Placed> = (0..self.textures.len())
            .filter(|&p| self.moving[p])
            .map(|p| Placed { texture: &self.textures[p], motion: self.motion(p, pose) })
            .collect();
        match self.channels {
            1 => compose::<C, 1>(extent, self.plate.as_ref().map(Still::plate), &parts, &mut codes),
            _ => compose::<C, 4>(extent, self.plate.as_ref().map(Still::plate), &parts, &mut codes),
        }
        codes
    }
}
