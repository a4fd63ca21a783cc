//! How much a participant downloads: of each block before anything is made (its stills all, its films an estimate from some of their frames), and of
//! a version as it is stored.

use crate::library::{Library, beside};
use crate::render;
use crate::task::{Task, tasks};
use kelir_scene::AnyScene;
use kelir_store::{PackedSize, Store, StoreError, packed_bytes, step_bytes};
use kelir_study::{Condition, Kind, StudyDefinition};
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// Bytes that are a session's own at the end of each stimulus that it gets.
pub const TAIL: usize = 32;
/// A slow line, bits a second.
pub const SLOW_BITS_PER_S: u64 = 1_600_000;
/// Above so many bytes a study is heavy at a size: half a minute on a slow line. It is one bound for all sizes, as a larger screen has no faster line.
pub const HEAVY_BYTES: u64 = SLOW_BITS_PER_S / 8 * 30;

/// What a participant downloads of a version at one of its sizes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct Download {
    /// [width, height] in pixels.
    pub size: [u32; 2],
    /// Bytes of all that may be shown.
    pub bytes: u64,
    /// Whether that takes more than half a minute on a slow line (1.6 Mbit/s).
    pub is_heavy: bool,
}

/// What a participant downloads of a version at each of its sizes, as its stimuli are stored; nothing where some are not packed.
pub(crate) async fn downloads(
    store: &Store,
    study: &str,
    version: &str,
) -> Result<Vec<Download>, StoreError> {
    let download = |PackedSize { size, stimuli, bytes }: PackedSize| {
        let bytes = bytes + stimuli * TAIL as u64;
        Download { size, bytes, is_heavy: bytes > HEAVY_BYTES }
    };
    Ok(store.packed_sizes(study, version).await?.into_iter().map(download).collect())
}

/// What a participant downloads of a block whose stimuli are shown at one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Weight {
    /// Block's id.
    pub block: String,
    /// [width, height] in pixels.
    pub size: [u32; 2],
    /// Bytes.
    pub bytes: u64,
    /// Whether they were counted, and not estimated from a part.
    pub is_exact: bool,
    /// Bytes after which a pair of its films begins while the rest comes at 9 Mbit/s, where it has any; of its heaviest pair.
    pub begins_after_bytes: Option<u64>,
}

/// Of a line of 9 Mbit/s, bytes a second that a page counts on, and how long before its time it wants a picture, s (`web/participant/forecast.ts`).
const SURE_BYTES_PER_S: f64 = 0.85 * 9e6 / 8.0;
const SPARE_S: f64 = 0.1;

/// A stimulus at one size.
#[derive(Clone, Copy)]
struct Weighed {
    bytes: u64,
    is_exact: bool,
    film: Option<Film>,
}

#[derive(Clone, Copy)]
struct Film {
    /// Of its first picture.
    bytes: u64,
    /// When its last frame is due, s.
    last_s: f64,
}

impl Weighed {
    /// Bytes of two such.
    fn pair(self) -> u64 {
        2 * (self.bytes + TAIL as u64)
    }

    /// Bytes of two such, if they are films, after which they begin: with their first pictures, and when the rest comes in time.
    fn begins_after(self) -> Option<u64> {
        let Film { bytes, last_s } = self.film?;
        let comes = SURE_BYTES_PER_S * (last_s - SPARE_S).max(0.0);
        Some((2 * bytes).max(self.pair().saturating_sub(comes.round() as u64)))
    }
}

impl Library {
    /// What a participant downloads of each block of a study that is good, at each of its sizes, in the order of the file. What is drawn is drawn at the
    /// smallest size alone: at a larger one it is taken to weigh as much more as it has more pixels.
    ///
    /// # Errors
    /// Why something cannot be drawn or packed.
    pub fn weights(&self, path: &str, study: &StudyDefinition) -> Result<Vec<Weight>, String> {
        weights(self, path, study)
    }
}

