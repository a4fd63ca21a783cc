//! The door draws what is no theatre: a card that an edge shades, with a renderer of its own.

use kelir_scene::Timeline;

use super::*;
use crate::albedo::PixelAlbedo;
use crate::subject::{Staged, Subject};
use crate::{Frame, Renderer, Stats, encode::code_exact};

const LIGHT: f64 = 2.0;
const ALBEDO: f32 = 0.5;
/// Width of the penumbra, as a share of the card's.
const SOFT: f64 = 0.2;
/// The standard error that the truth claims in penumbra.
const ERROR: f32 = 0.01;

/// Dark left of an edge, lit right of it.
#[derive(Clone, PartialEq)]
struct Card {
    edge: f64,
}

impl Card {
    fn visibility(&self, view: &View) -> Vec<f64> {
        let [w, h] = view.size;
        let at = |i: usize| (((i as f64 + 0.5) / w as f64 - self.edge) / SOFT + 0.5).clamp(0.0, 1.0);
        (0..w * h).map(|k| at(k % w)).collect()
    }
}

impl Subject for Card {
    fn sides(&self) -> [f64; 2] {
        [2.0, 1.0]
    }

    fn white(_: &[Self], _: &View) -> f64 {
        LIGHT
    }

    fn bytes(&self, view: &View) -> u64 {
        64 * (view.size[0] * view.size[1]) as u64
    }

    fn same_staging(&self, other: &Self) -> bool {
        self == other
    }

    fn penumbra(&self, view: &View) -> Vec<bool> {
        self.visibility(view).into_iter().map(|v| v > 0.0 && v < 1.0).collect()
    }

    fn albedo(&self, _: &View) -> PixelAlbedo {
        PixelAlbedo::Uniform([ALBEDO; 3])
    }

    fn brightest(&self, _: &View) -> f64 {
        LIGHT * std::f64::consts::PI / f64::from(ALBEDO)
    }
}

/// Cards whose edge moves for 0.2 s.
struct Deck {
    name: &'static str,
    timeline: Option<Timeline>,
}

impl Staged for Deck {
    type Subject = Card;
    type Kept = ();

    fn sha256(&self) -> &str {
        self.name
    }

    fn label(&self) -> &str {
        self.name
    }

    fn timeline(&self) -> Option<&Timeline> {
        self.timeline.as_ref()
    }

    fn still(&self) -> Card {
        Card { edge: 0.25 }
    }

    fn at(&self, time_s: f64, (): &mut ()) -> Card {
        Card { edge: 0.25 + time_s.min(0.2) }
    }

    fn lit(&self, _: Option<f64>) -> Card {
        self.still()
    }

    fn renderer(technique: &Technique, _: Backend) -> Result<Box<dyn Renderer<Card>>, RenderError> {
        technique.check()?;
        Ok(Box::new(Painter {
            truth: technique.is_truth(),
            faulty: *technique == faulty(technique.is_truth()),
        }))
    }
}

/// What the painter draws with one value that is no number: in the truth a standard error, in anything else a radiance.
fn faulty(truth: bool) -> Technique {
    let seed = [("seed".to_owned(), 13.into())];
    let (name, knobs) = if truth { ("mc", seed.into()) } else { ("points", BTreeMap::new()) };
    Technique::parse(name, &knobs).unwrap()
}

/// Draws cards: the truth exactly and with an error bar, anything else one per cent too dark.
struct Painter {
    truth: bool,
    faulty: bool,
}

impl Renderer<Card> for Painter {
    fn frame(&mut self, card: &Card, view: &View, _: bool) -> Result<Frame, RenderError> {
        let scale = if self.truth { LIGHT } else { 0.99 * LIGHT };
        let radiance: Vec<f32> = card.visibility(view).iter().map(|v| (scale * v) as f32).collect();
        let errors = || card.penumbra(view).iter().map(|soft| if *soft { ERROR } else { 0.0 }).collect();
        let mut frame = Frame {
            size: view.size,
            radiance: [radiance.clone(), radiance.clone(), radiance],
            visibilities: Vec::new(),
            standard_error: self.truth.then(|| [errors(), errors(), errors()]),
            stats: Stats::default(),
        };
        if self.faulty {
            let at = 2 * view.size[0] + 5;
            match &mut frame.standard_error {
                Some(errors) => errors[1][at] = f32::INFINITY,
                None => frame.radiance[1][at] = f32::NAN,
            }
        }
        Ok(frame)
    }

