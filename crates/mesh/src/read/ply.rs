//! PLY, in text or binary of either order.

use super::obj::unit;
use super::{polygon, within};
use crate::mesh::vector;
use crate::{Fault, Mesh};

/// Bytes of a header: a longer one is none.
const MOST_HEADER: usize = 1 << 16;

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Text,
    Little,
    Big,
}

#[derive(Clone, Copy)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn of(name: &str) -> Option<Scalar> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The value of bytes in little-endian order, as many as [`Scalar::size`].
    fn value(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Scalar::I8 => f64::from(a as i8),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(bytes),
        }
    }
}

struct Property {
    name: String,
    /// The type of a list's length.
    length: Option<Scalar>,
    scalar: Scalar,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

impl Element {
    fn property(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|property| names.contains(&property.name.as_str()))
    }
}

/// `vertex` with x, y, z, and, where they are there, nx, ny, nz, and u, v or s, t; `face` with `vertex_indices`. Other elements and
/// properties are passed over.
pub(super) fn read(bytes: &[u8]) -> Result<Mesh, Fault> {
    let (encoding, elements, data) = header(bytes)?;
    let mut values = Values { encoding, data, at: 0 };
    let (mut mesh, mut met) = (Mesh::default(), (false, false));
    for element in &elements {
        // In binary and in text alike a scalar takes a byte at least; an element without properties would take none.
        let least: usize = element
            .properties
            .iter()
            .map(|property| property.length.unwrap_or(property.scalar))
            .map(|scalar| if encoding == Encoding::Text { 2 } else { scalar.size() })
            .sum();
        let left = values.data.len() - values.at;
        if element.count.checked_mul(least).is_none_or(|needed| needed > left + 1) {
            return Err(Fault::of(
                format!("element {}", element.name),
                element.count,
                format!("the file has {left} bytes left for as many"),
            ));
        }
        match element.name.as_str() {
            "vertex" | "face" if elements.iter().filter(|other| other.name == element.name).count() > 1 => {
                return Err(Fault::new(format!("element {}", element.name), "is there once"));
            }
            "vertex" => {
                vertices(element, &mut values, &mut mesh)?;
                met.0 = true;
            }
            "face" => {
                faces(element, &mut values, &mut mesh, met.0)?;
                met.1 = true;
            }
            name => {
                let rows = if least == 0 { 0 } else { element.count };
                for row in 0..rows {
                    let at = || format!("{name} {row}");
                    element.properties.iter().try_for_each(|property| values.skip(property, &at))?;
                }
            }
        }
    }
    if !met.0 || !met.1 {
        let strips = elements.iter().any(|element| element.name == "tristrips");
        let rule = if strips {
            "strips of triangles (tristrips) are not read, only faces"
        } else {
            "has an element vertex and an element face"
        };
        return Err(Fault::new("header", rule));
    }
    Ok(mesh)
}