fn weights(library: &Library, file: &str, study: &StudyDefinition) -> Result<Vec<Weight>, String> {
    let mut weights = Vec::new();
    for block in &study.blocks {
        let of_block = |size: &[u32; 2]| {
            let (block, size) = (block.id.clone(), *size);
            Weight { block, size, bytes: 0, is_exact: true, begins_after_bytes: None }
        };
        weights.extend(study.sizes().iter().map(of_block));
    }
    // Both stimuli of a trial are as long as the longer one.
    let mut longest = BTreeMap::<(&str, usize), (&str, Weighed)>::new();
    let mut scenes = BTreeMap::new();
    for task in tasks(study).into_iter().filter(|task| task.rank == 0) {
        let weighed = match task.condition {
            Condition::Files { .. } => of_files(library, file, &task)?,
            Condition::Rendered { .. } => of_drawn(library, file, &task, &mut scenes)?,
        };
        for (rank, weighed) in weighed.into_iter().enumerate() {
            let known = longest.entry((&task.pair.id, rank)).or_insert((&task.block.id, weighed));
            if weighed.bytes > known.1.bytes {
                known.1 = weighed;
            }
            let size = study.sizes().get(rank);
            let own = weights.iter_mut().find(|w| w.block == task.block.id && Some(&w.size) == size);
            own.into_iter().for_each(|weight| weight.is_exact &= weighed.is_exact);
        }
    }
    for ((_, rank), (block, weighed)) in longest {
        let size = study.sizes().get(rank);
        let own = weights.iter_mut().find(|weight| weight.block == block && Some(&weight.size) == size);
        if let Some(weight) = own {
            weight.bytes += weighed.pair();
            weight.begins_after_bytes = weight.begins_after_bytes.max(weighed.begins_after());
        }
    }
    Ok(weights)
}

fn of_files(library: &Library, file: &str, task: &Task<'_>) -> Result<Vec<Weighed>, String> {
    let Condition::Files { files } = task.condition else { return Ok(Vec::new()) };
    let paths = files.get(&task.pair.id).map(|pictures| pictures.paths()).unwrap_or_default();
    let of = |path: &String| {
        let bytes = library.read(&beside(file, path)).map_err(|error| format!("{path}: {error}"))?;
        Ok(Weighed { bytes: packed_bytes(&bytes)?, is_exact: true, film: None })
    };
    paths.iter().map(of).collect()
}

/// `scenes` are those that have been read: reading one takes longer than drawing it.
fn of_drawn(
    library: &Library,
    file: &str,
    task: &Task<'_>,
    scenes: &mut BTreeMap<String, AnyScene>,
) -> Result<Vec<Weighed>, String> {
    let path = beside(file, task.pair.scene.as_deref().ok_or("has no scene")?);
    let scene = match scenes.remove(&path) {
        Some(scene) => scene,
        None => library.scene(&path).map_err(render::lines)?,
    };
    let (scene, drawn) = render::sample(task, scene);
    let last_s = scene.timeline().map(|timeline| timeline.frame_time_s(timeline.frame_count() - 1));
    scenes.insert(path, scene);
    let (frames, pictures) = drawn?;
    let first = pictures.first().ok_or("nothing was drawn")?;
    let steps: Vec<u64> =
        pictures.chunks_exact(2).map(|pair| step_bytes(&pair[0], &pair[1])).collect::<Result<_, _>>()?;
    let step = steps.iter().sum::<u64>() / steps.len().max(1) as u64;
    let first = packed_bytes(first)?;
    let steps = (frames as u64).saturating_sub(1);
    let pixels = |[w, h]: [u32; 2]| f64::from(w) * f64::from(h);
    let of_size = |size: &[u32; 2]| {
        let at_size = |bytes: u64| (bytes as f64 * pixels(*size) / pixels(task.size).max(1.0)).round() as u64;
        let film = last_s.filter(|_| task.block.kind == Kind::Animation);
        Weighed {
            bytes: at_size(first + step * steps),
            is_exact: *size == task.size && task.block.kind == Kind::Still,
            film: film.map(|last_s| Film { bytes: at_size(first), last_s }),
        }
    };
    Ok(task.study.sizes().iter().map(of_size).collect())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn films_begin_after_as_much_as_pages_wait_for() {
        // Of 2 × (2,058,233 − 32) bytes so much comes in 59/30 − 0.1 s at 0.85 × 1,125,000 bytes a second: 1,785,000.
        let film =
            |bytes, last_s| Weighed { bytes, is_exact: false, film: Some(Film { bytes: 155_390, last_s }) };
        let built_in = film(2_058_233 - TAIL as u64, 59.0 / 30.0);
        assert_eq!(built_in.pair(), 4_116_466);
        assert_eq!(built_in.begins_after(), Some(4_116_466 - 1_785_000));
        assert_eq!(film(2_058_201, 60.0).begins_after(), Some(310_780), "not before its first pictures");
        assert_eq!(film(2_058_201, 0.05).begins_after(), Some(4_116_466));
        assert_eq!(Weighed { film: None, ..built_in }.begins_after(), None);
    }

    #[test]
    fn pages_count_on_the_same() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../web/participant/forecast.ts");
        let page = std::fs::read_to_string(path).unwrap();
        assert!(page.contains("const SURE = 0.85;") && (SURE_BYTES_PER_S - 0.85 * 1_125_000.0).abs() < 1e-6);
        assert!(page.contains("const SPARE_MS = 100;") && (SPARE_S - 0.1).abs() < 1e-9);
    }
}
