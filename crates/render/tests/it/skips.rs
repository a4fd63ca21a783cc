//! Skipping what a scene does not need changes no byte, and happens where the scene offers it.

use kelir_render::pa::{Native, Skips, Variant, Weights};
use kelir_render::{
    Backend, Pixel, Renderer, Stats, Technique, View, mc, oracle, pa, pcss, points, renderer, white,
};
use kelir_scene::{Ambient, EmitterShape, Theatre};

use crate::support::{figure, plane, shipped, theatre};

const VIEW: View = View { size: [160, 90], pixel: Pixel::Area, skip: true };

/// One theatre a feature, by name.
fn features() -> Vec<(&'static str, Theatre)> {
    let one = || theatre(vec![plane(figure(96, 1), [0.1, 0.02, -0.3], 0.5)]);
    let with = |change: &dyn Fn(&mut Theatre)| {
        let mut theatre = one();
        change(&mut theatre);
        theatre
    };
    let paper = Ambient::Paper { k_d_m: 0.5, s: [0.3, 0.3, 0.2] };
    let far = || plane(figure(80, 1), [4.0, 0.05, -0.1], 0.4);
    let second = |channels| plane(figure(64, channels), [-0.2, 0.05, -0.6], 0.4);
    vec![
        ("plain", one()),
        ("disk", with(&|t| t.lamp.emitters[1].shape = EmitterShape::Disk { radius_m: 0.05 })),
        ("tilted", with(&|t| t.planes[0].tilt_deg = [25.0, -40.0])),
        ("dome", with(&|t| t.ambient = Ambient::Dome { radiance: [3.0, 2.0, 1.0] })),
        ("colours", with(&|t| t.planes[0].mask = figure(96, 3).into())),
        ("two planes", with(&|t| t.planes.push(second(1)))),
        ("a grey plane beside a coloured one", with(&|t| t.planes.push(second(3)))),
        ("the same, paper", with(&|t| (t.planes.push(second(3)), t.ambient = paper).0)),
        ("a black emitter", with(&|t| t.lamp.emitters[1].radiance = [0.0; 3])),
        ("a black emitter first", with(&|t| t.lamp.emitters[0].radiance = [0.0; 3])),
        ("off the beam", with(&|t| t.planes.push(far()))),
        ("off the beam first, paper", with(&|t| (t.planes.insert(0, far()), t.ambient = paper).0)),
        ("nothing on the beam", with(&|t| t.planes = vec![far()])),
        ("wholly dark places", with(&|t| (t.planes[0].size_m, t.planes[0].centre_m.z) = ([3.0; 2], -0.05))),
        ("coloured light", with(&|t| t.lamp.emitters[1].radiance = [10.0, 40.0, 90.0])),
    ]
}

fn techniques() -> Vec<Technique> {
    let pa = |knobs| Technique::Pa(knobs);
    vec![
        pa(pa::Knobs::default()),
        pa(pa::Knobs { split: 2, weights: Weights::Irradiance, strips: 8, ..pa::Knobs::default() }),
        pa(pa::Knobs { variant: Variant::ShadowMap, map_size: 128, ..pa::Knobs::default() }),
        Technique::Mc(mc::Knobs { spp: 16, ..mc::Knobs::default() }),
        Technique::Points(points::Knobs { lights: 4, ..points::Knobs::default() }),
        Technique::Pcss(pcss::Knobs { filter_samples: 16, map_size: 256, ..pcss::Knobs::default() }),
    ]
}

/// The theatre a moment later: its puppets have slid.
fn slid(theatre: &Theatre) -> Theatre {
    let mut theatre = theatre.clone();
    theatre.planes.iter_mut().for_each(|p| p.centre_m.x += 0.013);
    theatre
}

/// Display codes of the second of two frames, so that what is kept between frames is used, and what was skipped.
fn second(drawing: &mut dyn Renderer<Theatre>, theatre: &Theatre, skip: bool) -> Option<(Vec<u32>, Stats)> {
    let view = View { skip, ..VIEW };
    let white = white([theatre], &view);
    let mut out = vec![0; view.size[0] * view.size[1]];
    drawing.display(&slid(theatre), &view, white, &mut out).ok()?;
    let stats = drawing.display(theatre, &view, white, &mut out).unwrap();
    Some((out, stats))
}

/// All floats of a frame, as bits.
fn bits(drawing: &mut dyn Renderer<Theatre>, theatre: &Theatre, skip: bool) -> Vec<u32> {
    let frame = drawing.radiance(theatre, &View { skip, ..VIEW }).unwrap();
    frame.channels().flat_map(|(_, values)| values).map(|v| v.to_bits()).collect()
}

