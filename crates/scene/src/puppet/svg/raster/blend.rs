//! How a layer's colours meet those below: the modes of W3C's Compositing and Blending Level 1, on premultiplied colours.

use resvg::usvg::BlendMode;

/// Red, green, blue, alpha; premultiplied, encoded as sRGB.
pub(super) type Colour = [f32; 4];

/// `source` over `below`.
pub(super) fn over(source: Colour, below: Colour) -> Colour {
    let through = 1.0 - source[3];
    std::array::from_fn(|k| source[k] + through * below[k])
}

/// `source` laid on `below` by a mode.
pub(super) fn blend(mode: BlendMode, source: Colour, below: Colour) -> Colour {
    match mode {
        BlendMode::Normal => return over(source, below),
        BlendMode::PlusLighter => return std::array::from_fn(|k| (source[k] + below[k]).min(1.0)),
        _ => {}
    }
    let (alpha, alpha_below) = (source[3], below[3]);
    if alpha == 0.0 || alpha_below == 0.0 {
        return over(source, below);
    }
    let [s, b] = [source, below].map(|c| [0, 1, 2].map(|k| (c[k] / c[3]).clamp(0.0, 1.0)));
    let mixed = match mode {
        BlendMode::Hue => with_luminosity(with_saturation(s, saturation(b)), luminosity(b)),
        BlendMode::Saturation => with_luminosity(with_saturation(b, saturation(s)), luminosity(b)),
        BlendMode::Color => with_luminosity(s, luminosity(b)),
        BlendMode::Luminosity => with_luminosity(b, luminosity(s)),
        _ => [0, 1, 2].map(|k| separable(mode, s[k], b[k])),
    };
    std::array::from_fn(|k| match mixed.get(k) {
        Some(mixed) => {
            source[k] * (1.0 - alpha_below) + below[k] * (1.0 - alpha) + alpha * alpha_below * mixed
        }
        None => alpha + alpha_below - alpha * alpha_below,
    })
}

fn separable(mode: BlendMode, s: f32, b: f32) -> f32 {
    let hard = |s: f32, b: f32| if s <= 0.5 { 2.0 * s * b } else { 1.0 - 2.0 * (1.0 - s) * (1.0 - b) };
    match mode {
        BlendMode::Multiply => s * b,
        BlendMode::Screen => s + b - s * b,
        BlendMode::Overlay => hard(b, s),
        BlendMode::HardLight => hard(s, b),
        BlendMode::Darken => s.min(b),
        BlendMode::Lighten => s.max(b),
        BlendMode::ColorDodge if b == 0.0 => 0.0,
        BlendMode::ColorDodge => (b / (1.0 - s)).min(1.0),
        BlendMode::ColorBurn if b == 1.0 => 1.0,
        BlendMode::ColorBurn => 1.0 - ((1.0 - b) / s).min(1.0),
        BlendMode::SoftLight if s <= 0.5 => b - (1.0 - 2.0 * s) * b * (1.0 - b),
        BlendMode::SoftLight => {
            let d = if b <= 0.25 { ((16.0 * b - 12.0) * b + 4.0) * b } else { b.sqrt() };
            b + (2.0 * s - 1.0) * (d - b)
        }
        BlendMode::Difference => (s - b).abs(),
        BlendMode::Exclusion => s + b - 2.0 * s * b,
        _ => s,
    }
}

fn luminosity([r, g, b]: [f32; 3]) -> f32 {
    0.3 * r + 0.59 * g + 0.11 * b
}

fn least_and_most(colour: [f32; 3]) -> [f32; 2] {
    [colour.into_iter().fold(f32::INFINITY, f32::min), colour.into_iter().fold(0.0, f32::max)]
}

fn saturation(colour: [f32; 3]) -> f32 {
    let [least, most] = least_and_most(colour);
    most - least
}

fn with_saturation(colour: [f32; 3], saturation: f32) -> [f32; 3] {
    let [least, most] = least_and_most(colour);
    if most > least { colour.map(|c| (c - least) * saturation / (most - least)) } else { [0.0; 3] }
}