fn header(bytes: &[u8]) -> Result<(Encoding, Vec<Element>, &[u8]), Fault> {
    let (mut encoding, mut elements, mut at) = (None, Vec::<Element>::new(), 0);
    for number in 1.. {
        let at_line = || format!("line {number}");
        let window = &bytes[at..bytes.len().min(MOST_HEADER)];
        let Some(end) = window.iter().position(|byte| *byte == b'\n') else {
            return Err(Fault::new(at_line(), "a header ends with a line end_header"));
        };
        let line = String::from_utf8_lossy(window[..end].trim_ascii()).into_owned();
        at += end + 1;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match (number, &words[..]) {
            (1, ["ply"]) => {}
            (1, _) => return Err(Fault::of("line 1", line, "a PLY file begins with a line ply")),
            (_, [] | ["comment" | "obj_info", ..]) => {}
            (_, ["format", name, "1.0"]) => {
                encoding = Some(match *name {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => return Err(Fault::of(at_line(), name, "an unknown format")),
                });
            }
            (_, ["element", name, count]) => {
                let count =
                    count.parse().map_err(|_| Fault::of(at_line(), count, "must be a whole number"))?;
                within(count, at_line())?;
                elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new() });
            }
            (_, ["property", rest @ ..]) => {
                let known = |name: &str| {
                    Scalar::of(name).ok_or_else(|| Fault::of(at_line(), name, "an unknown type of number"))
                };
                let (name, length, scalar) = match rest {
                    ["list", length, scalar, name] => (name, Some(known(length)?), known(scalar)?),
                    [scalar, name] => (name, None, known(scalar)?),
                    _ => {
                        return Err(Fault::of(
                            at_line(),
                            line,
                            "a property is TYPE NAME or list TYPE TYPE NAME",
                        ));
                    }
                };
                let Some(element) = elements.last_mut() else {
                    return Err(Fault::of(at_line(), line, "a property stands behind its element"));
                };
                element.properties.push(Property { name: (*name).to_owned(), length, scalar });
            }
            (_, ["end_header"]) => break,
            _ => return Err(Fault::of(at_line(), line, "no line of a PLY 1.0 header")),
        }
    }
    let encoding = encoding.ok_or_else(|| Fault::new("header", "has a line format"))?;
    Ok((encoding, elements, &bytes[at..]))
}

/// The numbers behind the header, one after the other.
struct Values<'a> {
    encoding: Encoding,
    data: &'a [u8],
    at: usize,
}

impl Values<'_> {
    fn next(&mut self, scalar: Scalar, at: &dyn Fn() -> String) -> Result<f64, Fault> {
        let rest = &self.data[self.at..];
        if self.encoding == Encoding::Text {
            let blank = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let length = rest[blank..].iter().take_while(|byte| !byte.is_ascii_whitespace()).count();
            let word = String::from_utf8_lossy(&rest[blank..blank + length]);
            if word.is_empty() {
                return Err(Fault::new(at(), "the file ends before it"));
            }
            self.at += blank + length;
            return word.parse().map_err(|_| Fault::of(at(), word, "must be a number"));
        }
        let Some(bytes) = rest.get(..scalar.size()) else {
            return Err(Fault::new(at(), "the file ends before it"));
        };
        let mut little = [0; 8];
        little[..bytes.len()].copy_from_slice(bytes);
        if self.encoding == Encoding::Big {
            little[..bytes.len()].reverse();
        }
        self.at += bytes.len();
        Ok(scalar.value(little))
    }

    /// A list's length, no longer than the file.
    fn length(&mut self, length: Scalar, at: &dyn Fn() -> String) -> Result<usize, Fault> {
        let value = self.next(length, at)?;
        let left = self.data.len() - self.at;
        if value.fract() != 0.0 || value < 0.0 || value > left as f64 {
            return Err(Fault::of(at(), value, format!("a list is no longer than the {left} bytes left")));
        }
        Ok(value as usize)
    }

    fn skip(&mut self, property: &Property, at: &dyn Fn() -> String) -> Result<(), Fault> {
        let count = property.length.map_or(Ok(1), |length| self.length(length, at))?;
        (0..count).try_for_each(|_| self.next(property.scalar, at).map(drop))
    }
}

