//! What an MP4's boxes (ISO/IEC 14496-12) have to say and the library leaves out.

/// From the film to the description of its pictures.
const PICTURES: [&[u8; 4]; 7] = [b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsd", b"avc1"];

/// A box: where it begins and ends, its header of eight bytes included.
#[derive(Clone, Copy)]
struct Place {
    start: usize,
    end: usize,
}

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

fn set(bytes: &mut [u8], at: usize, number: u32) -> Option<()> {
    bytes.get_mut(at..at + 4)?.copy_from_slice(&number.to_be_bytes());
    Some(())
}

/// The first box of this name from `at` to `end`.
fn child(bytes: &[u8], mut at: usize, end: usize, name: &[u8; 4]) -> Option<Place> {
    while at + 8 <= end {
        let size = number(bytes, at)? as usize;
        if bytes.get(at + 4..at + 8)? == name {
            return Some(Place { start: at, end: at + size });
        }
        // A size below that of its header is none that the library writes.
        at += size.max(8);
    }
    None
}

/// The boxes along `path`, from the outermost inwards.
fn along(bytes: &[u8], path: &[&[u8; 4]]) -> Option<Vec<Place>> {
    let (mut at, mut end) = (0, bytes.len());
    let step = |name: &&[u8; 4]| {
        let place = child(bytes, at, end, name)?;
        // A description counts its entries before the first.
        at = place.start + if *name == b"stsd" { 16 } else { 8 };
        end = place.end;
        Some(place)
    };
    path.iter().map(step).collect()
}

/// Adds the box of colour information: primaries, transfer and matrix by their numbers, in limited range.
pub(super) fn say_colours(bytes: &mut Vec<u8>, colours: [u16; 3]) -> Option<()> {
    let mut colr = Vec::from(*b"\0\0\0\x13colrnclx");
    colr.extend(colours.iter().flat_map(|number| number.to_be_bytes()));
    colr.push(0);
    let places = along(bytes, &PICTURES)?;
    let grown = colr.len() as u32;
    let data = child(bytes, 0, bytes.len(), b"mdat")?;
    let offsets =
        *along(bytes, &[PICTURES[0], PICTURES[1], PICTURES[2], PICTURES[3], PICTURES[4], b"stco"])?.last()?;
    if data.start > offsets.start {
        for k in 0..number(bytes, offsets.start + 12)? as usize {
            let at = offsets.start + 16 + 4 * k;
            let offset = number(bytes, at)?;
            set(bytes, at, offset + grown)?;
        }
    }
    // Last, as sizes say where the boxes are.
    for place in &places {
        let size = number(bytes, place.start)?;
        set(bytes, place.start, size + grown)?;
    }
    let end = places.last()?.end;
    bytes.splice(end..end, colr);
    Some(())
}

/// Lets the only frame of a film last for so long.
pub(super) fn last(bytes: &mut [u8], seconds: f64) -> Option<()> {
    // After a header and flags: version 0 of each box, whose times are 32 bits.
    let at = |path: &[&[u8; 4]]| along(bytes, path)?.last().map(|place| place.start);
    let [film, track, media] =
        [&[b"moov", b"mvhd"][..], &[b"moov", b"trak", b"tkhd"], &[b"moov", b"trak", b"mdia", b"mdhd"]]
            .map(at);
    let times = at(&[b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stts"])?;
    let (film, track, media) = (film?, track?, media?);
    let [film_units, media_units] = [film, media].map(|at| number(bytes, at + 20));
    let of = |units: Option<u32>| Some((seconds * f64::from(units?)).round().max(1.0) as u32);
    let (film_time, media_time) = (of(film_units)?, of(media_units)?);
    set(bytes, film + 24, film_time)?;
    set(bytes, track + 28, film_time)?;
    set(bytes, media + 24, media_time)?;
    set(bytes, times + 20, media_time)
}
