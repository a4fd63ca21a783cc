//! Wavefront OBJ.

use std::collections::HashMap;

use super::{polygon, within};
use crate::mesh::vector;
use crate::{Fault, Mesh};

/// Statements of curves and surfaces that are not of triangles; what they say can't be passed over.
const FREE_FORM: [&str; 4] = ["cstype", "curv", "curv2", "surf"];

/// A face's corner: vertex, texture coordinates, normal, from 0. `None` for a vertex out of range.
type Corner = (Option<u32>, Option<u32>, Option<u32>);

#[derive(Default)]
struct Obj {
    positions: Vec<[f32; 3]>,
    texture: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[Corner; 3]>,
    without_texture: bool,
    without_normals: bool,
}

/// The faces of all objects and groups as one mesh.
pub(super) fn read(bytes: &[u8]) -> Result<Mesh, Fault> {
    let mut obj = Obj::default();
    let mut joined = Vec::new();
    for (number, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
        let line = line.trim_ascii();
        // A line that ends in a backslash goes on in the next one.
        if let Some(begun) = line.strip_suffix(b"\\") {
            joined.extend_from_slice(begun);
            joined.push(b' ');
            continue;
        }
        if joined.is_empty() {
            obj.line(number + 1, line)?;
        } else {
            joined.extend_from_slice(line);
            obj.line(number + 1, &std::mem::take(&mut joined))?;
        }
    }
    obj.line(bytes.split(|byte| *byte == b'\n').count(), &joined)?;
    obj.mesh()
}