fn vertices(element: &Element, values: &mut Values, mesh: &mut Mesh) -> Result<(), Fault> {
    let all =
        |names: &[&[&str]]| names.iter().map(|names| element.property(names)).collect::<Option<Vec<_>>>();
    let Some(places) = all(&[&["x"], &["y"], &["z"]]) else {
        return Err(Fault::new("element vertex", "has properties x, y and z"));
    };
    let normals = all(&[&["nx"], &["ny"], &["nz"]]);
    let texture = all(&[&["u", "s", "texture_u"], &["v", "t", "texture_v"]]);
    mesh.positions.reserve_exact(element.count);
    mesh.normals = normals.is_some().then(|| Vec::with_capacity(element.count));
    mesh.texture = texture.is_some().then(|| Vec::with_capacity(element.count));
    let mut row = vec![0.0; element.properties.len()];
    for vertex in 0..element.count {
        let at = || format!("vertex {vertex}");
        for (value, property) in row.iter_mut().zip(&element.properties) {
            match property.length {
                None => *value = values.next(property.scalar, &at)?,
                Some(_) => values.skip(property, &at)?,
            }
        }
        let three = |places: &[usize]| [row[places[0]], row[places[1]], row[places[2]]].map(|x| x as f32);
        mesh.positions.push(three(&places));
        for (all, places) in mesh.normals.iter_mut().zip(&normals) {
            all.push(unit(three(places)));
        }
        for (all, places) in mesh.texture.iter_mut().zip(&texture) {
            // Programs that write PLY count it from the picture's bottom, as OBJ does.
            all.push([row[places[0]] as f32, 1.0 - row[places[1]] as f32]);
        }
    }
    Ok(())
}

