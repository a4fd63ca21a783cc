#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use openh264::decoder::Decoder;
use openh264::formats::YUVSource;

use super::mp4::even;
use super::*;

const SIZE: [usize; 2] = [64, 35];

/// A bright bar that moves over a gradient; frames 2 and 3 are equal.
fn pictures() -> Vec<Vec<u32>> {
    let picture = |bar: usize| {
        (0..SIZE[0] * SIZE[1])
            .map(|at| {
                let (x, y) = (at % SIZE[0], at / SIZE[0]);
                let level = if (bar..bar + 8).contains(&x) { 230 } else { 40 + 2 * y as u32 };
                0xff00_0000 | (level * 3 / 4) << 16 | level << 8 | level
            })
            .collect()
    };
    [4, 12, 20, 20, 40].into_iter().map(picture).collect()
}

fn film(format: Format, pictures: &[Vec<u32>], fps: f64) -> Vec<u8> {
    let mut film = Film::new(format, Run { size: SIZE, fps, frames: pictures.len(), repeat: true }).unwrap();
    for picture in pictures {
        film.frame(picture).unwrap();
    }
    film.finish().unwrap()
}

#[test]
fn an_apng_gives_every_frame_back_exactly() {
    let shown = pictures();
    let bytes = film(Format::Apng, &shown, 30.0);
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let control = *reader.info().animation_control().unwrap();
    assert_eq!((control.num_frames, control.num_plays), (5, 0));
    let mut canvas = vec![0u32; SIZE[0] * SIZE[1]];
    let mut written = Vec::new();
    for expected in &shown {
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut buffer).unwrap();
        let frame = *reader.info().frame_control().unwrap();
        assert_eq!((frame.delay_num, frame.delay_den), (100, 3000));
        for (k, rgb) in buffer.chunks_exact(3).take((frame.width * frame.height) as usize).enumerate() {
            let (x, y) = (k % frame.width as usize, k / frame.width as usize);
            let at = (y + frame.y_offset as usize) * SIZE[0] + x + frame.x_offset as usize;
            canvas[at] = 0xff00_0000 | u32::from(rgb[2]) << 16 | u32::from(rgb[1]) << 8 | u32::from(rgb[0]);
        }
        assert_eq!(&canvas, expected);
        written.push(frame.width * frame.height);
    }
    assert_eq!(written[3], 1, "an equal frame costs one pixel");
    assert!(written[1] < written[0], "a moved bar costs its surroundings only");
}

/// The payloads of the boxes of this name, wherever they are.
fn boxes(bytes: &[u8], name: &[u8; 4]) -> Vec<(usize, Vec<u8>)> {
    let found = bytes.windows(4).enumerate().filter(|(_, window)| window == name).map(|(at, _)| at);
    found
        .map(|at| {
            let size = u32::from_be_bytes(bytes[at - 4..at].try_into().unwrap()) as usize;
            (at, bytes[at + 4..at - 4 + size].to_vec())
        })
        .collect()
}

fn number(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap())
}

/// Peak signal-to-noise ratio of the luma of each frame of `coded`, decoded, against [`pictures`], dB.
fn quality(coded: &[Vec<u32>]) -> Vec<f64> {
    let mut mp4 = Mp4::new(Run { size: SIZE, fps: 30.0, frames: coded.len(), repeat: false }).unwrap();
    let mut decoder = Decoder::new().unwrap();
    let shown = pictures();
    let wide = even(SIZE[0]);
    (coded.iter().zip(&shown))
        .map(|(picture, expected)| {
            mp4.frame(picture).unwrap();
            let decoded = decoder.decode(&mp4.last).unwrap().unwrap();
            let (stride, _, _) = decoded.strides();
            let square: f64 = (0..SIZE[1] * SIZE[0])
                .map(|at| {
                    let [r, g, b] = rgb(&expected[at]).map(f64::from);
                    // BT.601, limited range.
                    let luma = 16.0 + (65.481 * r + 128.553 * g + 24.966 * b) / 255.0;
                    let got = decoded.y()[at / SIZE[0] * stride + at % SIZE[0]];
                    (f64::from(got) - luma).powi(2)
                })
                .sum();
            assert_eq!(decoded.dimensions(), (wide, even(SIZE[1])));
            10.0 * (255.0f64.powi(2) * (SIZE[0] * SIZE[1]) as f64 / square).log10()
        })
        .collect()
}

