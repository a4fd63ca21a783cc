//! Numbers of a glTF file: accessors, in views of buffers.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::Beside;
use super::document::{Accessor, Buffer, Document};
use crate::Fault;
use crate::read::within;

/// The buffers of a file, and how to read them.
pub(super) struct Source<'a> {
    document: &'a Document,
    buffers: Vec<std::borrow::Cow<'a, [u8]>>,
}

/// The bytes of an accessor's elements, one after the other.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> {
        let Elements { bytes, stride, size, count } = *self;
        (0..count).map(move |k| &bytes[k * stride..][..size])
    }
}

impl<'a> Source<'a> {
    /// Every buffer: the file's own chunk, `data:` addresses and files beside it. Errors: one that is missing or too short.
    pub(super) fn open(
        document: &'a Document,
        chunk: Option<&'a [u8]>,
        beside: Beside,
    ) -> Result<Self, Fault> {
        let mut buffers = Vec::new();
        for (b, buffer) in document.buffers.iter().enumerate() {
            let at = format!("buffers[{b}]");
            let bytes = match (&buffer.uri, chunk) {
                (Some(uri), _) => file(uri, &format!("{at}.uri"), beside)?.into(),
                (None, Some(chunk)) if b == 0 => chunk.into(),
                (None, _) => return Err(Fault::new(format!("{at}.uri"), "is missing")),
            };
            let bytes: std::borrow::Cow<[u8]> = bytes;
            let Buffer { byte_length, .. } = *buffer;
            if (bytes.len() as u64) < byte_length {
                let rule = format!("the buffer has {} bytes", bytes.len());
                return Err(Fault::of(format!("{at}.byteLength"), byte_length, rule));
            }
            buffers.push(bytes);
        }
        Ok(Source { document, buffers })
    }

