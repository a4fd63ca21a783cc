//! Values that change with time: tracks of keys, eased between.

use kelir_reader::Node;

use crate::limits;

/// How an animation runs.
#[derive(Clone, Debug)]
pub struct Timeline {
    /// Frames a second, > 0.
    pub fps: f64,
    /// Length in seconds, > 0.
    pub seconds: f64,
    /// Whether it starts again at its end; then the instant `seconds` is the instant 0.
    pub repeat: bool,
    pub(crate) tracks: Vec<Track>,
}

impl Timeline {
    /// Frames from 0 to just before `seconds`; at least one.
    pub fn frame_count(&self) -> usize {
        ((self.fps * self.seconds).round() as usize).max(1)
    }

    /// When frame `frame` is shown: `frame / fps`.
    pub fn frame_time_s(&self, frame: usize) -> f64 {
        frame as f64 / self.fps
    }

    /// The instant within [0, `seconds`] that `time_s` shows: wrapped when repeating, else held at the ends.
    pub fn instant_s(&self, time_s: f64) -> f64 {
        let time_s = if time_s.is_finite() { time_s } else { 0.0 };
        if self.repeat { time_s.rem_euclid(self.seconds) } else { time_s.clamp(0.0, self.seconds) }
    }
}

/// What a track drives.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Target {
    LampPosition,
    Position(usize),
    Tilt(usize),
    Rotate(usize),
    /// Puppet, part.
    Pose(usize, usize),
    /// Of a stage.
    Stage(crate::stage::Moved),
}

/// How values go from one key to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Easing {
    /// Evenly.
    Linear,
    /// (1 − cos πu) / 2: at rest at every key.
    Smooth,
    /// Held until the next key.
    Step,
}

/// The keys of one value.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    pub target: Target,
    pub easing: Easing,
    /// (seconds, value), in the order of time; 1, 2 or 3 numbers a value.
    pub keys: Vec<(f64, Vec<f64>)>,
}

impl Track {
    /// The value at an instant: the first key's before it, the last key's after it.
    pub(crate) fn value(&self, instant_s: f64) -> Vec<f64> {
        let next = self.keys.partition_point(|(t, _)| *t <= instant_s);
        let Some((t0, from)) = self.keys.get(next.wrapping_sub(1)) else { return self.keys[0].1.clone() };
        let Some((t1, to)) = self.keys.get(next) else { return from.clone() };
        let u = (instant_s - t0) / (t1 - t0);
        let weight = match self.easing {
            Easing::Linear => u,
            Easing::Smooth => 0.5 - 0.5 * (std::f64::consts::PI * u).cos(),
            Easing::Step => 0.0,
        };
        from.iter().zip(to).map(|(a, b)| a + weight * (b - a)).collect()
    }
}

/// Reads one value of a track by its target's rule.
pub(crate) type ReadValue<'r> = dyn Fn(&Node) -> Option<Vec<f64>> + 'r;
/// What a track's target names, and how its values are read.
pub(crate) type Driven<'r> = (Target, Box<ReadValue<'r>>);

/// Reads `[timeline]`; `target` finds what a track's target names and how its values are read, or refuses it.
pub(crate) fn read<'r>(node: &Node, target: &dyn Fn(&Node) -> Option<Driven<'r>>) -> Option<Timeline> {
    let mut fields = node.table()?;
    let fps_rule = "frames a second are above 0 and at most 1000";
    let fps = fields.need("fps", fps_rule, |n| {
        n.number_in((std::ops::Bound::Excluded(0.0), std::ops::Bound::Included(limits::FPS)), fps_rule)
    });
    let seconds_rule = "the length is above 0 s and at most 86400 s";
    let seconds = fields.need("seconds", seconds_rule, |n| {
        n.number_in((std::ops::Bound::Excluded(0.0), std::ops::Bound::Included(86400.0)), seconds_rule)
    });
    let repeat =
        fields
            .optional("loop", "whether it starts again at its end; without it false", false, |n| n.boolean());
    let tracks = fields.optional("tracks", "what moves, one table each; without any nothing does", Vec::new(), |n| {
        let tracks: Vec<_> = n.array(limits::TRACKS)?.iter().map(|t| track(t, seconds, target)).collect();
        let items = n.array(limits::TRACKS)?;
        for (i, track) in tracks.iter().enumerate() {
            let same =
                |other: &Option<Track>| matches!((other, track), (Some(a), Some(b)) if a.target == b.target);
            if let Some(first) = tracks[..i].iter().position(same) {
                items[i]
                    .refuse::<()>(format!("drives what {}[{first}] drives; a value has one track", n.path()));
                return None;
            }
        }
        tracks.into_iter().collect()
    });
    if let (Some(fps), Some(seconds)) = (fps, seconds)
        && fps * seconds > limits::FRAMES as f64
    {
        node.refuse::<()>(format!(
            "fps × seconds is {:.0} frames; at most {}",
            fps * seconds,
            limits::FRAMES
        ));
    }
    fields.done();
    Some(Timeline { fps: fps?, seconds: seconds?, repeat: repeat?, tracks: tracks? })
}

fn track<'r>(
    node: &Node,
    seconds: Option<f64>,
    target: &dyn Fn(&Node) -> Option<Driven<'r>>,
) -> Option<Track> {
    let mut fields = node.table()?;
    let target = fields.need("target", "what the track drives, such as \"puppets[0].rotate_deg\"", target);
    let easing = fields.optional(
        "easing",
        "how values go from key to key: evenly, at rest at each key, or in steps; without it linear",
        Easing::Linear,
        |n| n.choice(&[("linear", Easing::Linear), ("smooth", Easing::Smooth), ("step", Easing::Step)]),
    );
    let keys = fields.need("keys", "at least one { t = seconds, value = … }", |n| {
        let items = n.array(limits::KEYS)?;
        if items.is_empty() {
            return n.refuse("a track has at least one key");
        }
        let keys: Vec<_> = items.iter().map(|k| key(k, seconds, target.as_ref().map(|t| &*t.1))).collect();
        let keys: Vec<(f64, Vec<f64>)> = keys.into_iter().collect::<Option<_>>()?;
        for i in 1..keys.len() {
            if keys[i].0 <= keys[i - 1].0 {
                return items[i]
                    .refuse(format!("keys come in the order of time, and {} s is before it", keys[i - 1].0));
            }
        }
        Some(keys)
    });
    fields.done();
    Some(Track { target: target?.0, easing: easing?, keys: keys? })
}

fn key(node: &Node, seconds: Option<f64>, read: Option<&ReadValue>) -> Option<(f64, Vec<f64>)> {
    let mut fields = node.table()?;
    let most = seconds.unwrap_or(f64::MAX);
    let t = fields.need("t", "the key's time in seconds", |n| {
        n.number_in(0.0..=most, &format!("a key's time is from 0 s to the timeline's end ({most} s)"))
    });
    let value = fields.need("value", "the value at that time", |n| match read {
        Some(read) => read(n),
        None => Some(Vec::new()), // the target was refused already
    });
    fields.done();
    Some((t?, value?))
}