impl Obj {
    fn line(&mut self, number: usize, line: &[u8]) -> Result<(), Fault> {
        let line = line.split(|byte| *byte == b'#').next().unwrap_or_default();
        let at = || format!("line {number}");
        let mut words =
            line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).map(String::from_utf8_lossy);
        match words.next().as_deref() {
            Some("v") => self.positions.push(numbers(&at, &mut words, 3)?),
            Some("vn") => self.normals.push(numbers(&at, &mut words, 3)?),
            Some("vt") => {
                let [u, v] = numbers(&at, &mut words, 1)?;
                // OBJ counts v from the picture's bottom.
                self.texture.push([u, 1.0 - v]);
            }
            Some("f") => self.face(&at, words)?,
            Some(word) if FREE_FORM.contains(&word) => {
                return Err(Fault::of(
                    at(),
                    word,
                    "free-form curves and surfaces are not read, only faces (f)",
                ));
            }
            _ => return Ok(()),
        }
        within(self.positions.len().max(self.normals.len()).max(self.texture.len()), at())?;
        within(self.triangles.len(), at())?;
        Ok(())
    }

    fn face<'a>(
        &mut self,
        at: &dyn Fn() -> String,
        words: impl Iterator<Item = std::borrow::Cow<'a, str>>,
    ) -> Result<(), Fault> {
        let corners = words.map(|word| self.corner(at, &word)).collect::<Result<Vec<Corner>, Fault>>()?;
        if corners.len() < 3 {
            return Err(Fault::of(at(), format!("{} corners", corners.len()), "a face has at least three"));
        }
        self.without_texture |= corners.iter().any(|corner| corner.1.is_none());
        self.without_normals |= corners.iter().any(|corner| corner.2.is_none());
        let place = |corner: &Corner| corner.0.map(|vertex| vector(self.positions[vertex as usize]));
        let places: Option<Vec<_>> = corners.iter().map(place).collect();
        let cut = match places {
            Some(places) => polygon::triangles(&places),
            None => Some((2..corners.len()).map(|k| [0, k - 1, k]).collect()),
        };
        let Some(cut) = cut else {
            return Err(Fault::of(
                at(),
                format!("{} corners", corners.len()),
                "a face that is not convex has at most 256",
            ));
        };
        self.triangles.extend(cut.iter().map(|triangle| triangle.map(|k| corners[k])));
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`; from 1, or from the last backwards by −1, −2, …
    fn corner(&self, at: &dyn Fn() -> String, word: &str) -> Result<Corner, Fault> {
        let rule = "a corner is v, v/vt, v//vn or v/vt/vn, whole numbers";
        let mut fields = word.split('/');
        let mut index = |count: usize| match fields.next() {
            None | Some("") => Ok(None),
            Some(field) => {
                let index: i64 = field.parse().map_err(|_| Fault::of(at(), word, rule))?;
                let from_zero = if index < 0 { index + count as i64 } else { index - 1 };
                Ok(Some(usize::try_from(from_zero).ok().filter(|index| *index < count)))
            }
        };
        let vertex = index(self.positions.len())?;
        let texture = index(self.texture.len())?;
        let normal = index(self.normals.len())?;
        let Some(vertex) = vertex.filter(|_| fields.next().is_none()) else {
            return Err(Fault::of(at(), word, rule));
        };
        let known = |index: Option<Option<usize>>, what: &str, count: usize| match index {
            Some(None) => Err(Fault::of(at(), word, format!("names one of the {count} {what} given so far"))),
            other => Ok(other.flatten().map(|index| index as u32)),
        };
        Ok((
            vertex.map(|index| index as u32),
            known(texture, "texture coordinates", self.texture.len())?,
            known(normal, "normals", self.normals.len())?,
        ))
    }

    fn mesh(self) -> Result<Mesh, Fault> {
        if self.triangles.is_empty() {
            return Err(Fault::new("", "has no faces (lines that begin with f)"));
        }
        let mut mesh = Mesh::default();
        if self.without_texture && self.without_normals {
            let index = |corner: Corner| corner.0.unwrap_or(u32::MAX);
            mesh.triangles = self.triangles.iter().map(|triangle| triangle.map(index)).collect();
            mesh.positions = self.positions;
            return Ok(mesh);
        }
        // One vertex for each combination that faces use.
        let (mut normals, mut texture) = (Vec::new(), Vec::new());
        let mut known: HashMap<Corner, u32> = HashMap::new();
        for triangle in &self.triangles {
            let triangle = triangle.map(|(vertex, uv, normal)| {
                let Some(v) = vertex else { return u32::MAX };
                let uv = uv.filter(|_| !self.without_texture);
                let normal = normal.filter(|_| !self.without_normals);
                *known.entry((vertex, uv, normal)).or_insert_with(|| {
                    mesh.positions.push(self.positions[v as usize]);
                    texture.extend(uv.map(|at| self.texture[at as usize]));
                    normals.extend(normal.map(|at| unit(self.normals[at as usize])));
                    mesh.positions.len() as u32 - 1
                })
            });
            mesh.triangles.push(triangle);
        }
        mesh.normals = (!self.without_normals).then_some(normals);
        mesh.texture = (!self.without_texture).then_some(texture);
        within(mesh.positions.len(), "")?;
        Ok(mesh)
    }
}

/// Normals of files are seldom quite of length 1.
pub(super) fn unit(normal: [f32; 3]) -> [f32; 3] {
    vector(normal).normalize_or_zero().as_vec3().to_array()
}

/// `N` numbers, of which all after the first `needed` may be left out.
fn numbers<'a, const N: usize>(
    at: &dyn Fn() -> String,
    words: &mut impl Iterator<Item = std::borrow::Cow<'a, str>>,
    needed: usize,
) -> Result<[f32; N], Fault> {
    let mut values = [0.0; N];
    for (k, value) in values.iter_mut().enumerate() {
        match words.next() {
            Some(word) => {
                *value = word.parse().map_err(|_| Fault::of(at(), word, "must be a number"))?;
            }
            None if k < needed => {
                return Err(Fault::of(
                    at(),
                    format!("{k} numbers"),
                    format!("has {needed} numbers at least"),
                ));
            }
            None => break,
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    fn fault(text: &str) -> String {
        read(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn faces_of_any_form_are_read() {
        let text = "# a square, a triangle\r\no thing\nv 0 0 0 1\nv 1e0 0 0 0.5 0.5 0.5\nv 1 1 \\\n 0\nv 0 1 0\n\
                    usemtl red\ns off\nf -4 -3 -2 -1 # all\nl 1 2\nv 0 0 1\nf 1 2 5";
        let mesh = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.positions.len(), 5);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 4]]);
        assert_eq!((mesh.normals, mesh.texture), (None, None));
    }

    #[test]
    fn a_corner_is_a_vertex_for_each_combination() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.25\nvn 0 0 2\n\
                    f 1/1/1 2/2/1 3/1/1\nf 1/2/1 3/1/1 2/2/1\n";
        let mesh = read(text.as_bytes()).unwrap();
        // Vertex 1 with two texture coordinates is two vertices; 3/1/1 and 2/2/1 are shared.
        assert_eq!(mesh.triangles, [[0, 1, 2], [3, 2, 1]]);
        assert_eq!(mesh.positions[3], mesh.positions[0]);
        assert_eq!(mesh.texture.unwrap(), [[0.0, 1.0], [1.0, 0.75], [0.0, 1.0], [1.0, 0.75]]);
        assert_eq!(mesh.normals.unwrap(), [[0.0, 0.0, 1.0]; 4]);
        // Normals on some faces alone are none.
        let some = format!("{text}f 1/1 2/2 3/1\n");
        let mesh = read(some.as_bytes()).unwrap();
        assert!(mesh.normals.is_none() && mesh.texture.is_some());
    }

    #[test]
    fn what_is_wrong_is_named_by_line_value_and_rule() {
        let v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        assert_eq!(fault("v 0 0\n"), "line 1 = 2 numbers: has 3 numbers at least");
        assert_eq!(fault("\nv 0 x 0\n"), "line 2 = x: must be a number");
        assert_eq!(fault(&format!("{v}f 1 2\n")), "line 4 = 2 corners: a face has at least three");
        let corner = "a corner is v, v/vt, v//vn or v/vt/vn, whole numbers";
        for word in ["a", "1.5", "/1", "", "1/1/1/1"].iter().filter(|word| !word.is_empty()) {
            let found = fault(&format!("{v}vt 0 0\nvn 0 0 1\nf 1 2 {word}\n"));
            assert_eq!(found, format!("line 6 = {word}: {corner}"));
        }
        assert_eq!(
            fault(&format!("{v}f 1/1 2 3\n")),
            "line 4 = 1/1: names one of the 0 texture coordinates given so far"
        );
        assert_eq!(
            fault("surf 0 1 0 1\n"),
            "line 1 = surf: free-form curves and surfaces are not read, only faces (f)"
        );
        assert_eq!(fault("hello, world\n"), "has no faces (lines that begin with f)");
    }

    #[test]
    fn a_vertex_out_of_range_is_left_to_the_check() {
        let mesh = read(b"v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\nf 1 2 9\nf 0 1 2\nf -9 1 2").unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, u32::MAX], [u32::MAX, 0, 1], [u32::MAX, 0, 1]]);
    }
}