#[test]
fn an_mp4_holds_every_frame_at_its_time() {
    let bytes = film(Format::Mp4, &pictures(), 30.0);
    let (movie, _) = boxes(&bytes, b"moov")[0];
    let (data, _) = boxes(&bytes, b"mdat")[0];
    assert!(movie < data, "a player can begin before the file has come");
    let sizes = &boxes(&bytes, b"stsz")[0].1;
    assert_eq!(number(sizes, 8), 5, "no frame is dropped, equal ones neither");
    let media = &boxes(&bytes, b"mdhd")[0].1;
    let (timescale, duration) = (number(media, 12), number(media, 16));
    assert!((f64::from(duration) / f64::from(timescale) - 5.0 / 30.0).abs() < 1e-3, "{duration}/{timescale}");
}

/// The boxes that say how a film's colours are to be shown stand with its description, and moved no picture.
#[test]
fn an_mp4_says_its_colours() {
    let bytes = film(Format::Mp4, &pictures(), 30.0);
    let (description, inside) = boxes(&bytes, b"avc1")[0].clone();
    let (at, colours) = boxes(&bytes, b"colr")[0].clone();
    assert_eq!(colours, *b"nclx\0\x01\0\x0d\0\x06\0");
    assert!(description < at && at < description + inside.len(), "within the description");
    // Every box ends where its parent does or its neighbour begins, so the sizes add up to the file.
    let tops = [b"ftyp", b"moov", b"mdat"].map(|name| boxes(&bytes, name)[0].1.len() + 8);
    assert_eq!(tops.iter().sum::<usize>(), bytes.len());
    let (data, _) = boxes(&bytes, b"mdat")[0];
    assert_eq!(
        number(&boxes(&bytes, b"stco")[0].1, 8) as usize,
        data + 4,
        "the pictures begin where they did"
    );
}

/// One frame is shown as long as one of several.
#[test]
fn a_film_of_one_frame_lasts_as_long_as_it() {
    for fps in [0.5, 25.0] {
        let bytes = film(Format::Mp4, &pictures()[..1], fps);
        let of = |name: &[u8; 4], units: usize, time: usize| {
            let payload = boxes(&bytes, name)[0].1.clone();
            f64::from(number(&payload, time)) / f64::from(number(&payload, units))
        };
        for lasts in [of(b"mvhd", 12, 16), of(b"mdhd", 12, 16)] {
            assert!((lasts * fps - 1.0).abs() < 1e-3, "{lasts} s at {fps} Hz");
        }
        let [movie, track] =
            [(b"mvhd", 16), (b"tkhd", 20)].map(|(name, at)| number(&boxes(&bytes, name)[0].1, at));
        assert_eq!(movie, track);
        let times = boxes(&bytes, b"stts")[0].1.clone();
        assert_eq!([4, 8, 12].map(|at| number(&times, at)), [1, 1, (90_000.0 / fps) as u32]);
    }
}

#[test]
fn an_mp4_looks_like_its_frames() {
    let good = quality(&pictures());
    assert!(good.iter().all(|decibel| *decibel > 40.0), "{good:?}");
    // The same film one frame late is another film.
    let mut late = pictures();
    late.rotate_right(1);
    assert!(quality(&late)[1] < 25.0);
}

#[test]
fn what_a_film_cannot_be_is_said() {
    let refused = |format, size, fps, frames| {
        Film::new(format, Run { size, fps, frames, repeat: true })
            .err()
            .map(|error| error.to_string())
            .unwrap()
    };
    assert!(refused(Format::Apng, SIZE, 0.0, 2).contains("fps = 0"));
    assert!(refused(Format::Apng, SIZE, f64::NAN, 2).contains("fps"));
    assert!(refused(Format::Mp4, [8, 8], 30.0, 2).contains("16x16"));
    for size in [[3842, 2160], [3840, 2162], [2400, 2400]] {
        assert!(refused(Format::Mp4, size, 30.0, 2).contains("at most 3840x2160"), "{size:?}");
    }
    assert!(refused(Format::Mp4, SIZE, 30.0, 0).contains("frames"));
    let short = Film::new(Format::Apng, Run { size: SIZE, fps: 30.0, frames: 2, repeat: true }).unwrap();
    assert!(short.finish().is_err(), "a film with frames missing is no film");
}

#[path = "no_mp4.rs"]
#[allow(dead_code, reason = "only the refusal is tried")]
mod absent;

/// A kelir without its encoder says what has one, and what it writes itself.
#[test]
fn a_build_without_an_encoder_says_so() {
    let run = Run { size: [64, 64], fps: 25.0, frames: 1, repeat: false };
    let message = absent::Mp4::new(run).err().unwrap().to_string();
    assert!(message.contains("cargo xtask release") && message.contains(".apng"), "{message}");
}
