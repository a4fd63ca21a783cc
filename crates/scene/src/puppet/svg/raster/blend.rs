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