fn same_bytes(name: &str, theatre: &Theatre, technique: &Technique, backend: Backend) -> Option<Stats> {
    let drawing = || renderer(technique, backend).unwrap();
    let Some((fast, stats)) = second(&mut *drawing(), theatre, true) else {
        assert!(second(&mut *drawing(), theatre, false).is_none(), "{name}: refused one way only");
        return None;
    };
    let (slow, all) = second(&mut *drawing(), theatre, false).unwrap();
    assert!(fast == slow, "{name}, {technique:?} on {backend:?}: skipping changed bytes");
    assert!(
        bits(&mut *drawing(), theatre, true) == bits(&mut *drawing(), theatre, false),
        "{name}, {technique:?} on {backend:?}: skipping changed floats"
    );
    for (_, _, count) in Skips::EACH.into_iter().filter(|_| backend == Backend::Cpu) {
        assert_eq!(all.counts.get(count).copied().unwrap_or(0), 0, "{name}, {technique:?}: {count}");
    }
    for count in ["samples_skipped", "searches_skipped"] {
        assert_eq!(all.counts.get(count).copied().unwrap_or(0), 0, "{name}, {technique:?}: {count}");
    }
    Some(stats)
}

#[test]
fn every_feature_with_every_technique() {
    let mut drawn = 0;
    for (name, theatre) in features() {
        for technique in techniques() {
            let Some(stats) = same_bytes(name, &theatre, &technique, Backend::Cpu) else { continue };
            drawn += 1;
            if let Technique::Pcss(_) = technique {
                let offered = name != "nothing on the beam";
                assert_eq!(stats.counts["searches_skipped"] > 0, offered, "{name}");
            }
            if matches!(technique, Technique::Mc(_) | Technique::Points(_)) {
                assert!(stats.counts["samples_skipped"] > 0, "{name}, {technique:?}");
                let dark = u64::from(name.starts_with("a black emitter"));
                assert_eq!(stats.counts["emitters_dark"], dark, "{name}");
            }
            if matches!(technique, Technique::Pcss(_)) && name != "nothing on the beam" {
                let offered = name != "nothing on the beam";
                assert_eq!(stats.counts["searches_skipped"] > 0, offered, "{name}");
            }
        }
    }
    assert!(drawn >= 84, "{drawn}");
}

/// Each of PA's skips alone: without it the same bytes, and a count that is above zero exactly where the theatre offers it.
#[test]
fn each_skip_alone() {
    let mut offered = [0; Skips::EACH.len()];
    for (name, theatre) in features() {
        let draw =
            |skips| second(&mut Native::with_skips(pa::Knobs::default(), skips), &theatre, true).unwrap();
        let (with_all, stats) = draw(Skips::ALL);
        let count = |name: &str| stats.counts[name] > 0;
        for ((skip, what, counter), offered) in Skips::EACH.into_iter().zip(&mut offered) {
            let (without, stats) = draw(Skips::ALL.without(skip));
            assert!(with_all == without, "{name}: without skipping {what} the bytes differ");
            assert_eq!(stats.counts[counter], 0, "{name}: {what}");
            *offered += u32::from(count(counter));
        }
        let only = |wanted: &[&str]| wanted.contains(&name);
        assert_eq!(count("emitters_dark"), name.starts_with("a black emitter"), "{name}");
        assert_eq!(
            count("planes_off_beam"),
            only(&["off the beam", "off the beam first, paper", "nothing on the beam"]),
            "{name}"
        );
        assert_eq!(
            count("boxes_shared"),
            only(&["a grey plane beside a coloured one", "the same, paper"]),
            "{name}"
        );
        assert_eq!(count("tables_reused"), name != "nothing on the beam", "{name}");
        assert!(count("background_reused"), "{name}");
        // The dome lights every pixel by its own amount; a puppet larger than the screen leaves no tile alone.
        assert_eq!(count("pixels_lit_copied"), !only(&["dome", "wholly dark places"]), "{name}");
    }
    for ((_, what, _), offered) in Skips::EACH.iter().zip(offered) {
        assert!(offered > 0, "no theatre offers {what}: nothing was tested");
    }
}

#[test]
fn every_scene_that_ships() {
    for scene in shipped() {
        for theatre in [Some(&scene.still), scene.later.as_ref()].into_iter().flatten() {
            for technique in techniques() {
                let stats = same_bytes(&scene.name, theatre, &technique, Backend::Cpu).unwrap();
                let counter = match technique {
                    Technique::Pa(_) => "pixels_lit_copied",
                    Technique::Pcss(_) => "searches_skipped",
                    _ => "samples_skipped",
                };
                assert!(stats.counts[counter] > 0, "{}, {technique:?}", scene.name);
            }
        }
    }
}

/// The oracle skips nothing; it must not mind being asked.
#[test]
fn the_oracle_does_not_mind() {
    let (_, theatre) = features().swap_remove(0);
    let draw = |skip| {
        let knobs = oracle::Knobs { tolerance: 0.1, geometric: true };
        let view = View { size: [32, 18], pixel: Pixel::Centre, skip };
        renderer(&Technique::Oracle(knobs), Backend::Cpu).unwrap().radiance(&theatre, &view).unwrap().radiance
    };
    assert!(draw(true) == draw(false));
}

#[test]
fn on_the_gpu_too() {
    for (name, theatre) in features() {
        if !["plain", "a black emitter", "colours"].contains(&name) {
            continue;
        }
        for technique in [&techniques()[0], &techniques()[3]] {
            same_bytes(name, &theatre, technique, Backend::Gpu).unwrap();
        }
    }
}