    fn adapter(&self) -> String {
        "painter".into()
    }
}

fn cards(technique: Technique, output: Output) -> Job<Deck> {
    let moving = job(SLIDE, technique, output);
    let deck = Deck { name: "a deck", timeline: moving.scene.timeline().cloned() };
    let view = View { size: [64, 32], ..moving.view };
    Job { view, ..moving.with_scene(deck) }
}

#[test]
fn a_card_is_drawn_through_the_door() {
    let mut still = cards(pa(), Output::Still);
    still.time_s = Some(0.1);
    let drawn = run(&mut still, &mut |_| ()).unwrap();
    let image = image::load_from_memory(&drawn.bytes).unwrap().to_rgb8();
    assert_eq!(image.dimensions(), (64, 32));
    for (i, v) in (Card { edge: 0.35 }).visibility(&still.view).iter().enumerate().take(64) {
        assert_eq!(image.get_pixel(i as u32, 31).0, [code_exact((0.99 * v) as f32); 3], "column {i}");
    }
    assert_eq!((&*drawn.provenance.adapter, drawn.provenance.white), ("painter", LIGHT));

    let film = run(&mut cards(pa(), Output::Animation), &mut |_| ()).unwrap();
    assert_eq!((film.attachments.len(), film.provenance.counts["frames_repeated"]), (3, 3));

    // It has its own ratio, and the rehearsal hands the deck back.
    let mut square = cards(pa(), Output::Still);
    square.view.size = [64, 64];
    let (deck, refused) = rehearse(square);
    assert_eq!(deck.name, "a deck");
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("as 2 by 1"), "{refused}");
    assert!(rehearse(cards(pa(), Output::Animation)).1.is_ok());
}

#[test]
fn a_card_has_a_key() {
    let key = |job: &Job<Deck>| job.key().unwrap();
    let one = cards(pa(), Output::Still);
    assert_eq!(key(&one), key(&cards(pa(), Output::Still)));
    assert_eq!(key(&one), hex::encode(Sha256::digest(one.preimage_for("a deck").unwrap())));
    let mut other = cards(pa(), Output::Still);
    other.scene.name = "another deck";
    assert_ne!(key(&one), key(&other));
    assert_ne!(key(&one), key(&cards(Technique::truth(), Output::Still)));
}

#[test]
fn a_card_is_measured() {
    let mut measured = cards(pa(), Output::Animation);
    measured.reference = Some(Technique::truth());
    let error = run(&mut measured, &mut |_| ()).unwrap().provenance.error.unwrap();
    assert_eq!(error.frames, [0, 3]);
    // One per cent of a penumbra that is lit by half, on the mean.
    assert!((error.penumbra.bias + 0.005).abs() < 2e-4, "{:?}", error.penumbra);
    assert!((error.all.max - 0.01).abs() < 1e-6, "{:?}", error.all);
    let floor = f64::from(ERROR) / LIGHT;
    assert!((error.floor.unwrap() / floor - 1.0).abs() < 1e-6);

    let truth = run(&mut cards(Technique::truth(), Output::Still), &mut |_| ()).unwrap();
    let own = truth.provenance.standard_error.unwrap();
    assert!([own.rms_sampled, own.max].iter().all(|e| (e / floor - 1.0).abs() < 1e-6), "{own:?}");
}

/// By no way: pictures, films, photographs, linear light, references and their error bars.
#[test]
fn nothing_that_is_not_finite_leaves() {
    let said = |mut job: Job<Deck>| run(&mut job, &mut |_| ()).unwrap_err().to_string();
    let radiance = "a deck drawn by points: G is NaN at pixel (5, 2)";
    let error = "a deck drawn by mc: SE.G is inf at pixel (5, 2)";
    let camera = Some(Camera::default());
    for (job, expected) in [
        (cards(faulty(false), Output::Still), radiance),
        (cards(faulty(false), Output::Animation), radiance),
        (Job { camera, ..cards(faulty(false), Output::Still) }, radiance),
        (cards(faulty(true), Output::Still), error),
        (Job { reference: Some(faulty(true)), ..cards(pa(), Output::Still) }, error),
    ] {
        let said = said(job);
        assert!(said.contains(expected), "{said}");
    }
    let mut job = cards(faulty(false), Output::Still);
    let said = Drawing::open(&mut job).unwrap().radiance(0).unwrap_err().to_string();
    assert!(said.contains(radiance), "{said}");
    assert!(rehearse(cards(faulty(false), Output::Animation)).1.is_err());
}