    fn accessor(&self, index: usize, place: &str) -> Result<&'a Accessor, Fault> {
        let accessors = &self.document.accessors;
        accessors
            .get(index)
            .ok_or_else(|| Fault::of(place, index, format!("is one of {} accessors", accessors.len())))
    }

    /// How many elements an accessor has.
    pub(super) fn count(&self, index: usize, place: &str) -> Result<usize, Fault> {
        let count = self.accessor(index, place)?.count;
        // Indices are three a triangle, keys of animations few: none are more than three times the limit.
        within(usize::try_from(count / 3).unwrap_or(usize::MAX), format!("accessors[{index}].count"))?;
        Ok(count as usize)
    }

    /// The elements of an accessor of this kind and one of these component types.
    fn elements(
        &self,
        index: usize,
        place: &str,
        kind: &str,
        components: usize,
        types: &[u32],
    ) -> Result<Elements<'_>, Fault> {
        let accessor = self.accessor(index, place)?;
        let at = |field: &str| format!("accessors[{index}].{field}");
        if accessor.kind != kind {
            return Err(Fault::of(at("type"), &accessor.kind, format!("{place} is {kind}")));
        }
        if !types.contains(&accessor.component_type) {
            let rule = format!("{place} is of one of the types {types:?}");
            return Err(Fault::of(at("componentType"), accessor.component_type, rule));
        }
        if accessor.sparse.is_some() {
            return Err(Fault::new(at("sparse"), "sparse accessors are not read"));
        }
        let Some(view_index) = accessor.buffer_view else {
            return Err(Fault::new(at("bufferView"), "is missing"));
        };
        let views = &self.document.buffer_views;
        let Some(view) = views.get(view_index) else {
            return Err(Fault::of(at("bufferView"), view_index, format!("is one of {} views", views.len())));
        };
        let Some(buffer) = self.buffers.get(view.buffer) else {
            let place = format!("bufferViews[{view_index}].buffer");
            return Err(Fault::of(place, view.buffer, format!("is one of {} buffers", self.buffers.len())));
        };
        let part = |bytes: &'_ [u8], from: u64, length: u64| {
            let end = from.checked_add(length)?;
            bytes.get(usize::try_from(from).ok()?..usize::try_from(end).ok()?).map(|_| (from, end))
        };
        let Some((from, end)) = part(buffer, view.byte_offset, view.byte_length) else {
            let value = format!("{} bytes from {}", view.byte_length, view.byte_offset);
            let rule = format!("the buffer has {} bytes", buffer.len());
            return Err(Fault::of(format!("bufferViews[{view_index}]"), value, rule));
        };
        let view_bytes = &buffer[from as usize..end as usize];
        let size = components * size_of(accessor.component_type);
        let stride = view.byte_stride.unwrap_or(size as u64);
        if stride < size as u64 || stride > 252 {
            let rule = format!("is from {size}, the size of an element, to 252");
            return Err(Fault::of(format!("bufferViews[{view_index}].byteStride"), stride, rule));
        }
        let count = self.count(index, place)?;
        let needed = (count as u64).saturating_sub(1) * stride + if count == 0 { 0 } else { size as u64 };
        let Some((from, _)) = part(view_bytes, accessor.byte_offset, needed) else {
            let value = format!("{count} elements from byte {}", accessor.byte_offset);
            let rule = format!("the view has {} bytes", view_bytes.len());
            return Err(Fault::of(format!("accessors[{index}]"), value, rule));
        };
        Ok(Elements { bytes: &view_bytes[from as usize..], stride: stride as usize, size, count })
    }

    /// Vectors of `N` numbers; whole ones stand for 0 to 1 (or −1 to 1), as `normalized` says.
    pub(super) fn floats<const N: usize>(&self, index: usize, place: &str) -> Result<Vec<[f32; N]>, Fault> {
        let kind = match N {
            1 => "SCALAR",
            2 => "VEC2",
            3 => "VEC3",
            4 => "VEC4",
            _ => "MAT4",
        };
        let accessor = self.accessor(index, place)?;
        let types: &[u32] = if accessor.normalized { &[5120, 5121, 5122, 5123] } else { &[5126] };
        let elements = self.elements(index, place, kind, N, types)?;
        let each = size_of(accessor.component_type);
        let value = |bytes: &[u8]| match (accessor.component_type, bytes) {
            (5126, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
            (5120, &[a]) => (f32::from(a as i8) / 127.0).max(-1.0),
            (5121, &[a]) => f32::from(a) / 255.0,
            (5122, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])) / 32767.0).max(-1.0),
            (_, &[a, b, ..]) => f32::from(u16::from_le_bytes([a, b])) / 65535.0,
            _ => 0.0,
        };
        let vector = |bytes: &[u8]| std::array::from_fn(|k| value(&bytes[k * each..][..each]));
        Ok(elements.iter().map(vector).collect())
    }

    /// Indices of vertices.
    pub(super) fn indices(&self, index: usize, place: &str) -> Result<Vec<u32>, Fault> {
        let elements = self.elements(index, place, "SCALAR", 1, &[5121, 5123, 5125])?;
        Ok(elements.iter().map(whole).collect())
    }

    /// Four joints a vertex.
    pub(super) fn joints(&self, index: usize, place: &str) -> Result<Vec<[u16; 4]>, Fault> {
        let elements = self.elements(index, place, "VEC4", 4, &[5121, 5123])?;
        let each = elements.size / 4;
        let four = |bytes: &[u8]| std::array::from_fn(|k| whole(&bytes[k * each..][..each]) as u16);
        Ok(elements.iter().map(four).collect())
    }
}

/// A number without a sign, of one, two or four bytes.
fn whole(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, byte| value << 8 | u32::from(*byte))
}

/// Bytes of a component.
fn size_of(component_type: u32) -> usize {
    match component_type {
        5120 | 5121 => 1,
        5122 | 5123 => 2,
        _ => 4,
    }
}

/// What an address names: bytes within it, or a file beside this one.
fn file(uri: &str, place: &str, beside: Beside) -> Result<Vec<u8>, Fault> {
    if let Some(data) = uri.strip_prefix("data:") {
        let Some((_, encoded)) = data.split_once(";base64,") else {
            return Err(Fault::of(place, uri, "data within the file is in base64"));
        };
        return STANDARD
            .decode(encoded)
            .map_err(|error| Fault::of(place, uri, format!("no base64: {error}")));
    }
    let name =
        decoded(uri).ok_or_else(|| Fault::of(place, uri, "a % is followed by two hexadecimal digits"))?;
    let leaves = name.split(['/', '\\']).any(|step| step == ".." || step.is_empty());
    if leaves || name.contains([':', '\0']) {
        return Err(Fault::of(place, uri, "a file beside this one, or in a folder beside it"));
    }
    beside(&name).map_err(|rule| Fault::of(place, uri, rule))
}

/// With `%20` and its like resolved.
fn decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first == b'%' {
            let digits = std::str::from_utf8(after.get(..2)?).ok()?;
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = &after[2..];
        } else {
            bytes.push(first);
        }
    }
    String::from_utf8(bytes).ok()
}