fn faces(element: &Element, values: &mut Values, mesh: &mut Mesh, vertices: bool) -> Result<(), Fault> {
    if !vertices {
        return Err(Fault::new("element face", "stands behind the element vertex"));
    }
    let Some(corners) = element.property(&["vertex_indices", "vertex_index"]) else {
        return Err(Fault::new("element face", "has a list vertex_indices"));
    };
    let mut face = Vec::new();
    for number in 0..element.count {
        let at = || format!("face {number}");
        for (k, property) in element.properties.iter().enumerate() {
            match property.length {
                Some(length) if k == corners => {
                    let count = values.length(length, &at)?;
                    face.clear();
                    for _ in 0..count {
                        let index = values.next(property.scalar, &at)?;
                        let is_index = index.fract() == 0.0 && index >= 0.0 && index < f64::from(u32::MAX);
                        face.push(if is_index { index as u32 } else { u32::MAX });
                    }
                }
                None if k == corners => return Err(Fault::new("element face", "vertex_indices is a list")),
                _ => values.skip(property, &at)?,
            }
        }
        if face.len() < 3 {
            return Err(Fault::of(at(), format!("{} corners", face.len()), "a face has at least three"));
        }
        let place = |index: &u32| mesh.positions.get(*index as usize).map(|position| vector(*position));
        let places: Option<Vec<_>> = face.iter().map(place).collect();
        let cut = match places {
            Some(places) => polygon::triangles(&places),
            None => Some((2..face.len()).map(|k| [0, k - 1, k]).collect()),
        };
        let Some(cut) = cut else {
            let corners = format!("{} corners", face.len());
            return Err(Fault::of(at(), corners, "a face that is not convex has at most 256"));
        };
        mesh.triangles.extend(cut.iter().map(|triangle| triangle.map(|k| face[k])));
        within(mesh.triangles.len(), at())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    const HEADER: &str = "comment made by hand\nelement vertex 4\nproperty float x\nproperty double y\nproperty short z\n\
        property uchar red\nelement face 2\nproperty list uchar int vertex_indices\nproperty float quality\n\
        element edge 1\nproperty int vertex1\nend_header\n";

    fn text() -> Vec<u8> {
        let rows = "0 0 0 9\n1.5 0 0 9\n1.5 2 0 9\n0 2 -3 9\n4 0 1 2 3 0.5\n3 0 2 1 0.25\n7\n";
        format!("ply\nformat ascii 1.0\n{HEADER}{rows}").into_bytes()
    }

    /// The same in binary: each number's bytes reversed for big-endian.
    fn binary(big: bool) -> Vec<u8> {
        let name = if big { "big" } else { "little" };
        let mut bytes = format!("ply\r\nformat binary_{name}_endian 1.0\r\n{HEADER}").into_bytes();
        let mut put = |mut number: Vec<u8>| {
            if big {
                number.reverse();
            }
            bytes.extend(number);
        };
        for (x, y, z) in [(0f32, 0f64, 0i16), (1.5, 0.0, 0), (1.5, 2.0, 0), (0.0, 2.0, -3)] {
            put(x.to_le_bytes().to_vec());
            put(y.to_le_bytes().to_vec());
            put(z.to_le_bytes().to_vec());
            put(vec![9]);
        }
        for (face, quality) in [(&[0i32, 1, 2, 3][..], 0.5f32), (&[0, 2, 1], 0.25)] {
            put(vec![face.len() as u8]);
            face.iter().for_each(|index| put(index.to_le_bytes().to_vec()));
            put(quality.to_le_bytes().to_vec());
        }
        put(7i32.to_le_bytes().to_vec());
        bytes
    }

    #[test]
    fn text_and_both_orders_say_the_same() {
        let mesh = read(&text()).unwrap();
        assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [1.5, 2.0, 0.0], [0.0, 2.0, -3.0]]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 1]]);
        assert_eq!((&mesh.normals, &mesh.texture), (&None, &None));
        assert_eq!(read(&binary(false)).unwrap(), mesh);
        assert_eq!(read(&binary(true)).unwrap(), mesh);
    }

    #[test]
    fn normals_and_texture_coordinates_are_read() {
        let header = "element vertex 3\nproperty float nz\nproperty float x\nproperty float y\nproperty float z\n\
            property float nx\nproperty float ny\nproperty float s\nproperty float t\nelement face 1\n\
            property list uchar uint vertex_index\nend_header\n";
        let rows = "2 0 0 0 0 0 .5 .25\n2 1 0 0 0 0 1 0\n2 0 1 0 0 0 0 1\n3 0 1 2";
        let mesh = read(format!("ply\nformat ascii 1.0\n{header}{rows}").as_bytes()).unwrap();
        assert_eq!(mesh.normals.unwrap(), [[0.0, 0.0, 1.0]; 3]);
        assert_eq!(mesh.texture.unwrap(), [[0.5, 0.75], [1.0, 1.0], [0.0, 0.0]]);
    }

    #[test]
    fn what_is_wrong_is_named_by_place_value_and_rule() {
        let swapped = |from: &str, to: &str| {
            let text = String::from_utf8(text()).unwrap();
            assert!(text.contains(from), "{from}");
            read(text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
        };
        assert_eq!(swapped("ply", "plx"), "line 1 = plx: a PLY file begins with a line ply");
        assert_eq!(swapped("ascii", "morse"), "line 2 = morse: an unknown format");
        assert_eq!(swapped("double", "quad"), "line 6 = quad: an unknown type of number");
        assert_eq!(swapped("end_header", "endheader"), "line 14 = endheader: no line of a PLY 1.0 header");
        assert_eq!(swapped("vertex 4", "vertex -4"), "line 4 = -4: must be a whole number");
        assert_eq!(
            swapped("vertex 4", "vertex 1000000"),
            "element vertex = 1000000: the file has 66 bytes left for as many"
        );
        assert!(swapped("vertex 4", "vertex 99999999999").contains("at most 16777216 vertices"));
        assert_eq!(swapped("float x", "float a"), "element vertex: has properties x, y and z");
        assert_eq!(swapped("1.5 2 0", "1.5 two 0"), "vertex 2 = two: must be a number");
        assert_eq!(swapped("3 0 2 1", "2 0 2"), "face 1 = 2 corners: a face has at least three");
        assert_eq!(
            swapped("3 0 2 1", "3e9 0 2 1"),
            "face 1 = 3000000000: a list is no longer than the 14 bytes left"
        );
        assert_eq!(swapped("7\n", ""), "edge 0: the file ends before it");
        let strips =
            "ply\nformat ascii 1.0\nelement tristrips 0\nproperty list int int vertex_indices\nend_header\n";
        assert!(read(strips.as_bytes()).unwrap_err().to_string().contains("tristrips"));
        for cut in 0..binary(true).len() {
            assert!(read(&binary(true)[..cut]).is_err(), "{cut} bytes");
        }
    }
}
