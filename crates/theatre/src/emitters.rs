//! What shines, and how much of each is seen.

use kelir_frame::{Visibility, VisibilityModel};
use kelir_scene::Theatre;

/// Names of a theatre's emitters.
pub(crate) fn emitters(theatre: &Theatre) -> impl Iterator<Item = &str> {
    theatre.lamp.emitters.iter().map(|emitter| emitter.name.as_str())
}

/// The visibility of each emitter in `names`, and in each channel where a puppet is coloured; `values` takes the emitter's and the
/// channel's index.
pub(crate) fn each_visibility<'a>(
    theatre: &Theatre,
    names: impl IntoIterator<Item = &'a str>,
    model: VisibilityModel,
    mut values: impl FnMut(usize, usize) -> Vec<f32>,
) -> Vec<Visibility> {
    let coloured = theatre.planes.iter().any(|plane| plane.mask.channels == 3);
    let mut all = Vec::new();
    for (e, name) in names.into_iter().enumerate() {
        for c in 0..if coloured { 3 } else { 1 } {
            let channel = coloured.then_some(c);
            all.push(Visibility { emitter: name.to_owned(), model, channel, values: values(e, c) });
        }
    }
    all
}
