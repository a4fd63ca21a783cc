//! Stimuli that need no renderer: small drawings told apart by scene and condition.

use kelir_house::{Library, Made, Maker, Task};
use kelir_study::Kind;
use serde_json::json;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Draws discs; counts how often it drew.
#[derive(Debug, Default)]
pub(crate) struct Placeholder {
    /// Stimuli drawn so far.
    pub drawn: AtomicUsize,
    /// Whether it draws otherwise than before.
    pub disguised: AtomicBool,
}

impl Maker for Placeholder {
    fn identity(&self, task: &Task<'_>, _: &Library) -> Result<String, String> {
        Ok(format!("placeholder {:?} {:?} {:?} {:?}", task.size, task.pair, task.name, task.condition))
    }

    fn make(
        &self,
        task: &Task<'_>,
        _: &Library,
        progress: &mut (dyn FnMut(f64, &str) + Send),
    ) -> Result<Made, String> {
        self.drawn.fetch_add(1, Ordering::SeqCst);
        let seed = task.pair.id.bytes().fold(7u32, |h, b| h.wrapping_mul(31).wrapping_add(u32::from(b)));
        let rough = (task.name != task.block.target) != self.disguised.load(Ordering::SeqCst);
        let provenance = json!({ "source": "placeholder", "condition": task.name });
        let png = "image/png".to_owned();
        match task.block.kind {
            Kind::Still => {
                let bytes = disc(task.size, seed, 0.0, rough);
                Ok(Made { media_type: png, bytes, attachments: Vec::new(), provenance })
            }
            Kind::Animation => {
                let mut frames = Vec::new();
                for i in 0..12 {
                    progress(f64::from(i) / 12.0, "drawing frames");
                    let phase = std::f64::consts::TAU * f64::from(i) / 12.0;
                    frames.push((png.clone(), disc(task.size, seed, phase.sin(), rough)));
                }
                let names: Vec<String> =
                    frames.iter().map(|(_, bytes)| kelir_store::sha256_hex(bytes)).collect();
                let [width, height] = task.size;
                let manifest =
                    json!({ "fps": 12, "loop": true, "width": width, "height": height, "frames": names });
                Ok(Made {
                    media_type: "application/vnd.kelir.animation+json".to_owned(),
                    bytes: manifest.to_string().into_bytes(),
                    attachments: frames,
                    provenance,
                })
            }
        }
    }
}

/// A grey PNG with a soft dark disc.
pub(crate) fn disc([width, height]: [u32; 2], seed: u32, sway: f64, rough: bool) -> Vec<u8> {
    let (w, h) = (f64::from(width), f64::from(height));
    let (cx, cy) = (w * (0.3 + 0.4 * f64::from(seed % 97) / 97.0 + 0.1 * sway), h * 0.5);
    let mut raw = Vec::with_capacity((width as usize + 1) * height as usize);
    for y in 0..height {
        raw.push(0);
        for x in 0..width {
            let r = (f64::from(x) - cx).hypot(f64::from(y) - cy) / h;
            let noise = if rough {
                f64::from(x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503 + seed)) % 23.0
            } else {
                0.0
            };
            raw.push((40.0 + 180.0 * ((r - 0.2) * 6.0).clamp(0.0, 1.0) + noise) as u8);
        }
    }
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    let header = [&width.to_be_bytes()[..], &height.to_be_bytes()[..], &[8, 0, 0, 0, 0]].concat();
    for (kind, data) in [(b"IHDR", header), (b"IDAT", stored(&raw)), (b"IEND", Vec::new())] {
        png.extend((data.len() as u32).to_be_bytes());
        let body = [&kind[..], &data].concat();
        png.extend(&body);
        png.extend(crc32(&body).to_be_bytes());
    }
    png
}

/// zlib without compression.
fn stored(raw: &[u8]) -> Vec<u8> {
    let mut out = vec![0x78, 0x01];
    let mut chunks = raw.chunks(65_535).peekable();
    while let Some(chunk) = chunks.next() {
        out.push(u8::from(chunks.peek().is_none()));
        out.extend((chunk.len() as u16).to_le_bytes());
        out.extend((!(chunk.len() as u16)).to_le_bytes());
        out.extend(chunk);
    }
    let (a, b) = raw.iter().fold((1u32, 0u32), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % 65_521;
        (a, (b + a) % 65_521)
    });
    out.extend(((b << 16) | a).to_be_bytes());
    out
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, byte| {
        (0..8)
            .fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (!(crc & 1)).wrapping_add(1)))
    })
}
