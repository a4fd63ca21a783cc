//! How much a participant downloads: of each block before anything is made (its stills all, its films an estimate from some of their frames), and of
//! a version as it is stored.

use crate::library::{Library, beside};
use crate::making::{Task, tasks};
use crate::presenting::TAIL;
use crate::render;
use kelir_scene::Scene;
use kelir_store::{PackedSize, Store, StoreError, packed_bytes, step_bytes};
use kelir_study::{Condition, Kind, StudyDefinition};
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::ToSchema;

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
}

/// What each block of a study weighs at each of its sizes, in the order of the file. What is drawn is drawn at the smallest size alone: at a larger
/// one it is taken to weigh as much more as it has more pixels.
///
/// # Errors
/// Why something cannot be drawn or packed.
pub(crate) fn weights(library: &Library, file: &str, study: &StudyDefinition) -> Result<Vec<Weight>, String> {
    let mut weights = Vec::new();
    for block in &study.blocks {
        let of_block =
            |size: &[u32; 2]| Weight { block: block.id.clone(), size: *size, bytes: 0, is_exact: true };
        weights.extend(study.sizes().iter().map(of_block));
    }
    // Both stimuli of a trial are as long as the longer one.
    let mut longest = BTreeMap::<(&str, usize), (&str, u64)>::new();
    let mut scenes = BTreeMap::new();
    for task in tasks(study).into_iter().filter(|task| task.rank == 0) {
        let weighed = match task.condition {
            Condition::Files { .. } => of_files(library, file, &task)?,
            Condition::Rendered { .. } => of_drawn(library, file, &task, &mut scenes)?,
        };
        for (rank, (bytes, is_exact)) in weighed.into_iter().enumerate() {
            let known = longest.entry((&task.pair.id, rank)).or_insert((&task.block.id, 0));
            known.1 = known.1.max(bytes);
            let size = study.sizes().get(rank);
            let own = weights.iter_mut().find(|w| w.block == task.block.id && Some(&w.size) == size);
            own.into_iter().for_each(|weight| weight.is_exact &= is_exact);
        }
    }
    for ((_, rank), (block, bytes)) in longest {
        let size = study.sizes().get(rank);
        let own = weights.iter_mut().find(|weight| weight.block == block && Some(&weight.size) == size);
        own.into_iter().for_each(|weight| weight.bytes += 2 * (bytes + TAIL as u64));
    }
    Ok(weights)
}

/// The bytes of a stimulus at each size, and whether they were counted.
type Weighed = Vec<(u64, bool)>;

fn of_files(library: &Library, file: &str, task: &Task<'_>) -> Result<Weighed, String> {
    let Condition::Files { files } = task.condition else { return Ok(Vec::new()) };
    let paths = files.get(&task.pair.id).map(|pictures| pictures.paths()).unwrap_or_default();
    let of = |path: &String| {
        let bytes = library.read(&beside(file, path)).map_err(|error| format!("{path}: {error}"))?;
        Ok((packed_bytes(&bytes)?, true))
    };
    paths.iter().map(of).collect()
}

/// `scenes` are those that have been read: reading one takes longer than drawing it.
fn of_drawn(
    library: &Library,
    file: &str,
    task: &Task<'_>,
    scenes: &mut BTreeMap<String, Scene>,
) -> Result<Weighed, String> {
    let path = beside(file, task.pair.scene.as_deref().ok_or("has no scene")?);
    let scene = match scenes.remove(&path) {
        Some(scene) => scene,
        None => library.scene(&path).map_err(render::lines)?,
    };
    let (scene, drawn) = render::sample(task, scene);
    scenes.insert(path, scene);
    let (frames, pictures) = drawn?;
    let first = pictures.first().ok_or("nothing was drawn")?;
    let steps: Vec<u64> =
        pictures.chunks_exact(2).map(|pair| step_bytes(&pair[0], &pair[1])).collect::<Result<_, _>>()?;
    let step = steps.iter().sum::<u64>() / steps.len().max(1) as u64;
    let smallest = packed_bytes(first)? + step * (frames as u64).saturating_sub(1);
    let pixels = |[w, h]: [u32; 2]| f64::from(w) * f64::from(h);
    let of_size = |size: &[u32; 2]| {
        let bytes = smallest as f64 * pixels(*size) / pixels(task.size).max(1.0);
        (bytes.round() as u64, *size == task.size && task.block.kind == Kind::Still)
    };
    Ok(task.study.sizes().iter().map(of_size).collect())
}