fn with_luminosity(colour: [f32; 3], wanted: f32) -> [f32; 3] {
    let shift = wanted - luminosity(colour);
    let colour = colour.map(|c| c + shift);
    let [least, most] = [
        colour.into_iter().fold(f32::INFINITY, f32::min),
        colour.into_iter().fold(f32::NEG_INFINITY, f32::max),
    ];
    // Drawn towards grey until it is a colour.
    let dark = if least < 0.0 { wanted / (wanted - least) } else { 1.0 };
    let bright = if most > 1.0 { (1.0 - wanted) / (most - wanted) } else { 1.0 };
    colour.map(|c| wanted + (c - wanted) * dark.min(bright))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Opaque colours laid on each other, worked out by hand from the recommendation's formulas: what lies below is [0.25, 0.5, 0.75].
    #[test]
    fn opaque_colours_meet_as_the_recommendation_has_it() {
        let below = [0.25, 0.5, 0.75];
        for (mode, source, expected) in [
            (BlendMode::Normal, [0.5, 0.5, 0.5], [0.5, 0.5, 0.5]),
            (BlendMode::Multiply, [0.5, 0.2, 1.0], [0.125, 0.1, 0.75]),
            (BlendMode::Screen, [0.5, 0.2, 1.0], [0.625, 0.6, 1.0]),
            // 2·B·S where B ≤ ½, else 1 − 2(1 − B)(1 − S).
            (BlendMode::Overlay, [0.5, 0.2, 0.6], [0.25, 0.2, 0.8]),
            // The same with S asked.
            (BlendMode::HardLight, [0.5, 0.2, 0.6], [0.25, 0.2, 0.8]),
            (BlendMode::HardLight, [0.8, 0.8, 0.2], [0.7, 0.8, 0.3]),
            (BlendMode::Overlay, [0.8, 0.8, 0.2], [0.4, 0.8, 0.6]),
            (BlendMode::Darken, [0.5, 0.2, 0.8], [0.25, 0.2, 0.75]),
            (BlendMode::Lighten, [0.5, 0.2, 0.8], [0.5, 0.5, 0.8]),
            (BlendMode::ColorDodge, [0.5, 0.2, 0.8], [0.5, 0.625, 1.0]),
            (BlendMode::ColorDodge, [1.0, 0.0, 1.0], [1.0, 0.5, 1.0]),
            (BlendMode::ColorBurn, [0.5, 0.8, 1.0], [0.0, 0.375, 0.75]),
            (BlendMode::ColorBurn, [0.0, 0.5, 0.0], [0.0, 0.0, 0.0]),
            // B − (1 − 2S)·B·(1 − B), and B + (2S − 1)(D(B) − B) with D(¼) = ½ and D(¾) = √¾.
            (BlendMode::SoftLight, [0.25, 0.5, 0.0], [0.15625, 0.5, 0.5625]),
            (BlendMode::SoftLight, [1.0, 0.5, 1.0], [0.5, 0.5, 0.8660254]),
            (BlendMode::Difference, [0.5, 0.2, 0.8], [0.25, 0.3, 0.05]),
            (BlendMode::Exclusion, [0.5, 0.2, 0.8], [0.5, 0.5, 0.35]),
            // Luminosity is 0.3 R + 0.59 G + 0.11 B: below 0.4525, whose range is ½.
            (BlendMode::Luminosity, [0.5525, 0.5525, 0.5525], [0.35, 0.6, 0.85]),
            (BlendMode::Color, [0.3, 0.3, 0.3], [0.4525, 0.4525, 0.4525]),
            // Grey has no hue to give, nor saturation.
            (BlendMode::Hue, [0.9, 0.9, 0.9], [0.4525, 0.4525, 0.4525]),
            (BlendMode::Saturation, [0.9, 0.9, 0.9], [0.4525, 0.4525, 0.4525]),
            // Red of range ½ with luminosity 0.4525: 0.15 is 0.3025 too dark; twice the range is [0, ½, 1], 0.0475 too dark, and drawn in to 1.
            (BlendMode::Hue, [1.0, 0.0, 0.0], [0.8025, 0.3025, 0.3025]),
        ] {
            let [[s0, s1, s2], [b0, b1, b2]] = [source, below];
            let found = blend(mode, [s0, s1, s2, 1.0], [b0, b1, b2, 1.0]);
            let worst = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-6 && found[3] == 1.0, "{mode:?} of {source:?}: {found:?}, not {expected:?}");
        }
    }

    /// Where one of the two is clear the other is seen as it is; where both are half there, each quarter is what it is made of.
    #[test]
    fn what_is_clear_does_not_meet() {
        let [below, source] = [[0.1, 0.2, 0.3, 0.5], [0.05, 0.1, 0.25, 0.5]];
        let all = [
            BlendMode::Multiply,
            BlendMode::Screen,
            BlendMode::Overlay,
            BlendMode::Darken,
            BlendMode::Lighten,
            BlendMode::ColorDodge,
            BlendMode::ColorBurn,
            BlendMode::HardLight,
            BlendMode::SoftLight,
            BlendMode::Difference,
            BlendMode::Exclusion,
            BlendMode::Hue,
            BlendMode::Saturation,
            BlendMode::Color,
            BlendMode::Luminosity,
        ];
        for mode in all {
            assert_eq!(blend(mode, source, [0.0; 4]), source, "{mode:?}");
            assert_eq!(blend(mode, [0.0; 4], below), below, "{mode:?}");
            // A quarter of the texel has the source alone, a quarter what is below, a quarter both and a quarter nothing.
            let both = blend(mode, source.map(|c| c / 0.5), below.map(|c| c / 0.5));
            let expected: Colour = std::array::from_fn(|k| 0.5 * (source[k] + below[k]) + 0.25 * both[k]);
            let found = blend(mode, source, below);
            let worst = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-6, "{mode:?}: {found:?}, not {expected:?}");
        }
        assert_eq!(over(source, below), [0.1, 0.2, 0.4, 0.75]);
        assert_eq!(blend(BlendMode::PlusLighter, source, [0.1, 0.2, 0.9, 0.5]), [0.15, 0.3, 1.0, 1.0]);
    }
}
